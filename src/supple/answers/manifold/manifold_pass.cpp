#include "answers/manifold/manifold_pass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
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
  if (largest < 0x1p400 && largest > 0x1p-400) return dot(point - origin, direction);
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

/// Reduces the candidates to the points of a manifold. `name_of` gives the features of a candidate.
template <class NameOf>
void ManifoldPass::add_manifold(const Manifold& manifold, const NameOf& name_of) {
  const ManifoldChoice choice = point_choice_.choose(candidates_, manifold.normal);
  Manifold& added = next_.manifolds.emplace_back(manifold);
  added.first_point = static_cast<std::uint32_t>(next_.points.size());
  added.point_count = choice.count;
  for (std::uint32_t i = 0; i < choice.count; ++i) {
    const ManifoldCandidate& candidate = candidates_[choice.chosen[i]];
    next_.points.push_back({0, Lasting::begin, candidate.position, candidate.depth});
    next_.names.push_back(name_of(choice.chosen[i]));
  }
}

void ManifoldPass::add_curve(const DetectResult& result, std::uint32_t index) {
  const IntersectionCurve& curve = result.curves[index];
  candidates_.clear();
  for (const std::uint32_t i : result.contacts_of(curve)) {
    const auto points = result.points_of(result.contacts[i]);
    for (std::uint32_t k = 0; k < points.size(); ++k) candidates_.push_back({points[k].position, 0, i, k});
  }
  const std::size_t on_curve = candidates_.size();
  add_enclosed(result, curve, ContactSide::a);
  const std::size_t end_of_a = candidates_.size();
  add_enclosed(result, curve, ContactSide::b);
  if (candidates_.size() == on_curve) {
    for (ManifoldCandidate& candidate : candidates_) candidate.depth = curve.depth;
  }
  Manifold manifold{curve.a, curve.b};
  manifold.source = ManifoldSource::curve;
  manifold.normal = curve.normal;
  manifold.depth = curve.depth;
  manifold.record = index;
  add_manifold(manifold, [&](std::size_t i) {
    const auto& [position, depth, record, part] = candidates_[i];
    ManifoldLists::PointName name;
    if (i >= on_curve) {
      const std::size_t side = i < end_of_a ? 0 : 1;
      name.names[side] = {FeatureKind::vertex, record, record};
      name.has_name[side] = true;
      return name;
    }
    const Contact& contact = result.contacts[record];
    const ContactPoint& point = result.points_of(contact)[part];
    const auto of = [&](ObjectId object, const Feature& on, std::uint32_t triangle) {
      return name_of(on, objects_[object.index].surface.triangle(triangle), triangle);
    };
    name.names = {of(contact.object_a, point.on_a, contact.triangle_a),
                  of(contact.object_b, point.on_b, contact.triangle_b)};
    name.has_name = {true, true};
    return name;
  });
}

/// Adds the vertices that the curve encloses beyond its plane.
void ManifoldPass::add_enclosed(const DetectResult& result, const IntersectionCurve& curve,
                                ContactSide side) {
  const bool is_a = side == ContactSide::a;
  const SurfaceView& surface = objects_[is_a ? curve.a.index : curve.b.index].surface;
  const Vec3d beyond = is_a ? -curve.normal : curve.normal;
  for (const std::uint32_t v : result.enclosed_vertices_of(curve, side)) {
    const Vec3d position = surface.position(v);
    const double height = height_of(position, curve.centroid, beyond);
    if (height > 0 && is_finite(position))
      candidates_.push_back({position, std::min(height, curve.depth), v, 0});
  }
}

/// Lists in which directions the pairs of a group keep the objects apart. Returns false when the surfaces of
/// two objects cross.
bool ManifoldPass::list_directions(std::span<const ProximityPair> pairs, const ContactGroup& group) {
  const ManifoldObject &a = objects_[group.a.index], &b = objects_[group.b.index];
  double size = 0;
  for (const ProximityPair& pair : pairs) size = std::max(size, largest_magnitude(pair.point_a));
  const double touching = 0x1p-40 * size;  // smaller distances are rounding, and have no direction
  directions_.clear();
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].distance > touching) {
      directions_.push_back({i, false, false, pairs[i].normal});
      continue;
    }
    const std::span<const Vec3d> normals = touching_.find(pairs[i], a, b);
    if (normals.empty() && group.a != group.b) return false;
    for (const Vec3d& normal : normals) directions_.push_back({i, true, normals.size() > 1, normal});
  }
  return true;
}

/// Calls `visit` for each vertex id of an element.
template <class Visit>
void ManifoldPass::for_each_vertex(ObjectId object, FeatureKind kind,
                                   const std::array<std::uint32_t, 2>& element, const Visit& visit) const {
  if (kind == FeatureKind::face) {
    for (const std::uint32_t v : objects_[object.index].surface.triangle(element[0])) visit(v);
    return;
  }
  visit(element[0]);
  if (kind == FeatureKind::edge) visit(element[1]);
}

/// The place of a vertex in `vertices_`, or none.
std::uint32_t ManifoldPass::place_of(std::uint32_t side, std::uint32_t vertex) const {
  const std::uint32_t place = places_[side][vertex];  // possibly that of an earlier group
  const bool is_there =
      place < vertices_.size() && vertices_[place].side == side && vertices_[place].vertex == vertex;
  return is_there ? place : none;
}

/// Lists which directions use each vertex.
void ManifoldPass::link_pairs(std::span<const ProximityPair> pairs, const ContactGroup& group) {
  vertices_.clear();
  for (const auto& [side, object] : {std::pair(0u, group.a), std::pair(1u, group.b)})
    places_[side].resize(
        std::max(places_[side].size(), objects_[object.index].surface.around->vertex_count()));
  vertices_of_.resize(directions_.size());
  vertex_counts_.assign(directions_.size(), 0);
  for (std::uint32_t d = 0; d < directions_.size(); ++d) {
    const ProximityPair& pair = pairs[directions_[d].pair];
    auto& vertices = vertices_of_[d];
    std::uint8_t& count = vertex_counts_[d];
    // Within one object, both sides have the same vertices.
    const auto add = [&](std::uint32_t side, ObjectId object, FeatureKind kind,
                         const std::array<std::uint32_t, 2>& element) {
      if (group.a == group.b) side = 0;
      for_each_vertex(object, kind, element, [&](std::uint32_t v) {
        std::uint32_t place = place_of(side, v);
        if (place == none) {
          place = places_[side][v] = static_cast<std::uint32_t>(vertices_.size());
          vertices_.push_back({side, v});
        }
        ++vertices_[place].first_use;
        vertices[count++] = place;
      });
    };
    add(0, pair.object_a, pair.kind_a, pair.element_a);
    add(1, pair.object_b, pair.kind_b, pair.element_b);
  }
  std::uint32_t end = 0;
  for (Vertex& vertex : vertices_) vertex.first_use = end += vertex.first_use;
  uses_.resize(end);
  vertices_.push_back({none, none, end});
  for (std::uint32_t d = static_cast<std::uint32_t>(directions_.size()); d-- > 0;) {
    for (std::size_t k = 0; k < vertex_counts_[d]; ++k) uses_[--vertices_[vertices_of_[d][k]].first_use] = d;
  }
}

/// Whether the elements of a pair are as far apart along a direction of the nearest pair as that pair, but
/// for rounding.
bool ManifoldPass::is_kept_apart(const ProximityPair& pair, double distance, const Vec3d& direction) const {
  double low_a = std::numeric_limits<double>::infinity(), high_b = -low_a, size = distance;
  const auto height = [&](ObjectId object, std::uint32_t vertex) {
    const Vec3d position = objects_[object.index].surface.position(vertex);
    size = std::max(size, largest_magnitude(position));
    return dot(position, direction);
  };
  for_each_vertex(pair.object_a, pair.kind_a, pair.element_a,
                  [&](std::uint32_t v) { low_a = std::min(low_a, height(pair.object_a, v)); });
  for_each_vertex(pair.object_b, pair.kind_b, pair.element_b,
                  [&](std::uint32_t v) { high_b = std::max(high_b, height(pair.object_b, v)); });
  return low_a - high_b >= distance - 0x1p-40 * size;
}

/// Calls `visit` for the place of each vertex of the pairs that is in a triangle with this one.
template <class Visit>
void ManifoldPass::for_each_linked_vertex(const ContactGroup& group, std::uint32_t place,
                                          const Visit& visit) const {
  const std::uint32_t side = vertices_[place].side;
  const SurfaceView& surface = objects_[side == 0 ? group.a.index : group.b.index].surface;
  for (const std::uint32_t triangle : surface.around->around(vertices_[place].vertex)) {
    for (const std::uint32_t corner : surface.triangle(triangle)) {
      if (const std::uint32_t other = place_of(side, corner); other != none) visit(other);
    }
  }
}

