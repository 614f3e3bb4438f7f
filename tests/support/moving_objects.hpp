#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "inspect/validation.hpp"
#include "narrow_phase/traversal.hpp"
#include "support/soups.hpp"

namespace supple {

/// A moving mesh with all data that the narrow phase needs.
struct MovingObject {
  /// An empty `end` means that the mesh is at rest.
  MovingObject(const TriangleMesh& mesh_in, const std::vector<Vec3d>& end_in,
               const ObjectOctreeOptions& options = {}, bool floats = true, std::uint32_t threads = 1)
      : mesh(mesh_in),
        octree(mesh.positions, mesh.triangles, options, BoundingVolume::aabb, SphereFit::vertices),
        elements(octree),
        at_rest(end_in.empty()) {
    const Parallel parallel(threads);
    assign(start, mesh.positions, floats, parallel);
    if (!at_rest) assign(end, end_in, floats, parallel);
    boxes.refit(octree, elements, start, end_positions(), parallel);
  }
  const VertexBuffer& end_positions() const { return at_rest ? start : end; }
  OctreeView view() const { return moving_view_of(octree, elements, boxes, translation); }
  /// Copies positions in the user's order to a buffer in the order of the elements.
  void assign(VertexBuffer& buffer, const std::vector<Vec3d>& positions, bool floats,
              const Parallel& parallel) {
    VertexBuffer given;
    std::vector<Vec3f> rounded;
    for (const Vec3d& p : positions) {
      rounded.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    if (floats) given.assign(rounded, parallel);
    if (!floats) given.assign(positions, parallel);
    buffer.gather(given, elements.vertex_ids(), parallel);
  }
  std::string validate() const {
    const std::string wrong = fault_of(elements, octree);
    return wrong.empty() ? fault_of(boxes, octree, elements, start, end_positions()) : wrong;
  }
  /// The stored position of a vertex in the user's numbering.
  Vec3d position(std::uint32_t vertex, bool at_end) const {
    const auto ids = elements.vertex_ids();
    const auto number = std::find(ids.begin(), ids.end(), vertex) - ids.begin();
    return (at_end ? end_positions() : start)[static_cast<std::uint32_t>(number)];
  }

  TriangleMesh mesh;
  ObjectOctree octree;
  SurfaceElements elements;
  VertexBuffer start, end;
  bool at_rest;
  MovingBoxes boxes;
  Vec3d translation;
};

/// Moves all vertices by `common`, and each coordinate by a random offset of at most `distance`.
inline std::vector<Vec3d> displaced(const TriangleMesh& mesh, double distance, std::uint64_t seed,
                                    Vec3d common = {}) {
  RandomNumbers random(seed);
  std::vector<Vec3d> positions;
  for (const Vec3d& p : mesh.positions) positions.push_back(p + common + random.vector(distance));
  return positions;
}

}  // namespace supple
