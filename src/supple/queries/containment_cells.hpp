#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "narrow_phase/query_kernels.hpp"
#include "octree/morton_curve.hpp"
#include "queries/object_queries.hpp"

namespace supple {

/// Points that need an exact answer: copies, because the points are far apart in memory, and their numbers.
struct OpenPoints {
  std::vector<CurvePlace> order;  ///< of the copies
  std::vector<Vec3d> points;
  std::vector<std::uint32_t> numbers;
  std::vector<Containment> sides;

  void clear() {
    order.clear();
    points.clear();
    numbers.clear();
    sides.clear();
  }
  void add(std::uint64_t code, const Vec3d& point, std::size_t number) {
    order.push_back({code, static_cast<std::uint32_t>(points.size())});
    points.push_back(point);
    numbers.push_back(static_cast<std::uint32_t>(number));
    sides.push_back(Containment::outside);
  }
};

/// Cells around one closed surface, for many questions whether points are inside. All points of a cell that
/// no triangle's box meets are on the same side of the surface, and so are those of two such neighbours. So
/// one exact query answers for all cells that are connected. From a point in another cell, a ray along an
/// axis leads to such a cell, and the triangles on it are those of the cells on the way.
///
/// The place of a point is a function of each coordinate that never decreases, also as it is rounded. So the
/// cells of a box are those between the cells of its corners, and a cell has an interval of each coordinate:
/// the answers are exact.
class ContainmentCells {
 public:
  /// Chooses at most two cells for each question. Returns false, and nothing else must be called, when cells
  /// do not pay: for few questions, and for triangles that fill many cells. O(cells + triangles).
  bool build(const QueriedObject& object, std::span<const Vec3d> points, ObjectQueries& queries);
  /// Raises the results of at most a block of points in the box of the object. Appends those that are in
  /// cells with triangles to `open`, with `first` added to their numbers.
  void raise(std::span<const Vec3d> points, std::size_t first, std::span<Containment> results,
             OpenPoints& open) const;
  /// For a point in the box of the object.
  Containment side_of(const Vec3d& point, const QueriedObject& object, ObjectQueries& queries) const;

 private:
  struct Entry {
    CellGrid::Place first, last;  ///< of the triangle's box; the rest of the bits are the triangle's number

    std::uint32_t triangle() const { return static_cast<std::uint32_t>(first >> 48 | last >> 48 << 16); }
  };

  template <class Visit>
  void visit_cells(const Entry& entry, const Visit& visit) const;
  bool choose_cells(const Aabb& box, std::size_t count);
  bool list_triangles(const QueriedObject& object);
  void decide(const QueriedObject& object, ObjectQueries& queries);
  Containment ask(const CellGrid::Cell& cell, const QueriedObject& object, ObjectQueries& queries) const;

  CellGrid grid_;
  std::vector<Containment> sides_;       // `on` for cells with triangles, or too small to ask for
  std::vector<std::uint32_t> begins_;    // of the entries of each cell, and the end
  std::vector<Entry> listed_, entries_;  // by triangle, and by cell
};

}  // namespace supple
