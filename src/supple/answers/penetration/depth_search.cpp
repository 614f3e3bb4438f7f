#include "answers/penetration/depth_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>
#include <utility>

#include "contact/intersection/triangle_bounds.hpp"
#include "core/float_rounding.hpp"
#include "narrow_phase/query_kernels.hpp"

namespace supple {

void ClosestPoints::compute(std::span<const FoundTriangle> found, std::span<ElementDistance> results) {
  using Kind = ClosestFeatures::Kind;
  constexpr std::array kinds{std::pair(Kind::vertices, FeaturePair::vertices),
                             std::pair(Kind::vertex_edge, FeaturePair::vertex_edge),
                             std::pair(Kind::interiors, FeaturePair::vertex_face)};
  for (const auto& [kind, pair] : kinds) {
    std::array<std::size_t, capacity> places;
    std::size_t count = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const ClosestFeatures& features = found[i].features;
      if (features.kind != kind) continue;
      const ElementPoints elements = found[i].elements();
      const std::array<std::uint8_t, 4> order =
          kind == Kind::interiors
              ? std::array<std::uint8_t, 4>{0, 1, 2, 3}
              : std::array<std::uint8_t, 4>{features.vertex, features.edge[0], features.edge[1], 3};
      for (std::size_t k = 0; k < order.size(); ++k) block_.set(k, count, elements.points[order[k]]);
      places[count++] = i;
    }
    if (count > 0) compute_distance_numbers(block_, count, pair, numbers_);
    for (std::size_t k = 0; k < count; ++k) {
      const FoundTriangle& of_pair = found[places[k]];
      bool used_exact = false;
      results[places[k]] = numbers_.is_valid[k] != 0
                               ? distance_of(of_pair.elements(), of_pair.features, numbers_.at(k))
                               : distance_of(of_pair.elements(), of_pair.features, used_exact);
    }
  }
}

void DepthSearch::start() {
  recent_.clear();
  nearest_ = none;
}

const FoundTriangle* DepthSearch::find(const QueriedObject& object, const Vec3d& point) {
  object_ = &object;
  point_ = point;
  candidates_.clear();
  is_bounded_ = has_found_ = used_exact_ = false;
  set_limit(std::numeric_limits<double>::infinity());
  if (nearest_ != none) consider(nearest_, 1);
  const PointBounds seen = seen_by(object, point);
  descent_.run(
      object.view,
      [&](std::uint32_t node, std::array<double, node_width>& bounds) {
        std::array<float, node_width> squares;
        squared_distances(seen, object.view.boxes[node], squares);
        std::copy(squares.begin(), squares.end(), bounds.begin());
      },
      [&] { return double{squared_limit_}; },
      [&](std::uint32_t leaf, std::uint32_t begin, std::uint32_t end) {
        for (; begin < end; begin += leaf_block) {
          const LeafBoxes& boxes =
              recent_.boxes_of(0, object.leaves(), leaf, begin, std::min(begin + leaf_block, end));
          consider(begin, near_triangles(seen, boxes, squared_limit_));
        }
      });
  decide();
  if (!has_found_) return nullptr;
  nearest_ = found_.triangle;
  return &found_;
}

void DepthSearch::set_limit(double limit) {
  limit_ = limit;
  squared_limit_ = round_up(limit * limit * (1 + 0x1p-18) + 0x1p-120);
}

/// Keeps those of a block of triangles that may be the nearest.
void DepthSearch::consider(std::uint32_t begin, std::uint64_t triangles) {
  std::array<TrianglePair, leaf_block> list;
  std::array<double, leaf_block> lower, upper;
  std::size_t count = 0;
  for (std::uint64_t left = triangles; left != 0; left &= left - 1)
    list[count++] = {begin + static_cast<std::uint32_t>(std::countr_zero(left)), 0};
  if (count == 0) return;
  bound_distances(point_, {object_->view.arrays, object_->view.translation}, std::span(list).first(count),
                  lower.data(), upper.data());
  const auto least = std::min_element(upper.begin(), upper.begin() + static_cast<std::ptrdiff_t>(count));
  if (*least < limit_) {
    nearest_ = list[static_cast<std::size_t>(least - upper.begin())].a;
    is_bounded_ = true;
    set_limit(*least);
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (lower[i] <= limit_) candidates_.push_back({lower[i], list[i].a});
  }
}

/// Several triangles are the nearest where they share an edge or a vertex.
void DepthSearch::decide() {
  std::erase_if(candidates_, [&](const Candidate& candidate) { return candidate.lower > limit_; });
  std::array<FeatureCode, PointsBlock::capacity> codes;
  for (std::size_t first = 0; first < candidates_.size(); first += codes.size()) {
    const auto part = std::span(candidates_).subspan(first);
    const std::size_t count = std::min(part.size(), codes.size());
    for (std::size_t i = 0; i < count; ++i) {
      const TrianglePoints corners = object_->corners(part[i].triangle);
      block_.set(0, i, point_);
      for (std::size_t k = 0; k < 3; ++k) block_.set(k + 1, i, corners[k]);
    }
    classify(block_, count, false, limit_, codes.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (codes[i] != FeatureCode::apart) decide(part[i], codes[i]);
    }
  }
}

void DepthSearch::decide(const Candidate& candidate, FeatureCode code) {
  if (candidate.lower > limit_ || (has_found_ && found_.triangle == candidate.triangle)) return;
  const std::uint32_t t = candidate.triangle;
  FoundTriangle other{point_, object_->corners(t), {}, t, object_->triangle_ids[t]};
  const auto features = code == FeatureCode::unknown
                            ? closest_features_within(other.elements(), limit_, used_exact_)
                            : std::optional(features_of_code(code, false));
  if (!features) return;
  other.features = *features;
  const FeatureName feature = name_of(features_of_elements(*features, 1)[1], object_->triangles[t], other.id);
  if (has_found_) {
    const int side =
        feature_ == feature ? 0 : compare_distances(other.elements(), found_.elements(), used_exact_);
    if (side > 0 || (side == 0 && found_.id < other.id)) return;
  }
  has_found_ = true;
  found_ = other;
  feature_ = feature;
  if (is_bounded_) return;
  // No triangle has a bound.
  const double distance = distance_of(other.elements(), other.features, used_exact_).distance;
  set_limit(distance * (1 + 0x1p-36) + 0x1p-1060);
}

}  // namespace supple
