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
#include "supple/response.hpp"
#include "supple/result.hpp"
#include "supple/scene.hpp"
#include "supple/types.hpp"

namespace supple {

/// The border of a scene's motion: lowest and highest corner.
using Border = std::array<Vec3d, 2>;

/// A body of masses and springs and its initial motion: random forces deform it in place, then it gets a
/// velocity (section 4 of the paper: v_i = v_i + v_d). Times count from when the object is added. Random
/// numbers depend on the simulation's seed and the object's index and are the same on every machine.
struct MassSpringMotion {
  /// With `threads` = 0 the simulation decides: it advances many small bodies in parallel, and each large
  /// body with all threads.
  MassSpringOptions springs{};
  Vec3d velocity{};         ///< from `deform_seconds` on, m/s
  double random_speed = 0;  ///< speed in a random direction, added to `velocity`, m/s, ≥ 0
  /// Root mean square of the random forces on the vertices, N, ≥ 0. The forces are waves about as long as the
  /// object, so neighbours get similar forces. Their sum and their torque are zero.
  double random_force = 0;
  /// How long the object deforms in place before it gets its velocity, s, ≥ 0. Constant random forces end
  /// then.
  double deform_seconds = 0;
  /// Time in which the random forces change smoothly into others that are independent of them, s, ≥ 0. Above
  /// 0 they act from the first step to the last. 0: they are constant and end after `deform_seconds`.
  double force_change_seconds = 0;
  std::optional<std::uint64_t> seed{};  ///< replaces the object's index

  /// Vertices that move at constant velocity and then stop.
  struct Handle {
    std::vector<std::uint32_t> vertices{};
    Vec3d by{};          ///< displacement, m
    double seconds = 1;  ///< duration of the movement, s, > 0
  };
  /// Their vertices become fixed vertices of `springs`. A vertex belongs to at most one handle.
  std::vector<Handle> handles{};
};

/// A rigid object that moves at constant velocity and turns about the centre of its vertices. The border
/// reflects its velocity. Without spin each step is one `Scene::translate`, O(1), otherwise one
/// `Scene::set_transform`. Random numbers depend on the simulation's seed and the object's index and are the
/// same on every machine.
struct RigidMotion {
  Vec3d velocity{};         ///< m/s
  double random_speed = 0;  ///< speed in a random direction, added to `velocity`, m/s, ≥ 0
  /// Angular velocity: its direction is the axis, its length degrees per second, counter-clockwise.
  Vec3d spin{};
  double random_spin = 0;               ///< about a random axis, added to `spin`, degrees per second, ≥ 0
  std::optional<std::uint64_t> seed{};  ///< replaces the object's index
};

/// The user's own motion: writes the positions of the vertices at `seconds`, the time at the end of the step.
/// On entry, `positions` contains the positions of the step before, and the rest positions in the first step.
/// The simulation calls the function once per step, from one thread, in the order of objects. It calls it
/// again for the same step when the step failed and is repeated. The function must not call the simulation.
using MotionFunction = std::function<void(double seconds, std::span<Vec3d> positions)>;

/// Options of a simulation, fixed at its construction.
struct SimulationOptions {
  SceneOptions scene{};
  double time_step = 0.01;  ///< s, > 0
  /// Reflects bodies of masses and springs, and rigid objects (section 5.2 of the paper): when a body reaches
  /// beyond a side after a step and its mean velocity points outward, that velocity is reversed along the
  /// axis. So a body
  /// may reach outside by the length of one step. It returns from any position, keeps its speed, and gravity
  /// does not push it out. A body larger than the border is reflected in every step and so stays in
  /// place. Fixed vertices are not reflected. A side may be infinite.
  std::optional<Border> border{};
  std::uint64_t seed = 0;  ///< seed of all random numbers
  /// The loop of the motion of masses and springs finds the bounds of each body, as in the paper (section
  /// 5.2), so that the refit does not read their vertices again. Needs `ComparisonOptions::lazy_refit`.
  bool fused_refit = false;
  /// Contacts push masses and springs apart; nothing: they do not. Fixed vertices and all other objects do
  /// not react. The margins of the objects are raised to `least_margin`. When the scene finds proximity in
  /// the listing of features, the response uses this result, otherwise it finds the same itself.
  ///
  /// An impulse also moves the surrounding vertices, as far as springs transmit it in a step, so that it
  /// strains the springs by no more energy than it takes from the motion. The energy grows only when elements
  /// that are too near are moved apart, by a few percent of the energy of an impact at long steps. Momentum
  /// is conserved between bodies of masses and springs.
  ///
  /// The response does not guarantee that objects stay apart; the scene reports the contacts that remain. It
  /// works when objects do not intersect at first and steps are short, so that nothing moves further than
  /// about an edge in one. `time_step` may be several times the stable step of springs without substeps.
  /// Impulses reach at most 1024 vertices, so springs that transmit them further (h² stiffness / mass above
  /// 100 or so) may gain energy. `thickness` should be well below the length of the shortest edge.
  ///
  /// Cost: usually one continuous detection per step, at most `iterations`, and memory for a second scene.
  /// For each vertex that touched something, it also takes 16 bytes for each vertex that its impulses move,
  /// once for all bodies with equal springs.
  std::optional<ContactResponse> response{};
};

/// A step of a body failed: a number was no longer finite, or a vertex moved too far. The message names the
/// object, the step and a stable time step.
struct MotionError : Error {
  /// The message, the name of the object, and the step that failed.
  MotionError(const std::string& message, std::string object_name, std::uint64_t at_step)
      : Error(message), object(std::move(object_name)), step(at_step) {}
  std::string object;
  std::uint64_t step = 0;  ///< the step that failed; all objects are as after the step before
};

/// A mesh and its options, as `Simulation::add` takes them. The mesh must outlive the call.
struct SceneObject {
  const TriangleMesh* mesh = nullptr;
  ObjectOptions options{};
};

/// Moves objects by their own motion, step by step, and finds the collisions between them.
///
/// When memory runs out, functions that are not const throw `std::bad_alloc` and may have done a part of
/// their work: then only destroy the simulation.
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

