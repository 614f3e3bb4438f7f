#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple::benchmarks {

/// Workload D: objects that deform so far that an octree of their rest pose tells their triangles apart
/// badly, and two in which it does not matter.
class DegradingShapes {
 public:
  struct Shape {
    TriangleMesh rest;
    bool self_collision = false;
    std::vector<Vec3f> positions;  ///< at present
    /// Where a vertex, at rest at p, is at a time.
    std::function<Vec3d(std::uint32_t vertex, Vec3d p, double time)> move;
  };

  /// `soup`: the triangles of two soups drift apart, each its own way. `parts`: two bodies of 64 sheets which
  /// exchange places. `stir`: two spheres, each in one object with a soup that drifts inside. `roll`: a strip
  /// of cloth rolls up, tested against itself and a ball. `crumple`: a sheet of cloth is pushed together, a
  /// ball inside. `swing`: as `parts`, there and back within four frames. `wave`: two spheres whose surfaces
  /// wave. Throws `Error` for other names.
  explicit DegradingShapes(const std::string& name);
  static std::span<const char* const> names();

  std::span<const Shape> shapes() const { return shapes_; }
  /// One frame on.
  void advance();

 private:
  std::vector<Shape> shapes_;
  double frames_ = 0;
};

}  // namespace supple::benchmarks
