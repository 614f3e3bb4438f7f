#pragma once

#include <cstddef>
#include <cstdint>

#include "contact/distance/element_distance.hpp"

namespace supple {

/// The points of up to 64 pairs: of a vertex and a face, of two edges, of two features, or of an edge and a
/// face. All coordinates are finite.
struct PointsBlock {
  static constexpr std::size_t capacity = 64;

  /// By vertex, as `ElementPoints` orders them, by pair and by axis. The fourth number is unspecified.
  alignas(64) double points[5][capacity][4];

  void set(std::size_t vertex, std::size_t pair, const Vec3d& point) {
    double* const p = points[vertex][pair];
    p[0] = point.x;
    p[1] = point.y;
    p[2] = point.z;
  }
  /// Sets what `compute_distance_numbers` needs of two features.
  void set_features(std::size_t pair, const ElementPoints& elements, const ClosestFeatures& features);
};

/// What `classify` says about a pair: the closest features of elements within the distance by their number in
/// `features_of_code`, or one of two answers.
enum class FeatureCode : std::uint8_t { interiors = 0, crosses = 0, apart = 254, unknown = 255 };

/// Finds the closest features of `count` pairs of a vertex and a face, or of two edges, whose distance is at
/// most `max_distance` ≥ 0. Every answer but `unknown` is exact. It is `unknown` where double precision
/// cannot decide, and where several features are closest. The order of the vertices of an element is
/// arbitrary. The answers are the same for every instruction set. Takes about 5 ns a pair.
void classify(const PointsBlock& block, std::size_t count, bool are_edges, double max_distance,
              FeatureCode* codes);
ClosestFeatures features_of_code(FeatureCode code, bool are_edges);
/// The ends of both features; those of a vertex are equal, and those of a face a vertex of it.
std::array<std::uint8_t, 4> ends_of_code(FeatureCode code, bool are_edges);

/// What `edge_crosses_face` says about `count` pairs of an edge and a face: `apart`, `crosses`, or `unknown`
/// where double precision cannot decide.
void classify_crossings(const PointsBlock& block, std::size_t count, FeatureCode* codes);

/// `DistanceNumbers` of up to 64 pairs.
struct DistanceNumbersBlock {
  alignas(64) double distance[PointsBlock::capacity];
  double along[2][PointsBlock::capacity], rest[2][PointsBlock::capacity];
  double direction[3][PointsBlock::capacity];
  double is_valid[PointsBlock::capacity];  ///< 1, or 0 where integers are needed

  DistanceNumbers at(std::size_t pair) const {
    return {distance[pair],
            {along[0][pair], along[1][pair]},
            {rest[0][pair], rest[1][pair]},
            {direction[0][pair], direction[1][pair], direction[2][pair]}};
  }
};

/// What the features of a block are. Two vertices use the first two points of a block, a vertex and an edge
/// the first three.
enum class FeaturePair : std::uint8_t { vertices, vertex_edge, vertex_face, edges };

FeaturePair feature_pair_of(const ElementPoints& elements, const ClosestFeatures& features);

/// Computes the numbers of `count` pairs of features. Takes about 30 ns a pair.
void compute_distance_numbers(const PointsBlock& block, std::size_t count, FeaturePair kind,
                              DistanceAccuracy accuracy, DistanceNumbersBlock& numbers);

}  // namespace supple
