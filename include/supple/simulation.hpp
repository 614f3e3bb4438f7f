#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "supple/error.hpp"
#include "supple/mesh.hpp"
#include "supple/motion.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"
#include "supple/scene.hpp"
#include "supple/types.hpp"

namespace supple {

/// The border of a scene's motion: lowest and highest corner.
using Border = std::array<Vec3d, 2>;

/// A body of masses and springs, and how it is set in motion: first deformed in place by random forces, then
/// sent off with a velocity (section 4 of the paper). Random numbers come from the scene's seed and the
/// object's number: the same on every machine.
struct MassSpringMotion {
  MassSpringOptions springs{};
  Vec3d velocity{};                     ///< m/s, from `deform_seconds` on
  double random_speed = 0;              ///< m/s, in a random direction, added to it
  double random_force = 0;              ///< N, size of the random forces on the vertices; they sum to zero
  double deform_seconds = 0;            ///< for how long these act, before the object is sent off
  std::optional<std::uint64_t> seed{};  ///< instead of the object's number

  /// Vertices that are pulled along.
  struct Handle {
    std::vector<std::uint32_t> vertices{};
    Vec3d by{};          ///< m, where they are moved
    double seconds = 1;  ///< how long it takes, uniformly, > 0; then they hold
  };
  /// Their vertices become fixed ones of `springs`.
  std::vector<Handle> handles{};
};

/// The user's own motion: writes where the vertices are at `seconds`; `positions` holds where they were the
/// step before (at first, at rest).
using MotionFunction = std::function<void(double seconds, std::span<Vec3d> positions)>;

/// Simple response to contacts: vertices and edges that would pass through something, or come nearer than
/// `thickness`, get impulses along the contact's normal that stop the approach. Momentum is conserved between
/// bodies of masses and springs; whatever moves otherwise, or rests, is not moved by it. It pushes apart what
/// it can and makes no promise; the contacts reported are those of the scene.
struct ContactResponse {
  bool enabled = false;
  double thickness = 1e-3;       ///< m, > 0
  double restitution = 0;        ///< 0 stops the approach, 1 returns it
  double friction = 0;           ///< Coulomb's coefficient, ≥ 0
  std::uint32_t iterations = 4;  ///< rounds of detection and impulses a step, ≥ 1
};

struct SimulationOptions {
  SceneOptions scene{};
  double time_step = 0.01;  ///< s, > 0
  /// Turns bodies of masses and springs back: one that reaches beyond a side and moves outward has its mean
  /// velocity along that axis reversed.
  std::optional<Border> border{};
  std::uint64_t seed = 0;
  ContactResponse response{};
};

/// A body that could not be carried on: a number stopped being finite, or a vertex flew off.
struct MotionError : Error {
  MotionError(const std::string& message, std::string object_name, std::uint64_t at_step)
      : Error(message), object(std::move(object_name)), step(at_step) {}
  std::string object;
  std::uint64_t step = 0;  ///< the one that failed: all objects are as after the step before
};

/// Objects that move by themselves, and the collisions between them, step by step.
///
/// ```cpp
/// supple::Simulation simulation({.border = supple::Border{{{-1, -1, -1}, {1, 1, 1}}}, .seed = 1});
/// simulation.add(supple::make_model("rabbit"), {}, supple::MassSpringMotion{.random_speed = 0.4});
/// for (int i = 0; i < 1000; ++i) {
///   for (const supple::Contact& c : simulation.step().contacts) ...
/// }
/// ```
class Simulation {
 public:
  /// Throws `Error` when an option is out of its range.
  explicit Simulation(const SimulationOptions& options = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// An object that stays, until `set_positions`. Each throws `Error` as `Scene::add` and `MassSpringBody`
  /// do.
  ObjectId add(const TriangleMesh& mesh, const ObjectOptions& object = {});
  ObjectId add(const TriangleMesh& mesh, const ObjectOptions& object, const MassSpringMotion& motion);
  ObjectId add(const TriangleMesh& mesh, const ObjectOptions& object, MotionFunction motion);
  void remove(ObjectId object);

  /// What touches where everything is now. Nothing moves; there are no continuous contacts.
  const DetectResult& detect();
  /// Moves everything on by one time step, then detects: continuous contacts are those of the way there.
  /// Throws `MotionError` when a body blows up; whatever the user's motion throws comes through. Either way
  /// everything is as before the call.
  const DetectResult& step();

  std::uint64_t step_count() const;  ///< steps taken
  double time() const;               ///< s: step_count() · time_step
  double motion_seconds() const;     ///< by the wall clock, of the last step: all but detection
  const SimulationOptions& options() const;

  /// The scene that detects; objects are moved by the simulation alone.
  const Scene& scene() const;
  std::span<const Vec3d> positions(ObjectId object) const;
  /// Puts an object somewhere else: an object without motion, or a body, which keeps its velocities. At the
  /// next step continuous contacts see the way from here.
  void set_positions(ObjectId object, std::span<const Vec3d> positions);
  /// The masses and springs of an object, to look at or to push; null when it has none.
  MassSpringBody* body(ObjectId object);
  const MassSpringBody* body(ObjectId object) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple
