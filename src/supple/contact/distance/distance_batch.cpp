#include "contact/distance/distance_batch.hpp"

namespace supple {
namespace {

using Kind = ClosestFeatures::Kind;

FeaturePair feature_pair_of(const FoundFeatures& pair) {
  if (pair.features.kind == Kind::vertices) return FeaturePair::vertices;
  if (pair.features.kind == Kind::vertex_edge) return FeaturePair::vertex_edge;
  return pair.elements.count_a == 2 ? FeaturePair::edges : FeaturePair::vertex_face;
}

/// The indices of the points that `compute_distance_numbers` needs.
std::array<std::uint8_t, 4> points_of_features(const ClosestFeatures& features) {
  if (features.kind == Kind::interiors) return {0, 1, 2, 3};
  return {features.vertex, features.edge[0], features.edge[1], 0};
}

}  // namespace

void DistanceBatch::compute(std::span<const FoundFeatures> pairs, std::span<ElementDistance> results,
                            std::uint64_t& exact_count) {
  for (const FeaturePair kind :
       {FeaturePair::vertices, FeaturePair::vertex_edge, FeaturePair::vertex_face, FeaturePair::edges}) {
    std::array<std::size_t, capacity> places;
    std::size_t count = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (feature_pair_of(pairs[i]) != kind) continue;
      const auto points = points_of_features(pairs[i].features);
      for (std::size_t k = 0; k < 4; ++k) block_.set(k, count, pairs[i].elements.points[points[k]]);
      places[count++] = i;
    }
    if (count > 0) compute_distance_numbers(block_, count, kind, numbers_);
    for (std::size_t k = 0; k < count; ++k) {
      const auto& [elements, features] = pairs[places[k]];
      bool used_exact = false;
      results[places[k]] = numbers_.is_valid[k] != 0 ? distance_of(elements, features, numbers_.at(k))
                                                     : distance_of(elements, features, used_exact);
      exact_count += used_exact ? 1 : 0;
    }
  }
}

}  // namespace supple
