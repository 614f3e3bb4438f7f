#include "supple/simulation.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/error.hpp"
#include "core/timer.hpp"
#include "motion/worth_threads.hpp"
#include "simulation/simulation_implementation.hpp"
#include "supple/simulation_descriptions.hpp"

namespace supple {
namespace {

const SimulationOptions& checked(const SimulationOptions& options) {
  check(options);
  for (int axis = 0; options.border && axis < 3; ++axis) {
    const double low = (*options.border)[0][axis], high = (*options.border)[1][axis];
    if (low < high) continue;
    fail(std::string("SimulationOptions::border: along ") + "xyz"[axis] + " it goes from " +
         std::to_string(low) + " to " + std::to_string(high) + "; the first corner must be the lower one");
  }
  if (options.response) check(*options.response);
  if (options.fused_refit && !options.scene.comparison.lazy_refit)
    fail("SimulationOptions: fused_refit has no effect when all nodes are refitted; set lazy_refit, too");
  return options;
}

/// The exception that `action` throws, or none.
template <class Action>
std::exception_ptr exception_of(Action&& action) {
#if defined(__cpp_exceptions)
  try {
    action();
  } catch (...) {
    return std::current_exception();
  }
#else
  action();
#endif
  return nullptr;
}

[[noreturn]] void raise(const MotionError& error) {
#if defined(__cpp_exceptions)
  throw error;
#else
  fail(error.what());
#endif
}

}  // namespace

Simulation::Implementation::Implementation(const SimulationOptions& simulation_options)
    : options(checked(simulation_options)),
      scene(simulation_options.scene),
      parallel_(simulation_options.scene.threads) {
  if (options.response)
    response_.emplace(Response{ContactImpulses(*options.response, options.time_step), {}});
}

/// Everything that may throw comes first.
ObjectId Simulation::Implementation::add(const TriangleMesh& mesh, ObjectOptions object_options,
                                         ObjectMotion motion) {
  check_mesh(mesh);
  object_options = with_margin(std::move(object_options));
  if (motion.index() != 0 && object_options.is_static) {
    fail((object_options.name.empty() ? mesh.name : object_options.name) +
         " is static and has a motion; leave one of them out");
  }
  auto added = std::make_unique<SimulatedObject>();
  const auto random_of = [&](const std::optional<std::uint64_t>& seed) {
    const std::uint64_t number = added->id.index | std::uint64_t{added->id.generation} << 32;
    return Random(options.seed, seed.value_or(number));
  };
  if (const auto* const springs = std::get_if<const MassSpringMotion*>(&motion)) {
    // A body too small for threads is stepped in parallel with others.
    const bool has_threads = is_worth_threads(mesh.positions.size(), (*springs)->springs.integrator);
    const std::uint32_t threads = has_threads ? options.scene.threads : 1;
    MassSpringBody body = make_body(mesh, **springs, threads);
    added->id = scene.add(mesh, object_options);
    added->moving_body = std::make_unique<MovingBody>(std::move(body), **springs, options.time_step,
                                                      random_of((*springs)->seed));
  } else if (const auto* const rigid = std::get_if<const RigidMotion*>(&motion)) {
    check(**rigid, "motion of " + mesh.name);
    added->id = scene.add(mesh, object_options);
    added->rigid_body.emplace(mesh.positions, **rigid, options.time_step, random_of((*rigid)->seed));
  } else {
    if (auto* const function = std::get_if<MotionFunction>(&motion)) added->function = std::move(*function);
    added->own_positions = mesh.positions;
    added->id = scene.add(mesh, object_options);
  }
  if (response_) prepare_response(mesh, *added);
  const ObjectId id = added->id;
  if (objects_.size() <= id.index) objects_.resize(id.index + 1);
  objects_[id.index] = std::move(added);
  has_current_result_ = false;
  return id;
}

ObjectOptions Simulation::Implementation::with_margin(ObjectOptions object_options) const {
  if (options.response)
    object_options.margin = std::max(object_options.margin, least_margin(*options.response));
  return object_options;
}

void Simulation::Implementation::prepare_response(const TriangleMesh& mesh, SimulatedObject& object) {
  if (object.moving_body == nullptr) return;
  const MassSpringOptions& springs = object.moving_body->body.options();
  object.spread = spread_of(mesh, springs);
  object.inverse_masses.assign(mesh.positions.size(), 1 / springs.vertex_mass);
  for (const std::uint32_t vertex : springs.fixed_vertices) object.inverse_masses[vertex] = 0;
}

/// That of an object with equal springs, if there is one: copies of an object would compute and keep the
/// same.
std::shared_ptr<ImpulseSpread> Simulation::Implementation::spread_of(const TriangleMesh& mesh,
                                                                     const MassSpringOptions& springs) const {
  auto made = std::make_shared<ImpulseSpread>(mesh, springs, options.time_step);
  for (const auto& other : objects_) {
    if (other != nullptr && other->spread != nullptr && other->spread->has_springs_of(*made))
      return other->spread;
  }
  return made;
}

void Simulation::Implementation::remove(ObjectId id) {
  scene.remove(id);
  objects_[id.index].reset();
  has_current_result_ = false;
}

SimulatedObject& Simulation::Implementation::object(ObjectId id, const char* call) const {
  if (id.index < objects_.size() && objects_[id.index] != nullptr && objects_[id.index]->id == id)
    return *objects_[id.index];
  fail(std::string(call) + ": object " + std::to_string(id.index) + " (generation " +
       std::to_string(id.generation) +
       ") is not in the simulation; it was removed or belongs to another simulation");
}

void Simulation::Implementation::set_positions(ObjectId id, std::span<const Vec3d> positions) {
  SimulatedObject& found = object(id, "set_positions");
  if (found.function != nullptr) {
    fail("set_positions: " + scene.options(id).name +
         " is moved by a function, so its positions cannot be set; let the function write other positions");
  }
  scene.set_positions(id, positions);
  has_current_result_ = false;
  found.is_on_path = false;
  if (found.moving_body != nullptr) {
    found.moving_body->body.set_positions(positions);
  } else if (found.rigid_body) {
    found.rigid_body->set_positions(positions);
  } else {
    found.own_positions.assign(positions.begin(), positions.end());
  }
}

/// The scene is replaced at the end, when nothing can fail any more.
const DetectResult& Simulation::Implementation::set_detection(const SceneOptions& scene_options,
                                                              std::span<const SceneObject> given) {
  if (given.size() != objects_.size())
    fail("set_detection: there are " + std::to_string(objects_.size()) + " objects, and " +
         std::to_string(given.size()) + " were given");
  Scene made(scene_options);
  for (std::size_t i = 0; i < given.size(); ++i) {
    const ObjectId id = made.add(*given[i].mesh, with_margin(given[i].options));
    if (objects_[i] == nullptr || objects_[i]->id != id)
      fail("set_detection: object " + std::to_string(i) +
           " was removed; a new scene would give its number to another object");
    // A static object stays where it was added.
    if (given[i].options.is_static) continue;
    if (objects_[i]->rigid_body)
      objects_[i]->rigid_body->place_again(made, id);
    else
      made.set_positions(id, objects_[i]->positions());
  }
  made.detect();
  made.set_observer(observer);
  scene = std::move(made);
  options.scene = scene_options;
  for (const auto& object : objects_) object->is_on_path = false;
  has_current_result_ = true;
  return scene.result();
}

const DetectResult& Simulation::Implementation::detect(const DetectRequest& request) {
  for (const auto& object : objects_) {
    if (object == nullptr || !object->is_on_path) continue;
    set_positions_in_scene(*object);
    object->is_on_path = false;
  }
  has_current_result_ = true;
  return scene.detect(request);
}

/// Operations after the step of the bodies must not fail; operations before it must have no lasting effect.
std::optional<MotionError> Simulation::Implementation::try_step(const DetectRequest& request) {
  Timer timer;
  call_functions(static_cast<double>(steps + 1) * options.time_step);
  remember_positions();
  if (auto error = step_bodies()) return error;
  step_rigid_bodies();
  if (response_) respond_to_contacts();
  ++steps;
  accept_written_positions();
  place_in_scene();
  prepare_next_step();
  motion_seconds = timer.lap();
  scene.detect(request);
  has_current_result_ = !scene.result().stopped;
  return std::nullopt;
}

void Simulation::Implementation::call_functions(double seconds) {
  for (const auto& object : objects_) {
    if (object == nullptr || object->function == nullptr) continue;
    object->next = object->own_positions;
    object->function(seconds, object->next);
  }
}

void Simulation::Implementation::remember_positions() {
  if (!needs_paths()) return;
  for (const auto& object : objects_) {
    if (object == nullptr || (object->moving_body == nullptr && !object->rigid_body)) continue;
    const std::span<const Vec3d> positions = object->positions();
    object->before.assign(positions.begin(), positions.end());
  }
}

/// Large bodies run one after the other with all threads; small bodies run in parallel with each other.
std::optional<MotionError> Simulation::Implementation::step_bodies() {
  small_bodies_.clear();
  for (const auto& object : objects_) {
    if (object == nullptr || object->moving_body == nullptr) continue;
    if (object->moving_body->body.options().threads == 1) {
      small_bodies_.push_back(object.get());
    } else {
      step_body(*object);
    }
  }
  parallel_.for_ranges(small_bodies_.size(), 1, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    for (std::size_t i = begin; i < end; ++i) step_body(*small_bodies_[i]);
  });
  for (const auto& object : objects_) {
    if (object == nullptr || object->moving_body == nullptr || !object->has_failed()) continue;
    undo_step_of_bodies();
    if (object->exception != nullptr) std::rethrow_exception(object->exception);
    const std::string& name = scene.options(object->id).name;
    const std::uint64_t step = steps + 1;
    return MotionError(name + " in step " + std::to_string(step) + ": " + *object->failure, name, step);
  }
  return std::nullopt;
}

