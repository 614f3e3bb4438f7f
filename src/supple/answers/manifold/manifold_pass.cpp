#include "answers/manifold/manifold_pass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "geometry/vector.hpp"

namespace supple {
namespace {

/// Normals of pairs in one patch are within 45 degrees of the normal of its nearest pair.
constexpr double least_cosine = 0.70710678118654757;

/// How far a point is beyond the plane through `origin`, along `direction`.
double height_of(const Vec3d& point, const Vec3d& origin, const Vec3d& direction) {
  const double largest = std::max(largest_magnitude(point), largest_magnitude(origin));
  if (!(largest > 0)) return 0;
  const int exponent = -std::ilogb(largest) - 1;
  return std::ldexp(dot(scaled(point, exponent) - scaled(origin, exponent), direction), -exponent);
}

}  // namespace

void ManifoldPass::find(const DetectResult& result, std::span<const ManifoldObject> objects) {
  objects_ = objects;
  next_.clear();
  std::uint32_t curve = 0;
  const auto add_curves_until = [&](const auto& is_before) {
    for (; curve < result.curves.size() && is_before(result.curves[curve]); ++curve) add_curve(result, curve);
  };
  for (const ContactGroup& group : result.proximity_groups) {
    const auto pair = std::tie(group.a, group.b);
    add_curves_until([&](const IntersectionCurve& c) { return std::tie(c.a, c.b) < pair; });
    const bool intersects = curve < result.curves.size() && result.curves[curve].a == group.a &&
                            result.curves[curve].b == group.b;
    if (!intersects) add_patches(result, group);
  }
  add_curves_until([](const IntersectionCurve&) { return true; });
  match();
}

void ManifoldPass::find_none() {
  next_.clear();
  match();
}

void ManifoldPass::match() {
  next_last_id_ = last_id_;
  matcher_.match(lists_, next_, next_last_id_, next_ended_);
}

void ManifoldPass::publish() {
  std::swap(lists_, next_);
  std::swap(ended_, next_ended_);
  last_id_ = next_last_id_;
}

/// Reduces the candidates to the points of a manifold.
void ManifoldPass::add_manifold(const Manifold& manifold) {
  const ManifoldChoice choice = choose_points(candidates_, manifold.normal);
  Manifold& added = next_.manifolds.emplace_back(manifold);
  added.first_point = static_cast<std::uint32_t>(next_.points.size());
  added.point_count = choice.count;
  for (std::uint32_t i = 0; i < choice.count; ++i) {
    const ManifoldCandidate& candidate = candidates_[choice.chosen[i]];
    next_.points.push_back({0, Lasting::begin, candidate.position, candidate.depth});
    next_.names.push_back({candidate.names, candidate.has_name});
  }
}

void ManifoldPass::add_curve(const DetectResult& result, std::uint32_t index) {
  const IntersectionCurve& curve = result.curves[index];
  candidates_.clear();
  for (const std::uint32_t i : result.contacts_of(curve)) {
    const Contact& contact = result.contacts[i];
    const Triangle &a = objects_[contact.object_a.index].octree->user_triangle(contact.triangle_a),
                   &b = objects_[contact.object_b.index].octree->user_triangle(contact.triangle_b);
    for (const ContactPoint& point : result.points_of(contact))
      candidates_.push_back(
          {point.position,
           0,
           {name_of(point.on_a, a, contact.triangle_a), name_of(point.on_b, b, contact.triangle_b)},
           {true, true}});
  }
  const std::size_t on_curve = candidates_.size();
  add_enclosed(result, curve, ContactSide::a);
  add_enclosed(result, curve, ContactSide::b);
  if (candidates_.size() == on_curve) {
    for (ManifoldCandidate& candidate : candidates_) candidate.depth = curve.depth;
  }
  Manifold manifold{curve.a, curve.b};
  manifold.source = ManifoldSource::curve;
  manifold.normal = curve.normal;
  manifold.depth = curve.depth;
  manifold.record = index;
  add_manifold(manifold);
}

/// Adds the vertices that the curve encloses beyond its plane.
void ManifoldPass::add_enclosed(const DetectResult& result, const IntersectionCurve& curve,
                                ContactSide side) {
  const bool is_a = side == ContactSide::a;
  const Placement& placement = *objects_[is_a ? curve.a.index : curve.b.index].placement;
  for (const std::uint32_t v : result.enclosed_vertices_of(curve, side)) {
    const Vec3d position = placement.position(v);
    if (!is_finite(position)) continue;
    const double height = height_of(position, curve.centroid, is_a ? -curve.normal : curve.normal);
    if (!(height > 0)) continue;
    ManifoldCandidate candidate{position, std::min(height, curve.depth)};
    candidate.names[is_a ? 0 : 1] = {FeatureKind::vertex, v, v};
    candidate.has_name[is_a ? 0 : 1] = true;
    candidates_.push_back(candidate);
  }
}

/// Calls `visit` for each vertex id of an element.
template <class Visit>
void ManifoldPass::for_each_vertex(ObjectId object, FeatureKind kind,
                                   const std::array<std::uint32_t, 2>& element, const Visit& visit) const {
  if (kind == FeatureKind::face) {
    for (const std::uint32_t v : objects_[object.index].octree->user_triangle(element[0])) visit(v);
    return;
  }
  visit(element[0]);
  if (kind == FeatureKind::edge) visit(element[1]);
}

/// Lists which pairs of a group use each vertex.
void ManifoldPass::link_pairs(const DetectResult& result, const ContactGroup& group) {
  const std::span<const ProximityPair> pairs = result.proximity_pairs_of(group);
  uses_.clear();
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    const ProximityPair& pair = pairs[i];
    // Within one object, both sides have the same vertices.
    const auto add = [&](std::uint32_t side, ObjectId object, FeatureKind kind,
                         const std::array<std::uint32_t, 2>& element) {
      if (group.a == group.b) side = 0;
      for_each_vertex(object, kind, element, [&](std::uint32_t v) { uses_.push_back({side, v, i}); });
    };
    add(0, pair.object_a, pair.kind_a, pair.element_a);
    add(1, pair.object_b, pair.kind_b, pair.element_b);
  }
  std::sort(uses_.begin(), uses_.end());
  first_use_.clear();
  vertices_of_pair_.resize(pairs.size());
  vertex_count_of_pair_.assign(pairs.size(), 0);
  for (std::uint32_t u = 0; u < uses_.size(); ++u) {
    const bool is_next =
        u == 0 || uses_[u].side != uses_[u - 1].side || uses_[u].vertex != uses_[u - 1].vertex;
    if (is_next) first_use_.push_back(u);
    std::uint8_t& count = vertex_count_of_pair_[uses_[u].pair];
    vertices_of_pair_[uses_[u].pair][count++] = static_cast<std::uint32_t>(first_use_.size() - 1);
  }
  scanned_by_.assign(first_use_.size(), ~std::uint32_t{0});
  linked_by_ = scanned_by_;
  first_use_.push_back(static_cast<std::uint32_t>(uses_.size()));
}

