#pragma once

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/brute_force_contacts.hpp"
#include "supple/queries.hpp"
#include "supple/triangle_intersection.hpp"

// The surface of one object, for `verify`. Intervals of doubles decide what they can, and integers the rest.
// Shares no code with detection and queries.
namespace supple {

/// A squared distance, exactly: over / under · 2^exponent, with an even exponent.
struct SquaredDistance {
  boost::multiprecision::cpp_int over = 0, under = 1;
  int exponent = 0;
};
/// The sign of the difference.
int compare(const SquaredDistance& p, const SquaredDistance& q);
/// The squared distance of a point and a triangle with finite coordinates.
SquaredDistance squared_distance_by_integers(const Vec3d& point, const TrianglePoints& corners);
/// The square of a double.
SquaredDistance square_of(double distance);
/// Whether a distance is within some units in the last place of the exact one.
bool is_within_units(double distance, const SquaredDistance& squared, int units);

/// A triangle with finite corners, and its exact box.
struct BoxedCorners {
  TrianglePoints corners;
  Vec3d min, max;
  std::uint32_t triangle = 0;  ///< the user's number
};

/// A grid of squares in the y-z plane, each with the triangles whose boxes touch it.
class PlainColumns {
 public:
  explicit PlainColumns(const std::vector<BoxedCorners>& triangles);

  /// Calls `visit(i)` once for each triangle whose box may come within `radius` of the point in the y-z
  /// plane.
  template <class Visit>
  void visit(const Vec3d& point, double radius, const Visit& visit) const {
    const std::array first{cell(0, point.y - radius), cell(1, point.z - radius)},
        last{cell(0, point.y + radius), cell(1, point.z + radius)};
    for (std::uint32_t row = first[1]; row <= last[1]; ++row) {
      for (std::uint32_t column = first[0]; column <= last[0]; ++column) {
        const std::size_t place = std::size_t{row} * count_ + column;
        for (std::uint32_t i = first_[place]; i < first_[place + 1]; ++i) {
          // In the first of its cells that is visited.
          const std::array<std::uint32_t, 2>& from = first_cell_[items_[i]];
          if (column == std::max(from[0], first[0]) && row == std::max(from[1], first[1])) visit(items_[i]);
        }
      }
    }
  }
  /// The edge of a cell.
  double width() const { return width_; }

 private:
  /// Never decreases with x.
  std::uint32_t cell(std::size_t axis, double x) const {
    const double place = (x - low_[axis]) * scale_[axis];
    return place > 0 ? static_cast<std::uint32_t>(std::min(place, static_cast<double>(count_ - 1))) : 0;
  }

  std::uint32_t count_ = 1;  // of rows and of columns
  double width_ = 0;
  std::array<double, 2> low_{}, scale_{};                 // of y and z
  std::vector<std::array<std::uint32_t, 2>> first_cell_;  // of each triangle
  std::vector<std::uint32_t> first_, items_;              // by cell
};

/// The triangles of one object.
struct PlainSurface {
  bool has_inert = false;               ///< triangles with a corner that is not finite are left out
  std::vector<BoxedCorners> triangles;  ///< the others, ascending
  PlainColumns columns;

  explicit PlainSurface(const PlainObject& object);

  /// Where a finite point is: on a triangle, else inside by an odd number of crossings of a ray along x. With
  /// a triangle that is left out, nothing is inside.
  Containment containment(const Vec3d& point) const;

  struct Nearest {
    std::uint32_t triangle = 0;  ///< the user's number; the smallest of several
    SquaredDistance squared;
  };
  /// The nearest triangle of a finite point. There must be one.
  Nearest nearest(const Vec3d& point) const;
};

}  // namespace supple
