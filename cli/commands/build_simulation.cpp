#include "commands/build_simulation.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

#include "supple/comparison.hpp"

namespace supple::cli {
namespace {

/// Where the motion of an object starts: its octree is built there.
std::vector<Vec3d> start_positions(const InputObject& object, const std::optional<Border>& border) {
  std::vector<Vec3d> positions = object.mesh.positions;
  if (const auto* const wave = motion_of<WaveMotion>(object))
    apply_wave_motion(*wave, border, object.mesh.positions, 0, positions);
  if (const auto frames = frames_of(object)) frames->positions(0, positions);
  return positions;
}

/// Adds an object and returns its id; one overload per kind of motion.
struct Adder {
  Simulation& simulation;
  const InputObject& object;
  const ObjectOptions& options;
  bool only_positions = false;  ///< without the elements

  ObjectId add(const auto&... motion) {
    TriangleMesh mesh = only_positions ? TriangleMesh{object.mesh.name, {}, {}} : object.mesh;
    mesh.positions = start_positions(object, simulation.options().border);
    return simulation.add(mesh, options, motion...);
  }

  ObjectId operator()(const WaveMotion& motion) {
    return add(MotionFunction([motion, border = simulation.options().border, rest = object.mesh.positions](
                                  double seconds, std::span<Vec3d> positions) {
      apply_wave_motion(motion, border, rest, seconds, positions);
    }));
  }

  ObjectId operator()(const MassSpringMotion& motion) { return add(motion); }
  ObjectId operator()(const RigidMotion& motion) { return add(motion); }

  /// Frames: step k ends with frame k.
  ObjectId operator()(const auto&) {
    return add(
        MotionFunction([read = frames_of(object)->positions, time_step = simulation.options().time_step](
                           double seconds, std::span<Vec3d> positions) {
          read(static_cast<std::uint64_t>(std::llround(seconds / time_step)), positions);
        }));
  }
};

}  // namespace

void apply(const MethodOptions& options, Input& input) {
  input.simulation.scene = options.scene;
  input.simulation.scene.contacts = with_included(options.scene.contacts);
  input.simulation.fused_refit = options.fused_refit.value_or(false);
  apply_to_objects(options.given_objects, options.as_2007, options.parts, input);
}

void apply_to_objects(const viewer::Overrides<ObjectOptions>& given, bool as_2007, bool parts, Input& input) {
  for (InputObject& object : input.objects) {
    if (as_2007) object.options.octree = octree_of_2007();
    given.apply_to(object.options);
    object.splits = object.splits || parts;
  }
  split_parts(input);
}

RecordedObject recorded_object(ObjectId id, const InputObject& object, const std::optional<Border>& border) {
  ObjectOptions options = object.options;
  options.edges.insert(options.edges.end(), object.mesh.edges.begin(), object.mesh.edges.end());
  options.points.insert(options.points.end(), object.mesh.points.begin(), object.mesh.points.end());
  return {id, std::move(options), start_positions(object, border), object.mesh.triangles};
}

ObjectId add_positions(Simulation& simulation, const InputObject& object) {
  if (motion_of<MassSpringMotion>(object)) return add_object(simulation, object);
  const ObjectOptions options{.name = object.options.name};
  Adder adder{simulation, object, options, true};
  return object.motion ? std::visit(adder, *object.motion) : adder.add();
}

ObjectId add_object(Simulation& simulation, const InputObject& object) {
  return object.motion ? std::visit(Adder{simulation, object, object.options}, *object.motion)
                       : simulation.add(object.mesh, object.options);
}

Simulation build_simulation(const Input& input) {
  Simulation simulation(input.simulation);
  for (const InputObject& object : input.objects) add_object(simulation, object);
  return simulation;
}

}  // namespace supple::cli
