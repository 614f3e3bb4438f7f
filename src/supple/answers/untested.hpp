#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "answers/question.hpp"
#include "supple/result.hpp"
#include "world/world.hpp"

namespace supple {

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

/// What decides whether a kind of contacts has something to test of an object.
struct TestableObject {
  ObjectId id;
  bool has_elements = false;  ///< that the kind tests
  bool takes_part = false;    ///< one of them has the finite vertices that it needs
  bool has_quality = true;    ///< a motion, a margin or a solid, where the kind needs one
  bool is_static = false;
  bool tests_itself = false;
  bool may_touch_itself = false;       ///< two of its vertices, by their groups
  bool has_separate_elements = false;  ///< two that it tests against each other, if it tests itself
  bool has_vertex_groups = false;
  std::uint32_t group = 1, mask = ~std::uint32_t{0};
  GroupPairs vertex_groups{};

  static constexpr unsigned can_move = 1, has_what_is_needed = 2, both_traits = 3;
  /// A pair needs both traits, each in one of its objects.
  unsigned traits() const { return (is_static ? 0 : can_move) | (has_quality ? has_what_is_needed : 0); }
  /// Without the groups of vertices.
  bool may_pair(const TestableObject& other) const {
    return (traits() | other.traits()) == both_traits && (group & other.mask) != 0 &&
           (other.group & mask) != 0;
  }
};

TestableObject testable_object(ContactKinds kind, ElementKinds elements, const WorldObject& object,
                               ObjectId id, bool tests_itself);
/// Why there is nothing to test of these objects, if so. Erases those that do not take part. An empty filter
/// lets all pairs through.
std::optional<NothingToTest> nothing_to_test(ContactKinds kind, std::vector<TestableObject>& objects,
                                             const PairFilter& filter);

/// Objects that may be paired by their groups, added one after the other.
class PairableObjects {
 public:
  /// Whether the object may be paired with an earlier one.
  bool add(const TestableObject& object) {
    if (!object.takes_part) return false;
    bool is_pairable = false;
    for (unsigned others = 0; others < earlier_.size(); ++others) {
      is_pairable = is_pairable || ((others | object.traits()) == TestableObject::both_traits &&
                                    earlier_[others].accept(object.group, object.mask));
    }
    earlier_[object.traits()].add(object.group, object.mask);
    return is_pairable;
  }

 private:
  std::array<GroupPairs, 4> earlier_;  // by traits
};

/// Calls `visit(kind)` for each requested kind that found nothing.
template <class Visit>
void for_each_kind_without_contacts(ContactKinds requested, const DetectResult& found, const Visit& visit) {
  const auto check = [&](ContactKinds kind, bool has_contacts) {
    if (contains(requested, kind) && !has_contacts) visit(kind);
  };
  check(ContactKinds::intersection, !found.groups.empty());
  check(ContactKinds::continuous, !found.continuous_groups.empty());
  check(ContactKinds::proximity, !found.proximity_groups.empty());
  check(ContactKinds::penetration, !found.penetration_groups.empty() || !found.contained_parts.empty());
}

/// Finds the kinds of contacts for which a world has nothing to test, and the reason.
class UntestedKinds {
 public:
  /// Lists each requested kind that has nothing to test. `found` has the groups of all contacts. The span is
  /// valid until the next call.
  std::span<const UntestedKind> list(const World& world, const Question& question, const DetectResult& found);
  /// Calls `visit(list)` for each list of the result.
  template <class Visit>
  void visit_lists(const Visit& visit) {
    visit(untested_);
  }

 private:
  std::optional<NothingToTest> nothing_to_test(const World& world, const Question& question,
                                               ContactKinds kind);

  std::vector<UntestedKind> untested_;
  std::vector<TestableObject> objects_;  // scratch memory
};

}  // namespace supple
