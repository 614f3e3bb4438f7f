#include "scene/object_queries.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include "contact/element_distance.hpp"
#include "contact/ray_triangle.hpp"
#include "core/float_rounding.hpp"
#include "geometry/exact_predicates.hpp"
#include "geometry/vector.hpp"
#include "scene/feature_name.hpp"

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

/// 0 when the upward line from the point meets the box, otherwise infinite.
template <class Box>
double column_bound(const Vec3d& point, const Box& box) {
  const bool meets = box.min[0] <= point.x && point.x <= box.max[0] && box.min[1] <= point.y &&
                     point.y <= box.max[1] && point.z <= box.max[2];
  return meets ? 0 : infinity;
}

ElementPoints point_and_triangle(const Vec3d& point, const TrianglePoints& corners) {
  return {{point, corners[0], corners[1], corners[2]}, 1, 3};
}

/// About the point of a triangle that is closest to the origin; any point for a triangle almost without area.
///
/// Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
Vec3d rough_closest(const TrianglePoints& c) {
  const Vec3d u = c[1] - c[0], v = c[2] - c[0];
  const double u0 = -dot(u, c[0]), v0 = -dot(v, c[0]);
  if (u0 <= 0 && v0 <= 0) return c[0];
  const double u1 = -dot(u, c[1]), v1 = -dot(v, c[1]);
  if (u1 >= 0 && v1 <= u1) return c[1];
  const double u2 = -dot(u, c[2]), v2 = -dot(v, c[2]);
  if (v2 >= 0 && u2 <= v2) return c[2];
  const double on_w = u0 * v1 - u1 * v0, on_v = u2 * v0 - u0 * v2, on_u = u1 * v2 - u2 * v1;
  if (on_w <= 0 && u0 >= 0 && u1 <= 0) return c[0] + (u0 / (u0 - u1)) * u;
  if (on_v <= 0 && v0 >= 0 && v2 <= 0) return c[0] + (v0 / (v0 - v2)) * v;
  if (on_u <= 0 && v1 >= u1 && u2 >= v2) {
    const double along = v1 - u1;
    return c[1] + (along / (along + (u2 - v2))) * (c[2] - c[1]);
  }
  const double whole = on_u + on_v + on_w;
  return c[0] + (on_v / whole) * u + (on_w / whole) * v;
}

/// At most the distance of a point and a triangle, and almost always nearly that: the distance of a plane
/// beyond which the triangle lies. 0 where rounding leaves nothing certain.
double plane_bound(const Vec3d& point, const TrianglePoints& corners) {
  const TrianglePoints seen{corners[0] - point, corners[1] - point, corners[2] - point};
  const Vec3d normal = rough_closest(seen);
  const double square = dot(normal, normal);
  const double farthest = std::max({dot(seen[0], seen[0]), dot(seen[1], seen[1]), dot(seen[2], seen[2])});
  if (!(square > 0x1p-900 && farthest < 0x1p900)) return 0;
  const double least = std::min({dot(seen[0], normal), dot(seen[1], normal), dot(seen[2], normal)});
  // A product of vectors has a rounding error below 2^-50 of the product of their lengths.
  return std::max(0.0, least / std::sqrt(square) - 0x1p-48 * std::sqrt(farthest));
}

/// A point as the boxes of an object's triangles see it: single precision, without the translation.
class PointInFloats {
 public:
  PointInFloats(const Vec3d& point, const QueriedObject& object) {
    for (int axis = 0; axis < 3; ++axis) {
      const double offset = object.view.translation[axis], local = point[axis] - offset;
      // More than the roundings of `local` and of a translated vertex.
      const double largest =
          std::max(std::fabs(double{object.box.min[axis]}), std::fabs(double{object.box.max[axis]}));
      const double slop = offset == 0 ? 0 : 0x1p-50 * (std::fabs(point[axis]) + std::fabs(offset) + largest);
      low_[axis] = round_down(local - slop);
      high_[axis] = round_up(local + slop);
    }
  }

