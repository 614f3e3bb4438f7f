#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "placement.hpp"
#include "supple/mesh.hpp"

namespace supple::cli {

/// Frames of one object as mesh files, the first at step 0. After the last it stays, or the first comes
/// again.
struct FrameSequence {
  std::vector<std::filesystem::path> files;  ///< one or more
  bool loop = false;
  std::optional<Placement> placement;  ///< of each frame; none: coordinates as they stand in the files

  const std::filesystem::path& file_at(std::uint64_t frame) const;
};

/// Reads the frames of a sequence on demand.
class FrameFiles {
 public:
  /// Frames must have the vertex count and the triangles of this mesh.
  FrameFiles(FrameSequence sequence, const TriangleMesh& mesh);

  /// Where the vertices are at a step. Throws `Error` when the file cannot be read or is not the same object:
  /// other counts or other triangles.
  void read(std::uint64_t step, std::span<Vec3d> positions) const;

 private:
  FrameSequence sequence_;
  std::size_t vertex_count_;
  std::vector<Triangle> triangles_;
};

/// A mesh file of any format; throws `Error` when there is none.
TriangleMesh read_mesh(const std::filesystem::path& path);

}  // namespace supple::cli
