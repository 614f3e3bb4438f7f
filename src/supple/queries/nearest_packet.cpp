// The nearest triangles of several points at once: bounds decide for nearly all of them.

#include <algorithm>
#include <bit>
#include <cmath>

#include "contact/intersection/triangle_bounds.hpp"
#include "core/float_rounding.hpp"
#include "geometry/vector.hpp"
#include "queries/nearest_triangle.hpp"
#include "queries/object_queries.hpp"

namespace supple {
namespace {

void load_leaf_corners(const QueriedObject& object, std::uint32_t, std::uint32_t begin, std::uint32_t end,
                       LeafCorners& leaf) {
  leaf.size = end - begin;
  QueryBox box = no_box();
  Vec3d area;
  for (std::uint32_t i = 0; i < leaf.size; ++i) {
    const bool is_inert = object.view.arrays.inert != nullptr && object.view.arrays.inert[begin + i] != 0;
    TrianglePoints rounded;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d corner = (*object.positions)[object.triangles[begin + i][k]];
      for (int axis = 0; axis < 3; ++axis) {
        float& x = leaf.corners[k][axis][i];
        x = static_cast<float>(is_inert ? std::numeric_limits<double>::infinity() : corner[axis]);
        rounded[k][axis] = double{x};
      }
    }
    const double edge =
        std::max({squared_norm(rounded[1] - rounded[0]), squared_norm(rounded[2] - rounded[1]),
                  squared_norm(rounded[0] - rounded[2])});
    leaf.spread[i] = is_inert ? 0 : round_up(edge * (1.0 / 3 + 0x1p-40));
    if (is_inert) continue;
    for (const Vec3d& corner : rounded) extend(box, corner, corner);
    area += cross(rounded[1] - rounded[0], rounded[2] - rounded[0]);
  }
  const Vec3d middle = 0.5 * (box.min + box.max), axis = normalized(area);
  leaf.middle = {static_cast<float>(middle.x), static_cast<float>(middle.y), static_cast<float>(middle.z)};
  leaf.axis = {static_cast<float>(axis.x), static_cast<float>(axis.y), static_cast<float>(axis.z)};
  double height = 0, squared_radius = 0;
  for (std::uint32_t i = 0; i < leaf.size; ++i) {
    for (const auto& corner : leaf.corners) {
      if (std::isinf(corner[0][i])) continue;
      const Vec3d way{double{corner[0][i]} - double{leaf.middle.x},
                      double{corner[1][i]} - double{leaf.middle.y},
                      double{corner[2][i]} - double{leaf.middle.z}};
      const double along =
          way.x * double{leaf.axis.x} + way.y * double{leaf.axis.y} + way.z * double{leaf.axis.z};
      height = std::max(height, std::fabs(along));
      squared_radius = std::max(squared_radius, squared_norm(way) - along * along * (1 - 0x1p-20));
    }
  }
  leaf.height = round_up(height * (1 + 0x1p-20));
  leaf.radius = round_up(std::sqrt(squared_radius) * (1 + 0x1p-20));
}

}  // namespace

/// Bounds the distances of the triangles of an object that may be the nearest ones. Returns false where
/// single precision does not suffice.
bool ObjectQueries::bound_triangles(const QueriedObject& object, std::span<const Vec3d> points,
                                    std::span<double> limits) {
  constexpr double largest = 0x1p60;
  constexpr std::size_t most = 64 * PointPacket::capacity;
  PointPacket packet;
  double size = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double offset = object.view.translation[axis];
    size = std::max({size, std::fabs(double{object.box.min[axis]}), std::fabs(double{object.box.max[axis]}),
                     std::fabs(offset)});
    for (std::size_t k = 0; k < PointPacket::capacity; ++k) {
      const double x = points[std::min(k, points.size() - 1)][axis];
      size = std::max(size, std::fabs(x));
      packet.points[axis][k] = static_cast<float>(x - offset);
    }
  }
  const bool are_finite =
      std::all_of(points.begin(), points.end(), [](const Vec3d& p) { return is_finite(p); });
  if (!are_finite || !(size < largest) || object.fine_boxes != nullptr) return false;
  packet.slack = static_cast<float>(0x1p-20 * size + 0x1p-60);
  for (std::size_t k = 0; k < PointPacket::capacity; ++k) {
    const double limit = limits[std::min(k, points.size() - 1)] + double{packet.slack};
    packet.limits[k] = round_up(limit * limit * (1 + 0x1p-18));
  }
  near_.clear();
  squares_.clear();
  descent_.run(
      object.view,
      [&](std::uint32_t node, std::array<double, node_width>& bounds) {
        std::array<float, node_width> squares;
        squared_distances(packet, object.view.boxes[node], squares);
        std::copy(squares.begin(), squares.end(), bounds.begin());
      },
      [&] {
        const float limit = *std::max_element(packet.limits, packet.limits + PointPacket::capacity);
        return stop_.stop_requested() || near_.size() > most ? -1 : std::min(double{limit}, 0x1p127);
      },
      [&](std::uint32_t leaf, std::uint32_t begin, std::uint32_t end) {
        for (; begin < end; begin += leaf_block) {
          PacketBounds squares;
          const LeafCorners& corners = recent_corners_.block_of(
              0, object, leaf, begin, std::min(begin + leaf_block, end), load_leaf_corners);
          for (std::uint64_t left = near_triangles(packet, corners, squares); left != 0; left &= left - 1) {
            const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
            for (std::uint32_t k = 0; k < points.size(); ++k) {
              if (!(squares[i][k] <= packet.limits[k])) continue;
              near_.push_back({begin + i, k});
              squares_.push_back(squares[i][k]);
            }
          }
        }
      });
  if (near_.size() > most) return false;
  std::size_t count = 0;  // within the final limits
  for (std::size_t i = 0; i < near_.size(); ++i) {
    near_[count] = near_[i];
    count += squares_[i] <= packet.limits[near_[i].b] ? 1 : 0;
  }
  bounded_ += count;
  lower_.resize(count + node_width);
  upper_.resize(count + node_width);
  bound_distances(points, {object.view.arrays, object.view.translation}, std::span(near_).first(count),
                  lower_.data(), upper_.data());
  for (std::size_t i = 0; i < count; ++i) {
    const auto [triangle, point] = near_[i];
    limits[point] = std::min(limits[point], upper_[i]);
    if (lower_[i] <= limits[point]) of_points_[point].push_back({lower_[i], 0, triangle});
  }
  return true;
}

void ObjectQueries::nearest(std::span<const QueriedObject> objects, std::span<const Vec3d> points,
                            double max_distance, std::span<std::optional<FoundTriangle>> found) {
  std::array<double, PointPacket::capacity> limits;
  for (std::size_t k = 0; k < points.size(); ++k) {
    of_points_[k].clear();
    NearestTriangle start(objects, points[k], max_distance, stop_, candidates_, block_);
    if (last_nearest_) start.limit_to(last_nearest_->corners);
    limits[k] = start.limit();
  }
  const bool is_bounded = objects.size() == 1 && bound_triangles(objects.front(), points, limits);
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (is_bounded) {
      NearestTriangle nearest(objects, points[k], max_distance, stop_, of_points_[k], block_, limits[k]);
      nearest.decide(true);
      decided_ += nearest.decided();
      found[k] = nearest.found();
      if (found[k]) last_nearest_ = found[k];
    } else {
      found[k] = nearest(objects, points[k], max_distance);
    }
  }
}

}  // namespace supple
