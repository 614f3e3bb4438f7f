#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simulation/random.hpp"
#include "supple/motion.hpp"
#include "supple/simulation.hpp"
#include "supple/types.hpp"

namespace supple {

/// Random forces that bend a body without moving it: smooth waves about as long as the body, so that
/// neighbours get similar forces. For each connected piece, the sum and the torque are zero up to rounding,
/// so pieces do not separate. Vertices that are not finite get no force.
///
/// Forces that change go from one field of waves to the next by weights whose squares have the sum 1, so that
/// their size stays about the same.
class DeformingForces {
 public:
  DeformingForces(std::span<const Vec3d> rest, std::span<const MassSpringBody::Spring> springs,
                  const MassSpringMotion& motion, Random random);

  /// Whether the forces change as long as the body moves.
  bool change() const { return change_seconds_ > 0; }
  /// The forces on the body at rest, one for each vertex.
  std::span<const Vec3d> constant() const { return from_; }
  /// The forces at a time that is not before that of the call before. O(n), without allocation except when
  /// the next field begins. Sum and torque are zero at these positions.
  std::span<const Vec3d> at(double seconds, std::span<const Vec3d> positions);

 private:
  using Piece = std::vector<std::uint32_t>;  // vertices that springs connect

  std::vector<Vec3d> next_field();
  void keep_in_place(std::span<const Vec3d> positions, std::vector<Vec3d>& forces) const;

  double size_, change_seconds_;
  Random random_;
  std::vector<Piece> pieces_;
  std::vector<Vec3d> rest_;  // from the centre
  double vertex_count_ = 0;  // of those that get forces
  double length_ = 0;        // longest side of the bounding box at rest
  double changes_ = 0;       // complete ones
  std::vector<Vec3d> from_, to_, now_;
};

}  // namespace supple
