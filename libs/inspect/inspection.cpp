#include "supple/inspection.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/error.hpp"
#include "core/sort_once.hpp"
#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "inspect/octree_statistics.hpp"
#include "inspect/polytope.hpp"
#include "inspect/searched_volumes.hpp"
#include "inspect/validation.hpp"
#include "mesh/share_vertex.hpp"
#include "scene/scene_implementation.hpp"

namespace supple {
namespace {

/// A cell by its place in the octree: 0 for the root, otherwise 1 plus eight times the node plus the child.
/// These names ascend by level and number.
using CellName = std::uint64_t;

CellName name_of(const OctreeView& view, std::uint32_t node, int child) {
  return is_one_leaf(view) ? 0 : 1 + node_width * CellName{node} + static_cast<CellName>(child);
}

/// The cells of an octree, where the object is now.
class CellReader {
 public:
  CellReader(const OctreeView& view, const WorldObject& object) : view_(view), object_(&object) {}

  OctreeCell cell(std::uint32_t n, int child) const {
    const OctreeNode& node = view_.nodes[n];
    OctreeCell cell;
    cell.level = cell_level(view_, n);
    const std::uint32_t arity = object_->options.octree.arity;
    cell.number = cell_number(view_, arity, n, child);
    cell.number_level = number_level(view_, arity, n, cell.number);
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

  OctreeCell named(CellName name) const {
    return name == 0 ? root()
                     : cell(static_cast<std::uint32_t>((name - 1) / node_width),
                            static_cast<int>((name - 1) % node_width));
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

/// Throws an error unless the object is as in the last `detect`. All of its nodes are refitted.
const WorldObject& refitted_object(const World& world, const Question& question, ObjectId id,
                                   const char* call) {
  WorldObject& asked = world.object(id, call);
  if (asked.has_moved() || asked.needs_refit(question.shapes())) {
    fail(std::string(call) + ": " + asked.options.name +
         " was moved since anything was detected; call detect first");
  }
  if (question.shapes().lazy) asked.update_all_children(world.parallel);
  return asked;
}

}  // namespace

ObjectPairView search_view(const World& world, const Question& question, const ContactJob& job) {
  OctreeView a = question.view(world[job.a]), b = question.view(world[job.b]);
  a.culled = b.culled = nullptr;
  const OctreeView& second = job.a == job.b ? a : b;
  if (question.searches_at_rest()) return pair_of(a, second);
  return pair_of(a, second,
                 question.is_continuous()
                     ? question.separation_of(world[job.a], world[job.b])
                     : reach_of_margins(world[job.a].options.margin, world[job.b].options.margin));
}

std::vector<OctreeCell> SceneInspector::cells(ObjectId id, std::optional<std::uint32_t> level) const {
  const auto& inside = SceneAccess::of(*scene_);
  const WorldObject& asked = refitted_object(inside.world, inside.detection.question(), id, "cells");
  const std::span<const OctreeNode> nodes = asked.octree().nodes();
  std::vector<OctreeCell> cells;
  if (nodes.empty()) return cells;
  const CellReader reader(inside.detection.question().view(asked), asked);
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

OctreeCell SceneInspector::leaf(ObjectId id, std::uint32_t triangle) const {
  const auto& inside = SceneAccess::of(*scene_);
  const WorldObject& asked = refitted_object(inside.world, inside.detection.question(), id, "leaf");
  check_triangle(asked, triangle, "leaf");
  return CellReader(inside.detection.question().view(asked), asked)
      .leaf_with(asked.octree().octree_triangle(triangle));
}

NodePairList SceneInspector::node_pairs(ObjectId id_a, ObjectId id_b) const {
  const World& world = SceneAccess::of(*scene_).world;
  const WorldObject &a = world.object(id_a, "node_pairs"), &b = world.object(id_b, "node_pairs");
  const Detection& detection = detected(*scene_, "node_pairs").detection;
  NodePairList list;
  const auto [low, high] = std::minmax(id_a, id_b);
  const ContactJob job{low.index, high.index};
  const bool is_compared = std::ranges::any_of(detection.pairs().jobs(), [&](const ContactJob& compared) {
    return compared.a == job.a && compared.b == job.b;
  });
  if (!is_compared || a.octree().nodes().empty() || b.octree().nodes().empty()) return list;

  const ObjectPairView view = search_view(world, detection.question(), job);
  std::vector<std::array<CellName, 2>> names;  // of the cells of a and b
  const auto add = [&](CellName low_name, CellName high_name) {
    names.push_back(id_b < id_a ? std::array{high_name, low_name} : std::array{low_name, high_name});
  };
  const auto finish_level = [&] {
    std::sort(names.begin() + static_cast<std::ptrdiff_t>(list.level_begin.back()), names.end());
    list.level_begin.push_back(names.size());
  };
  // The broad phase found that the roots overlap. Two octrees of one leaf each have only this pair.
  add(0, 0);
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
      add(name_of(view.a, at.node_a, at.child_a), name_of(view.b, at.node_b, at.child_b));
      if (const auto below = nodes_below(view, at)) nodes.push_back(*below);
    }
    finish_level();
  }
  list.pairs.resize(names.size());
  const auto list_cells = [&](std::size_t side, const WorldObject& object, std::vector<OctreeCell>& cells,
                              std::uint32_t NodePairList::Pair::*place) {
    std::vector<CellName> of_side;
    for (const auto& pair : names) of_side.push_back(pair[side]);
    sort_once(of_side);
    const CellReader reader(&object == &world[job.a] ? view.a : view.b, object);
    for (const CellName name : of_side) cells.push_back(reader.named(name));
    for (std::size_t i = 0; i < names.size(); ++i)
      list.pairs[i].*place =
          static_cast<std::uint32_t>(std::ranges::lower_bound(of_side, names[i][side]) - of_side.begin());
  };
  list_cells(0, a, list.nodes_a, &NodePairList::Pair::a);
  list_cells(1, b, list.nodes_b, &NodePairList::Pair::b);
  return list;
}

std::uint32_t SceneInspector::octree_depth(ObjectId id) const {
  const WorldObject& object = SceneAccess::of(*scene_).world.object(id, "octree_depth");
  const std::span<const OctreeNode> nodes = object.octree().nodes();
  return nodes.empty() || nodes[0].child_count == 1 ? 0 : nodes.back().level + 1u;
}

OctreeStatistics SceneInspector::octree_statistics(ObjectId id) const {
  const World& world = SceneAccess::of(*scene_).world;
  WorldObject& asked = world.object(id, "octree_statistics");
  asked.update_all_children(world.parallel);
  return supple::octree_statistics(asked);
}

Aabb SceneInspector::bounds(ObjectId id) const {
  return SceneAccess::of(*scene_).world.object(id, "bounds").box();
}

std::vector<SceneRegion> SceneInspector::regions() const {
  return SceneAccess::of(*scene_).detection.pairs().finder().regions();
}

std::vector<SceneRegion> SceneInspector::regions(ObjectId id) const {
  const auto& inside = SceneAccess::of(*scene_);
  inside.world.object(id, "regions");
  return inside.detection.pairs().finder().regions(id.index);
}

/// Jobs are in canonical order.
CandidateList SceneInspector::candidates(std::size_t limit) const {
  const auto& inside = detected(*scene_, "candidates");
  const World& world = inside.world;
  CandidateList list;
  const auto traversal = std::make_unique<Traversal>();
  std::vector<TrianglePair> first;  // as a heap
  for (const ContactJob& job : inside.detection.pairs().jobs()) {
    const WorldObject &a = world[job.a], &b = world[job.b];
    const std::size_t most = limit - list.pairs.size();
    first.clear();
    const ObjectPairView view = search_view(world, inside.detection.question(), job);
    for_each_candidate(*traversal, view, [&](const TrianglePair& pair) {
      TrianglePair named{a.octree().triangle_ids()[pair.a], b.octree().triangle_ids()[pair.b]};
      if (named.a >= a.face_count() || named.b >= b.face_count())
        return;  // an edge or a point of no triangle
      if (job.a == job.b && named.a > named.b) std::swap(named.a, named.b);
      ++list.total;
      first.push_back(named);
      std::push_heap(first.begin(), first.end());
      if (first.size() <= most) return;
      std::pop_heap(first.begin(), first.end());
      first.pop_back();
    });
    std::sort_heap(first.begin(), first.end());
    for (const TrianglePair& pair : first)
      list.pairs.push_back({world.id_of(job.a), world.id_of(job.b), pair.a, pair.b});
  }
  return list;
}

std::string SceneInspector::validate() const {
  const auto& inside = SceneAccess::of(*scene_);
  const std::string wrong = fault_of(inside.world);
  return wrong.empty() ? inside.detection.pairs().finder().validate() : wrong;
}

std::vector<std::array<Vec3d, 2>> edges_of(std::span<const Slab> slabs) {
  return Polytope(slabs).edges();
}

}  // namespace supple