/// Lists the directions of the patch of a seed.
void ManifoldPass::grow_patch(std::span<const ProximityPair> pairs, const ContactGroup& group,
                              std::uint32_t seed) {
  patch_.assign(1, seed);
  is_in_patch_[seed] = 1;
  --left_;
  const auto& [nearest, touches, is_one_of_several, normal] = directions_[seed];
  const auto scan = [&](std::uint32_t place) {
    if (std::exchange(vertices_[place].scanned_by, seed) == seed) return;
    for (std::uint32_t u = vertices_[place].first_use; u < vertices_[place + 1].first_use; ++u) {
      const std::uint32_t other = uses_[u];
      if (is_in_patch_[other] != 0) continue;
      const ProximityPair& pair = pairs[directions_[other].pair];
      const bool has_direction = dot(directions_[other].normal, normal) >= least_cosine;
      if (!has_direction &&
          (directions_[other].is_one_of_several || !is_kept_apart(pair, pairs[nearest].distance, normal)))
        continue;
      is_in_patch_[other] = 1;
      --left_;
      if (has_direction) patch_.push_back(other);
    }
  };
  const auto places_of = [&](std::uint32_t direction) {
    return std::span(vertices_of_[direction]).first(vertex_counts_[direction]);
  };
  // Vertices in common are found faster than triangles.
  std::size_t next = 0, next_linked = 0;
  while (left_ > 0 && next_linked < patch_.size()) {
    for (; next < patch_.size(); ++next) {
      for (const std::uint32_t place : places_of(patch_[next])) scan(place);
    }
    if (left_ == 0) return;
    for (const std::uint32_t place : places_of(patch_[next_linked++])) {
      if (std::exchange(vertices_[place].linked_by, seed) != seed) for_each_linked_vertex(group, place, scan);
    }
  }
}

/// Adds the manifold of the patch with this seed, unless it would move a body deeper into a solid.
void ManifoldPass::add_patch(std::span<const ProximityPair> pairs, const ContactGroup& group,
                             std::uint32_t seed) {
  grow_patch(pairs, group, seed);
  const std::uint32_t nearest = directions_[seed].pair;
  if (!directions_[seed].touches &&
      touching_.starts_inside(pairs[nearest], objects_[group.a.index], objects_[group.b.index]))
    return;
  candidates_.clear();
  for (const std::uint32_t d : patch_) {
    const ProximityPair& pair = pairs[directions_[d].pair];
    candidates_.push_back(
        {0.5 * pair.point_a + 0.5 * pair.point_b, 0 - pair.distance, directions_[d].pair, 0});
  }
  Manifold manifold{group.a, group.b};
  manifold.source = ManifoldSource::pairs;
  manifold.normal = directions_[seed].normal;
  manifold.depth = 0 - pairs[nearest].distance;
  manifold.record = group.first_contact + nearest;
  add_manifold(manifold, [&](std::size_t i) {
    const ProximityPair& pair = pairs[candidates_[i].record];
    return ManifoldLists::PointName{{FeatureName{pair.kind_a, pair.element_a[0], pair.element_a[1]},
                                     FeatureName{pair.kind_b, pair.element_b[0], pair.element_b[1]}},
                                    {true, true}};
  });
}

void ManifoldPass::add_patches(const DetectResult& result, const ContactGroup& group) {
  const std::span<const ProximityPair> pairs = result.proximity_pairs_of(group);
  if (!list_directions(pairs, group) || directions_.empty()) return;
  link_pairs(pairs, group);
  is_in_patch_.assign(directions_.size(), 0);
  left_ = directions_.size();
  by_distance_.resize(directions_.size());
  for (std::uint32_t d = 0; d < by_distance_.size(); ++d) by_distance_[d] = d;
  const auto is_nearer = [&](std::uint32_t p, std::uint32_t q) {
    return std::pair(pairs[directions_[p].pair].distance, p) <
           std::pair(pairs[directions_[q].pair].distance, q);
  };
  add_patch(pairs, group, *std::ranges::min_element(by_distance_, is_nearer));
  if (left_ == 0) return;
  std::ranges::sort(by_distance_, is_nearer);
  for (const std::uint32_t seed : by_distance_) {
    if (is_in_patch_[seed] == 0) add_patch(pairs, group, seed);
  }
}

}  // namespace supple
