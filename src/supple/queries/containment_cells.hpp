#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "queries/object_queries.hpp"

namespace supple {

/// Cells around one closed surface, for many questions whether points are inside. All points of a cell that
/// no triangle's box meets are on the same side of the surface, and so are those of two such neighbours. So
/// one exact query answers for all cells that are connected.
///
/// The cell of a point is a function of each coordinate that never decreases, also as it is rounded. So the
/// cells of a box are those between the cells of its corners, and a cell has an interval of each coordinate:
/// the answers are exact.
class ContainmentCells {
 public:
  /// Chooses about two cells for each question. Returns false, and `side_of` must not be called, when cells
  /// do not pay: for few questions, and for triangles that fill many cells. O(cells + triangles).
  bool build(const QueriedObject& object, std::size_t questions, ObjectQueries& queries);
  /// The side of a point in the box of the object. Nothing when a triangle may be near.
  std::optional<Containment> side_of(const Vec3d& point) const {
    const Content content = cells_[index_of(cell_of(point))];
    if (!is_decided(content)) return {};
    return content == Content::inside ? Containment::inside : Containment::outside;
  }

 private:
  enum class Content : std::uint8_t { unknown, triangles, outside, inside };
  using Cell = std::array<std::uint32_t, 3>;

  static bool is_decided(Content content) { return content >= Content::outside; }
  Cell cell_of(const Vec3d& point) const {
    Cell cell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = (point[static_cast<int>(axis)] - low_[axis]) * scale_[axis];
      cell[axis] = static_cast<std::uint32_t>(place < last_[axis] ? place : last_[axis]);
    }
    return cell;
  }
  std::size_t index_of(const Cell& cell) const {
    return (std::size_t{cell[2]} * counts_[1] + cell[1]) * counts_[0] + cell[0];
  }
  bool choose_cells(const Aabb& box, std::size_t questions);
  bool mark_triangles(const QueriedObject& object);
  void decide(const QueriedObject& object, ObjectQueries& queries);
  Content ask(const Cell& cell, const QueriedObject& object, ObjectQueries& queries) const;

  std::array<double, 3> low_{}, scale_{}, last_{};  // the last cell of each axis
  Cell counts_{};
  std::vector<Content> cells_;  // x first
};

}  // namespace supple
