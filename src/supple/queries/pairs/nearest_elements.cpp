// The decisions of `NearestPairSearch` about two triangles and their elements.

#include <algorithm>
#include <array>
#include <span>

#include "contact/intersection/triangle_intersection.hpp"
#include "geometry/vector.hpp"
#include "queries/pairs/nearest_pair.hpp"

namespace supple {
namespace {

PairName name_of(const ProximityPair& pair) {
  return {pair.kind_a, pair.kind_b, pair.element_a, pair.element_b};
}

/// Whether two edges are along the same axis: then their vertices are as near as their insides.
bool are_along_one_axis(const EdgePoints& p, const EdgePoints& q) {
  int equal = 0;
  for (int axis = 0; axis < 3; ++axis) equal += p[0][axis] == p[1][axis] && q[0][axis] == q[1][axis] ? 1 : 0;
  return equal >= 2;
}

/// Whether the boxes of some points are farther apart than `distance`.
bool boxes_apart(std::span<const Vec3d> a, std::span<const Vec3d> b, double distance) {
  const QueryBox box_a = box_around(a), box_b = box_around(b);
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max({box_a.min[axis] - box_b.max[axis], box_b.min[axis] - box_a.max[axis], 0.0});
    if (gap > distance * (1 + 0x1p-50)) return true;
    square += gap * gap;
  }
  return square > distance * distance * (1 + 0x1p-48) + 0x1p-1040;
}

}  // namespace

void NearestPairSearch::decide(TrianglePair triangles) {
  const TrianglePoints a = a_->corners(triangles.a), b = b_->corners(triangles.b);
  const auto ids_of = [&](TrianglePair pair) {
    return std::pair(a_->triangle_ids[pair.a], b_->triangle_ids[pair.b]);
  };
  if (intersects_ && search_ == Search::nearest && ids_of(triangles_) < ids_of(triangles)) return;
  ++decided_triangles_;
  if (!boxes_apart(a, b, 0)) {
    if (triangles_intersect(a, b)) {
      intersects_ = true;
      bound_.clear();
      triangles_ = triangles;
      set_limit(0);
      return;
    }
  }
  if (!intersects_ && search_ == Search::nearest) decide_elements(triangles, a, b);
}

/// Considers the vertices and faces and the edges of two triangles that do not intersect.
void NearestPairSearch::decide_elements(TrianglePair triangles, const TrianglePoints& a,
                                        const TrianglePoints& b) {
  const Triangle &vertices_a = a_->triangles[triangles.a], &vertices_b = b_->triangles[triangles.b];
  const auto vertex = [](const Triangle& vertices, const TrianglePoints& corners, std::size_t i) {
    return PairElement(std::span(&vertices[i], 1), {corners[i]}, 0);
  };
  const auto edge = [](const Triangle& vertices, const TrianglePoints& corners, std::size_t i) {
    const std::size_t k = (i + 1) % 3;
    return PairElement(std::array{vertices[i], vertices[k]}, {corners[i], corners[k]}, 0);
  };
  const auto face = [](const QueriedObject& object, std::uint32_t triangle, const TrianglePoints& corners) {
    return PairElement(object.triangles[triangle], corners, object.triangle_ids[triangle]);
  };
  // Makes room for all elements: the bound may not change between the depths and their use.
  if (vertices_and_faces_.count + 6 > PointsBlock::capacity) consider(vertices_and_faces_);
  if (edges_.count + 9 > PointsBlock::capacity) consider(edges_);
  TriangleDepths depths_a, depths_b;
  if (bound_.is_set()) {
    depths_a = bound_.depths(NearestBound::a, *a_, triangles.a);
    depths_b = bound_.depths(NearestBound::b, *b_, triangles.b);
  }
  const auto is_excluded = [&](unsigned corners_a, unsigned corners_b) {
    return bound_.is_set() && bound_.excludes(depths_a, corners_a, depths_b, corners_b);
  };
  const auto is_not_nearer = [&](unsigned corners_a, unsigned corners_b) {
    return bound_.is_set() && depths_a.least(corners_a) >= 0 && depths_b.least(corners_b) >= 0;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    const std::array edge_a{a[i], a[next]};
    constexpr unsigned all = NearestBound::all_corners;
    if (!is_excluded(1u << i, all) && !boxes_apart(std::span(&a[i], 1), b, limit_))
      add({vertex(vertices_a, a, i), face(*b_, triangles.b, b), PairOrder::given, triangles,
           is_not_nearer(1u << i, all)});
    if (!is_excluded(all, 1u << i) && !boxes_apart(std::span(&b[i], 1), a, limit_))
      add({vertex(vertices_b, b, i), face(*a_, triangles.a, a), PairOrder::swapped, triangles,
           is_not_nearer(all, 1u << i)});
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t after = (k + 1) % 3;
      const unsigned corners_a = 1u << i | 1u << next, corners_b = 1u << k | 1u << after;
      const std::array edge_b{b[k], b[after]};
      if (!are_along_one_axis(edge_a, edge_b) && !is_excluded(corners_a, corners_b) &&
          !boxes_apart(edge_a, edge_b, limit_))
        add({edge(vertices_a, a, i), edge(vertices_b, b, k), PairOrder::given, triangles,
             is_not_nearer(corners_a, corners_b)});
    }
  }
}

