#include "supple/comparison.hpp"

namespace supple {

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
