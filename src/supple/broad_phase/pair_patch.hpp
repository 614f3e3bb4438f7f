#pragma once

#include <cstdint>
#include <vector>

#include "supple/broad_phase.hpp"

namespace supple {

/// Changes a sorted list of pairs where it changes, and shifts what is between.
class PairPatch {
 public:
  /// Takes those of the pairs a << 32 | b out that are in the list, and puts those in that are not; one that
  /// is given twice stays as it is. O(toggled log pairs), and moving what is behind the first of them.
  void toggle(std::vector<std::uint64_t>& toggled, std::vector<IndexPair>& pairs);

 private:
  /// What is between one change and the next, in the list as it was, and by how much it moves.
  struct Block {
    std::size_t begin, end;
    std::ptrdiff_t shift;
  };
  std::vector<Block> blocks_;
};

}  // namespace supple
