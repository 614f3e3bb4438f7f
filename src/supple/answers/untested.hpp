#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "answers/question.hpp"
#include "supple/result.hpp"
#include "world/world.hpp"

namespace supple {

/// What decides whether a kind of contacts has something to test of an object.
struct TestableObject {
  ObjectId id;
  bool has_elements = false;  ///< that the kind tests
  bool takes_part = false;    ///< one of them has the finite vertices that it needs
  bool has_quality = true;    ///< a motion, a margin or a solid, where the kind needs one
  bool is_static = false;
  bool tests_itself = false;  ///< and two of its elements take part
  std::uint32_t group = 1, mask = ~std::uint32_t{0};

  bool may_pair(const TestableObject& other) const {
    return takes_part && other.takes_part && (has_quality || other.has_quality) &&
           !(is_static && other.is_static) && (group & other.mask) != 0 && (other.group & mask) != 0;
  }
};

/// Whether an object has what a kind needs of one object of a pair.
bool has_quality(ContactKinds kind, const ObjectOptions& object, bool has_motion);
TestableObject testable_object(ContactKinds kind, ElementKinds elements, const WorldObject& object,
                               ObjectId id, bool tests_itself);

/// Objects of a scene, added one after the other until one of them is tested.
class TestableObjects {
 public:
  void clear() {
    objects_.clear();
    pairs_left_ = most_pairs;
    is_filtered_ = false;
  }
  /// Whether the object is tested, against itself or an earlier one. `accept(a, b)` is the pair filter.
  template <class Accept>
  bool add(const TestableObject& object, const Accept& accept) {
    if (object.takes_part && object.has_quality && object.tests_itself) return true;
    for (std::size_t i = 0; i < objects_.size() && pairs_left_ > 0; ++i, --pairs_left_) {
      if (!objects_[i].may_pair(object)) continue;
      if (accept(objects_[i].id, object.id)) return true;
      is_filtered_ = true;
    }
    objects_.push_back(object);
    return false;
  }
  /// Why none of the objects is tested. Nothing when there are many pairs that groups or filters exclude:
  /// they are not all looked at.
  std::optional<NothingToTest> reason(ContactKinds kind) const;

 private:
  static constexpr std::size_t most_pairs = 1 << 16;
  std::vector<TestableObject> objects_;
  std::size_t pairs_left_ = most_pairs;
  bool is_filtered_ = false;
};

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
  TestableObjects objects_;  // scratch memory
};

}  // namespace supple
