#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "files/polygon/corner_index.hpp"
#include "files/polygon/outline_view.hpp"
#include "files/polygon/outline_winding.hpp"
#include "supple/mesh.hpp"

namespace supple {

/// Cuts a polygon into triangles by its ears: corners whose triangle with both neighbours lies inside the
/// outline. It keeps its memory from one polygon to the next.
///
/// An ear is cut only where the outline winds once around its triangle. So when every corner can be cut, the
/// triangles cover the inside once. Where an outline that does not cross itself comes back to a place, its
/// edges there get new links, so that each corner has a part of the inside to itself. Then the outline is
/// several loops, and corners at one place do not hinder each other. When no ear is left, as in an outline
/// that crosses itself, corners are cut whose triangle turns left, and then any. Outlines that cross
/// themselves can have many corners in many triangles, so their corners are no longer tested after 100 tests
/// a corner.
class EarClipper {
 public:
  /// Writes view.size() - 2 triangles of corner numbers, which keep the direction of the outline. `winding`
  /// is that of `find_winding`. Returns false when a triangle turns to the right.
  bool clip(const OutlineView& view, const OutlineWinding& winding, std::span<Triangle> triangles);

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
  /// The corners of one rank, first in, first out. Corners that have another rank by now are skipped.
  struct Queue {
    std::vector<std::uint32_t> corners;
    std::size_t first = 0;
  };
  struct Obstacles {
    std::uint32_t inside, touching;  ///< `none`: there is no such corner
  };
  /// A corner to test again when an obstacle of its triangle is gone.
  struct Waiting {
    std::uint32_t corner, next;
  };
  /// An edge as seen from one of its corners.
  struct Ray {
    std::uint32_t corner, end;
    bool leaves;  ///< the outline goes from the corner to the end
  };
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  void start(const OutlineView& view);
  /// Gives the edges at each place with several corners new links: each edge that leaves it follows the one
  /// that comes in on the other side of the inside to its left.
  void link_places(const OutlineWinding& winding);
  void link_place(std::span<const std::uint32_t> corners, bool starts_inside);
  std::uint32_t next_corner();
  bool pop(Rank rank, std::uint32_t& corner);
  void classify(std::uint32_t corner);
  Rank rank_of(std::uint32_t corner) const;
  void set_rank(std::uint32_t corner, Rank rank);
  bool may_cut_ear(std::uint32_t corner);
  bool may_cut_loose(std::uint32_t corner);
  /// Finds the obstacles in the triangle of the corner: all, or only the first one.
  Obstacles find_obstacles(std::uint32_t corner, bool only_one);
  /// Whether an edge to `end`, from a corner with these sides of a triangle, goes into the open triangle.
  bool enters(std::uint32_t end, const std::array<std::uint32_t, 3>& triangle,
              const std::array<int, 3>& sides_of_start) const;
  bool winds_once_around(const std::array<std::uint32_t, 3>& triangle);
  void wait(std::uint32_t corner, Rank rank, std::uint32_t obstacle);
  void remove_obstacle(std::uint32_t corner);
  void cut(std::uint32_t corner);
  /// Takes away a corner that is cut, or that is left when its loop is complete.
  void finish(std::uint32_t corner);

  const OutlineView* view_ = nullptr;
  std::vector<std::uint32_t> previous_, next_;  ///< of each corner that is left
  std::vector<Rank> rank_;
  std::vector<std::uint32_t> first_waiting_;  ///< of each corner, an index into `waiting_`
  std::vector<Waiting> waiting_;
  std::vector<Triangle> fills_;  ///< without area, between the loops and the outline
  /// Whether no edge at the place of a corner goes into the angle to its left, which is inside.
  std::vector<bool> is_settled_;
  std::vector<Ray> rays_;
  std::uint64_t tests_left_ = 0;  ///< of a corner with a triangle
  std::array<Queue, ranks> queues_;
  CornerIndex
      index_;  ///< all corners but those that turn left: if any corner is in a triangle, one of these is
};

}  // namespace supple
