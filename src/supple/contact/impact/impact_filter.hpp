#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "contact/impact/relative_motion.hpp"
#include "mesh/vertex_arrays.hpp"

namespace supple {

/// Up to 64 relative motions of one kind of elements, each coordinate rounded to float once. The fourth
/// number of each row is unspecified.
struct RelativeMotionBlock {
  static constexpr std::size_t capacity = 64;
  enum Row : std::size_t { m, u, w, end, row_count = 6 };

  alignas(64) float rows[row_count][capacity][4];

  void set(std::size_t pair, const RelativeMotion& motion);
};

/// The paths of the vertices of an object: their positions at both ends of the step. Four scalars from each
/// vertex on must be readable.
template <class Scalar>
struct VertexPaths {
  VertexArray<Scalar> start, end;
};

/// Sets the motions of `count` pairs from time 0 to `latest`. Vertex i of pair k, in the order of
/// `VertexFaceMotion` or `EdgeEdgeMotion`, is vertex `vertices[k][i]` of `paths[i]`. Coordinates may differ
/// in the last bit between instruction sets when `latest` is less than 1.
void set_motions(const std::array<VertexPaths<float>, 4>& paths, const std::array<std::uint32_t, 4>* vertices,
                 std::size_t count, bool are_edges, float latest, RelativeMotionBlock& block);
void set_motions(const std::array<VertexPaths<double>, 4>& paths,
                 const std::array<std::uint32_t, 4>* vertices, std::size_t count, bool are_edges,
                 float latest, RelativeMotionBlock& block);

/// Bit i is set when pair i may come within `separation` (≥ 0) during the step. Never misses a pair, and
/// rejects most pairs whose boxes overlap. Takes 5 to 10 ns a pair.
std::uint64_t may_touch(const RelativeMotionBlock& block, std::size_t count, bool is_square,
                        float separation);

}  // namespace supple
