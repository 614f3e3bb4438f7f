#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "inputs/placement.hpp"
#include "supple/formats.hpp"

namespace supple::cli {

/// Frames of one object as mesh files, starting at step 0. After the last file, the object stays or starts
/// again with the first file.
struct FrameSequence {
  std::vector<std::filesystem::path> files;  ///< one or more
  bool loop = false;
  std::optional<Placement> placement;  ///< of each frame; none: the coordinates of the files are used
  CoordinateConversion conversion{};   ///< of each file, before the placement

  const std::filesystem::path& file_at(std::uint64_t frame) const;
};

/// Reads the frames of a sequence on demand.
class FrameFiles {
 public:
  /// Frames must have the number of vertices of this mesh, and its triangles, edges and points. Formats
  /// without vertex ids, such as STL, must have as many triangles: each of their corners moves the vertex
  /// that it has in this mesh.
  FrameFiles(FrameSequence sequence, const TriangleMesh& mesh);

  /// Reads the positions at a step. Throws `Error` when the file cannot be read, or when it has other counts
  /// or other triangles, edges or points.
  void read(std::uint64_t step, std::span<Vec3d> positions) const;

 private:
  /// Gives each vertex of the first frame the place of its corners. Returns a vertex whose corners part.
  std::optional<std::uint32_t> place_by_corners(const TriangleMesh& mesh, std::span<Vec3d> positions) const;

  FrameSequence sequence_;
  std::size_t vertex_count_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
  std::vector<std::uint32_t> points_;
};

std::string lower_case_extension(const std::filesystem::path& path);

/// Whether any conversion is wanted.
constexpr bool is_given(const CoordinateConversion& conversion) {
  return conversion.up != UpAxis::file || conversion.unit != LengthUnit::file;
}

/// Reads a mesh file of any format, with the conversion. A file whose reader can crash is read in a child
/// process. Throws `Error` when the file does not exist.
MeshFile read_mesh(const std::filesystem::path& path, const CoordinateConversion& conversion = {});

/// As `read_mesh_file`, in a child process. So a file that makes Assimp crash is an `Error`, and not the end
/// of this program.
MeshFile read_in_child(const std::filesystem::path& path);

}  // namespace supple::cli
