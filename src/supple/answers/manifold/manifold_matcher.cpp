#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "answers/manifold/manifold_pass.hpp"

namespace supple {
namespace {

Vec3d center_of(const ManifoldLists& lists, const Manifold& manifold) {
  Vec3d mean;
  for (std::uint32_t i = 0; i < manifold.point_count; ++i)
    mean += lists.points[manifold.first_point + i].position / manifold.point_count;
  return mean;
}

/// Gives a manifold the id of an old one, and its points those of the old points: first where both features
/// agree, then where one does, then the nearest.
void take_ids(const ManifoldLists& before, const Manifold& old, ManifoldLists& now, Manifold& manifold) {
  manifold.id = old.id;
  manifold.lasting = Lasting::stay;
  const std::span was = std::span(before.points).subspan(old.first_point, old.point_count);
  const std::span is = std::span(now.points).subspan(manifold.first_point, manifold.point_count);
  const auto* const old_names = before.names.data() + old.first_point;
  const auto* const names = now.names.data() + manifold.first_point;
  std::array<bool, 4> is_taken{};
  std::size_t left = std::min(was.size(), is.size());
  const auto for_each_pair = [&](const auto& visit) {
    for (std::size_t q = 0; q < is.size(); ++q) {
      for (std::size_t p = 0; p < was.size() && is[q].lasting == Lasting::begin; ++p) {
        if (!is_taken[p]) visit(p, q);
      }
    }
  };
  const auto take = [&](std::size_t p, std::size_t q) {
    is_taken[p] = true;
    is[q].id = was[p].id;
    is[q].lasting = Lasting::stay;
    --left;
  };
  for_each_pair([&](std::size_t p, std::size_t q) {
    if (old_names[p] == names[q]) take(p, q);
  });
  while (left > 0) {
    int fewest = 3;
    double nearest = 0;
    std::size_t best_p = 0, best_q = 0;
    for_each_pair([&](std::size_t p, std::size_t q) {
      const int different =
          (old_names[p][0] != names[q][0] ? 1 : 0) + (old_names[p][1] != names[q][1] ? 1 : 0);
      const double distance = squared_norm(is[q].position - was[p].position);
      if (different > fewest || (different == fewest && !(distance < nearest))) return;
      fewest = different;
      nearest = distance;
      best_p = p;
      best_q = q;
    });
    take(best_p, best_q);
  }
}

}  // namespace

void ManifoldMatcher::match(const ManifoldLists& before, ManifoldLists& now, std::uint64_t& last_id,
                            std::vector<EndedManifold>& ended) {
  ended.clear();
  // Both lists are in the order of objects.
  Range old, found;
  const auto objects = [](const Manifold& m) { return std::pair(m.a, m.b); };
  const auto find_end = [&](const std::vector<Manifold>& list, Range& range) {
    range.end = range.begin;
    while (range.end < list.size() && objects(list[range.end]) == objects(list[range.begin])) ++range.end;
  };
  const auto end = [&](const Manifold& manifold) { ended.push_back({manifold.a, manifold.b, manifold.id}); };
  while (found.begin < now.manifolds.size()) {
    find_end(now.manifolds, found);
    const auto of_found = objects(now.manifolds[found.begin]);
    while (old.begin < before.manifolds.size() && objects(before.manifolds[old.begin]) < of_found)
      end(before.manifolds[old.begin++]);
    find_end(before.manifolds, old);
    if (old.begin < old.end && objects(before.manifolds[old.begin]) != of_found) old.end = old.begin;
    old_of_.assign(found.end - found.begin, 0);
    new_of_.assign(old.end - old.begin, 0);
    if (old_of_.size() != 1 || new_of_.size() != 1) match_several(before, old, now, found);
    for (std::uint32_t i = found.begin; i < found.end; ++i) {
      Manifold& manifold = now.manifolds[i];
      const std::uint32_t of_old = old_of_[i - found.begin];
      if (of_old != none)
        take_ids(before, before.manifolds[old.begin + of_old], now, manifold);
      else
        manifold.id = ++last_id;
      for (ManifoldPoint& point : std::span(now.points).subspan(manifold.first_point, manifold.point_count)) {
        if (point.lasting == Lasting::begin) point.id = ++last_id;
      }
    }
    for (std::uint32_t i = old.begin; i < old.end; ++i) {
      if (new_of_[i - old.begin] == none) end(before.manifolds[i]);
    }
    found.begin = found.end;
    old.begin = old.end;
  }
  while (old.begin < before.manifolds.size()) end(before.manifolds[old.begin++]);
}

/// Matches those with most features in common first, then the nearest ones. A manifold is compared with few
/// of those that have a feature or nothing in common with it, so that the work stays linear.
void ManifoldMatcher::match_several(const ManifoldLists& before, const Range& old, const ManifoldLists& now,
                                    const Range& found) {
  constexpr std::uint32_t most_of_a_name = 16, most_without_one = 64;
  const bool is_one_object = now.manifolds[found.begin].a == now.manifolds[found.begin].b;
  const auto for_each_name = [&](const ManifoldLists& lists, std::uint32_t i, const auto& visit) {
    const Manifold& manifold = lists.manifolds[i];
    for (std::uint32_t p = 0; p < manifold.point_count; ++p) {
      const ManifoldLists::PointName& names = lists.names[manifold.first_point + p];
      // Within one object, the sides may be exchanged.
      if (names[0] != ManifoldLists::no_name) visit(0u, names[0]);
      if (names[1] != ManifoldLists::no_name) visit(is_one_object ? 0u : 1u, names[1]);
    }
  };
  std::ranges::fill(old_of_, none);
  std::ranges::fill(new_of_, none);
  if (new_of_.empty()) return;
  named_.clear();
  for (std::uint32_t i = old.begin; i < old.end; ++i) {
    for_each_name(before, i, [&](std::uint32_t side, std::uint64_t name) {
      named_.push_back({name, side, i});
    });
  }
  std::ranges::sort(named_);
  candidates_.clear();
  for (std::uint32_t i = found.begin; i < found.end; ++i) {
    const Vec3d center = center_of(now, now.manifolds[i]);
    const std::size_t first = candidates_.size();
    const auto add = [&](std::uint32_t other, int common) {
      const auto known =
          std::find_if(candidates_.begin() + static_cast<std::ptrdiff_t>(first), candidates_.end(),
                       [&](const Candidate& c) { return c.before == other; });
      if (known != candidates_.end())
        --known->minus_common;
      else
        candidates_.push_back(
            {-common, squared_norm(center_of(before, before.manifolds[other]) - center), other, i});
    };
    for_each_name(now, i, [&](std::uint32_t side, std::uint64_t name) {
      auto named = std::ranges::lower_bound(named_, NamedManifold{name, side, 0});
      for (std::uint32_t n = 0;
           n < most_of_a_name && named != named_.end() && named->name == name && named->side == side;
           ++n, ++named)
        add(named->manifold, 1);
    });
    if (candidates_.size() > first) continue;
    const std::uint32_t count = old.end - old.begin, middle = std::min(i - found.begin, count);
    const std::uint32_t begin = middle - std::min(middle, most_without_one / 2);
    for (std::uint32_t k = begin; k < std::min(begin + most_without_one, count); ++k) add(old.begin + k, 0);
  }
  std::ranges::sort(candidates_);
  for (const Candidate& candidate : candidates_) {
    std::uint32_t &of_old = new_of_[candidate.before - old.begin],
                  &of_new = old_of_[candidate.now - found.begin];
    if (of_old != none || of_new != none) continue;
    of_old = candidate.now - found.begin;
    of_new = candidate.before - old.begin;
  }
}

}  // namespace supple
