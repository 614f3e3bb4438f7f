#include "supple/scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "scene/scene_implementation.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {
namespace {

std::string described(ObjectId id) {
  return "object " + std::to_string(id.index);
}

void check_finite(const Vec3d& v, const char* call, const char* what) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::isfinite(v[axis])) continue;
    fail(std::string(call) + ": " + "xyz"[axis] + " of the " + what + " is " + std::to_string(v[axis]) +
         "; it must be a finite number");
  }
}

const SceneOptions& checked(const SceneOptions& options) {
  check(options);
  return options;
}

void check_triangles(const std::string& name, std::size_t vertex_count, std::span<const Triangle> triangles) {
  constexpr std::size_t most = 0xffffffff;
  if (vertex_count >= most || triangles.size() >= most)
    fail(name + ": more than 2^32 - 2 vertices or triangles");
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t vertex : triangles[t]) {
      if (vertex < vertex_count) continue;
      fail(name + ": triangle " + std::to_string(t) + " uses vertex " + std::to_string(vertex) +
           ", but there are " + std::to_string(vertex_count) + " vertices, numbered from 0");
    }
  }
}

/// Positions from packed coordinates.
template <class Scalar>
PositionsView<Scalar> packed(std::span<const Scalar> xyz, const char* call) {
  if (xyz.size() % 3 != 0) {
    fail(std::string(call) + ": " + std::to_string(xyz.size()) +
         " coordinates are no whole number of points; give x y z of each");
  }
  return {xyz.data(), xyz.size() / 3};
}

void check_count(const SceneObject& object, std::size_t count, const char* call) {
  const std::size_t vertices = object.octree().vertex_count();
  if (count == vertices) return;
  fail(std::string(call) + ": " + std::to_string(count) + " positions for " + object.options.name +
       ", which has " + std::to_string(vertices) + " vertices; give one for each vertex");
}

}  // namespace

Scene::Implementation::Implementation(const SceneOptions& scene_options)
    : options(checked(scene_options)),
      parallel(scene_options.threads),
      pair_finder(scene_options.broad_phase, scene_options.bounding_volume, scene_options.scene_octree) {}

ObjectId Scene::Implementation::add(const PositionsView<double>& positions,
                                    std::span<const Triangle> triangles, const ObjectOptions& object_options,
                                    const std::string& fallback_name) {
  const auto index = free_slots_.empty() ? static_cast<std::uint32_t>(slots_.size()) : free_slots_.back();
  ObjectOptions named = object_options;
  if (named.name.empty()) named.name = fallback_name.empty() ? described({index, 0}) : fallback_name;
  check(named);
  check_triangles(named.name, positions.count, triangles);
  auto object = std::make_unique<SceneObject>(positions, triangles, named, options);
  object->set_positions(positions, parallel);
  object->set_rest_quality(parallel);
  if (free_slots_.empty()) {
    slots_.emplace_back();
  } else {
    free_slots_.pop_back();
  }
  slots_[index].object = std::move(object);
  mark_changed();
  return id_of(index);
}

void Scene::Implementation::remove(ObjectId id) {
  object(id, "remove");
  volume_pairs_.release(id);
  contact_pairs_.release(id);
  slots_[id.index].object.reset();
  ++slots_[id.index].generation;
  free_slots_.push_back(id.index);
  changed_.resize(slots_.size(), 0);
  changed_[id.index] = 1;
  mark_changed();
}

bool Scene::Implementation::contains(ObjectId id) const {
  return id.index < slots_.size() && slots_[id.index].object != nullptr &&
         slots_[id.index].generation == id.generation;
}

SceneObject& Scene::Implementation::object(ObjectId id, const char* call) const {
  if (!contains(id)) {
    fail(std::string(call) + ": " + described(id) + " (generation " + std::to_string(id.generation) +
         ") is not in the scene; it was removed or belongs to another scene");
  }
  return *slots_[id.index].object;
}

SceneObject& Scene::Implementation::movable_object(ObjectId id, const char* call) const {
  SceneObject& found = object(id, call);
  if (found.options.is_static) {
    fail(std::string(call) + ": " + found.options.name +
         " is static and cannot move; call set_static(id, false) first");
  }
  return found;
}

