#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "supple/mesh.hpp"

namespace supple::benchmarks {

/// Gigabytes per second when summing an array repeatedly; the best of several runs.
double read_bandwidth(std::size_t bytes, unsigned threads);

/// A lower bound for any refit: it reads indexed vertices, writes all levels of full nodes with eight float
/// boxes each, and does nothing else. Triangles lie along a Morton curve with vertices numbered by first
/// use.
class IdealRefit {
 public:
  /// Each of the eight boxes of a node of the lowest level contains `per_slot` ≥ 1 triangles.
  IdealRefit(const TriangleMesh& mesh, std::size_t per_slot);
  void run();
  std::size_t triangles() const { return indices_.size() / 3; }
  /// The box of the root, so that the compiler cannot omit work, and for tests.
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
  /// `per_slot_` as a compile-time constant where it is small.
  template <class Count>
  void run_lowest(Count per_slot);
  void run_level(std::size_t level);

  std::size_t per_slot_;
  std::vector<float> positions_;        // x y z of each vertex, and one more float
  std::vector<std::uint32_t> indices_;  // three per triangle; slots are filled by repeating the last
  std::vector<std::vector<Node>> levels_;
  std::vector<std::vector<Bounds>> bounds_;  // the boxes around the nodes of each level
};

}  // namespace supple::benchmarks
