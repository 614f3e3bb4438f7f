#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "comparison/volumes/volume_kernels.hpp"
#include "octree/volumes/node_volumes.hpp"

namespace supple {

/// Area, centre of area and second moments about it of some triangles. Sums are those of the union. There is
/// no common origin, so nothing cancels far away from it, and moments depend on nothing but their triangles.
struct SurfaceMoments {
  double area = 0;
  Vec3d center{};
  std::array<double, 6> second{};  ///< integrals of xx, yy, zz, xy, yz, zx

  SurfaceMoments& operator+=(const SurfaceMoments& other);
};

/// Oriented boxes, rounded outward. Their axes are the principal axes of the surface, as in Gottschalk, Lin
/// and Manocha, "OBBTree", 1996; the area as weight makes them independent of the tessellation. They are
/// never larger than the box of the triangles: they equal that box when the principal axes are worse. They
/// are infinite when coordinates are so large that squares overflow. A refit takes O(vertices · levels).
class OrientedBoxes final : public NodeVolumes {
 public:
  explicit OrientedBoxes(std::size_t nodes)
      : NodeVolumes(BoundingVolume::obb, nodes), boxes_(nodes == 0 ? 0 : nodes + 1), moments_(nodes) {}

  void refit(const RefittedOctree& octree, std::uint32_t begin, std::uint32_t end) override;
  void refit_object(const RefittedOctree& octree, const Aabb& box) override;
  void clear_apart(std::span<const NodePair> pairs, const NodeVolumes& b, const RelativePlacement& placement,
                   std::uint64_t* masks) const override {
    clear_boxes_apart(pairs, boxes_.data(), static_cast<const OrientedBoxes&>(b).boxes_.data(), placement,
                      masks);
  }
  std::vector<Slab> slabs(std::uint32_t node, int child, const Aabb& box, Vec3d translation) const override;
  std::size_t bytes() const override {
    return boxes_.capacity() * sizeof(ChildOrientedBoxes) + moments_.capacity() * sizeof(SurfaceMoments);
  }

 private:
  std::vector<ChildOrientedBoxes> boxes_;
  std::vector<SurfaceMoments> moments_;  // of the nodes
};

}  // namespace supple
