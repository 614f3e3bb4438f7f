#include "comparison/methods.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "geometry/aabb.hpp"
#include "geometry/vector.hpp"
#include "octree/morton_curve.hpp"

namespace supple {
namespace {

/// A cluster chooses among this many clusters before it and after it.
constexpr std::size_t reach = 8;
/// Two clusters merge if the surface of their common box is at most this many times the sum of theirs, unless
/// clusters would otherwise remain less than half full.
constexpr double most_growth = 1.1;
/// When fewer than one in so many choices are mutual, the next round merges along the curve. Otherwise a
/// surface that gets coarser in one direction could take a round for each triangle.
constexpr std::size_t least_mutual_share = 16;
constexpr std::uint32_t no_cluster = std::numeric_limits<std::uint32_t>::max();

struct Cluster {
  Aabb box;
  double surface = 0;  ///< half of that of the box
  std::uint32_t triangles = 1;
  std::uint32_t size = 1;             ///< clusters of the level below
  std::uint32_t first = 0, last = 0;  ///< of these, linked in their order
};

/// The clusters of one level: cluster c consists of the clusters `members[first[c]]` up to
/// `members[first[c + 1]]` of the level below, or of these triangles.
struct Level {
  std::vector<std::uint32_t> members, first, triangles;
};

/// A partner that a cluster could merge with.
struct Choice {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t distance = 0;  ///< the exclusive or of both places: equal costs then pair off evenly
  std::uint32_t partner = no_cluster;

  void consider(double other_cost, std::size_t place, std::size_t other) {
    if (other_cost > cost || (other_cost == cost && (place ^ other) > distance)) return;
    *this = {other_cost, place ^ other, static_cast<std::uint32_t>(other)};
  }
};

class BottomUpMerger {
 public:
  explicit BottomUpMerger(std::vector<Cluster> triangles) : clusters_(std::move(triangles)) {}

  std::size_t cluster_count() const { return clusters_.size(); }

  /// Merges clusters of up to `most` of the present clusters, which become the clusters of the next level.
  Level merge_level(std::uint32_t most) {
    for (std::uint32_t c = 0; c < clusters_.size(); ++c) {
      clusters_[c].size = 1;
      clusters_[c].first = clusters_[c].last = c;
    }
    next_.assign(clusters_.size(), no_cluster);
    bool along_curve = false, any_growth = false;
    while (!any_growth || clusters_.size() * (std::uint64_t{most} + 1) > 2 * next_.size()) {
      const std::size_t choices = choose_partners(most, along_curve, any_growth);
      if (choices == 0 && any_growth) break;
      any_growth = any_growth || choices == 0;
      const std::size_t mutual = 2 * merge_mutual_choices();
      along_curve = !along_curve && mutual * least_mutual_share < choices;
    }
    Level level;
    level.members.reserve(next_.size());
    for (const Cluster& cluster : clusters_) {
      level.first.push_back(static_cast<std::uint32_t>(level.members.size()));
      level.triangles.push_back(cluster.triangles);
      for (std::uint32_t m = cluster.first; m != no_cluster; m = next_[m]) level.members.push_back(m);
    }
    level.first.push_back(static_cast<std::uint32_t>(level.members.size()));
    return level;
  }

 private:
  /// Returns the number of clusters that found a partner.
  std::size_t choose_partners(std::uint32_t most, bool along_curve, bool any_growth) {
    choices_.assign(clusters_.size(), {});
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
      const std::size_t end = std::min(clusters_.size(), c + reach + 1);
      for (std::size_t d = c + 1; d < end; ++d) {
        if (clusters_[c].size + clusters_[d].size > most) continue;
        const double surface = merged_surface(clusters_[c], clusters_[d]);
        if (!any_growth && surface > most_growth * (clusters_[c].surface + clusters_[d].surface)) continue;
        choices_[c].consider(along_curve ? 0 : surface, c, d);
        choices_[d].consider(along_curve ? 0 : surface, d, c);
      }
    }
    return static_cast<std::size_t>(
        std::ranges::count_if(choices_, [](const Choice& choice) { return choice.partner != no_cluster; }));
  }

  /// Finite, so that clusters compare in a fixed order even where surfaces overflow.
  static double merged_surface(const Cluster& c, const Cluster& d) {
    Aabb box = c.box;
    extend(box, d.box);
    constexpr double largest = std::numeric_limits<double>::max();
    const double surface = half_surface(box);
    return surface < largest ? surface : largest;
  }

  /// Returns the number of merged pairs. The pair of the least choice of all is mutual, so there is one.
  std::size_t merge_mutual_choices() {
    std::size_t count = 0;
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
      const std::uint32_t d = choices_[c].partner;
      Cluster cluster = clusters_[c];
      if (d != no_cluster && choices_[d].partner == c) {
        if (d < c) continue;
        const Cluster& other = clusters_[d];
        extend(cluster.box, other.box);
        cluster.surface = half_surface(cluster.box);
        cluster.triangles += other.triangles;
        cluster.size += other.size;
        next_[cluster.last] = other.first;
        cluster.last = other.last;
      }
      clusters_[count++] = cluster;
    }
    const std::size_t merged = clusters_.size() - count;
    clusters_.resize(count);
    return merged;
  }

