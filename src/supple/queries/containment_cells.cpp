#include "queries/containment_cells.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace supple {

bool ContainmentCells::build(const QueriedObject& object, std::size_t questions, ObjectQueries& queries) {
  // A question without cells takes as long as 20 triangles here.
  const bool are_worth = questions >= 256 + object.triangles.size() / 20;
  if (!are_worth || !choose_cells(object.box, questions)) return false;
  cells_.assign(std::size_t{counts_[0]} * counts_[1] * counts_[2], Content::unknown);
  if (!mark_triangles(object)) return false;
  decide(object, queries);
  return true;
}

/// False when the box has no volume, or one that is not a normal number.
bool ContainmentCells::choose_cells(const Aabb& box, std::size_t questions) {
  constexpr std::size_t least_cells = 64, most_cells = std::size_t{1} << 21;
  constexpr double most_along = 4096;
  Vec3d size;
  for (int axis = 0; axis < 3; ++axis) size[axis] = double{box.max[axis]} - box.min[axis];
  const double volume = size.x * size.y * size.z;
  if (!std::isnormal(volume)) return false;
  const double edge =
      std::cbrt(volume / static_cast<double>(std::clamp(2 * questions, least_cells, most_cells)));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double length = size[static_cast<int>(axis)];
    counts_[axis] = static_cast<std::uint32_t>(std::clamp(length / edge, 1.0, most_along));
    low_[axis] = box.min[static_cast<int>(axis)];
    scale_[axis] = counts_[axis] / length;
    last_[axis] = counts_[axis] - 1;
    if (!std::isnormal(scale_[axis])) return false;
  }
  return std::size_t{counts_[0]} * counts_[1] * counts_[2] <= 2 * most_cells;
}

/// False when it takes too long, because triangles are large or many lie in one place.
bool ContainmentCells::mark_triangles(const QueriedObject& object) {
  std::size_t left = 4 * (cells_.size() + object.triangles.size());
  const std::uint8_t* const inert = object.view.arrays.inert;
  for (std::uint32_t t = 0; t < object.triangles.size(); ++t) {
    if (inert != nullptr && inert[t] != 0) continue;
    const TrianglePoints corners = object.corners(t);
    const Cell a = cell_of(corners[0]), b = cell_of(corners[1]), c = cell_of(corners[2]);
    Cell first, last, size;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::tie(first[axis], last[axis]) = std::minmax({a[axis], b[axis], c[axis]});
      size[axis] = last[axis] - first[axis] + 1;
    }
    const std::size_t cells = std::size_t{size[0]} * size[1] * size[2];
    if (cells > left) return false;
    left -= cells;
    for (std::uint32_t z = first[2]; z <= last[2]; ++z) {
      for (std::uint32_t y = first[1]; y <= last[1]; ++y)
        std::fill_n(cells_.begin() + static_cast<std::ptrdiff_t>(index_of({first[0], y, z})), size[0],
                    Content::triangles);
    }
  }
  return true;
}

void ContainmentCells::decide(const QueriedObject& object, ObjectQueries& queries) {
  const std::size_t row = counts_[0], layer = row * counts_[1];
  std::size_t i = 0;
  for (std::uint32_t z = 0; z < counts_[2]; ++z) {
    for (std::uint32_t y = 0; y < counts_[1]; ++y) {
      for (std::uint32_t x = 0; x < counts_[0]; ++x, ++i) {
        if (cells_[i] == Content::triangles) continue;
        if (x > 0 && is_decided(cells_[i - 1])) {
          cells_[i] = cells_[i - 1];
        } else if (y > 0 && is_decided(cells_[i - row])) {
          cells_[i] = cells_[i - row];
        } else if (z > 0 && is_decided(cells_[i - layer])) {
          cells_[i] = cells_[i - layer];
        } else {
          cells_[i] = ask({x, y, z}, object, queries);
        }
      }
    }
  }
}

/// Asks for a point of the cell. A cell stays unknown where it is too small to have one.
ContainmentCells::Content ContainmentCells::ask(const Cell& cell, const QueriedObject& object,
                                                ObjectQueries& queries) const {
  Vec3d middle;
  for (std::size_t axis = 0; axis < 3; ++axis)
    middle[static_cast<int>(axis)] = low_[axis] + (cell[axis] + 0.5) / scale_[axis];
  if (cell_of(middle) != cell) return Content::unknown;
  return queries.inside(0, object, middle) == Containment::inside ? Content::inside : Content::outside;
}

}  // namespace supple
