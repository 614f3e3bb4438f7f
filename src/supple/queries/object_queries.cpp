#include "queries/object_queries.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include "contact/distance/axis_ray.hpp"
#include "contact/distance/element_distance.hpp"
#include "contact/distance/ray_triangle.hpp"
#include "core/float_rounding.hpp"
#include "geometry/vector.hpp"
#include "narrow_phase/query_kernels.hpp"
#include "queries/box_faces.hpp"
#include "queries/nearest_triangle.hpp"
#include "queries/ray_line.hpp"
#include "queries/support_plane.hpp"

namespace supple {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// At most the distance of a point and a box.
template <class Box>
double distance_bound(const Vec3d& point, const Box& box) {
  constexpr double down = 1 - 0x1p-50;
  double sum = 0, largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max({box.min[axis] - point[axis], point[axis] - box.max[axis], 0.0});
    sum += gap * gap;
    largest = std::max(largest, gap);
  }
  return down * (sum < infinity ? std::sqrt(sum) : largest);
}

/// At most the first parameter at which a ray is in a box; infinite when it misses the box.
template <class Box>
double ray_bound(const Ray& ray, const Box& box) {
  // Widened by more than the roundings of a difference and a quotient.
  const auto below = [](double t) { return t * (t > 0 ? 1 - 0x1p-50 : 1 + 0x1p-50) - 0x1p-1060; };
  const auto above = [](double t) { return t * (t > 0 ? 1 + 0x1p-50 : 1 - 0x1p-50) + 0x1p-1060; };
  double first = 0, last = infinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis], origin = ray.origin[axis],
                 direction = ray.direction[axis];
    if (direction == 0) {
      if (origin < low || origin > high) return infinity;
      continue;
    }
    const double enter = ((direction > 0 ? low : high) - origin) / direction,
                 leave = ((direction > 0 ? high : low) - origin) / direction;
    first = std::max(first, below(enter));
    last = std::min(last, above(leave));
  }
  return first <= last ? std::min(first, std::numeric_limits<double>::max()) : infinity;
}

/// Finite; where the box is too large for floats, the origin.
Vec3d middle_of(const QueriedObject& object) {
  Vec3d middle;
  for (int axis = 0; axis < 3; ++axis)
    middle[axis] = (double{object.box.min[axis]} + double{object.box.max[axis]}) / 2;
  return is_finite(middle) ? middle : Vec3d{};
}

/// More than the roundings of a point without the translation, and of a translated vertex.
double slop_of(const QueriedObject& object, const Vec3d& point, int axis) {
  const double offset = object.view.translation[axis];
  if (offset == 0) return 0;
  const double largest =
      std::max(std::fabs(double{object.box.min[axis]}), std::fabs(double{object.box.max[axis]}));
  return 0x1p-50 * (std::fabs(point[axis]) + std::fabs(offset) + largest);
}

}  // namespace

Aabb seen_by(const QueriedObject& object, const Vec3d& point) {
  Aabb bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const double local = point[axis] - object.view.translation[axis], slop = slop_of(object, point, axis);
    bounds.min[axis] = round_down(local - slop);
    bounds.max[axis] = round_up(local + slop);
  }
  return bounds;
}

namespace {

/// A ray as the boxes of an object's octree see it: without the translation.
RaySlabs slabs_of(const QueriedObject& object, const Ray& ray) {
  constexpr double smallest = 0x1p-1000, largest = 0x1p1000;
  RaySlabs slabs;
  for (int axis = 0; axis < 3; ++axis) {
    const double offset = object.view.translation[axis], local = ray.origin[axis] - offset;
    const double slop = slop_of(object, ray.origin, axis);
    slabs.low[axis] = local - slop;
    slabs.high[axis] = local + slop;
    const double size = std::fabs(ray.direction[axis]);
    slabs.is_parallel[static_cast<std::size_t>(axis)] = size == 0;
    slabs.is_unlimited[static_cast<std::size_t>(axis)] = size != 0 && !(size >= smallest && size <= largest);
    slabs.reciprocal[axis] = 1 / ray.direction[axis];
  }
  return slabs;
}

/// The square of a lower bound of a distance, rounded down.
double squared_bound(double distance) {
  return distance * distance * (1 - 0x1p-50);
}

/// By the place on the ray, then by object and triangle.
bool is_before(const TriangleOnRay& p, const TriangleOnRay& q) {
  bool used_exact = false;
  const int side = p.parameter.compare(q.parameter, used_exact);
  return side != 0 ? side < 0 : std::tie(p.object, p.id) < std::tie(q.object, q.id);
}

RayHit hit_of(ObjectId object, const Ray& ray, const TriangleOnRay& found, std::uint64_t hits) {
  const double t = found.parameter.rounded();
  RayHit hit{object, found.id, t, ray.origin + t * ray.direction, {}, hits};
  if (is_finite(hit.point)) {
    bool used_exact = false;
    const ElementPoints elements = point_and_triangle(hit.point, found.parameter.triangle());
    hit.barycentric = distance_within(elements, infinity, used_exact, DistanceAccuracy::rough)->barycentric_b;
  }
  return hit;
}

}  // namespace

