#include "scene/object_queries.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include "contact/element_distance.hpp"
#include "contact/ray_triangle.hpp"
#include "contact/triangle_bounds.hpp"
#include "core/float_rounding.hpp"
#include "geometry/exact_predicates.hpp"
#include "geometry/vector.hpp"
#include "narrow_phase/query_kernels.hpp"
#include "scene/feature_name.hpp"
#include "scene/upward_ray.hpp"

namespace supple {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The box of a triangle, in double.
struct CornerBox {
  Vec3d min, max;

  explicit CornerBox(const TrianglePoints& corners) : min(corners[0]), max(corners[0]) {
    for (const Vec3d& corner : corners) {
      for (int axis = 0; axis < 3; ++axis) {
        min[axis] = std::min(min[axis], corner[axis]);
        max[axis] = std::max(max[axis], corner[axis]);
      }
    }
  }
};

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

ElementPoints point_and_triangle(const Vec3d& point, const TrianglePoints& corners) {
  return {{point, corners[0], corners[1], corners[2]}, 1, 3};
}

/// More than the roundings of a point without the translation, and of a translated vertex.
double slop_of(const QueriedObject& object, const Vec3d& point, int axis) {
  const double offset = object.view.translation[axis];
  if (offset == 0) return 0;
  const double largest =
      std::max(std::fabs(double{object.box.min[axis]}), std::fabs(double{object.box.max[axis]}));
  return 0x1p-50 * (std::fabs(point[axis]) + std::fabs(offset) + largest);
}

/// A point as the boxes of an object's octree see it: in single precision, without the translation.
PointBounds seen_by(const QueriedObject& object, const Vec3d& point) {
  PointBounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const double local = point[axis] - object.view.translation[axis], slop = slop_of(object, point, axis);
    bounds.low[axis] = round_down(local - slop);
    bounds.high[axis] = round_up(local + slop);
  }
  return bounds;
}

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

/// The nearest triangle so far.
class NearestTriangle {
 public:
  NearestTriangle(std::span<const QueriedObject> objects, const Vec3d& point, double max_distance,
                  std::vector<NearTriangle>& candidates)
      : objects_(objects), point_(point), max_distance_(max_distance), candidates_(candidates) {
    candidates_.clear();
    set_limit(max_distance);
  }

  /// Triangles farther away than this are not of interest.
  double limit() const { return limit_; }
  /// Its square, rounded up by more than a squared distance in single precision can lose.
  float squared_limit() const { return squared_limit_; }

  /// Triangles in octree order from `begin` on, one for each bit. Keeps those that may be the nearest.
  void consider(std::uint32_t index, std::uint32_t begin, std::uint64_t triangles) {
    std::array<TrianglePair, leaf_block> list;
    std::array<double, leaf_block> lower, upper;
    std::size_t count = 0;
    for (std::uint64_t left = triangles; left != 0; left &= left - 1)
      list[count++] = {begin + static_cast<std::uint32_t>(std::countr_zero(left)), 0};
    if (count == 0) return;
    bound_distances(point_, {objects_[index].view.arrays, objects_[index].view.translation},
                    std::span(list).first(count), lower.data(), upper.data());
    const double least = *std::min_element(upper.begin(), upper.begin() + static_cast<std::ptrdiff_t>(count));
    if (least < limit_) set_limit(least);
    for (std::size_t i = 0; i < count; ++i) {
      if (lower[i] <= limit_) candidates_.push_back({lower[i], index, list[i].a});
    }
  }

  /// Decides between the triangles that were kept. The nearest one first, which discards most of the others.
  void decide() {
    if (candidates_.empty()) return;
    std::swap(candidates_.front(), *std::min_element(candidates_.begin(), candidates_.end(),
                                                     [](const NearTriangle& p, const NearTriangle& q) {
                                                       return p.distance < q.distance;
                                                     }));
    for (const NearTriangle& candidate : candidates_) {
      if (candidate.distance <= limit_) decide(candidate.object, candidate.triangle);
    }
  }

  std::uint32_t object() const { return index_; }
  /// In octree order.
  std::uint32_t triangle() const { return triangle_; }

  std::optional<ClosestPoint> result() const {
    if (!found_) return {};
    return ClosestPoint{
        objects_[index_].id, id_,           found_->on_b, found_->distance, found_->barycentric_b,
        found_->point_b,     found_->normal};
  }