template <class Scalar>
void Scene::Implementation::set_positions(ObjectId id, const PositionsView<Scalar>& positions) {
  SceneObject& found = movable_object(id, "set_positions");
  check_count(found, positions.count, "set_positions");
  found.set_positions(positions, parallel);
  mark_changed();
}

template <class Scalar>
void Scene::Implementation::share_positions(ObjectId id, const PositionsView<Scalar>& positions) {
  SceneObject& found = movable_object(id, "share_positions");
  check_count(found, positions.count, "share_positions");
  found.share_positions(positions, parallel);
  mark_changed();
}

template <class Scalar>
void Scene::Implementation::set_motion(ObjectId id, const PositionsView<Scalar>& from,
                                       const PositionsView<Scalar>& to) {
  SceneObject& found = movable_object(id, "set_motion");
  check_count(found, from.count, "set_motion");
  check_count(found, to.count, "set_motion");
  found.set_motion(from, to, parallel);
  mark_changed();
}

std::vector<ObjectId> Scene::Implementation::objects() const {
  std::vector<ObjectId> ids;
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    if (slots_[index].object != nullptr) ids.push_back(id_of(index));
  }
  return ids;
}

std::string Scene::Implementation::validate() const {
  for (const ObjectId id : objects()) {
    const SceneObject& object = *slots_[id.index].object;
    if (object.is_stale()) continue;
    if (const std::string wrong = object.validate(); !wrong.empty())
      return object.options.name + ": " + wrong;
  }
  return pair_finder.validate();
}

