#pragma once

#include <cstddef>
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

}  // namespace supple
