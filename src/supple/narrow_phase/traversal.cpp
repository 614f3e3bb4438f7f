#include "narrow_phase/traversal.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>

#include "core/float_rounding.hpp"
#include "narrow_phase/volume_kernels.hpp"

namespace supple {
namespace {

void test_children(const ObjectPairView& pair, std::span<const NodePair> node_pairs, std::uint64_t* masks) {
  if (pair.is_moving()) {
    moving_overlap_masks(node_pairs, pair.a.moving, pair.b.moving, pair.part_of_step(), masks);
  } else if (pair.a.spheres != nullptr) {
    overlap_masks(node_pairs, pair.a.spheres, pair.b.spheres, pair.placement, masks);
  } else {
    overlap_masks(node_pairs, pair.a.boxes, pair.b.boxes, pair.placement, masks);
    separate_volumes(node_pairs, pair.a.volumes, pair.b.volumes, pair.placement, masks);
  }
}

/// Bit i to the bits of byte i.
std::uint64_t spread_to_bytes(std::uint32_t bits) {
  const std::uint64_t copies = bits * 0x0101010101010101u;
  const std::uint64_t ones = copies & 0x8040201008040201u;  // one bit of each byte
  return ((ones + 0x7f7f7f7f7f7f7f7fu) >> 7 & 0x0101010101010101u) * 0xffu;
}

/// Calls `visit(i, j)` for each pair of children that is in the mask; for a node with itself only pairs with
/// i <= j. This is one loop over all pairs, because the end of a loop for each i is hard to predict.
template <class Visit>
void for_each_child_pair(const ObjectPairView& pair, NodePair node_pair, std::uint64_t mask, Visit&& visit) {
  const OctreeNode& node_a = pair.a.nodes[node_pair.a];
  const OctreeNode& node_b = pair.b.nodes[node_pair.b];
  mask &= spread_to_bytes(node_pair.children_a & node_a.child_mask());
  mask &= (node_pair.children_b & node_b.child_mask()) * 0x0101010101010101u;
  if (pair.same_object && node_pair.a == node_pair.b) {
    constexpr std::uint64_t upper_half = 0x80c0e0f0f8fcfeffu;
    mask &= upper_half;
    const std::uint32_t culled = pair.a.culled != nullptr ? pair.a.culled[node_pair.a] : 0;
    for (std::uint32_t rest = culled; rest != 0; rest &= rest - 1) {
      mask &= ~(std::uint64_t{1} << 9 * std::countr_zero(rest));
    }
  }
  for (; mask != 0; mask &= mask - 1) {
    const int place = std::countr_zero(mask);
    visit(place >> 3, place & 7);
  }
}

std::uint32_t leaf_number(std::uint32_t node, int child) {
  return node * node_width + static_cast<std::uint32_t>(child);
}

std::uint8_t child_bit(int child) {
  return static_cast<std::uint8_t>(1u << child);
}

/// Largest absolute coordinate of the box; 0 when it is empty.
double greatest_coordinate(const Aabb& box) {
  if (box.empty()) return 0;
  double greatest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    greatest = std::max({greatest, std::abs(double{box.min[axis]}), std::abs(double{box.max[axis]})});
  }
  return greatest;
}

/// The volumes are those of the untranslated positions. Seen from a, b's move by the difference of the
/// translations, or a's the other way. The slop covers the sums fl(position + translation) that the exact
/// tests see (2^-53 of their size, in both objects), and where there is a difference, rounding it and the
/// moved coordinates to float (2^-24 of their size each). Below an ulp it still works: rounding is monotonic,
/// so a gap of at most the slop closes.
RelativePlacement place(const OctreeView& a, const OctreeView& b) {
  if (a.translation == Vec3d{} && b.translation == Vec3d{}) return {};
  const Vec3d offset = b.translation - a.translation;
  const auto largest = [](Vec3d v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
  const double size_a = greatest_coordinate(a.box), size_b = greatest_coordinate(b.box);
  const double world = std::max(size_a + largest(a.translation), size_b + largest(b.translation));
  const double moved = offset == Vec3d{} ? 0 : std::max(size_a, size_b) + largest(offset);
  return {{static_cast<float>(offset.x), static_cast<float>(offset.y), static_cast<float>(offset.z)},
          round_up(0x1p-21 * moved + 0x1p-50 * world)};
}

}  // namespace

OctreeView view_of(const ObjectOctree& octree, const VertexBuffer& vertices,
                   std::span<const std::uint8_t> inert, Vec3d translation) {
  OctreeView view;
  view.nodes = octree.nodes();
  view.boxes = octree.boxes();
  view.spheres = octree.spheres();
  view.volumes = octree.volumes();
  view.leaf_vertices = octree.leaf_vertices();
  view.arrays = arrays_of(octree.triangles(), vertices, inert);
  view.box = octree.box();
  view.translation = translation;
  return view;
}

OctreeView moving_view_of(const ObjectOctree& octree, const SurfaceElements& elements,
                          const MovingBoxes& boxes, Vec3d translation) {
  OctreeView view;
  view.nodes = octree.nodes();
  view.box = boxes.swept_box();
  view.translation = translation;
  view.moving = boxes.view(elements);
  return view;
}

ObjectPairView pair_of(const OctreeView& a, const OctreeView& b) {
  return {a, b, place(a, b), false, 0, nullptr};
}

ObjectPairView self_pair_of(const OctreeView& object) {
  // Both translations are equal, but rounding may still make close positions touch.
  ObjectPairView pair{object, object, place(object, object), true, 0, nullptr};
  if (!pair.placement.is_identity()) pair.a.culled = nullptr;
  return pair;
}

ObjectPairView moving_pair_of(const OctreeView& a, const OctreeView& b, double separation) {
  const RelativePlacement placement = place(a, b);
  return {a, b, placement, false, round_up(separation + placement.slop), nullptr};
}

ObjectPairView moving_self_pair_of(const OctreeView& object, double separation) {
  ObjectPairView pair = moving_pair_of(object, object, separation);
  pair.same_object = true;
  if (separation > 0 || !pair.placement.is_identity()) pair.a.culled = nullptr;
  return pair;
}

bool object_volumes_apart(const ObjectPairView& pair) {
  const NodePair objects{pair.a.volumes.object, pair.b.volumes.object};
  std::uint64_t mask = 1;
  if (!pair.a.volumes.empty() && !pair.b.volumes.empty())
    separate_volumes({&objects, 1}, pair.a.volumes, pair.b.volumes, pair.placement, &mask);
  return mask == 0;
}

std::optional<NodePair> nodes_below(const ObjectPairView& pair, const ChildPair& children) {
  const OctreeNode &node_a = pair.a.nodes[children.node_a], &node_b = pair.b.nodes[children.node_b];
  const int i = children.child_a, j = children.child_b;
  const bool inner_a = node_a.is_inner(i), inner_b = node_b.is_inner(j);
  if (inner_a && inner_b) return NodePair{node_a.child_node(i), node_b.child_node(j)};
  if (inner_a) return NodePair{node_a.child_node(i), children.node_b, 0xff, child_bit(j)};
  if (inner_b) return NodePair{children.node_a, node_b.child_node(j), child_bit(i), 0xff};
  return std::nullopt;
}

void find_overlapping_children(const ObjectPairView& pair, NodePair node_pair,
                               std::vector<ChildPair>& children) {
  std::uint64_t mask = 0;
  test_children(pair, {&node_pair, 1}, &mask);
  for_each_child_pair(pair, node_pair, mask, [&](int i, int j) {
    children.push_back({node_pair.a, node_pair.b, i, j});
  });
}

ChildPair last_children(const ObjectPairView& pair, TrianglePair triangles) {
  ChildPair at;
  for (;;) {
    const OctreeNode& node_a = pair.a.nodes[at.node_a];
    const OctreeNode& node_b = pair.b.nodes[at.node_b];
    at.child_a = node_a.child_with(triangles.a);
    at.child_b = node_b.child_with(triangles.b);
    const NodePair nodes{at.node_a, at.node_b, child_bit(at.child_a), child_bit(at.child_b)};
    std::uint64_t mask = 0;
    test_children(pair, {&nodes, 1}, &mask);
    at.apart = (mask >> (node_width * at.child_a + at.child_b) & 1) == 0;
    const bool inner_a = node_a.is_inner(at.child_a), inner_b = node_b.is_inner(at.child_b);
    if (at.apart || !(inner_a || inner_b)) return at;
    if (inner_a) at.node_a = node_a.child_node(at.child_a);
    if (inner_b) at.node_b = node_b.child_node(at.child_b);
  }
}

bool leaf_triangles_apart(const ObjectPairView& pair, const ChildPair& leaves, TrianglePair triangles) {
  const LeafPair both{triangles.a,
                      triangles.a + 1,
                      triangles.b,
                      triangles.b + 1,
                      leaf_number(leaves.node_a, leaves.child_a),
                      leaf_number(leaves.node_b, leaves.child_b)};
  const auto cache = std::make_unique<LeafBoxCache>();
  TrianglePairList found;
  find_triangle_box_pairs({&both, 1}, {pair.a.arrays, pair.a.boxes, pair.a.leaf_vertices},
                          {pair.b.arrays, pair.b.boxes, pair.b.leaf_vertices}, pair.placement,
                          pair.same_object, *cache, found);
  return found.size() == 0;
}

void Traversal::expand_batch(const ObjectPairView& pair, TraversalStats& stats) {
  const std::size_t count = std::min(node_batch, stack_.size());
  std::copy(stack_.end() - static_cast<std::ptrdiff_t>(count), stack_.end(), batch_.begin());
  stack_.resize(stack_.size() - count);
  test_children(pair, {batch_.data(), count}, masks_.data());
  stats.node_pairs_visited += count;
  for (std::size_t k = 0; k < count; ++k) {
    const NodePair node_pair = batch_[k];
    const OctreeNode& node_a = pair.a.nodes[node_pair.a];
    const OctreeNode& node_b = pair.b.nodes[node_pair.b];
    stats.volumes_tested += std::uint64_t{bit_count(node_pair.children_a & node_a.child_mask())} *
                            bit_count(node_pair.children_b & node_b.child_mask());
    for_each_child_pair(pair, node_pair, masks_[k], [&](int i, int j) {
      if (const auto below = nodes_below(pair, {node_pair.a, node_pair.b, i, j})) {
        stack_.push_back(*below);
      } else {
        leaf_pairs_.push_back({node_a.first_triangle[i], node_a.first_triangle[i + 1],
                               node_b.first_triangle[j], node_b.first_triangle[j + 1],
                               leaf_number(node_pair.a, i), leaf_number(node_pair.b, j)});
      }
    });
  }
}

void Traversal::refine(const ObjectPairView& pair, NodePair node_pair, std::vector<NodePair>& finer) {
  if (pair.a.nodes.empty() || pair.b.nodes.empty()) return;
  std::uint64_t mask = 0;
  test_children(pair, {&node_pair, 1}, &mask);
  const OctreeNode& node_a = pair.a.nodes[node_pair.a];
  const OctreeNode& node_b = pair.b.nodes[node_pair.b];
  for_each_child_pair(pair, node_pair, mask, [&](int i, int j) {
    if (node_a.is_inner(i) && node_b.is_inner(j)) {
      finer.push_back({node_a.child_node(i), node_b.child_node(j)});
    } else {
      finer.push_back({node_pair.a, node_pair.b, child_bit(i), child_bit(j)});
    }
  });
}

}  // namespace supple
