#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "answers/manifold/manifold_pass.hpp"
#include "core/sort_once.hpp"

namespace supple {
namespace {

Vec3d center_of(const ManifoldLists& lists, const Manifold& manifold) {
  Vec3d mean;
  for (std::uint32_t i = 0; i < manifold.point_count; ++i)
    mean += lists.points[manifold.first_point + i].position / manifold.point_count;
  return mean;
}

}  // namespace

void ManifoldMatcher::match(const ManifoldLists& before, ManifoldLists& now, std::uint64_t& last_id,
                            std::vector<EndedManifold>& ended) {
  old_of_.assign(now.manifolds.size(), none);
  new_of_.assign(before.manifolds.size(), none);
  match_single(before, now);
  match_by_names(before, now);
  match_by_places(before, now);
  for (std::size_t i = 0; i < now.manifolds.size(); ++i) {
    Manifold& manifold = now.manifolds[i];
    manifold.lasting = Lasting::begin;
    if (old_of_[i] != none) {
      const Manifold& old = before.manifolds[old_of_[i]];
      manifold.id = old.id;
      manifold.lasting = Lasting::stay;
      match_points(before, old, now, manifold);
    } else {
      manifold.id = ++last_id;
    }
    for (std::uint32_t p = 0; p < manifold.point_count; ++p) {
      ManifoldPoint& point = now.points[manifold.first_point + p];
      if (point.lasting == Lasting::begin) point.id = ++last_id;
    }
  }
  ended.clear();
  for (std::size_t i = 0; i < before.manifolds.size(); ++i) {
    const Manifold& old = before.manifolds[i];
    if (new_of_[i] == none) ended.push_back({old.a, old.b, old.id});
  }
  std::sort(ended.begin(), ended.end(),
            [](const EndedManifold& p, const EndedManifold& q) { return p.id < q.id; });
}

/// Matches the only manifold of two objects with their only one of the step before. Both lists are in the
/// order of objects.
void ManifoldMatcher::match_single(const ManifoldLists& before, const ManifoldLists& now) {
  const auto objects = [](const Manifold& manifold) { return std::tie(manifold.a, manifold.b); };
  const auto is_single = [&](const std::vector<Manifold>& list, std::size_t i) {
    return (i == 0 || objects(list[i - 1]) != objects(list[i])) &&
           (i + 1 == list.size() || objects(list[i + 1]) != objects(list[i]));
  };
  std::uint32_t old = 0;
  for (std::uint32_t i = 0; i < now.manifolds.size(); ++i) {
    while (old < before.manifolds.size() && objects(before.manifolds[old]) < objects(now.manifolds[i])) ++old;
    if (old == before.manifolds.size()) return;
    if (objects(before.manifolds[old]) != objects(now.manifolds[i]) || !is_single(before.manifolds, old) ||
        !is_single(now.manifolds, i))
      continue;
    new_of_[old] = i;
    old_of_[i] = old;
  }
}

/// Matches other manifolds with features in common, first those with most of them. A feature of many
/// manifolds says little, and is left out, so that the work stays linear.
void ManifoldMatcher::match_by_names(const ManifoldLists& before, const ManifoldLists& now) {
  constexpr std::ptrdiff_t most_manifolds = 16;
  const auto for_each_key = [](const ManifoldLists& lists, std::uint32_t i, const auto& visit) {
    const Manifold& manifold = lists.manifolds[i];
    for (std::uint32_t p = 0; p < manifold.point_count; ++p) {
      const ManifoldLists::PointName& name = lists.names[manifold.first_point + p];
      for (std::uint32_t side = 0; side < 2; ++side) {
        // Within one object, the sides may be exchanged.
        if (name.has_name[side])
          visit(Key{manifold.a, manifold.b, manifold.a == manifold.b ? 0 : side, name.names[side]});
      }
    }
  };
  named_.clear();
  for (std::uint32_t i = 0; i < before.manifolds.size(); ++i) {
    if (new_of_[i] == none) for_each_key(before, i, [&](const Key& key) { named_.push_back({key, i}); });
  }
  sort_once(named_);
  common_.clear();
  for (std::uint32_t i = 0; i < now.manifolds.size(); ++i) {
    if (old_of_[i] != none) continue;
    for_each_key(now, i, [&](const Key& key) {
      const auto first =
          std::lower_bound(named_.begin(), named_.end(), key,
                           [](const NamedManifold& named, const Key& k) { return named.key < k; });
      const auto last = std::upper_bound(
          first, named_.end(), key, [](const Key& k, const NamedManifold& named) { return k < named.key; });
      if (last - first > most_manifolds) return;
      for (auto named = first; named != last; ++named) common_.push_back({named->manifold, i, 1});
    });
  }
  std::sort(common_.begin(), common_.end());
  std::size_t count = 0;
  for (const Common& one : common_) {
    if (count > 0 && common_[count - 1].before == one.before && common_[count - 1].now == one.now)
      ++common_[count - 1].count;
    else
      common_[count++] = one;
  }
  common_.resize(count);
  std::sort(common_.begin(), common_.end(), [](const Common& p, const Common& q) {
    return std::tuple(q.count, p.before, p.now) < std::tuple(p.count, q.before, q.now);
  });
  for (const Common& one : common_) {
    if (new_of_[one.before] != none || old_of_[one.now] != none) continue;
    new_of_[one.before] = one.now;
    old_of_[one.now] = one.before;
  }
}

/// Matches each other manifold with the nearest one of the same objects that is left.
void ManifoldMatcher::match_by_places(const ManifoldLists& before, const ManifoldLists& now) {
  centers_.clear();
  for (std::uint32_t i = 0; i < before.manifolds.size(); ++i) {
    const Manifold& old = before.manifolds[i];
    if (new_of_[i] == none) centers_.push_back({old.a, old.b, center_of(before, old), i});
  }
  const auto place = [](const Center& c) { return std::tuple(c.a, c.b, c.at.x, c.manifold); };
  std::sort(centers_.begin(), centers_.end(),
            [&](const Center& p, const Center& q) { return place(p) < place(q); });
  for (std::uint32_t i = 0; i < now.manifolds.size(); ++i) {
    const Manifold& manifold = now.manifolds[i];
    if (old_of_[i] != none) continue;
    const Vec3d at = center_of(now, manifold);
    const auto start =
        std::lower_bound(centers_.begin(), centers_.end(), Center{manifold.a, manifold.b, at, 0},
                         [&](const Center& p, const Center& q) { return place(p) < place(q); });
    std::uint32_t nearest = none;
    double best = std::numeric_limits<double>::infinity();
    // Returns false when all further ones are farther away.
    const auto look_at = [&](const Center& c) {
      if (c.a != manifold.a || c.b != manifold.b) return false;
      const double along = c.at.x - at.x;
      if (nearest != none && along * along > best) return false;
      const double distance = squared_norm(c.at - at);
      const bool is_nearer = nearest == none || distance < best || (distance == best && c.manifold < nearest);
      if (new_of_[c.manifold] == none && is_nearer) {
        best = distance;
        nearest = c.manifold;
      }
      return true;
    };
    for (auto c = start; c != centers_.end() && look_at(*c); ++c) {
    }
    for (auto c = start; c != centers_.begin() && look_at(*std::prev(c)); --c) {
    }
    if (nearest == none) continue;
    new_of_[nearest] = i;
    old_of_[i] = nearest;
  }
}

/// Gives the points of a manifold the ids of those of the old one: first where all features agree, then where
/// one does, then the nearest.
void ManifoldMatcher::match_points(const ManifoldLists& before, const Manifold& old, ManifoldLists& now,
                                   const Manifold& manifold) {
  struct Match {
    int missing = 0;  // features that differ
    double distance = 0;
    std::uint32_t before = 0, now = 0;
    auto order() const { return std::tuple(missing, distance, before, now); }
  };
  std::array<bool, 4> is_taken{};
  const auto take = [&](std::uint32_t from, std::uint32_t to) {
    ManifoldPoint& point = now.points[to];
    bool& taken = is_taken[from - old.first_point];
    if (taken || point.lasting == Lasting::stay) return;
    taken = true;
    point.id = before.points[from].id;
    point.lasting = Lasting::stay;
  };
  const auto for_each_pair = [&](const auto& visit) {
    for (std::uint32_t p = 0; p < old.point_count; ++p) {
      for (std::uint32_t q = 0; q < manifold.point_count; ++q)
        visit(old.first_point + p, manifold.first_point + q);
    }
  };
  for_each_pair([&](std::uint32_t from, std::uint32_t to) {
    if (before.names[from] == now.names[to]) take(from, to);
  });
  std::array<Match, 16> matches;
  std::size_t count = 0;
  for_each_pair([&](std::uint32_t from, std::uint32_t to) {
    if (is_taken[from - old.first_point] || now.points[to].lasting == Lasting::stay) return;
    const ManifoldLists::PointName &was = before.names[from], &is = now.names[to];
    Match& match = matches[count++];
    match = {2, squared_norm(before.points[from].position - now.points[to].position), from, to};
    for (std::size_t side = 0; side < 2; ++side) {
      if (was.has_name[side] && is.has_name[side] && was.names[side] == is.names[side]) --match.missing;
    }
  });
  std::sort(matches.begin(), matches.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Match& p, const Match& q) { return p.order() < q.order(); });
  for (const Match& match : std::span(matches).first(count)) take(match.before, match.now);
}

}  // namespace supple
