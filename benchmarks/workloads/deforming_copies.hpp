#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple::benchmarks {

/// Workload B: copies of one mesh, each rotated at random, on a cubic lattice so that neighbours overlap. At
/// time t, which grows by 0.1 a frame, vertex b of the copy at c with phase p is at
/// c + 0.03 sin(t + p) + b (1 + 0.04 sin(3 b.x + 4 b.y + t + p) + 0.015 sin(9 b.z - 7 b.x + 1.7 t + p)).
class DeformingCopies {
 public:
  /// `spacing` is the lattice's. Only every `one_in`-th copy moves in `advance`.
  DeformingCopies(TriangleMesh mesh, std::size_t copies, double spacing, std::size_t one_in = 1,
                  std::uint64_t seed = 1);

  std::size_t copies() const { return copies_.size(); }
  std::size_t triangle_count() const { return mesh_.triangles.size() * copies_.size(); }
  const std::vector<Triangle>& triangles() const { return mesh_.triangles; }
  const TriangleMesh& mesh() const { return mesh_; }
  /// Of one copy at present. One coordinate past the last may be read: for those who load four at a time.
  std::span<const Vec3f> positions(std::size_t copy) const {
    return std::span(copies_[copy].positions).first(copies_[copy].rest.size());
  }
  const Aabb& bounds(std::size_t copy) const { return copies_[copy].bounds; }
  /// Whether the last `advance` moved it.
  bool moves(std::size_t copy) const { return copy % one_in_ == 0; }
  /// One frame on.
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

/// A cell of workload B by name: SHAPExCOPIES, SHAPE being the triangles of a geodesic sphere of radius 1,
/// such as 980, 18000, 69620 (20 times a square), or bunny; an ending `-rest` leaves nine copies of ten at
/// rest. Nothing when the bunny is not there; throws `Error` for other names.
std::optional<DeformingCopies> make_deforming_copies(const std::string& name);

}  // namespace supple::benchmarks
