#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "supple/types.hpp"

namespace supple {

/// The positions of the vertices of a mesh in each frame, from a point cache: .pc2 (of 3ds Max, Blender and
/// others) or .mdd (of LightWave, Blender and others). Vertices have the order of the mesh file, which has
/// other formats than the cache, usually OBJ. The whole file is kept in memory: 12 bytes for each vertex and
/// frame.
class PointCache {
 public:
  /// Throws `Error` when the file cannot be read, has another extension, or is not complete.
  explicit PointCache(const std::filesystem::path& path);

  std::uint64_t frame_count() const;  ///< at least 1
  std::size_t vertex_count() const;

  /// Reads the positions of a frame, which the file has as float. Throws `Error` when there is no such frame,
  /// or when `positions` has not one element for each vertex. Can be called from several threads at once.
  void positions(std::uint64_t frame, std::span<Vec3d> positions) const;

 private:
  struct Content;
  std::shared_ptr<const Content> content_;
};

}  // namespace supple