bool is_far(const Aabb& box, double distance, double ratio) {
  const double size =
      std::max({double{box.max.x} - box.min.x, double{box.max.y} - box.min.y, double{box.max.z} - box.min.z});
  return distance > ratio * size;
}

TrianglePoints QueriedObject::corners(std::uint32_t triangle) const {
  TrianglePoints result;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d p = (*positions)[triangles[triangle][i]];
    result[i] = view.translation == Vec3d{} ? p : p + view.translation;
  }
  return result;
}

QueryBox QueriedObject::child_box(std::uint32_t node, int child) const {
  QueryBox result;
  if (fine_boxes != nullptr) {
    result = fine_boxes[node_width * node + static_cast<std::uint32_t>(child)];
  } else {
    const Aabb rounded = supple::child_box(view.boxes[node], child);
    result = {{rounded.min.x, rounded.min.y, rounded.min.z}, {rounded.max.x, rounded.max.y, rounded.max.z}};
  }
  // Vertices are placed with the same rounding, which is monotonic.
  return {result.min + view.translation, result.max + view.translation};
}

/// Writes squares of lower bounds of the distances of the point and the children; NaN for those behind the
/// plane, if there is one.
void ObjectQueries::bound_children(const QueriedObject& object, std::uint32_t node, const Vec3d& point,
                                   const Aabb& seen, const NearestTriangle& nearest,
                                   std::array<double, node_width>& bounds) {
  std::array<float, node_width> squares;
  squared_distances(seen, object.view.boxes[node], squares);
  std::copy(squares.begin(), squares.end(), bounds.begin());
  if (!nearest.has_plane() && object.fine_boxes == nullptr) return;
  for (int child = 0; child < object.view.nodes[node].child_count; ++child) {
    double& bound = bounds[static_cast<std::size_t>(child)];
    const QueryBox box = object.child_box(node, child);
    if (object.fine_boxes != nullptr) bound = squared_bound(distance_bound(point, box));
    if (nearest.has_plane() && nearest.is_behind(box)) bound = std::numeric_limits<double>::quiet_NaN();
  }
}

/// A triangle that is nearly the first one in the direction from the point, in octree order; none when all
/// are inert.
std::optional<std::uint32_t> ObjectQueries::frontmost_triangle(const QueriedObject& object,
                                                               const Vec3d& point) {
  SupportPlane plane;
  plane.origin = middle_of(object);
  const Vec3d way = plane.origin - point;
  plane.normal = way / scaled_norm(way);
  std::uint32_t node = 0;
  for (;;) {
    int first = -1;
    double least = infinity;
    for (int child = 0; child < object.view.nodes[node].child_count; ++child) {
      if (supple::child_box(object.view.boxes[node], child).empty()) continue;
      const double depth = plane.depth(object.child_box(node, child));
      if (first < 0 || depth < least) std::tie(least, first) = std::tuple(depth, child);
    }
    if (first < 0) return {};
    const OctreeNode& found = object.view.nodes[node];
    if (found.is_inner(first)) {
      node = found.child_node(first);
      continue;
    }
    std::optional<std::uint32_t> triangle;
    least = infinity;
    for (std::uint32_t t = found.first_triangle[first]; t < found.first_triangle[first + 1]; ++t) {
      if (object.view.arrays.inert != nullptr && object.view.arrays.inert[t] != 0) continue;
      if (!triangle) triangle = t;
      for (const Vec3d& corner : object.corners(t)) {
        const double depth = plane.depth(corner);
        if (depth < least) std::tie(least, triangle) = std::tuple(depth, t);
      }
    }
    return triangle;
  }
}

template <class BoundOf>
void ObjectQueries::order(std::span<const QueriedObject> objects, const BoundOf& bound_of, double limit) {
  order_.clear();
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    if (objects[i].box.empty()) continue;
    const double bound = bound_of(objects[i].box);
    if (bound <= limit) order_.emplace_back(bound, i);
  }
  std::sort(order_.begin(), order_.end());
}

/// Calls `visit` with the triangles of a leaf that `chosen(boxes)` has, in octree order.
template <class Chosen, class Visit>
void ObjectQueries::visit_leaf(std::uint32_t index, const QueriedObject& object, std::uint32_t leaf,
                               std::uint32_t begin, std::uint32_t end, const Chosen& chosen,
                               const Visit& visit) {
  for (; begin < end && !stop_.stop_requested(); begin += leaf_block) {
    const LeafBoxes& boxes = recent_.block_of(index, object.leaves(), leaf, begin,
                                              std::min(begin + leaf_block, end), load_leaf_boxes);
    for (std::uint64_t left = chosen(boxes); left != 0; left &= left - 1)
      visit(begin + static_cast<std::uint32_t>(std::countr_zero(left)));
  }
}

