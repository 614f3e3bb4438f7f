#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "answers/question.hpp"
#include "supple/result.hpp"
#include "world/world.hpp"

namespace supple {

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
  template <class Accept>
  bool any_candidate_pair(const World& world, ContactKinds kind, const Accept& accept) const;

  std::vector<UntestedKind> untested_;
  std::vector<std::uint32_t> candidates_;  // slots of objects with something to test
};

}  // namespace supple
