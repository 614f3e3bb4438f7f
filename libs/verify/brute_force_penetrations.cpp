#include "verify/brute_force.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/sort_once.hpp"
#include "geometry/exact_predicates.hpp"
#include "geometry/vector.hpp"
#include "mesh/vertex_sets.hpp"
#include "queries/feature_name.hpp"

namespace supple {
namespace {

/// The connected parts of `triangles` with all vertices inside and no triangle that touches. `is_used` marks
/// their vertices.
std::vector<ContainedPart> contained_parts(const PlainObject& inner, std::span<const Triangle> triangles,
                                           const std::vector<std::uint8_t>& is_used,
                                           std::span<const std::uint32_t> touching,
                                           std::span<const ExactPenetration> found) {
  VertexSets sets(inner.end.size());
  std::vector<std::uint8_t> is_excluded(inner.end.size(), 0), is_inside = is_excluded;
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t v : triangle) sets.join(triangle[0], v);
  }
  for (const ExactPenetration& p : found) is_inside[p.vertex] = p.where == Containment::inside ? 1 : 0;
  for (const std::uint32_t t : touching) is_excluded[sets.root(inner.triangles[t][0])] = 1;
  std::vector<ContainedPart> parts(inner.end.size());
  std::size_t part_count = 0;
  for (std::uint32_t v = 0; v < inner.end.size(); ++v) {
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
  std::vector<std::uint8_t> is_used(inner.end.size(), 0);
  std::vector<Triangle> triangles(inner.faces().begin(), inner.faces().end());
  std::erase_if(triangles, [&](const Triangle& triangle) {
    return std::ranges::any_of(triangle, [&](std::uint32_t v) { return !is_finite(inner.end[v]); });
  });
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t v : triangle) is_used[v] = 1;
  }
  const PlainSurface surface(outer);
  std::vector<std::optional<ExactPenetration>> found(inner.end.size());
  parallel.for_ranges(inner.end.size(), 64, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    std::size_t guess = 0;
    for (std::size_t v = begin; v < end; ++v) {
      if (is_used[v] == 0) continue;
      const Vec3d& p = inner.end[v];
      ExactPenetration penetration{static_cast<std::uint32_t>(v), surface.containment(p), 0, {}};
      if (penetration.where == Containment::outside) continue;
      if (penetration.where == Containment::inside) {
        PlainSurface::Nearest nearest = surface.nearest(p, guess);
        guess = nearest.place;
        penetration.triangle = nearest.triangle;
        penetration.squared_depth = std::move(nearest.squared);
      }
      found[v] = std::move(penetration);
    }
  });
  for (auto& penetration : found) {
    if (penetration) result.vertices.push_back(*std::move(penetration));
  }
  result.parts = contained_parts(inner, triangles, is_used, touching, result.vertices);
  result.pairs_checked = inner.end.size() * surface.triangles.size();
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
                           !is_accurate(next_inside->depth, expected.squared_depth)))
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

