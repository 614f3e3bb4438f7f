#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <span>
#include <type_traits>
#include <utility>

#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple {

/// Which lines of a matrix are the items: points or triangles.
enum class MatrixItems : std::uint8_t { rows, columns, automatic };

/// A dense matrix with the interface of Eigen: `Eigen::Matrix`, `Array`, `Map`, `Ref`, `Block` and others.
/// The library only calls these members; it does not include Eigen.
template <class Matrix>
concept DenseMatrix = requires(const Matrix& m) {
  typename Matrix::Scalar;
  { *m.data() } -> std::convertible_to<typename Matrix::Scalar>;
  { m.rows() } -> std::convertible_to<std::ptrdiff_t>;
  { m.cols() } -> std::convertible_to<std::ptrdiff_t>;
  { m.innerStride() } -> std::convertible_to<std::ptrdiff_t>;
  { m.outerStride() } -> std::convertible_to<std::ptrdiff_t>;
  { Matrix::IsRowMajor + 0 } -> std::convertible_to<int>;
};

namespace detail {

/// Triples of scalars in memory. Strides are in bytes.
struct Triples {
  const void* data = nullptr;
  std::size_t count = 0;
  std::ptrdiff_t item_stride = 0;    ///< from one triple to the next
  std::ptrdiff_t scalar_stride = 0;  ///< from one scalar of a triple to the next
};

/// A matrix in memory. Strides are in bytes.
struct MatrixLayout {
  const void* data = nullptr;
  std::ptrdiff_t rows = 0, columns = 0, row_stride = 0, column_stride = 0;
  MatrixItems items = MatrixItems::automatic;
};

/// Throws `Error` when the matrix has no dimension of 3, or two and `items` is automatic.
Triples triples_of(const MatrixLayout& matrix);
/// Throws `Error` when `scalars` is not a multiple of 3.
Triples packed_triples(const void* data, std::size_t scalars, std::size_t scalar_size);

template <DenseMatrix Matrix>
Triples triples_of(const Matrix& m, MatrixItems items) {
  constexpr std::ptrdiff_t size = sizeof(typename Matrix::Scalar);
  const std::ptrdiff_t inner = m.innerStride() * size, outer = m.outerStride() * size;
  if constexpr (requires { Matrix::RowsAtCompileTime + Matrix::ColsAtCompileTime; }) {
    constexpr bool three_rows = int{Matrix::RowsAtCompileTime} == 3;
    constexpr bool three_columns = int{Matrix::ColsAtCompileTime} == 3;
    if (items == MatrixItems::automatic && three_rows != three_columns)
      items = three_rows ? MatrixItems::columns : MatrixItems::rows;
  }
  return triples_of(Matrix::IsRowMajor ? MatrixLayout{m.data(), m.rows(), m.cols(), outer, inner, items}
                                       : MatrixLayout{m.data(), m.rows(), m.cols(), inner, outer, items});
}

/// The scalar of an element that is three scalars and nothing else.
template <class Element>
struct TripleElement {};
template <class S>
struct TripleElement<Vec3<S>> {
  using Scalar = S;
};
template <class S>
struct TripleElement<std::array<S, 3>> {
  using Scalar = S;
};
template <DenseMatrix Element>
requires(sizeof(Element) == 3 * sizeof(typename Element::Scalar)) struct TripleElement<Element> {
  using Scalar = typename Element::Scalar;
};

template <class Range>
concept PlainRange = !DenseMatrix<Range> && requires(const Range& range) {
  { *std::data(range) } -> std::convertible_to<const std::remove_cvref_t<decltype(*std::data(range))>&>;
  { std::size(range) } -> std::convertible_to<std::size_t>;
};
template <class Range>
using Element = std::remove_cvref_t<decltype(*std::data(std::declval<const Range&>()))>;
template <class Range>
concept TripleRange = PlainRange<Range> && requires {
  typename TripleElement<Element<Range>>::Scalar;
};

template <TripleRange Range>
Triples triples_in(const Range& range) {
  constexpr std::ptrdiff_t size = sizeof(typename TripleElement<Element<Range>>::Scalar);
  return {std::data(range), std::size(range), 3 * size, size};
}

template <class Scalar>
Scalar read(const Triples& triples, std::size_t item, int scalar) {
  Scalar value;
  std::memcpy(&value,
              static_cast<const std::byte*>(triples.data) +
                  static_cast<std::ptrdiff_t>(item) * triples.item_stride + scalar * triples.scalar_stride,
              sizeof value);
  return value;
}

}  // namespace detail

/// The scalars of `PositionsView`.
template <class Scalar>
concept Coordinate = std::same_as<Scalar, double> || std::same_as<Scalar, float>;

/// Points in the user's memory, `double` or `float`, in any layout. The view converts from
/// - a contiguous range of `Vec3d`, `Vec3f`, `std::array<double, 3>`, `Eigen::Vector3d` and the like,
/// - a contiguous range of `double` or `float`: packed x y z,
/// - a dense matrix (Eigen) with points in its rows (n x 3) or columns (3 x n), row-major or column-major, or
///   a vector of packed x y z,
/// - a pointer and strides.
///
/// ```cpp
/// Eigen::MatrixX3d V(n, 3);                                        // column-major: x x x … y y y … z z z …
/// scene.set_positions(cloth, V);
/// scene.set_positions(cloth, PositionsView(V.data(), n, sizeof(double), n * sizeof(double)));  // the same
/// scene.set_positions(fish, PositionsView(&particles[0].x, particles.size(), sizeof(Particle)));
/// ```
///
/// The view does not own the memory. A call that takes a view reads it only during the call, except
/// `Scene::share_positions`.
class PositionsView {
 public:
  PositionsView() = default;
  /// Coordinate c of point i is at `first + i * point_stride + c * coordinate_stride`, the strides in bytes.
  /// Strides may have any value, also negative; the memory need not be aligned.
  template <Coordinate Scalar>
  PositionsView(const Scalar* first, std::size_t count, std::ptrdiff_t point_stride = 3 * sizeof(Scalar),
                std::ptrdiff_t coordinate_stride = sizeof(Scalar))
      : triples_{first, count, point_stride, coordinate_stride},
        is_double_(sizeof(Scalar) == sizeof(double)) {}

  template <detail::TripleRange Points>
  requires Coordinate<typename detail::TripleElement<detail::Element<Points>>::Scalar> PositionsView(
      const Points& points)
      : triples_(detail::triples_in(points)),
        is_double_(sizeof(detail::Element<Points>) == 3 * sizeof(double)) {}

  /// Packed x y z. Throws `Error` when the number of coordinates is not a multiple of 3.
  template <detail::PlainRange Coordinates>
  requires Coordinate<detail::Element<Coordinates>> PositionsView(const Coordinates& xyz)
      : triples_(
            detail::packed_triples(std::data(xyz), std::size(xyz), sizeof(detail::Element<Coordinates>))),
        is_double_(sizeof(detail::Element<Coordinates>) == sizeof(double)) {}

  /// A matrix has its points in rows when it has three columns, and in columns when it has three rows. Throws
  /// `Error` when it has neither, and for a 3 x 3 matrix whose type does not fix one dimension: use
  /// `Eigen::MatrixX3d`, or pass `MatrixItems::rows`.
  template <DenseMatrix Matrix>
  requires Coordinate<typename Matrix::Scalar> PositionsView(const Matrix& matrix,
                                                             MatrixItems points_in = MatrixItems::automatic)
      : triples_(detail::triples_of(matrix, points_in)),
        is_double_(sizeof(typename Matrix::Scalar) == sizeof(double)) {}

  std::size_t size() const { return triples_.count; }
  bool is_double() const { return is_double_; }
  const void* data() const { return triples_.data; }
  std::ptrdiff_t point_stride() const { return triples_.item_stride; }
  std::ptrdiff_t coordinate_stride() const { return triples_.scalar_stride; }