void NearestPairSearch::add(const ElementCandidate& candidate) {
  Candidates& list = candidate.first.count == 1 ? vertices_and_faces_ : edges_;
  const ElementPoints elements = points_of(candidate.first, candidate.second);
  for (std::size_t i = 0; i < 4; ++i) list.block.set(i, list.count, elements.points[i]);
  list.candidates[list.count++] = candidate;
}

void NearestPairSearch::consider_all() {
  consider(vertices_and_faces_);
  consider(edges_);
}

/// Considers those that the kernel does not exclude. Many others have the nearest features again, which
/// several triangles share, or are as near and come later in the order of pairs.
void NearestPairSearch::consider(Candidates& list) {
  const bool are_edges = &list == &edges_;
  std::array<FeatureCode, PointsBlock::capacity> codes, codes_at_any_distance;
  classify(list.block, list.count, are_edges, limit_, codes.data());
  const bool needs_features = best_ && std::find(codes.begin(), codes.begin() + list.count,
                                                 FeatureCode::unknown) != codes.begin() + list.count;
  if (needs_features) classify(list.block, list.count, are_edges, any_distance, codes_at_any_distance.data());
  for (std::size_t i = 0; i < list.count; ++i) {
    if (codes[i] == FeatureCode::apart) continue;
    const ElementCandidate& candidate = list.candidates[i];
    const bool is_known = codes[i] != FeatureCode::unknown;
    const FeatureCode code = is_known || !needs_features ? codes[i] : codes_at_any_distance[i];
    if (best_ && code != FeatureCode::unknown) {
      const ClosestFeatures features = features_of_code(code, are_edges);
      // The vertices of edges are tested against faces, too.
      if (are_edges && features.kind != ClosestFeatures::Kind::interiors) continue;
      const PairName name = name_of_pair(candidate.first, candidate.second, features, candidate.order,
                                         ProximityListing::features);
      if (name == name_of(*best_) || (candidate.is_not_nearer && name_of(*best_) < name)) continue;
    }
    consider(candidate);
  }
  list.count = 0;
}

void NearestPairSearch::consider(const ElementCandidate& candidate) {
  const auto& [first, second, order, triangles, is_not_nearer] = candidate;
  const ElementPoints elements = points_of(first, second);
  if (farther_.find(elements) != nullptr) return;
  ++decided_elements_;
  const auto pair = proximity_pair_within(first, second, {a_->id, b_->id}, order, ProximityListing::features,
                                          limit_, used_exact_);
  if (!pair) return farther_.store(elements, true);
  if (best_) {
    const bool is_same = name_of(*pair) == name_of(*best_);
    const int side = is_same ? 0 : compare_distances(elements, best_elements_, used_exact_);
    if (side > 0) return farther_.store(elements, true);
    if (side == 0 && name_of(*best_) <= name_of(*pair)) return;
  }
  best_ = pair;
  best_elements_ = elements;
  triangles_ = triangles;
  if (pair->distance > 0) bound_.set(*a_, *b_, *best_, triangles);
  set_limit(std::min(limit_, pair->distance * (1 + 0x1p-36) + 0x1p-1060));
}

}  // namespace supple
