#include "supple/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "core/sort_once.hpp"
#include "mesh/vertex_triangles.hpp"
#include "scene/scene_implementation.hpp"
#include "supple/option_descriptions.hpp"
#include "supple/topology.hpp"

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

std::vector<Triangle> checked_triangles(const std::string& name, std::size_t vertex_count,
                                        const TrianglesView& view, const Parallel& parallel) {
  constexpr std::size_t most = 0xffffffff, grain = 8192;
  if (vertex_count >= most || view.size() >= most) fail(name + ": more than 2^32 - 2 vertices or triangles");
  const auto is_vertex = [&](std::int64_t id) {
    return id >= 0 && id < static_cast<std::int64_t>(vertex_count);
  };
  std::vector<Triangle> triangles(view.size());
  const bool are_all = parallel.all_of_ranges(view.size(), grain, [&](std::size_t begin, std::size_t end) {
    bool are_vertices = true;
    for (std::size_t t = begin; t < end; ++t) {
      const std::array<std::int64_t, 3> ids = view[t];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        are_vertices = are_vertices && is_vertex(ids[corner]);
        triangles[t][corner] = static_cast<std::uint32_t>(ids[corner]);
      }
    }
    return are_vertices;
  });
  for (std::size_t t = 0; !are_all && t < triangles.size(); ++t) {
    for (const std::int64_t id : view[t]) {
      if (is_vertex(id)) continue;
      fail(name + ": triangle " + std::to_string(t) + " uses vertex " + std::to_string(id) +
           ", but there are " + std::to_string(vertex_count) + " vertices, numbered from 0");
    }
  }
  return triangles;
}

/// `ObjectOptions::same_vertex`, or its replacement by `weld`; empty when each vertex is its own.
std::vector<std::uint32_t> checked_same_vertices(const PositionsView& positions,
                                                 const ObjectOptions& options) {
  const std::vector<std::uint32_t>& same = options.same_vertex;
  if (options.weld && !same.empty())
    fail(options.name + ": weld and same_vertex are both set; choose one of them");
  if (options.weld) return vertices_at_same_position(positions);
  if (!same.empty() && same.size() != positions.size()) {
    fail(options.name + ": same_vertex has " + std::to_string(same.size()) + " ids for " +
         std::to_string(positions.size()) + " vertices; give one for each vertex");
  }
  for (std::size_t v = 0; v < same.size(); ++v) {
    if (same[v] < same.size() && same[same[v]] == same[v]) continue;
    fail(options.name + ": same_vertex of vertex " + std::to_string(v) + " is " + std::to_string(same[v]) +
         ", which is no vertex that counts as itself");
  }
  return same;
}

/// The edges and points of no triangle, as triangles with repeated corners.
std::vector<Triangle> checked_extra_elements(std::size_t vertex_count, const ObjectOptions& options) {
  const auto check_vertex = [&](std::uint32_t vertex, const char* what, std::size_t i) {
    if (vertex < vertex_count) return;
    fail(options.name + ": " + what + " " + std::to_string(i) + " uses vertex " + std::to_string(vertex) +
         ", but there are " + std::to_string(vertex_count) + " vertices, numbered from 0");
  };
  std::vector<Triangle> elements;
  for (std::size_t i = 0; i < options.edges.size(); ++i) {
    const auto [v, w] = std::minmax(options.edges[i][0], options.edges[i][1]);
    check_vertex(w, "edge", i);
    if (v == w)
      fail(options.name + ": both ends of edge " + std::to_string(i) + " are vertex " + std::to_string(v) +
           "; list it in points");
    elements.push_back({v, w, w});
  }
  for (std::size_t i = 0; i < options.points.size(); ++i) {
    const std::uint32_t v = options.points[i];
    check_vertex(v, "point", i);
    elements.push_back({v, v, v});
  }
  return elements;
}

void check_count(const SceneObject& object, std::size_t count, const char* call) {
  const std::size_t vertices = object.octree().vertex_count();
  if (count == vertices) return;
  fail(std::string(call) + ": " + std::to_string(count) + " positions for " + object.options.name +
       ", which has " + std::to_string(vertices) + " vertices; give one for each vertex");
}

void check_vertex(const SceneObject& object, std::uint32_t vertex, const char* call) {
  const std::size_t count = object.octree().vertex_count();
  if (vertex < count) return;
  fail(std::string(call) + ": " + object.options.name + " has no vertex " + std::to_string(vertex) +
       "; it has " + std::to_string(count) + ", numbered from 0");
}

}  // namespace

void check_triangle(const SceneObject& object, std::uint32_t triangle, const char* call) {
  const std::size_t count = object.face_count();
  if (triangle < count) return;
  fail(std::string(call) + ": " + object.options.name + " has no triangle " + std::to_string(triangle) +
       "; it has " + std::to_string(count) + ", numbered from 0");
}