  /// Squared distances of the boxes. At most those of the triangles, but for the roundings that
  /// `NearestTriangle::squared_limit` covers.
  void squared_distances(const LeafBoxes& boxes, std::array<float, leaf_block>& squares) const {
    for (std::size_t i = 0; i < leaf_block; ++i) {
      const float x = std::max(std::max(boxes.min_x[i] - high_.x, low_.x - boxes.max_x[i]), 0.0f);
      const float y = std::max(std::max(boxes.min_y[i] - high_.y, low_.y - boxes.max_y[i]), 0.0f);
      const float z = std::max(std::max(boxes.min_z[i] - high_.z, low_.z - boxes.max_z[i]), 0.0f);
      squares[i] = x * x + y * y + z * z;
    }
  }

 private:
  Vec3f low_, high_;
};

/// The nearest triangle so far.
class NearestTriangle {
 public:
  NearestTriangle(std::span<const QueriedObject> objects, const Vec3d& point, double max_distance)
      : objects_(objects), point_(point), max_distance_(max_distance) {
    set_limit(max_distance);
  }

  /// Triangles farther away than this are not of interest.
  double limit() const { return limit_; }
  /// Its square, rounded up by more than a squared distance in single precision can lose.
  float squared_limit() const { return squared_limit_; }

  /// Triangles in octree order from `begin` on, one for each bit.
  void consider(std::uint32_t index, std::uint32_t begin, std::uint64_t triangles) {
    std::array<double, leaf_block> bounds;
    std::uint32_t first = leaf_block;
    for (std::uint64_t left = triangles; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      bounds[i] = plane_bound(point_, objects_[index].corners(begin + i));
      if (first == leaf_block || bounds[i] < bounds[first]) first = i;
    }
    // The nearest one first, which discards most of the others.
    if (first != leaf_block && bounds[first] <= limit_) consider(index, begin + first);
    for (std::uint64_t left = triangles; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      if (i != first && bounds[i] <= limit_) consider(index, begin + i);
    }
  }

  std::optional<ClosestPoint> result() const {
    if (!found_) return {};
    return ClosestPoint{
        objects_[index_].id, id_,           found_->on_b, found_->distance, found_->barycentric_b,
        found_->point_b,     found_->normal};
  }

 private:
  void consider(std::uint32_t index, std::uint32_t t) {
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
    id_ = id;
    feature_ = feature;
    set_limit(std::min(max_distance_, found->distance * (1 + 0x1p-49) + 0x1p-1060));
  }

  void set_limit(double limit) {
    limit_ = limit;
    squared_limit_ = round_up(limit * limit * (1 + 0x1p-18) + 0x1p-120);
  }

  std::span<const QueriedObject> objects_;
  Vec3d point_;
  double max_distance_, limit_ = 0;
  float squared_limit_ = 0;
  std::optional<ElementDistance> found_;
  TrianglePoints corners_;
  std::uint32_t index_ = 0, id_ = 0;
  FeatureName feature_;
  bool used_exact_ = false;
};

/// The turn of a, b and the point in the x-y plane, where the point is moved by (e, e²) for an infinitely
/// small e > 0. 0 only when a and b have equal x and y.
int turn_beside(const Vec3d& a, const Vec3d& b, const Vec3d& point, bool& used_exact) {
  if (const int turn = orient2d(a, b, point, 2, used_exact)) return turn;
  if (a.y != b.y) return a.y > b.y ? 1 : -1;
  return (b.x > a.x) - (b.x < a.x);
}

/// Whether a ray from beside the point, straight up, crosses the triangle, which does not contain the point.
bool crosses_above(const TrianglePoints& corners, const Vec3d& point, bool& used_exact) {
  const int turn = turn_beside(corners[0], corners[1], point, used_exact);
  if (turn == 0 || turn_beside(corners[1], corners[2], point, used_exact) != turn ||
      turn_beside(corners[2], corners[0], point, used_exact) != turn)
    return false;
  return orient3d(corners[0], corners[1], corners[2], point, used_exact) * turn < 0;
}

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

