#include "manifold/manifold_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>
#include <utility>

#include <hwy/cache_control.h>

#include "geometry/vector.hpp"
#include "manifold/curves/curve_finder.hpp"
#include "queries/feature_name.hpp"
#include "supple/use_manifolds.hpp"

namespace supple {
namespace {

/// Normals of pairs in one patch are within 45 degrees of the normal of its nearest pair.
constexpr double least_cosine = 0.70710678118654757;

/// Bounds the rounding of coordinates that are scaled to at most 1/2.
constexpr double rounding = 0x1p-40;

constexpr double infinity = std::numeric_limits<double>::infinity();

std::uint64_t number_of(const FeatureName& name) {
  const std::uint64_t no_vertex = name.kind == FeatureKind::face ? 1 : 0;
  return (name.first | (0 - no_vertex)) << 32 | name.last;
}

Vec3d middle_of(const ProximityPair& pair) {
  return 0.5 * pair.point_a + 0.5 * pair.point_b;
}

/// Whether the point may be inside a solid. Without branches, because no answer is likely.
bool may_contain(const WorldObject& object, const Vec3d& point) {
  const Aabb& box = object.box();
  return object.options.solid & (point.x >= box.min.x) & (point.y >= box.min.y) & (point.z >= box.min.z) &
         (point.x <= box.max.x) & (point.y <= box.max.y) & (point.z <= box.max.z);
}

}  // namespace

/// Collects candidates, scaled so that no square overflows or vanishes.
class ManifoldFinder::Collector {
 public:
  /// There will be at most `most` candidates. `size` is the largest coordinate, and `deepest` the largest
  /// depth, if it is known.
  Collector(std::vector<Candidate>& candidates, std::size_t most, const Vec3d& normal, double size,
            double deepest)
      : scale_(size > 0 ? std::min(0.5 / size, 0x1p1000) : 1), deepest_(scale_ * deepest) {
    if (candidates.size() < most) candidates.resize(most);
    candidates_ = candidates.data();
    // "Building an Orthonormal Basis, Revisited" (Duff et al. 2017)
    const double sign = std::copysign(1.0, normal.z), w = -1 / (sign + normal.z),
                 xy = normal.x * normal.y * w;
    x_ = scale_ * Vec3d{1 + sign * normal.x * normal.x * w, sign * xy, -sign * normal.x};
    y_ = scale_ * Vec3d{xy, sign + normal.y * normal.y * w, -normal.y};
  }
  void add(const Vec3d& position, double depth, std::uint32_t record) {
    const double x = dot(x_, position), y = dot(y_, position), scaled_depth = scale_ * depth;
    // When several points are deepest, the one that is farthest in a direction comes first. Edges of meshes
    // are seldom at right angles to this direction, so the point is a corner.
    const double far = x + 0.618 * y;
    deepest_ = std::max(deepest_, scaled_depth);
    const double least = deepest_ - rounding;
    if (scaled_depth >= least && (far > farthest_ || depth_of_first_ < least)) {
      first_ = count_;
      farthest_ = far;
      depth_of_first_ = scaled_depth;
    }
    candidates_[count_++] = {x, y, scaled_depth, record};
  }
  std::span<const Candidate> candidates() const { return {candidates_, count_}; }
  std::size_t first() const { return first_; }

