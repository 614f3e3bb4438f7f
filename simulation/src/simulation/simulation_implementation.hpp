#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/parallel.hpp"
#include "simulation/contact_impulses.hpp"
#include "simulation/impulse_spread.hpp"
#include "simulation/moving_body.hpp"
#include "simulation/rigid_body.hpp"
#include "supple/simulation.hpp"

namespace supple {

/// The motion of an object; null pointers do not occur.
using ObjectMotion =
    std::variant<std::monostate, const MassSpringMotion*, const RigidMotion*, MotionFunction>;

/// One object, moved by masses and springs, as a rigid body, by a function, or not at all.
struct SimulatedObject {
  ObjectId id;
  std::unique_ptr<MovingBody> moving_body;
  std::optional<RigidBody> rigid_body;
  MotionFunction function;
  std::vector<Vec3d> own_positions;       // for objects without a body
  std::vector<Vec3d> next;                // the output of the function, until the step succeeds
  std::vector<Vec3d> before;              // positions before the last step, kept only when paths are needed
  bool is_on_path = false;                // the scene has a path: of the last step, or one that was tried out
  std::shared_ptr<ImpulseSpread> spread;  // for bodies, with a response; shared by those with equal springs
  std::vector<double> inverse_masses;
  std::optional<std::string> failure;  // why the body failed in this step, as text
  std::exception_ptr exception;        // and as the exception, when there was memory for it

  bool has_failed() const { return failure.has_value() || exception != nullptr; }
  bool moves() const { return moving_body != nullptr || rigid_body || function != nullptr; }
  std::span<const Vec3d> positions() const {
    if (moving_body != nullptr) return moving_body->body.positions();
    return rigid_body ? rigid_body->positions() : std::span<const Vec3d>(own_positions);
  }
};

class Simulation::Implementation {
 public:
  explicit Implementation(const SimulationOptions& options);

  ObjectId add(const TriangleMesh& mesh, ObjectOptions object_options, ObjectMotion motion);
  void remove(ObjectId id);
  const DetectResult& detect(const DetectRequest& request);
  std::optional<MotionError> try_step(const DetectRequest& request);
  const DetectResult& set_detection(const SceneOptions& scene_options, std::span<const SceneObject> given);
  void set_positions(ObjectId id, std::span<const Vec3d> positions);
  SimulatedObject& object(ObjectId id, const char* call) const;

  SimulationOptions options;
  Scene scene;
  DetectObserver observer;  // of the scene
  std::uint64_t steps = 0;
  double motion_seconds = 0;

 private:
  ObjectOptions with_margin(ObjectOptions object_options) const;
  void prepare_response(const TriangleMesh& mesh, SimulatedObject& object);
  std::shared_ptr<ImpulseSpread> spread_of(const TriangleMesh& mesh, const MassSpringOptions& springs) const;
  void call_functions(double seconds);
  void remember_positions();
  std::optional<MotionError> step_bodies();
  void step_body(SimulatedObject& object);
  void undo_step_of_bodies();
  void step_rigid_bodies();
  void respond_to_contacts();
  void gather_responding_objects();
  std::span<const ProximityPair> near_pairs();
  bool may_respond(ObjectId a, ObjectId b) const;
  void accept_written_positions();
  void place_in_scene();
  void set_positions_in_scene(const SimulatedObject& object);
  void prepare_next_step();
  bool needs_paths() const { return is_continuous() || response_; }
  bool is_continuous() const { return contains(options.scene.contacts, ContactKinds::continuous); }

  struct Response {
    ContactImpulses impulses;
    std::vector<RespondingObject> objects;  // scratch memory of a step
  };

  Parallel parallel_;
  std::optional<Response> response_;
  bool has_current_result_ = false;  // the result of the scene is that of the present positions
  std::vector<std::unique_ptr<SimulatedObject>> objects_;  // indexed by object
  std::vector<SimulatedObject*> small_bodies_;             // scratch memory of a step
};

}  // namespace supple