std::optional<ClosestPoint> ObjectQueries::closest(std::span<const QueriedObject> objects, const Vec3d& point,
                                                   double max_distance) {
  if (!is_finite(point)) return {};
  NearestTriangle nearest(objects, point, max_distance);
  const auto bound_of = [&](const Aabb& box) { return distance_bound(point, box); };
  order(objects, bound_of, max_distance);
  for (const auto& [object_bound, index] : order_) {
    const QueriedObject& object = objects[index];
    if (!(object_bound <= nearest.limit())) break;
    const LeafArrays leaves{object.view.arrays, object.view.boxes, object.view.leaf_vertices};
    const PointInFloats seen(point, object);
    descent_.run(
        object.view, bound_of, [&] { return nearest.limit(); },
        [&](std::uint32_t leaf, std::uint32_t begin, std::uint32_t end) {
          for (; begin < end; begin += leaf_block) {
            load_leaf_boxes(leaves, leaf, begin, std::min(begin + leaf_block, end), boxes_);
            seen.squared_distances(boxes_, squares_);
            std::uint64_t near = 0;
            for (std::uint32_t i = 0; i < boxes_.size; ++i)
              near |= std::uint64_t{squares_[i] <= nearest.squared_limit()} << i;
            nearest.consider(index, begin, near & boxes_.triangles);
          }
        });
  }
  return nearest.result();
}

std::optional<RayHit> ObjectQueries::cast(std::span<const QueriedObject> objects, const Ray& ray,
                                          bool count_hits) {
  if (!is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == Vec3d{}) return {};
  struct Best {
    RayParameter parameter;
    TrianglePoints corners;
    double t = 0;
    std::uint32_t object = 0, id = 0;
  };
  std::optional<Best> best;
  constexpr double any = std::numeric_limits<double>::max();
  double limit = any;
  std::uint64_t hits = 0;
  bool used_exact = false;
  const auto bound_of = [&](const auto& box) { return ray_bound(ray, box); };
  order(objects, bound_of, limit);
  for (const auto& [object_bound, index] : order_) {
    const QueriedObject& object = objects[index];
    if (!(object_bound <= limit)) break;
    descent_.run(
        object.view, bound_of, [&] { return limit; },
        [&](std::uint32_t, std::uint32_t begin, std::uint32_t end) {
          for (std::uint32_t t = begin; t < end; ++t) {
            if (object.is_inert(t)) continue;
            const TrianglePoints corners = object.corners(t);
            if (!(bound_of(CornerBox(corners)) <= limit)) continue;
            const auto parameter = RayParameter::find(ray, corners, used_exact);
            if (!parameter) continue;
            ++hits;
            const std::uint32_t id = object.triangle_ids[t];
            if (best) {
              const int side = parameter->compare(best->parameter, used_exact);
              if (side > 0 || (side == 0 && std::tie(best->object, best->id) < std::tie(index, id))) continue;
            }
            best = {*parameter, corners, parameter->rounded(), index, id};
            if (!count_hits) limit = std::min(any, best->t * (1 + 0x1p-45) + 0x1p-1060);
          }
        });
  }
  if (!best) return {};
  RayHit hit{objects[best->object].id, best->id, best->t, ray.origin + best->t * ray.direction, {},
             count_hits ? hits : 1};
  if (is_finite(hit.point)) {
    const ElementPoints elements = point_and_triangle(hit.point, best->corners);
    hit.barycentric = distance_within(elements, infinity, used_exact, DistanceAccuracy::rough)->barycentric_b;
  }
  return hit;
}

Containment ObjectQueries::inside(const QueriedObject& object, const Vec3d& point) {
  bool is_on = false, is_inside = false, used_exact = false;
  const auto bound_of = [&](const auto& box) { return column_bound(point, box); };
  descent_.run(
      object.view, bound_of, [&] { return is_on ? -1.0 : 0.0; },
      [&](std::uint32_t, std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t t = begin; t < end && !is_on; ++t) {
          if (object.is_inert(t)) continue;
          const TrianglePoints corners = object.corners(t);
          const CornerBox box(corners);
          if (bound_of(box) > 0) continue;
          if (box.min.z <= point.z)
            is_on = distance_within(point_and_triangle(point, corners), 0, used_exact).has_value();
          if (!is_on && crosses_above(corners, point, used_exact)) is_inside = !is_inside;
        }
      });
  if (is_on) return Containment::on;
  return is_inside && object.view.arrays.inert == nullptr ? Containment::inside : Containment::outside;
}

Containment ObjectQueries::inside(std::span<const QueriedObject> objects, const Vec3d& point) {
  Containment result = Containment::outside;
  if (!is_finite(point)) return result;
  order(
      objects, [&](const Aabb& box) { return column_bound(point, box); }, 0);
  for (const auto& [bound, index] : order_) {
    result = std::max(result, inside(objects[index], point));
    if (result == Containment::inside) break;
  }
  return result;
}

}  // namespace supple