namespace {

using VertexPair = std::array<std::uint32_t, 2>;
constexpr std::uint32_t no_curve = ~std::uint32_t{0}, several_curves = no_curve - 1;

/// For each vertex inside the other object the number of the only curve around it and those that edges
/// without contacts connect to it, or `no_curve` or `several_curves`.
std::vector<std::uint32_t> curves_around(const CurveSideTruth& truth, std::size_t side,
                                         std::span<const IntersectionCurve> curves,
                                         const DetectResult& result) {
  const PlainObject& object = *truth.object;
  std::vector<std::pair<VertexPair, std::uint32_t>> crossed;  // edges, or vertices as {v, v}, and curves
  for (std::uint32_t c = 0; c < curves.size(); ++c) {
    for (const std::uint32_t i : result.contacts_of(curves[c])) {
      const Contact& contact = result.contacts[i];
      const std::uint32_t t = side == 0 ? contact.triangle_a : contact.triangle_b;
      const auto& [v, w, x] = object.triangles[t];
      for (const ContactPoint& point : result.points_of(contact)) {
        const FeatureName name = name_of(side == 0 ? point.on_a : point.on_b, {v, w, x}, t);
        if (name.kind != FeatureKind::face) crossed.push_back({{name.first, name.last}, c});
      }
      // The contacts of a triangle without area do not name all of its features.
      bool used_exact = false;
      if (find_projection(object.end[v], object.end[w], object.end[x], used_exact)) continue;
      for (const auto& [p, q] : {VertexPair{v, w}, VertexPair{w, x}, VertexPair{v, x}})
        crossed.push_back({{std::min(p, q), std::max(p, q)}, c});
    }
  }
  sort_once(crossed);
  const auto crossings_of = [&](std::uint32_t v, std::uint32_t w) {
    return std::ranges::equal_range(crossed, VertexPair{std::min(v, w), std::max(v, w)}, {},
                                    [](const auto& crossing) { return crossing.first; });
  };
  std::vector<std::uint8_t> is_inside(object.end.size());
  for (const ExactPenetration& p : truth.inside) is_inside[p.vertex] = 1;
  VertexSets sets(object.end.size());
  const auto for_each_edge = [&](const auto& visit) {
    for (const Triangle& triangle : object.faces()) {
      for (const auto& [i, k] : {VertexPair{0, 1}, VertexPair{1, 0}, VertexPair{1, 2}, VertexPair{2, 1},
                                 VertexPair{2, 0}, VertexPair{0, 2}}) {
        if (is_inside[triangle[i]] != 0) visit(triangle[i], triangle[k]);
      }
    }
  };
  for_each_edge([&](std::uint32_t v, std::uint32_t w) {
    if (is_inside[w] != 0 && crossings_of(v, w).empty()) sets.join(v, w);
  });
  std::vector<std::uint32_t> around(object.end.size(), no_curve);
  for_each_edge([&](std::uint32_t v, std::uint32_t w) {
    for (const auto& crossings : {crossings_of(v, w), crossings_of(w, w)}) {
      for (const auto& [edge, curve] : crossings) {
        std::uint32_t& found = around[sets.root(v)];
        found = found == no_curve || found == curve ? curve : several_curves;
      }
    }
  });
  for (const ExactPenetration& p : truth.inside) around[p.vertex] = around[sets.root(p.vertex)];
  return around;
}

}  // namespace

void verify_curves(const ObjectPair& pair, const std::array<CurveSideTruth, 2>& sides,
                   const DetectResult& result, std::vector<PenetrationDifference>& differences) {
  const auto found = std::ranges::equal_range(result.curves, pair, {}, [](const IntersectionCurve& curve) {
    return ObjectPair{curve.a, curve.b};
  });
  const std::span<const IntersectionCurve> curves(found.begin(), found.end());
  const auto note = [&](const ObjectPair& in_order, std::uint32_t vertex) {
    differences.push_back({in_order.a, in_order.b, vertex, PenetrationDifference::Fault::inexact});
  };
  for (const IntersectionCurve& curve : curves) {
    const Contact& first = result.contacts[result.contacts_of(curve).front()];
    if (!(std::fabs(norm(curve.normal) - 1) < 0x1p-40 && curve.depth >= 0))
      note(pair, sides[0].object->triangles[first.triangle_a][0]);
  }
  for (std::size_t side = 0; side < 2 && !curves.empty(); ++side) {
    if (sides[side].inside.empty()) continue;
    const std::vector<std::uint32_t> around = curves_around(sides[side], side, curves, result);
    const std::vector<PlainSurface> outer(1, PlainSurface(*sides[1 - side].object));
    std::vector<std::size_t> counts(curves.size()), numbers(curves.size());
    for (const ExactPenetration& p : sides[side].inside) {
      if (around[p.vertex] < curves.size()) ++counts[around[p.vertex]];
    }
    for (const ExactPenetration& p : sides[side].inside) {
      const std::uint32_t c = around[p.vertex];
      if (c >= curves.size() || numbers[c]++ % (counts[c] / 256 + 1) != 0) continue;
      const Vec3d& point = sides[side].object->end[p.vertex];
      const double longest = curves[c].depth * (1 + 0x1p-30) + 0x1p-40 * largest_magnitude(point);
      const std::vector<ExactHit> hits =
          hits_by_brute_force({point, side == 0 ? curves[c].normal : Vec3d{} - curves[c].normal}, outer);
      if (!hits.empty() && !std::isfinite(longest)) continue;
      if (hits.empty() || hits.front().t > Rational(longest))
        note(side == 0 ? pair : ObjectPair{pair.b, pair.a}, p.vertex);
    }
  }
}

