#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/views.hpp"

namespace supple {

/// Which triangles of a solid face inwards: into what `Scene::inside` finds inside.
///
/// Edges connect triangles to closed sheets. A sheet faces outwards when its signed volume is positive; the
/// sign is exact. A sheet inside an odd number of others bounds a hole, so there it is the other way round. A
/// sheet is inside another one when its lowest and highest vertices along each axis are. The constructor
/// finds that once, because it changes only where sheets pass through each other. Sheets of volume 0, or with
/// a vertex that is not finite, stay as they are.
class Orientation {
 public:
  /// The triangles bound a solid (`fault_of_solid`). O(n log n) for n triangles, and O(m) for each sheet in
  /// the box of another one with m triangles.
  Orientation(std::vector<Triangle> triangles, const PositionsView& positions);

  /// O(n).
  void judge(const PositionsView& positions);

  /// A byte by triangle; empty when all face outwards.
  std::span<const std::uint8_t> inward() const {
    return has_inward_ ? std::span(inward_) : std::span<const std::uint8_t>();
  }
  /// Whether there are triangles, and the volume of each sheet is exactly 0.
  bool is_flat() const { return is_flat_; }

 private:
  struct Sheet {
    std::uint32_t first = 0, last = 0;  // of `order_`
    bool is_hole = false;
  };
  void list_sheets();
  void find_holes(const PositionsView& positions);
  std::span<const std::uint32_t> triangles_of(const Sheet& sheet) const {
    return std::span(order_).subspan(sheet.first, sheet.last - sheet.first);
  }

  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> order_;  // the triangles, by sheet
  std::vector<Sheet> sheets_;
  std::vector<std::uint8_t> inward_;
  bool has_inward_ = false, is_flat_ = false;
};

}  // namespace supple
