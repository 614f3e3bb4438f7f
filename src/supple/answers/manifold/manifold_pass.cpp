#include "answers/manifold/manifold_pass.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "geometry/vector.hpp"
#include "queries/feature_name.hpp"

namespace supple {
namespace {

/// Normals of pairs in one patch are within 45 degrees of the normal of its nearest pair.
constexpr double least_cosine = 0.70710678118654757;

/// Bounds the rounding of coordinates that are scaled to at most 1/2.
constexpr double rounding = 0x1p-40;

constexpr double infinity = std::numeric_limits<double>::infinity();

std::uint64_t number_of(const FeatureName& name) {
  const std::uint64_t first = name.kind == FeatureKind::face ? ~std::uint32_t{0} : name.first;
  return first << 32 | name.last;
}

}  // namespace

/// Collects candidates, scaled so that no square overflows or vanishes.
class ManifoldPass::Collector {
 public:
  /// `size` is the largest coordinate, and `deepest` the largest depth, if it is known.
  Collector(std::vector<Candidate>& candidates, const Vec3d& normal, double size, double deepest)
      : candidates_(candidates),
        scale_(size > 0 ? std::min(0.5 / size, 0x1p1000) : 1),
        deepest_(scale_ * deepest) {
    candidates.clear();
    // "Building an Orthonormal Basis, Revisited" (Duff et al. 2017)
    const double sign = std::copysign(1.0, normal.z), w = -1 / (sign + normal.z),
                 xy = normal.x * normal.y * w;
    x_ = scale_ * Vec3d{1 + sign * normal.x * normal.x * w, sign * xy, -sign * normal.x};
    y_ = scale_ * Vec3d{xy, sign + normal.y * normal.y * w, -normal.y};
  }
  void add(const Vec3d& position, double depth, std::uint32_t record, std::uint32_t part) {
    const double x = dot(x_, position), y = dot(y_, position), scaled_depth = scale_ * depth;
    // When several points are deepest, the one that is farthest in a direction comes first. Edges of meshes
    // are seldom at right angles to this direction, so the point is a corner.
    const double far = x + 0.618 * y;
    deepest_ = std::max(deepest_, scaled_depth);
    const double least = deepest_ - rounding;
    if (scaled_depth >= least && (far > farthest_ || depth_of_first_ < least)) {
      first_ = candidates_.size();
      farthest_ = far;
      depth_of_first_ = scaled_depth;
    }
    candidates_.push_back({x, y, scaled_depth, position, depth, record, part});
  }
  std::size_t first() const { return first_; }

