#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "contact/distance/element_distance.hpp"
#include "geometry/numbers/bounded_double.hpp"
#include "geometry/numbers/number_vector.hpp"
#include "geometry/numbers/wide_integer.hpp"

namespace supple {

/// The coordinates of two elements as doubles with error bounds.
class BoundedNumbers {
 public:
  using Number = BoundedDouble;

  explicit BoundedNumbers(const ElementPoints& elements) : points_(elements.points) {}
  std::array<Number, 3> difference(std::size_t i, std::size_t j) const {
    std::array<Number, 3> result;
    for (int axis = 0; axis < 3; ++axis)
      result[static_cast<std::size_t>(axis)] = BoundedDouble::difference(points_[i][axis], points_[j][axis]);
    return result;
  }
  static Number number(double value) { return {value, 0}; }
  static Number one() { return {1, 0}; }
  static int sign_of(const Number& n) { return supple::sign_of(n); }

 private:
  const std::array<Vec3d, 4>& points_;
};

/// As integers: exact.
class IntegerNumbers {
 public:
  using Number = UnboundedInteger;

  /// All numbers are multiplied by the same power of two.
  IntegerNumbers(const ElementPoints& elements, double max_distance) {
    std::array<double, 13> numbers{};
    std::size_t i = 0;
    for (const Vec3d& p : elements.points) {
      for (int axis = 0; axis < 3; ++axis) numbers[i++] = p[axis];
    }
    numbers[i] = std::isfinite(max_distance) ? max_distance : 0;
    lowest_ = BitRange(numbers).lowest;
    for (i = 0; i < 12; ++i) points_[i / 3][i % 3] = number(numbers[i]);
  }
  std::array<Number, 3> difference(std::size_t i, std::size_t j) const {
    return supple::difference(points_[i], points_[j]);
  }
  Number number(double value) const { return to_integer<Number>(value, lowest_); }
  static Number one() { return 1; }
  static int sign_of(const Number& n) { return sign(n); }
  int lowest() const { return lowest_; }

 private:
  int lowest_ = 0;
  std::array<std::array<Number, 3>, 4> points_;
};

template <class Number>
using Vector = NumberVector<Number>;

/// The volume that two elements span, and the place where the lines or planes through them are closest:
/// `along_u` / whole and `along_v` / whole of u and v.
template <class Number>
struct InteriorNumbers {
  Number volume, whole, along_u, along_v;
  Vector<Number> normal;

  template <class Numbers>
  InteriorNumbers(const Numbers& numbers, bool are_edges) {
    const Vector<Number> u = are_edges ? numbers.difference(1, 0) : numbers.difference(2, 1);
    const Vector<Number> v = are_edges ? numbers.difference(3, 2) : numbers.difference(3, 1);
    const Vector<Number> w = are_edges ? numbers.difference(0, 2) : numbers.difference(0, 1);
    normal = cross(u, v);
    volume = dot(normal, w);
    whole = dot(normal, normal);
    along_u = dot(are_edges ? cross(v, w) : cross(w, v), normal);
    along_v = dot(cross(u, w), normal);
  }
};

template <class Number>
struct VertexEdgeNumbers {
  Vector<Number> to_vertex, edge;
  Number along, whole;

  template <class Numbers>
  VertexEdgeNumbers(const Numbers& numbers, std::uint8_t vertex, const std::array<std::uint8_t, 2>& ends)
      : to_vertex(numbers.difference(vertex, ends[0])),
        edge(numbers.difference(ends[1], ends[0])),
        along(dot(to_vertex, edge)),
        whole(dot(edge, edge)) {}
  Number squared_moment() const {
    const Vector<Number> moment = cross(to_vertex, edge);
    return dot(moment, moment);
  }
};

}  // namespace supple
