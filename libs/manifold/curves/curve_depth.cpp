// How far the two objects of a curve must move apart, from the vertices behind it.

#include <algorithm>

#include "manifold/curves/curve_finder.hpp"

namespace supple {

/// Appends the vertices that the curve encloses on one side and returns their number.
std::size_t CurveFinder::enclose(std::span<const std::uint32_t> members, bool side_b, CurveLists& lists) {
  const SurfaceView& surface = surface_of(side_b ? 1 : 0);
  const bool is_one_sided = is_one_sided_[members.front()] != 0;
  if (is_one_sided && side_b) return 0;
  side_.start(surface.around->vertex_count());
  const auto add_triangle = [&](std::uint32_t i, bool of_b) {
    const Triangle& triangle = surface.triangle(of_b ? contact(i).triangle_b : contact(i).triangle_a);
    side_.add_triangle(triangle);
    for (std::uint32_t k = 0; k < contact(i).point_count; ++k) {
      const std::uint32_t place = first_place(i) + k;
      const FeatureName name = name_of(of_b ? points_[place].on_b : points_[place].on_a, triangle, 0);
      if (name.kind == FeatureKind::edge) side_.add_crossing(name.first, name.last, key_[place]);
    }
  };
  for (const std::uint32_t i : members) {
    add_triangle(i, side_b != is_turned(i));
    if (is_one_sided) add_triangle(i, !is_turned(i));
  }
  const std::span<const std::uint32_t> behind = regions_[side_b ? 1 : 0].inside();
  const std::span<const std::uint32_t> enclosed =
      side_.enclose(surface, behind.empty() ? CurveSide::none : behind.front());
  visited_ += side_.visited();
  const auto first = static_cast<std::ptrdiff_t>(lists.enclosed.size());
  lists.enclosed.insert(lists.enclosed.end(), enclosed.begin(), enclosed.end());
  std::sort(lists.enclosed.begin() + first, lists.enclosed.end());
  return enclosed.size();
}

/// Finds on both surfaces what is behind each curve.
void CurveFinder::link_regions() {
  for (std::size_t side = 0; side < 2; ++side) {
    regions_[side].start(surface_of(side));
    for (std::uint32_t i = 0; i < contacts_.size(); ++i) {
      // A curve whose sides are one has nothing behind it.
      if (is_one_sided_[members_[first_member_[curve_of_[i]]]] != 0) continue;
      const bool of_b = (side != 0) != is_turned(i);
      const std::uint32_t id = triangle_of(i, side);
      const Triangle& triangle = surface_of(side).triangle(id);
      const TrianglePoints other = surface_of(1 - side).corners(triangle_of(i, 1 - side));
      for (std::uint32_t k = 0; k < contact(i).point_count; ++k) {
        const std::uint32_t place = first_place(i) + k;
        const Feature& feature = of_b ? points_[place].on_b : points_[place].on_a;
        regions_[side].add(
            {name_of(feature, triangle, id), triangle, other, position(place), key_[place], curve_of_[i]});
      }
    }
    regions_[side].link(static_cast<std::uint32_t>(first_member_.size() - 1));
  }
  way_out_.start(*input_.a, *input_.b);
}

/// Finds bodies that only touch: the plane of a face is between their triangles, and nothing is inside.
bool CurveFinder::find_separation(std::span<const std::uint32_t> members, IntersectionCurve& curve) {
  for (const ContactRegions& region : regions_) {
    if (!region.inside().empty() || !region.middles().empty()) return false;
  }
  list_face_normals(members, true);
  bool is_found = false;
  for (const Direction& direction : directions_) {
    const Vec3d normal{direction.normal[0], direction.normal[1], direction.normal[2]};
    if ((is_found && !is_before(normal, curve.normal)) ||
        !separates(direction.side, direction.triangle, members))
      continue;
    is_found = true;
    curve.normal = normal;
  }
  return is_found;
}

/// Adds probes inside both bodies, for flush faces have no vertex inside, beside contacts with counted
/// normals: beside others, no point may be inside. With one, 2 of 60,000 random pairs overlap after the move.
void CurveFinder::add_common_points() {
  constexpr std::size_t most = 4;
  for (std::size_t k = 0; k < std::min(counted_.size(), most); ++k) {
    const std::uint32_t i = counted_[k * counted_.size() / std::min(counted_.size(), most)];
    const std::uint32_t place = first_place(i);
    const Vec3d middle = 0.5 * position(place) + 0.5 * position(place + contact(i).point_count - 1);
    const Vec3d point =
        middle - 0x1p-24 * largest_magnitude(middle) * (face_normals_[i][0] + face_normals_[i][1]);
    if (!way_out_.contains(0, point) || !way_out_.contains(1, point)) continue;
    way_out_.add_probe(0, point);
    way_out_.add_probe(1, point);
  }
}

/// Chooses the direction with the least depth.
void CurveFinder::find_way_out(std::span<const std::uint32_t> members, IntersectionCurve& curve) {
  double largest = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto include = [&](std::uint32_t t) {
      for (const Vec3d& p : surface_of(side).corners(t)) largest = std::max(largest, largest_magnitude(p));
    };
    for (const std::uint32_t i : members) include(triangle_of(i, side));
    for_each_behind(side, [&](std::uint32_t v) {
      for (const std::uint32_t t : surface_of(side).around->around(v)) include(t);
    });
  }
  const double scale = scale_of(largest);
  const Vec3d origin = scale * position(first_place(members.front()));
  way_out_.clear(scale, origin);
  for (std::size_t side = 0; side < 2; ++side) {
    for (const std::uint32_t i : members) way_out_.add_triangle(side, triangle_of(i, side));
    for_each_behind(side, [&](std::uint32_t v) {
      for (const std::uint32_t t : surface_of(side).around->around(v)) way_out_.add_triangle(side, t);
    });
    for (const std::uint32_t v : regions_[side].inside())
      way_out_.add_probe(side, surface_of(side).position(v));
    for (const Vec3d& p : regions_[side].middles()) way_out_.add_probe(side, p);
  }
  list_face_normals(members, false);
  if (directions_.empty()) list_face_normals(members, true);
  if (input_.a->is_solid && input_.b->is_solid && !input_.same_object()) add_common_points();
  candidates_.clear();
  for (const Direction& direction : directions_) {
    const Vec3d normal{direction.normal[0], direction.normal[1], direction.normal[2]};
    // A face of b, which points of a leave; a face of a, from which points of b go away.
    const std::size_t moves = direction.side == 0 ? 1 : 0;
    const double sign = moves == 0 ? -1 : 1;
    const Vec3d plane = scale * surface_of(direction.side).corners(direction.triangle)[0] - origin;
    double behind = 0;
    const auto include = [&](const Vec3d& p) {
      behind = std::max(behind, sign * dot(normal, scale * p - origin - plane));
    };
    for (const std::uint32_t v : regions_[moves].inside()) include(surface_of(moves).position(v));
    for_each_point(members, include);
    candidates_.push_back({normal, behind});
  }
  const auto is_near = [&](const WayCandidate& c) { return squared_norm(c.normal - of_area_) < 0x1p-34; };
  if (of_area_ != Vec3d{} && std::none_of(candidates_.begin(), candidates_.end(), is_near))
    candidates_.push_back({of_area_});
  if (candidates_.empty()) candidates_.push_back({mean_normal(members)});
  const WayOut::Way way = way_out_.find(candidates_);
  curve.normal = way.normal;
  curve.depth = way.depth == WayOut::none ? 0 : restored(way.depth, scale);
  visited_ += way_out_.visited();
}

}  // namespace supple
