#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple::benchmarks {

/// Workload B: copies of one mesh, each rotated at random, on a cubic lattice on which neighbours overlap.
/// Time t grows by 0.1 per frame. Vertex b of the copy at c with phase p is at c + 0.03 sin(t + p) + b (1 +
/// 0.04 sin(3 b.x + 4 b.y + t + p) + 0.015 sin(9 b.z - 7 b.x + 1.7 t + p)).
class DeformingCopies {
 public:
  /// `spacing` is the lattice constant. Only every `one_in`-th copy moves in `advance`.
  DeformingCopies(TriangleMesh mesh, std::size_t copies, double spacing, std::size_t one_in = 1,
                  std::uint64_t seed = 1);

  std::size_t copies() const { return copies_.size(); }
  std::size_t triangle_count() const { return mesh_.triangles.size() * copies_.size(); }
  const std::vector<Triangle>& triangles() const { return mesh_.triangles; }
  const TriangleMesh& mesh() const { return mesh_; }
  /// The current positions of one copy. One float past the last may be read, for loads of four floats.
  std::span<const Vec3f> positions(std::size_t copy) const {
    return std::span(copies_[copy].positions).first(copies_[copy].rest.size());
  }
  const Aabb& bounds(std::size_t copy) const { return copies_[copy].bounds; }
  /// Whether the last `advance` moved the copy.
  bool moves(std::size_t copy) const { return copy % one_in_ == 0; }
  /// Advances by one frame.
  void advance();

 private:
  struct Copy {
    Vec3d center;
    double phase = 0;  // in turns
    std::vector<Vec3f> rest, positions;
    Aabb bounds;
  };
  void deform(Copy& copy) const;

  TriangleMesh mesh_;
  std::size_t one_in_;
  double time_ = 0;
  std::vector<Copy> copies_;
};

/// Makes a cell of workload B: SHAPExCOPIES. SHAPE is `bunny` or the number of triangles of a geodesic
/// sphere of radius 1, such as 980, 18000, 69620 (20 times a square). With the suffix `-rest`, nine of ten
/// copies are at rest. Returns nothing when the bunny's file is missing. Throws `Error` for other names.
std::optional<DeformingCopies> make_deforming_copies(const std::string& name);

}  // namespace supple::benchmarks
