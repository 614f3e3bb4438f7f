#include "supple/comparison.hpp"

#include "comparison/methods.hpp"
#include "octree/comparison_methods.hpp"

namespace supple {
namespace {

std::unique_ptr<NodeVolumes> make_node_volumes(BoundingVolume kind, SphereFit fit, const ObjectOctree& octree,
                                               const PositionsView& rest_positions) {
  if (kind == BoundingVolume::sphere) return make_spheres(fit, octree, rest_positions);
  const std::size_t nodes = octree.nodes().size();
  return kind == BoundingVolume::obb ? make_oriented_boxes(nodes) : make_kdops(kind, nodes);
}

OctreeTopology build_other_octree(const PositionsView& positions, std::span<const Triangle> triangles,
                                  std::span<const Vec3d> centers, const ObjectOctreeOptions& options) {
  return options.build == ObjectOctreeBuild::regular
             ? build_regular_octree(centers, options)
             : build_bottom_up_octree(positions, triangles, centers, options);
}

std::unique_ptr<PairSearch> make_pair_search(BroadPhaseMethod method) {
  if (method == BroadPhaseMethod::sweep3) return std::make_unique<ThreeAxisSweep>();
  return std::make_unique<SweepSearch>(method == BroadPhaseMethod::sweep);
}

}  // namespace

void use_comparison_methods() {
  static constexpr ComparisonMethods methods{make_node_volumes,         build_other_octree,
                                             make_pair_search,          mask_one_side_first,
                                             list_colliding_vertices,   LazyRefit::refit_object,
                                             LazyRefit::refit_children, LazyRefit::refit_where_objects_meet};
  set_comparison_methods(methods);
}

SceneOptions with_method_of_2007(SceneOptions options) {
  if (options.bounding_volume != BoundingVolume::sphere) options.bounding_volume = BoundingVolume::aabb;
  options.broad_phase = BroadPhaseMethod::octree;
  options.scene_octree = {.max_level = 2,
                          .expand_at = 2,
                          .region_sphere_test = RegionSphereTest::grown_box,
                          .expand_for_large_objects = true,
                          .min_level = 1,
                          .root = options.scene_octree.root};
  options.contact_points = false;
  options.comparison = {.sphere_fit = SphereFit::vertices,
                        .colliding_vertices = true,
                        .descent = Descent::one_side_first,
                        .lazy_refit = true};
  return options;
}

ObjectOctreeOptions octree_of_2007() {
  return {.leaf_size = 1, .build = ObjectOctreeBuild::regular, .rebuild_degraded = false};
}

}  // namespace supple
