#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "queries/feature_name.hpp"
#include "supple/types.hpp"

namespace supple {

/// A point that may span a manifold.
struct ManifoldCandidate {
  Vec3d position;
  double depth = 0;
  /// The features of a and of b that meet there. A vertex that a curve encloses has one.
  std::array<FeatureName, 2> names{};
  std::array<bool, 2> has_name{};
};

/// Indices of candidates.
struct ManifoldChoice {
  std::array<std::uint32_t, 4> chosen{};
  std::uint32_t count = 0;
};

/// Chooses at most four points that span the candidates in the plane at right angles to the normal, in the
/// order around it; see `Manifold`. There is at least one candidate, and all are finite. O(n).
ManifoldChoice choose_points(std::span<const ManifoldCandidate> candidates, const Vec3d& normal);

}  // namespace supple
