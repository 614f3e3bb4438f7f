#include <algorithm>
#include <memory>
#include <utility>

#include "core/error.hpp"
#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "mesh/share_vertex.hpp"
#include "scene/scene_implementation.hpp"
#include "scene/searched_volumes.hpp"

namespace supple {
namespace {

/// The children of an octree as cells, where the object is now.
class CellReader {
 public:
  explicit CellReader(const OctreeView& view) : view_(view) {}

  /// Whether the octree is a single leaf, which is then the root cell.
  bool is_one_leaf() const {
    return view_.nodes.size() > 0 && view_.nodes[0].child_count == 1 && !view_.nodes[0].is_inner(0);
  }

  /// Calls `visit(node, child, is_leaf)` for every child that the search knows; shallow ones first.
  template <class Visit>
  void for_each_child(Visit&& visit) const {
    for (const OctreeNode& node : view_.nodes) {
      for (int child = 0; child < node.child_count; ++child) visit(node, child, !node.is_inner(child));
    }
  }

  OctreeCell cell(const OctreeNode& node, int child, bool is_leaf) const {
    OctreeCell cell;
    cell.level = is_one_leaf() ? 0 : node.level + 1u;
    cell.is_leaf = is_leaf;
    cell.triangle_count = node.size(child);
    const auto n = static_cast<std::uint32_t>(&node - view_.nodes.data());
    cell.box = moved(child_box(view_, n, child), view_.translation);
    if (view_.spheres != nullptr) cell.sphere = moved(child_sphere(view_, n, child), view_.translation);
    return cell;
  }

  /// The root cell of an object that has triangles.
  OctreeCell root(const BoundingSphere& sphere) const {
    OctreeCell cell{0, is_one_leaf(), view_.nodes[0].size(), {}, {}};
    for (int child = 0; child < view_.nodes[0].child_count; ++child)
      extend(cell.box, child_box(view_, 0, child));
    cell.box = moved(cell.box, view_.translation);
    if (view_.spheres != nullptr) cell.sphere = sphere;
    return cell;
  }

 private:
  OctreeView view_;
};

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

std::vector<OctreeCell> Scene::Implementation::octree_cells(ObjectId id,
                                                            std::optional<std::uint32_t> level) const {
  const SceneObject& asked = object(id, "cells");
  if (asked.has_moved() || asked.needs_refit(question_.shapes())) {
    fail("cells: " + asked.options.name + " was moved since anything was detected; call detect first");
  }
  std::vector<OctreeCell> cells;
  if (asked.octree().nodes().empty()) return cells;
  const CellReader reader(search_view(asked));
  if (level == 0) return {reader.root(asked.sphere())};
  reader.for_each_child([&](const OctreeNode& node, int child, bool is_leaf) {
    const std::uint32_t here = node.level + 1u;
    const bool is_asked_for = !level ? is_leaf : here == *level || (is_leaf && here < *level);
    if (is_asked_for) cells.push_back(reader.cell(node, child, is_leaf));
  });
  return cells;
}

std::uint32_t Scene::Implementation::octree_depth(ObjectId id) const {
  const CellReader reader(search_view(object(id, "octree_depth")));
  if (reader.is_one_leaf()) return 0;
  std::uint32_t depth = 0;
  reader.for_each_child([&](const OctreeNode& node, int, bool) { depth = std::max(depth, node.level + 1u); });
  return depth;
}

ObjectPairView Scene::Implementation::search_view(const ContactJob& job) const {
  OctreeView a = search_view(*slots_[job.a].object), b = search_view(*slots_[job.b].object);
  a.culled = b.culled = nullptr;
  const double separation = question_.impact.min_separation;
  if (question_.searches_at_rest()) return job.a == job.b ? self_pair_of(a) : pair_of(a, b);
  return job.a == job.b ? moving_self_pair_of(a, separation) : moving_pair_of(a, b, separation);
}

/// Jobs are in canonical order.
CandidateList Scene::Implementation::candidates(std::size_t limit) const {
  if (!detected_) fail("candidates: nothing was detected at the present positions; call detect first");
  CandidateList list;
  const auto traversal = std::make_unique<Traversal>();
  for (const ContactJob& job : jobs_.jobs) {
    const std::span<const std::uint32_t> ids_a = slots_[job.a].object->octree().triangle_ids();
    const std::span<const std::uint32_t> ids_b = slots_[job.b].object->octree().triangle_ids();
    FirstPairs pairs(limit - list.pairs.size());
    for_each_candidate(*traversal, search_view(job), [&](const TrianglePair& pair) {
      TrianglePair named{ids_a[pair.a], ids_b[pair.b]};
      if (job.a == job.b && named.a > named.b) std::swap(named.a, named.b);
      pairs.add(named);
    });
    list.total += pairs.count();
    for (const TrianglePair& pair : pairs.sorted())
      list.pairs.push_back({id_of(job.a), id_of(job.b), pair.a, pair.b});
  }
  return list;
}

std::string Scene::Implementation::validate() const {
  for (const ObjectId id : objects()) {
    const SceneObject& object = *slots_[id.index].object;
    if (const std::string wrong = object.validate(); !wrong.empty())
      return object.options.name + ": " + wrong;
  }
  return pair_finder.validate();
}

std::vector<OctreeCell> SceneInspector::cells(ObjectId object, std::optional<std::uint32_t> level) const {
  return scene_->implementation_->octree_cells(object, level);
}
std::uint32_t SceneInspector::octree_depth(ObjectId object) const {
  return scene_->implementation_->octree_depth(object);
}
OctreeStatistics SceneInspector::octree_statistics(ObjectId object) const {
  return scene_->implementation_->object(object, "octree_statistics").octree_statistics();
}
Aabb SceneInspector::bounds(ObjectId object) const {
  return scene_->implementation_->object(object, "bounds").box();
}
std::vector<SceneRegion> SceneInspector::regions() const {
  return scene_->implementation_->pair_finder.regions();
}
CandidateList SceneInspector::candidates(std::size_t limit) const {
  return scene_->implementation_->candidates(limit);
}
PairExplanation SceneInspector::explain(ObjectId object_a, std::uint32_t triangle_a, ObjectId object_b,
                                        std::uint32_t triangle_b) const {
  return scene_->implementation_->explain(object_a, triangle_a, object_b, triangle_b);
}
std::string SceneInspector::validate() const {
  return scene_->implementation_->validate();
}

}  // namespace supple