void Simulation::Implementation::step_body(SimulatedObject& object) {
  object.failure.reset();
  object.exception =
      exception_of([&] { object.failure = object.moving_body->body.try_step(options.time_step); });
}

/// Bodies that failed have already restored their state.
void Simulation::Implementation::undo_step_of_bodies() {
  for (const auto& object : objects_) {
    if (object != nullptr && object->moving_body != nullptr && !object->has_failed())
      object->moving_body->body.undo_step();
  }
}

void Simulation::Implementation::step_rigid_bodies() {
  for (const auto& object : objects_) {
    if (object != nullptr && object->rigid_body) object->rigid_body->step();
  }
}

void Simulation::Implementation::respond_to_contacts() {
  gather_responding_objects();
  const DetectRequest impacts{.contacts = ContactKinds::continuous,
                              .impact = ImpactOptions{},
                              .element_kinds = ElementKinds::all,
                              .continuous_listing = ContinuousListing::all};
  const std::span<const ProximityPair> near = near_pairs();
  has_current_result_ = false;  // from here on, the scene has paths that are tried out
  for (const RespondingObject& object : response_->objects) objects_[object.id.index]->is_on_path = true;
  response_->impulses.resolve(scene, near, response_->objects, impacts,
                              [this](ObjectId a, ObjectId b) { return may_respond(a, b); });
  for (const auto& object : objects_) {
    if (object == nullptr || object->moving_body == nullptr) continue;
    if (const auto change = response_->impulses.change(object->id))
      object->moving_body->change_velocities(change->of_average_velocity, change->of_end_velocity);
  }
}

