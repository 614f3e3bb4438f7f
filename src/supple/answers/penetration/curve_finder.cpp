#include "answers/penetration/curve_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "geometry/exact_predicates.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

Vec3d unit_or_zero(const Vec3d& v) {
  const double largest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  if (!(largest > 0 && std::isfinite(largest))) return {};
  const Vec3d scaled{v.x / largest, v.y / largest, v.z / largest};
  return (1 / std::sqrt(dot(scaled, scaled))) * scaled + Vec3d{};
}

/// The power of two that brings coordinates of any size to about 1, so that their squares and sums neither
/// overflow nor vanish. It changes no other rounding.
double scale_of(double largest) {
  return std::ldexp(1.0, -std::clamp(largest > 0 ? std::ilogb(largest) : 0, -1000, 1023));
}

/// The value before scaling, at most the largest double.
double restored(double scaled, double scale) {
  constexpr double most = std::numeric_limits<double>::max();
  return std::clamp(scaled / scale, -most, most);
}
Vec3d restored(const Vec3d& scaled, double scale) {
  return {restored(scaled.x, scale), restored(scaled.y, scale), restored(scaled.z, scale)};
}

}  // namespace

void CurveFinder::find(const CurveInput& input, CurveLists& lists) {
  input_ = input;
  contacts_ = input.result->contacts_of(*input.group);
  if (contacts_.empty()) return;
  const Contact& last = contacts_.back();
  points_ = input.result->contact_points.subspan(
      contacts_[0].first_point, last.first_point + last.point_count - contacts_[0].first_point);
  link_contacts();
  face_normals_.clear();
  for (const Contact& of_pair : contacts_)
    face_normals_.push_back({unit_normal(input_.a.corners(of_pair.triangle_a)),
                             unit_normal(input_.b.corners(of_pair.triangle_b))});
  for (std::size_t c = 0; c + 1 < first_member_.size(); ++c)
    add_curve(std::span(members_).subspan(first_member_[c], first_member_[c + 1] - first_member_[c]), lists);
}

/// Joins the contacts that have a point in common, and lists the contacts of each curve.
void CurveFinder::link_contacts() {
  const auto count = static_cast<std::uint32_t>(contacts_.size());
  links_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    const Triangle &a = input_.a.triangle(contact(i).triangle_a),
                   &b = input_.b.triangle(contact(i).triangle_b);
    for (std::uint32_t k = 0; k < contact(i).point_count; ++k) {
      const std::uint32_t place = first_place(i) + k;
      Link link{name_of(points_[place].on_a, a, contact(i).triangle_a),
                name_of(points_[place].on_b, b, contact(i).triangle_b), i, place};
      if (input_.same_object && link.b < link.a) {
        std::swap(link.a, link.b);
        link.is_swapped = true;
      }
      links_.push_back(link);
    }
  }
  std::sort(links_.begin(), links_.end());
  sides_.start(count);
  is_one_sided_.assign(count, 0);
  key_.resize(links_.size());
  first_link_.clear();
  for (std::uint32_t l = 0; l < links_.size(); ++l) {
    const bool is_next =
        l == 0 || std::tie(links_[l - 1].a, links_[l - 1].b) != std::tie(links_[l].a, links_[l].b);
    if (is_next) first_link_.push_back(l);
    const Link &first = links_[first_link_.back()], &link = links_[l];
    if (!sides_.join(first.contact, link.contact, first.is_swapped != link.is_swapped))
      is_one_sided_[link.contact] = 1;
    key_[link.place] = static_cast<std::uint32_t>(first_link_.size() - 1);
  }
  first_link_.push_back(static_cast<std::uint32_t>(links_.size()));

  // The smallest contact of a curve is the root of its set.
  first_member_.assign(1, 0);
  curve_of_.resize(count);
  is_turned_.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto [root, is_opposite] = sides_.find(i);
    is_turned_[i] = is_opposite ? 1 : 0;
    if (is_one_sided_[i] != 0) is_one_sided_[root] = 1;
    if (root == i) {
      curve_of_[i] = static_cast<std::uint32_t>(first_member_.size() - 1);
      first_member_.push_back(0);
    }
    curve_of_[i] = curve_of_[root];
    ++first_member_[curve_of_[i] + 1];
  }
  for (std::size_t c = 1; c < first_member_.size(); ++c) first_member_[c] += first_member_[c - 1];
  members_.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) members_[first_member_[curve_of_[i]]++] = i;
  // Each number is now the end of its curve.
  first_member_.pop_back();
  first_member_.insert(first_member_.begin(), 0);
}

