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

/// A connected set of triangles in which each edge occurs equally often in both directions: a surface
/// without border, which encloses a volume.
struct ClosedPart {
  std::uint32_t origin = 0;  ///< volumes are measured from this vertex, to reduce rounding
  double rest_volume = 0;    ///< negative when the triangles face inward
  /// 1 / |rest volume|, or 0 for a flat part: one whose volume is below a millionth of the volume of a
  /// sphere of the same area. Its stiffness would be unbounded.
  double inverse_scale = 0;
};

struct ClosedParts {
  std::vector<VolumeElement> elements;  ///< by part, then in the order of the mesh
  std::vector<ClosedPart> parts;
  /// Number of closed parts that are omitted because a vertex is not finite at rest or the volume overflows
  /// double.
  std::uint32_t left_out = 0;
};

/// Ignores triangles with a repeated vertex id. O(n log n).
ClosedParts closed_parts(const TriangleMesh& rest);

/// The normal, with the area as its length. Summed over the triangles of a closed surface around a vertex, a
/// third of it is the gradient of the volume with respect to that vertex.
inline Vec3d area_vector(Vec3d p0, Vec3d p1, Vec3d p2) {
  return cross(p1 - p0, p2 - p0) * 0.5;
}

/// The volume between `elements` of one part and the origin, as a sum of tetrahedra.
double volume_of(std::span<const VolumeElement> elements, Vec3d origin, std::span<const Vec3d> positions);

}  // namespace supple
