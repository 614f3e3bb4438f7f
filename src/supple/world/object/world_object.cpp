#include "world/object/world_object.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/float_rounding.hpp"
#include "geometry/aabb.hpp"
#include "geometry/sphere.hpp"
#include "geometry/vector.hpp"
#include "octree/build/query_cost.hpp"
#include "octree/octree_topology.hpp"

namespace supple {
namespace {

/// The sphere around a box.
BoundingSphere sphere_around(const Aabb& box) {
  if (box.empty()) return {};
  BoundingSphere sphere;
  double squared_radius = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    sphere.center[axis] = static_cast<float>((low + high) / 2);
    const double reach = std::max(high - sphere.center[axis], sphere.center[axis] - low);
    squared_radius += reach * reach;
  }
  sphere.radius = round_up(std::sqrt(squared_radius) * (1 + 0x1p-50));
  return sphere;
}

/// The rule for the size of leaves. Searches of paths and margins test all vertices, edges and faces of
/// two leaves, most of them in vain, so leaves half as large are faster. Regular octrees keep the size that
/// the user chose.
ObjectOctreeOptions octree_options(const ObjectOptions& options, const SceneOptions& scene_options) {
  ObjectOctreeOptions octree = options.octree;
  const bool tests_elements = std::ranges::any_of(contact_kinds, [&](const ContactKindInfo& of) {
    return of.shape != SearchedShape::triangles && contains(scene_options.contacts, of.kind);
  });
  if (tests_elements && octree.build != ObjectOctreeBuild::regular)
    octree.leaf_size = octree.leaf_size / 2 + octree.leaf_size % 2;
  return octree;
}

std::vector<Triangle> with_extra(std::vector<Triangle> faces, std::span<const Triangle> extra) {
  faces.insert(faces.end(), extra.begin(), extra.end());
  return faces;
}

}  // namespace

WorldObject::WorldObject(const PositionsView& positions, std::vector<Triangle> faces,
                         std::span<const Triangle> extra, const ObjectOptions& object_options,
                         const SceneOptions& scene_options, const Parallel& parallel)
    : options(object_options),
      face_count_(static_cast<std::uint32_t>(faces.size())),
      is_edited_locally_(object_options.octree.build == ObjectOctreeBuild::balanced &&
                         scene_options.bounding_volume == BoundingVolume::aabb &&
                         !scene_options.comparison.lazy_refit),
      descent_(scene_options.comparison.descent),
      octree_(positions, with_extra(std::move(faces), extra), octree_options(object_options, scene_options),
              scene_options.bounding_volume, scene_options.comparison.sphere_fit, parallel),
      // The paper's results depend on the leaves of the rest pose. The cost of an octree at rest leaves out
      // extra elements.
      rebuild_policy_(object_options.octree.rebuild_degraded && extra.empty() &&
                      !scene_options.comparison.colliding_vertices && !scene_options.comparison.lazy_refit &&
                      scene_options.comparison.sphere_fit != SphereFit::box) {
  // They are in the octree now.
  options.edges = {};
  options.points = {};
  options.same_vertex = {};
  list_points(extra, positions.size());
}

void WorldObject::list_points(std::span<const Triangle> extra, std::size_t vertex_count) {
  std::vector<std::uint8_t> is_point;
  for (const auto& [v, w, last] : extra) {
    if (v != w) continue;
    is_point.resize(vertex_count, 0);
    is_point[v] = 1;
  }
  is_point_ = std::move(is_point);
}