 private:
  void decide(std::uint32_t index, std::uint32_t t) {
    if (found_ && index_ == index && triangle_ == t) return;
    const QueriedObject& object = objects_[index];
    const TrianglePoints corners = object.corners(t);
    const ElementPoints elements = point_and_triangle(point_, corners);
    const auto found = distance_within(elements, limit_, used_exact_);
    if (!found) return;
    const std::uint32_t id = object.triangle_ids[t];
    const FeatureName feature = name_of(found->on_b, object.triangles[t], id);
    if (found_) {
      const bool is_same_feature = index_ == index && feature_ == feature;
      const int side = is_same_feature
                           ? 0
                           : compare_distances(elements, point_and_triangle(point_, corners_), used_exact_);
      if (side > 0 || (side == 0 && std::tie(index_, id_) < std::tie(index, id))) return;
    }
    found_ = found;
    corners_ = corners;
    index_ = index;
    triangle_ = t;
    id_ = id;
    feature_ = feature;
    set_limit(std::min(max_distance_, found->distance * (1 + 0x1p-36) + 0x1p-1060));
  }

  void set_limit(double limit) {
    limit_ = limit;
    squared_limit_ = round_up(limit * limit * (1 + 0x1p-18) + 0x1p-120);
  }

  std::span<const QueriedObject> objects_;
  Vec3d point_;
  double max_distance_, limit_ = 0;
  float squared_limit_ = 0;
  std::vector<NearTriangle>& candidates_;
  std::optional<ElementDistance> found_;
  TrianglePoints corners_;
  std::uint32_t index_ = 0, triangle_ = 0, id_ = 0;
  FeatureName feature_;
  bool used_exact_ = false;
};

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

