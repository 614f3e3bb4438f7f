#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "supple/formats.hpp"

namespace supple {

/// One animation of a file.
struct AnimationClip {
  std::string name;  ///< of the file; "clip 0", "clip 1", ... where the file has none
  double start = 0;  ///< time of the first key, in seconds
  double end = 0;    ///< time of the last key, in seconds
};

/// A mesh with the animations of its file: moving nodes, skins and morph targets.
///
/// Everything is evaluated in double, with the same bits on every machine: node transforms by steps, linearly
/// (rotations by spherical interpolation) or by cubic splines; morph targets before skins; the weights of a
/// vertex are divided by their sum. ufbx evaluates FBX, also with the same bits: layers, curves, pivots, and
/// curves that go on beyond their keys. A vertex keeps its id, so `mesh().triangles` are those of every pose.
class AnimatedMesh {
 public:
  /// Reads a file as `read_mesh_file` does, with its animations. Files of formats without animations have no
  /// clips. Throws `Error` in the same cases.
  explicit AnimatedMesh(const std::filesystem::path& path);

  /// The mesh in the pose of the file's nodes, as `read_mesh_file` returns it.
  const TriangleMesh& mesh() const;
  const CoordinateFrame& frame() const;
  /// In the order of the file, without those that move no mesh, such as those of cameras.
  std::span<const AnimationClip> clips() const;

  /// Computes the positions of all vertices at a time, in seconds, of the clip with this index. Before its
  /// first key and after its last key, a value stays that of this key; of FBX, before and after the clip.
  /// Throws `Error` when there is no such
  /// clip, when `positions` has not one element for each vertex, or when the time is not finite. Cost: in
  /// proportion to the vertices, their morph targets and joints, and the nodes. Can be called from several
  /// threads at once.
  void positions(std::size_t clip, double time, std::span<Vec3d> positions) const;

 private:
  struct Content;
  std::shared_ptr<const Content> content_;
};

}  // namespace supple
