#include "commands/build_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "inputs/frame_files.hpp"
#include "inputs/parts.hpp"
#include "supple/comparison.hpp"

namespace supple::cli {
namespace {

/// Adds an object and returns its id; one overload per kind of motion.
struct Adder {
  Simulation& simulation;
  TriangleMesh mesh;
  const ObjectOptions& options;
  bool only_positions = false;  ///< without the elements

  ObjectId add(const auto&... motion) {
    if (only_positions) mesh = {mesh.name, std::move(mesh.positions), {}, {}, {}};
    return simulation.add(mesh, options, motion...);
  }

  ObjectId operator()(const WaveMotion& motion) {
    const auto swayed = [motion, border = simulation.options().border, rest = mesh.positions](
                            double seconds, std::span<Vec3d> positions) {
      apply_wave_motion(motion, border, rest, seconds, positions);
    };
    swayed(0, mesh.positions);
    return add(MotionFunction(swayed));
  }

  ObjectId operator()(const MassSpringMotion& motion) { return add(motion); }
  ObjectId operator()(const RigidMotion& motion) { return add(motion); }

  /// The step that ends at a time.
  auto step_at() const {
    return [time_step = simulation.options().time_step](double seconds) {
      return static_cast<std::uint64_t>(std::llround(seconds / time_step));
    };
  }

  ObjectId operator()(const FrameSequence& sequence) {
    const auto frames = std::make_shared<const FrameFiles>(sequence, mesh);
    frames->read(0, mesh.positions);
    return add(MotionFunction([step = step_at(), frames](double seconds, std::span<Vec3d> positions) {
      frames->read(step(seconds), positions);
    }));
  }

  ObjectId operator()(const ComputedMotion& motion) {
    motion.positions(0, mesh.positions);
    return add(
        MotionFunction([step = step_at(), read = motion.positions](
                           double seconds, std::span<Vec3d> positions) { read(step(seconds), positions); }));
  }

  ObjectId operator()(const RecordedMotion& motion) {
    return add(MotionFunction([step = step_at(), motion](double seconds, std::span<Vec3d> positions) {
      const std::vector<Vec3d> recorded = motion.recording->positions(step(seconds), motion.object);
      std::copy(recorded.begin(), recorded.end(), positions.begin());
    }));
  }
};

}  // namespace

void apply(const MethodOptions& options, Input& input) {
  input.simulation.scene = options.scene;
  input.simulation.scene.contacts = with_included(options.scene.contacts);
  input.simulation.fused_refit = options.fused_refit.value_or(false);
  for (InputObject& object : input.objects) {
    if (options.as_2007) object.options.octree = octree_of_2007();
    options.given_objects.apply_to(object.options);
    object.splits = object.splits || options.parts;
  }
  split_parts(input);
}

ObjectId add_positions(Simulation& simulation, const InputObject& object) {
  if (object.motion && std::holds_alternative<MassSpringMotion>(*object.motion))
    return add_object(simulation, object);
  const ObjectOptions options{.name = object.options.name};
  Adder adder{simulation, object.mesh, options, true};
  return object.motion ? std::visit(adder, *object.motion) : adder.add();
}

ObjectId add_object(Simulation& simulation, const InputObject& object) {
  return object.motion ? std::visit(Adder{simulation, object.mesh, object.options}, *object.motion)
                       : simulation.add(object.mesh, object.options);
}

Simulation build_simulation(const Input& input) {
  Simulation simulation(input.simulation);
  for (const InputObject& object : input.objects) add_object(simulation, object);
  return simulation;
}

}  // namespace supple::cli
