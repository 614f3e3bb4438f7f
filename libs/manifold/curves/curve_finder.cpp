#include "manifold/curves/curve_finder.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/exact_predicates.hpp"
#include "geometry/vector.hpp"

namespace supple {
namespace {

/// Without negative zeros.
Vec3d unit_or_zero(const Vec3d& v) {
  return normalized(v) + Vec3d{};
}

}  // namespace

void CurveFinder::find(const CurveInput& input, CurveLists& lists) {
  input_ = input;
  visited_ = 0;
  contacts_ = input.result->contacts_of(*input.group);
  if (contacts_.empty()) return;
  const Contact& last = contacts_.back();
  points_ = input.result->contact_points.subspan(
      contacts_[0].first_point, last.first_point + last.point_count - contacts_[0].first_point);
  link_contacts();
  link_regions();
  face_normals_.clear();
  for (const Contact& of_pair : contacts_)
    face_normals_.push_back({unit_normal(surface_of(0).corners(of_pair.triangle_a)),
                             unit_normal(surface_of(1).corners(of_pair.triangle_b))});
  for (std::size_t c = 0; c + 1 < first_member_.size(); ++c)
    add_curve(std::span(members_).subspan(first_member_[c], first_member_[c + 1] - first_member_[c]), lists);
}

/// Joins the contacts that have a point in common, and lists the contacts of each curve.
void CurveFinder::link_contacts() {
  const auto count = static_cast<std::uint32_t>(contacts_.size());
  links_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    const Triangle &a = surface_of(0).triangle(contact(i).triangle_a),
                   &b = surface_of(1).triangle(contact(i).triangle_b);
    for (std::uint32_t k = 0; k < contact(i).point_count; ++k) {
      const std::uint32_t place = first_place(i) + k;
      Link link{name_of(points_[place].on_a, a, contact(i).triangle_a),
                name_of(points_[place].on_b, b, contact(i).triangle_b), i, place};
      if (input_.same_object() && link.b < link.a) {
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
  // In proportion to the contacts, where the other surface is not known to bound the region.
  const std::size_t n = members.size(), many = 64 + 16 * n + n * n / 4, all = ~std::size_t{0};
  const std::uint32_t number = curve_of_[members.front()];
  for (std::size_t side = 0; side < 2; ++side) {
    ContactRegions& region = regions_[side];
    const bool other_is_solid = !input_.same_object() && (side == 0 ? input_.b : input_.a)->is_solid;
    region.begin(number);
    // Contacts at corners of the other surface may tell nothing.
    for (std::size_t i = 0; i < n && other_is_solid && region.inside().empty(); ++i) {
      for (const std::uint32_t v : surface_of(side).triangle(triangle_of(members[i], side))) {
        if (region.is_open(v)) region.decide(v, way_out_.contains(1 - side, surface_of(side).position(v)));
      }
    }
    region.grow(number, other_is_solid ? all : many);
    visited_ += region.inside().size() + region.beyond().size();
  }
  curve.enclosed_count_a = static_cast<std::uint32_t>(enclose(members, false, lists));
  curve.enclosed_count_b = static_cast<std::uint32_t>(enclose(members, true, lists));
  if (!find_separation(members, curve)) find_way_out(members, curve);
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
  const TrianglePoints a = surface_of(0).corners(contact(i).triangle_a),
                       b = surface_of(1).corners(contact(i).triangle_b);
  return is_outside(a, b) || is_outside(b, a);
}

/// Whether the triangles of the other side are nowhere behind a face, and those of its own side nowhere in
/// front of it. Faces of solids in one plane that face the same way have both insides behind them.
bool CurveFinder::separates(std::size_t side, std::uint32_t face,
                            std::span<const std::uint32_t> members) const {
  const TrianglePoints plane = surface_of(side).corners(face);
  bool used_exact = false;
  const auto is_on_its_side = [&](std::uint32_t i, std::size_t of) {
    const TrianglePoints corners = surface_of(of).corners(triangle_of(i, of));
    bool is_in_plane = true;
    for (const Vec3d& p : corners) {
      const int height = orient3d(plane[0], plane[1], plane[2], p, used_exact);
      if (of == side ? height > 0 : height < 0) return false;
      is_in_plane = is_in_plane && height == 0;
    }
    return of == side || !is_in_plane || !input_.a->is_solid || !input_.b->is_solid ||
           dot(unit_normal(plane), unit_normal(corners)) <= 0;
  };
  return std::all_of(members.begin(), members.end(),
                     [&](std::uint32_t i) { return is_on_its_side(i, 1 - side) && is_on_its_side(i, side); });
}

/// Lists the normals of the faces on which the curve lies: those of b, and the reverse of those of a. Of many
/// normals, those on an eighth of the curve. Skips contacts that only touch on request.
void CurveFinder::list_face_normals(std::span<const std::uint32_t> members, bool counts_touching) {
  constexpr std::size_t few = 12;
  double whole = 0;
  const auto add = [&](const Vec3d& n, double length, std::uint32_t triangle, std::uint8_t side) {
    const auto rounded = [](double x) { return std::floor(x * 0x1p30 + 0.5); };
    if (n != Vec3d{})
      directions_.push_back(
          {{rounded(n.x), rounded(n.y), rounded(n.z)}, side, {n.x, n.y, n.z}, triangle, length});
  };
  directions_.clear();
  counted_.clear();
  for (const std::uint32_t i : members) {
    const double length = length_of(i);
    if (length == 0 || (!counts_touching && only_touches(i))) continue;
    whole += length;
    counted_.push_back(i);
    for (std::uint8_t side = 0; side < 2; ++side) {
      const Vec3d& outward = face_normals_[i][is_turned(i) ? 1 - side : side];
      add(side == 0 ? Vec3d{} - outward : outward, length, triangle_of(i, side), side);
    }
  }
  std::sort(directions_.begin(), directions_.end());
  std::size_t count = 0;
  for (const Direction& direction : directions_) {
    Direction* const last = count > 0 ? &directions_[count - 1] : nullptr;
    if (last != nullptr && last->rounded == direction.rounded && last->side == direction.side)
      last->length += direction.length;
    else
      directions_[count++] = direction;
  }
  directions_.resize(count);
  if (count > few)
    std::erase_if(directions_, [&](const Direction& direction) { return direction.length < whole / 8; });
  // The faces with most of the curve are most likely the way out.
  std::sort(directions_.begin(), directions_.end(), [](const Direction& p, const Direction& q) {
    return p.length != q.length ? p.length > q.length : p < q;
  });
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

/// The normal of a curve whose faces and area have no direction.
Vec3d CurveFinder::mean_normal(std::span<const std::uint32_t> members) const {
  Vec3d by_length, sum;
  double length = 0;
  for (const std::uint32_t i : members) {
    const Vec3d normal = is_turned(i) ? Vec3d{} - contact(i).normal : contact(i).normal;
    by_length = by_length + length_of(i) * normal;
    sum = sum + normal;
    length += length_of(i);
  }
  // Sums of which rounding is a large part have no direction.
  constexpr double least = 0x1p-30;
  if (norm(by_length) > least * length) return unit_or_zero(by_length);
  if (norm(sum) > least * static_cast<double>(members.size())) return unit_or_zero(sum);
  return contact(members.front()).normal;
}

}  // namespace supple