 private:
  Candidate* candidates_;
  std::size_t count_ = 0;
  double scale_;
  Vec3d x_, y_;
  double deepest_, farthest_ = -infinity, depth_of_first_ = -infinity;
  std::size_t first_ = 0;  // the first point to choose
};

void ManifoldFinder::find(const DetectResult& result, const World& world, bool lists_all_pairs) {
  world_ = &world;
  objects_.assign(world.slot_count(), {});
  lists_all_pairs_ = lists_all_pairs;
  next_.clear();
  std::uint32_t curve = 0;
  const auto add_curves_until = [&](const auto& is_before) {
    for (; curve < result.curves.size() && is_before(result.curves[curve]); ++curve) add_curve(result, curve);
  };
  for (const ContactGroup& group : result.proximity_groups) {
    const WorldObject& next =
        world[(&group == &result.proximity_groups.back() ? &group : &group + 1)->b.index];
    hwy::Prefetch(&next.box().min);
    hwy::Prefetch(&next.box().max.z);  // perhaps in the next cache line
    hwy::Prefetch(&next.options.solid);
    const auto pair = std::tie(group.a, group.b);
    add_curves_until([&](const IntersectionCurve& c) { return std::tie(c.a, c.b) < pair; });
    const bool intersects = curve < result.curves.size() && result.curves[curve].a == group.a &&
                            result.curves[curve].b == group.b;
    if (!intersects) add_patches(result, group);
  }
  add_curves_until([](const IntersectionCurve&) { return true; });
  next_last_id_ = last_id_;
  matcher_.match(lists_, next_, next_last_id_, next_ended_);
}

ManifoldObject& ManifoldFinder::object_of(ObjectId id) {
  ManifoldObject& listed = objects_[id.index];
  if (listed.object != nullptr) return listed;
  WorldObject& object = (*world_)[id.index];
  const Placement& placement = object.placement();
  listed = {{&object.octree(), nullptr, &placement.end(), placement.translation(), placement.is_mirrored(),
             object.inward_triangles()},
            &object,
            object.options.solid};
  return listed;
}

void ManifoldFinder::publish(DetectResult& result) {
  std::swap(lists_, next_);
  std::swap(ended_, next_ended_);
  last_id_ = next_last_id_;
  result.manifolds = lists_.manifolds;
  result.manifold_points = lists_.points;
  result.ended_manifolds = ended_;
}

void ManifoldFinder::keep(KeptLists& kept) {
  kept.keep(lists_.manifolds);
  kept.keep(lists_.points);
  kept.keep(ended_);
}

/// Chooses at most four candidates that span all of them, in the order around the normal; see `Manifold`.
ManifoldFinder::Choice ManifoldFinder::choose_points(std::span<const Candidate> candidates,
                                                     std::size_t first) {
  Choice choice{{first}, 1};
  auto& [chosen, count] = choice;
  // Takes the point with the largest value of those with more than `least`; of almost equal ones the deepest.
  const auto add_largest = [&](double least, double weight_of_depth, const auto& value_of) {
    if (count == candidates.size()) return false;
    std::size_t best = candidates.size();
    double most = -infinity;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double value = value_of(candidates[i]);
      // Without branches: -infinity or NaN, which is never the largest, where the value is not above the
      // least.
      const double weighed =
          std::min((value - least) * infinity, value + weight_of_depth * candidates[i].scaled_depth);
      best = weighed > most ? i : best;
      most = std::max(most, weighed);
    }
    if (best == candidates.size()) return false;
    chosen[count++] = best;
    return true;
  };
  // Twice the area of the triangle of two chosen points and another one, which is to the left.
  const auto area_of = [&](std::size_t from, std::size_t to) {
    const Candidate &p = candidates[chosen[from]], &q = candidates[chosen[to]];
    return [x = p.x, y = p.y, dx = q.x - p.x, dy = q.y - p.y](const Candidate& other) {
      return dx * (other.y - y) - dy * (other.x - x);
    };
  };
  const auto distance = [x = candidates[first].x, y = candidates[first].y](const Candidate& p) {
    return std::sqrt((p.x - x) * (p.x - x) + (p.y - y) * (p.y - y));
  };
  if (!add_largest(rounding, 1, distance)) return choice;
  const double length = distance(candidates[chosen[1]]);
  const double least = std::max(0x1p-10 * length, rounding) * length;
  const auto area = area_of(0, 1);
  if (!add_largest(least, length, [&](const Candidate& p) { return std::fabs(area(p)); })) return choice;
  if (area(candidates[chosen[2]]) < 0) std::swap(chosen[1], chosen[2]);
  const std::array added{area_of(1, 0), area_of(2, 1), area_of(0, 2)};
  if (!add_largest(least, length, [&](const Candidate& p) {
        return std::max({added[0](p), added[1](p), added[2](p)});
      }))
    return choice;
  // Between the ends of the edge that it is outside of.
  const Candidate& last = candidates[chosen[3]];
  if (added[2](last) > std::max(added[0](last), added[1](last))) return choice;
  std::swap(chosen[2], chosen[3]);
  if (added[0](last) > added[1](last)) std::swap(chosen[1], chosen[2]);
  return choice;
}

