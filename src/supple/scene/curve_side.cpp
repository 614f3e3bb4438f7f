#include "scene/curve_side.hpp"

#include <algorithm>
#include <cmath>

#include "core/sort_once.hpp"
#include "geometry/vector.hpp"

namespace supple {

void CurveSide::clear() {
  triangles_.clear();
  corners_.clear();
  crossings_.clear();
  behind_ = {};
}

std::span<const std::uint32_t> CurveSide::enclose(const SurfaceView& surface, const Direction& direction,
                                                  std::size_t most_behind) {
  if (!color_corners() || !start_flood(surface)) return {};
  std::optional<std::size_t> behind = color_behind(surface, direction);
  const std::vector<std::uint32_t>* const smaller = flood(surface, behind, most_behind);
  if (smaller == nullptr) return {};
  behind_ = behind ? flooded_[*behind] : *smaller;
  return *smaller;
}

bool CurveSide::is_cut(std::uint32_t v, std::uint32_t w) const {
  return std::binary_search(cut_edges_.begin(), cut_edges_.end(), std::array{std::min(v, w), std::max(v, w)});
}

/// Gives corners on the same side of the curve the same colour. False when that is impossible or the curve
/// crosses no edge.
bool CurveSide::color_corners() {
  sort_once(crossings_);
  sort_once(corners_);
  cut_edges_.clear();
  for (std::size_t begin = 0, end = 0; begin < crossings_.size(); begin = end) {
    const auto [v, w, key] = crossings_[begin];
    while (end < crossings_.size() && crossings_[end][0] == v && crossings_[end][1] == w) ++end;
    if ((end - begin) % 2 != 0) cut_edges_.push_back({v, w});
  }
  if (cut_edges_.empty()) return false;
  colors_.start(corners_.size());
  const auto corner = [&](std::uint32_t vertex) {
    return static_cast<std::uint32_t>(std::lower_bound(corners_.begin(), corners_.end(), vertex) -
                                      corners_.begin());
  };
  for (const Triangle& triangle : triangles_) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = triangle[k], w = triangle[(k + 1) % 3];
      if (v != w && !colors_.join(corner(v), corner(w), is_cut(v, w))) return false;
    }
  }
  return true;
}

/// The colour of the corners that are behind. Nothing when there is no direction, or hardly a difference.
std::optional<std::size_t> CurveSide::color_behind(const SurfaceView& surface, const Direction& direction) {
  std::array<double, 2> sums{}, counts{};
  double extent = 0;
  for (std::uint32_t c = 0; c < corners_.size(); ++c) {
    const std::size_t color = colors_.find(c).is_opposite ? 1 : 0;
    const Vec3d way = direction.scale * surface.position(corners_[c]) - direction.from;
    sums[color] += dot(direction.towards_behind, way);
    counts[color] += 1;
    extent = std::max(extent, largest_magnitude(way));
  }
  if (counts[0] == 0 || counts[1] == 0) return {};
  const double difference = sums[0] / counts[0] - sums[1] / counts[1];
  if (!(std::fabs(difference) > 0x1p-7 * extent)) return {};
  return difference > 0 ? 0 : 1;
}

/// Marks the corners by their colours. False when the curve has several pieces on this surface.
bool CurveSide::start_flood(const SurfaceView& surface) {
  marks_.resize(std::max(marks_.size(), surface.around->vertex_count()), 0);
  constexpr std::uint32_t almost_all = 0xfffffff0;
  if (last_mark_ > almost_all) {
    std::fill(marks_.begin(), marks_.end(), 0);
    last_mark_ = 0;
  }
  last_mark_ += 2;
  for (auto& flooded : flooded_) flooded.clear();
  for (std::uint32_t c = 0; c < corners_.size(); ++c) {
    const ParitySets::Place place = colors_.find(c);
    if (place.root != 0) return false;
    const std::size_t color = place.is_opposite ? 1 : 0;
    marks_[corners_[c]] = mark_of(color);
    flooded_[color].push_back(corners_[c]);
  }
  return true;
}

/// Floods both sides of the curve in turns, without crossing it, until one of them is complete, and then the
/// one that is behind; `behind` loses its value when that side has more than `most_behind` vertices and is
/// not the smaller one. Returns the smaller side; null when they are the same side.
const std::vector<std::uint32_t>* CurveSide::flood(const SurfaceView& surface,
                                                   std::optional<std::size_t>& behind,
                                                   std::size_t most_behind) {
  const std::vector<std::uint32_t>* smaller = nullptr;
  for (std::size_t next = 0;; ++next) {
    for (std::size_t color = 0; color < 2; ++color) {
      if (smaller == nullptr && next == flooded_[color].size()) {
        smaller = &flooded_[color];
        // When both are equal, the one behind counts as the smaller one.
        if (behind && flooded_[*behind].size() == next) smaller = &flooded_[*behind];
      }
      if (smaller != nullptr && behind && smaller != &flooded_[*behind] &&
          flooded_[*behind].size() > most_behind)
        behind.reset();
      if (smaller != nullptr && (!behind || next >= flooded_[*behind].size())) return smaller;
      if (next >= flooded_[color].size()) continue;
      const std::uint32_t v = flooded_[color][next];
      for (const std::uint32_t t : surface.around->around(v)) {
        for (const std::uint32_t w : surface.triangle(t)) {
          if (marks_[w] == mark_of(color)) continue;
          const bool is_other = marks_[w] == mark_of(1 - color);
          if (is_other) {
            if (is_cut(v, w)) continue;
            return nullptr;
          }
          marks_[w] = mark_of(color);
          flooded_[color].push_back(w);
        }
      }
    }
  }
}

}  // namespace supple
