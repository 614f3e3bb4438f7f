#include "supple/scene.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "scene/scene_implementation.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {
namespace {

void check_finite(const Vec3d& v, const char* call, const char* what) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::isfinite(v[axis])) continue;
    fail(std::string(call) + ": " + "xyz"[axis] + " of the " + what + " is " + std::to_string(v[axis]) +
         "; it must be a finite number");
  }
}

}  // namespace

Scene::Scene(const SceneOptions& options) : implementation_(new Implementation(options)) {}
void Scene::Deleter::operator()(Implementation* implementation) const {
  delete implementation;
}

ObjectId Scene::add(const TriangleMesh& mesh, const ObjectOptions& options) {
  ObjectOptions with_elements = options;
  with_elements.edges.insert(with_elements.edges.end(), mesh.edges.begin(), mesh.edges.end());
  with_elements.points.insert(with_elements.points.end(), mesh.points.begin(), mesh.points.end());
  return implementation_->world.add(mesh.positions, mesh.triangles, with_elements, mesh.name);
}
ObjectId Scene::add(PositionsView positions, TrianglesView triangles, const ObjectOptions& options) {
  return implementation_->world.add(positions, triangles, options, "");
}
void Scene::remove(ObjectId object) {
  implementation_->remove(object);
}

void Scene::set_positions(ObjectId object, PositionsView positions,
                          const std::optional<std::array<Vec3d, 2>>& bounds) {
  if (bounds) {
    for (const Vec3d& corner : *bounds) check_finite(corner, "set_positions", "bounds");
  }
  implementation_->world.set_positions(object, positions, bounds);
}
void Scene::set_vertices(ObjectId object, std::span<const std::uint32_t> vertices, PositionsView positions) {
  implementation_->world.set_vertices(object, vertices, positions);
}
void Scene::edit(ObjectId object, const MeshEdit& edit) {
  implementation_->world.edit(object, edit);
}
std::vector<std::uint32_t> Scene::compact(ObjectId object) {
  return implementation_->world.compact(object);
}
void Scene::share_positions(ObjectId object, PositionsView positions) {
  implementation_->world.share_positions(object, positions);
}
void Scene::set_motion(ObjectId object, PositionsView from, PositionsView to) {
  implementation_->world.set_motion(object, from, to);
}

void Scene::translate(ObjectId object, Vec3d offset) {
  check_finite(offset, "translate", "offset");
  implementation_->world.translate(object, offset);
}

void Scene::set_transform(ObjectId object, const RigidTransform& transform) {
  check_finite(transform.translation, "set_transform", "translation");
  for (int row = 0; row < 3; ++row) {
    const double* const r = transform.rotation.data() + 3 * row;
    check_finite({r[0], r[1], r[2]}, "set_transform", "rotation's rows");
  }
  implementation_->world.set_transform(object, transform);
}

void Scene::set_options(ObjectId object, const ObjectChanges& changes) {
  implementation_->world.set_options(object, changes);
}

void Scene::set_vertex_groups(ObjectId object, std::span<const std::uint32_t> groups,
                              std::span<const std::uint32_t> masks) {
  implementation_->world.set_vertex_groups(object, groups, masks);
}

void Scene::set_pair_filter(PairFilter filter) {
  implementation_->world.set_filter(std::move(filter));
}

void Scene::set_observer(DetectObserver observer) {
  implementation_->observer = std::move(observer);
}

const DetectResult& Scene::detect(const DetectRequest& request) {
  const DetectResult& result = implementation_->detect(request);
  if (implementation_->observer && !result.stopped) implementation_->observer(*this, request);
  return result;
}
const DetectResult& Scene::search(const DetectRequest& request, const PairFilter& only) {
  return implementation_->search(request, only);
}
std::optional<ContinuousContact> Scene::earliest_impact(const StepLimits& limits) {
  check_limits(limits, "earliest_impact");
  return implementation_->step_search.earliest_impact(implementation_->impact_options(), limits);
}
SafeStep Scene::collision_free_step(const StepOptions& step, const StepLimits& limits) {
  check(step, "collision_free_step");
  check_limits(limits, "collision_free_step");
  return implementation_->step_search.safe_step(implementation_->impact_options(), step, limits);
}
std::span<const ObjectStep> Scene::collision_free_steps(const StepOptions& step, const StepLimits& limits) {
  check(step, "collision_free_steps");
  check_limits(limits, "collision_free_steps");
  return implementation_->step_search.safe_steps(implementation_->impact_options(), step, limits);
}
SafeStep Scene::max_step(const StepLimits& limits) {
  check_limits(limits, "max_step");
  return implementation_->step_search.safe_step(implementation_->impact_options(), {}, limits);
}
const DetectResult& Scene::result() const {
  return implementation_->result;
}
std::shared_ptr<const void> Scene::keep_result() {
  return implementation_->keep_result();
}

std::vector<ObjectId> Scene::objects() const {
  return implementation_->world.objects();
}
bool Scene::contains(ObjectId object) const {
  return implementation_->world.contains(object);
}

const ObjectOptions& Scene::options(ObjectId object) const {
  return implementation_->world.object(object, "options").options;
}

std::size_t Scene::vertex_count(ObjectId object) const {
  return implementation_->world.object(object, "vertex_count").vertex_count();
}

std::size_t Scene::triangle_count(ObjectId object) const {
  return implementation_->world.object(object, "triangle_count").triangle_count();
}

std::optional<Triangle> Scene::triangle(ObjectId object, std::uint32_t triangle) const {
  const WorldObject& found = implementation_->world.object(object, "triangle");
  if (triangle >= found.triangle_count()) check_triangle(found, triangle, "triangle");
  return found.has_triangle(triangle) ? std::optional(found.triangle(triangle)) : std::nullopt;
}

std::uint64_t Scene::mesh_version(ObjectId object) const {
  return implementation_->world.object(object, "mesh_version").mesh_version();
}

Vec3d Scene::position(ObjectId object, std::uint32_t vertex) const {
  const WorldObject& found = implementation_->world.object(object, "position");
  check_vertex(found, vertex, "position");
  return found.placement().position(vertex);
}

const SceneOptions& Scene::options() const {
  return implementation_->world.options;
}

namespace detail {

ElementVertices vertices_of(const Scene& scene, ObjectId id, FeatureKind kind,
                            const std::array<std::uint32_t, 2>& element) {
  if (kind == FeatureKind::vertex) return {{element[0]}, 1};
  if (kind == FeatureKind::edge) return {{element[0], element[1]}, 2};
  const WorldObject& found = SceneAccess::of(scene).world.object(id, "vertices_of");
  check_triangle(found, element[0], "vertices_of");
  check_triangle(found, element[0], "vertices_of");
  return {found.triangle(element[0]), 3};
}

}  // namespace detail

}  // namespace supple
