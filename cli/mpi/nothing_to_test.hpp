#pragma once

#include <span>
#include <vector>

#include "inputs/inputs.hpp"
#include "supple/result.hpp"

namespace supple::cli {

/// Finds `DetectResult::untested` on rank 0, where the input is but no scene with all objects. What can be
/// tested depends on a few elements of each object, so a small scene with these says it.
class NothingFound {
 public:
  explicit NothingFound(const Input& input) : input_(input) {}

  /// The requested kinds without contacts for which there was nothing to test. `is_step` says that objects
  /// with a motion were on their way. The span is valid until the next call.
  std::span<const UntestedKind> untested(const DetectResult& result, bool is_step);

 private:
  std::vector<UntestedKind> reasons(std::span<const NonFiniteVertex> non_finite, bool is_step) const;

  const Input& input_;
  std::vector<UntestedKind> reasons_, untested_;
  std::vector<NonFiniteVertex> non_finite_;  ///< of `reasons_`, without positions
  bool is_step_ = false, has_reasons_ = false;
};

}  // namespace supple::cli