Scene::Implementation::Implementation(const SceneOptions& scene_options)
    : options(checked(scene_options)),
      parallel(scene_options.threads),
      pair_finder(scene_options.broad_phase, scene_options.bounding_volume, scene_options.scene_octree) {
  options.contacts = with_included(options.contacts);
}

ObjectId Scene::Implementation::add(const PositionsView& positions, const TrianglesView& triangles,
                                    const ObjectOptions& object_options, const std::string& fallback_name) {
  const auto index = free_slots_.empty() ? static_cast<std::uint32_t>(slots_.size()) : free_slots_.back();
  ObjectOptions named = object_options;
  if (named.name.empty()) named.name = fallback_name.empty() ? described({index, 0}) : fallback_name;
  check(named);
  if (named.octree.build == ObjectOctreeBuild::balanced && named.octree.arity != node_width)
    fail(named.name + ": a balanced octree has eight children; for an arity of " +
         std::to_string(named.octree.arity) + ", build it regular or bottom-up");
  std::vector<Triangle> faces = checked_triangles(named.name, positions.size(), triangles, parallel);
  std::vector<Triangle> extra = checked_extra_elements(positions.size(), named);
  if (faces.size() + extra.size() >= 0xffffffff) fail(named.name + ": more than 2^32 - 2 elements");
  if (const auto same = checked_same_vertices(positions, named); !same.empty()) {
    for (auto* const elements : {&faces, &extra}) {
      for (Triangle& triangle : *elements) {
        for (std::uint32_t& vertex : triangle) vertex = same[vertex];
      }
    }
    // Welded ends make an edge a point.
    for (Triangle& edge : extra) std::sort(edge.begin(), edge.begin() + 2);
    for (Triangle& edge : extra) edge[2] = edge[1];
  }
  sort_once(extra);
  if (named.solid) {
    TriangleMesh surface{.name = {}, .positions = {}, .triangles = faces};
    for (std::size_t v = 0; v < positions.size(); ++v) surface.positions.push_back(positions[v]);
    if (const std::string fault = fault_of_solid(surface); !fault.empty())
      fail(named.name + " is no solid: " + fault);
  }
  auto object = std::make_unique<SceneObject>(positions, std::move(faces), extra, named, options, parallel);
  object->move().set_positions(positions, parallel);
  object->measure_built_octree(parallel);
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
  const std::array caches{&volume_pairs_, &narrow_phase_pairs_, &contact_pairs_, &near_object_pairs_,
                          &penetrating_pairs_};
  // What may run out of memory comes first, so that no object is half removed.
  for (PairCache* const pairs : caches) pairs->prepare_release();
  free_slots_.reserve(slots_.capacity());
  changed_.resize(slots_.size(), 0);
  for (PairCache* const pairs : caches) pairs->release(id);
  std::erase_if(nearest_triangles_,
                [&](const auto& known) { return known.first.a == id || known.first.b == id; });
  slots_[id.index].object.reset();
  ++slots_[id.index].generation;
  free_slots_.push_back(id.index);
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

void Scene::Implementation::set_positions(ObjectId id, const PositionsView& positions) {
  SceneObject& found = movable_object(id, "set_positions");
  check_count(found, positions.size(), "set_positions");
  found.move().set_positions(positions, parallel);
  mark_changed();
}

void Scene::Implementation::set_vertices(ObjectId id, std::span<const std::uint32_t> vertices,
                                         const PositionsView& positions) {
  SceneObject& found = movable_object(id, "set_vertices");
  const std::string& name = found.options.name;
  if (positions.size() != vertices.size()) {
    fail("set_vertices: " + std::to_string(positions.size()) + " positions for " +
         std::to_string(vertices.size()) + " vertices of " + name + "; give one for each vertex");
  }
  for (const std::uint32_t vertex : vertices) check_vertex(found, vertex, "set_vertices");
  const bool is_double = found.placement().is_double();
  if (!vertices.empty() && positions.is_double() != is_double) {
    fail("set_vertices: the positions are " + std::string(is_double ? "float" : "double") + ", those of " +
         name + " are " + (is_double ? "double" : "float") + "; give both in one precision");
  }
  found.move().set_vertices(vertices, positions, parallel);
  mark_changed();
}

void Scene::Implementation::share_positions(ObjectId id, const PositionsView& positions) {
  SceneObject& found = movable_object(id, "share_positions");
  check_count(found, positions.size(), "share_positions");
  found.move().share_positions(positions, parallel);
  mark_changed();
}

void Scene::Implementation::set_motion(ObjectId id, const PositionsView& from, const PositionsView& to) {
  SceneObject& found = movable_object(id, "set_motion");
  check_count(found, from.size(), "set_motion");
  check_count(found, to.size(), "set_motion");
  if (from.is_double() != to.is_double())
    fail("set_motion: one end of the path is float, the other double; give both in one precision");
  found.move().set_motion(from, to, parallel);
  mark_changed();
}

void Scene::Implementation::set_distance(ObjectId id, double ObjectOptions::*member, double distance,
                                         const char* call) {
  SceneObject& found = object(id, call);
  ObjectOptions changed = found.options;
  changed.*member = distance;
  check(changed, call);
  found.options.*member = distance;
  found.move();  // so that its pairs are found again
  mark_changed();
}

void Scene::Implementation::set_vertex_groups(ObjectId id, std::span<const std::uint32_t> groups,
                                              std::span<const std::uint32_t> masks) {
  SceneObject& found = object(id, "set_vertex_groups");
  const std::size_t count = found.octree().vertex_count();
  for (const std::size_t given : {groups.size(), masks.size()}) {
    if (given == count || (groups.empty() && masks.empty())) continue;
    fail("set_vertex_groups: " + std::to_string(given) + " numbers for " + found.options.name +
         ", which has " + std::to_string(count) + " vertices; give a group and a mask for each vertex");
  }
  found.set_vertex_groups(groups, masks);
  found.move();  // so that its pairs are found again
  mark_changed();
}

std::vector<ObjectId> Scene::Implementation::objects() const {
  std::vector<ObjectId> ids;
  for (std::uint32_t index = 0; index < slots_.size(); ++index) {
    if (slots_[index].object != nullptr) ids.push_back(id_of(index));
  }
  return ids;
}

ElementVertices Scene::Implementation::triangle_vertices(ObjectId id, std::uint32_t triangle) const {
  const SceneObject& found = object(id, "vertices_of");
  check_triangle(found, triangle, "vertices_of");
  return {found.octree().user_triangle(triangle), 3};
}

ElementVertices Scene::Implementation::element_vertices(ObjectId id, FeatureKind kind,
                                                        const std::array<std::uint32_t, 2>& element) const {
  switch (kind) {
    case FeatureKind::vertex:
      return {{element[0]}, 1};
    case FeatureKind::edge:
      return {{element[0], element[1]}, 2};
    case FeatureKind::face:
      break;
  }
  return triangle_vertices(id, element[0]);
}

Scene::Scene(const SceneOptions& options) : implementation_(std::make_unique<Implementation>(options)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

ObjectId Scene::add(const TriangleMesh& mesh, const ObjectOptions& options) {
  ObjectOptions with_elements = options;
  with_elements.edges.insert(with_elements.edges.end(), mesh.edges.begin(), mesh.edges.end());
  with_elements.points.insert(with_elements.points.end(), mesh.points.begin(), mesh.points.end());
  return implementation_->add(mesh.positions, mesh.triangles, with_elements, mesh.name);
}
ObjectId Scene::add(PositionsView positions, TrianglesView triangles, const ObjectOptions& options) {
  return implementation_->add(positions, triangles, options, "");
}
void Scene::remove(ObjectId object) {
  implementation_->remove(object);
}

void Scene::set_positions(ObjectId object, PositionsView positions) {
  implementation_->set_positions(object, positions);
}
void Scene::set_vertices(ObjectId object, std::span<const std::uint32_t> vertices, PositionsView positions) {
  implementation_->set_vertices(object, vertices, positions);
}
void Scene::share_positions(ObjectId object, PositionsView positions) {
  implementation_->share_positions(object, positions);
}
void Scene::set_motion(ObjectId object, PositionsView from, PositionsView to) {
  implementation_->set_motion(object, from, to);
}

void Scene::translate(ObjectId object, Vec3d offset) {
  check_finite(offset, "translate", "offset");
  implementation_->movable_object(object, "translate").move().translate(offset, implementation_->parallel);
  implementation_->mark_changed();
}

void Scene::set_transform(ObjectId object, const RigidTransform& transform) {
  check_finite(transform.translation, "set_transform", "translation");
  for (int row = 0; row < 3; ++row) {
    const double* const r = transform.rotation.data() + 3 * row;
    check_finite({r[0], r[1], r[2]}, "set_transform", "rotation's rows");
  }
  implementation_->movable_object(object, "set_transform")
      .move()
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

void Scene::set_margin(ObjectId object, double margin) {
  implementation_->set_distance(object, &ObjectOptions::margin, margin, "set_margin");
}

void Scene::set_min_separation(ObjectId object, double separation) {
  implementation_->set_distance(object, &ObjectOptions::min_separation, separation, "set_min_separation");
}

void Scene::set_vertex_groups(ObjectId object, std::span<const std::uint32_t> groups,
                              std::span<const std::uint32_t> masks) {
  implementation_->set_vertex_groups(object, groups, masks);
}

void Scene::set_user_data(ObjectId object, std::uint64_t data) {
  implementation_->object(object, "set_user_data").options.user_data = data;
}

void Scene::set_self_collision(ObjectId object, bool enabled) {
  implementation_->object(object, "set_self_collision").options.self_collision = enabled;
  implementation_->mark_changed();
}

void Scene::set_pair_filter(PairFilter filter) {
  implementation_->filter = std::move(filter);
  implementation_->mark_changed();
}

const DetectResult& Scene::detect(const DetectRequest& request) {
  return implementation_->detect(request);
}
std::optional<ContinuousContact> Scene::earliest_impact() {
  return implementation_->earliest_impact();
}
SafeStep Scene::collision_free_step(const StepOptions& step) {
  return implementation_->collision_free_step(step);
}
std::span<const ObjectStep> Scene::collision_free_steps(const StepOptions& step) {
  return implementation_->collision_free_steps(step);
}
SafeStep Scene::max_step() {
  const auto earliest = implementation_->earliest_impact();
  return earliest ? SafeStep{earliest->toi, pair_of_contact(*earliest)} : SafeStep{};
}
void Scene::closest(std::span<const Vec3d> points, std::span<std::optional<ClosestPoint>> results,
                    const ClosestOptions& options) {
  implementation_->closest(points, results, options);
}
void Scene::cast(std::span<const Ray> rays, std::span<std::optional<RayHit>> results,
                 const CastOptions& options) {
  implementation_->cast(rays, results, options);
}
std::span<const ListedRayHit> Scene::cast_all(std::span<const Ray> rays, const QueryFilter& filter,
                                              const CallLimits& limits) {
  return implementation_->cast_all(rays, filter, limits);
}
void Scene::inside(std::span<const Vec3d> points, std::span<Containment> results, const QueryFilter& filter,
                   const CallLimits& limits) {
  implementation_->inside(points, results, filter, limits);
}
std::span<const Overlap> Scene::overlaps(std::span<const QueryBox> boxes, const QueryFilter& filter,
                                         const CallLimits& limits) {
  return implementation_->overlaps(boxes, filter, limits);
}
std::span<const Overlap> Scene::overlaps(std::span<const QuerySphere> spheres, const QueryFilter& filter,
                                         const CallLimits& limits) {
  return implementation_->overlaps(spheres, filter, limits);
}
std::optional<ProximityPair> Scene::distance(ObjectId a, ObjectId b, const CallLimits& limits) {
  return implementation_->distance(a, b, limits);
}
std::span<const ProximityPair> Scene::distances(double max_distance, const CallLimits& limits) {
  return implementation_->distances(max_distance, limits);
}
bool Scene::any_contact(ObjectId a, ObjectId b, const CallLimits& limits) {
  return implementation_->any_contact(a, b, limits);
}
const DetectResult& Scene::result() const {
  return implementation_->result;
}
VerifyReport Scene::verify(const CallLimits& limits) const {
  return implementation_->verify(limits);
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

std::uint64_t Scene::user_data(ObjectId object) const {
  return implementation_->object(object, "user_data").options.user_data;
}

std::size_t Scene::vertex_count(ObjectId object) const {
  return implementation_->object(object, "vertex_count").octree().vertex_count();
}

std::size_t Scene::triangle_count(ObjectId object) const {
  return implementation_->object(object, "triangle_count").face_count();
}

Vec3d Scene::position(ObjectId object, std::uint32_t vertex) const {
  const SceneObject& found = implementation_->object(object, "position");
  check_vertex(found, vertex, "position");
  return found.placement().position(vertex);
}

ElementVertices Scene::vertices_of(const LimitingPair& pair, ContactSide side) const {
  const bool is_a = side == ContactSide::a;
  const std::array<std::uint32_t, 2>& element = is_a ? pair.element_a : pair.element_b;
  return implementation_->element_vertices(is_a ? pair.object_a : pair.object_b,
                                           feature_kinds(pair.kind)[is_a ? 0 : 1], element);
}
ElementVertices Scene::vertices_of(const ContinuousContact& contact, ContactSide side) const {
  return vertices_of(pair_of_contact(contact), side);
}
ElementVertices Scene::vertices_of(const Contact& contact, ContactSide side) const {
  const bool is_a = side == ContactSide::a;
  return implementation_->triangle_vertices(is_a ? contact.object_a : contact.object_b,
                                            is_a ? contact.triangle_a : contact.triangle_b);
}

ElementVertices Scene::vertices_of(const ProximityPair& pair, ContactSide side) const {
  const bool is_a = side == ContactSide::a;
  const std::array<std::uint32_t, 2>& element = is_a ? pair.element_a : pair.element_b;
  return implementation_->element_vertices(is_a ? pair.object_a : pair.object_b,
                                           is_a ? pair.kind_a : pair.kind_b, element);
}

const SceneOptions& Scene::options() const {
  return implementation_->options;
}

}  // namespace supple
