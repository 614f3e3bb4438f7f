#pragma once

#include <cstddef>

#include "answers/question.hpp"
#include "supple/verify.hpp"
#include "world/world.hpp"

namespace supple {

/// The pairs of objects with these numbers, in their order: `first`, `first + stride` and so on.
struct PairShare {
  std::size_t first = 0, stride = 1;
};

/// Compares the result of a search with exact brute force; see supple/verify.hpp. The world must be as it was
/// searched.
VerifyReport verify(const World& world, const Question& question, const DetectResult& result,
                    const CallLimits& limits, const PairShare& share = {});

}  // namespace supple
