#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "supple/mesh.hpp"

namespace supple::benchmarks {

/// Gigabytes a second of adding up memory, the whole array again and again; the best of several.
double read_bandwidth(std::size_t bytes, unsigned threads);

/// What a refit cannot be faster than: indexed vertices in, all levels of full eight-wide nodes of floats
/// out, nothing else done. Triangles lie along a Morton curve with vertices numbered by first use.
class IdealRefit {
 public:
  /// `per_slot` triangles, at least 1, in each of the eight boxes of a node of the lowest level.
  IdealRefit(const TriangleMesh& mesh, std::size_t per_slot);
  void run();
  std::size_t triangles() const { return indices_.size() / 3; }
  /// Of the root, so that nothing can be left out, and for tests.
  Aabb bounds() const;

 private:
  struct Node {
    alignas(64) float low[3][8], high[3][8];
  };
  struct Bounds {
    alignas(16) float low[4], high[4];
  };
  struct Corners;
  static void write_node(const Corners (&boxes)[8], Node& node, Bounds& around);
  /// `per_slot_`, known when compiling where it is small.
  template <class Count>
  void run_lowest(Count per_slot);
  void run_level(std::size_t level);

  std::size_t per_slot_;
  std::vector<float> positions_;        // x y z of each vertex, and one more
  std::vector<std::uint32_t> indices_;  // three a triangle, slots filled up by repeating the last
  std::vector<std::vector<Node>> levels_;
  std::vector<std::vector<Bounds>> bounds_;  // around the nodes of each level
};

}  // namespace supple::benchmarks
