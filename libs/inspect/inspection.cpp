#include "inspect/inspection.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/error.hpp"
#include "core/sort_once.hpp"
#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "inspect/polytope.hpp"
#include "inspect/searched_volumes.hpp"
#include "mesh/share_vertex.hpp"

namespace supple {
namespace {

/// The cells of an octree, where the object is now.
class CellReader {
 public:
  CellReader(const OctreeView& view, const WorldObject& object) : view_(view), object_(&object) {}

  OctreeCell cell(std::uint32_t n, int child) const {
    const OctreeNode& node = view_.nodes[n];
    OctreeCell cell;
    cell.level = cell_level(view_, n);
    cell.number = cell_number(view_, object_->options.octree.arity, n, child);
    cell.is_leaf = !node.is_inner(child);
    cell.triangle_count = node.size(child);
    cell.box = moved(child_box(view_, n, child), view_.translation);
    cell.sphere = moved(child_sphere(view_, n, child), view_.translation);
    cell.slabs = child_slabs(view_, n, child);
    return cell;
  }

  /// The root cell of an object that has triangles.
  OctreeCell root() const {
    OctreeCell cell;
    cell.is_leaf = is_one_leaf(view_);
    cell.triangle_count = view_.nodes[0].size();
    cell.slabs = object_slabs(view_);
    for (int child = 0; child < view_.nodes[0].child_count; ++child)
      extend(cell.box, child_box(view_, 0, child));
    cell.box = moved(cell.box, view_.translation);
    if (view_.volumes != nullptr) cell.sphere = object_->sphere();
    return cell;
  }

  /// The leaf with a triangle, numbered in octree order.
  OctreeCell leaf_with(std::uint32_t triangle) const {
    std::uint32_t n = 0;
    int child = view_.nodes[0].child_with(triangle);
    while (view_.nodes[n].is_inner(child)) {
      n = view_.nodes[n].child_node(child);
      child = view_.nodes[n].child_with(triangle);
    }
    return cell(n, child);
  }

 private:
  OctreeView view_;
  const WorldObject* object_;
};

/// The cells of one side of a `NodePairList`. A cell is named by its place in the octree: 0 for the root,
/// otherwise 1 plus eight times the node plus the child. These names ascend by level and number.
class CollidingCells {
 public:
  using Name = std::uint64_t;

  CollidingCells(const OctreeView& view, const WorldObject& object)
      : reader_(view, object), is_one_leaf_(is_one_leaf(view)) {}

  Name add_root() { return add(0); }
  Name add(std::uint32_t node, int child) {
    return add(is_one_leaf_ ? 0 : 1 + node_width * Name{node} + static_cast<Name>(child));
  }
  /// Call after all cells were added, and before `place_of`.
  std::vector<OctreeCell> list() {
    sort_once(names_);
    std::vector<OctreeCell> cells;
    for (const Name name : names_)
      cells.push_back(name == 0 ? reader_.root()
                                : reader_.cell(static_cast<std::uint32_t>((name - 1) / node_width),
                                               static_cast<int>((name - 1) % node_width)));
    return cells;
  }
  std::uint32_t place_of(Name name) const {
    return static_cast<std::uint32_t>(std::lower_bound(names_.begin(), names_.end(), name) - names_.begin());
  }

 private:
  Name add(Name name) {
    names_.push_back(name);
    return name;
  }

  CellReader reader_;
  bool is_one_leaf_;
  std::vector<Name> names_;
};

/// Exchanges both objects.
NodePairList mirrored(NodePairList list) {
  std::swap(list.nodes_a, list.nodes_b);
  for (NodePairList::Pair& pair : list.pairs) std::swap(pair.a, pair.b);
  for (std::uint32_t level = 0; level < list.level_count(); ++level) {
    const auto at = [&](std::uint32_t k) {
      return list.pairs.begin() + static_cast<std::ptrdiff_t>(list.level_begin[k]);
    };
    std::sort(at(level), at(level + 1));
  }
  return list;
}

/// Collects the first `limit` pairs in ascending order and counts all of them.
class FirstPairs {
 public:
  explicit FirstPairs(std::size_t limit) : limit_(limit) {}