/// Whether the elements of a pair are as far apart along the normal of the nearest pair as that pair, but for
/// rounding.
bool ManifoldPass::is_kept_apart(const ProximityPair& pair, const ProximityPair& nearest) const {
  double low_a = std::numeric_limits<double>::infinity(), high_b = -low_a, size = nearest.distance;
  const auto height = [&](ObjectId object, std::uint32_t vertex) {
    const Vec3d position = objects_[object.index].placement->position(vertex);
    size = std::max(size, largest_magnitude(position));
    return dot(position, nearest.normal);
  };
  for_each_vertex(pair.object_a, pair.kind_a, pair.element_a,
                  [&](std::uint32_t v) { low_a = std::min(low_a, height(pair.object_a, v)); });
  for_each_vertex(pair.object_b, pair.kind_b, pair.element_b,
                  [&](std::uint32_t v) { high_b = std::max(high_b, height(pair.object_b, v)); });
  return low_a - high_b >= nearest.distance - 0x1p-40 * size;
}

/// Calls `visit` for each vertex of the pairs that is in a triangle with this one: for itself, too.
template <class Visit>
void ManifoldPass::for_each_linked_vertex(const ContactGroup& group, std::uint32_t vertex,
                                          const Visit& visit) const {
  visit(vertex);
  const auto [side, of_object, first_pair] = uses_[first_use_[vertex]];
  const ManifoldObject& object = objects_[side == 0 ? group.a.index : group.b.index];
  const auto vertices = std::span(first_use_).first(first_use_.size() - 1);
  for (const std::uint32_t triangle : object.around->around(of_object)) {
    for (const std::uint32_t corner : object.octree->user_triangle(triangle)) {
      const auto place = std::ranges::lower_bound(
          vertices, std::pair(side, corner), {},
          [&](std::uint32_t u) { return std::pair(uses_[u].side, uses_[u].vertex); });
      const bool is_used =
          place != vertices.end() && uses_[*place].side == side && uses_[*place].vertex == corner;
      if (is_used) visit(static_cast<std::uint32_t>(place - vertices.begin()));
    }
  }
}

