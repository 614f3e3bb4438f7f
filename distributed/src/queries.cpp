// Queries. Distances of objects: one rank gets both objects of a pair, whole.
//
// Closest points: the rank whose region contains a point bounds its distance by the boxes of clusters there.
// The ranks whose regions the ball of this radius meets find the nearest triangle of the clusters in the
// ball, each cluster on the rank whose region contains the lower corner of what its box and that of the ball
// share. The rank of the point takes the nearest of all.

#include <algorithm>
#include <array>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "core/error.hpp"
#include "core/sort_once.hpp"
#include "core/stop_signal.hpp"
#include "distributed_implementation.hpp"
#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "queries/check_queries.hpp"
#include "queries/queries.hpp"

namespace supple {

struct DistributedScene::Implementation::PointQuery {
  Vec3d point;
  double radius = 0;
  std::uint64_t index = 0;  ///< of the point on its rank
  std::int32_t rank = 0;
};

struct DistributedScene::Implementation::Candidate {
  std::uint64_t index = 0;
  ClosestPoint closest;
  std::array<Vec3d, 3> corners;
};

namespace {

namespace geometry = boost::geometry;
using TreePoint = geometry::model::point<double, 3, geometry::cs::cartesian>;
using TreeBox = geometry::model::box<TreePoint>;

/// More than what sums and roots of doubles lose.
constexpr double slack = 1 + 0x1p-40;

double farthest_distance(const Vec3d& p, const Aabb& box) {
  Vec3d way;
  for (int axis = 0; axis < 3; ++axis)
    way[axis] = std::max(std::fabs(p[axis] - box.min[axis]), std::fabs(p[axis] - box.max[axis]));
  return scaled_norm(way) * slack;
}

bool is_near(const Vec3d& p, double radius, const Aabb& box) {
  Vec3d way;
  for (int axis = 0; axis < 3; ++axis)
    way[axis] = std::max({0.0, box.min[axis] - p[axis], p[axis] - box.max[axis]});
  return !(scaled_norm(way) > radius * slack);
}

Aabb box_of_ball(const Vec3d& p, double radius) {
  const Vec3d to_corner{radius, radius, radius};
  Aabb box;
  extend(box, p - to_corner);
  extend(box, p + to_corner);
  return box;
}

TreePoint tree_point(const Vec3d& p) {
  return {p.x, p.y, p.z};
}

/// Infinite bounds, with which the tree cannot compute, become larger than any other float.
TreeBox tree_box(const Aabb& box) {
  const auto corner = [](const Vec3f& p) {
    const auto finite = [](float x) { return std::clamp(double{x}, -1e39, 1e39); };
    return TreePoint(finite(p.x), finite(p.y), finite(p.z));
  };
  return {corner(box.min), corner(box.max)};
}

}  // namespace

/// The clusters that a filter lets through, in a tree of their boxes.
class DistributedScene::Implementation::SeenClusters {
 public:
  SeenClusters(std::span<const Unit> clusters, const QueryFilter& filter) : clusters_(clusters) {
    std::vector<Entry> entries;
    for (std::uint32_t i = 0; i < clusters.size(); ++i) {
      const Unit& unit = clusters[i];
      if (unit.box.empty() || (unit.group & filter.mask) == 0) continue;
      if (filter.object && *filter.object != unit.name.object) continue;
      entries.push_back({tree_box(unit.box), i});
      extend(box, unit.box);
    }
    tree_ = Tree(entries);
  }

  /// A distance from the point, at most `radius`, within which a triangle is.
  double bound(const Vec3d& point, double radius) const {
    if (tree_.empty()) return radius;  // which `nearest` does not take
    // By ascending distance of the boxes.
    for (auto near =
             tree_.qbegin(geometry::index::nearest(tree_point(point), static_cast<unsigned>(tree_.size())));
         near != tree_.qend(); ++near) {
      const Aabb& of = clusters_[near->second].box;
      if (!is_near(point, radius, of)) break;
      radius = std::min(radius, farthest_distance(point, of));
    }
    return radius;
  }
  /// Calls `visit(cluster)` for each one that the ball meets.
  template <class Visit>
  void for_each_near(const Vec3d& point, double radius, const Visit& visit) const {
    const TreeBox ball = tree_box(box_of_ball(point, radius));
    for (auto near = tree_.qbegin(geometry::index::intersects(ball)); near != tree_.qend(); ++near) {
      if (is_near(point, radius, clusters_[near->second].box)) visit(near->second);
    }
  }

