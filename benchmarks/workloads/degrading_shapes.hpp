#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/types.hpp"

namespace supple::benchmarks {

/// Workload D: objects that deform so far that an octree built for the rest pose becomes slow, and two
/// shapes for which it does not.
class DegradingShapes {
 public:
  struct Shape {
    TriangleMesh rest;
    bool self_collision = false;
    std::vector<Vec3f> positions;  ///< current positions
    /// The position at `time` of a vertex with rest position p.
    std::function<Vec3d(std::uint32_t vertex, Vec3d p, double time)> move;
  };

  /// `soup`: the triangles of two soups drift apart, each in its own direction. `parts`: two bodies of 64
  /// sheets that exchange places. `stir`: two objects, each a sphere with a drifting soup inside. `roll`: a
  /// strip of cloth rolls up, tested against itself and a ball. `crumple`: a sheet of cloth is compressed,
  /// with a ball inside. `swing`: like `parts`, back and forth within four frames. `wave`: two spheres with
  /// waves on their surfaces. Throws `Error` for other names.
  explicit DegradingShapes(const std::string& name);
  static std::span<const char* const> names();

  std::span<const Shape> shapes() const { return shapes_; }
  /// Advances by one frame.
  void advance();

 private:
  std::vector<Shape> shapes_;
  double frames_ = 0;
};

}  // namespace supple::benchmarks
