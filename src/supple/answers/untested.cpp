#include "answers/untested.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/vector.hpp"
#include "supple/topology.hpp"

namespace supple {
namespace {

/// Groups and masks of some objects, or of the vertices of one.
class GroupPairs {
 public:
  void add(std::uint32_t group, std::uint32_t mask) {
    for (; group != 0; group &= group - 1) masks_[static_cast<std::size_t>(std::countr_zero(group))] |= mask;
  }
  /// Whether one of them may be tested against this one.
  bool accept(std::uint32_t group, std::uint32_t mask) const {
    for (; mask != 0; mask &= mask - 1) {
      if ((masks_[static_cast<std::size_t>(std::countr_zero(mask))] & group) != 0) return true;
    }
    return false;
  }
  /// Whether one of them may be tested against one of the others.
  bool accept(const GroupPairs& others) const {
    for (std::uint32_t bit = 0; bit < masks_.size(); ++bit) {
      if (others.accept(std::uint32_t{1} << bit, masks_[bit])) return true;
    }
    return false;
  }

 private:
  std::array<std::uint32_t, 32> masks_{};  // of those that have each bit in their group
};

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

// A pair needs both traits, each in one of its objects.
constexpr unsigned can_move = 1, has_what_is_needed = 2, both_traits = 3;

unsigned traits_of(ContactKinds kind, const WorldObject& object) {
  return (object.options.is_static ? 0 : can_move) | (has_quality(kind, object) ? has_what_is_needed : 0);
}

/// Objects that may be paired by their groups, added one after the other.
class PairableObjects {
 public:
  explicit PairableObjects(ContactKinds kind) : kind_(kind) {}

  /// Whether the object may be paired with an earlier one.
  bool add(const WorldObject& object) {
    const unsigned traits = traits_of(kind_, object);
    const auto& [group, mask] = std::pair(object.options.group, object.options.mask);
    bool is_pairable = false;
    for (unsigned others = 0; others < earlier_.size(); ++others) {
      is_pairable = is_pairable || ((others | traits) == both_traits && earlier_[others].accept(group, mask));
    }
    earlier_[traits].add(group, mask);
    return is_pairable;
  }

 private:
  ContactKinds kind_;
  std::array<GroupPairs, 4> earlier_;  // by traits
};

}  // namespace

/// Calls `accept(a, b)` for pairs of candidates until it returns true. After many pairs, true is assumed.
template <class Accept>
bool UntestedKinds::any_candidate_pair(const World& world, ContactKinds kind, const Accept& accept) const {
  std::size_t left = 1 << 16;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    for (std::size_t j = i + 1; j < candidates_.size(); ++j) {
      const IndexPair pair{candidates_[i], candidates_[j]};
      const WorldObject &a = world[pair.a], &b = world[pair.b];
      if (left-- == 0) return true;
      if ((traits_of(kind, a) | traits_of(kind, b)) == both_traits && world.may_pair_by_groups(pair) &&
          accept(pair, a, b))
        return true;
    }
  }
  return false;
}

std::optional<NothingToTest> UntestedKinds::nothing_to_test(const World& world, const Question& question,
                                                            ContactKinds kind) {
  const TestedElements tested(kind, question.impact.kinds);
  PairableObjects pairable(kind);
  bool has_objects = false, has_elements = false, is_pairable = false, has_vertex_groups = false;
  candidates_.clear();
  for (std::uint32_t slot = 0; slot < world.slot_count(); ++slot) {
    const WorldObject* const object = world.at(slot);
    if (object == nullptr) continue;
    has_objects = true;
    if (tested.next(*object, 0) == tested.count(*object)) {
      has_elements = has_elements || tested.has_any(*object);
      continue;
    }
    candidates_.push_back(slot);
    has_vertex_groups = has_vertex_groups || !object->vertex_groups().empty();
    is_pairable = pairable.add(*object) || is_pairable;
    if (is_pairable && !question.has_filter(world) && !has_vertex_groups) return std::nullopt;
  }
  if (!has_objects) return NothingToTest::no_objects;
  if (candidates_.empty()) return has_elements ? NothingToTest::not_finite : NothingToTest::no_elements;
  const auto any_of_candidates = [&](auto holds) {
    return std::any_of(candidates_.begin(), candidates_.end(), holds);
  };
  if (!any_of_candidates([&](std::uint32_t slot) { return has_quality(kind, world[slot]); }))
    return lack_of_quality(kind);
  const auto is_tested_alone = [&](std::uint32_t slot) { return question.tests_itself(world, slot); };
  const bool tests_itself = kind != ContactKinds::penetration && any_of_candidates(is_tested_alone);
  if (tests_itself && any_of_candidates([&](std::uint32_t slot) {
        const WorldObject& object = world[slot];
        return is_tested_alone(slot) && has_quality(kind, object) && may_touch_itself(object) &&
               (tested.has_edges_and_points ? has_separate_elements(object, tested)
                                            : has_separate_triangles(object, tested));
      }))
    return std::nullopt;
  if (candidates_.size() == 1) {
    if (!tests_itself) return NothingToTest::one_object;
    return any_of_candidates([&](std::uint32_t slot) { return may_touch_itself(world[slot]); })
               ? NothingToTest::shared_vertex
               : NothingToTest::groups;
  }
  if (!any_of_candidates([&](std::uint32_t slot) { return !world[slot].options.is_static; }))
    return NothingToTest::all_static;
  const auto may_touch = [&](const IndexPair&, const WorldObject& a, const WorldObject& b) {
    return !has_vertex_groups || vertex_group_pairs(a).accept(vertex_group_pairs(b));
  };
  if (!is_pairable || !any_candidate_pair(world, kind, may_touch)) return NothingToTest::groups;
  const auto is_accepted = [&](const IndexPair& pair, const WorldObject& a, const WorldObject& b) {
    return may_touch(pair, a, b) && question.may_pair(world, pair);
  };
  if (!any_candidate_pair(world, kind, is_accepted)) return NothingToTest::filter;
  return std::nullopt;
}

std::span<const UntestedKind> UntestedKinds::list(const World& world, const Question& question,
                                                  const DetectResult& found) {
  untested_.clear();
  const auto list = [&](ContactKinds kind, bool has_contacts) {
    if (!contains(question.contacts, kind) || has_contacts) return;
    if (const auto reason = nothing_to_test(world, question, kind)) untested_.push_back({kind, *reason});
  };
  list(ContactKinds::intersection, !found.groups.empty());
  list(ContactKinds::continuous, !found.continuous_groups.empty());
  list(ContactKinds::proximity, !found.proximity_groups.empty());
  list(ContactKinds::penetration, !found.penetration_groups.empty() || !found.contained_parts.empty());
  return untested_;
}

}  // namespace supple
