#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "octree/vertex_buffer.hpp"
#include "supple/scene.hpp"

namespace supple {

/// Where an object is: the positions that the user gave last and the transforms applied since.
///
/// The position of a vertex is fl(R p) + T, where p is the position that the user gave last. `end` holds fl(R
/// p); T is added when volumes and positions are read, so that a translation is O(1). Where that could lose
/// bits or overflow in single precision, T is baked into `end` instead. An object on a path has no T.
///
/// Each function takes all memory before it changes anything, so one that runs out of memory has no effect.
class Placement {
 public:
  void set_positions(const PositionsView& positions, const Parallel& parallel);
  /// Reads the positions in place when their layout allows it.
  void share_positions(const PositionsView& positions, const Parallel& parallel);
  void set_motion(const PositionsView& from, const PositionsView& to, const Parallel& parallel);
  /// Sets some of the positions p. The object comes to rest; its transform and translation stay.
  void set_vertices(std::span<const std::uint32_t> vertices, const PositionsView& positions,
                    const Parallel& parallel);
  /// Adds vertices with these positions p, and on a path with these starts. The positions are not borrowed.
  void append(const PositionsView& positions, const PositionsView& start, const Parallel& parallel);
  void translate(Vec3d offset, const Parallel& parallel);
  void set_transform(const RigidTransform& transform, const Parallel& parallel);
  /// The sign of the determinant of the matrix, which is finite. Exact.
  static int sign_of(const RigidTransform& transform);

  /// The ends of the path without the translation. Both are the same buffer for an object at rest.
  const VertexBuffer& start() const { return has_motion_ ? *start_ : end_; }
  const VertexBuffer& end() const { return end_; }
  bool has_motion() const { return has_motion_; }
  Vec3d translation() const { return is_baked_ ? Vec3d{} : translation_; }
  /// The position of a vertex, and that at the start of its path.
  Vec3d position(std::uint32_t vertex) const { return placed(end_[vertex]); }
  Vec3d start_position(std::uint32_t vertex) const { return placed(start()[vertex]); }

  /// Whether the translation must be baked. `box` encloses the positions without it.
  bool needs_baking(const Aabb& box) const;
  void bake(const Parallel& parallel);

  /// Changes whenever `start` or `end` changes; never 0.
  std::uint64_t version() const { return version_; }
  /// The vertices of `end` that have changed since this version, possibly some others and some twice; nothing
  /// when all vertices may have changed.
  std::optional<std::span<const std::uint32_t>> moved_since(std::uint64_t version) const {
    if (version < moved_since_) return std::nullopt;
    return moved_;
  }
  /// Forgets the vertices that changed before the present version.
  void forget_moved() {
    moved_.clear();
    moved_since_ = version_;
  }
  /// The positions p.
  const VertexBuffer& shape() const { return has_shape_ ? *shape_ : end_; }
  /// Changes when all positions p change, or more than an eighth at once; never 0.
  std::uint64_t shape_version() const { return shape_version_; }
  /// Whether the determinant of R is negative.
  bool is_mirrored() const { return is_mirrored_; }

 private:
  Vec3d rotated(const Vec3d& p) const;
  void change_all();
  Vec3d placed(const Vec3d& p) const;
  void place_afresh();
  void restore(const Parallel& parallel);
  void keep_shape();
  void reserve_transformed();
  void apply(const Vec3d& translation, const Parallel& parallel);

  VertexBuffer end_;
  // Null before they are needed, because most objects never need them.
  std::unique_ptr<VertexBuffer> start_;  // of an object on a path
  std::unique_ptr<VertexBuffer> shape_;  // p, once a transform made `end_` differ from it
  bool has_motion_ = false, has_shape_ = false, is_baked_ = false, is_mirrored_ = false;
  std::array<double, 9> rotation_ = RigidTransform{}.rotation;
  Vec3d translation_;
  std::uint64_t version_ = 1, shape_version_ = 1;
  std::uint64_t moved_since_ = 1;     // version
  std::vector<std::uint32_t> moved_;  // since then
};

}  // namespace supple
