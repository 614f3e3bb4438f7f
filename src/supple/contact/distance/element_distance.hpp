#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "supple/distance.hpp"

namespace supple {

/// The vertices of element a, then those of element b. Element a has one vertex and b one to three, or both
/// have two.
struct ElementPoints {
  std::array<Vec3d, 4> points{};
  std::uint8_t count_a = 1, count_b = 1;
};

/// What the error of a distance and its normal is at most: 4 units in the last place, or 2^-26 of it, for
/// which integers are rarely needed.
enum class DistanceAccuracy : std::uint8_t { full, rough };

/// The features that hold the closest points. Vertices have the indices of `ElementPoints`.
struct ClosestFeatures {
  enum class Kind : std::uint8_t { vertices, vertex_edge, interiors };
  Kind kind = Kind::interiors;
  std::uint8_t vertex = 0;  ///< of either element; of a when both features are vertices
  std::array<std::uint8_t, 2>
      edge{};  ///< the edge's ends, ascending; the first is b's vertex for two vertices

  bool operator==(const ClosestFeatures&) const = default;
};

/// The numbers of a distance, rounded.
struct DistanceNumbers {
  double distance = 0;
  /// The barycentric coordinates of the closest points: `along` of the second end of an edge, `rest` of the
  /// first; for two edges, of a and of b. For a face: `along` of the second and the third corner, `rest[0]`
  /// of the first.
  std::array<double, 2> along{}, rest{};
  Vec3d direction;  ///< from the edge to the vertex, or from b to a
};

/// The closest features of two elements whose distance is at most `max_distance` ≥ 0, or nothing. Exact. Sets
/// `used_exact` when integers decide.
std::optional<ClosestFeatures> closest_features_within(const ElementPoints& elements, double max_distance,
                                                       bool& used_exact);
/// The distance and the closest points of these features.
ElementDistance distance_of(const ElementPoints& elements, const ClosestFeatures& features, bool& used_exact,
                            DistanceAccuracy accuracy = DistanceAccuracy::full);
/// The same from numbers that were computed before.
ElementDistance distance_of(const ElementPoints& elements, const ClosestFeatures& features,
                            const DistanceNumbers& numbers);
/// The features as parts of each element.
std::array<Feature, 2> features_of_elements(const ClosestFeatures& features, std::uint8_t count_a);

/// The functions of `supple/distance.hpp` as one. `max_distance` ≥ 0. Sets `used_exact` when integers decide.
/// Decisions and features are exact for any accuracy.
std::optional<ElementDistance> distance_within(const ElementPoints& elements, double max_distance,
                                               bool& used_exact,
                                               DistanceAccuracy accuracy = DistanceAccuracy::full);

/// The sign of the difference of two distances: -1 when the first is smaller. Exact. Sets `used_exact` when
/// integers decide.
int compare_distances(const ElementPoints& p, const ElementPoints& q, bool& used_exact);

}  // namespace supple
