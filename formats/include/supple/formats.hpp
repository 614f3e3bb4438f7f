#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "supple/mesh.hpp"

namespace supple {

/// Reads a mesh file. `load_mesh` reads OBJ, OFF, PLY and STL; Assimp reads all other formats (glTF and GLB,
/// FBX, COLLADA, 3DS, X3D, ...). The extension selects the reader; its case does not matter.
///
/// With Assimp, all meshes of the file become one mesh, in the order of the node tree, in the file's own
/// units and axes, in the rest pose. The transforms of the nodes are applied in double; the triangles of a
/// mirrored node are reversed. Assimp stores coordinates as float. Points and lines are dropped, polygons
/// are triangulated. These formats repeat a vertex wherever its normal, texture or material changes; so
/// vertices of one node with equal coordinates become one vertex, numbered by first use. Vertices of
/// different nodes stay separate.
///
/// Throws `Error` with the reason when the file cannot be read. Assimp can crash on damaged files; a program
/// that reads files of strangers can call this function in a child process.
TriangleMesh load_any_mesh(const std::filesystem::path& path);

/// Whether `load_any_mesh` gives the file to Assimp, by its extension.
bool is_read_by_assimp(const std::filesystem::path& path);

/// The extensions that `load_any_mesh` reads: lower case, with their dot, sorted. Valid until the program
/// ends.
std::span<const std::string_view> supported_extensions();

}  // namespace supple