  Aabb box;  ///< of all

 private:
  using Entry = std::pair<TreeBox, std::uint32_t>;
  using Tree = geometry::index::rtree<Entry, geometry::index::rstar<8>>;

  std::span<const Unit> clusters_;
  Tree tree_;
};

/// Collective: gives each point to the rank whose region contains it, with a radius in which a triangle is.
/// Returns the points whose balls meet the region of this rank.
std::vector<DistributedScene::Implementation::PointQuery> DistributedScene::Implementation::query_points(
    std::span<const Vec3d> points, const SeenClusters& seen) {
  Aabb all = seen.box;
  std::vector<double> bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.push_back(-double{all.min[axis]});
    bounds.push_back(double{all.max[axis]});
  }
  ranks.largest(bounds);
  for (int axis = 0; axis < 3; ++axis) {
    all.min[axis] = static_cast<float>(-bounds[static_cast<std::size_t>(2 * axis)]);
    all.max[axis] = static_cast<float>(bounds[static_cast<std::size_t>(2 * axis) + 1]);
  }
  if (all.empty()) return {};
  const auto read_points = [&](const auto& read) {
    inbox_.for_each([&](Reader& from, int) {
      while (!from.is_done()) read(from.get<PointQuery>());
    });
  };
  outbox_.clear();
  ranks.together([&] {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!is_finite(points[i])) continue;
      const std::span<const int> homes = regions_.ranks_of(box_of_ball(points[i], 0));
      outbox_.to(*std::min_element(homes.begin(), homes.end()))
          .put(PointQuery{points[i], farthest_distance(points[i], all), i, ranks.rank()});
    }
  });
  ranks.exchange(outbox_, inbox_);
  outbox_.clear();
  ranks.together([&] {
    read_points([&](PointQuery query) {
      query.radius = seen.bound(query.point, query.radius);
      for (const int rank : regions_.ranks_of(box_of_ball(query.point, query.radius)))
        outbox_.to(rank).put(query);
    });
  });
  ranks.exchange(outbox_, inbox_);
  std::vector<PointQuery> queries;
  ranks.together([&] { read_points([&](const PointQuery& query) { queries.push_back(query); }); });
  return queries;
}

/// Needs the clusters in the balls of the points, and forgets points without one here.
void DistributedScene::Implementation::need_clusters_near(std::vector<PointQuery>& points,
                                                          const SeenClusters& seen) {
  needed_.clear();
  tested_.clear();
  std::vector<double> work(clusters_.size(), 0);
  std::erase_if(points, [&](const PointQuery& query) {
    const Aabb ball = box_of_ball(query.point, query.radius);
    bool has_any = false;
    seen.for_each_near(query.point, query.radius, [&](std::uint32_t i) {
      const Aabb shared = shared_box(ball, clusters_[i].box);
      if (!region_.contains(Vec3d{shared.min.x, shared.min.y, shared.min.z})) return;
      work[i] += 1;
      has_any = true;
    });
    return !has_any;
  });
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    if (work[i] > 0) needed_.push_back({clusters_[i].name, work[i]});
  }
}

/// Finds the nearest triangle of this rank for each point, and sends it to the rank of the point.
void DistributedScene::Implementation::send_nearest(std::span<const PointQuery> points,
                                                    const ClosestOptions& closest_options) {
  outbox_.clear();
  ClosestOptions here = closest_options;
  if (here.filter.object) {
    here.filter.object = local_.local_object(*here.filter.object);
    if (!here.filter.object) return;
  }
  std::vector<Vec3d> places;
  for (const PointQuery& query : points) places.push_back(query.point);
  std::vector<std::optional<ClosestPoint>> found(points.size());
  Queries(world()).closest(places, found, here);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!found[i]) continue;
    Candidate candidate{points[i].index, *found[i], {}};
    const WorldObject& object = world()[found[i]->object.index];
    const Triangle corners = object.octree().user_triangle(found[i]->triangle);
    for (std::size_t c = 0; c < 3; ++c) candidate.corners[c] = object.placement().position(corners[c]);
    candidate.closest.object = user(found[i]->object);
    candidate.closest.triangle = local_.face(found[i]->object, found[i]->triangle);
    outbox_.to(points[i].rank).put(candidate);
  }
}

