#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "supple/mesh.hpp"

namespace supple {

/// Reads a mesh of any format: OBJ, OFF, PLY and STL by `load_mesh`, all others (glTF and GLB, FBX, COLLADA,
/// 3DS, X3D, ...) by Assimp, told by the extension whatever the case.
///
/// Of these, all meshes of the scene become one, in the order of its tree of nodes, in the scene's own units
/// and axes, rest pose; the nodes' transforms are applied in double, a mirrored node's triangles turned
/// around. Assimp keeps coordinates as float. Points and lines are dropped, polygons cut into triangles.
/// Vertices with equal coordinates in one node become one vertex, numbered by first use, since these formats
/// repeat a vertex wherever its normal, texture or material changes; those of different nodes stay apart.
/// Throws `Error` with the reason when the file cannot be read.
TriangleMesh load_any_mesh(const std::filesystem::path& path);

/// What `load_any_mesh` reads: extensions in lower case with their dot, sorted. Lasts as long as the program.
std::span<const std::string_view> supported_extensions();

}  // namespace supple
