#include "answers/untested.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/vector.hpp"
#include "supple/topology.hpp"

namespace supple {
namespace {

/// What a kind of contacts tests of objects.
struct TestedElements {
  bool has_edges_and_points = false;  // besides triangles
  bool only_edges = false;
  bool on_the_way = false;

  explicit TestedElements(ContactKinds kind, ElementKinds kinds)
      : has_edges_and_points(kind == ContactKinds::continuous || kind == ContactKinds::proximity),
        only_edges(has_edges_and_points && kinds == ElementKinds::edge_edge),
        on_the_way(kind == ContactKinds::continuous) {}

  std::uint32_t count(const WorldObject& object) const {
    return has_edges_and_points ? static_cast<std::uint32_t>(object.octree().triangles().size())
                                : object.face_count();
  }
  bool is_tested(const Triangle& element) const { return !only_edges || element[0] != element[2]; }
  bool is_finite(const WorldObject& object, std::uint32_t vertex) const {
    const Placement& placement = object.placement();
    return supple::is_finite(placement.position(vertex)) &&
           (!on_the_way || supple::is_finite(placement.start_position(vertex)));
  }
  /// Whether an element takes part: a triangle with an edge that is finite, or all of another element.
  /// Without edges and points, all of a triangle.
  bool takes_part(const WorldObject& object, std::uint32_t element) const {
    const Triangle& corners = object.octree().user_triangle(element);
    const auto finite =
        std::count_if(corners.begin(), corners.end(), [&](std::uint32_t v) { return is_finite(object, v); });
    const bool has_parts = has_edges_and_points && element < object.face_count();
    return is_tested(corners) && finite >= (has_parts ? 2 : 3);
  }
  /// The first element from this number on that takes part, or the number of elements.
  std::uint32_t next(const WorldObject& object, std::uint32_t element) const {
    const std::uint32_t end = count(object);
    while (element < end && !takes_part(object, element)) ++element;
    return element;
  }
  bool has_any(const WorldObject& object) const {
    const std::uint32_t end = count(object);
    for (std::uint32_t e = 0; e < end; ++e) {
      if (is_tested(object.octree().user_triangle(e))) return true;
    }
    return false;
  }
};

std::size_t count_different(Triangle element) {
  std::sort(element.begin(), element.end());
  return static_cast<std::size_t>(std::unique(element.begin(), element.end()) - element.begin());
}

/// Whether an object has two triangles that it tests against each other when it is tested against itself.
bool has_separate_triangles(const WorldObject& object, const TestedElements& tested) {
  const std::uint32_t first = tested.next(object, 0), end = tested.count(object);
  if (first == end) return false;
  const Triangle& one = object.octree().user_triangle(first);
  for (std::uint32_t t = tested.next(object, first + 1); t < end; t = tested.next(object, t + 1)) {
    const Triangle& other = object.octree().user_triangle(t);
    if (object.options.neighbours == Neighbours::exact ||
        std::find_first_of(one.begin(), one.end(), other.begin(), other.end()) == one.end())
      return true;
  }
  std::vector<Triangle> all;  // for example a fan
  for (std::uint32_t t = first; t < end; t = tested.next(object, t + 1))
    all.push_back(object.octree().user_triangle(t));
  return count_neighbour_pairs(all) < std::uint64_t{all.size()} * (all.size() - 1) / 2;
}

/// The same for elements: a fourth vertex is enough for a triangle, a third one for an edge of no triangle.
bool has_separate_elements(const WorldObject& object, const TestedElements& tested) {
  constexpr std::size_t of_two_edges = 4;
  std::size_t needed = of_two_edges;
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t e = tested.next(object, 0); e < tested.count(object); e = tested.next(object, e + 1)) {
    const Triangle& element = object.octree().user_triangle(e);
    if (!tested.only_edges) needed = std::min(needed, count_different(element) + 1);
    for (const std::uint32_t vertex : element) {
      if (tested.is_finite(object, vertex) &&
          std::find(vertices.begin(), vertices.end(), vertex) == vertices.end())
        vertices.push_back(vertex);
    }
    if (vertices.size() >= needed) return true;
  }
  return false;
}

/// Whether the groups of vertices let two vertices of an object touch.
bool may_touch_itself(const WorldObject& object) {
  const VertexGroups groups = object.vertex_groups();
  GroupPairs earlier;
  for (std::uint32_t v = 0; v < groups.groups.size(); ++v) {
    if (earlier.accept(groups.group(v), groups.mask(v))) return true;
    earlier.add(groups.group(v), groups.mask(v));
  }
  return groups.empty();
}

GroupPairs vertex_group_pairs(const WorldObject& object) {
  GroupPairs pairs;
  const VertexGroups groups = object.vertex_groups();
  if (groups.empty()) pairs.add(~std::uint32_t{0}, ~std::uint32_t{0});
  for (std::uint32_t v = 0; v < groups.groups.size(); ++v) pairs.add(groups.group(v), groups.mask(v));
  return pairs;
}

/// Whether an object is what a kind needs of one object of a pair.
bool has_quality(ContactKinds kind, const WorldObject& object) {
  if (kind == ContactKinds::continuous) return object.placement().has_motion();
  if (kind == ContactKinds::proximity) return object.options.margin > 0;
  if (kind == ContactKinds::penetration) return object.options.solid;
  return true;
}

NothingToTest lack_of_quality(ContactKinds kind) {
  return kind == ContactKinds::continuous  ? NothingToTest::no_motion
         : kind == ContactKinds::proximity ? NothingToTest::no_margin
                                           : NothingToTest::no_solid;
}

/// Calls `accept(a, b)` for pairs of objects that may be paired by their groups, until it returns true. After
/// many pairs, true is assumed.
template <class Accept>
bool any_pair(std::span<const TestableObject> objects, const Accept& accept) {
  std::size_t left = 1 << 16;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (std::size_t j = i + 1; j < objects.size(); ++j) {
      const TestableObject &a = objects[i], &b = objects[j];
      if (left-- == 0) return true;
      if (a.may_pair(b) && a.vertex_groups.accept(b.vertex_groups) && accept(a, b)) return true;
    }
  }
  return false;
}

}  // namespace

