#include "files/polygon/outline.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <queue>
#include <utility>

#include "files/polygon/corner_index.hpp"

namespace supple {
namespace {

class EarClipper {
 public:
  EarClipper(const OutlineView& view, const OutlineWinding& winding)
      : view_(&view),
        winding_(winding),
        count_(static_cast<std::uint32_t>(view.size())),
        previous_(count_),
        next_(count_),
        rank_(count_, ranks),
        waiting_(count_),
        is_settled_(count_, false),
        index_(view) {
    if (winding.crosses) tests_left_ = 100 * std::uint64_t{count_};
    for (std::uint32_t corner = 0; corner < count_; ++corner) {
      previous_[corner] = corner == 0 ? count_ - 1 : corner - 1;
      next_[corner] = corner + 1 == count_ ? 0 : corner + 1;
    }
    for (std::uint32_t corner = 0; corner < count_; ++corner) classify(corner);
  }

  /// Returns false when a triangle turns to the right.
  bool clip(std::span<Triangle> triangles) {
    bool all_turn_left = true;
    std::size_t done = 0;
    const auto cut_triangle = [&](std::uint32_t corner) {
      triangles[done++] = {previous_[corner], corner, next_[corner]};
      all_turn_left = all_turn_left && rank_of(corner) != reflex;
      cut(corner);
    };
    if (!winding_.crosses) {
      std::uint32_t corner = 0;
      while (done < triangles.size() && pop(spike, corner)) cut_triangle(corner);
      link_places();
    }
    while (done + fills_.size() < triangles.size()) cut_triangle(next_corner());
    std::copy(fills_.begin(), fills_.end(), triangles.begin() + static_cast<std::ptrdiff_t>(done));
    return all_turn_left;
  }

 private:
  /// What the corner and its neighbours form; the smaller ones are cut first.
  enum Rank : std::uint8_t {
    spike,     ///< no area: the edges coincide, or one has no length
    ear,       ///< turns left; not known to be blocked
    loose,     ///< turns left, and another corner touches its triangle
    straight,  ///< no area: the corner lies on the line from the previous to the next
    blocked,   ///< turns left, and the outline passes through its triangle
    reflex,    ///< turns right
    ranks
  };
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  struct Obstacles {
    std::uint32_t inside, touching;  ///< `none`: there is no such corner
  };
  /// An edge as seen from one of its corners.
  struct Ray {
    std::uint32_t corner, end;
    bool leaves;  ///< the outline goes from the corner to the end
  };

  /// Gives the edges at each place with several corners new links: each edge that leaves it follows the one
  /// that comes in on the other side of the inside to its left.
  void link_places() {
    std::vector<std::uint32_t> left;
    for (std::uint32_t corner = 0; corner < count_; ++corner) {
      if (rank_[corner] != ranks) left.push_back(corner);
    }
    std::sort(left.begin(), left.end(), [&](std::uint32_t a, std::uint32_t b) {
      return view_->same_place(a, b) ? a < b : view_->before(a, b);
    });
    const auto previous = previous_, next = next_;
    for (std::size_t first = 0, last = 0; first < left.size(); first = last) {
      while (last < left.size() && view_->same_place(left[first], left[last])) ++last;
      if (last - first == 1)
        is_settled_[left[first]] = true;
      else
        link_place(std::span(left).subspan(first, last - first), winding_.is_inside_below[left[first]]);
    }
    std::size_t loops = 0;
    std::vector<bool> is_counted(count_);
    for (const std::uint32_t start : left) {
      if (is_counted[start]) continue;
      ++loops;
      for (std::uint32_t corner = start; !is_counted[corner]; corner = next_[corner])
        is_counted[corner] = true;
    }
    if (fills_.size() + 2 != 2 * loops) {  // no such links exist
      previous_ = previous;
      next_ = next;
      is_settled_.assign(count_, false);
      fills_.clear();
    }
    for (const std::uint32_t corner : left) {
      if (next_[corner] == previous_[corner])
        finish(corner);
      else if (previous_[corner] != previous[corner] || next_[corner] != next[corner])
        classify(corner);
    }
  }

