#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "supple/mesh.hpp"

namespace supple {

/// The axis that points up. `file`: as the file has it.
enum class UpAxis : std::uint8_t { file, x, y, z };

/// A unit of length. `file`: as the file has it.
enum class LengthUnit : std::uint8_t { file, um, mm, cm, m, km, in, ft };

/// What a file states about its coordinates.
struct CoordinateFrame {
  UpAxis up = UpAxis::file;  ///< `file`: the file does not state it
  double unit = 0;           ///< length of one unit in metres; 0: the file does not state it
};

/// The axes and the unit that are wanted instead of those of the file.
struct CoordinateConversion {
  UpAxis up = UpAxis::file;
  LengthUnit unit = LengthUnit::file;
};

/// Whether the file states what the conversion needs, in part or in whole. Otherwise `convert` has no effect.
bool can_convert(const CoordinateFrame& frame, const CoordinateConversion& wanted);

/// Turns and scales positions of a file. What the file does not state is not converted. The turn exchanges
/// coordinates and changes signs, without rounding; it keeps the axes right-handed: from y up to z up it is
/// (x, -z, y), from x up to y up (-y, x, z). The scale is one multiplication for each coordinate.
void convert(std::span<Vec3d> positions, const CoordinateFrame& frame, const CoordinateConversion& wanted);

/// A mesh file with what it states beside the mesh.
struct MeshFile {
  TriangleMesh mesh;
  CoordinateFrame frame{};
  std::vector<std::string>
      clips{};  ///< names of its animations (animation.hpp); the mesh is the pose at rest
};

/// Reads a mesh file. `load_mesh` reads OBJ, OFF, PLY and STL; own readers read glTF and GLB, 3MF, AMF, and
/// the surfaces of meshes with solids (Gmsh, VTK, TetGen, Medit, MFEM); ufbx reads FBX; Assimp reads all
/// other formats (COLLADA, 3DS, X3D, ..., and FBX in builds without ufbx). The extension selects the reader;
/// its case does not matter. Of Medit, MFEM and Ogre, which share .mesh, the content selects. docs/formats.md
/// has a table of what is read, and says which triangles the surface of a mesh with solids has.
///
/// All meshes of a glTF or FBX file or of a file that Assimp reads become one mesh, in the order of the node
/// tree, in the file's own units and axes: coordinates are those of the file. Left-handed formats (X, B3D,
/// LWO, PMX) keep their coordinates, too. glTF always has metres and y up. The exception is IFC, which is in
/// metres.
///
/// The transforms of the nodes are applied in double; the triangles of a mirrored node are reversed. Skins
/// and morph targets have the pose of the file's nodes and default weights. A skinned mesh follows its
/// joints, not its own node. Assimp stores coordinates as float. Points and lines are dropped, polygons are
/// triangulated. These formats repeat a vertex wherever its normal, texture or material changes; so vertices
/// of one node that have equal coordinates, morph targets and skin weights become one vertex, numbered by
/// first use. Vertices of different nodes stay separate. FBX by ufbx keeps the vertices of each mesh and
/// their order, also unused ones.
///
/// glTF 2.0 may use KHR_mesh_quantization, KHR_draco_mesh_compression, EXT_meshopt_compression and
/// EXT_mesh_gpu_instancing. An unknown extension that the file requires is an error that names it.
///
/// Throws `Error` with the reason when the file cannot be read. Assimp can crash on damaged files: a program
/// that reads files of strangers refuses those for which `is_read_by_assimp` is true, or calls this function
/// in a child process (docs/formats.md, "Files of strangers"). The message for a format without
/// a reader names the format and what to export instead, also when only the first bytes of the file tell it.
MeshFile read_mesh_file(const std::filesystem::path& path);

/// The mesh of `read_mesh_file`.
TriangleMesh load_any_mesh(const std::filesystem::path& path);

/// Whether `read_mesh_file` gives the file to Assimp, by its extension, and for .mesh by its content.
bool is_read_by_assimp(const std::filesystem::path& path);

/// The extensions that `read_mesh_file` reads: lower case, with their dot, sorted. Valid until the program
/// ends.
std::span<const std::string_view> supported_extensions();

}  // namespace supple
