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
/// sent off with a velocity (section 4 of the paper: v_i = v_i + v_d). Times count from when the object is
/// added. Random numbers come from the simulation's seed and the object's number: the same on every machine.
struct MassSpringMotion {
  /// `threads` = 0 leaves it to the simulation: many small bodies are stepped side by side, large ones by all
  /// threads.
  MassSpringOptions springs{};
  Vec3d velocity{};         ///< m/s, from `deform_seconds` on
  double random_speed = 0;  ///< m/s, ≥ 0, in a random direction, added to it
  /// N, ≥ 0, root mean square of the random forces on the vertices. They are waves about as long as the
  /// object, so that neighbours are pulled alike, and stay the same all the while; they sum to zero and turn
  /// nothing.
  double random_force = 0;
  double deform_seconds = 0;            ///< ≥ 0, for how long these act, before the object is sent off
  std::optional<std::uint64_t> seed{};  ///< instead of the object's number

  /// Vertices that are pulled along.
  struct Handle {
    std::vector<std::uint32_t> vertices{};
    Vec3d by{};          ///< m, where they are moved
    double seconds = 1;  ///< how long it takes, uniformly, > 0; then they hold
  };
  /// Their vertices become fixed ones of `springs`; a vertex belongs to one handle at most.
  std::vector<Handle> handles{};
};

/// The user's own motion: writes where the vertices are at `seconds`, the simulation's time at the end of the
/// step; `positions` holds where they were the step before (at first, at rest). Called once a step, from one
/// thread, in the order of objects, and again for the same step when that fails and is repeated. It must not
/// call the simulation.
using MotionFunction = std::function<void(double seconds, std::span<Vec3d> positions)>;

/// Simple response to contacts, by impulses (Bridson, Fedkiw and Anderson 2002): vertices and faces, and
/// edges, that would pass through each other in a step, or come nearer than `thickness`, get impulses along
/// the contact's normal that stop the approach; what is too near already is moved apart gently, by a tenth of
/// what is missing a step. An impulse also moves the vertices about, as far as springs carry it in a step, so
/// that it does not strain them by more than it takes from the motion; energy grows by no more than what
/// moving apart takes, a percent or so at long steps. Objects are tested against themselves where
/// `self_collision` asks for it, and groups and masks hold. Momentum is conserved between bodies of masses
/// and springs; fixed vertices, and whatever moves otherwise or rests, are not moved.
///
/// It makes no promise; the contacts reported are those of the scene. It works as long as objects do not
/// intersect at first and steps are short: nothing moves further than about an edge in one. `time_step` may
/// be several times as long as springs bear without substeps; impulses go no further than 1024 vertices, so
/// springs that carry them further, h² stiffness / mass above 100 or so, may gain energy.
/// `thickness` should be well below the shortest edge.
///
/// Costs up to `iterations` continuous detections a step, and memory for a second scene and, for each vertex
/// that touched something, 16 bytes a vertex that its impulses move.
struct ContactResponse {
  bool enabled = false;
  double thickness = 1e-3;       ///< m, > 0
  double restitution = 0;        ///< from 0, which stops the approach, to 1, which returns it
  double friction = 0;           ///< Coulomb's coefficient, ≥ 0
  std::uint32_t iterations = 4;  ///< rounds of detection and impulses a step at most, ≥ 1
};

struct SimulationOptions {
  SceneOptions scene{};
  double time_step = 0.01;  ///< s, > 0
  /// Turns bodies of masses and springs back (section 5.2 of the paper): one that reaches beyond a side after
  /// a step, and whose mean velocity points outward, has that velocity reversed along the axis. So it may
  /// reach out by the way of a step, comes back from wherever it is, and loses no speed; gravity does not
  /// press it out. One that is larger than the room is turned back at every step, and so stays where it is.
  /// Fixed vertices are not turned. A side may be infinite.
  std::optional<Border> border{};
  std::uint64_t seed = 0;
  ContactResponse response{};
};

/// A body that could not be carried on: a number stopped being finite, or a vertex flew off. The message
/// names the object and the step, and says which time step would do.
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

  /// What touches where everything is now. Nothing moves: continuous contacts are those at time 0.
  const DetectResult& detect();
  /// Moves everything on by one time step, then detects: continuous contacts are those of the way there,
  /// which is straight. Throws `MotionError` when a body blows up; whatever the user's motion throws comes
  /// through. Either way everything is as before the call. Objects without motion cost nothing.
  const DetectResult& step();
  /// As `step`, but gives the error instead of throwing it when a body blows up; nothing when the step was
  /// taken: `scene().result()` then has what was detected. For builds without exceptions.
  [[nodiscard]] std::optional<MotionError> try_step();

  std::uint64_t step_count() const;  ///< steps taken
  double time() const;               ///< s: step_count() · time_step
  double motion_seconds() const;     ///< by the wall clock, of the last step: all but detection
  const SimulationOptions& options() const;

  /// The scene that detects; objects are moved by the simulation alone.
  const Scene& scene() const;
  std::span<const Vec3d> positions(ObjectId object) const;
  /// Puts an object somewhere else: an object without motion, or a body, which keeps its velocities. It is
  /// there at once: at the next step continuous contacts see the way from here. Throws `Error` as
  /// `Scene::set_positions` does, or when the object is moved by a function.
  void set_positions(ObjectId object, std::span<const Vec3d> positions);
  /// The masses and springs of an object, to look at or to push; null when it has none. Stays where it is
  /// until the object is removed. Positions that are set here show after the next step; external forces are
  /// those of the simulation until `deform_seconds` have passed.
  MassSpringBody* body(ObjectId object);
  const MassSpringBody* body(ObjectId object) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple
