#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "supple/formats.hpp"

namespace supple {

// Readers of this library's own. They take the bytes of a whole file and its name for messages, and leave the
// name of the mesh empty. docs/formats.md says what they read. Memory: in proportion to the file.

/// Gmsh's .msh of versions 1, 2, 4.0 and 4.1: text, and binary in either byte order.
TriangleMesh read_gmsh(std::string_view bytes, const std::string& file);

/// VTK's legacy .vtk, text or binary: POLYDATA and UNSTRUCTURED_GRID.
TriangleMesh read_vtk(std::string_view bytes, const std::string& file);

/// Medit's .mesh (text).
TriangleMesh read_medit(std::string_view bytes, const std::string& file);

/// Medit's .meshb (binary, either byte order).
TriangleMesh read_medit_binary(std::string_view bytes, const std::string& file);

/// One of the files of TetGen. An absent file has no name.
struct TetgenFile {
  std::string_view bytes;
  std::string name;
};
TriangleMesh read_tetgen(const TetgenFile& nodes, const TetgenFile& elements, const TetgenFile& faces);

/// 3MF, with its unit; z is up.
MeshFile read_3mf(std::string_view bytes, const std::string& file);

/// AMF, as XML or as an archive of it, with its unit.
MeshFile read_amf(std::string_view bytes, const std::string& file);

/// VTK's .vtu and .vtp: unstructured grids and polygons in XML; text or binary, as they are or compressed by
/// zlib.
TriangleMesh read_vtk_xml(std::string_view bytes, const std::string& file);

/// MFEM's meshes of version 1.
TriangleMesh read_mfem(std::string_view bytes, const std::string& file);

}  // namespace supple
