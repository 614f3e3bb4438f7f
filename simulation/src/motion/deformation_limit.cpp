#include "motion/deformation_limit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/vector.hpp"

namespace supple {
namespace {

constexpr std::size_t edges_at_a_time = 512;

struct Bounds {
  double shortest, longest;

  /// An edge with rest length 0 has no strain and no bounds.
  Bounds(const SpringElement& edge, double max_strain)
      : shortest(std::max(0.0, 1 - max_strain) * edge.rest_length),
        longest(edge.rest_length > 0 ? (1 + max_strain) * edge.rest_length
                                     : std::numeric_limits<double>::infinity()) {}

  bool have(double squared_length) const {
    return squared_length >= shortest * shortest && squared_length <= longest * longest;
  }
};

/// The change of d = x_b - x_a that gives d the length `wanted`. It is parallel to `before`, the edge in
/// x - h v, where possible.
Vec3d correction(Vec3d d, Vec3d before, double wanted) {
  const double squared_length = dot(d, d), length = std::sqrt(squared_length);
  const double squared_before = dot(before, before);
  if (squared_before > 0) {
    const Vec3d n = before * (1 / std::sqrt(squared_before));
    const double along = dot(d, n);
    const double discriminant = along * along - squared_length + wanted * wanted;
    if (std::abs(along) > 0.5 * length && discriminant >= 0) {
      const double root = std::copysign(std::sqrt(discriminant), along);
      return n * ((wanted * wanted - squared_length) / (along + root));
    }
  }
  return length > 0 ? d * ((wanted - length) / length) : Vec3d{};
}

/// Greedy edge colouring: each edge gets the first color that neither end uses yet.
std::vector<std::uint32_t> edge_colors(std::span<const SpringElement> edges, std::uint32_t vertex_count) {
  struct Colors {
    std::vector<bool> taken;
    std::uint32_t first_left = 0;

    bool has(std::uint32_t color) const { return color < taken.size() && taken[color]; }
    void take(std::uint32_t color) {
      if (taken.size() <= color) taken.resize(color + 1);
      taken[color] = true;
      while (has(first_left)) ++first_left;
    }
  };
  std::vector<Colors> at(vertex_count);
  std::vector<std::uint32_t> colors;
  colors.reserve(edges.size());
  for (const SpringElement& edge : edges) {
    std::uint32_t color = std::max(at[edge.a].first_left, at[edge.b].first_left);
    while (at[edge.a].has(color) || at[edge.b].has(color)) ++color;
    at[edge.a].take(color);
    at[edge.b].take(color);
    colors.push_back(color);
  }
  return colors;
}

}  // namespace

DeformationLimit::DeformationLimit(const SpringNetwork& network, std::span<const double> inverse_masses,
                                   double max_strain)
    : inverse_masses_(inverse_masses.begin(), inverse_masses.end()), max_strain_(max_strain) {
  const auto& edges = network.edges.elements;
  const std::vector<std::uint32_t> color_of = edge_colors(edges, network.vertex_count);
  const std::uint32_t colors = color_of.empty() ? 0 : 1 + *std::max_element(color_of.begin(), color_of.end());
  first_color_.assign(colors + 1, 0);
  for (const std::uint32_t color : color_of) ++first_color_[color + 1];
  for (std::uint32_t c = 0; c < colors; ++c) first_color_[c + 1] += first_color_[c];
  by_color_.resize(edges.size());
  std::vector<std::uint32_t> next(first_color_.begin(), first_color_.end() - 1);
  for (std::uint32_t i = 0; i < edges.size(); ++i) by_color_[next[color_of[i]]++] = i;
}

bool DeformationLimit::apply(std::span<const SpringElement> edges, double seconds, std::span<Vec3d> positions,
                             std::span<Vec3d> velocities, const Parallel& parallel) const {
  const auto is_within = [&](const SpringElement& edge) {
    const Bounds bounds(edge, max_strain_);
    const Vec3d d = positions[edge.b] - positions[edge.a];
    return bounds.have(dot(d, d)) || !can_move(edge);
  };
  if (parallel.all_of_ranges(edges.size(), edges_at_a_time, [&](std::size_t begin, std::size_t end) {
        return std::all_of(edges.begin() + begin, edges.begin() + end, is_within);
      })) {
    return false;
  }
  const auto one_color = [&](std::size_t color) {
    const std::uint32_t first = first_color_[color];
    return parallel.all_of_ranges(first_color_[color + 1] - first, edges_at_a_time,
                                  [&](std::size_t begin, std::size_t end) {
                                    bool all = true;
                                    for (std::size_t i = first + begin; i < first + end; ++i) {
                                      const SpringElement& edge = edges[by_color_[i]];
                                      if (!is_within(edge) && !correct(edge, seconds, positions, velocities))
                                        all = false;
                                    }
                                    return all;
                                  });
  };
  for (int round = 0; round < max_rounds; ++round) {
    bool all = true;
    for (std::size_t color = 0; color + 1 < first_color_.size(); ++color) {
      if (!one_color(color)) all = false;
    }
    if (all) break;
  }
  return true;
}

/// Returns true when the edge was already within the tolerance.
bool DeformationLimit::correct(const SpringElement& edge, double seconds, std::span<Vec3d> positions,
                               std::span<Vec3d> velocities) const {
  const double weight_a = inverse_masses_[edge.a], weight_b = inverse_masses_[edge.b];
  const Vec3d d = positions[edge.b] - positions[edge.a];
  const double length = norm(d);
  const Bounds bounds(edge, max_strain_);
  const double wanted = std::clamp(length, bounds.shortest, bounds.longest);
  const Vec3d before = d - (velocities[edge.b] - velocities[edge.a]) * seconds;
  const Vec3d change = correction(d, before, wanted);
  const Vec3d of_a = change * (-weight_a / (weight_a + weight_b));
  const Vec3d of_b = change * (weight_b / (weight_a + weight_b));
  positions[edge.a] = positions[edge.a] + of_a;
  positions[edge.b] = positions[edge.b] + of_b;
  velocities[edge.a] = velocities[edge.a] + of_a * (1 / seconds);
  velocities[edge.b] = velocities[edge.b] + of_b * (1 / seconds);
  return !(std::abs(length - wanted) > tolerance * edge.rest_length);
}

}  // namespace supple
