#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/volumes/node_volumes.hpp"

namespace supple {

/// The spheres of the children of a node. Those of missing children, and of children without a finite
/// triangle, are empty.
using ChildSpheres = std::array<BoundingSphere, node_width>;

/// `SphereFit::minimal` starts with the sphere of `SphereFit::vertices`. Then it finds the vertex farthest
/// from the centre and computes the smallest sphere of this vertex and of the up to four vertices on the
/// sphere before, again and again, until no vertex is outside. (Gärtner, "Fast and robust smallest enclosing
/// balls", 1999.) It takes the smallest of these spheres after their radii reached the farthest vertex, so
/// the result encloses all vertices and is never larger than the first, even when rounding ends the search
/// early.
///
/// Both fits search the farthest vertex below a node top-down and skip children whose sphere ends before the
/// farthest vertex so far. A refit takes O(n · levels).
class Spheres final : public NodeVolumes {
 public:
  Spheres(SphereFit fit, std::size_t nodes)
      : NodeVolumes(BoundingVolume::sphere, nodes), fit_(fit), spheres_(nodes) {}

  void refit(const RefittedOctree& octree, std::uint32_t begin, std::uint32_t end) override;
  void refit_object(const RefittedOctree& octree, const Aabb& box) override;
  void clear_apart(std::span<const NodePair> pairs, const NodeVolumes& b, const RelativePlacement& placement,
                   std::uint64_t* masks) const override;
  BoundingSphere sphere(std::uint32_t node, int child) const override {
    return node == object() ? object_sphere_ : spheres_[node][static_cast<std::size_t>(child)];
  }
  std::size_t bytes() const override { return spheres_.capacity() * sizeof(ChildSpheres); }

 private:
  SphereFit fit_;
  std::vector<ChildSpheres> spheres_;
  BoundingSphere object_sphere_;
};

}  // namespace supple