void Simulation::Implementation::gather_responding_objects() {
  response_->objects.clear();
  for (const auto& object : objects_) {
    if (object == nullptr) continue;
    if (object->moving_body != nullptr) {
      const MassSpringBody& body = object->moving_body->body;
      response_->objects.push_back({object->id, object->before, body.positions(), body.velocities(),
                                    object->inverse_masses, object->spread.get()});
    } else if (object->rigid_body) {
      response_->objects.push_back({object->id, object->before, object->rigid_body->positions()});
    } else if (object->function != nullptr) {
      response_->objects.push_back({object->id, object->own_positions, object->next});
    }
  }
}

/// The proximity of the last step, when the scene has found it; otherwise found here, with the same result.
std::span<const ProximityPair> Simulation::Implementation::near_pairs() {
  if (has_current_result_ && contains(options.scene.contacts, ContactKinds::proximity) &&
      options.scene.proximity_listing == ProximityListing::features) {
    return scene.result().proximity_pairs;
  }
  for (const RespondingObject& object : response_->objects) scene.set_positions(object.id, object.from);
  return scene
      .search({.contacts = ContactKinds::proximity,
               .proximity_listing = ProximityListing::features,
               .element_kinds = ElementKinds::all},
              [this](ObjectId a, ObjectId b) { return may_respond(a, b); })
      .proximity_pairs;
}