  void add(TrianglePair pair) {
    ++count_;
    if (limit_ == 0) return;
    pairs_.push_back(pair);
    if (pairs_.size() >= 2 * limit_ + slack) drop_last();
  }
  std::uint64_t count() const { return count_; }
  std::span<const TrianglePair> sorted() {
    drop_last();
    std::sort(pairs_.begin(), pairs_.end());
    return pairs_;
  }

 private:
  static constexpr std::size_t slack = 1024;

  void drop_last() {
    if (pairs_.size() <= limit_) return;
    std::nth_element(pairs_.begin(), pairs_.begin() + static_cast<std::ptrdiff_t>(limit_), pairs_.end());
    pairs_.resize(limit_);
  }

  std::size_t limit_;
  std::uint64_t count_ = 0;
  std::vector<TrianglePair> pairs_;
};

/// Visits the pairs of triangles of two leaves whose swept boxes overlap.
template <class Visit>
void for_each_moving_pair(const ObjectPairView& pair, const LeafPair& leaves, Visit&& visit) {
  const bool same_leaf = pair.same_object && leaves.begin_a == leaves.begin_b;
  for (std::uint32_t a = leaves.begin_a; a < leaves.end_a; ++a) {
    for (std::uint32_t b = same_leaf ? a + 1 : leaves.begin_b; b < leaves.end_b; ++b) {
      if (pair.same_object && share_vertex(pair.a.moving.face_ids[a], pair.b.moving.face_ids[b])) continue;
      if (!moving_faces_apart(pair, {a, b})) visit(TrianglePair{a, b});
    }
  }
}

/// Visits all candidates of two objects, in octree order.
template <class Visit>
void for_each_candidate(Traversal& traversal, const ObjectPairView& pair, Visit&& visit) {
  TraversalStats stats;
  if (pair.is_moving()) {
    traversal.find_leaf_pairs(pair, stats, [&](std::span<const LeafPair> leaf_pairs) {
      for (const LeafPair& leaves : leaf_pairs) for_each_moving_pair(pair, leaves, visit);
    });
  } else {
    traversal.find_triangle_pairs(
        pair, {}, stats, [](std::span<const LeafPair>) {},
        [&](std::span<const TrianglePair> pairs) { std::for_each(pairs.begin(), pairs.end(), visit); });
  }
}

}  // namespace

/// Throws an error unless the object is as in the last `detect`. All of its nodes are refitted.
const WorldObject& Inspection::refitted_object(ObjectId id, const char* call) const {
  WorldObject& asked = world_.object(id, call);
  if (asked.has_moved() || asked.needs_refit(question().shapes())) {
    fail(std::string(call) + ": " + asked.options.name +
         " was moved since anything was detected; call detect first");
  }
  if (question().shapes().lazy) asked.update_all_children(world_.parallel);
  return asked;
}

std::vector<OctreeCell> Inspection::octree_cells(ObjectId id, std::optional<std::uint32_t> level) const {
  const WorldObject& asked = refitted_object(id, "cells");
  const std::span<const OctreeNode> nodes = asked.octree().nodes();
  std::vector<OctreeCell> cells;
  if (nodes.empty()) return cells;
  const CellReader reader(question().view(asked), asked);
  if (level == 0) return {reader.root()};
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    const std::uint32_t here = nodes[n].level + 1u;
    for (int child = 0; child < nodes[n].child_count; ++child) {
      const bool is_leaf = !nodes[n].is_inner(child);
      const bool is_asked_for = !level ? is_leaf : here == *level || (is_leaf && here < *level);
      if (is_asked_for) cells.push_back(reader.cell(n, child));
    }
  }
  return cells;
}

OctreeCell Inspection::leaf(ObjectId id, std::uint32_t triangle) const {
  const WorldObject& asked = refitted_object(id, "leaf");
  check_triangle(asked, triangle, "leaf");
  return CellReader(question().view(asked), asked).leaf_with(asked.octree().octree_triangle(triangle));
}

