#include "motion/network/closed_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "motion/network/mesh_pieces.hpp"

namespace supple {
namespace {

/// Indexed by the lowest vertex of each component: 1 when each edge occurs equally often in both directions.
std::vector<std::uint8_t> closed_pieces(const TriangleMesh& mesh, std::span<const std::uint32_t> piece) {
  struct Side {
    std::array<std::uint32_t, 2> ends;
    std::int32_t direction;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  std::vector<std::uint8_t> is_closed(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    if (spans_nothing(t)) continue;
    is_closed[piece[t[0]]] = 1;
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t p = t[corner], q = t[(corner + 1) % 3];
      sides.push_back({{std::min(p, q), std::max(p, q)}, p < q ? 1 : -1});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.ends < b.ends; });
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    std::int32_t sum = 0;
    while (end < sides.size() && sides[end].ends == sides[begin].ends) sum += sides[end++].direction;
    if (sum != 0) is_closed[piece[sides[begin].ends[0]]] = 0;
  }
  return is_closed;
}

double inverse_scale(std::span<const VolumeElement> elements, double volume,
                     std::span<const Vec3d> positions) {
  double area = 0;
  for (const VolumeElement& e : elements) {
    area += norm(area_vector(positions[e.corners[0]], positions[e.corners[1]], positions[e.corners[2]]));
  }
  constexpr double six_roots_of_pi = 10.634723105433096;
  const double sphere = area * std::sqrt(area) / six_roots_of_pi, inverse = 1 / std::abs(volume);
  return std::abs(volume) > 1e-6 * sphere && std::isfinite(inverse) ? inverse : 0;
}

}  // namespace

double volume_of(std::span<const VolumeElement> elements, Vec3d origin, std::span<const Vec3d> positions) {
  double sum = 0;
  for (const VolumeElement& element : elements) {
    const Vec3d p = positions[element.corners[0]];
    sum += dot(p - origin, area_vector(p, positions[element.corners[1]], positions[element.corners[2]]));
  }
  return sum / 3;
}

ClosedParts closed_parts(const TriangleMesh& rest) {
  const std::vector<std::uint32_t> piece = lowest_of_piece(rest);
  const std::vector<std::uint8_t> is_closed = closed_pieces(rest, piece);
  std::vector<VolumeElement> candidates;
  for (const Triangle& t : rest.triangles) {
    if (!spans_nothing(t) && is_closed[piece[t[0]]] != 0) candidates.push_back({t, piece[t[0]]});
  }
  std::vector<std::uint32_t> order(candidates.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return candidates[a].part != candidates[b].part ? candidates[a].part < candidates[b].part : a < b;
  });

  ClosedParts closed;
  closed.elements.reserve(candidates.size());
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    const std::size_t first = closed.elements.size();
    const std::uint32_t origin = candidates[order[begin]].part;
    const auto number = static_cast<std::uint32_t>(closed.parts.size());
    while (end < order.size() && candidates[order[end]].part == origin)
      closed.elements.push_back({candidates[order[end++]].corners, number});
    const auto elements = std::span(closed.elements).subspan(first);
    const double volume = volume_of(elements, rest.positions[origin], rest.positions);
    if (std::isfinite(volume)) {
      closed.parts.push_back({origin, volume, inverse_scale(elements, volume, rest.positions)});
    } else {
      closed.elements.resize(first);
      ++closed.left_out;
    }
  }
  return closed;
}

}  // namespace supple
