#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vector.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// A triangle of a closed part of a mesh.
struct VolumeElement {
  Triangle corners{};
  std::uint32_t part = 0;

  const Triangle& vertices() const { return corners; }
};

/// Triangles that hang together by vertices, each side of which is run through as often in one direction as
/// in the other: a surface without border that has an inside.
struct ClosedPart {
  std::uint32_t origin = 0;  ///< a vertex from which volumes are measured, for the sake of rounding
  double rest_volume = 0;    ///< below 0 when triangles are wound the other way round
  /// 1 / |rest volume|; 0 when it is less than a millionth of the volume of the sphere of the same area. Such
  /// a part is flat, and would be stiff without bound.
  double inverse_scale = 0;
};

struct ClosedParts {
  std::vector<VolumeElement> elements;  ///< by part, then in the order of the mesh
  std::vector<ClosedPart> parts;
  /// Closed parts that are not among them, as a vertex is not finite at rest or the volume beyond double.
  std::uint32_t left_out = 0;
};

/// Triangles with a repeated id are no part of anything. O(n log n).
ClosedParts closed_parts(const TriangleMesh& rest);

/// The normal, as long as the area. A third of it is how the volume changes as any of the corners moves,
/// summed over the triangles of a closed surface.
inline Vec3d area_vector(Vec3d p0, Vec3d p1, Vec3d p2) {
  return cross(p1 - p0, p2 - p0) * 0.5;
}

/// What elements of one part give to its volume: of the tetrahedra between each and the origin.
double volume_of(std::span<const VolumeElement> elements, Vec3d origin, std::span<const Vec3d> positions);

}  // namespace supple
