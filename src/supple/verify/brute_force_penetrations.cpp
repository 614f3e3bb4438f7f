#include "verify/brute_force_penetrations.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "geometry/vector.hpp"
#include "mesh/vertex_sets.hpp"

namespace supple {
namespace {

/// The connected parts with all vertices inside and no triangle that touches.
std::vector<ContainedPart> contained_parts(const PlainObject& inner, std::span<const std::uint32_t> touching,
                                           std::span<const ExactPenetration> found) {
  VertexSets sets(inner.positions.size());
  std::vector<std::uint8_t> is_used(inner.positions.size(), 0), is_excluded = is_used, is_inside = is_used;
  const auto is_finite_triangle = [&](const Triangle& triangle) {
    return std::all_of(triangle.begin(), triangle.end(),
                       [&](std::uint32_t v) { return is_finite(inner.positions[v]); });
  };
  for (const Triangle& triangle : inner.triangles) {
    if (!is_finite_triangle(triangle)) continue;
    for (const std::uint32_t v : triangle) {
      is_used[v] = 1;
      sets.join(triangle[0], v);
    }
  }
  for (const ExactPenetration& p : found) is_inside[p.vertex] = p.where == Containment::inside ? 1 : 0;
  for (const std::uint32_t t : touching) is_excluded[sets.root(inner.triangles[t][0])] = 1;
  std::vector<ContainedPart> parts(inner.positions.size());
  std::size_t part_count = 0;
  for (std::uint32_t v = 0; v < inner.positions.size(); ++v) {
    if (is_used[v] == 0) continue;
    const std::uint32_t root = sets.root(v);
    if (root == v) ++part_count;
    parts[root].vertex = root;
    ++parts[root].vertex_count;
    if (is_inside[v] == 0) is_excluded[root] = 1;
  }
  std::erase_if(parts, [&](const ContainedPart& part) {
    return part.vertex_count == 0 || is_excluded[part.vertex] != 0;
  });
  for (ContainedPart& part : parts) part.is_whole = parts.size() == part_count;
  return parts;
}

}  // namespace

BruteForcePenetrations find_penetrations_by_brute_force(const PlainObject& inner, const PlainObject& outer,
                                                        std::span<const std::uint32_t> touching,
                                                        const Parallel& parallel) {
  BruteForcePenetrations result;
  std::vector<std::uint8_t> is_used(inner.positions.size(), 0);
  for (const Triangle& triangle : inner.triangles) {
    const bool is_inert = std::any_of(triangle.begin(), triangle.end(),
                                      [&](std::uint32_t v) { return !is_finite(inner.positions[v]); });
    for (const std::uint32_t v : triangle) is_used[v] |= is_inert ? 0 : 1;
  }
  const PlainSurface surface(outer);
  std::vector<std::vector<ExactPenetration>> found(parallel.worker_count());
  parallel.for_ranges(inner.positions.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t w) {
    std::size_t guess = 0;
    for (std::size_t v = begin; v < end; ++v) {
      if (is_used[v] == 0) continue;
      const Vec3d& p = inner.positions[v];
      ExactPenetration penetration{static_cast<std::uint32_t>(v), surface.containment(p), 0, {}};
      if (penetration.where == Containment::outside) continue;
      if (penetration.where == Containment::inside) {
        PlainSurface::Nearest nearest = surface.nearest(p, guess);
        guess = nearest.place;
        penetration.triangle = nearest.triangle;
        penetration.squared_depth = std::move(nearest.squared);
      }
      found[w].push_back(penetration);
    }
  });
  for (auto& part : found) std::move(part.begin(), part.end(), std::back_inserter(result.vertices));
  std::sort(result.vertices.begin(), result.vertices.end(),
            [](const auto& p, const auto& q) { return p.vertex < q.vertex; });
  result.parts = contained_parts(inner, touching, result.vertices);
  result.pairs_checked = inner.positions.size() * surface.triangles.size();
  return result;
}

void compare_penetrations(const ObjectPair& pair, std::span<const Penetration> inside,
                          std::span<const std::uint32_t> on_surface, std::span<const ContainedPart> parts,
                          const BruteForcePenetrations& truth,
                          std::vector<PenetrationDifference>& differences) {
  using Fault = PenetrationDifference::Fault;
  const auto note = [&](std::uint32_t vertex, Fault fault) {
    differences.push_back({pair.a, pair.b, vertex, fault});
  };
  auto next_inside = inside.begin();
  auto next_on = on_surface.begin();
  for (const ExactPenetration& expected : truth.vertices) {
    for (; next_inside != inside.end() && next_inside->vertex < expected.vertex; ++next_inside)
      note(next_inside->vertex, Fault::added);
    for (; next_on != on_surface.end() && *next_on < expected.vertex; ++next_on) note(*next_on, Fault::added);
    const bool is_inside = next_inside != inside.end() && next_inside->vertex == expected.vertex;
    const bool is_on = next_on != on_surface.end() && *next_on == expected.vertex;
    const bool is_right_list =
        expected.where == Containment::inside ? is_inside && !is_on : is_on && !is_inside;
    if (!is_right_list)
      note(expected.vertex, Fault::missed);
    else if (is_inside && (next_inside->triangle != expected.triangle ||
                           !is_within_units(next_inside->depth, expected.squared_depth, 4)))
      note(expected.vertex, Fault::inexact);
    if (is_inside) ++next_inside;
    if (is_on) ++next_on;
  }
  for (; next_inside != inside.end(); ++next_inside) note(next_inside->vertex, Fault::added);
  for (; next_on != on_surface.end(); ++next_on) note(*next_on, Fault::added);

  const auto is_same_part = [](const ContainedPart& p, const ContainedPart& q) {
    return p.vertex == q.vertex && p.vertex_count == q.vertex_count && p.is_whole == q.is_whole;
  };
  const auto note_parts = [&](std::span<const ContainedPart> from, std::span<const ContainedPart> without,
                              Fault fault) {
    for (const ContainedPart& part : from) {
      const bool is_known = std::any_of(without.begin(), without.end(), [&](const ContainedPart& other) {
        return is_same_part(part, other);
      });
      if (!is_known) note(part.vertex, fault);
    }
  };
  note_parts(truth.parts, parts, Fault::missed);
  note_parts(parts, truth.parts, Fault::added);
}

}  // namespace supple
