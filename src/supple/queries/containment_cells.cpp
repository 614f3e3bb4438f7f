#include "queries/containment_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "contact/distance/axis_ray.hpp"

namespace supple {

bool ContainmentCells::build(const QueriedObject& object, std::span<const Vec3d> points,
                             ObjectQueries& queries) {
  // A question without cells takes as long as 20 triangles here.
  const std::size_t triangles = object.triangles.size(), least = 256 + triangles / 20, most = 2 * triangles;
  std::size_t questions = 0;
  for (std::size_t i = 0; i < points.size() && questions < std::max(least, most); ++i)
    questions += contains(object.box, points[i]) ? 1 : 0;
  if (questions < least || !choose_cells(object.box, 2 * questions)) return false;
  sides_.assign(grid_.size(), Containment::outside);
  begins_.assign(grid_.size() + 1, 0);
  if (!list_triangles(object)) return false;
  decide(object, queries);
  return true;
}

/// False when the box has no volume, or one that is not a normal number.
bool ContainmentCells::choose_cells(const Aabb& box, std::size_t count) {
  constexpr std::size_t least_cells = 64, most_cells = std::size_t{1} << 21;
  for (int axis = 0; axis < 3; ++axis) {
    grid_.low[axis] = box.min[axis];
    grid_.high[axis] = box.max[axis];
  }
  const Vec3d size = grid_.high - grid_.low;
  const double volume = size.x * size.y * size.z;
  if (!std::isnormal(volume)) return false;
  const double edge = std::cbrt(volume / static_cast<double>(std::clamp(count, least_cells, most_cells)));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double length = size[static_cast<int>(axis)];
    grid_.counts[axis] =
        static_cast<std::uint32_t>(std::clamp(length / edge, 1.0, double{CellGrid::most_along}));
    grid_.scale[static_cast<int>(axis)] = grid_.counts[axis] / length;
    if (!std::isnormal(grid_.scale[static_cast<int>(axis)])) return false;
  }
  return grid_.size() <= 2 * most_cells;
}

/// Calls `visit` with the index of each cell of an entry.
template <class Visit>
void ContainmentCells::visit_cells(const Entry& entry, const Visit& visit) const {
  const CellGrid::Cell first = CellGrid::cell_of(entry.first), last = CellGrid::cell_of(entry.last);
  for (std::uint32_t z = first[2]; z <= last[2]; ++z) {
    for (std::uint32_t y = first[1]; y <= last[1]; ++y) {
      const std::size_t begin = grid_.index_of({first[0], y, z});
      for (std::uint32_t x = 0; x <= last[0] - first[0]; ++x) visit(begin + x);
    }
  }
}

/// False when it takes too long, because triangles are large or many lie in one place.
bool ContainmentCells::list_triangles(const QueriedObject& object) {
  const std::size_t most = 2 * (sides_.size() + object.triangles.size());
  std::size_t count = 0;
  const std::uint8_t* const inert = object.view.arrays.inert;
  listed_.clear();
  for (std::uint32_t t = 0; t < object.triangles.size(); ++t) {
    if (inert != nullptr && inert[t] != 0) continue;
    const QueryBox box = box_around(object.corners(t));
    const Entry& entry =
        listed_.emplace_back(Entry{grid_.place_of(box.min) | CellGrid::Place{t} << 48,
                                   grid_.place_of(box.max) | CellGrid::Place{t >> 16} << 48});
    visit_cells(entry, [&](std::size_t cell) { ++begins_[cell], ++count; });
    if (count > most) return false;
  }
  std::inclusive_scan(begins_.begin(), begins_.end(), begins_.begin());
  entries_.resize(begins_.back());
  for (const Entry& entry : listed_)
    visit_cells(entry, [&](std::size_t cell) { entries_[--begins_[cell]] = entry; });
  return true;
}

