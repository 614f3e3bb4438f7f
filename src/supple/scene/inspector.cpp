// `SceneInspector`: the public face of src/supple/inspect.

#include "scene/scene_implementation.hpp"
#include "supple/inspection.hpp"

namespace supple {

std::vector<OctreeCell> SceneInspector::cells(ObjectId object, std::optional<std::uint32_t> level) const {
  return scene_->implementation_->inspection().octree_cells(object, level);
}
OctreeCell SceneInspector::leaf(ObjectId object, std::uint32_t triangle) const {
  return scene_->implementation_->inspection().leaf(object, triangle);
}
NodePairList SceneInspector::node_pairs(ObjectId object_a, ObjectId object_b) const {
  return scene_->implementation_->inspection().node_pairs(object_a, object_b);
}
std::uint32_t SceneInspector::octree_depth(ObjectId object) const {
  return scene_->implementation_->inspection().octree_depth(object);
}
OctreeStatistics SceneInspector::octree_statistics(ObjectId object) const {
  const World& world = scene_->implementation_->world;
  WorldObject& asked = world.object(object, "octree_statistics");
  asked.update_all_children(world.parallel);
  return asked.octree_statistics();
}
Aabb SceneInspector::bounds(ObjectId object) const {
  return scene_->implementation_->world.object(object, "bounds").box();
}
std::vector<SceneRegion> SceneInspector::regions() const {
  return scene_->implementation_->detection.pairs().finder().regions();
}
std::vector<SceneRegion> SceneInspector::regions(ObjectId object) const {
  scene_->implementation_->world.object(object, "regions");
  return scene_->implementation_->detection.pairs().finder().regions(object.index);
}
CandidateList SceneInspector::candidates(std::size_t limit) const {
  return scene_->implementation_->inspection().candidates(limit);
}
PairExplanation SceneInspector::explain(ObjectId object_a, std::uint32_t triangle_a, ObjectId object_b,
                                        std::uint32_t triangle_b) const {
  return scene_->implementation_->inspection().explain(object_a, triangle_a, object_b, triangle_b);
}
std::string SceneInspector::validate() const {
  const Scene::Implementation& scene = *scene_->implementation_;
  const std::string wrong = scene.world.validate();
  return wrong.empty() ? scene.detection.pairs().finder().validate() : wrong;
}

}  // namespace supple