TestableObject testable_object(ContactKinds kind, ElementKinds elements, const WorldObject& object,
                               ObjectId id, bool tests_itself) {
  const TestedElements tested(kind, elements);
  TestableObject found{.id = id,
                       .has_quality = has_quality(kind, object),
                       .is_static = object.options.is_static,
                       .has_vertex_groups = !object.vertex_groups().empty(),
                       .group = object.options.group,
                       .mask = object.options.mask,
                       .vertex_groups = vertex_group_pairs(object)};
  found.takes_part = tested.next(object, 0) != tested.count(object);
  found.has_elements = found.takes_part || tested.has_any(object);
  found.tests_itself = tests_itself && kind != ContactKinds::penetration;
  found.may_touch_itself = may_touch_itself(object);
  found.has_separate_elements =
      found.tests_itself && (tested.has_edges_and_points ? has_separate_elements(object, tested)
                                                         : has_separate_triangles(object, tested));
  return found;
}

std::optional<NothingToTest> nothing_to_test(ContactKinds kind, std::vector<TestableObject>& objects,
                                             const PairFilter& filter) {
  const auto any = [&](auto holds) { return std::any_of(objects.begin(), objects.end(), holds); };
  if (objects.empty()) return NothingToTest::no_objects;
  const bool has_elements = any([](const TestableObject& object) { return object.has_elements; });
  std::erase_if(objects, [](const TestableObject& object) { return !object.takes_part; });
  if (objects.empty()) return has_elements ? NothingToTest::not_finite : NothingToTest::no_elements;
  if (!any([](const TestableObject& object) { return object.has_quality; })) return lack_of_quality(kind);
  if (any([](const TestableObject& object) {
        return object.has_quality && object.may_touch_itself && object.has_separate_elements;
      }))
    return std::nullopt;
  if (objects.size() == 1) {
    if (!objects[0].tests_itself) return NothingToTest::one_object;
    return objects[0].may_touch_itself ? NothingToTest::shared_vertex : NothingToTest::groups;
  }
  if (!any([](const TestableObject& object) { return !object.is_static; })) return NothingToTest::all_static;
  PairableObjects pairable;
  bool is_pairable = false;
  for (const TestableObject& object : objects) is_pairable = pairable.add(object) || is_pairable;
  if (!is_pairable || !any_pair(objects, [](const auto&, const auto&) { return true; }))
    return NothingToTest::groups;
  if (filter && !any_pair(objects, [&](const auto& a, const auto& b) { return filter(a.id, b.id); }))
    return NothingToTest::filter;
  return std::nullopt;
}

std::optional<NothingToTest> UntestedKinds::nothing_to_test(const World& world, const Question& question,
                                                            ContactKinds kind) {
  PairableObjects pairable;
  bool has_vertex_groups = false;
  objects_.clear();
  for (std::uint32_t slot = 0; slot < world.slot_count(); ++slot) {
    const WorldObject* const object = world.at(slot);
    if (object == nullptr) continue;
    objects_.push_back(testable_object(kind, question.impact.kinds, *object, world.id_of(slot),
                                       question.tests_itself(world, slot)));
    has_vertex_groups = has_vertex_groups || objects_.back().has_vertex_groups;
    if (pairable.add(objects_.back()) && !question.has_filter(world) && !has_vertex_groups)
      return std::nullopt;
  }
  PairFilter filter;
  if (question.has_filter(world))
    filter = [&](ObjectId a, ObjectId b) { return question.may_pair(world, {a.index, b.index}); };
  return supple::nothing_to_test(kind, objects_, filter);
}

std::span<const UntestedKind> UntestedKinds::list(const World& world, const Question& question,
                                                  const DetectResult& found) {
  untested_.clear();
  for_each_kind_without_contacts(question.contacts, found, [&](ContactKinds kind) {
    if (const auto reason = nothing_to_test(world, question, kind)) untested_.push_back({kind, *reason});
  });
  return untested_;
}

}  // namespace supple
