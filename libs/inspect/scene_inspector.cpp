#include "inspect/inspection.hpp"
#include "inspect/octree_statistics.hpp"
#include "scene/scene_implementation.hpp"
#include "supple/inspection.hpp"

namespace supple {
namespace {

const auto& inside(const Scene* scene) {
  return SceneAccess::of(*scene);
}

Inspection inspection(const Scene* scene) {
  const auto& of = inside(scene);
  return {of.world, of.detection, of.result, of.is_current()};
}

}  // namespace

std::vector<OctreeCell> SceneInspector::cells(ObjectId object, std::optional<std::uint32_t> level) const {
  return inspection(scene_).octree_cells(object, level);
}
OctreeCell SceneInspector::leaf(ObjectId object, std::uint32_t triangle) const {
  return inspection(scene_).leaf(object, triangle);
}
NodePairList SceneInspector::node_pairs(ObjectId object_a, ObjectId object_b) const {
  return inspection(scene_).node_pairs(object_a, object_b);
}
std::uint32_t SceneInspector::octree_depth(ObjectId object) const {
  return inspection(scene_).octree_depth(object);
}
OctreeStatistics SceneInspector::octree_statistics(ObjectId object) const {
  const World& world = inside(scene_).world;
  WorldObject& asked = world.object(object, "octree_statistics");
  asked.update_all_children(world.parallel);
  return supple::octree_statistics(asked);
}
Aabb SceneInspector::bounds(ObjectId object) const {
  return inside(scene_).world.object(object, "bounds").box();
}
std::vector<SceneRegion> SceneInspector::regions() const {
  return inside(scene_).detection.pairs().finder().regions();
}
std::vector<SceneRegion> SceneInspector::regions(ObjectId object) const {
  inside(scene_).world.object(object, "regions");
  return inside(scene_).detection.pairs().finder().regions(object.index);
}
CandidateList SceneInspector::candidates(std::size_t limit) const {
  return inspection(scene_).candidates(limit);
}
PairExplanation SceneInspector::explain(ObjectId object_a, std::uint32_t triangle_a, ObjectId object_b,
                                        std::uint32_t triangle_b) const {
  return inspection(scene_).explain(object_a, triangle_a, object_b, triangle_b);
}
std::string SceneInspector::validate() const {
  const auto& scene = inside(scene_);
  const std::string wrong = scene.world.validate();
  return wrong.empty() ? scene.detection.pairs().finder().validate() : wrong;
}

}  // namespace supple
