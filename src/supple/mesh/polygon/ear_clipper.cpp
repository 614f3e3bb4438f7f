#include "mesh/polygon/ear_clipper.hpp"

#include <utility>

namespace supple {

bool EarClipper::clip(const OutlineView& view, bool crosses_itself, std::span<Triangle> triangles) {
  start(view);
  tests_left_ = crosses_itself ? 100 * std::uint64_t{view.size()} : std::numeric_limits<std::uint64_t>::max();
  bool all_turn_left = true;
  for (Triangle& triangle : triangles) {
    const std::uint32_t corner = next_corner();
    triangle = {previous_[corner], corner, next_[corner]};
    all_turn_left = all_turn_left && rank_of(corner) != reflex;
    cut(corner);
  }
  return all_turn_left;
}

void EarClipper::start(const OutlineView& view) {
  view_ = &view;
  const auto count = static_cast<std::uint32_t>(view.size());
  previous_.resize(count);
  next_.resize(count);
  rank_.assign(count, ranks);
  first_waiting_.assign(count, none);
  waiting_.clear();
  for (Queue& queue : queues_) queue = {std::move(queue.corners), 0}, queue.corners.clear();
  for (std::uint32_t corner = 0; corner < count; ++corner) {
    previous_[corner] = corner == 0 ? count - 1 : corner - 1;
    next_[corner] = corner + 1 == count ? 0 : corner + 1;
  }
  index_.start(view);
  for (std::uint32_t corner = 0; corner < count; ++corner) classify(corner);
}

void EarClipper::classify(std::uint32_t corner) {
  const Rank rank = rank_of(corner);
  set_rank(corner, rank);
  if (rank == ear) {
    remove_obstacle(corner);
  } else {
    index_.insert(corner);
  }
}

EarClipper::Rank EarClipper::rank_of(std::uint32_t corner) const {
  const std::uint32_t before = previous_[corner], after = next_[corner];
  const int side = view_->side(before, corner, after);
  if (side != 0) return side > 0 ? ear : reflex;
  const bool passes = view_->before(before, corner)
                          ? view_->before(corner, after)
                          : view_->before(after, corner) && view_->before(corner, before);
  return passes ? straight : spike;
}

void EarClipper::set_rank(std::uint32_t corner, Rank rank) {
  rank_[corner] = rank;
  if (rank != ranks) queues_[rank].corners.push_back(corner);
}

std::uint32_t EarClipper::next_corner() {
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

bool EarClipper::pop(Rank rank, std::uint32_t& corner) {
  Queue& queue = queues_[rank];
  while (queue.first < queue.corners.size()) {
    corner = queue.corners[queue.first++];
    if (rank_[corner] == rank) return true;
  }
  return false;
}

bool EarClipper::may_cut_ear(std::uint32_t corner) {
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

bool EarClipper::may_cut_loose(std::uint32_t corner) {
  if (tests_left_ == 0) return true;
  const Obstacles obstacles = find_obstacles(corner, false);
  if (obstacles.inside != none) {
    wait(corner, blocked, obstacles.inside);
    return false;
  }
  // Where edges coincide, the triangle can lie outside: left of an edge, another edge can follow immediately.
  if (winds_once_around({previous_[corner], corner, next_[corner]})) return true;
  if (obstacles.touching != none) wait(corner, blocked, obstacles.touching);
  return false;
}

EarClipper::Obstacles EarClipper::find_obstacles(std::uint32_t corner, bool only_one) {
  const std::uint32_t a = previous_[corner], b = corner, c = next_[corner];
  const std::array triangle{a, b, c};
  Obstacles found{none, none};
  index_.search(a, b, c, [&](std::uint32_t d) {
    if (d == a || d == b || d == c) return false;
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

bool EarClipper::enters(std::uint32_t end, const std::array<std::uint32_t, 3>& triangle,
                        const std::array<int, 3>& sides_of_start) const {
  for (std::size_t i = 0; i < 3; ++i) {
    if (sides_of_start[i] == 0 && view_->side(triangle[i], triangle[(i + 1) % 3], end) <= 0) return false;
  }
  return true;
}

bool EarClipper::winds_once_around(const std::array<std::uint32_t, 3>& triangle) {
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

void EarClipper::wait(std::uint32_t corner, Rank rank, std::uint32_t obstacle) {
  set_rank(corner, rank);
  waiting_.push_back({corner, first_waiting_[obstacle]});
  first_waiting_[obstacle] = static_cast<std::uint32_t>(waiting_.size() - 1);
}

void EarClipper::remove_obstacle(std::uint32_t corner) {
  index_.remove(corner);
  for (std::uint32_t i = std::exchange(first_waiting_[corner], none); i != none; i = waiting_[i].next) {
    const std::uint32_t waiting = waiting_[i].corner;
    if (rank_[waiting] == loose || rank_[waiting] == blocked) set_rank(waiting, ear);
  }
}

void EarClipper::cut(std::uint32_t corner) {
  const std::uint32_t before = previous_[corner], after = next_[corner];
  next_[before] = after;
  previous_[after] = before;
  rank_[corner] = ranks;
  remove_obstacle(corner);
  classify(before);
  classify(after);
}

}  // namespace supple
