#include "motion/plastic_flow.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "geometry/vector.hpp"

namespace supple {
namespace {

constexpr std::size_t springs_at_a_time = 2048;

/// Heron's formula in Kahan's order, which is accurate for needle-shaped triangles.
double area_of_sides(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (b < c) std::swap(b, c);
  if (a < b) std::swap(a, b);
  const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return product > 0 ? 0.25 * std::sqrt(product) : 0;
}

}  // namespace

bool flow(std::span<SpringElement> springs, double yield_strain, double rate, double seconds,
          std::span<const Vec3d> positions, const Parallel& parallel) {
  // Backward Euler of ds/dt = rate (yielded - s).
  const double part = rate * seconds / (1 + rate * seconds);
  std::atomic<bool> any = false;
  parallel.for_ranges(
      springs.size(), springs_at_a_time, [&](std::size_t begin, std::size_t end, std::uint32_t) {
        bool changed = false;
        for (SpringElement& spring : springs.subspan(begin, end - begin)) {
          const double length = norm(positions[spring.b] - positions[spring.a]);
          const double longest = length / (1 + yield_strain);
          const double shortest = yield_strain < 1 ? length / (1 - yield_strain) : spring.rest_length;
          const double yielded = std::clamp(spring.rest_length, longest, std::max(longest, shortest));
          if (yielded == spring.rest_length) continue;
          spring.rest_length += part * (yielded - spring.rest_length);
          changed = true;
        }
        if (changed) any.store(true, std::memory_order_relaxed);
      });
  return any.load();
}

std::vector<Triangle> sides_of_areas(std::span<const AreaElement> areas,
                                     std::span<const SpringElement> edges) {
  std::vector<std::uint32_t> order(edges.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto ends = [&](std::uint32_t i) { return edges[i].vertices(); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t p, std::uint32_t q) { return ends(p) < ends(q); });
  std::vector<Triangle> sides;
  sides.reserve(areas.size());
  for (const AreaElement& area : areas) {
    Triangle of_area{};
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t p = area.corners[corner], q = area.corners[(corner + 1) % 3];
      const std::array wanted{std::min(p, q), std::max(p, q)};
      of_area[corner] =
          *std::lower_bound(order.begin(), order.end(), wanted,
                            [&](std::uint32_t i, const auto& value) { return ends(i) < value; });
    }
    sides.push_back(of_area);
  }
  return sides;
}

void follow_rest_lengths(std::span<AreaElement> areas, std::span<const Triangle> sides,
                         std::span<const SpringElement> edges) {
  for (std::size_t i = 0; i < areas.size(); ++i) {
    areas[i].rest_area = area_of_sides(edges[sides[i][0]].rest_length, edges[sides[i][1]].rest_length,
                                       edges[sides[i][2]].rest_length);
  }
}

}  // namespace supple