  void link_place(std::span<const std::uint32_t> corners, bool starts_inside) {
    const std::uint32_t place = corners[0];
    rays_.clear();
    for (const std::uint32_t corner : corners) {
      rays_.push_back({corner, previous_[corner], false});
      rays_.push_back({corner, next_[corner], true});
    }
    // Counter-clockwise from below, in the order of the sweep.
    const auto turns = [&](const Ray& a, const Ray& b) {
      const bool a_after = view_->before(place, a.end), b_after = view_->before(place, b.end);
      return a_after != b_after ? a_after : view_->side(place, a.end, b.end) > 0;
    };
    std::sort(rays_.begin(), rays_.end(), [&](const Ray& a, const Ray& b) {
      return turns(a, b) || (!turns(b, a) && (a.leaves != b.leaves ? a.leaves : a.corner < b.corner));
    });
    bool inside = starts_inside;
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      // Which of several equal edges are neighbours is not known.
      if (view_->same_place(rays_[i].end, place) || (i + 2 < rays_.size() && !turns(rays_[i], rays_[i + 2])))
        return;
      const bool has_twin = i + 1 < rays_.size() && !turns(rays_[i], rays_[i + 1]);
      if (has_twin && inside) std::swap(rays_[i], rays_[i + 1]);
      if (rays_[i].leaves == inside) return;
      inside = !inside;
    }
    // The ray after one that leaves comes in; before the first, an angle may go on from the last.
    const std::size_t shift = starts_inside ? rays_.size() - 1 : 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> links;  // of corners: from the one that comes in
    for (std::size_t i = 0; i < rays_.size(); i += 2) {
      const Ray &out = rays_[(i + shift) % rays_.size()], &in = rays_[(i + shift + 1) % rays_.size()];
      previous_[out.corner] = in.end;
      next_[in.end] = out.corner;
      is_settled_[out.corner] = true;
      if (in.corner != out.corner) {
        fills_.push_back({in.end, in.corner, out.corner});
        links.emplace_back(in.corner, out.corner);
      }
    }
    // The cycles of the links are polygons without area.
    std::sort(links.begin(), links.end());
    const auto follow = [&](std::uint32_t corner) {
      const auto link = std::lower_bound(links.begin(), links.end(), std::pair(corner, std::uint32_t{0}));
      return std::exchange(link->second, none);
    };
    for (const auto& [first, second] : links) {
      if (second == none) continue;
      std::uint32_t last = follow(first);
      for (std::uint32_t corner = follow(last); corner != first; corner = follow(last)) {
        fills_.push_back({first, corner, last});
        last = corner;
      }
    }
  }

  void classify(std::uint32_t corner) {
    const Rank rank = rank_of(corner);
    set_rank(corner, rank);
    if (rank == ear) {
      remove_obstacle(corner);
    } else {
      index_.insert(corner);
    }
  }

  Rank rank_of(std::uint32_t corner) const {
    const std::uint32_t before = previous_[corner], after = next_[corner];
    const int side = view_->side(before, corner, after);
    if (side != 0) return side > 0 ? ear : reflex;
    const bool passes = view_->before(before, corner)
                            ? view_->before(corner, after)
                            : view_->before(after, corner) && view_->before(corner, before);
    return passes ? straight : spike;
  }

  void set_rank(std::uint32_t corner, Rank rank) {
    rank_[corner] = rank;
    queues_[rank].push(corner);
  }

  std::uint32_t next_corner() {
    std::uint32_t corner = 0;
    while (true) {
      if (pop(spike, corner)) return corner;
      if (pop(ear, corner)) {
        if (may_cut_ear(corner)) return corner;
      } else if (pop(loose, corner)) {
        if (may_cut_loose(corner)) return corner;
      } else if (pop(straight, corner) || pop(blocked, corner) || pop(reflex, corner)) {
        return corner;
      }
    }
  }

  bool pop(Rank rank, std::uint32_t& corner) {
    for (std::queue<std::uint32_t>& queue = queues_[rank]; !queue.empty();) {
      corner = queue.front();
      queue.pop();
      if (rank_[corner] == rank) return true;
    }
    return false;
  }

  bool may_cut_ear(std::uint32_t corner) {
    if (tests_left_ == 0) return true;
    const Obstacles obstacles = find_obstacles(corner, true);
    if (obstacles.inside != none) {
      wait(corner, blocked, obstacles.inside);
    } else if (obstacles.touching != none) {
      wait(corner, loose, obstacles.touching);
    } else {
      return true;
    }
    return false;
  }

  bool may_cut_loose(std::uint32_t corner) {
    if (tests_left_ == 0) return true;
    const Obstacles obstacles = find_obstacles(corner, false);
    if (obstacles.inside != none) {
      wait(corner, blocked, obstacles.inside);
      return false;
    }
    // Where corners and edges coincide, the triangle can lie outside: left of an edge, another edge can
    // follow immediately.
    if (is_settled_[corner] || winds_once_around({previous_[corner], corner, next_[corner]})) return true;
    if (obstacles.touching != none) wait(corner, blocked, obstacles.touching);
    return false;
  }