  /// Adds an object that only `set_positions` moves, a body of masses and springs, a rigid object that moves,
  /// or an object with the user's motion. Throws `Error` as `Scene::add` and `MassSpringBody` do.
  ObjectId add(const TriangleMesh& mesh, const ObjectOptions& object = {});
  ObjectId add(const TriangleMesh& mesh, const ObjectOptions& object, const MassSpringMotion& motion);
  ObjectId add(const TriangleMesh& mesh, const ObjectOptions& object, const RigidMotion& motion);
  ObjectId add(const TriangleMesh& mesh, const ObjectOptions& object, MotionFunction motion);
  void remove(ObjectId object);

  /// Finds the contacts at the present positions. Nothing moves: continuous contacts are those at time 0. The
  /// request gives the limits of the detection, here and below; its kinds must be those of the scene. A
  /// detection that is stopped has no contacts, but the step was taken.
  const DetectResult& detect(const DetectRequest& request = {});
  /// Advances all objects by one time step, then detects. Continuous contacts are those on the straight paths
  /// of the step. Throws `MotionError` when a body fails, and rethrows what the user's motion throws; the
  /// state is then as before the call. Objects without motion cost nothing.
  const DetectResult& step(const DetectRequest& request = {});
  /// As `step`, but returns the error instead of throwing it when a body fails. Returns nothing when the step
  /// succeeded; `scene().result()` then has the result. For builds without exceptions.
  [[nodiscard]] std::optional<MotionError> try_step(const DetectRequest& request = {});

  /// Replaces the scene by one with other options, and detects at the present positions. `objects` has all
  /// objects, in the order in which they were added. Their motion keeps its state: only the detection
  /// changes. Events begin again. Cost: that of `Scene::add` for each object. Throws `Error` as `Scene` does,
  /// and when an object was removed before; then nothing changes.
  const DetectResult& set_detection(const SceneOptions& options, std::span<const SceneObject> objects);

  std::uint64_t step_count() const;  ///< steps taken
  double time() const;               ///< step_count() · time_step, s
  double motion_seconds() const;     ///< wall-clock time of the last step without detection
  const SimulationOptions& options() const;

  /// The scene of the simulation. Only the simulation moves its objects.
  const Scene& scene() const;
  /// `Scene::set_observer` of this scene: it sees each detection of the simulation.
  void set_observer(DetectObserver observer);
  /// `Scene::keep_result` of this scene.
  std::shared_ptr<const void> keep_result();
  /// The positions of all vertices. They are valid until the next step. Of a rigid object, the first call
  /// after a step computes them, O(n), so calls for one object must not overlap.
  std::span<const Vec3d> positions(ObjectId object) const;
  /// Sets the positions of an object without motion, of a body, which keeps its velocities, or of a rigid
  /// object, which keeps its velocity and spin and turns about its new centre from now on. They apply
  /// at once: the paths of the next step start there. Throws `Error` as `Scene::set_positions` does, and when
  /// the user's motion moves the object.
  void set_positions(ObjectId object, std::span<const Vec3d> positions);
  /// The masses and springs of an object; null when it has none. The pointer is valid until the object is
  /// removed. The scene sees positions that are set here after the next step. While random forces act, the
  /// simulation sets the external forces.
  MassSpringBody* body(ObjectId object);
  const MassSpringBody* body(ObjectId object) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple
