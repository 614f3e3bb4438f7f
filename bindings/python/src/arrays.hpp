#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <span>
#include <type_traits>

#include "supple/error.hpp"
#include "supple/views.hpp"

// Arrays of users. Python hands over arrays of NumPy with an aligned, native type (supple/_arrays.py), so
// here only types and shapes are read. Strides may have any value.

namespace supple::python {

namespace nb = nanobind;

using Array = nb::ndarray<nb::ro, nb::device::cpu>;

inline bool is_triples(const Array& array) {
  return array.ndim() == 2 && array.shape(1) == 3;
}

template <class Scalar, class View>
View view_of(const Array& array) {
  constexpr std::int64_t size = sizeof(Scalar);
  return View(static_cast<const Scalar*>(array.data()), array.shape(0), array.stride(0) * size,
              array.stride(1) * size);
}

/// An (n, 3) array of float32 or float64.
inline PositionsView positions_of(const Array& array) {
  if (!is_triples(array)) throw Error("positions must have the shape (n, 3)");
  if (array.dtype() == nb::dtype<double>()) return view_of<double, PositionsView>(array);
  if (array.dtype() == nb::dtype<float>()) return view_of<float, PositionsView>(array);
  throw Error("positions must be float32 or float64");
}

/// An (m, 3) array of int32, uint32, int64 or uint16.
inline TrianglesView triangles_of(const Array& array) {
  if (!is_triples(array)) throw Error("triangles must have the shape (m, 3)");
  if (array.dtype() == nb::dtype<std::int64_t>()) return view_of<std::int64_t, TrianglesView>(array);
  if (array.dtype() == nb::dtype<std::int32_t>()) return view_of<std::int32_t, TrianglesView>(array);
  if (array.dtype() == nb::dtype<std::uint32_t>()) return view_of<std::uint32_t, TrianglesView>(array);
  if (array.dtype() == nb::dtype<std::uint16_t>()) return view_of<std::uint16_t, TrianglesView>(array);
  throw Error("triangles must be int32, int64, uint16 or uint32");
}

template <class Scalar>
using List = nb::ndarray<const Scalar, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class Scalar, nb::ssize_t columns>
using Matrix = nb::ndarray<const Scalar, nb::shape<-1, columns>, nb::c_contig, nb::device::cpu>;

template <class Scalar>
std::span<const Scalar> span_of(const List<Scalar>& list) {
  return {list.data(), list.size()};
}
/// Rows of doubles as records that consist of as many doubles.
template <class Row, nb::ssize_t columns>
std::span<const Row> rows_of(const Matrix<double, columns>& matrix) {
  static_assert(sizeof(Row) == columns * sizeof(double) && std::is_trivially_copyable_v<Row>);
  return {reinterpret_cast<const Row*>(matrix.data()), matrix.shape(0)};
}

}  // namespace supple::python
