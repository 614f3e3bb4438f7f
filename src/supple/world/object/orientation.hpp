#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/views.hpp"

namespace supple {

/// Which triangles of a solid face inwards: into what `Scene::inside` finds inside.
///
/// A connected part faces outwards when its signed volume is positive; the sign is exact. A part inside an
/// odd number of others bounds a hole, so there it is the other way round. A part is inside another one when
/// its box is, and vertices spread over it are. The constructor finds that, because it changes only where
/// parts pass through each other. Parts of volume 0, or with a vertex that is not finite, stay as they are.
class Orientation {
 public:
  /// The triangles bound a solid (`fault_of_solid`). O(n log n), and O(m) for each part in the box of another
  /// one with m triangles.
  Orientation(std::vector<Triangle> triangles, const PositionsView& positions);

  /// O(n).
  void judge(const PositionsView& positions);

  /// A byte by triangle; empty when all face outwards.
  std::span<const std::uint8_t> inward() const {
    return has_inward_ ? std::span(inward_) : std::span<const std::uint8_t>();
  }

 private:
  struct Part {
    std::uint32_t first = 0, last = 0;  // of `order_`
    bool is_hole = false;
  };
  void find_holes(const PositionsView& positions);
  std::span<const std::uint32_t> triangles_of(const Part& part) const {
    return std::span(order_).subspan(part.first, part.last - part.first);
  }

  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> order_;  // the triangles, by part
  std::vector<Part> parts_;
  std::vector<std::uint8_t> inward_;
  bool has_inward_ = false;
};

}  // namespace supple
