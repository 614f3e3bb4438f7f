#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/views.hpp"

namespace supple {

class NodeVolumes;
class PairSearch;
struct OctreeTopology;

/// Methods that only serve comparisons with the defaults. They are in the library supple::comparison.
struct ComparisonMethods {
  /// For all kinds but boxes.
  std::unique_ptr<NodeVolumes> (*node_volumes)(BoundingVolume kind, SphereFit fit, std::size_t nodes);
  /// For all builds but the balanced one.
  OctreeTopology (*octree)(const PositionsView& positions, std::span<const Triangle> triangles,
                           std::span<const Vec3d> centers, const ObjectOctreeOptions& options);
  /// For `sweep` and `brute`.
  std::unique_ptr<PairSearch> (*pair_search)(BroadPhaseMethod method);
};

/// Any number of threads may set the same methods, which must live until the end.
void set_comparison_methods(const ComparisonMethods& methods);
/// Throws `Error` when no methods were set. `option` names what needs them.
const ComparisonMethods& comparison_methods(const std::string& option);

}  // namespace supple