Scene::Scene(const SceneOptions& options) : implementation_(std::make_unique<Implementation>(options)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

ObjectId Scene::add(const TriangleMesh& mesh, const ObjectOptions& options) {
  return implementation_->add(PositionsView<double>(mesh.positions), mesh.triangles, options, mesh.name);
}

ObjectId Scene::add(PositionsView<double> positions, std::span<const Triangle> triangles,
                    const ObjectOptions& options) {
  return implementation_->add(positions, triangles, options, "");
}

ObjectId Scene::add(PositionsView<float> positions, std::span<const Triangle> triangles,
                    const ObjectOptions& options) {
  std::vector<Vec3d> widened;
  widened.reserve(positions.count);
  for (std::size_t i = 0; i < positions.count; ++i)
    widened.push_back({positions[i].x, positions[i].y, positions[i].z});
  const ObjectId id = implementation_->add(PositionsView<double>(widened), triangles, options, "");
  implementation_->object(id, "add").set_positions(positions, implementation_->parallel);
  return id;
}

void Scene::remove(ObjectId object) {
  implementation_->remove(object);
}

void Scene::set_positions(ObjectId object, PositionsView<double> positions) {
  implementation_->set_positions(object, positions);
}
void Scene::set_positions(ObjectId object, PositionsView<float> positions) {
  implementation_->set_positions(object, positions);
}
void Scene::set_positions(ObjectId object, std::span<const double> xyz) {
  implementation_->set_positions(object, packed(xyz, "set_positions"));
}
void Scene::set_positions(ObjectId object, std::span<const float> xyz) {
  implementation_->set_positions(object, packed(xyz, "set_positions"));
}

void Scene::share_positions(ObjectId object, PositionsView<double> positions) {
  implementation_->share_positions(object, positions);
}
void Scene::share_positions(ObjectId object, PositionsView<float> positions) {
  implementation_->share_positions(object, positions);
}

void Scene::set_motion(ObjectId object, PositionsView<double> from, PositionsView<double> to) {
  implementation_->set_motion(object, from, to);
}
void Scene::set_motion(ObjectId object, PositionsView<float> from, PositionsView<float> to) {
  implementation_->set_motion(object, from, to);
}
void Scene::set_motion(ObjectId object, std::span<const double> from, std::span<const double> to) {
  implementation_->set_motion(object, packed(from, "set_motion"), packed(to, "set_motion"));
}
void Scene::set_motion(ObjectId object, std::span<const float> from, std::span<const float> to) {
  implementation_->set_motion(object, packed(from, "set_motion"), packed(to, "set_motion"));
}

void Scene::translate(ObjectId object, Vec3d offset) {
  check_finite(offset, "translate", "offset");
  implementation_->movable_object(object, "translate").translate(offset, implementation_->parallel);
  implementation_->mark_changed();
}

void Scene::set_transform(ObjectId object, const RigidTransform& transform) {
  check_finite(transform.translation, "set_transform", "translation");
  for (int row = 0; row < 3; ++row) {
    const double* const r = transform.rotation.data() + 3 * row;
    check_finite({r[0], r[1], r[2]}, "set_transform", "rotation's rows");
  }
  implementation_->movable_object(object, "set_transform")
      .set_transform(transform, implementation_->parallel);
  implementation_->mark_changed();
}

void Scene::set_static(ObjectId object, bool is_static) {
  implementation_->object(object, "set_static").options.is_static = is_static;
  implementation_->mark_changed();
}

void Scene::set_group(ObjectId object, std::uint32_t group, std::uint32_t mask) {
  ObjectOptions& options = implementation_->object(object, "set_group").options;
  options.group = group;
  options.mask = mask;
  implementation_->mark_changed();
}

void Scene::set_self_collision(ObjectId object, bool enabled) {
  implementation_->object(object, "set_self_collision").options.self_collision = enabled;
  implementation_->mark_changed();
}

void Scene::set_pair_filter(PairFilter filter) {
  implementation_->filter = std::move(filter);
  implementation_->mark_changed();
}

const DetectResult& Scene::detect() {
  return implementation_->detect();
}
std::optional<ContinuousContact> Scene::earliest_impact() {
  return implementation_->earliest_impact("earliest_impact");
}
double Scene::max_step() {
  const auto earliest = implementation_->earliest_impact("max_step");
  return earliest ? earliest->toi : 1;
}
const DetectResult& Scene::result() const {
  return implementation_->result;
}
VerifyReport Scene::verify() const {
  return implementation_->verify();
}
std::string Scene::validate() const {
  return implementation_->validate();
}

std::vector<OctreeCell> Scene::octree_cells(ObjectId object, std::optional<std::uint32_t> level) const {
  return implementation_->octree_cells(object, level);
}
std::uint32_t Scene::octree_depth(ObjectId object) const {
  return implementation_->octree_depth(object);
}
std::vector<CandidatePair> Scene::candidates(std::size_t limit, std::uint64_t* total) const {
  return implementation_->candidates(limit, total);
}
PairExplanation Scene::explain(ObjectId object_a, std::uint32_t triangle_a, ObjectId object_b,
                               std::uint32_t triangle_b) const {
  return implementation_->explain(object_a, triangle_a, object_b, triangle_b);
}

std::vector<ObjectId> Scene::objects() const {
  return implementation_->objects();
}
bool Scene::contains(ObjectId object) const {
  return implementation_->contains(object);
}

const std::string& Scene::name(ObjectId object) const {
  return implementation_->object(object, "name").options.name;
}

std::size_t Scene::vertex_count(ObjectId object) const {
  return implementation_->object(object, "vertex_count").octree().vertex_count();
}

std::size_t Scene::triangle_count(ObjectId object) const {
  return implementation_->object(object, "triangle_count").octree().triangles().size();
}

Vec3d Scene::position(ObjectId object, std::uint32_t vertex) const {
  const SceneObject& found = implementation_->object(object, "position");
  const std::size_t count = found.octree().vertex_count();
  if (vertex >= count) {
    fail("position: " + found.options.name + " has no vertex " + std::to_string(vertex) + "; it has " +
         std::to_string(count) + ", numbered from 0");
  }
  return found.position(found.octree().octree_vertex(vertex));
}

Aabb Scene::bounds(ObjectId object) const {
  return implementation_->object(object, "bounds").box();
}

OctreeStatistics Scene::octree_statistics(ObjectId object) const {
  return implementation_->object(object, "octree_statistics").octree_statistics();
}

std::vector<SceneRegion> Scene::scene_regions() const {
  return implementation_->pair_finder.regions();
}
const SceneOptions& Scene::options() const {
  return implementation_->options;
}

}  // namespace supple
