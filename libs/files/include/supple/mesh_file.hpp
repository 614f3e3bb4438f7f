#pragma once

#include <string>

#include "supple/mesh.hpp"

namespace supple {

/// Reads an OBJ, OFF, PLY (ASCII, little or big endian, float or double) or STL (ASCII or binary) file. The
/// extension, in either case, selects the format.
///
/// Coordinates keep the precision of the file, and ids keep its order: vertex i is the i-th vertex of the
/// file. Texture and normal ids are ignored. Unused vertices stay. The lines of an OBJ file become edges,
/// n - 1 for a polyline of n vertices, and its points become points; so do the edges of a PLY file. A face of
/// two corners is an edge, and a face of one corner is a point, but not in STL. Faces of OFF and PLY without
/// corners are left out. STL has no ids: corners with equal coordinates become one vertex, numbered by first
/// use.
///
/// A polygon of n corners becomes n - 2 triangles, in file order, that cover the inside of its outline once.
/// They are the fan around its first corner where this fan stays inside, as in convex polygons. The outline
/// is seen along the axis in which its area is the largest; in this view the cut is exact, also for corners
/// on one line and for corners and edges that coincide. The triangles of an outline that crosses itself
/// overlap, or some of them turn the other way; `TriangleMesh::polygons` counts these polygons, and those
/// that are not flat.
///
/// Throws `Error`; the message names the file, the line or byte, the value, and the allowed values.
TriangleMesh load_mesh(const std::string& path);

/// Writes a file in the format of its extension: .obj, .off, .ply (binary little endian, double), .stl
/// (binary, single precision). Text formats print the shortest digits that read back to the same double.
/// Throws `Error` when the extension is unknown, when the file cannot be written, and when the mesh has edges
/// or points of no triangle and the format is not OBJ.
void save_mesh(const TriangleMesh& mesh, const std::string& path);

}  // namespace supple
