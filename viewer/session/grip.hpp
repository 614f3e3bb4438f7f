#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/motion.hpp"
#include "supple/types.hpp"

namespace supple::viewer {

/// A vertex that is held, and those about it that come along, the less the further away they are at rest.
struct Grip {
  std::size_t object = 0;
  std::uint32_t vertex = 0;
  std::vector<std::uint32_t> vertices{};  ///< with `vertex`
  /// From 1 at the vertex to 0 at the radius, smoothly at both: (1 - r²)², the slope being 0 at 0 and at 1.
  std::vector<double> weights{};
  std::vector<Vec3d> from{};  ///< where these vertices were when it was taken
  Vec3d anchor{};             ///< and where the vertex was
  /// Of the springs that pull: times the critical damping of the masses they hold, so that it is that of the
  /// whole body, which hangs on them.
  double damping = 1;
  /// How far from its target a vertex pulls at most.
  double reach = 0;
  std::optional<Vec3d> target{};  ///< of the vertex, once it is dragged
};

/// Without `radius`, a fifth of the longest side of the mesh.
Grip take_hold(const TriangleMesh& rest, std::span<const Vec3d> now, std::uint32_t vertex,
               std::optional<double> radius);

/// Moves the vertices of the grip with its target, from where they were when it was taken.
void bend(const Grip& grip, std::span<Vec3d> positions);

/// Gives the vertices of the grip velocities that bring them nearer to the target in a step of that length,
/// as damped springs would that a step of backward Euler carries on: a body that moves as a whole gets there
/// without swinging. Each is stable by itself, and weak beside the inertia of the mass, so that it does not
/// disturb what an integrator bears; none moves a vertex by more than the mesh's mean edge in a step.
/// `is_fixed` may be empty.
void pull(const Grip& grip, const std::vector<bool>& is_fixed, MassSpringBody& body, double seconds,
          std::vector<Vec3d>& velocities);

}  // namespace supple::viewer
