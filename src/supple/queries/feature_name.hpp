#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>

#include "supple/contact.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// A feature of a surface by its vertices or its triangle, to recognise it in all triangles that have it:
/// {v, v} for a vertex, {v, w} with v < w for an edge, {t, t} for the face of triangle t.
struct FeatureName {
  FeatureKind kind = FeatureKind::face;
  std::uint32_t first = 0, last = 0;

  constexpr auto operator<=>(const FeatureName&) const = default;
};

inline FeatureName name_of(const Feature& feature, const Triangle& triangle, std::uint32_t id) {
  if (feature.kind == FeatureKind::face) return {feature.kind, id, id};
  const std::uint32_t first = triangle[feature.index],
                      last = feature.kind == FeatureKind::vertex ? first : triangle[(feature.index + 1u) % 3];
  return {feature.kind, std::min(first, last), std::max(first, last)};
}

}  // namespace supple