/// Reduces the candidates to the points of a manifold. `fill(record, point)` sets the position and the depth
/// of a point and returns the features there.
template <class Fill>
void ManifoldFinder::add_manifold(const Manifold& manifold, const Collector& found, const Fill& fill) {
  const std::span<const Candidate> candidates = found.candidates();
  const auto [chosen, count] = choose_points(candidates, found.first());
  Manifold& added = next_.manifolds.emplace_back(manifold);
  added.first_point = static_cast<std::uint32_t>(next_.points.size());
  added.point_count = count;
  for (const std::size_t i : std::span(chosen).first(count))
    next_.names.push_back(fill(candidates[i].record, next_.points.emplace_back()));
}

void ManifoldFinder::add_curve(const DetectResult& result, std::uint32_t index) {
  const IntersectionCurve& curve = result.curves[index];
  const auto contacts = result.contacts_of(curve);
  const auto points = result.points_of(curve);
  double size = largest_magnitude(curve.centroid);
  for (const Vec3d& point : points) size = std::max(size, largest_magnitude(point));
  // A contact has at most six points.
  const std::size_t most =
      points.size() + 6 * contacts.size() + curve.enclosed_count_a + curve.enclosed_count_b;
  Collector collector(candidates_, most, curve.normal, size, -infinity);
  named_.clear();
  const auto add = [&](const Vec3d& position, double depth, const ManifoldLists::PointName& name) {
    collector.add(position, depth, static_cast<std::uint32_t>(named_.size()));
    named_.push_back({position, depth, name});
  };
  const auto name_of = [&](std::uint32_t contact, std::uint64_t point) {
    const Contact& of = result.contacts[contact];
    return ManifoldLists::PointName{~point << 32 | of.triangle_a, ~point << 32 | of.triangle_b};
  };
  constexpr std::uint64_t any_point = 100;
  const double depth = curve.enclosed_count_a + curve.enclosed_count_b > 0 ? 0 : curve.depth;
  for (std::size_t k = 0; k < points.size(); ++k)
    add(points[k], depth, name_of(contacts[std::min(k, contacts.size() - 1)], any_point));
  // A branched curve has no points.
  for (const std::uint32_t i : contacts.first(points.empty() ? contacts.size() : 0)) {
    const auto of_contact = result.points_of(result.contacts[i]);
    for (std::uint32_t k = 0; k < of_contact.size(); ++k) add(of_contact[k].position, depth, name_of(i, k));
  }
  const std::size_t on_curve = named_.size();
  for (const ContactSide side : {ContactSide::a, ContactSide::b}) {
    const bool is_a = side == ContactSide::a;
    // The vertices that the curve encloses beyond its plane.
    for (const std::uint32_t v : result.enclosed_vertices_of(curve, side)) {
      const Vec3d position = object_of(is_a ? curve.a : curve.b).surface.position(v);
      const double height = dot(position - curve.centroid, is_a ? -curve.normal : curve.normal);
      ManifoldLists::PointName name{ManifoldLists::no_name, ManifoldLists::no_name};
      name[is_a ? 0 : 1] = number_of({FeatureKind::vertex, v, v});
      if (height > 0 && is_finite(position)) add(position, std::min(height, curve.depth), name);
    }
  }
  const bool is_flat = named_.size() == on_curve;
  const Manifold patch{curve.a,      curve.b,     0, {}, ManifoldSource::curve,
                       curve.normal, curve.depth, 0, 0,  index};
  add_manifold(patch, collector, [&](std::uint32_t record, ManifoldPoint& point) {
    point.position = named_[record].position;
    point.depth = is_flat ? curve.depth : named_[record].depth;
    return named_[record].name;
  });
}

