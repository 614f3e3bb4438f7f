#include "octree/morton_curve.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "octree/octree_topology.hpp"

namespace supple {
namespace {

/// Puts two zero bits between each of the low 21 bits.
std::uint64_t spread_bits(std::uint64_t v) {
  v = (v | v << 32) & 0x001f00000000ffffu;
  v = (v | v << 16) & 0x001f0000ff0000ffu;
  v = (v | v << 8) & 0x100f00f00f00f00fu;
  v = (v | v << 4) & 0x10c30c30c30c30c3u;
  return (v | v << 2) & 0x1249249249249249u;
}

std::uint64_t cell(double fraction) {
  constexpr double cells = 1 << curve_bits_per_axis;
  return static_cast<std::uint64_t>(std::clamp(fraction * cells, 0.0, cells - 1));
}

}  // namespace

void sort_by_code(std::span<CurvePlace> places, std::vector<CurvePlace>& memory) {
  constexpr std::size_t few = 256;
  if (places.size() < few) {
    std::ranges::sort(places, {}, [](const CurvePlace& p) { return std::pair(p.code, p.triangle); });
    return;
  }
  constexpr int bits = 9, digits = 3 * curve_bits_per_axis / bits;
  const auto digit_of = [](const CurvePlace& place, int i) {
    return static_cast<std::size_t>(place.code >> (bits * i)) % (std::size_t{1} << bits);
  };
  std::array<std::array<std::uint32_t, 1 << bits>, digits> begins{};
  for (const CurvePlace& place : places) {
    for (int i = 0; i < digits; ++i) ++begins[i][digit_of(place, i)];
  }
  memory.resize(places.size());
  std::span<CurvePlace> from = places, to = memory;
  for (int i = 0; i < digits; ++i) {
    auto& begin = begins[i];
    if (begin[digit_of(from[0], i)] == from.size()) continue;
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), 0u);
    for (const CurvePlace& place : from) to[begin[digit_of(place, i)]++] = place;
    std::swap(from, to);
  }
  if (from.data() != places.data()) std::ranges::copy(from, places.begin());
}

void sort_along_curve(std::span<CurvePlace> places, std::span<const Vec3d> centers,
                      std::vector<CurvePlace>& memory) {
  CenterBounds bounds;
  for (const CurvePlace& place : places) bounds.add(centers[place.triangle]);
  const double side = bounds.longest_side();
  for (CurvePlace& place : places) {
    const Vec3d& c = centers[place.triangle];
    place.code = 0;
    if (!(side > 0) || !is_finite(c)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      place.code |= spread_bits(cell((c[axis] * CenterBounds::scale - bounds.lower[axis]) / side)) << axis;
    }
  }
  sort_by_code(places, memory);
}

}  // namespace supple