/// A box, exactly: its points, and the twelve triangles of its faces.
class BoxFaces {
 public:
  explicit BoxFaces(const QueryBox& box) : box_(box) {
    std::array<Vec3d, 8> corners;
    for (std::uint32_t i = 0; i < 8; ++i)
      corners[i] = {(i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                    (i & 4) != 0 ? box.max.z : box.min.z};
    constexpr std::uint8_t faces[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                          {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
    for (std::size_t f = 0; f < 6; ++f) {
      const auto& [a, b, c, d] = faces[f];
      triangles_[2 * f] = {corners[a], corners[b], corners[c]};
      triangles_[2 * f + 1] = {corners[a], corners[c], corners[d]};
    }
  }

  /// Whether the triangle shares a point with the box: a corner inside, or a point on a face.
  bool meet(const TrianglePoints& triangle) const {
    const CornerBox around(triangle);
    for (int axis = 0; axis < 3; ++axis) {
      if (around.min[axis] > box_.max[axis] || around.max[axis] < box_.min[axis]) return false;
    }
    const auto has = [&](const Vec3d& p) {
      return box_.min.x <= p.x && p.x <= box_.max.x && box_.min.y <= p.y && p.y <= box_.max.y &&
             box_.min.z <= p.z && p.z <= box_.max.z;
    };
    return std::any_of(triangle.begin(), triangle.end(), has) ||
           std::any_of(triangles_.begin(), triangles_.end(),
                       [&](const TrianglePoints& face) { return triangles_intersect(face, triangle); });
  }

 private:
  QueryBox box_;
  std::array<TrianglePoints, 12> triangles_;
};

}  // namespace

TrianglePoints QueriedObject::corners(std::uint32_t triangle) const {
  TrianglePoints result;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d p = (*positions)[triangles[triangle][i]];
    result[i] = view.translation == Vec3d{} ? p : p + view.translation;
  }
  return result;
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
  for (; begin < end; begin += leaf_block) {
    const LeafBoxes& boxes =
        recent_.boxes_of(index, object.leaves(), leaf, begin, std::min(begin + leaf_block, end));
    for (std::uint64_t left = chosen(boxes); left != 0; left &= left - 1)
      visit(begin + static_cast<std::uint32_t>(std::countr_zero(left)));
  }
}

void ObjectQueries::start() {
  last_nearest_.reset();
  recent_.clear();
}

std::optional<ClosestPoint> ObjectQueries::closest(std::span<const QueriedObject> objects, const Vec3d& point,
                                                   double max_distance) {
  if (!is_finite(point)) return {};
  NearestTriangle nearest(objects, point, max_distance, candidates_);
  const auto bound_of = [&](const Aabb& box) { return distance_bound(point, box); };
  if (last_nearest_) nearest.consider(last_nearest_->object, last_nearest_->triangle, 1);
  order(objects, bound_of, nearest.limit());
  for (const auto& [object_bound, object_index] : order_) {
    const std::uint32_t index = object_index;
    const QueriedObject& object = objects[index];
    if (!(object_bound <= nearest.limit())) break;
    const PointBounds seen = seen_by(object, point);
    descent_.run(
        object.view,
        [&](std::uint32_t node, std::array<double, node_width>& bounds) {
          std::array<float, node_width> squares;
          squared_distances(seen, object.view.boxes[node], squares);
          std::copy(squares.begin(), squares.end(), bounds.begin());
        },
        [&] { return double{nearest.squared_limit()}; },
        [&](std::uint32_t leaf, std::uint32_t begin, std::uint32_t end) {
          for (; begin < end; begin += leaf_block) {
            const LeafBoxes& boxes =
                recent_.boxes_of(index, object.leaves(), leaf, begin, std::min(begin + leaf_block, end));
            nearest.consider(index, begin, near_triangles(seen, boxes, nearest.squared_limit()));
          }
        });
  }
  nearest.decide();
  const std::optional<ClosestPoint> result = nearest.result();
  if (result) last_nearest_ = {0, nearest.object(), nearest.triangle()};
  return result;
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
    descent_.run(
        object.view,
        [&](std::uint32_t node, std::array<double, node_width>& bounds) {
          ray_bounds(slabs, object.view.boxes[node], bounds);
        },
        [&] { return limit; },
        [&](std::uint32_t leaf, std::uint32_t first, std::uint32_t end) {
          const auto on_ray = [&](const LeafBoxes& boxes) { return triangles_on_ray(slabs, boxes, limit); };
          visit_leaf(index, object, leaf, first, end, on_ray, [&](std::uint32_t t) {
            if (const auto parameter = RayParameter::find(ray, object.corners(t), used_exact))
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
    if (!count_hits) limit = std::min(any, found.parameter.rounded() * (1 + 0x1p-45) + 0x1p-1060);
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
void ObjectQueries::visit_overlapping(std::uint32_t index, const QueriedObject& object, const Aabb& box,
                                      const Visit& visit) {
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
  UpwardRay ray(point);
  const PointBounds seen = seen_by(object, point);
  Aabb column{seen.low, seen.high};
  column.max.z = std::numeric_limits<float>::infinity();
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
    const Aabb seen{seen_by(object, box.min).low, seen_by(object, box.max).high};
    visit_overlapping(index, object, seen, [&](std::uint32_t t) {
      if (faces.meet(object.corners(t))) found.push_back({query, object.id, object.triangle_ids[t]});
    });
  }
}

void ObjectQueries::overlaps(std::span<const QueriedObject> objects, const QuerySphere& sphere,
                             std::uint32_t query, std::vector<Overlap>& found) {
  if (!is_finite(sphere.center) || !std::isfinite(sphere.radius) || !(sphere.radius >= 0)) return;
  const Vec3d reach{sphere.radius, sphere.radius, sphere.radius};
  bool used_exact = false;
  for (std::uint32_t index = 0; index < objects.size(); ++index) {
    const QueriedObject& object = objects[index];
    // The floats round by more than the sums in double.
    Aabb seen{seen_by(object, sphere.center - reach).low, seen_by(object, sphere.center + reach).high};
    for (int axis = 0; axis < 3; ++axis) {
      seen.min[axis] =
          round_down(double{seen.min[axis]} - 0x1p-50 * (std::fabs(sphere.center[axis]) + sphere.radius));
      seen.max[axis] =
          round_up(double{seen.max[axis]} + 0x1p-50 * (std::fabs(sphere.center[axis]) + sphere.radius));
    }
    visit_overlapping(index, object, seen, [&](std::uint32_t t) {
      if (distance_within(point_and_triangle(sphere.center, object.corners(t)), sphere.radius, used_exact,
                          DistanceAccuracy::rough))
        found.push_back({query, object.id, object.triangle_ids[t]});
    });
  }
}

}  // namespace supple