 private:
  std::vector<Candidate>& candidates_;
  double scale_;
  Vec3d x_, y_;
  double deepest_, farthest_ = -infinity, depth_of_first_ = -infinity;
  std::size_t first_ = 0;  // the first point to choose
};

void ManifoldPass::find(const DetectResult& result, std::span<ManifoldObject> objects, bool lists_all_pairs) {
  objects_ = objects;
  lists_all_pairs_ = lists_all_pairs;
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

/// Chooses at most four candidates that span all of them, in the order around the normal; see `Manifold`.
ManifoldPass::Choice ManifoldPass::choose_points(std::size_t first) const {
  Choice choice{{first}, 1};
  auto& [chosen, count] = choice;
  // Takes the point with the largest value of those with more than `least`; of almost equal ones the deepest.
  const auto add_largest = [&](double least, double weight_of_depth, const auto& value_of) {
    std::size_t best = candidates_.size();
    double most = -infinity;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const Candidate& p = candidates_[i];
      const double value = value_of(p), weighed = value + weight_of_depth * p.scaled_depth;
      const bool is_better = value > least && weighed > most;
      most = is_better ? weighed : most;
      best = is_better ? i : best;
    }
    if (best == candidates_.size()) return false;
    chosen[count++] = best;
    return true;
  };
  // Twice the area of the triangle of two chosen points and another one, which is to the left.
  const auto area_of = [&](std::size_t from, std::size_t to) {
    const Candidate &p = candidates_[chosen[from]], &q = candidates_[chosen[to]];
    return [x = p.x, y = p.y, dx = q.x - p.x, dy = q.y - p.y](const Candidate& other) {
      return dx * (other.y - y) - dy * (other.x - x);
    };
  };
  const auto distance = [x = candidates_[first].x, y = candidates_[first].y](const Candidate& p) {
    return std::sqrt((p.x - x) * (p.x - x) + (p.y - y) * (p.y - y));
  };
  if (candidates_.size() == 1 || !add_largest(rounding, 1, distance)) return choice;
  const double length = distance(candidates_[chosen[1]]);
  const double least = std::max(0x1p-10 * length, rounding) * length;
  const auto area = area_of(0, 1);
  if (!add_largest(least, length, [&](const Candidate& p) { return std::fabs(area(p)); })) return choice;
  if (area(candidates_[chosen[2]]) < 0) std::swap(chosen[1], chosen[2]);
  const std::array added{area_of(1, 0), area_of(2, 1), area_of(0, 2)};
  if (!add_largest(least, length, [&](const Candidate& p) {
        return std::max({added[0](p), added[1](p), added[2](p)});
      }))
    return choice;
  // Between the ends of the edge that it is outside of.
  const Candidate& last = candidates_[chosen[3]];
  if (added[2](last) > std::max(added[0](last), added[1](last))) return choice;
  std::swap(chosen[2], chosen[3]);
  if (added[0](last) > added[1](last)) std::swap(chosen[1], chosen[2]);
  return choice;
}

/// Reduces the candidates to the points of a manifold. `name_of` gives the features of a candidate.
template <class NameOf>
void ManifoldPass::add_manifold(const Manifold& manifold, std::size_t first, const NameOf& name_of) {
  Manifold& added = next_.manifolds.emplace_back(manifold);
  added.first_point = static_cast<std::uint32_t>(next_.points.size());
  const auto [chosen, count] = choose_points(first);
  added.point_count = count;
  for (const std::size_t i : std::span(chosen).first(count)) {
    next_.points.push_back({0, Lasting::begin, candidates_[i].position, candidates_[i].depth});
    next_.names.push_back(name_of(candidates_[i]));
  }
}

void ManifoldPass::add_curve(const DetectResult& result, std::uint32_t index) {
  const IntersectionCurve& curve = result.curves[index];
  const auto contacts = result.contacts_of(curve);
  const auto points = result.points_of(curve);
  double size = largest_magnitude(curve.centroid);
  for (const Vec3d& point : points) size = std::max(size, largest_magnitude(point));
  Collector collector(candidates_, curve.normal, size, -infinity);
  const double depth = curve.enclosed_count_a + curve.enclosed_count_b > 0 ? 0 : curve.depth;
  for (std::size_t k = 0; k < points.size(); ++k)
    collector.add(points[k], depth, contacts[std::min(k, contacts.size() - 1)], Candidate::any_point);
  // A branched curve has no points.
  for (const std::uint32_t i : contacts.first(points.empty() ? contacts.size() : 0)) {
    const auto of_contact = result.points_of(result.contacts[i]);
    for (std::uint32_t k = 0; k < of_contact.size(); ++k) collector.add(of_contact[k].position, depth, i, k);
  }
  const std::size_t on_curve = candidates_.size();
  for (const ContactSide side : {ContactSide::a, ContactSide::b}) {
    const bool is_a = side == ContactSide::a;
    const SurfaceView& surface = objects_[is_a ? curve.a.index : curve.b.index].surface;
    const Vec3d beyond = is_a ? -curve.normal : curve.normal;
    // The vertices that the curve encloses beyond its plane.
    for (const std::uint32_t v : result.enclosed_vertices_of(curve, side)) {
      const Vec3d position = surface.position(v);
      const double height = dot(position - curve.centroid, beyond);
      if (height > 0 && is_finite(position))
        collector.add(position, std::min(height, curve.depth), v,
                      is_a ? Candidate::vertex_of_a : Candidate::vertex_of_b);
    }
  }
  if (candidates_.size() == on_curve && depth != curve.depth) {
    for (Candidate& candidate : candidates_) candidate.depth = curve.depth;
  }
  Manifold manifold{curve.a, curve.b};
  manifold.source = ManifoldSource::curve;
  manifold.normal = curve.normal;
  manifold.depth = curve.depth;
  manifold.record = index;
  add_manifold(manifold, collector.first(), [&](const Candidate& candidate) {
    if (candidate.part >= Candidate::vertex_of_a) {
      ManifoldLists::PointName name{ManifoldLists::no_name, ManifoldLists::no_name};
      name[candidate.part - Candidate::vertex_of_a] =
          number_of({FeatureKind::vertex, candidate.record, candidate.record});
      return name;
    }
    const Contact& contact = result.contacts[candidate.record];
    return ManifoldLists::PointName{~std::uint64_t{candidate.part} << 32 | contact.triangle_a,
                                    ~std::uint64_t{candidate.part} << 32 | contact.triangle_b};
  });
}

/// Whether the elements of a pair are as far apart along a direction of the nearest pair as that pair, but
/// for rounding.
bool ManifoldPass::is_kept_apart(const ProximityPair& pair, double distance, const Vec3d& direction) const {
  double low_a = dot(pair.point_a, direction), high_b = dot(pair.point_b, direction);
  double size = std::max(distance, size_);
  const auto is_apart = [&] { return low_a - high_b >= distance - 0x1p-40 * size; };
  const auto for_each_height = [&](ObjectId id, FeatureKind kind, const std::array<std::uint32_t, 2>& element,
                                   const auto& visit) {
    const SurfaceView& surface = objects_[id.index].surface;
    Triangle vertices{element[0], element[1], element[1]};
    if (kind == FeatureKind::face) vertices = surface.triangle(element[0]);
    for (const std::uint32_t vertex : vertices) {
      const Vec3d position = surface.position(vertex);
      size = std::max(size, largest_magnitude(position));
      visit(dot(position, direction));
    }
  };
  // The height of a vertex is known.
  if (is_apart() && pair.kind_a != FeatureKind::vertex)
    for_each_height(pair.object_a, pair.kind_a, pair.element_a,
                    [&](double h) { low_a = std::min(low_a, h); });
  if (is_apart() && pair.kind_b != FeatureKind::vertex)
    for_each_height(pair.object_b, pair.kind_b, pair.element_b,
                    [&](double h) { high_b = std::max(high_b, h); });
  return is_apart();
}

/// Adds the manifold of the patch around the nearest pair, unless it would move a body deeper into a solid.
/// Keeps the directions in no patch. `direction_of(i)` gives each of `count` directions. `has_nearest`: no
/// pair of the objects is nearer.
template <class DirectionOf>
void ManifoldPass::add_patch(std::span<const ProximityPair> pairs, const ContactGroup& group,
                             const Direction& nearest, bool has_nearest, std::size_t count,
                             const DirectionOf& direction_of) {
  Collector collector(candidates_, nearest.normal, size_, -nearest.distance);
  left_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const Direction& direction = direction_of(i);
    const ProximityPair& pair = pairs[direction.pair];
    if (dot(direction.normal, nearest.normal) >= least_cosine)
      collector.add(0.5 * pair.point_a + 0.5 * pair.point_b, 0 - pair.distance, direction.pair, 0);
    else if (direction.is_one_of_several || group.a == group.b ||
             !is_kept_apart(pair, nearest.distance, nearest.normal))
      left_.push_back(direction);
  }
  std::swap(directions_, left_);
  ManifoldObject &a = objects_[group.a.index], &b = objects_[group.b.index];
  // The nearest points of two objects lie in the other one, or the way between them starts outside.
  const bool may_be_inside = !has_nearest || a.may_contain(pairs[nearest.pair].point_b) ||
                             b.may_contain(pairs[nearest.pair].point_a);
  if (may_be_inside && !nearest.touches && touching_.starts_inside(pairs[nearest.pair], a, b)) return;
  Manifold manifold{group.a, group.b};
  manifold.source = ManifoldSource::pairs;
  manifold.normal = nearest.normal;
  manifold.depth = 0 - nearest.distance;
  manifold.record = group.first_contact + nearest.pair;
  add_manifold(manifold, collector.first(), [&](const Candidate& candidate) {
    const ProximityPair& pair = pairs[candidate.record];
    return ManifoldLists::PointName{number_of({pair.kind_a, pair.element_a[0], pair.element_a[1]}),
                                    number_of({pair.kind_b, pair.element_b[0], pair.element_b[1]})};
  });
}

