#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "supple/mesh.hpp"

namespace supple {

enum class Solid : std::uint8_t {
  tetrahedron,
  hexahedron,
  prism,
  pyramid,
  pentagonal_prism,
  hexagonal_prism
};

/// The corners of a solid, without the nodes inside its edges and faces.
std::size_t corner_count(Solid kind);

/// A mesh of polygons and solids, as programs for finite elements write it.
struct ElementMesh {
  /// A polygon of the file. One with fewer than three corners is ignored.
  void add_polygon(std::span<const std::uint32_t> corners);
  /// A solid whose corners are in the order of Gmsh and VTK. Further nodes of `corners` are ignored.
  void add_solid(Solid kind, std::span<const std::uint32_t> corners);

  /// The surface: all positions, and these triangles, in this order.
  /// - The polygons of the file, except those between two solids. A polygon that is on the boundary of a
  /// solid
  ///   faces outwards; its second copy is left out. All others stay as they are.
  /// - The faces of exactly one solid that no polygon covers: outwards, in the order of the solids, and of
  /// the
  ///   faces of each.
  /// Quads and larger faces become triangles as in `load_mesh`. Faces are the same when they have the same
  /// corners. A solid is taken as numbered inside out when its corners lie outside of its faces, by exact
  /// signs. Fails with the name of the file when there are more triangles than ids. O(n log n).
  TriangleMesh take_surface(const std::string& file);

  std::vector<Vec3d> positions;

 private:
  std::vector<std::uint32_t> polygon_corners_, solid_corners_;
  std::vector<std::size_t> polygon_ends_;
  std::vector<Solid> solids_;
};

}  // namespace supple