  /// Point i in the precision of the user's numbers; `Scalar` must be the scalar of the view.
  template <Coordinate Scalar>
  Vec3<Scalar> get(std::size_t i) const {
    return {detail::read<Scalar>(triples_, i, 0), detail::read<Scalar>(triples_, i, 1),
            detail::read<Scalar>(triples_, i, 2)};
  }
  Vec3d operator[](std::size_t i) const {
    if (is_double_) return get<double>(i);
    const Vec3f p = get<float>(i);
    return {p.x, p.y, p.z};
  }

 private:
  detail::Triples triples_;
  bool is_double_ = true;
};

/// The vertex ids of `TrianglesView`: `uint16_t`, and all integers of 32 and 64 bits, such as `int`, `long`,
/// `long long` and `size_t`.
template <class Integer>
concept VertexIndex = std::integral<Integer> &&
    (sizeof(Integer) == 4 || sizeof(Integer) == 8 || std::same_as<Integer, std::uint16_t>);

/// Triangles in the user's memory as three vertex ids each: `uint16_t`, or integers of 32 or 64 bits, in any
/// layout. It converts from the same ranges, matrices, and pointers with strides as `PositionsView`,
/// with ids instead of coordinates: `std::vector<Triangle>`, packed ids, `Eigen::MatrixX3i`.
class TrianglesView {
 public:
  TrianglesView() = default;
  /// Corner c of triangle i is at `first + i * triangle_stride + c * corner_stride`, the strides in bytes.
  template <VertexIndex Integer>
  TrianglesView(const Integer* first, std::size_t count, std::ptrdiff_t triangle_stride = 3 * sizeof(Integer),
                std::ptrdiff_t corner_stride = sizeof(Integer))
      : triples_{first, count, triangle_stride, corner_stride}, index_(index_of<Integer>()) {}

  template <detail::TripleRange Triangles>
  requires VertexIndex<typename detail::TripleElement<detail::Element<Triangles>>::Scalar> TrianglesView(
      const Triangles& triangles)
      : triples_(detail::triples_in(triangles)),
        index_(index_of<typename detail::TripleElement<detail::Element<Triangles>>::Scalar>()) {}

  /// Packed ids. Throws `Error` when their number is not a multiple of 3.
  template <detail::PlainRange Ids>
  requires VertexIndex<detail::Element<Ids>> TrianglesView(const Ids& ids)
      : triples_(detail::packed_triples(std::data(ids), std::size(ids), sizeof(detail::Element<Ids>))),
        index_(index_of<detail::Element<Ids>>()) {}

  template <DenseMatrix Matrix>
  requires VertexIndex<typename Matrix::Scalar> TrianglesView(
      const Matrix& matrix, MatrixItems triangles_in = MatrixItems::automatic)
      : triples_(detail::triples_of(matrix, triangles_in)), index_(index_of<typename Matrix::Scalar>()) {}

  std::size_t size() const { return triples_.count; }
  /// The vertex ids of triangle t, unchecked: they may be negative.
  std::array<std::int64_t, 3> operator[](std::size_t t) const {
    switch (index_) {
      case Index::uint16:
        return get<std::uint16_t>(t);
      case Index::int32:
        return get<std::int32_t>(t);
      case Index::int64:
        return get<std::int64_t>(t);
      case Index::uint32:
        break;
    }
    return get<std::uint32_t>(t);
  }

 private:
  enum class Index : std::uint8_t { uint32, int32, uint16, int64 };

  template <class Integer>
  static constexpr Index index_of() {
    if (sizeof(Integer) == 2) return Index::uint16;
    if (sizeof(Integer) == 8) return Index::int64;
    return std::is_signed_v<Integer> ? Index::int32 : Index::uint32;
  }
  template <class Integer>
  std::array<std::int64_t, 3> get(std::size_t t) const {
    return {detail::read<Integer>(triples_, t, 0), detail::read<Integer>(triples_, t, 1),
            detail::read<Integer>(triples_, t, 2)};
  }

  detail::Triples triples_;
  Index index_ = Index::uint32;
};

}  // namespace supple
