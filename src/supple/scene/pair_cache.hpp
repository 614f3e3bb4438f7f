#pragma once

#include <span>
#include <vector>

#include "supple/result.hpp"
#include "supple/types.hpp"

namespace supple {

/// Pairs kept while they last and released when they part (the paper's section 5.2), with the changes of each
/// step. A pair that begins ends exactly once.
class PairCache {
 public:
  /// The pairs of this step, ascending, each once. O(old + new), without allocation once it has held as many.
  void update(std::span<const ObjectPair> now);

  /// An object is gone: its pairs end at the next `update`, even where that is handed them once more. They
  /// then begin anew. An object that takes over the index with another generation is a different one.
  void release(ObjectId object);

  /// Changes made by the last `update`, each list ascending. Valid until the next one.
  PairEvents events() const { return {begin_, stay_, end_}; }
  /// The pairs handed to the last `update`.
  std::span<const ObjectPair> pairs() const { return pairs_; }

 private:
  bool is_released(const ObjectPair& pair) const;

  std::vector<ObjectPair> pairs_;
  std::vector<ObjectPair> begin_, stay_, end_;
  std::vector<ObjectId> released_;  // since the last update, ascending
};

}  // namespace supple
