#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "supple/options.hpp"
#include "supple/views.hpp"

namespace supple {

/// The triangles of an object. Throws an error that names the object for a vertex that it does not have.
std::vector<Triangle> checked_triangles(const std::string& name, std::size_t vertex_count,
                                        const TrianglesView& view, const Parallel& parallel);

/// The edges and points of no triangle, as triangles with repeated corners, in the order of the user. Throws
/// as above, and when both ends of an edge are the same.
std::vector<Triangle> checked_extra_elements(std::size_t vertex_count, const ObjectOptions& options);

/// Replaces each vertex by the one that counts in its place.
template <class SameVertex>
void merge_welded(std::vector<Triangle>& elements, const SameVertex& same_vertex) {
  for (Triangle& element : elements) {
    for (std::uint32_t& vertex : element) vertex = same_vertex(vertex);
  }
}
/// The same for edges and points of no triangle. Edges whose ends are welded become points.
template <class SameVertex>
void merge_welded_elements(std::vector<Triangle>& elements, const SameVertex& same_vertex) {
  merge_welded(elements, same_vertex);
  for (Triangle& edge : elements) {
    std::sort(edge.begin(), edge.begin() + 2);
    edge[2] = edge[1];
  }
}

}  // namespace supple