CurveKind CurveFinder::kind_of(std::span<const std::uint32_t> members) const {
  CurveKind kind = CurveKind::closed;
  for (const std::uint32_t i : members) {
    if (contact(i).kind != IntersectionKind::segment) return CurveKind::branched;
    for (std::uint32_t k = 0; k < 2; ++k) {
      const std::uint32_t contacts = degree(key_[first_place(i) + k]);
      if (contacts > 2) return CurveKind::branched;
      if (contacts == 1) kind = CurveKind::open;
    }
  }
  return kind;
}

/// Lists the contacts of a closed or an open curve in their order.
void CurveFinder::walk(std::span<const std::uint32_t> members, CurveKind kind) {
  steps_.clear();
  Step step{members.front(), first_place(members.front()), first_place(members.front()) + 1};
  if (kind == CurveKind::open) {
    for (const std::uint32_t i : members) {
      const std::uint32_t place = first_place(i);
      const bool starts = degree(key_[place]) == 1, ends = degree(key_[place + 1]) == 1;
      if (!starts && !ends) continue;
      step = starts ? Step{i, place, place + 1} : Step{i, place + 1, place};
      break;
    }
  }
  for (;;) {
    steps_.push_back(step);
    const std::uint32_t key = key_[step.leave];
    if (degree(key) == 1 || steps_.size() == members.size()) break;
    const Link* const links = &links_[first_link_[key]];
    const Link& next = links[0].contact == step.contact ? links[1] : links[0];
    const std::uint32_t place = first_place(next.contact);
    step = {next.contact, next.place, next.place == place ? place + 1 : place};
  }
}

/// Positive when the steps go in the direction n_b x n_a.
double CurveFinder::turn_of_steps() const {
  double sum = 0;
  for (const Step& step : steps_) {
    const auto& [n_a, n_b] = face_normals_[step.contact];
    const double turn = dot(cross(n_b, n_a), position(step.leave) - position(step.enter));
    if (std::isfinite(turn)) sum += is_turned(step.contact) ? -turn : turn;
  }
  return sum;
}

void CurveFinder::turn_around(CurveKind kind) {
  for (Step& step : steps_) std::swap(step.enter, step.leave);
  // A closed curve keeps its first contact.
  std::reverse(steps_.begin() + (kind == CurveKind::closed ? 1 : 0), steps_.end());
}

void CurveFinder::add_curve(std::span<const std::uint32_t> members, CurveLists& lists) {
  const auto size_of = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
  IntersectionCurve curve;
  curve.a = input_.group->a;
  curve.b = input_.group->b;
  curve.kind = kind_of(members);
  curve.first_contact = size_of(lists.contacts);
  curve.contact_count = static_cast<std::uint32_t>(members.size());
  curve.first_point = size_of(lists.points);
  curve.first_enclosed = size_of(lists.enclosed);
  steps_.clear();
  if (curve.kind == CurveKind::branched) {
    for (const std::uint32_t i : members) lists.contacts.push_back(input_.group->first_contact + i);
  } else {
    walk(members, curve.kind);
    if (turn_of_steps() < 0) turn_around(curve.kind);
    for (const Step& step : steps_) {
      lists.contacts.push_back(input_.group->first_contact + step.contact);
      lists.points.push_back(position(step.enter));
    }
    if (curve.kind == CurveKind::open) lists.points.push_back(position(steps_.back().leave));
  }
  curve.point_count = size_of(lists.points) - curve.first_point;
  measure(members, curve);
  for (auto& behind : behind_) behind.clear();
  curve.enclosed_count_a = static_cast<std::uint32_t>(enclose(members, false, lists));
  curve.enclosed_count_b = static_cast<std::uint32_t>(enclose(members, true, lists));
  find_way_out(members, curve);
  lists.curves.push_back(curve);
}

void CurveFinder::measure(std::span<const std::uint32_t> members, IntersectionCurve& curve) {
  double largest = 0;
  for_each_point(members, [&](const Vec3d& p) { largest = std::max(largest, largest_magnitude(p)); });
  scale_ = scale_of(largest);
  const auto scaled = [&](std::uint32_t place) { return scale_ * position(place); };
  Vec3d middle, middle_of_points;
  double length = 0, points = 0;
  for (const std::uint32_t i : members) {
    const std::uint32_t place = first_place(i), count = contact(i).point_count;
    for (std::uint32_t k = 0; k < count; ++k) middle_of_points = middle_of_points + scaled(place + k);
    points += count;
    const Vec3d along = scaled(place + count - 1) - scaled(place);
    const double part = std::sqrt(dot(along, along));
    middle = middle + (part / 2) * (scaled(place) + scaled(place + count - 1));
    length += part;
  }
  const Vec3d centroid = length > 0 ? (1 / length) * middle : (1 / points) * middle_of_points;
  curve.centroid = restored(centroid, scale_);
  Vec3d area;
  if (curve.kind == CurveKind::closed) {
    for (const Step& step : steps_)
      area = area + cross(scaled(step.enter) - centroid, scaled(step.leave) - centroid);
    curve.area = restored(restored(0.5 * area, scale_), scale_);
  }
  middle_ = centroid;
  of_area_ = curve.kind == CurveKind::closed ? unit_or_zero(area) : direction_of_segments(members);
}

