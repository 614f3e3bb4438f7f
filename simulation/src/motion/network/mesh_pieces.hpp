#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "supple/mesh.hpp"

namespace supple {

/// Whether a triangle has a repeated vertex id.
inline bool spans_nothing(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// For each vertex, the lowest vertex id of its connected component.
std::vector<std::uint32_t> lowest_of_piece(const TriangleMesh& mesh);

/// Pairs of vertices that make the pieces of a mesh one piece: each piece but the largest is connected to the
/// larger ones. Of its vertices, the 16 that are nearest to a larger piece are each connected to the three
/// corners of the nearest triangle. Vertices of no triangle, and those that are not finite, stay alone. Each
/// pair (a, b) has a < b; sorted, without duplicates. O(n log n + p²) for p pieces.
std::vector<std::array<std::uint32_t, 2>> connections_of_pieces(const TriangleMesh& mesh);

}  // namespace supple
