#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "answers/penetration/surface_view.hpp"
#include "manifold/curves/parity_sets.hpp"
#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple {

/// The triangles of one surface that a curve crosses, and the vertices on both sides of it. Keeps its memory.
class CurveSide {
 public:
  /// Starts another curve.
  void start(std::size_t vertex_count);
  void add_triangle(const Triangle& triangle);
  /// The edge is one of a triangle that was added. Repeated crossings count once.
  void add_crossing(std::uint32_t v, std::uint32_t w, std::uint32_t key);

  static constexpr std::uint32_t none = ~std::uint32_t{0};
  /// The vertices of the smaller of the two parts into which the curve cuts the surface; when both are equal,
  /// the part of the vertex `behind`, if there is one. None when the curve does not cut it in two.
  std::span<const std::uint32_t> enclose(const SurfaceView& surface, std::uint32_t behind = none);
  /// The number of vertices that the last `enclose` reached.
  std::size_t visited() const { return flooded_[0].size() + flooded_[1].size(); }

 private:
  /// Where the curve crosses an edge between two corners, and the key of that point.
  struct Crossing {
    std::uint32_t corner = 0, other = 0, key = 0;  // corner < other
    constexpr auto operator<=>(const Crossing&) const = default;
  };
  bool list_cuts();
  bool color_corners();
  std::size_t color_of(std::uint32_t corner) {
    return (colors_.find(corner).is_opposite != is_opposite_to_first_) ? 1 : 0;
  }
  bool start_flood();
  const std::vector<std::uint32_t>* flood(const SurfaceView& surface, std::uint32_t behind);
  bool is_cut(std::uint32_t corner, std::uint32_t other) const;
  std::uint64_t mark_of(std::size_t color) const { return last_mark_ + color; }

  std::vector<std::uint32_t> corner_of_;       // by vertex: its place in `corners_`, or `none`
  std::vector<std::uint32_t> corners_;         // vertices of the triangles
  std::vector<Triangle> triangles_;            // of places in `corners_`
  std::vector<Crossing> crossings_, sorted_;   // as they were added, and by corner
  std::vector<std::uint32_t> first_crossing_;  // of each corner, in `sorted_`
  // The other corners of edges that are crossed an odd number of times, and where those of each corner begin.
  std::vector<std::uint32_t> cuts_, first_cut_;
  ParitySets colors_;                  // of the corners
  bool is_opposite_to_first_ = false;  // the corner with the smallest vertex, to the first corner
  std::vector<std::uint64_t> marks_;   // by vertex
  std::uint64_t last_mark_ = 0;
  std::array<std::vector<std::uint32_t>, 2> flooded_;  // by colour
};

}  // namespace supple
