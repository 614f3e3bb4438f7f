#include "files/polygon/outline.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>

namespace supple {
namespace {

// A sweep over the corners in the order of `OutlineView::before`. The edges that start before the current
// corner and end after it are sorted from right to left of the direction of the sweep, called below and
// above.

/// Edges on one line that overlap. `from` is before `to`.
struct Strand {
  std::uint32_t from, to;
  mutable int edges = 0;
  /// How much the winding number grows from below to above: edges in the direction of the sweep minus others.
  mutable int step = 0;
};

struct Below {
  using is_transparent = void;
  const OutlineView& view;

  /// The strands do not cross, and some line of the sweep meets both. Where one starts on the other, the
  /// directions decide. Neither is below the other when they overlap.
  bool operator()(const Strand& a, const Strand& b) const {
    if (view.before(b.from, a.from)) return side(b, a) < 0;
    return side(a, b) > 0;
  }
  bool operator()(const Strand& strand, std::uint32_t corner) const {
    return view.side(strand.from, strand.to, corner) > 0;
  }
  bool operator()(std::uint32_t corner, const Strand& strand) const {
    return view.side(strand.from, strand.to, corner) < 0;
  }

 private:
  int side(const Strand& strand, const Strand& later) const {
    const int start = view.side(strand.from, strand.to, later.from);
    return start != 0 ? start : view.side(strand.from, strand.to, later.to);
  }
};

class Sweep {
 public:
  explicit Sweep(const OutlineView& view) : view_(view), strands_(Below{view}) {}

  /// Fills `is_inside_below` until it finds a crossing.
  bool finds_crossing(std::vector<bool>& is_inside_below) {
    const auto count = static_cast<std::uint32_t>(view_.size());
    is_inside_below.resize(count);
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return view_.same_place(a, b) ? a < b : view_.before(a, b);
    });
    for (std::size_t first = 0, last = 0; first < count; first = last) {
      while (last < count && view_.same_place(order[first], order[last])) ++last;
      for (const bool starts : {false, true}) {
        for (std::size_t i = first; i < last; ++i) {
          const std::uint32_t corner = order[i], next = corner + 1 == count ? 0 : corner + 1;
          const std::uint32_t previous = corner == 0 ? count - 1 : corner - 1;
          if (!take(corner, next, starts, 1) || !take(corner, previous, starts, -1)) return true;
        }
      }
      const std::optional<bool> inside = inside_below(order[first]);
      if (!inside) return true;
      for (std::size_t i = first; i < last; ++i) is_inside_below[order[i]] = *inside;
    }
    return false;
  }

 private:
  /// Adds an edge when it starts at the corner, and removes it when it ends there. `direction` is 1 for the
  /// edge from the corner, -1 for the edge to it.
  bool take(std::uint32_t corner, std::uint32_t other, bool starts, int direction) {
    if (view_.same_place(corner, other) || view_.before(corner, other) != starts) return true;
    const Strand edge = starts ? Strand{corner, other} : Strand{other, corner};
    auto place = strands_.find(edge);
    if (starts) {
      if (place == strands_.end()) {
        place = strands_.insert(edge).first;
      } else if (view_.before(place->to, other)) {
        // The strand reaches as far as its longest edge.
        const Strand longer{place->from, other, place->edges, place->step};
        place = strands_.insert(strands_.erase(place), longer);
      }
      ++place->edges;
      place->step += direction;
      return true;
    }
    if (place == strands_.end()) return false;
    --place->edges;
    place->step += direction;
    if (place->edges == 0) strands_.erase(place);
    return true;
  }

  /// Checks the strands at the corner and one on each side: neighbours must not cross before one ends, and
  /// the winding number goes from 0 to 1 and back. Strands without a step change nothing. Returns whether the
  /// area below the corner is inside; nothing when the outline crosses itself.
  std::optional<bool> inside_below(std::uint32_t corner) const {
    auto strand = strands_.lower_bound(corner);
    int below = -1;
    while (strand != strands_.begin()) {
      --strand;
      if (strand->step != 0) {
        below = strand->step;
        ++strand;
        break;
      }
    }
    const bool inside = below == 1;
    for (; strand != strands_.end(); ++strand) {
      if (strand != strands_.begin() && will_cross(*std::prev(strand), *strand)) return {};
      if (strand->step == 0) continue;
      if (strand->step != -below || (strand->step != 1 && strand->step != -1)) return {};
      below = strand->step;
      if (Below{view_}(corner, *strand)) break;
    }
    return inside;
  }

  bool will_cross(const Strand& low, const Strand& high) const {
    return view_.before(low.to, high.to) ? view_.side(high.from, high.to, low.to) > 0
                                         : view_.side(low.from, low.to, high.to) < 0;
  }

  const OutlineView& view_;
  std::set<Strand, Below> strands_;
};

}  // namespace

OutlineWinding find_winding(const OutlineView& view) {
  OutlineWinding winding;
  winding.crosses = Sweep(view).finds_crossing(winding.is_inside_below);
  return winding;
}

}  // namespace supple
