#pragma once

#include "answers/question.hpp"
#include "supple/call_limits.hpp"
#include "supple/result.hpp"
#include "world/world.hpp"

namespace supple {

/// Compares the result of a search with exact brute force; see `Scene::verify`. The world must be as it was
/// searched.
VerifyReport verify(const World& world, const Question& question, const DetectResult& result,
                    const CallLimits& limits);

}  // namespace supple
