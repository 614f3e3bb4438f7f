#pragma once

#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace supple {

/// Three coordinates, in the user's units (the documents say metres). Right-handed axes.
template <class Scalar>
struct Vec3 {
  Scalar x{}, y{}, z{};

  constexpr Scalar& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr const Scalar& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr bool operator==(const Vec3&) const = default;

  constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
  constexpr Vec3& operator-=(Vec3 b) { return *this = *this - b; }
  constexpr Vec3& operator*=(Scalar s) { return *this = *this * s; }
  friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator*(Vec3 a, Scalar s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(Scalar s, Vec3 a) { return a * s; }
  friend constexpr Vec3 operator/(Vec3 a, Scalar s) { return {a.x / s, a.y / s, a.z / s}; }
};

/// Sums run from left to right and each operation rounds once: error bounds in the library rely on it.
template <class Scalar>
constexpr Scalar dot(Vec3<Scalar> a, Vec3<Scalar> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Scalar>
constexpr Vec3<Scalar> cross(Vec3<Scalar> a, Vec3<Scalar> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Scalar>
constexpr Scalar squared_norm(Vec3<Scalar> a) {
  return dot(a, a);
}
template <class Scalar>
Scalar norm(Vec3<Scalar> a) {
  return std::sqrt(dot(a, a));
}

/// The vectors in double and in single precision.
using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;

/// Closed axis-aligned box in single precision, always rounded outward from the coordinates it bounds.
/// The empty box is inverted (+inf, -inf), so the union with a box is that box.
struct Aabb {
  Vec3f min{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
            std::numeric_limits<float>::infinity()};
  Vec3f max{-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
            -std::numeric_limits<float>::infinity()};

  constexpr bool operator==(const Aabb&) const = default;
  /// True when the box contains no point.
  constexpr bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
};

/// Closed sphere (a solid ball) in single precision. A negative radius is the empty sphere.
struct BoundingSphere {
  Vec3f center;
  float radius = -1;

  constexpr bool operator==(const BoundingSphere&) const = default;
  constexpr bool empty() const { return radius < 0; }
};

/// The points p with low <= dot(direction, p) <= high. The direction need not be of unit length.
struct Slab {
  Vec3f direction;
  float low = 0, high = 0;

  constexpr bool operator==(const Slab&) const = default;
};

/// Identifies an object of one scene. A scene reuses the `index` of a removed object and raises its
/// `generation`, so that it recognizes an outdated id. Ordered by index.
struct ObjectId {
  std::uint32_t index = 0;
  std::uint32_t generation = 0;

  constexpr auto operator<=>(const ObjectId&) const = default;
};

/// Two different objects, `a.index < b.index`.
struct ObjectPair {
  ObjectId a, b;
  constexpr auto operator<=>(const ObjectPair&) const = default;
};

/// A triangle of object a and a triangle of object b, as indices into each object's own list of triangles.
struct TrianglePair {
  std::uint32_t a = 0, b = 0;
  constexpr auto operator<=>(const TrianglePair&) const = default;
};

}  // namespace supple