  /// Finds the obstacles in the triangle of the corner: all, or only the first one.
  Obstacles find_obstacles(std::uint32_t corner, bool only_one) {
    const std::uint32_t a = previous_[corner], b = corner, c = next_[corner];
    const std::array triangle{a, b, c};
    Obstacles found{none, none};
    // Other corners at the place of a settled corner do not go into its angle.
    const std::array is_clear{bool{is_settled_[a]}, bool{is_settled_[b]}, bool{is_settled_[c]}};
    index_.search(triangle, is_clear, [&](std::uint32_t d) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (d == triangle[i] || (is_clear[i] && view_->same_place(d, triangle[i]))) return false;
      }
      if (tests_left_ > 0) --tests_left_;
      const std::array sides{view_->side(a, b, d), view_->side(b, c, d), view_->side(c, a, d)};
      if (sides[0] < 0 || sides[1] < 0 || sides[2] < 0) return false;
      if (enters(previous_[d], triangle, sides) || enters(next_[d], triangle, sides)) {
        found.inside = d;
        return true;
      }
      if (found.touching == none) found.touching = d;
      return only_one;
    });
    return found;
  }

  /// Whether an edge to `end`, from a corner with these sides of a triangle, goes into the open triangle.
  bool enters(std::uint32_t end, const std::array<std::uint32_t, 3>& triangle,
              const std::array<int, 3>& sides_of_start) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (sides_of_start[i] == 0 && view_->side(triangle[i], triangle[(i + 1) % 3], end) <= 0) return false;
    }
    return true;
  }

  bool winds_once_around(const std::array<std::uint32_t, 3>& triangle) {
    const auto [a, b, c] = triangle;
    const OutlineView& view = *view_;
    const Vec3d inside = view[a] / 3 + view[b] / 3 + view[c] / 3;
    // Doubles can be too coarse for a point inside.
    if (view.side(view[a], view[b], inside) <= 0 || view.side(view[b], view[c], inside) <= 0 ||
        view.side(view[c], view[a], inside) <= 0)
      return true;
    const double y = inside[view.y_axis()];
    int winding = 0;
    std::uint32_t from = b;
    do {
      if (tests_left_ > 0) --tests_left_;
      const std::uint32_t to = next_[from];
      const bool is_above = view.y(from) > y, ends_above = view.y(to) > y;
      if (is_above != ends_above) {
        const int side = view.side(view[from], view[to], inside);
        // Edges to the right of the point count. The sides of a view from the other direction are mirrored.
        if (side * view.turn() == (ends_above ? 1 : -1)) winding += side;
      }
      from = to;
    } while (from != b);
    return winding == 1;
  }

  void wait(std::uint32_t corner, Rank rank, std::uint32_t obstacle) {
    set_rank(corner, rank);
    waiting_[obstacle].push_back(corner);
  }

  void remove_obstacle(std::uint32_t corner) {
    index_.remove(corner);
    for (auto& waiting = waiting_[corner]; !waiting.empty(); waiting.pop_back()) {
      if (rank_[waiting.back()] == loose || rank_[waiting.back()] == blocked) set_rank(waiting.back(), ear);
    }
  }

  /// Takes away a corner that is cut, or that is left when its loop is complete.
  void finish(std::uint32_t corner) {
    rank_[corner] = ranks;
    remove_obstacle(corner);
  }

  void cut(std::uint32_t corner) {
    const std::uint32_t before = previous_[corner], after = next_[corner];
    next_[before] = after;
    previous_[after] = before;
    finish(corner);
    for (const std::uint32_t neighbour : {before, after}) {
      if (next_[after] == before)  // the loop is complete
        finish(neighbour);
      else
        classify(neighbour);
    }
  }

  const OutlineView* view_;
  const OutlineWinding& winding_;
  std::uint32_t count_;
  std::vector<std::uint32_t> previous_, next_;  ///< of each corner that is left
  std::vector<Rank> rank_;
  std::vector<std::vector<std::uint32_t>> waiting_;  ///< to test again when this corner is gone
  std::vector<Triangle> fills_;                      ///< without area, between the loops and the outline
  /// Whether no edge at the place of a corner goes into the angle to its left, which is inside.
  std::vector<bool> is_settled_;
  std::vector<Ray> rays_;
  /// Tests of a corner with a triangle.
  std::uint64_t tests_left_ = std::numeric_limits<std::uint64_t>::max();
  /// The corners of each rank, first in, first out. Corners that have another rank by now are skipped.
  std::array<std::queue<std::uint32_t>, ranks> queues_;
  /// All corners but those that turn left: if any corner is in a triangle, one of these is.
  CornerIndex index_;
};

}  // namespace

bool clip_ears(const OutlineView& view, const OutlineWinding& winding, std::span<Triangle> triangles) {
  return EarClipper(view, winding).clip(triangles);
}

}  // namespace supple
