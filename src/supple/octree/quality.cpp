#include "octree/quality.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/aabb.hpp"
#include "octree/box_kernels.hpp"
#include "octree/rebuild.hpp"

namespace supple {
namespace {

/// For a node whose cost when built is not known, as all its triangles were one point: a surface of leaves
/// with two dozen triangles has about this.
constexpr double usual_reference = 16;

}  // namespace

bool TreeQuality::is_known() const {
  // Written so that NaN is not known.
  return !nodes_.empty() && nodes_[0].area > 0 && nodes_[0].cost > 0 && std::isfinite(nodes_[0].cost);
}

void TreeQuality::set_costs(const TreeBoxes& tree) {
  add_up_costs(tree, nodes_.data());
  nodes_[0].area = half_surface(box_of_lanes(tree.boxes[0]));
}

void TreeQuality::clear_choice() {
  degraded_.clear();
  saving_ = share_ = degraded_cost_ = 0;
}

void TreeQuality::set_references(const TreeBoxes& tree) {
  clear_choice();
  nodes_.assign(tree.nodes.size(), {});
  if (nodes_.empty()) return;
  set_costs(tree);
  for (NodeCost& node : nodes_) {
    const double reference = node.cost / node.area;
    node.reference = reference > 0 && std::isfinite(reference) ? reference : usual_reference;
  }
}

void TreeQuality::update_references(const TreeBoxes& tree, std::span<const std::uint32_t> old_nodes) {
  const std::vector<NodeCost> before = std::move(nodes_);
  const std::vector<std::uint32_t> built = degraded_;
  set_references(tree);
  // Beyond what was the reference, of all below each node.
  std::vector<double> excess(nodes_.size(), 0);
  for (auto n = static_cast<std::uint32_t>(nodes_.size()); n-- > 0;) {
    if (old_nodes[n] == no_node) continue;
    NodeCost& node = nodes_[n];
    const double old_reference = before[old_nodes[n]].reference;
    if (std::binary_search(built.begin(), built.end(), old_nodes[n])) {
      excess[n] = node.cost - old_reference * node.area;
    } else {
      const double reference = old_reference + excess[n] / node.area;
      node.reference = reference > 0 && std::isfinite(reference) ? reference : old_reference;
    }
    if (n > 0) excess[tree.nodes[n].parent] += excess[n];
  }
}

void TreeQuality::measure(const TreeBoxes& tree) {
  clear_choice();
  if (nodes_.size() != tree.nodes.size()) set_references(tree);
  if (nodes_.empty()) return;
  set_costs(tree);
  if (!is_known()) return;
  for (NodeCost& node : nodes_) node.net_saving = 0;
  for (auto n = static_cast<std::uint32_t>(nodes_.size()); n-- > 0;) {
    nodes_[n].net_saving = std::max(nodes_[n].net_saving, net_saving(tree, n));
    if (n > 0) nodes_[tree.nodes[n].parent].net_saving += nodes_[n].net_saving;
  }
  if (nodes_[0].net_saving > 0) choose(tree);
}

/// Of building this very node anew.
double TreeQuality::net_saving(const TreeBoxes& tree, std::uint32_t n) const {
  const double saved = nodes_[n].cost - nodes_[n].reference * nodes_[n].area;
  const double share = static_cast<double>(tree.nodes[n].size()) / tree.nodes[0].size();
  return saved / reference_cost() - least_saving * share;
}

/// Finds the topmost nodes whose rebuild is better than rebuilds below them.
void TreeQuality::choose(const TreeBoxes& tree) {
  degraded_.push_back(0);
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < degraded_.size(); ++i) {
    const std::uint32_t n = degraded_[i];
    const OctreeNode& node = tree.nodes[n];
    const double net = net_saving(tree, n);
    if (net >= nodes_[n].net_saving) {
      degraded_[chosen++] = n;
      share_ += static_cast<double>(node.size()) / tree.nodes[0].size();
      saving_ += net;
      degraded_cost_ += nodes_[n].cost / nodes_[0].area;
      continue;
    }
    for (int lane = 0; lane < node.lane_count; ++lane) {
      if (node.is_inner(lane) && nodes_[node.child(lane)].net_saving > 0) {
        degraded_.push_back(node.child(lane));
      }
    }
  }
  degraded_.resize(chosen);
  saving_ += least_saving * share_;
}

}  // namespace supple
