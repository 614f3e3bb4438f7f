#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geometry/oriented_box.hpp"
#include "octree/vertex_buffer.hpp"
#include "octree/volumes/slab_kernels.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// Area, centre of area and second moments about it of some triangles. Sums are those of the union. There is
/// no common origin, so nothing cancels far away from it, and moments depend on nothing but their triangles.
struct SurfaceMoments {
  double area = 0;
  Vec3d center{};
  std::array<double, 6> second{};  ///< integrals of xx, yy, zz, xy, yz, zx

  SurfaceMoments& operator+=(const SurfaceMoments& other);
};

/// Some triangles of an octree; inert ones are left out. `inert` may be empty.
struct SurfacePart {
  std::span<const Triangle> triangles;
  std::span<const std::uint8_t> inert;
  const VertexBuffer& vertices;

  SurfacePart part(std::uint32_t first, std::uint32_t count) const {
    return {triangles.subspan(first, count), inert.empty() ? inert : inert.subspan(first, count), vertices};
  }
  /// Calls `visit(p, q, r)`.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (!inert.empty() && inert[t] != 0) continue;
      visit(vertices[triangles[t][0]], vertices[triangles[t][1]], vertices[triangles[t][2]]);
    }
  }
};

SurfaceMoments moments_of(const SurfacePart& part);

/// Fits an oriented box to some triangles, rounded outward. Its axes are the principal axes of the surface,
/// as in Gottschalk, Lin and Manocha, "OBBTree", 1996; the area as weight makes them independent of the
/// tessellation. The result is never larger than the box of the triangles: it equals that box when the
/// principal axes are worse. It is infinite when coordinates are so large that squares overflow.
class OrientedBoxFit {
 public:
  /// `box` is the box of the triangles.
  OrientedBoxFit(const SurfaceMoments& moments, const Aabb& box);

  /// Whether `box` needs the extents of the vertices. Otherwise, the result is known from `box` alone.
  bool needs_extents() const { return needs_extents_; }
  const AxisFrame& frame() const { return frame_; }
  /// The result. `extents` are those of all vertices in `frame`.
  OrientedBox box(const AxisExtents& extents) const;

 private:
  OrientedBox aligned_;
  AxisFrame frame_;
  bool needs_extents_ = false;
};

}  // namespace supple