void ObjectQueries::start(const StopSignal& stop) {
  stop_ = stop;
  last_nearest_.reset();
  recent_.clear();
  recent_corners_.clear();
}

std::optional<FoundTriangle> ObjectQueries::nearest(std::span<const QueriedObject> objects,
                                                    const Vec3d& point, double max_distance) {
  if (!is_finite(point)) return {};
  candidates_.clear();
  NearestTriangle nearest(objects, point, max_distance, stop_, candidates_, block_);
  const auto bound_of = [&](const Aabb& box) { return distance_bound(point, box); };
  if (last_nearest_) nearest.limit_to(last_nearest_->corners);
  order(objects, bound_of, nearest.limit());
  for (const auto& [object_bound, object_index] : order_) {
    const std::uint32_t index = object_index;
    const QueriedObject& object = objects[index];
    if (!(object_bound <= nearest.limit())) break;
    const Aabb seen = seen_by(object, point);
    // Distances in single precision hardly tell its triangles apart, so the search needs a plane.
    if (is_far(object.box, object_bound, far_ratio)) {
      const std::optional<std::uint32_t> first = frontmost_triangle(object, point);
      if (!first) continue;
      nearest.decide(index, *first, FeatureCode::unknown);
      // The triangle of the query before was nearer than the frontmost one.
      if (!nearest.has_plane() && last_nearest_) {
        nearest.consider(last_nearest_->object, last_nearest_->triangle, 1);
        nearest.find_plane();
      }
    }
    descent_.run(
        object.view,
        [&](std::uint32_t node, std::array<double, node_width>& bounds) {
          bound_children(object, node, point, seen, nearest, bounds);
        },
        [&] { return stop_.stop_requested() ? -1 : double{nearest.squared_limit()}; },
        [&](std::uint32_t leaf, std::uint32_t begin, std::uint32_t end) {
          for (; begin < end; begin += leaf_block) {
            const LeafBoxes& boxes = recent_.block_of(index, object.leaves(), leaf, begin,
                                                      std::min(begin + leaf_block, end), load_leaf_boxes);
            nearest.consider(index, begin, near_triangles(seen, boxes, nearest.squared_limit()));
          }
        });
  }
  nearest.decide(true);
  decided_ += nearest.decided();
  bounded_ += nearest.bounded();
  if (nearest.found()) last_nearest_ = nearest.found();
  return nearest.found();
}

/// Calls `visit(hit)` with the triangles on the ray up to `limit`, which may decrease.
template <class Visit>
void ObjectQueries::visit_triangles_on_ray(std::span<const QueriedObject> objects, const Ray& ray,
                                           const double& limit, const Visit& visit) {
  if (!is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == Vec3d{}) return;
  bool used_exact = false;
  order(
      objects, [&](const auto& box) { return ray_bound(ray, box); }, limit);
  for (const auto& [object_bound, object_index] : order_) {
    const std::uint32_t index = object_index;
    const QueriedObject& object = objects[index];
    if (!(object_bound <= limit)) break;
    const RaySlabs slabs = slabs_of(object, ray);
    std::optional<RayLine> line;  // where slabs of boxes are too rough
    const double distance = object_bound * scaled_norm(ray.direction);
    if (object.fine_boxes != nullptr || is_far(object.box, distance, 0x1p16))
      line.emplace(ray, middle_of(object));
    descent_.run(
        object.view,
        [&](std::uint32_t node, std::array<double, node_width>& bounds) {
          ray_bounds(slabs, object.view.boxes[node], bounds);
          for (int child = 0; line && child < object.view.nodes[node].child_count; ++child) {
            const QueryBox box = object.child_box(node, child);
            double& bound = bounds[static_cast<std::size_t>(child)];
            bound = line->misses(box) ? infinity : std::max(bound, ray_bound(ray, box));
          }
        },
        [&] { return stop_.stop_requested() ? -1 : limit; },
        [&](std::uint32_t leaf, std::uint32_t first, std::uint32_t end) {
          const auto on_ray = [&](const LeafBoxes& boxes) { return triangles_on_ray(slabs, boxes, limit); };
          visit_leaf(index, object, leaf, first, end, on_ray, [&](std::uint32_t t) {
            const TrianglePoints corners = object.corners(t);
            if (line && line->misses(box_around(corners))) return;
            ++decided_;
            if (const auto parameter = RayParameter::find(ray, corners, used_exact))
              visit(TriangleOnRay{*parameter, index, object.triangle_ids[t]});
          });
        });
  }
}