/// Whether the elements of a pair are as far apart along a direction of the nearest pair as that pair, but
/// for rounding.
bool ManifoldFinder::is_kept_apart(const ProximityPair& pair, double distance, const Vec3d& direction) const {
  double low_a = dot(pair.point_a, direction), high_b = dot(pair.point_b, direction);
  double size = std::max(distance, size_);
  const auto is_apart = [&] { return low_a - high_b >= distance - 0x1p-40 * size; };
  const auto for_each_height = [&](ObjectId id, FeatureKind kind, const std::array<std::uint32_t, 2>& element,
                                   const auto& visit) {
    const WorldObject& object = (*world_)[id.index];
    Triangle vertices{element[0], element[1]};
    if (kind == FeatureKind::face) vertices = object.octree().user_triangle(element[0]);
    for (const std::uint32_t vertex : std::span(vertices).first(kind == FeatureKind::face ? 3 : 2)) {
      const Vec3d position = object.placement().position(vertex);
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
void ManifoldFinder::add_patch(std::span<const ProximityPair> pairs, const ContactGroup& group,
                               const Direction& nearest, bool has_nearest, std::size_t count,
                               const DirectionOf& direction_of) {
  Collector collector(candidates_, count, nearest.normal, size_, -nearest.distance);
  left_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const Direction& direction = direction_of(i);
    const ProximityPair& pair = pairs[direction.pair];
    if (dot(direction.normal, nearest.normal) >= least_cosine)
      collector.add(middle_of(pair), 0 - pair.distance, direction.pair);
    else if (direction.is_one_of_several || group.a == group.b ||
             !is_kept_apart(pair, nearest.distance, nearest.normal))
      left_.push_back(direction_of(i));
  }
  std::swap(directions_, left_);
  // The nearest points of two objects lie in the other one, or the way between them starts outside.
  const bool may_be_inside = !has_nearest ||
                             may_contain((*world_)[group.a.index], pairs[nearest.pair].point_b) ||
                             may_contain((*world_)[group.b.index], pairs[nearest.pair].point_a);
  if (may_be_inside && !nearest.touches &&
      touching_.starts_inside(pairs[nearest.pair], object_of(group.a), object_of(group.b)))
    return;
  Manifold patch{group.a, group.b, 0, {}, ManifoldSource::pairs, nearest.normal, 0 - nearest.distance};
  patch.record = group.first_contact + nearest.pair;
  add_manifold(patch, collector, [&](std::uint32_t record, ManifoldPoint& point) {
    const ProximityPair& pair = pairs[record];
    point.position = middle_of(pair);
    point.depth = 0 - pair.distance;
    return ManifoldLists::PointName{number_of({pair.kind_a, pair.element_a[0], pair.element_a[1]}),
                                    number_of({pair.kind_b, pair.element_b[0], pair.element_b[1]})};
  });
}

void ManifoldFinder::add_patches(const DetectResult& result, const ContactGroup& group) {
  const std::span<const ProximityPair> pairs = result.proximity_pairs_of(group);
  double least = infinity, size = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    size = std::max(size, largest_magnitude(pairs[i].point_a));
    first = pairs[i].distance < least ? i : first;
    least = std::min(least, pairs[i].distance);
  }
  size_ = size;
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
      const std::span<const Vec3d> normals = touching_.find(pairs[i], object_of(group.a), object_of(group.b));
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

void use_manifolds() {
  static constexpr ManifoldMethods methods{
      .curve_maker = []() -> std::unique_ptr<CurveMaker> { return std::make_unique<CurveFinder>(); },
      .manifold_maker = []() -> std::unique_ptr<ManifoldMaker> {
        return std::make_unique<ManifoldFinder>();
      }};
  set_manifold_methods(methods);
}

}  // namespace supple