void ManifoldPass::add_patches(const DetectResult& result, const ContactGroup& group) {
  const std::span<const ProximityPair> pairs = result.proximity_pairs_of(group);
  double least = infinity;
  std::size_t first = 0;
  size_ = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    size_ = std::max(size_, largest_magnitude(pairs[i].point_a));
    first = pairs[i].distance < least ? i : first;
    least = std::min(least, pairs[i].distance);
  }
  const auto direction_of = [&](std::size_t i) {
    return Direction{pairs[i].normal, pairs[i].distance, static_cast<std::uint32_t>(i)};
  };
  const double touching = 0x1p-40 * size_;  // smaller distances are rounding, and have no direction
  directions_.clear();
  if (least > touching) {
    add_patch(pairs, group, direction_of(first), lists_all_pairs_, pairs.size(), direction_of);
  } else {
    for (std::uint32_t i = 0; i < pairs.size(); ++i) {
      if (pairs[i].distance > touching) {
        directions_.push_back(direction_of(i));
        continue;
      }
      const std::span<const Vec3d> normals =
          touching_.find(pairs[i], objects_[group.a.index], objects_[group.b.index]);
      if (normals.empty() && group.a != group.b) return;  // the surfaces cross
      for (const Vec3d& normal : normals)
        directions_.push_back({normal, pairs[i].distance, i, true, normals.size() > 1});
    }
  }
  while (!directions_.empty()) {
    const Direction nearest = *std::ranges::min_element(
        directions_, {}, [](const Direction& d) { return std::pair(d.distance, d.pair); });
    add_patch(pairs, group, nearest, false, directions_.size(),
              [&](std::size_t i) -> const Direction& { return directions_[i]; });
  }
}

}  // namespace supple
