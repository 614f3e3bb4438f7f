#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contact/intersection/neighbour_test.hpp"
#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "geometry/vector.hpp"
#include "inspect/searched_volumes.hpp"
#include "mesh/share_vertex.hpp"
#include "queries/box_faces.hpp"
#include "scene/scene_implementation.hpp"
#include "supple/distance.hpp"
#include "supple/inspection.hpp"
#include "supple/triangle_intersection.hpp"

namespace supple {
namespace {

std::uint32_t octree_triangle(const WorldObject& object, std::uint32_t triangle) {
  check_triangle(object, triangle, "explain");
  return object.octree().octree_triangle(triangle);
}

TrianglePoints points_of(const WorldObject& object, std::uint32_t triangle) {
  const Triangle& corners = object.octree().triangles()[triangle];
  const Placement& placement = object.placement();
  return {placement.position(corners[0]), placement.position(corners[1]), placement.position(corners[2])};
}

/// Whether a corner is not finite at either end of the step.
bool is_inert(const WorldObject& object, std::uint32_t triangle) {
  const Triangle& corners = object.octree().triangles()[triangle];
  return std::any_of(corners.begin(), corners.end(), [&](std::uint32_t vertex) {
    return !is_finite(object.placement().position(vertex)) ||
           !is_finite(object.placement().start_position(vertex));
  });
}

/// Swaps a and b.
PairExplanation mirrored(PairExplanation explanation) {
  std::swap(explanation.box_a, explanation.box_b);
  std::swap(explanation.sphere_a, explanation.sphere_b);
  std::swap(explanation.slabs_a, explanation.slabs_b);
  std::swap(explanation.level_a, explanation.level_b);
  std::swap(explanation.number_a, explanation.number_b);
  explanation.axis = Vec3d{} - explanation.axis;
  return explanation;
}

QueryBox translated(const Aabb& box, const Vec3d& translation) {
  return {in_double(box.min) + translation, in_double(box.max) + translation};
}

/// Sets the axis along which the boxes are furthest apart, from a to b, and the distance along it.
void set_gap(PairExplanation& explanation, const QueryBox& a, const QueryBox& b) {
  explanation.distance = -INFINITY;
  const auto consider = [&](int axis, double sign, double gap) {
    if (!(gap > explanation.distance)) return;
    explanation.distance = gap;
    explanation.axis = {};
    explanation.axis[axis] = sign;
  };
  for (int axis = 0; axis < 3; ++axis) {
    consider(axis, 1, b.min[axis] - a.max[axis]);
    consider(axis, -1, a.min[axis] - b.max[axis]);
  }
}

/// Sets the direction from centre to centre and the distance between the spheres. Spheres that do not enclose
/// their triangles (equations 3 and 4 of the paper) may also be empty.
void set_gap(PairExplanation& explanation, const Vec3d& between_centers) {
  const double distance = norm(between_centers);
  if (!(distance > 0)) return;
  explanation.axis = between_centers * (1 / distance);
  explanation.distance = distance - explanation.sphere_a.radius - explanation.sphere_b.radius;
}

/// The extent of a volume along a direction.
struct Extent {
  double low, high;
};
/// Returns the extent of the oriented box that has these three slabs.
Extent extent_along(Vec3d direction, std::span<const Slab> box) {
  Extent extent{0, 0};
  for (const Slab& slab : box) {
    const double along = dot(direction, in_double(slab.direction));
    extent.low += along * (along > 0 ? slab.low : slab.high);
    extent.high += along * (along > 0 ? slab.high : slab.low);
  }
  return extent;
}

/// Sets the direction in which the slabs of the explanation are furthest apart, and the gap along it.
void set_gap(PairExplanation& explanation) {
  explanation.distance = -INFINITY;
  const auto consider = [&](Vec3d direction, Extent a, Extent b) {
    const double length = norm(direction);
    const double after = (b.low - a.high) / length, before = (a.low - b.high) / length;
    if (!(std::max(after, before) > explanation.distance)) return;
    explanation.distance = std::max(after, before);
    explanation.axis = direction * ((after > before ? 1 : -1) / length);
  };
  const std::span<const Slab> slabs_a = explanation.slabs_a, slabs_b = explanation.slabs_b;
  const auto direction = [](const Slab& slab) { return in_double(slab.direction); };
  constexpr std::size_t axes_of_box = 3;
  if (slabs_a.size() > axes_of_box) {
    for (std::size_t d = 0; d < slabs_a.size(); ++d)
      consider(direction(slabs_a[d]), {slabs_a[d].low, slabs_a[d].high}, {slabs_b[d].low, slabs_b[d].high});
    return;
  }
  const auto consider_boxes = [&](Vec3d along) {
    // The cross product of parallel axes has no direction.
    if (norm(along) > 0x1p-20) consider(along, extent_along(along, slabs_a), extent_along(along, slabs_b));
  };
  for (const Slab& a : slabs_a) {
    consider_boxes(direction(a));
    for (const Slab& b : slabs_b) consider_boxes(cross(direction(a), direction(b)));
  }
  for (const Slab& b : slabs_b) consider_boxes(direction(b));
}

/// The end of the descent from the roots to two triangles, numbered in octree order: the first children on
/// the way that are apart, or the two leaves. For one object with itself, `triangles.a < triangles.b`.
struct LastChildren {
  ChildPair at;
  bool are_apart = false;
};
LastChildren last_children(const ObjectPairView& pair, TrianglePair triangles) {
  std::vector<ChildPair> overlapping;
  for (NodePair nodes;;) {
    const ChildPair at{nodes.a, nodes.b, pair.a.nodes[nodes.a].child_with(triangles.a),
                       pair.b.nodes[nodes.b].child_with(triangles.b)};
    overlapping.clear();
    find_overlapping_children(pair, nodes, overlapping);
    const bool overlap = std::ranges::any_of(overlapping, [&](const ChildPair& children) {
      return children.child_a == at.child_a && children.child_b == at.child_b;
    });
    const std::optional<NodePair> below = overlap ? nodes_below(pair, at) : std::nullopt;
    if (!below) return {at, !overlap};
    nodes = *below;
  }
}

/// Whether `Traversal::find_triangle_pairs` excludes two triangles of two leaves by their boxes.
bool leaf_triangles_apart(const ObjectPairView& pair, const ChildPair& leaves, TrianglePair triangles) {
  const auto leaf = [](std::uint32_t node, int child) {
    return node_width * node + static_cast<std::uint32_t>(child);
  };
  const LeafPair both{triangles.a,
                      triangles.a + 1,
                      triangles.b,
                      triangles.b + 1,
                      leaf(leaves.node_a, leaves.child_a),
                      leaf(leaves.node_b, leaves.child_b)};
  const auto cache = std::make_unique<LeafBoxCache>();
  TrianglePairList found;
  find_triangle_box_pairs({&both, 1}, {pair.a.arrays, pair.a.boxes, pair.a.leaf_vertices},
                          {pair.b.arrays, pair.b.boxes, pair.b.leaf_vertices}, pair.placement,
                          pair.same_object, *cache, found);
  return found.size() == 0;
}

/// The volumes of an object or a cell, and where they are now.
struct Volumes {
  Aabb box;
  BoundingSphere sphere;
  std::vector<Slab> slabs;  ///< translated
  Vec3d translation{};
};

/// Sets the volumes that are apart, and the gap between them.
void set_volumes(PairExplanation& explanation, bool are_spheres, const Volumes& a, const Volumes& b) {
  if (are_spheres) {
    explanation.sphere_a = moved(a.sphere, a.translation);
    explanation.sphere_b = moved(b.sphere, b.translation);
    set_gap(explanation,
            (in_double(b.sphere.center) + b.translation) - (in_double(a.sphere.center) + a.translation));
    return;
  }
  explanation.box_a = moved(a.box, a.translation);
  explanation.box_b = moved(b.box, b.translation);
  set_gap(explanation, translated(a.box, a.translation), translated(b.box, b.translation));
  if (a.slabs.empty() || explanation.distance > 0) return;
  explanation.slabs_a = a.slabs;
  explanation.slabs_b = b.slabs;
  set_gap(explanation);
}

PairExplanation objects_apart(const WorldObject& a, const WorldObject& b, BoundingVolume bounding_volume,
                              bool has_elements) {
  PairExplanation explanation{.stage = PairStage::object_volumes};
  const auto volumes_of = [&](const WorldObject& object) -> Volumes {
    if (has_elements) return {unclamped(object.box()), object.sphere(), {}};
    return {object.box(), object.sphere(), object_slabs(object.resting_view())};
  };
  set_volumes(explanation, bounding_volume == BoundingVolume::sphere, volumes_of(a), volumes_of(b));
  return explanation;
}

PairExplanation cells_apart(const ObjectPairView& pair, const ChildPair& at, const WorldObject& object_a,
                            const WorldObject& object_b) {
  PairExplanation explanation{.stage = PairStage::octree_volumes};
  const std::uint32_t arity_a = object_a.options.octree.arity, arity_b = object_b.options.octree.arity;
  explanation.number_a = cell_number(pair.a, arity_a, at.node_a, at.child_a);
  explanation.number_b = cell_number(pair.b, arity_b, at.node_b, at.child_b);
  explanation.level_a = number_level(pair.a, arity_a, at.node_a, explanation.number_a);
  explanation.level_b = number_level(pair.b, arity_b, at.node_b, explanation.number_b);
  const auto volumes_of = [](const OctreeView& view, std::uint32_t node, int child) -> Volumes {
    return {child_box(view, node, child), child_sphere(view, node, child), child_slabs(view, node, child),
            view.translation};
  };
  set_volumes(explanation, pair.a.volumes != nullptr && pair.a.volumes->replace_boxes(),
              volumes_of(pair.a, at.node_a, at.child_a), volumes_of(pair.b, at.node_b, at.child_b));
  return explanation;
}

PairExplanation triangle_boxes_apart(const TrianglePoints& a, const TrianglePoints& b) {
  PairExplanation explanation{.stage = PairStage::triangle_boxes};
  const QueryBox box_a = box_around(a), box_b = box_around(b);
  for (const Vec3d& corner : {box_a.min, box_a.max}) extend(explanation.box_a, corner);
  for (const Vec3d& corner : {box_b.min, box_b.max}) extend(explanation.box_b, corner);
  set_gap(explanation, box_a, box_b);
  return explanation;
}

PairExplanation triangles_apart(const TrianglePoints& a, const TrianglePoints& b) {
  PairExplanation explanation{.stage = PairStage::exact_test};
  // Continuous contacts do not include triangles that intersect from the start when none of their elements
  // touch.
  if (triangles_intersect(a, b)) return explanation;
  explanation.distance = any_distance;
  const auto consider = [&](const std::optional<ElementDistance>& found, double from_a_to_b) {
    if (!found || found->distance > explanation.distance) return;
    explanation.distance = found->distance;
    explanation.axis = from_a_to_b * found->normal;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    consider(point_triangle_distance(a[i], b), -1);
    consider(point_triangle_distance(b[i], a), 1);
    for (std::size_t k = 0; k < 3; ++k)
      consider(edge_edge_distance({a[i], a[(i + 1) % 3]}, {b[k], b[(k + 1) % 3]}), -1);
  }
  return explanation;
}

/// Whether a continuous contact or a near pair of the result joins an element of one triangle to an element
/// of the other.
bool are_joined(const World& world, const DetectResult& result, const ContactJob& job,
                TrianglePair triangles) {
  const auto corners = [&](std::uint32_t slot, std::uint32_t triangle) {
    const ObjectOctree& octree = world[slot].octree();
    return std::pair(octree.triangle_ids()[triangle], octree.triangles()[triangle]);
  };
  const auto a = corners(job.a, triangles.a), b = corners(job.b, triangles.b);
  const auto has = [](const std::pair<std::uint32_t, Triangle>& triangle, bool is_face,
                      const std::array<std::uint32_t, 2>& element) {
    const Triangle& of = triangle.second;
    if (is_face) return element[0] == triangle.first;
    return std::all_of(element.begin(), element.end(), [&](std::uint32_t vertex) {
      return std::find(of.begin(), of.end(), vertex) != of.end();
    });
  };
  const auto joins = [&](const auto& pair) {
    std::array<FeatureKind, 2> kinds;
    if constexpr (requires { pair.kind_a; })
      kinds = {pair.kind_a, pair.kind_b};
    else
      kinds = feature_kinds(pair.kind);
    const bool face_a = kinds[0] == FeatureKind::face, face_b = kinds[1] == FeatureKind::face;
    if (has(a, face_a, pair.element_a) && has(b, face_b, pair.element_b)) return true;
    return job.a == job.b && has(b, face_a, pair.element_a) && has(a, face_b, pair.element_b);
  };
  const ObjectPair ids{world.id_of(job.a), world.id_of(job.b)};
  const auto any_joins = [&](std::span<const ContactGroup> groups, const auto& records) {
    return std::ranges::any_of(groups, [&](const ContactGroup& group) {
      return ObjectPair{group.a, group.b} == ids &&
             std::ranges::any_of(records.subspan(group.first_contact, group.contact_count), joins);
    });
  };
  return any_joins(result.continuous_groups, result.continuous_contacts) ||
         any_joins(result.proximity_groups, result.proximity_pairs);
}

/// Follows the stages of `detect`. Triangles are in the order of the traversal.
PairExplanation explain_in_order(const World& world, const Detection& detection, const DetectResult& result,
                                 const ContactJob& job, TrianglePair triangles) {
  const Question& question = detection.question();
  const WorldObject &a = world[job.a], &b = world[job.b];
  const bool same_object = job.a == job.b;
  if (same_object ? !a.options.self_collision : !world.may_pair({job.a, job.b}))
    return {.stage = PairStage::not_tested};
  const Triangle &ids_a = a.octree().triangles()[triangles.a], &ids_b = b.octree().triangles()[triangles.b];
  if (!may_touch_by_groups(a.vertex_groups(), ids_a, b.vertex_groups(), ids_b))
    return {.stage = PairStage::not_tested};
  // Elements touch or are near even when the pair of triangles they belong to is not tested.
  if (are_joined(world, result, job, triangles)) return {};
  if (same_object && share_vertex(ids_a, ids_b)) {
    const bool meet = question.searches_at_rest() && a.options.neighbours == Neighbours::exact &&
                      triangles.a != triangles.b && !is_inert(a, triangles.a) && !is_inert(b, triangles.b) &&
                      meet_elsewhere(ids_a, points_of(a, triangles.a), ids_b, points_of(b, triangles.b));
    return {.stage = meet ? PairStage::contact : PairStage::shared_vertex};
  }
  if (is_inert(a, triangles.a) || is_inert(b, triangles.b)) return {.stage = PairStage::inert};
  const ObjectPair ids{world.id_of(job.a), world.id_of(job.b)};
  if (!same_object &&
      !std::binary_search(detection.pairs().pairs().begin(), detection.pairs().pairs().end(), ids))
    return objects_apart(a, b, world.options.bounding_volume,
                         question.reads(SearchedShape::paths) || question.reads(SearchedShape::margins));
  const ObjectPairView pair = search_view(world, question, job);
  const auto [at, are_apart] = last_children(pair, triangles);
  if (are_apart) return cells_apart(pair, at, a, b);
  const TrianglePoints points_a = points_of(a, triangles.a), points_b = points_of(b, triangles.b);
  const bool boxes_apart =
      pair.is_moving() ? moving_faces_apart(pair, triangles) : leaf_triangles_apart(pair, at, triangles);
  if (boxes_apart) return triangle_boxes_apart(points_a, points_b);
  if (question.searches_at_rest() && triangles_intersect(points_a, points_b)) return {};
  return triangles_apart(points_a, points_b);
}

}  // namespace

PairExplanation SceneInspector::explain(ObjectId id_a, std::uint32_t triangle_a, ObjectId id_b,
                                        std::uint32_t triangle_b) const {
  const World& world = SceneAccess::of(*scene_).world;
  const WorldObject &a = world.object(id_a, "explain"), &b = world.object(id_b, "explain");
  const auto& inside = detected(*scene_, "explain");  // the octrees have all edits from here on
  const TrianglePair triangles{octree_triangle(a, triangle_a), octree_triangle(b, triangle_b)};
  const auto in_order = [&](const ContactJob& job, const TrianglePair& ordered) {
    return explain_in_order(world, inside.detection, inside.result, job, ordered);
  };
  if (id_a == id_b ? triangles.a <= triangles.b : id_a < id_b)
    return in_order({id_a.index, id_b.index}, triangles);
  return mirrored(in_order({id_b.index, id_a.index}, {triangles.b, triangles.a}));
}

}  // namespace supple
