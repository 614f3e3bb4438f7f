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
  if (question_.searches_at_rest() && !find_contacts(input, stats)) return false;
  if (question_.is_continuous() && !find_impacts(input, stats)) return false;
  if (question_.has_proximity() && !find_proximity(input, stats)) return false;
  stage.lap();
  if (question_.has_penetration()) {
    if (!find_penetrations(input, stats)) return false;
    stats.penetration_seconds = stage.lap();
  }
  list_non_finite();
  return true;
}

bool Detection::find_contacts(const PassInput& input, StepStats& stats) {
  intersected_objects_.resize(world_.slot_count());
  is_listed_.assign(world_.slot_count(), 0);
  for (const auto& [a, b] : input.jobs) {
    for (const std::uint32_t slot : {a, b}) {
      if (std::exchange(is_listed_[slot], std::uint8_t{1}) != 0) continue;
      WorldObject& object = world_[slot];
      intersected_objects_[slot] = {world_.id_of(slot), object.resting_view(), &object.octree(),
                                    object.vertex_groups(),
                                    object.tests_neighbours() ? &object.vertex_triangles() : nullptr};
    }
  }
  const IntersectionSearch search{question_.has_intersections(),
                                  question_.contact_points || question_.has_penetration(),
                                  question_.colliding_vertices};
  return intersection_pass_.run(input, intersected_objects_, search, stats);
}

bool Detection::find_impacts(const PassInput& input, StepStats& stats) {
  list_moving_objects(world_, MovingShape::Part::way, moving_objects_);
  return impact_pass_.run(input, moving_objects_, question_.impact, stats);
}

bool Detection::find_proximity(const PassInput& input, StepStats& stats) {
  list_moving_objects(world_, MovingShape::Part::end, moving_objects_);
  return proximity_pass_.run(input, moving_objects_, {question_.proximity_listing, question_.impact.kinds},
                             stats);
}

bool Detection::find_penetrations(const PassInput& input, StepStats& stats) {
  penetrated_objects_.assign(world_.slot_count(), {});
  for (const auto& [a, b] : input.jobs) {
    for (const std::uint32_t slot : {a, b}) {
      if (penetrated_objects_[slot].surface.octree != nullptr) continue;
      WorldObject& object = world_[slot];
      const std::span<const std::uint8_t> none, inward = question_.curves ? object.inward_triangles() : none;
      penetrated_objects_[slot] = {
          queried_object(world_, slot),
          {&object.octree(), &object.vertex_triangles(), &object.placement().end(),
           object.resting_view().translation, object.placement().is_mirrored(), inward},
          object.options.solid};
    }
  }
  DetectResult found;
  found.groups = intersection_pass_.groups();
  found.contacts = intersection_pass_.contacts();
  found.contact_points = intersection_pass_.contact_points();
  if (!penetration_pass_.run(input, penetrated_objects_, found, question_.curves)) return false;
  stats.penetrations = penetration_pass_.penetrations().size();
  stats.curves = penetration_pass_.curves().curves.size();
  return true;
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
  if (question_.searches_at_rest()) {
    found.truncated = intersection_pass_.is_truncated();
    found.groups = intersection_pass_.groups();
    found.contacts = intersection_pass_.contacts();
    found.contact_points = intersection_pass_.contact_points();
    found.colliding_vertex_groups = intersection_pass_.colliding_vertex_groups();
    found.colliding_vertices = intersection_pass_.colliding_vertices();
  }
  if (question_.is_continuous()) {
    found.truncated = found.truncated || impact_pass_.is_truncated();
    found.continuous_groups = impact_pass_.groups();
    found.continuous_contacts = impact_pass_.contacts();
  }
  if (question_.has_penetration()) {
    found.penetration_groups = penetration_pass_.groups();
    found.penetrations = penetration_pass_.penetrations();
    found.vertices_on_surface = penetration_pass_.vertices_on_surface();
    found.contained_parts = penetration_pass_.contained_parts();
    const CurveLists& curves = penetration_pass_.curves();
    found.curves = curves.curves;
    found.curve_contacts = curves.contacts;
    found.curve_points = curves.points;
    found.enclosed_vertices = curves.enclosed;
  }
  if (question_.has_proximity()) {
    found.truncated = found.truncated || proximity_pass_.is_truncated();
    found.proximity_groups = proximity_pass_.groups();
    found.proximity_pairs = proximity_pass_.pairs();
  }
  found.object_pairs = pairs_.pairs();
  found.non_finite_vertices = non_finite_;
  found.untested = untested_.list(world_, question_, found);
}

}  // namespace supple