void verify_manifolds(const ObjectPair& pair, const std::array<const PlainObject*, 2>& objects,
                      const DetectResult& result, VerifyReport& report) {
  const auto objects_of = [](const auto& record) { return ObjectPair{record.a, record.b}; };
  for (const Manifold& manifold : std::ranges::equal_range(result.manifolds, pair, {}, objects_of)) {
    std::vector<std::pair<double, Vec3d>> known;  // depths and points
    const bool is_curve = manifold.source == ManifoldSource::curve;
    Vec3d normal = manifold.normal;
    double depth = 0, deepest = 0, size = 0;
    if (is_curve) {
      const IntersectionCurve& curve = result.curves[manifold.record];
      normal = curve.normal;
      depth = curve.depth;
      for (const ContactSide side : {ContactSide::a, ContactSide::b}) {
        for (const std::uint32_t v : result.enclosed_vertices_of(curve, side)) {
          const Vec3d at = objects[side == ContactSide::a ? 0 : 1]->end[v];
          const double height = dot(at - curve.centroid, side == ContactSide::a ? -normal : normal);
          if (height > 0) known.emplace_back(std::min(height, depth), at);
        }
      }
      deepest = depth;
      if (!known.empty())
        deepest = std::ranges::max_element(known, {}, [](const auto& k) { return k.first; })->first;
      const double of_curve = known.empty() ? depth : 0;
      for (const std::uint32_t i : result.contacts_of(curve)) {
        for (const ContactPoint& point : result.points_of(result.contacts[i]))
          known.emplace_back(of_curve, point.position);
      }
    } else {
      for (const ContactGroup& group :
           std::ranges::equal_range(result.proximity_groups, pair, {}, objects_of)) {
        for (const ProximityPair& p : result.proximity_pairs_of(group)) {
          known.emplace_back(0 - p.distance, 0.5 * p.point_a + 0.5 * p.point_b);
          size = std::max(size, largest_magnitude(p.point_a));
        }
      }
      deepest = depth = 0 - result.proximity_pairs[manifold.record].distance;
      if (-depth > 0x1p-40 * size) normal = result.proximity_pairs[manifold.record].normal;
    }
    const auto points = result.points_of(manifold);
    double most = -std::numeric_limits<double>::infinity();
    bool is_right = points.size() <= 4 && manifold.depth == depth &&
                    norm(manifold.normal - normal) < 0x1p-40 &&
                    (normal == Vec3d{} || std::fabs(norm(normal) - 1) < 0x1p-40);
    for (const ManifoldPoint& point : points) {
      most = std::max(most, point.depth);
      size = std::max(size, largest_magnitude(point.position));
      is_right = is_right && std::ranges::find(known, std::pair(point.depth, point.position)) != known.end();
    }
    if (is_right && std::fabs(most - deepest) <= 0x1p-38 * size) continue;
    if (is_curve) {
      const Contact& first = result.contacts[result.contacts_of(result.curves[manifold.record]).front()];
      report.penetration_differences.push_back({pair.a, pair.b, objects[0]->triangles[first.triangle_a][0],
                                                PenetrationDifference::Fault::inexact});
    } else {
      const ProximityPair& p = result.proximity_pairs[manifold.record];
      report.proximity_differences.push_back({pair.a, pair.b, p.kind_a, p.kind_b, p.element_a, p.element_b,
                                              ProximityDifference::Fault::inexact});
    }
  }
}

}  // namespace supple
