#include "supple/comparison.hpp"

#include "comparison/broad_phase/sweep_search.hpp"
#include "comparison/builds/builds.hpp"
#include "comparison/volumes/kdops.hpp"
#include "comparison/volumes/oriented_boxes.hpp"
#include "comparison/volumes/spheres.hpp"
#include "octree/comparison_methods.hpp"

namespace supple {
namespace {

std::unique_ptr<NodeVolumes> make_node_volumes(BoundingVolume kind, SphereFit fit, std::size_t nodes) {
  if (kind == BoundingVolume::sphere) return std::make_unique<Spheres>(fit, nodes);
  if (kind == BoundingVolume::obb) return std::make_unique<OrientedBoxes>(nodes);
  return std::make_unique<Kdops>(kind, nodes);
}

OctreeTopology build_other_octree(const PositionsView& positions, std::span<const Triangle> triangles,
                                  std::span<const Vec3d> centers, const ObjectOctreeOptions& options) {
  return options.build == ObjectOctreeBuild::regular
             ? build_regular_octree(centers, options)
             : build_bottom_up_octree(positions, triangles, centers, options);
}

std::unique_ptr<PairSearch> make_pair_search(BroadPhaseMethod method) {
  return std::make_unique<SweepSearch>(method == BroadPhaseMethod::sweep);
}

}  // namespace

void use_comparison_methods() {
  static constexpr ComparisonMethods methods{make_node_volumes, build_other_octree, make_pair_search};
  set_comparison_methods(methods);
}

}  // namespace supple
