#include "elements/vtk_cells.hpp"

#include <array>

namespace supple {

std::optional<VtkCellShape> vtk_shape_of(std::int64_t type) {
  switch (type) {
    case 0:
    case 1:
    case 2:
    case 3:
    case 4:  // empty, points and lines
    case 21:
    case 35:
    case 68:
    case 75:
      return VtkCellShape{VtkCellShape::nothing};
    case 6:
      return VtkCellShape{VtkCellShape::strip, 3};
    case 7:
      return VtkCellShape{VtkCellShape::polygon};
    case 8:
      return VtkCellShape{VtkCellShape::pixel, 4};
    case 5:
    case 22:
    case 34:
    case 69:
    case 76:
      return VtkCellShape{VtkCellShape::polygon, 3};
    case 9:
    case 23:
    case 28:
    case 30:
    case 70:
    case 77:
      return VtkCellShape{VtkCellShape::polygon, 4};
    case 10:
    case 24:
    case 71:
    case 78:
      return VtkCellShape{VtkCellShape::solid, 4, Solid::tetrahedron};
    case 11:
      return VtkCellShape{VtkCellShape::voxel, 8, Solid::hexahedron};
    case 12:
    case 25:
    case 29:
    case 33:
    case 72:
    case 79:
      return VtkCellShape{VtkCellShape::solid, 8, Solid::hexahedron};
    case 13:
    case 26:
    case 31:
    case 32:
    case 73:
    case 80:
      return VtkCellShape{VtkCellShape::solid, 6, Solid::prism};
    case 14:
    case 27:
    case 37:
    case 74:
    case 81:
      return VtkCellShape{VtkCellShape::solid, 5, Solid::pyramid};
    case 15:
      return VtkCellShape{VtkCellShape::solid, 10, Solid::pentagonal_prism};
    case 16:
      return VtkCellShape{VtkCellShape::solid, 12, Solid::hexagonal_prism};
    default:
      return {};
  }
}

std::string unsupported_vtk_cell(std::int64_t type) {
  return " is of type " + std::to_string(type) +
         ", which is not supported; save the mesh with simple cells such as tetrahedra (type 10) or "
         "hexahedra "
         "(type 12)";
}

void add_vtk_cell(ElementMesh& mesh, std::span<const std::uint32_t> ids, const VtkCellShape& shape) {
  switch (shape.kind) {
    case VtkCellShape::nothing:
      return;
    case VtkCellShape::polygon:
      return mesh.add_polygon(shape.corner_count == 0 ? ids : ids.first(shape.corner_count));
    case VtkCellShape::strip:
      for (std::size_t i = 2; i < ids.size(); ++i) {
        const std::size_t odd = i % 2;  // every second triangle of a strip goes the other way
        mesh.add_polygon(std::array{ids[i - 2 + odd], ids[i - 1 - odd], ids[i]});
      }
      return;
    case VtkCellShape::pixel:
      return mesh.add_polygon(std::array{ids[0], ids[1], ids[3], ids[2]});
    case VtkCellShape::solid:
      return mesh.add_solid(shape.solid_kind, ids);
    case VtkCellShape::voxel:
      return mesh.add_solid(shape.solid_kind,
                            std::array{ids[0], ids[1], ids[3], ids[2], ids[4], ids[5], ids[7], ids[6]});
  }
}

}  // namespace supple
