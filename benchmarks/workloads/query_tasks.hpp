#pragma once

#include <optional>
#include <string>
#include <vector>

#include "supple/queries.hpp"
#include "workloads/deforming_copies.hpp"

namespace supple::benchmarks {

/// What is asked: the nearest point of the surface, whether points are inside, the first triangles on rays,
/// the vertices of both copies that are inside the other one, with their depths, or the distance of two
/// copies that move without deformation.
enum class QueryTaskKind { closest, inside, rays, penetration, distance };

/// Workload Q: 100,000 queries to copies of one mesh, or the penetrations of two copies. All coordinates are
/// single precision.
struct QueryTask {
  QueryTaskKind kind = QueryTaskKind::closest;
  DeformingCopies copies;
  std::vector<Vec3d> points{};
  std::vector<Ray> rays{};  ///< of directions in the whole scene, without an order
  Vec3d offset{};           ///< of the second copy, for distances

  /// The copies deform before each frame of rays and penetrations; for points they are at rest. For
  /// distances, the second one moves.
  void advance() {
    if (kind == QueryTaskKind::distance) offset += {0.001, 0.0005, -0.0002};
    if (kind == QueryTaskKind::rays || kind == QueryTaskKind::penetration) copies.advance();
  }
};

/// `closest/SHAPE-uniform` has points in the box of the mesh, `closest/SHAPE-near` points within 1 % of the
/// box of a vertex, `inside/SHAPE` points in the box, `rays/SHAPExCOPIES` and `penetration/SHAPE` copies as
/// in `make_deforming_copies`. With `penetration/SHAPE-deep`, the copies are 0.4 apart, so that most of each
/// is inside the other. `distance/SHAPE-apart` and `distance/SHAPE-near` have copies that are about two radii
/// and a twentieth of a radius apart. Returns nothing when a file is missing. Throws `Error` for other names.
std::optional<QueryTask> make_query_task(const std::string& name);

}  // namespace supple::benchmarks