NodePairList Inspection::node_pairs(ObjectId id_a, ObjectId id_b) const {
  const WorldObject &a = world_.object(id_a, "node_pairs"), &b = world_.object(id_b, "node_pairs");
  if (!is_current_) fail("node_pairs: nothing was detected at the present positions; call detect first");
  if (id_b < id_a) return mirrored(node_pairs(id_b, id_a));
  NodePairList list;
  const bool is_compared = std::any_of(jobs().begin(), jobs().end(), [&](const ContactJob& job) {
    return job.a == id_a.index && job.b == id_b.index;
  });
  if (!is_compared || a.octree().nodes().empty() || b.octree().nodes().empty()) return list;

  const ObjectPairView view = search_view(ContactJob{id_a.index, id_b.index});
  CollidingCells cells_a(view.a, a), cells_b(view.b, b);
  std::vector<std::pair<CollidingCells::Name, CollidingCells::Name>> names;
  const auto finish_level = [&] {
    std::sort(names.begin() + static_cast<std::ptrdiff_t>(list.level_begin.back()), names.end());
    list.level_begin.push_back(names.size());
  };
  // The broad phase found that the roots overlap. Two octrees of one leaf each have only this pair.
  names.emplace_back(cells_a.add_root(), cells_b.add_root());
  finish_level();
  std::vector<NodePair> nodes;
  if (!is_one_leaf(view.a) || !is_one_leaf(view.b)) nodes.emplace_back();
  std::vector<ChildPair> children;
  while (!nodes.empty()) {
    children.clear();
    for (const NodePair& node_pair : nodes) find_overlapping_children(view, node_pair, children);
    nodes.clear();
    if (children.empty()) break;
    for (const ChildPair& at : children) {
      names.emplace_back(cells_a.add(at.node_a, at.child_a), cells_b.add(at.node_b, at.child_b));
      if (const auto below = nodes_below(view, at)) nodes.push_back(*below);
    }
    finish_level();
  }
  list.nodes_a = cells_a.list();
  list.nodes_b = cells_b.list();
  list.pairs.reserve(names.size());
  for (const auto& [name_a, name_b] : names)
    list.pairs.push_back({cells_a.place_of(name_a), cells_b.place_of(name_b)});
  return list;
}

std::uint32_t Inspection::octree_depth(ObjectId id) const {
  const std::span<const OctreeNode> nodes = world_.object(id, "octree_depth").octree().nodes();
  return nodes.empty() || nodes[0].child_count == 1 ? 0 : nodes.back().level + 1u;
}

ObjectPairView Inspection::search_view(const ContactJob& job) const {
  OctreeView a = question().view(world_[job.a]), b = question().view(world_[job.b]);
  a.culled = b.culled = nullptr;
  if (question().searches_at_rest()) return job.a == job.b ? self_pair_of(a) : pair_of(a, b);
  const double separation =
      question().is_continuous() ? question().separation_of(world_[job.a], world_[job.b]) : reach_of(job);
  return job.a == job.b ? moving_self_pair_of(a, separation) : moving_pair_of(a, b, separation);
}

/// Jobs are in canonical order.
CandidateList Inspection::candidates(std::size_t limit) const {
  if (!is_current_) fail("candidates: nothing was detected at the present positions; call detect first");
  CandidateList list;
  const auto traversal = std::make_unique<Traversal>();
  for (const ContactJob& job : jobs()) {
    const std::span<const std::uint32_t> ids_a = world_[job.a].octree().triangle_ids();
    const std::span<const std::uint32_t> ids_b = world_[job.b].octree().triangle_ids();
    const std::uint32_t faces_a = world_[job.a].face_count();
    const std::uint32_t faces_b = world_[job.b].face_count();
    FirstPairs pairs(limit - list.pairs.size());
    for_each_candidate(*traversal, search_view(job), [&](const TrianglePair& pair) {
      TrianglePair named{ids_a[pair.a], ids_b[pair.b]};
      if (named.a >= faces_a || named.b >= faces_b) return;  // an edge or a point of no triangle
      if (job.a == job.b && named.a > named.b) std::swap(named.a, named.b);
      pairs.add(named);
    });
    list.total += pairs.count();
    for (const TrianglePair& pair : pairs.sorted())
      list.pairs.push_back({world_.id_of(job.a), world_.id_of(job.b), pair.a, pair.b});
  }
  return list;
}

std::vector<std::array<Vec3d, 2>> edges_of(std::span<const Slab> slabs) {
  return Polytope(slabs).edges();
}

}  // namespace supple