void ContainmentCells::decide(const QueriedObject& object, ObjectQueries& queries) {
  const int row = grid_.step(1), layer = grid_.step(2);
  for (std::uint32_t z = 0; z < grid_.counts[2]; ++z) {
    for (std::uint32_t y = 0; y < grid_.counts[1]; ++y) {
      const std::size_t begin = grid_.index_of({0, y, z});
      Containment* side = &sides_[begin];
      for (std::uint32_t x = 0; x < grid_.counts[0]; ++x, ++side) {
        if (begins_[begin + x] != begins_[begin + x + 1]) {
          *side = Containment::on;
        } else if (side[-1] != Containment::on) {
          *side = side[-1];
        } else if (side[-row] != Containment::on) {
          *side = side[-row];
        } else {
          *side = side[-layer] != Containment::on ? side[-layer] : ask({x, y, z}, object, queries);
        }
      }
    }
  }
}

/// Asks for a point of a cell, which may be too small to have one.
Containment ContainmentCells::ask(const CellGrid::Cell& cell, const QueriedObject& object,
                                  ObjectQueries& queries) const {
  Vec3d middle;
  for (int axis = 0; axis < 3; ++axis)
    middle[axis] = grid_.low[axis] + (cell[static_cast<std::size_t>(axis)] + 0.5) / grid_.scale[axis];
  if (CellGrid::cell_of(grid_.place_of(middle)) != cell) return Containment::on;
  return queries.inside(0, object, middle);
}

void ContainmentCells::raise(std::span<const Vec3d> points, std::size_t first, std::span<Containment> results,
                             OpenPoints& open) const {
  std::array<std::uint32_t, CellGrid::block> cells;
  find_cells(grid_, points, cells);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Containment side = sides_[cells[i]];
    if (side == Containment::on)
      open.add(cells[i], points[i], first + i);
    else
      results[i] = std::max(results[i], side);
  }
}

/// By a ray along an axis to the next cell on a side, where one is near and triangles are few.
Containment ContainmentCells::side_of(const Vec3d& point, const QueriedObject& object,
                                      ObjectQueries& queries) const {
  constexpr int most_cells = 3;
  int left = 64;  // more triangles take as long as a query
  const CellGrid::Place place = grid_.place_of(point);
  const std::size_t own = grid_.index_of(CellGrid::cell_of(place));
  for (int way = 0; way < 6 * most_cells; ++way) {
    // The cells around the grid are outside, so the first side on the way is not behind them.
    const int axis = way % 6 / 2, direction = way % 2 == 0 ? 1 : -1;
    const int step = direction * grid_.step(axis);
    const std::size_t end = own + static_cast<std::size_t>(step * (1 + way / 6));
    if (sides_[end] == Containment::on) continue;
    const CellGrid::Place along = CellGrid::all_parts << 16 * axis;
    const CellGrid::Place low = direction > 0 ? place : place & ~along,
                          high = direction > 0 ? place | along : place;
    AxisRay ray(point, axis, direction);
    std::uint32_t coordinate = CellGrid::cell_of(place)[static_cast<std::size_t>(axis)];
    for (std::size_t cell = own; cell != end;
         cell += static_cast<std::size_t>(step), coordinate += direction) {
      for (std::uint32_t i = begins_[cell]; i < begins_[cell + 1] && left >= 0; ++i, --left) {
        const Entry& entry = entries_[i];
        if (!CellGrid::are_ordered(entry.first, high) || !CellGrid::are_ordered(low, entry.last)) continue;
        const CellGrid::Cell begin = CellGrid::cell_of(direction > 0 ? entry.first : entry.last);
        // Each triangle in the first of its cells on the ray.
        if (cell == own || begin[static_cast<std::size_t>(axis)] == coordinate)
          ray.meet(object.corners(entry.triangle()));
      }
    }
    if (left < 0) break;
    if (ray.starts_on_surface()) return Containment::on;
    const bool is_inside = ray.is_odd() != (sides_[end] == Containment::inside);
    return is_inside && !object.has_inert_faces ? Containment::inside : Containment::outside;
  }
  return queries.inside(0, object, point);
}

}  // namespace supple
