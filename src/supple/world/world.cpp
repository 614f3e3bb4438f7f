#include "world/world.hpp"

#include <string>
#include <utility>

#include "core/error.hpp"
#include "octree/comparison_methods.hpp"
#include "supple/option_descriptions.hpp"

namespace supple {
namespace {

std::string described(ObjectId id) {
  return "object " + std::to_string(id.index);
}

SceneOptions checked(SceneOptions options) {
  check(options);
  if (options.bounding_volume != BoundingVolume::aabb)
    comparison_methods(std::string("the bounding volume ") + word_of(options.bounding_volume));
  if (options.comparison.descent != Descent::both_sides)
    comparison_methods(std::string("the descent ") + word_of(options.comparison.descent));
  if (options.comparison.lazy_refit) comparison_methods("the lazy refit");
  if (options.comparison.colliding_vertices) comparison_methods("the list of colliding vertices");
  if (is_tested_after_boxes(options.bounding_volume) &&
      (options.comparison.lazy_refit || options.comparison.descent != Descent::both_sides))
    fail(
        "SceneOptions: lazy_refit and the descent one_side_first need boxes or spheres; set bounding_volume "
        "to "
        "aabb or sphere");
  options.contacts = with_included(options.contacts);
  return options;
}

void check_count(const WorldObject& object, std::size_t count, const char* call) {
  const std::size_t vertices = object.vertex_count();
  if (count == vertices) return;
  fail(std::string(call) + ": " + std::to_string(count) + " positions for " + object.options.name +
       ", which has " + std::to_string(vertices) + " vertices; give one for each vertex");
}

}  // namespace

void check_vertex(const WorldObject& object, std::uint32_t vertex, const char* call) {
  const std::size_t count = object.vertex_count();
  if (vertex < count) return;
  fail(std::string(call) + ": " + object.options.name + " has no vertex " + std::to_string(vertex) +
       "; it has " + std::to_string(count) + ", numbered from 0");
}

void check_triangle(const WorldObject& object, std::uint32_t triangle, const char* call) {
  const std::size_t count = object.triangle_count();
  if (object.has_triangle(triangle)) return;
  if (triangle < count)
    fail(std::string(call) + ": triangle " + std::to_string(triangle) + " of " + object.options.name +
         " was removed by an edit");
  fail(std::string(call) + ": " + object.options.name + " has no triangle " + std::to_string(triangle) +
       "; it has " + std::to_string(count) + ", numbered from 0");
}

ChangedOptions change_options(ObjectOptions& options, const ObjectChanges& changes) {
  check(ObjectOptions{.margin = changes.margin.value_or(0),
                      .min_separation = changes.min_separation.value_or(0)},
        "set_options");
  ChangedOptions changed;
  const auto set = [](auto& option, const auto& value, bool& differs) {
    if (!value || *value == option) return;
    option = *value;
    differs = true;
  };
  set(options.margin, changes.margin, changed.distances);
  set(options.min_separation, changes.min_separation, changed.distances);
  set(options.self_collision, changes.self_collision, changed.pairs);
  set(options.is_static, changes.is_static, changed.pairs);
  set(options.group, changes.group, changed.pairs);
  set(options.mask, changes.mask, changed.pairs);
  options.user_data = changes.user_data.value_or(options.user_data);
  return changed;
}

World::World(const SceneOptions& scene_options)
    : options(checked(scene_options)), parallel(scene_options.threads) {}

void World::remove(ObjectId id) {
  object(id, "remove");
  // What may run out of memory comes first, so that no object is half removed.
  free_slots_.reserve(slots_.capacity());
  versions_.resize(slots_.size(), 0);
  slots_[id.index].object.reset();
  ++slots_[id.index].generation;
  free_slots_.push_back(id.index);
  versions_[id.index] = ++last_version_;
  mark_changed();
}

void World::arrange(std::span<const std::uint32_t> slots) {
  std::vector<Slot> arranged;
  arranged.reserve(slots_.size());
  for (const std::uint32_t slot : slots) arranged.push_back(std::move(slots_[slot]));
  arranged.resize(slots_.size());
  slots_ = std::move(arranged);
  free_slots_.clear();
  for (auto slot = static_cast<std::uint32_t>(slots_.size()); slot > slots.size();)
    free_slots_.push_back(--slot);
  versions_.resize(slots_.size(), 0);
  for (std::uint64_t& version : versions_) version = ++last_version_;
  mark_changed();
}

bool World::contains(ObjectId id) const {
  return id.index < slots_.size() && slots_[id.index].object != nullptr &&
         slots_[id.index].generation == id.generation;
}

std::vector<ObjectId> World::objects() const {
  std::vector<ObjectId> ids;
  for (std::uint32_t slot = 0; slot < slots_.size(); ++slot) {
    if (slots_[slot].object != nullptr) ids.push_back(id_of(slot));
  }
  return ids;
}

WorldObject& World::object(ObjectId id, const char* call) const {
  if (!contains(id)) {
    fail(std::string(call) + ": " + described(id) + " (generation " + std::to_string(id.generation) +
         ") is not in the scene; it was removed or belongs to another scene");
  }
  return *slots_[id.index].object;
}

WorldObject& World::movable_object(ObjectId id, const char* call) const {
  WorldObject& found = object(id, call);
  if (found.options.is_static) {
    fail(std::string(call) + ": " + found.options.name +
         " is static and cannot move; set its option is_static to false first");
  }
  return found;
}

ObjectPair World::two_objects(ObjectId a, ObjectId b, const char* call) const {
  object(a, call);
  object(b, call);
  if (a == b) fail(std::string(call) + ": both objects are " + object(a, call).options.name + "; give two");
  return a < b ? ObjectPair{a, b} : ObjectPair{b, a};
}

void World::set_positions(ObjectId id, const PositionsView& positions,
                          const std::optional<std::array<Vec3d, 2>>& bounds) {
  WorldObject& found = movable_object(id, "set_positions");
  check_count(found, positions.size(), "set_positions");
  found.move().set_positions(positions, parallel);
  if (bounds) {
    Aabb box;
    for (const Vec3d& corner : *bounds) extend(box, corner);
    found.set_bounds(box);
  }
  mark_changed();
}

void World::set_vertices(ObjectId id, std::span<const std::uint32_t> vertices,
                         const PositionsView& positions) {
  WorldObject& found = movable_object(id, "set_vertices");
  const std::string& name = found.options.name;
  if (positions.size() != vertices.size()) {
    fail("set_vertices: " + std::to_string(positions.size()) + " positions for " +
         std::to_string(vertices.size()) + " vertices of " + name + "; give one for each vertex");
  }
  for (const std::uint32_t vertex : vertices) check_vertex(found, vertex, "set_vertices");
  const bool is_double = found.placement().shape().is_double();
  if (!vertices.empty() && positions.is_double() != is_double) {
    fail("set_vertices: the positions are " + std::string(is_double ? "float" : "double") + ", those of " +
         name + " are " + (is_double ? "double" : "float") + "; give both in one precision");
  }
  found.move().set_vertices(vertices, positions, parallel);
  mark_changed();
}

void World::share_positions(ObjectId id, const PositionsView& positions) {
  WorldObject& found = movable_object(id, "share_positions");
  check_count(found, positions.size(), "share_positions");
  found.move().share_positions(positions, parallel);
  mark_changed();
}

void World::set_motion(ObjectId id, const PositionsView& from, const PositionsView& to) {
  WorldObject& found = movable_object(id, "set_motion");
  check_count(found, from.size(), "set_motion");
  check_count(found, to.size(), "set_motion");
  if (from.is_double() != to.is_double())
    fail("set_motion: one end of the path is float, the other double; give both in one precision");
  found.move().set_motion(from, to, parallel);
  mark_changed();
}

void World::translate(ObjectId id, const Vec3d& offset) {
  movable_object(id, "translate").move().translate(offset, parallel);
  mark_changed();
}

void World::set_transform(ObjectId id, const RigidTransform& transform) {
  WorldObject& found = movable_object(id, "set_transform");
  if (found.options.solid && Placement::sign_of(transform) == 0) {
    fail("set_transform: the matrix is singular, so it makes " + found.options.name +
         " flat, which is solid; give a matrix whose determinant is not 0");
  }
  found.move().set_transform(transform, parallel);
  mark_changed();
}

void World::set_options(ObjectId id, const ObjectChanges& changes) {
  WorldObject& found = object(id, "set_options");
  const auto [distances, pairs] = change_options(found.options, changes);
  if (distances) found.move();  // so that its pairs are found again
  if (distances || pairs) mark_changed();
}

void World::set_vertex_groups(ObjectId id, std::span<const std::uint32_t> groups,
                              std::span<const std::uint32_t> masks) {
  WorldObject& found = object(id, "set_vertex_groups");
  const std::size_t count = found.vertex_count();
  for (const std::size_t given : {groups.size(), masks.size()}) {
    if (given == count || (groups.empty() && masks.empty())) continue;
    fail("set_vertex_groups: " + std::to_string(given) + " numbers for " + found.options.name +
         ", which has " + std::to_string(count) + " vertices; give a group and a mask for each vertex");
  }
  found.set_vertex_groups(groups, masks);
  found.move();  // so that its pairs are found again
  mark_changed();
}

void World::set_filter(PairFilter filter) {
  filter_ = std::move(filter);
  mark_changed();
}

bool World::may_pair_by_groups(const IndexPair& pair) const {
  const ObjectOptions &a = slots_[pair.a].object->options, &b = slots_[pair.b].object->options;
  if (a.is_static && b.is_static) return false;
  return (a.group & b.mask) != 0 && (b.group & a.mask) != 0;
}

bool World::may_pair(const IndexPair& pair) const {
  return may_pair_by_groups(pair) && (!filter_ || filter_(id_of(pair.a), id_of(pair.b)));
}

std::vector<ObjectPair> World::all_pairs() const {
  std::vector<ObjectPair> pairs;
  const std::vector<ObjectId> ids = objects();
  for (const ObjectId a : ids) {
    if (slots_[a.index].object->options.self_collision) pairs.push_back({a, a});
    for (const ObjectId b : ids) {
      if (a < b && may_pair({a.index, b.index})) pairs.push_back({a, b});
    }
  }
  return pairs;
}

}  // namespace supple