/// Half around the polygon that the triangles of a contact share; the length of a segment.
double CurveFinder::length_of(std::uint32_t i) const {
  const std::uint32_t place = first_place(i), count = contact(i).point_count;
  double around = 0;
  for (std::uint32_t k = 0; k < count; ++k)
    around += norm(scale_ * position(place + (k + 1) % count) - scale_ * position(place + k));
  return around / 2;
}

/// Whether one of the two triangles is nowhere behind the other one.
bool CurveFinder::only_touches(std::uint32_t i) const {
  const auto pierces = [&](std::uint32_t place) {
    const FeatureKind on_a = points_[place].on_a.kind, on_b = points_[place].on_b.kind;
    return (on_a == FeatureKind::edge && on_b == FeatureKind::face) ||
           (on_a == FeatureKind::face && on_b == FeatureKind::edge);
  };
  // An edge goes through the inside of a triangle that is not in its plane: each has corners on both sides of
  // the other.
  if (contact(i).kind == IntersectionKind::segment &&
      (pierces(first_place(i)) || pierces(first_place(i) + 1)))
    return false;
  bool used_exact = false;
  const auto is_outside = [&](const TrianglePoints& p, const TrianglePoints& q) {
    return std::all_of(p.begin(), p.end(), [&](const Vec3d& corner) {
      return orient3d(q[0], q[1], q[2], corner, used_exact) >= 0;
    });
  };
  const TrianglePoints a = input_.a.corners(contact(i).triangle_a),
                       b = input_.b.corners(contact(i).triangle_b);
  return is_outside(a, b) || is_outside(b, a);
}

/// Lists the normals of faces on which at least half of the curve lies: those of b, and the reverse of those
/// of a. Contacts that only touch count where there are no others.
void CurveFinder::list_face_normals(std::span<const std::uint32_t> members) {
  double whole = 0;
  const auto add = [&](const Vec3d& n, double length) {
    const auto rounded = [](double x) { return std::floor(x * 0x1p30 + 0.5); };
    if (n != Vec3d{})
      directions_.push_back({{rounded(n.x), rounded(n.y), rounded(n.z)}, {n.x, n.y, n.z}, length});
  };
  for (const bool counts_touching : {false, true}) {
    directions_.clear();
    for (const std::uint32_t i : members) {
      const double length = length_of(i);
      if (length == 0 || (!counts_touching && only_touches(i))) continue;
      whole += length;
      const auto& [n_a, n_b] = face_normals_[i];
      add(is_turned(i) ? n_a : n_b, length);
      add(Vec3d{} - (is_turned(i) ? n_b : n_a), length);
    }
    if (whole > 0) break;
  }
  std::sort(directions_.begin(), directions_.end());
  for (std::size_t first = 0, next = 0; first < directions_.size(); first = next) {
    double length = 0;
    for (; next < directions_.size() && directions_[next].rounded == directions_[first].rounded; ++next)
      length += directions_[next].length;
    const auto& [x, y, z] = directions_[first].normal;
    if (length >= (0.5 - 0x1p-20) * whole) normals_.push_back({x, y, z});
  }
}

/// The direction of the area that segments surround, each in the direction n_b x n_a, in any order; zero when
/// rounding is a large part of it.
Vec3d CurveFinder::direction_of_segments(std::span<const std::uint32_t> members) const {
  Vec3d area;
  double length = 0;
  for (const std::uint32_t i : members) {
    if (contact(i).kind != IntersectionKind::segment) continue;
    const Vec3d p = scale_ * position(first_place(i)) - middle_,
                q = scale_ * position(first_place(i) + 1) - middle_;
    const auto& [n_a, n_b] = face_normals_[i];
    const double along = dot(cross(n_b, n_a), q - p) * (is_turned(i) ? -1 : 1);
    if (along != 0) area = area + (along > 0 ? 1.0 : -1.0) * cross(p, q);
    length += norm(q - p);
  }
  return norm(area) > 0x1p-20 * length * length ? unit_or_zero(area) : Vec3d{};
}

