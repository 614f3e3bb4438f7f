#include "answers/detection.hpp"

#include <utility>

#include "core/timer.hpp"
#include "octree/comparison_methods.hpp"
#include "queries/queries.hpp"

namespace supple {

bool Detection::run(const Question& question, std::uint64_t max_contacts, const StopSignal& stop,
                    StepStats& stats) {
  question_ = question;
  Timer stage;
  const World::Work refitted = world_.refit(question_.shapes());
  stats.objects_refitted = refitted.objects;
  stats.triangles_refitted = refitted.triangles;
  stats.refit_seconds = stage.lap();
  pairs_.find(question_);
  const BroadPhaseStats& broad_phase = pairs_.finder().stats();
  stats.broad_phase_method = broad_phase.method;
  stats.object_pairs_tested = broad_phase.object_pairs_tested;
  stats.object_pairs = pairs_.pairs().size();
  stats.broad_phase_seconds = stage.lap();
  if (stop.stop_requested()) return false;
  if (question_.shapes().lazy) {
    stats.triangles_refitted +=
        comparison_methods({}).refit_where_objects_meet(world_, pairs_.jobs(), node_pairs_, children_);
    stats.refit_seconds += stage.lap();
  }
  const World::Work rebuilt = world_.rebuild_degraded(pairs_.jobs(), pairs_.boxes());
  stats.octrees_rebuilt = rebuilt.objects;
  stats.triangles_rebuilt = rebuilt.triangles;
  stats.rebuild_seconds = stage.lap();
  const PassInput input{pairs_.jobs(), world_.versions(), max_contacts, stop, world_.parallel};
  DetectResult found;
  const auto find_all = [&](auto&... pass) { return (find(pass, input, found, stats) && ...); };
  if (!std::apply(find_all, passes_)) return false;
  list_non_finite();
  return true;
}

/// Runs the pass of a kind that the question has. `found` are the lists of the passes before it. Returns
/// false when it was stopped.
template <class Kind>
bool Detection::find(Kind& pass, const PassInput& input, DetectResult& found, StepStats& stats) {
  if (!question_.searches(Kind::answers)) return true;
  Timer timer;
  auto& objects = std::get<std::vector<typename Kind::Object>>(objects_);
  list_objects(Kind::answers, objects);
  if (!pass.run(input, objects, Kind::search_of(question_, found), stats)) return false;
  pass.list(found);
  if constexpr (Kind::answers == ContactKinds::penetration) stats.penetration_seconds = timer.lap();
  return true;
}

void Detection::list_objects(ContactKinds, std::vector<IntersectedObject>& objects) {
  objects.resize(world_.slot_count());
  is_listed_.assign(world_.slot_count(), 0);
  for (const auto& [a, b] : pairs_.jobs()) {
    for (const std::uint32_t slot : {a, b}) {
      if (std::exchange(is_listed_[slot], std::uint8_t{1}) != 0) continue;
      WorldObject& object = world_[slot];
      objects[slot] = {world_.id_of(slot), object.resting_view(), &object.octree(), object.vertex_groups(),
                       object.tests_neighbours() ? &object.vertex_triangles() : nullptr};
    }
  }
}

void Detection::list_objects(ContactKinds kind, std::vector<MovingObject>& objects) {
  const bool is_way = info_of(kind).shape == SearchedShape::paths;
  list_moving_objects(world_, is_way ? MovingShape::Part::way : MovingShape::Part::end, objects);
}

void Detection::list_objects(ContactKinds, std::vector<PenetratedObject>& objects) {
  objects.assign(world_.slot_count(), {});
  for (const auto& [a, b] : pairs_.jobs()) {
    for (const std::uint32_t slot : {a, b}) {
      if (objects[slot].surface.octree != nullptr) continue;
      WorldObject& object = world_[slot];
      const std::span<const std::uint8_t> none, inward = question_.curves ? object.inward_triangles() : none;
      objects[slot] = {queried_object(world_, slot),
                       {&object.octree(), &object.vertex_triangles(), &object.placement().end(),
                        object.resting_view().translation, object.placement().is_mirrored(), inward},
                       object.options.solid};
    }
  }
}

void Detection::list_non_finite() {
  non_finite_.clear();
  for (std::uint32_t slot = 0; slot < world_.slot_count(); ++slot) {
    const WorldObject* const object = world_.at(slot);
    if (object == nullptr) continue;
    for (const std::uint32_t vertex : object->non_finite_vertices(question_.shapes()))
      non_finite_.push_back({world_.id_of(slot), vertex, object->non_finite_position(vertex)});
  }
}

void Detection::list(DetectResult& found) {
  const auto list_pass = [&]<class Kind>(const Kind& pass) {
    if (question_.searches(Kind::answers)) pass.list(found);
  };
  std::apply([&](const auto&... pass) { (list_pass(pass), ...); }, passes_);
  found.object_pairs = pairs_.pairs();
  found.non_finite_vertices = non_finite_;
  found.untested = untested_.list(world_, question_, found);
}

}  // namespace supple