  std::vector<Cluster> clusters_;
  std::vector<std::uint32_t> next_;  ///< the next member of the same cluster
  std::vector<Choice> choices_;
};

/// Makes the octree from the clusters of all levels.
class BottomUpSplitter {
 public:
  /// `places` are the triangles along the curve. `levels` are the clusters, those of triangles first; the
  /// last level has at most one cluster.
  BottomUpSplitter(std::span<const CurvePlace> places, std::span<const Level> levels, std::uint32_t deepest)
      : places_(places), deepest_(deepest), begins_(levels.size()) {
    std::vector<std::uint32_t> members;
    order_.assign(places.empty() ? 0 : 1, 0);
    for (std::size_t l = levels.size(); l-- > 0;) {
      const Level& level = levels[l];
      std::uint32_t begin = 0;
      members.clear();
      for (const std::uint32_t c : order_) {
        begins_[l].push_back(begin);
        begin += level.triangles[c];
        members.insert(members.end(), level.members.begin() + level.first[c],
                       level.members.begin() + level.first[c + 1]);
      }
      begins_[l].push_back(begin);
      std::swap(order_, members);
    }
  }

  bool should_split(TriangleRange range, std::uint32_t level) const {
    return level < deepest_ && *end_of_first(0, range) < range.end;
  }

  /// The children of a node are the clusters of the highest level that divides its range.
  void split(std::span<NodeDivision> nodes, std::uint32_t) const {
    for (NodeDivision& node : nodes) {
      const TriangleRange range = node.range;
      std::size_t level = begins_.size() - 1;
      while (*end_of_first(level, range) >= range.end) --level;
      auto end = end_of_first(level, range);
      for (std::uint32_t begin = range.begin; begin < range.end; begin = *end++)
        node.push_child({begin, *end});
    }
  }

  /// Along the curve, so that triangles that are tested together are near each other.
  std::vector<std::uint32_t> finish(std::span<const TriangleRange> leaves) {
    for (const TriangleRange leaf : leaves)
      std::ranges::sort(std::span(order_).subspan(leaf.begin, leaf.size()));
    for (std::uint32_t& place : order_) place = places_[place].triangle;
    return std::move(order_);
  }

 private:
  /// Where the level's first cluster of the range ends.
  std::vector<std::uint32_t>::const_iterator end_of_first(std::size_t level, TriangleRange range) const {
    return std::ranges::upper_bound(begins_[level], range.begin);
  }

  std::span<const CurvePlace> places_;
  std::uint32_t deepest_;             ///< level
  std::vector<std::uint32_t> order_;  ///< the places of the triangles
  /// By level: the first triangle of each cluster, then the number of triangles.
  std::vector<std::vector<std::uint32_t>> begins_;
};

/// Sorts again where triangles have the same code although their centres differ, so that a vertex far away
/// does not cost the others their order.
void sort_finely(std::span<CurvePlace> places, std::span<const Vec3d> at, std::vector<CurvePlace>& memory) {
  sort_along_curve(places, at, memory);
  if (places.empty() || places.front().code == places.back().code) return;
  for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
    while (end < places.size() && places[end].code == places[begin].code) ++end;
    if (end - begin > reach) sort_finely(places.subspan(begin, end - begin), at, memory);
  }
}

Aabb box_of(const PositionsView& positions, const Triangle& triangle) {
  Aabb box;
  for (const std::uint32_t vertex : triangle) {
    if (!is_finite(positions[vertex])) return {};
    extend(box, positions[vertex]);
  }
  return box;
}

}  // namespace

OctreeTopology build_bottom_up_octree(const PositionsView& positions, std::span<const Triangle> triangles,
                                      std::span<const Vec3d> centers, const ObjectOctreeOptions& options) {
  std::vector<CurvePlace> places, memory;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) places.push_back({0, t});
  sort_finely(places, centers, memory);
  std::vector<Cluster> clusters;
  clusters.reserve(places.size());
  for (const CurvePlace& place : places) {
    const Aabb box = box_of(positions, triangles[place.triangle]);
    clusters.push_back({.box = box, .surface = half_surface(box)});
  }
  BottomUpMerger merger(std::move(clusters));
  std::vector<Level> levels{merger.merge_level(options.leaf_size)};
  while (merger.cluster_count() > 1) levels.push_back(merger.merge_level(options.arity));
  return build_octree(static_cast<std::uint32_t>(triangles.size()),
                      BottomUpSplitter(places, levels, deepest_level(options)));
}

}  // namespace supple
