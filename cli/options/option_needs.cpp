#include "options/option_needs.hpp"

#include "session/settings.hpp"

namespace supple::cli {
namespace {

bool only_intersections(const SceneOptions& scene) {
  return scene.contacts == ContactKinds::none || scene.contacts == ContactKinds::intersection;
}

/// Oriented boxes and k-DOPs enclose objects at rest, not their paths.
constexpr bool is_of_positions(BoundingVolume volume) {
  return volume != BoundingVolume::aabb && volume != BoundingVolume::sphere;
}

bool has_boxes_or_spheres(const SceneOptions& scene) {
  return !is_of_positions(scene.bounding_volume);
}

constexpr const char* methods = "octree or automatic";
constexpr const char* kinds_at_rest = "intersection or none";

constexpr OptionNeed needs[] = {
    {"bounding_volume",
     [](const SceneOptions& scene) { return is_at_rest(scene) || !is_of_positions(scene.bounding_volume); },
     "contacts",
     "intersection or none, because vertices, edges and faces are searched with boxes or spheres"},
    {"sphere_fit", has_spheres, "bounding_volume", "sphere"},
    {"sphere_fit", is_at_rest, "contacts", kinds_at_rest},
    {"region_test", has_spheres, "bounding_volume", "sphere"},
    {"region_test", has_scene_octree, "broad_phase", methods},
    {"scene_octree_max_level", has_scene_octree, "broad_phase", methods},
    {"scene_octree_expand_at", has_scene_octree, "broad_phase", methods},
    {"scene_octree_expand_for_large", has_scene_octree, "broad_phase", methods},
    {"scene_octree_min_level", has_scene_octree, "broad_phase", methods},
    {"scene_octree_arity", has_scene_octree, "broad_phase", methods},
    {"scene_octree_root", has_scene_octree, "broad_phase", methods},
    {"min_separation", has_continuous, "contacts", "continuous"},
    {"undecided", has_continuous, "contacts", "continuous"},
    {"max_time", has_continuous, "contacts", "continuous"},
    {"skip_parting", has_continuous, "contacts", "continuous"},
    {"continuous_listing", has_continuous, "contacts", "continuous"},
    {"curves", has_penetration, "contacts", "penetration"},
    {"element_kinds", [](const SceneOptions& scene) { return has_continuous(scene) || has_margins(scene); },
     "contacts", "continuous or proximity"},
    {"proximity_listing", has_margins, "contacts", "proximity"},
    {"manifolds", [](const SceneOptions& scene) { return has_penetration(scene) || has_margins(scene); },
     "contacts", "penetration or proximity"},
    {"contact_points", has_intersections, "contacts", "intersection"},
    {"colliding_vertices", is_at_rest, "contacts", kinds_at_rest},
    {"descent", is_at_rest, "contacts", kinds_at_rest},
    {"descent", has_boxes_or_spheres, "bounding_volume", "aabb or sphere"},
    {"lazy_refit", only_intersections, "contacts", kinds_at_rest},
    {"lazy_refit", has_boxes_or_spheres, "bounding_volume", "aabb or sphere"},
};

}  // namespace

bool is_at_rest(const SceneOptions& scene) {
  return scene.contacts == ContactKinds::none || has_intersections(scene);
}

std::span<const OptionNeed> option_needs() {
  return needs;
}

bool has_scene_octree(const SceneOptions& scene) {
  return viewer::uses_scene_octree(scene.broad_phase);
}
bool has_spheres(const SceneOptions& scene) {
  return scene.bounding_volume == BoundingVolume::sphere;
}

}  // namespace supple::cli
