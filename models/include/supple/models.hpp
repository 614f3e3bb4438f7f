#pragma once

#include <span>
#include <string_view>

#include "supple/mesh.hpp"

namespace supple {

/// Names of the built-in models, which replace the models of the paper, with their numbers of vertices and
/// faces: pawn (154, 304), fish (216, 338), rabbit (453, 902), human (1250, 2500), bike (9543, 18238).
std::span<const std::string_view> model_names();

/// Makes a built-in model: y up, centered on the origin, longest side 1, with the same bits on every machine.
/// Throws `Error` when there is no such model; the message lists the names.
TriangleMesh make_model(std::string_view name);

/// Geodesic sphere of radius 1: an icosahedron with each edge divided into `frequency` ≥ 1 parts;
/// 20 frequency² triangles.
TriangleMesh make_icosphere(std::uint32_t frequency);

/// Torus around the y axis: `rings` ≥ 3 around the axis, `sides` ≥ 3 around the tube; 2·rings·sides
/// triangles.
TriangleMesh make_torus(std::uint32_t rings, std::uint32_t sides, double major_radius = 0.5,
                        double minor_radius = 0.2);

/// Axis-aligned box from -size/2 to size/2. Each face is a grid of `resolution` ≥ 1 squares per side. Faces
/// share the vertices on edges; 12 resolution² triangles.
TriangleMesh make_box(Vec3d size, std::uint32_t resolution = 1);

/// Flat sheet in the xz plane with normal +y and side lengths `width` and `depth`: columns × rows squares
/// with alternating diagonals; 2·columns·rows triangles.
TriangleMesh make_cloth(std::uint32_t columns, std::uint32_t rows, double width = 1, double depth = 1);

}  // namespace supple
