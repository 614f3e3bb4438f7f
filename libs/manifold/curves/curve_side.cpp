#include "manifold/curves/curve_side.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace supple {

void CurveSide::start(std::size_t vertex_count) {
  for (const std::uint32_t v : corners_) corner_of_[v] = none;
  corner_of_.resize(std::max(corner_of_.size(), vertex_count), none);
  marks_.resize(std::max(marks_.size(), vertex_count), 0);
  crossings_.clear();
  corners_.clear();
  triangles_.clear();
}

void CurveSide::add_triangle(const Triangle& triangle) {
  Triangle corners;
  for (std::size_t k = 0; k < 3; ++k) {
    std::uint32_t& corner = corner_of_[triangle[k]];
    if (corner == none) {
      // In this order, `start` finds all of them also after memory ran out.
      corners_.push_back(triangle[k]);
      corner = static_cast<std::uint32_t>(corners_.size() - 1);
    }
    corners[k] = corner;
  }
  triangles_.push_back(corners);
}

void CurveSide::add_crossing(std::uint32_t v, std::uint32_t w, std::uint32_t key) {
  const auto [corner, other] = std::minmax(corner_of_[v], corner_of_[w]);
  crossings_.push_back({corner, other, key});
}

std::span<const std::uint32_t> CurveSide::enclose(const SurfaceView& surface, std::uint32_t behind) {
  if (!list_cuts() || !color_corners() || !start_flood()) return {};
  const std::vector<std::uint32_t>* const smaller = flood(surface, behind);
  return smaller == nullptr ? std::span<const std::uint32_t>() : *smaller;
}

bool CurveSide::is_cut(std::uint32_t corner, std::uint32_t other) const {
  if (other < corner) std::swap(corner, other);
  const auto begin = cuts_.begin() + first_cut_[corner], end = cuts_.begin() + first_cut_[corner + 1];
  return std::find(begin, end, other) != end;
}

/// Lists the edges that the curve crosses an odd number of times. False when there are none.
bool CurveSide::list_cuts() {
  first_crossing_.assign(corners_.size() + 2, 0);
  for (const Crossing& crossing : crossings_) ++first_crossing_[crossing.corner + 2];
  std::partial_sum(first_crossing_.begin(), first_crossing_.end(), first_crossing_.begin());
  sorted_.resize(crossings_.size());
  for (const Crossing& crossing : crossings_) sorted_[first_crossing_[crossing.corner + 1]++] = crossing;
  cuts_.clear();
  first_cut_.assign(1, 0);
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    const auto begin = sorted_.begin() + first_crossing_[c], last = sorted_.begin() + first_crossing_[c + 1];
    std::sort(begin, last);
    const auto end = std::unique(begin, last);
    for (auto first = begin, next = begin; first != end; first = next) {
      next =
          std::find_if(first, end, [&](const Crossing& crossing) { return crossing.other != first->other; });
      if ((next - first) % 2 != 0) cuts_.push_back(first->other);
    }
    first_cut_.push_back(static_cast<std::uint32_t>(cuts_.size()));
  }
  return !cuts_.empty();
}

/// Gives corners on the same side of the curve the same colour. False when that is impossible.
bool CurveSide::color_corners() {
  colors_.start(corners_.size());
  for (const Triangle& triangle : triangles_) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t c = triangle[k], d = triangle[(k + 1) % 3];
      if (c != d && !colors_.join(c, d, is_cut(c, d))) return false;
    }
  }
  const auto first = std::min_element(corners_.begin(), corners_.end()) - corners_.begin();
  is_opposite_to_first_ = colors_.find(static_cast<std::uint32_t>(first)).is_opposite;
  return true;
}

/// Marks the corners by their colours. False when the curve has several pieces on this surface.
bool CurveSide::start_flood() {
  last_mark_ += 2;
  for (auto& flooded : flooded_) flooded.clear();
  for (std::uint32_t c = 0; c < corners_.size(); ++c) {
    if (colors_.find(c).root != 0) return false;
    const std::size_t color = color_of(c);
    marks_[corners_[c]] = mark_of(color);
    flooded_[color].push_back(corners_[c]);
  }
  return true;
}

/// Floods both sides of the curve in turns, without crossing it, until one of them is complete. Returns this
/// side; null when they are the same side.
const std::vector<std::uint32_t>* CurveSide::flood(const SurfaceView& surface, std::uint32_t behind) {
  for (std::size_t next = 0;; ++next) {
    for (std::size_t color = 0; color < 2; ++color) {
      if (next == flooded_[color].size()) {
        const bool are_equal = flooded_[1 - color].size() == next;
        return &flooded_[are_equal && behind != none && marks_[behind] == mark_of(1 - color) ? 1 - color
                                                                                             : color];
      }
      const std::uint32_t v = flooded_[color][next];
      for (const std::uint32_t t : surface.around->around(v)) {
        for (const std::uint32_t w : surface.triangle(t)) {
          if (marks_[w] == mark_of(color)) continue;
          const bool is_other = marks_[w] == mark_of(1 - color);
          if (is_other) {
            const std::uint32_t c = corner_of_[v], d = corner_of_[w];
            if (c == none || d == none || !is_cut(c, d)) return nullptr;
            continue;
          }
          marks_[w] = mark_of(color);
          flooded_[color].push_back(w);
        }
      }
    }
  }
}

}  // namespace supple