/// Whether a response can move one of both objects.
bool Simulation::Implementation::may_respond(ObjectId a, ObjectId b) const {
  return objects_[a.index]->moving_body != nullptr || objects_[b.index]->moving_body != nullptr;
}

void Simulation::Implementation::accept_written_positions() {
  for (const auto& object : objects_) {
    if (object == nullptr || object->function == nullptr) continue;
    object->before.swap(object->own_positions);
    object->own_positions.swap(object->next);
  }
}

void Simulation::Implementation::place_in_scene() {
  for (const auto& object : objects_) {
    if (object == nullptr || !object->moves()) continue;
    object->is_on_path = is_continuous();
    if (object->is_on_path) {
      scene.set_motion(object->id, object->before, object->positions());
    } else if (object->rigid_body && !response_) {
      object->rigid_body->place(scene, object->id);
    } else {
      set_positions_in_scene(*object);
    }
  }
}

void Simulation::Implementation::set_positions_in_scene(const SimulatedObject& object) {
  const bool has_bounds = options.fused_refit && object.moving_body != nullptr;
  scene.set_positions(object.id, object.positions(),
                      has_bounds ? object.moving_body->body.bounds() : std::nullopt);
}

void Simulation::Implementation::prepare_next_step() {
  for (const auto& object : objects_) {
    if (object == nullptr) continue;
    if (object->moving_body != nullptr) object->moving_body->end_step(options.border);
    if (object->rigid_body && options.border) object->rigid_body->reflect_at(*options.border);
  }
}

Simulation::Simulation(const SimulationOptions& options)
    : implementation_(std::make_unique<Implementation>(options)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

ObjectId Simulation::add(const TriangleMesh& mesh, const ObjectOptions& object) {
  return implementation_->add(mesh, object, {});
}
ObjectId Simulation::add(const TriangleMesh& mesh, const ObjectOptions& object,
                         const MassSpringMotion& motion) {
  return implementation_->add(mesh, object, &motion);
}
ObjectId Simulation::add(const TriangleMesh& mesh, const ObjectOptions& object, const RigidMotion& motion) {
  return implementation_->add(mesh, object, &motion);
}
ObjectId Simulation::add(const TriangleMesh& mesh, const ObjectOptions& object, MotionFunction motion) {
  if (motion == nullptr) fail("add: the motion of " + mesh.name + " is an empty function");
  return implementation_->add(mesh, object, std::move(motion));
}
void Simulation::remove(ObjectId object) {
  implementation_->remove(object);
}

const DetectResult& Simulation::detect(const DetectRequest& request) {
  return implementation_->detect(request);
}
const DetectResult& Simulation::step(const DetectRequest& request) {
  if (const auto error = try_step(request)) raise(*error);
  return scene().result();
}
std::optional<MotionError> Simulation::try_step(const DetectRequest& request) {
  return implementation_->try_step(request);
}

const DetectResult& Simulation::set_detection(const SceneOptions& options,
                                              std::span<const SceneObject> objects) {
  return implementation_->set_detection(options, objects);
}

std::uint64_t Simulation::step_count() const {
  return implementation_->steps;
}
double Simulation::time() const {
  return static_cast<double>(implementation_->steps) * implementation_->options.time_step;
}
double Simulation::motion_seconds() const {
  return implementation_->motion_seconds;
}
const SimulationOptions& Simulation::options() const {
  return implementation_->options;
}
void Simulation::set_observer(DetectObserver observer) {
  implementation_->observer = observer;
  implementation_->scene.set_observer(std::move(observer));
}
std::shared_ptr<const void> Simulation::keep_result() {
  return implementation_->scene.keep_result();
}
const Scene& Simulation::scene() const {
  return implementation_->scene;
}

std::span<const Vec3d> Simulation::positions(ObjectId object) const {
  return implementation_->object(object, "positions").positions();
}
void Simulation::set_positions(ObjectId object, std::span<const Vec3d> positions) {
  implementation_->set_positions(object, positions);
}

MassSpringBody* Simulation::body(ObjectId object) {
  MovingBody* const moving = implementation_->object(object, "body").moving_body.get();
  return moving != nullptr ? &moving->body : nullptr;
}
const MassSpringBody* Simulation::body(ObjectId object) const {
  const MovingBody* const moving = implementation_->object(object, "body").moving_body.get();
  return moving != nullptr ? &moving->body : nullptr;
}

}  // namespace supple