VertexWays WorldObject::ways(const Parallel& parallel) const {
  constexpr std::size_t grain = 4096;
  VertexWays all;
  const auto is_finite_at = [&](std::uint32_t v) {
    return is_finite(placement_.start_position(v)) && is_finite(placement_.position(v));
  };
  const auto way = [&](std::uint32_t v) { return placement_.position(v) - placement_.start_position(v); };
  const auto count = static_cast<std::uint32_t>(octree_.vertex_count());
  // One thread sums the ways, so that the result does not depend on the number of threads.
  for (std::uint32_t v = 0; placement_.has_motion() && v < count; ++v) {
    if (is_finite_at(v)) all.mean = all.mean + (1.0 / count) * way(v);
  }
  if (!is_finite(all.mean)) all.mean = {};
  std::vector<VertexWays> parts(parallel.worker_count());
  parallel.for_ranges(count, grain, [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
    VertexWays& part = parts[worker];
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      if (!is_finite_at(v)) continue;
      const Vec3d d = way(v), rest = d - all.mean;
      part.longest = std::max(part.longest, scaled_norm(d));
      part.farthest_from_mean = std::max(part.farthest_from_mean, scaled_norm(rest));
      part.largest_coordinate =
          std::max(part.largest_coordinate, largest_magnitude(placement_.start_position(v)));
    }
  });
  for (const VertexWays& part : parts) {
    all.longest = std::max(all.longest, part.longest);
    all.farthest_from_mean = std::max(all.farthest_from_mean, part.farthest_from_mean);
    all.largest_coordinate = std::max(all.largest_coordinate, part.largest_coordinate);
  }
  return all;
}

SearchedShapes WorldObject::of_this(SearchedShapes shapes) const {
  shapes.near = shapes.near || (shapes.extra && has_extra_elements());
  return shapes;
}

bool WorldObject::is_stale(const SearchedShapes& shapes) const {
  return has_moved_ || of_this(shapes) != updated_ || needs_refit(shapes);
}

bool WorldObject::needs_refit(const SearchedShapes& shapes) const {
  const bool has_resting =
      is_lazy(shapes) ? resting_.has_object(placement_) : resting_.is_current(placement_);
  return pending_ || (shapes.resting && !has_resting) ||
         (shapes.moving && !moving().is_current(placement_)) ||
         (of_this(shapes).near && !near().is_current(placement_));
}

SearchedShapes WorldObject::with_current(SearchedShapes shapes) const {
  shapes.resting = shapes.resting || resting_.is_current(placement_);
  shapes.moving = shapes.moving || moving().is_current(placement_);
  shapes.near = shapes.near || near().is_current(placement_);
  return shapes;
}

void WorldObject::update(const SearchedShapes& of_search, const Parallel& parallel) {
  if (pending_) make_pending_edits(parallel);
  const SearchedShapes shapes = of_this(of_search);
  const bool was_behind = needs_refit(shapes);
  const bool refits_elements =
      (shapes.moving && !moving().is_current(placement_)) || (shapes.near && !near().is_current(placement_));
  refitted_triangles_ = refits_elements ? octree_.triangles().size() : 0;
  refit(shapes, parallel);
  update_volumes(shapes);
  if (was_behind && rebuild_policy_.should_measure()) rebuild_policy_.set_cost(current_query_cost());
  has_moved_ = false;
  updated_ = shapes;
}

/// Updates the shapes for this search, and those that were up to date before.
void WorldObject::refit(const SearchedShapes& shapes, const Parallel& parallel) {
  const SearchedShapes wanted = with_current(shapes);
  // When one shape bakes the translation, the other one is out of date.
  do {
    if (wanted.resting) refitted_triangles_ = std::max(refitted_triangles_, update_resting(wanted, parallel));
    if (!wanted.moving && !wanted.near) continue;
    if (!shapes_of_step_) shapes_of_step_ = std::make_unique<ShapesOfStep>();
    auto& [way, end] = *shapes_of_step_;
    if (wanted.moving) way.update(octree_, placement_, parallel);
    if (wanted.near) (placement_.has_motion() ? end : way).update(octree_, placement_, parallel);
  } while (needs_refit(wanted));
  if (!options.self_collision || has_extra_elements()) return;
  if (wanted.cull_resting) resting_.update_culling(octree_, placement_, parallel);
  if (wanted.cull_moving && shapes_of_step_) shapes_of_step_->way.update_culling(octree_, parallel);
}

std::size_t WorldObject::update_resting(const SearchedShapes& shapes, const Parallel& parallel) {
  if (!is_lazy(shapes)) return resting_.update(octree_, placement_, parallel);
  const bool has_bounds = bounds_.version == placement_.version();
  return resting_.update_object(octree_, placement_, has_bounds ? std::optional(bounds_.box) : std::nullopt,
                                parallel);
}

void WorldObject::update_volumes(const SearchedShapes& shapes) {
  if (!shapes.moving && !shapes.near) {
    box_ = moved(octree_.box(), placement_.translation());
    sphere_ = moved(octree_.sphere(), placement_.translation());
    return;
  }
  box_ = shapes.moving ? moving().box() : near().box();
  if (shapes.near) extend(box_, near().box());
  if (shapes.resting) extend(box_, octree_.box());
  box_ = moved(box_, placement_.translation());
  sphere_ = sphere_around(box_);
}

/// The query cost at the positions of the shape that is up to date: the resting one if both are.
double WorldObject::current_query_cost() const {
  const MovingShape& elements = moving().is_current(placement_) ? moving() : near();
  const bool is_resting = resting_.is_current(placement_) || !elements.is_current(placement_);
  return query_cost(octree_.nodes(), is_resting ? octree_.boxes() : elements.node_boxes());
}

std::optional<std::array<std::uint32_t, 2>> WorldObject::open_edge() {
  if (knows_open_edge_) return open_edge_;
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& triangle : octree_.triangles()) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [first, last] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      if (first != last) edges.push_back({first, last});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size() && !open_edge_;) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if ((end - i) % 2 != 0) open_edge_ = edges[i];
    i = end;
  }
  knows_open_edge_ = true;
  return open_edge_;
}

const VertexTriangles& WorldObject::vertex_triangles() {
  const std::uint8_t* const inert = resting_view().arrays.inert;
  if (vertex_triangles_ && !leaves_out_inert_ && inert == nullptr) return *vertex_triangles_;
  const std::size_t count = octree_.id_count();
  const bool are_all = inert == nullptr && octree_.triangles().size() == count;
  std::vector<Triangle> triangles(count);
  std::vector<std::uint8_t> inert_by_id(are_all ? 0 : count, 1);
  for (std::uint32_t t = 0; t < octree_.triangles().size(); ++t) {
    const std::uint32_t id = octree_.triangle_ids()[t];
    triangles[id] = octree_.triangles()[t];
    if (!are_all) inert_by_id[id] = inert != nullptr ? inert[t] : 0;
  }
  leaves_out_inert_ = inert != nullptr;
  vertex_triangles_ = std::make_unique<VertexTriangles>(triangles, inert_by_id, octree_.vertex_count());
  return *vertex_triangles_;
}

std::span<const std::uint8_t> WorldObject::inward_triangles() {
  if (!options.solid) return {};
  const PositionsView positions = placement_.shape().view();
  if (!orientation_) {
    std::vector<Triangle> faces;
    faces.reserve(face_count_);
    for (std::uint32_t t = 0; t < face_count_; ++t)
      faces.push_back(octree_.has_triangle(t) ? octree_.user_triangle(t) : Triangle{});
    orientation_ = std::make_unique<Orientation>(std::move(faces), positions);
  } else if (oriented_version_ != placement_.shape_version()) {
    orientation_->judge(positions);
  }
  oriented_version_ = placement_.shape_version();
  return orientation_->inward();
}

void WorldObject::measure_built_octree(const Parallel& parallel) {
  resting_.update(octree_, placement_, parallel);
  rebuild_policy_.set_cost_when_built(current_query_cost());
}

void WorldObject::forget_octree() {
  fine_boxes_ = {};
  resting_.forget_octree(face_count_);
  if (!shapes_of_step_) return;
  shapes_of_step_->way.forget_octree();
  shapes_of_step_->end.forget_octree();
}

bool WorldObject::rebuild(const Parallel& parallel) {
  ObjectOctree octree = octree_.rebuilt(placement_.end().view(), parallel);
  if (!octree.refit(placement_.end(), {}, parallel) || has_extra_elements()) {
    std::vector<std::uint8_t> inert;
    mark_inert(octree, placement_.end(), face_count_, inert);
    octree.refit(placement_.end(), inert, parallel);
  }
  if (!rebuild_policy_.accept(query_cost(octree.nodes(), octree.boxes()))) return false;
  ++rebuilds_;
  const SearchedShapes shapes = with_current(updated_);
  octree_ = std::move(octree);
  forget_octree();
  // If memory runs out here, the next update refits the shapes.
  refit(shapes, parallel);
  return true;
}

Vec3d WorldObject::non_finite_position(std::uint32_t vertex) const {
  const Vec3d end = placement_.position(vertex);
  return is_finite(end) ? placement_.start_position(vertex) : end;
}

}  // namespace supple
