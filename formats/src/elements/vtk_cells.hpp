#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "elements/element_mesh.hpp"

namespace supple {

/// What a type of cells is. Its corners come before its other nodes.
struct VtkCellShape {
  enum Kind { nothing, polygon, strip, pixel, solid, voxel } kind;
  std::size_t corner_count = 0;  // of a polygon: 0 for all of its nodes
  Solid solid_kind{};
};

/// Nothing for a type that is not supported.
std::optional<VtkCellShape> vtk_shape_of(std::int64_t type);

/// What is wrong with a cell of such a type, after its number.
std::string unsupported_vtk_cell(std::int64_t type);

/// Adds a cell, which has at least `shape.corner_count` corners.
void add_vtk_cell(ElementMesh& mesh, std::span<const std::uint32_t> ids, const VtkCellShape& shape);

}  // namespace supple