/// Lists the directions of which `find_way_out` chooses one.
void CurveFinder::list_normals(std::span<const std::uint32_t> members) {
  normals_.clear();
  list_face_normals(members);
  const auto is_near = [&](const Vec3d& n) { return squared_norm(n - of_area_) < 0x1p-34; };
  if (of_area_ != Vec3d{} && std::none_of(normals_.begin(), normals_.end(), is_near))
    normals_.push_back(of_area_);
  if (!normals_.empty()) return;
  Vec3d by_length, sum;
  for (const std::uint32_t i : members) {
    const Vec3d normal = is_turned(i) ? Vec3d{} - contact(i).normal : contact(i).normal;
    by_length = by_length + length_of(i) * normal;
    sum = sum + normal;
  }
  normals_ = {contact(members.front()).normal};
  // Sums of which rounding is a large part have no direction.
  constexpr double least = 0x1p-30;
  double length = 0;
  for (const std::uint32_t i : members) length += length_of(i);
  if (norm(sum) > least * static_cast<double>(members.size())) normals_.front() = unit_or_zero(sum);
  if (norm(by_length) > least * length) normals_.front() = unit_or_zero(by_length);
}

/// Appends the vertices that the curve encloses on one side and returns their number.
std::size_t CurveFinder::enclose(std::span<const std::uint32_t> members, bool side_b, CurveLists& lists) {
  const SurfaceView& surface = side_b ? input_.b : input_.a;
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
  // All curves together flood as many vertices as there are contacts and vertices, about.
  const std::size_t curves = first_member_.size() - 1;
  const std::size_t most_behind = std::max(16 * members.size(), 4 * surface.around->vertex_count() / curves);
  const Vec3d towards_behind = side_b ? of_area_ : Vec3d{} - of_area_;
  const std::span<const std::uint32_t> enclosed =
      side_.enclose(surface, {towards_behind, middle_, scale_}, most_behind);
  behind_[side_b ? 1 : 0].assign(side_.behind().begin(), side_.behind().end());
  const auto first = static_cast<std::ptrdiff_t>(lists.enclosed.size());
  lists.enclosed.insert(lists.enclosed.end(), enclosed.begin(), enclosed.end());
  std::sort(lists.enclosed.begin() + first, lists.enclosed.end());
  return enclosed.size();
}

/// Collects the triangles of both sides, relative to a point of the curve and scaled to about 1 or less.
/// Returns the scale.
double CurveFinder::collect_parts(std::span<const std::uint32_t> members) {
  const auto surface_of = [&](std::size_t side) { return side == 0 ? input_.a : input_.b; };
  double largest = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const SurfaceView surface = surface_of(side);
    std::vector<std::uint32_t>& triangles = triangles_[side];
    std::vector<std::uint8_t>& is_listed = is_listed_[side];
    for (const std::uint32_t t : triangles) is_listed[t] = 0;
    triangles.clear();
    is_listed.resize(std::max(is_listed.size(), surface.octree->triangles().size()), 0);
    const auto add = [&](std::uint32_t t) {
      if (is_listed[t] == 0) triangles.push_back(t);
      is_listed[t] = 1;
    };
    for (const std::uint32_t i : members) {
      const bool of_b = (side != 0) != is_turned(i);
      add(of_b ? contact(i).triangle_b : contact(i).triangle_a);
    }
    for (const std::uint32_t v : behind_[side]) {
      for (const std::uint32_t t : surface.around->around(v)) add(t);
    }
    for (const std::uint32_t t : triangles) {
      for (const Vec3d& p : surface.corners(t)) largest = std::max(largest, largest_magnitude(p));
    }
  }
  const double scale = scale_of(largest);
  const Vec3d origin = scale * position(first_place(members.front()));
  parts_.clear();
  for (std::size_t side = 0; side < 2; ++side) {
    for (const std::uint32_t t : triangles_[side]) {
      TrianglePoints corners = surface_of(side).corners(t);
      for (Vec3d& p : corners) p = scale * p - origin;
      parts_.add(side, corners);
    }
  }
  return scale;
}

/// Chooses the normal with the least depth. One along which nothing is ahead does not lead out; it counts
/// only where all are such.
void CurveFinder::find_way_out(std::span<const std::uint32_t> members, IntersectionCurve& curve) {
  list_normals(members);
  const double scale = collect_parts(members);
  ways_.clear();
  for (const Vec3d& normal : normals_) ways_.push_back(parts_.way_along(normal));
  const auto best = std::min_element(ways_.begin(), ways_.end()) - ways_.begin();
  double depth = ways_[static_cast<std::size_t>(best)];
  curve.normal = normals_[static_cast<std::size_t>(best)];
  // Between equal ways it is the middle one, so that the normal of a symmetric curve is symmetric.
  Vec3d sum;
  std::size_t equal = 0;
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    if (ways_[i] > depth * (1 + 0x1p-36)) continue;
    sum = sum + normals_[i];
    ++equal;
  }
  if (equal > 1 && norm(sum) > 0x1p-10) {
    curve.normal = unit_or_zero(sum);
    depth = parts_.way_along(curve.normal);
  }
  curve.depth = depth == CurveParts::nothing_ahead ? 0 : restored(depth, scale);
}

}  // namespace supple
