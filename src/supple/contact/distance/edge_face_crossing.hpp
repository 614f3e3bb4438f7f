#pragma once

#include <array>

#include "supple/distance.hpp"

namespace supple {

/// Where the inside of an edge crosses the inside of a face.
struct EdgeFaceCrossing {
  std::array<double, 2> on_edge{};  ///< barycentric coordinates, each to within 2^-45
  std::array<double, 3> on_face{};
  Vec3d point;   ///< as `intersect_triangles` computes it
  Vec3d normal;  ///< of the face, by the right-hand rule
};

/// Whether the ends of an edge are on different sides of the plane of a face and the edge meets the inside of
/// the face: what a distance of 0 of a vertex and a face or of two edges does not say. Exact; false when a
/// coordinate is not finite. Sets `used_exact` when integers decide.
bool edge_crosses_face(const EdgePoints& edge, const TrianglePoints& face, bool& used_exact);

/// For an edge that crosses the face.
EdgeFaceCrossing crossing_of(const EdgePoints& edge, const TrianglePoints& face, bool& used_exact);

}  // namespace supple