void DistributedScene::Implementation::closest(std::span<const Vec3d> points,
                                               std::span<std::optional<ClosestPoint>> results,
                                               const ClosestOptions& closest_options) {
  const QueryFilter& seen = closest_options.filter;
  ranks.begin([&] {
    check_counts(points.size(), results.size(), "closest");
    check_distance(closest_options.max_distance, "closest");
    if (closest_options.signed_distance)
      fail("DistributedScene::closest: signed_distance is not supported; take the object to one Scene");
    return call("closest")
        .add("object", seen.object)
        .add("mask", seen.mask)
        .add("max_distance", closest_options.max_distance);
  });
  question_ = {};
  by_objects_ = false;
  growth_ = 0;
  exchange_units();
  if (seen.object && !ranks.any(homes_.contains(*seen.object)))
    fail("closest: object " + std::to_string(seen.object->index) + " (generation " +
         std::to_string(seen.object->generation) + ") is not in the scene");
  std::optional<SeenClusters> clusters;
  ranks.together([&] { clusters.emplace(clusters_, seen); });
  std::vector<PointQuery> queries = query_points(points, *clusters);
  ranks.together([&] { need_clusters_near(queries, *clusters); });
  fetch_clusters();
  ranks.together([&] { send_nearest(queries, closest_options); });
  ranks.exchange(outbox_, inbox_);
  ranks.together([&] {
    std::vector<Candidate> candidates;
    inbox_.for_each([&](Reader& from, int) {
      while (!from.is_done()) candidates.push_back(from.get<Candidate>());
    });
    const auto key = [](const Candidate& c) {
      return std::tuple(c.index, c.closest.object, c.closest.triangle);
    };
    std::sort(candidates.begin(), candidates.end(),
              [&](const Candidate& p, const Candidate& q) { return key(p) < key(q); });
    std::fill(results.begin(), results.end(), std::nullopt);
    for (auto first = candidates.begin(); first != candidates.end();) {
      const auto end =
          std::find_if(first, candidates.end(), [&](const Candidate& c) { return c.index != first->index; });
      results[first->index] = nearest_of({first, end}, points[first->index]);
      first = end;
    }
  });
  end_step();
}

/// Exact arithmetic decides between distances that round alike.
ClosestPoint DistributedScene::Implementation::nearest_of(std::span<const Candidate> candidates,
                                                          const Vec3d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& c : candidates) least = std::min(least, c.closest.distance);
  std::vector<const Candidate*> nearest;  // in canonical order
  for (const Candidate& c : candidates) {
    if (!(c.closest.distance > least * slack)) nearest.push_back(&c);
  }
  if (nearest.size() == 1) return nearest[0]->closest;
  World corners({.threads = 1});
  for (const Candidate* const c : nearest)
    corners.add(std::span<const Vec3d>(c->corners), std::array{Triangle{0, 1, 2}}, {}, "");
  std::optional<ClosestPoint> found;
  Queries(corners).closest({&point, 1}, {&found, 1}, {});
  return nearest[found ? found->object.index : 0]->closest;
}

std::vector<ProximityPair> DistributedScene::Implementation::distances(double max_distance,
                                                                       const CallLimits& limits) {
  ranks.begin([&] {
    check_distance(max_distance, "distances");
    return call("distances").add("max_distance", max_distance);
  });
  // Rounded up by more than the sums of boxes can lose.
  const double growth = 0.5 * max_distance * (1 + 0x1p-19) + std::numeric_limits<float>::min();
  question_ = {};
  prepare(true, std::min(growth, double{std::numeric_limits<float>::max()}));
  ranks.together([&] {
    clear_lists();
    const std::vector<ProximityPair> nearest = Queries(world()).distances(max_distance, limits);
    // The other ranks would take an empty list for an answer.
    if (stop_of(limits).stop_requested()) fail("distances: it was stopped, so there is no answer");
    DetectResult found;
    found.proximity_pairs = nearest;
    send_all(found, "proximity_pairs");
  });
  send_lists();
  end_step();
  DetectResult all;
  lists_.list(all);
  return {all.proximity_pairs.begin(), all.proximity_pairs.end()};
}

}  // namespace supple