std::optional<RayHit> ObjectQueries::cast(std::span<const QueriedObject> objects, const Ray& ray,
                                          bool count_hits) {
  std::optional<TriangleOnRay> best;
  constexpr double any = std::numeric_limits<double>::max();
  double limit = any;
  std::uint64_t hits = 0;
  visit_triangles_on_ray(objects, ray, limit, [&](const TriangleOnRay& found) {
    ++hits;
    if (best && !is_before(found, *best)) return;
    best = found;
    if (!count_hits) limit = std::min(any, found.parameter.upper_bound());
  });
  if (!best) return {};
  return hit_of(objects[best->object].id, ray, *best, count_hits ? hits : 1);
}

void ObjectQueries::cast_all(std::span<const QueriedObject> objects, const Ray& ray, std::uint32_t query,
                             std::vector<ListedRayHit>& found) {
  constexpr double any = std::numeric_limits<double>::max();
  on_ray_.clear();
  visit_triangles_on_ray(objects, ray, any,
                         [&](const TriangleOnRay& triangle) { on_ray_.push_back(triangle); });
  std::sort(on_ray_.begin(), on_ray_.end(), is_before);
  for (const TriangleOnRay& triangle : on_ray_)
    found.push_back({query, hit_of(objects[triangle.object].id, ray, triangle, on_ray_.size())});
}

template <class Visit>
void ObjectQueries::visit_overlapping(std::uint32_t index, const QueriedObject& object,
                                      const QueryBox& region, const Visit& visit) {
  const Aabb box{seen_by(object, region.min).min, seen_by(object, region.max).max};
  const auto chosen = [&](const LeafBoxes& boxes) { return overlapping_triangles(box, boxes); };
  nodes_.clear();
  if (!object.view.nodes.empty()) nodes_.push_back(0);
  while (!nodes_.empty()) {
    const std::uint32_t number = nodes_.back();
    const OctreeNode& node = object.view.nodes[number];
    nodes_.pop_back();
    const std::uint32_t children = (1u << node.child_count) - 1;
    for (std::uint32_t left = overlapping_children(box, object.view.boxes[number]) & children; left != 0;
         left &= left - 1) {
      const int child = std::countr_zero(left);
      if (object.fine_boxes != nullptr && are_apart(object.child_box(number, child), region)) continue;
      if (node.is_inner(child)) {
        nodes_.push_back(node.child_node(child));
      } else {
        visit_leaf(index, object, node_width * number + static_cast<std::uint32_t>(child),
                   node.first_triangle[child], node.first_triangle[child + 1], chosen, visit);
      }
    }
  }
}

Containment ObjectQueries::inside(std::uint32_t index, const QueriedObject& object, const Vec3d& point) {
  if (!is_finite(point)) return Containment::outside;
  AxisRay ray(point);
  const QueryBox column{point, {point.x, point.y, infinity}};
  visit_overlapping(index, object, column, [&](std::uint32_t t) { ray.meet(object.corners(t)); });
  if (ray.starts_on_surface()) return Containment::on;
  return ray.is_odd() && !object.has_inert_faces ? Containment::inside : Containment::outside;
}

void ObjectQueries::overlaps(std::span<const QueriedObject> objects, const QueryBox& box, std::uint32_t query,
                             std::vector<Overlap>& found) {
  if (!is_finite(box.min) || !is_finite(box.max)) return;
  if (box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z) return;
  const BoxFaces faces(box);
  for (std::uint32_t index = 0; index < objects.size(); ++index) {
    const QueriedObject& object = objects[index];
    visit_overlapping(index, object, box, [&](std::uint32_t t) {
      if (faces.meet(object.corners(t))) found.push_back({query, object.id, object.triangle_ids[t]});
    });
  }
}

void ObjectQueries::overlaps(std::span<const QueriedObject> objects, const QuerySphere& sphere,
                             std::uint32_t query, std::vector<Overlap>& found) {
  if (!is_finite(sphere.center) || !std::isfinite(sphere.radius) || !(sphere.radius >= 0)) return;
  // More than the roundings of a sum.
  QueryBox around;
  for (int axis = 0; axis < 3; ++axis) {
    const double center = sphere.center[axis], slack = 0x1p-50 * (std::fabs(center) + sphere.radius);
    around.min[axis] = center - sphere.radius - slack;
    around.max[axis] = center + sphere.radius + slack;
  }
  bool used_exact = false;
  for (std::uint32_t index = 0; index < objects.size(); ++index) {
    const QueriedObject& object = objects[index];
    visit_overlapping(index, object, around, [&](std::uint32_t t) {
      if (distance_within(point_and_triangle(sphere.center, object.corners(t)), sphere.radius, used_exact,
                          DistanceAccuracy::rough))
        found.push_back({query, object.id, object.triangle_ids[t]});
    });
  }
}

}  // namespace supple
