#include "contact/distance/distance_batch.hpp"

namespace supple {

void DistanceBatch::compute(std::span<const FoundFeatures> pairs, std::span<ElementDistance> results,
                            std::uint64_t& exact_count) {
  for (const FeaturePair kind :
       {FeaturePair::vertices, FeaturePair::vertex_edge, FeaturePair::vertex_face, FeaturePair::edges}) {
    std::array<std::size_t, capacity> places;
    std::size_t count = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto& [elements, features] = pairs[i];
      if (feature_pair_of(elements, features) != kind) continue;
      block_.set_features(count, elements, features);
      places[count++] = i;
    }
    compute_distance_numbers(block_, count, kind, DistanceAccuracy::full, numbers_);
    for (std::size_t k = 0; k < count; ++k) {
      const auto& [elements, features] = pairs[places[k]];
      bool used_exact = false;
      results[places[k]] = numbers_.is_valid[k] != 0 ? distance_of(elements, features, numbers_.at(k))
                                                     : distance_of(elements, features, used_exact);
      exact_count += used_exact ? 1 : 0;
    }
  }
}

void DistanceBatch::find(std::span<FoundFeatures> pairs, std::span<ElementDistance> results) {
  std::array<FeatureCode, capacity> codes;
  for (std::size_t i = 0; i < pairs.size(); ++i) block_.set_features(i, pairs[i].elements, {});
  classify(block_, pairs.size(), false, any_distance, codes.data());
  bool used_exact = false;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].features = codes[i] < FeatureCode::apart
                            ? features_of_code(codes[i], false)
                            : *closest_features_within(pairs[i].elements, any_distance, used_exact);
  }
  std::uint64_t exact_count = 0;
  compute(pairs, results, exact_count);
}

}  // namespace supple
