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

/// A held vertex and the vertices around it. Vertices that are farther away at rest follow it less.
struct Grip {
  std::size_t object = 0;
  std::uint32_t vertex = 0;
  std::vector<std::uint32_t> vertices{};  ///< including `vertex`
  /// One per vertex: (1 - r²)², which falls from 1 at the vertex to 0 at the radius, with slope 0 at both
  /// ends.
  std::vector<double> weights{};
  std::vector<Vec3d> from{};  ///< their positions when the grip started
  Vec3d anchor{};             ///< the position of `vertex` then
  /// Damping of the pulling springs, as a multiple of the critical damping of the held masses, chosen so
  /// that the whole body is critically damped.
  double damping = 1;
  /// The pull grows with the distance from the target up to this distance.
  double reach = 0;
  std::optional<Vec3d> target{};  ///< of `vertex`, once it is dragged
};

/// The default `radius` is a fifth of the longest side of the mesh.
Grip take_hold(const TriangleMesh& rest, std::span<const Vec3d> now, std::uint32_t vertex,
               std::optional<double> radius);

/// Moves the held vertices with the target, relative to their positions when the grip started.
void bend(const Grip& grip, std::span<Vec3d> positions);

/// Moves all positions so that the held vertex is at the target.
void carry(const Grip& grip, std::span<Vec3d> positions);

/// Gives the held vertices velocities that bring them closer to the target in a step of length `seconds`, as
/// damped springs integrated by backward Euler would: a rigid body arrives without oscillation. Each pull is
/// stable on its own and weak compared with inertia, so it does not reduce the stable step of the integrator.
/// No vertex moves more than the mean edge length in a step. `is_fixed` may be empty.
void pull(const Grip& grip, const std::vector<bool>& is_fixed, MassSpringBody& body, double seconds,
          std::vector<Vec3d>& velocities);

}  // namespace supple::viewer
