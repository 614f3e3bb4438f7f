#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

#include "manifold/manifold_finder.hpp"

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
  // Without branches, because nothing about them is likely. The smallest key is the next match: of those with
  // the fewest different features the nearest, except that all with the same features are equal.
  constexpr std::uint64_t taken = ~std::uint64_t{0};
  std::array<std::uint64_t, 16> keys;
  keys.fill(taken);
  for (std::size_t q = 0; q < is.size(); ++q) {
    for (std::size_t p = 0; p < was.size(); ++p) {
      const std::uint64_t differs_a = old_names[p][0] != names[q][0],
                          differs_b = old_names[p][1] != names[q][1];
      const auto distance = std::bit_cast<std::uint64_t>(squared_norm(is[q].position - was[p].position));
      keys[4 * q + p] = ((0 - (differs_a | differs_b)) & (distance + 1)) | (differs_a & differs_b) << 63;
    }
  }
  for (std::size_t left = std::min(was.size(), is.size()); left > 0; --left) {
    // A tournament, because a loop over the keys would wait for each comparison.
    std::array<std::size_t, 16> best;
    std::iota(best.begin(), best.end(), 0);
    for (std::size_t count = keys.size() / 2; count > 0; count /= 2) {
      for (std::size_t i = 0; i < count; ++i)
        best[i] = keys[best[2 * i + 1]] < keys[best[2 * i]] ? best[2 * i + 1] : best[2 * i];
    }
    const std::size_t p = best[0] % 4, q = best[0] / 4;
    is[q].id = was[p].id;
    is[q].lasting = Lasting::stay;
    for (std::size_t k = 0; k < 4; ++k) keys[4 * q + k] = keys[4 * k + p] = taken;
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
    const bool are_one = found.end - found.begin == 1 && old.end - old.begin == 1;
    if (!are_one) match_several(before, old, now, found);
    for (std::uint32_t i = found.begin; i < found.end; ++i) {
      Manifold& manifold = now.manifolds[i];
      const std::uint32_t of_old = are_one ? 0 : old_of_[i - found.begin];
      if (of_old != none)
        take_ids(before, before.manifolds[old.begin + of_old], now, manifold);
      else
        manifold.id = ++last_id;
      for (ManifoldPoint& point : std::span(now.points).subspan(manifold.first_point, manifold.point_count)) {
        last_id += point.lasting == Lasting::begin ? 1 : 0;
        point.id = point.lasting == Lasting::begin ? last_id : point.id;
      }
    }
    for (std::uint32_t i = old.begin; i < old.end && !are_one; ++i) {
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
  old_of_.assign(found.end - found.begin, none);
  new_of_.assign(old.end - old.begin, none);
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
