#include "supple/views.hpp"

#include <string>

#include "core/error.hpp"

namespace supple::detail {

Triples triples_of(const MatrixLayout& matrix) {
  const auto& [data, rows, columns, row_stride, column_stride, items] = matrix;
  const Triples in_rows{data, static_cast<std::size_t>(rows), row_stride, column_stride};
  const Triples in_columns{data, static_cast<std::size_t>(columns), column_stride, row_stride};
  const bool may_be_rows = items != MatrixItems::columns && columns == 3;
  const bool may_be_columns = items != MatrixItems::rows && rows == 3;
  if (may_be_rows && !may_be_columns) return in_rows;
  if (may_be_columns && !may_be_rows) return in_columns;
  const std::string size = "a " + std::to_string(rows) + " x " + std::to_string(columns) + " matrix ";
  if (may_be_rows) {
    fail(size + "may have its items in rows or in columns; say which by MatrixItems::rows or ::columns");
  }
  if (rows == 0 && columns == 0) return {data, 0, 0, 0};
  // A vector of packed scalars.
  const std::ptrdiff_t scalar_stride = columns == 1 ? row_stride : column_stride;
  if (items == MatrixItems::automatic && (rows == 1 || columns == 1) && rows * columns % 3 == 0)
    return {data, static_cast<std::size_t>(rows * columns / 3), 3 * scalar_stride, scalar_stride};
  fail(size + "cannot be points or triangles; it must be n x 3, 3 x n or a vector of 3 n");
}

Triples packed_triples(const void* data, std::size_t scalars, std::size_t scalar_size) {
  if (scalars % 3 != 0) {
    fail(std::to_string(scalars) +
         " packed numbers are not a whole number of points or triangles; give three for each");
  }
  const auto size = static_cast<std::ptrdiff_t>(scalar_size);
  return {data, scalars / 3, 3 * size, size};
}

}  // namespace supple::detail
