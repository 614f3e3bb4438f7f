#include "sources/simulation_source.hpp"

#include <variant>

#include "sources/extent.hpp"
#include "sources/start.hpp"

namespace supple::viewer {

SimulationSource::SimulationSource(const SceneView& show)
    : show_(show),
      simulation_(show.simulation),
      versions_(show.objects.size(), 1),
      bends_(show.objects.size()) {
  for (const ViewedObject& object : show.objects) add(object);
  simulation_.detect();
}

void SimulationSource::add(const ViewedObject& object) {
  if (const auto* const springs = std::get_if<MassSpringMotion>(&object.motion)) {
    ids_.push_back(simulation_.add(object.mesh, object.options, *springs));
  } else if (const auto* const rigid = std::get_if<RigidMotion>(&object.motion)) {
    ids_.push_back(simulation_.add(object.mesh, object.options, *rigid));
  } else if (std::holds_alternative<WaveMotion>(object.motion)) {
    const std::size_t number = ids_.size();
    ids_.push_back(simulation_.add(start_of(show_, object), object.options,
                                   [this, number](double seconds, std::span<Vec3d> positions) {
                                     move_swaying(number, seconds, positions);
                                   }));
  } else {
    ids_.push_back(simulation_.add(object.mesh, object.options));
  }
}

void SimulationSource::set_detection(const SceneView& show) {
  std::vector<SceneObject> objects;
  for (const ViewedObject& object : show.objects) objects.push_back({&object.mesh, object.options});
  simulation_.set_detection(show.simulation.scene, objects);
  is_detected_ = true;
}

/// Adds up the waves, earlier bends, and the current drag of the held vertices.
void SimulationSource::move_swaying(std::size_t object, double seconds, std::span<Vec3d> positions) {
  const ViewedObject& shown = show_.objects[object];
  apply_wave_motion(std::get<WaveMotion>(shown.motion), show_.simulation.border, shown.mesh.positions,
                    seconds, positions);
  const std::vector<Vec3d>& bend = bends_[object];
  for (std::size_t i = 0; i < bend.size(); ++i) positions[i] = positions[i] + bend[i];
  if (!grip_ || grip_->object != object || !grip_->target) return;
  held_offset_ = *grip_->target - positions[grip_->vertex];
  for (std::size_t i = 0; i < grip_->vertices.size(); ++i) {
    Vec3d& p = positions[grip_->vertices[i]];
    p = p + grip_->weights[i] * held_offset_;
  }
}

std::optional<std::string> SimulationSource::take_step() {
  if (grip_ && grip_->target) {
    pull_held();
    is_dragged_ |= is_rigid(grip_->object);  // the last step moved it away from the target
    bend_held();
  }
  if (const auto error = simulation_.try_step()) return error->what();
  is_detected_ = true;
  motion_seconds_ = simulation_.motion_seconds();
  for (std::size_t i = 0; i < versions_.size(); ++i) {
    if (moves_by_itself(i)) ++versions_[i];
  }
  return std::nullopt;
}

std::optional<std::string> SimulationSource::grab(std::size_t object, std::uint32_t vertex,
                                                  std::optional<double> radius) {
  release();
  const ViewedObject& shown = show_.objects[object];
  const std::string& name = scene().options(ids_[object]).name;
  if (shown.options.is_static) return name + " is static: it cannot be moved or bent";
  const auto about_vertex = [&] { return "vertex " + std::to_string(vertex) + " of " + name; };
  if (!is_finite(shown.mesh.positions[vertex]) || !is_finite(positions(object)[vertex]))
    return about_vertex() + " is not at a finite position; choose another one";
  is_fixed_.clear();
  if (const MassSpringBody* const body = simulation_.body(ids_[object])) {
    is_fixed_.resize(shown.mesh.positions.size());
    for (const std::uint32_t fixed : body->options().fixed_vertices) is_fixed_[fixed] = true;
    if (is_fixed_[vertex]) return about_vertex() + " is fixed; choose another one";
  }
  grip_ = take_hold(shown.mesh, positions(object), vertex, radius);
  grip_->object = object;
  return std::nullopt;
}

void SimulationSource::drag(const Vec3d& target) {
  grip_->target = target;
  is_dragged_ = true;
}

void SimulationSource::release() {
  if (!grip_) return;
  settle();
  if (grip_->target && std::holds_alternative<WaveMotion>(show_.objects[grip_->object].motion)) {
    std::vector<Vec3d>& bend = bends_[grip_->object];
    bend.resize(show_.objects[grip_->object].mesh.positions.size());
    for (std::size_t i = 0; i < grip_->vertices.size(); ++i)
      bend[grip_->vertices[i]] = bend[grip_->vertices[i]] + grip_->weights[i] * held_offset_;
  }
  grip_.reset();
  is_dragged_ = false;
  held_offset_ = {};
}

bool SimulationSource::needs_steps() const {
  return grip_ && grip_->target && moves_in_steps(grip_->object);
}

bool SimulationSource::settle() {
  bend_held();
  if (is_detected_) return false;
  simulation_.detect();
  is_detected_ = true;
  return true;
}

void SimulationSource::bend_held() {
  if (!grip_ || !is_dragged_ || moves_in_steps(grip_->object)) return;
  const std::span<const Vec3d> now = positions(grip_->object);
  scratch_.assign(now.begin(), now.end());
  if (is_rigid(grip_->object))
    carry(*grip_, scratch_);
  else
    bend(*grip_, scratch_);
  simulation_.set_positions(ids_[grip_->object], scratch_);
  ++versions_[grip_->object];
  is_dragged_ = false;
  is_detected_ = false;
}

void SimulationSource::pull_held() {
  if (MassSpringBody* const body = simulation_.body(ids_[grip_->object]))
    pull(*grip_, is_fixed_, *body, show_.simulation.time_step, scratch_);
}

}  // namespace supple::viewer