void ManifoldPass::grow_patch(std::span<const ProximityPair> pairs, const ContactGroup& group,
                              std::uint32_t seed) {
  patch_.assign(1, seed);
  is_in_patch_[seed] = 1;
  const auto scan = [&](std::uint32_t vertex) {
    if (std::exchange(scanned_by_[vertex], seed) == seed) return;
    for (std::uint32_t u = first_use_[vertex]; u < first_use_[vertex + 1]; ++u) {
      const std::uint32_t other = uses_[u].pair;
      if (is_in_patch_[other] != 0) continue;
      const bool has_direction = dot(pairs[other].normal, pairs[seed].normal) >= least_cosine;
      if (!has_direction && !is_kept_apart(pairs[other], pairs[seed])) continue;
      is_in_patch_[other] = 1;
      if (has_direction) patch_.push_back(other);
    }
  };
  for (std::size_t next = 0; next < patch_.size(); ++next) {
    const std::uint32_t pair = patch_[next];
    for (std::size_t k = 0; k < vertex_count_of_pair_[pair]; ++k) {
      const std::uint32_t vertex = vertices_of_pair_[pair][k];
      if (std::exchange(linked_by_[vertex], seed) != seed) for_each_linked_vertex(group, vertex, scan);
    }
  }
}

void ManifoldPass::add_patches(const DetectResult& result, const ContactGroup& group) {
  const std::span<const ProximityPair> pairs = result.proximity_pairs_of(group);
  link_pairs(result, group);
  by_distance_.resize(pairs.size());
  for (std::uint32_t i = 0; i < pairs.size(); ++i) by_distance_[i] = i;
  std::sort(by_distance_.begin(), by_distance_.end(), [&](std::uint32_t p, std::uint32_t q) {
    return std::pair(pairs[p].distance, p) < std::pair(pairs[q].distance, q);
  });
  is_in_patch_.assign(pairs.size(), 0);
  for (const std::uint32_t seed : by_distance_) {
    if (is_in_patch_[seed] != 0) continue;
    grow_patch(pairs, group, seed);
    candidates_.clear();
    for (const std::uint32_t i : patch_) {
      const ProximityPair& pair = pairs[i];
      candidates_.push_back({0.5 * pair.point_a + 0.5 * pair.point_b,
                             0 - pair.distance,
                             {FeatureName{pair.kind_a, pair.element_a[0], pair.element_a[1]},
                              FeatureName{pair.kind_b, pair.element_b[0], pair.element_b[1]}},
                             {true, true}});
    }
    Manifold manifold{group.a, group.b};
    manifold.source = ManifoldSource::pairs;
    manifold.normal = pairs[seed].normal;
    manifold.depth = 0 - pairs[seed].distance;
    manifold.record = group.first_contact + seed;
    add_manifold(manifold);
  }
}

}  // namespace supple
