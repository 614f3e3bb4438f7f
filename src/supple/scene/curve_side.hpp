#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/parity_sets.hpp"
#include "scene/surface_view.hpp"
#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple {

/// The triangles of one surface that a curve crosses, and the vertices on both sides of it. Keeps its memory.
class CurveSide {
 public:
  /// The vertices of an edge, ascending, and the key of the point where the curve crosses it.
  using Crossing = std::array<std::uint32_t, 3>;

  /// Where a curve leaves a surface: "behind" is farther along the direction, which may be zero, from a point
  /// in scaled coordinates.
  struct Direction {
    Vec3d towards_behind, from;
    double scale = 1;
  };

  void clear();
  void add_triangle(const Triangle& triangle) {
    corners_.insert(corners_.end(), triangle.begin(), triangle.end());
    triangles_.push_back(triangle);
  }
  void add_crossing(const Crossing& crossing) { crossings_.push_back(crossing); }

  /// The vertices of the smaller of the two parts into which the curve cuts the surface; when both are equal,
  /// the part behind. None when the curve does not cut it in two. The part behind counts only when it is the
  /// smaller one or has at most `most_behind` vertices.
  std::span<const std::uint32_t> enclose(const SurfaceView& surface, const Direction& direction,
                                         std::size_t most_behind);
  /// The vertices of the part behind after `enclose`; those of the smaller part when it is not known which
  /// part is behind.
  std::span<const std::uint32_t> behind() const { return behind_; }

 private:
  bool color_corners();
  std::optional<std::size_t> color_behind(const SurfaceView& surface, const Direction& direction);
  bool start_flood(const SurfaceView& surface);
  const std::vector<std::uint32_t>* flood(const SurfaceView& surface, std::optional<std::size_t>& behind,
                                          std::size_t most_behind);
  bool is_cut(std::uint32_t v, std::uint32_t w) const;
  std::uint32_t mark_of(std::size_t color) const { return last_mark_ + static_cast<std::uint32_t>(color); }

  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> corners_;                   // vertices of these triangles, ascending
  std::vector<Crossing> crossings_;                      // ascending
  std::vector<std::array<std::uint32_t, 2>> cut_edges_;  // crossed an odd number of times, ascending
  ParitySets colors_;                                    // of the corners
  std::vector<std::uint32_t> marks_;                     // by vertex
  std::uint32_t last_mark_ = 0;
  std::array<std::vector<std::uint32_t>, 2> flooded_;  // by colour
  std::span<const std::uint32_t> behind_;
};

}  // namespace supple
