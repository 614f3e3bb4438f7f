#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "placement.hpp"
#include "supple/mesh.hpp"

namespace supple::cli {

/// Frames of one object as mesh files, starting at step 0. After the last file, the object stays or starts
/// again with the first file.
struct FrameSequence {
  std::vector<std::filesystem::path> files;  ///< one or more
  bool loop = false;
  std::optional<Placement> placement;  ///< of each frame; none: the coordinates of the files are used

  const std::filesystem::path& file_at(std::uint64_t frame) const;
};

/// Reads the frames of a sequence on demand.
class FrameFiles {
 public:
  /// Frames must have the number of vertices of this mesh, and its triangles, edges and points.
  FrameFiles(FrameSequence sequence, const TriangleMesh& mesh);

  /// Reads the positions at a step. Throws `Error` when the file cannot be read, or when it has other counts
  /// or other triangles, edges or points.
  void read(std::uint64_t step, std::span<Vec3d> positions) const;

 private:
  FrameSequence sequence_;
  std::size_t vertex_count_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
  std::vector<std::uint32_t> points_;
};

/// Reads a mesh file of any format. Throws `Error` when the file does not exist.
TriangleMesh read_mesh(const std::filesystem::path& path);

}  // namespace supple::cli
