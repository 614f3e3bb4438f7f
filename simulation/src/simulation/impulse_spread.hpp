#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/motion.hpp"

namespace supple {

/// How an impulse on one vertex of a body of masses and springs is shared out to those about it within a
/// step: by (1 + h²/m L)⁻¹, as a step of backward Euler would, with the Laplacian L of the springs, which is
/// at least as stiff as they are. Without that springs would be strained by what the vertex alone moves in a
/// step, which takes more energy than the impulse does when h² k / m is large.
///
/// Shares sum to 1, but for what goes into fixed vertices. Only the nearest `patch_size` vertices share.
class ImpulseSpread {
 public:
  static constexpr std::size_t patch_size = 1024;

  struct Share {
    std::uint32_t vertex = 0;
    double part = 0;
  };

  ImpulseSpread(const TriangleMesh& rest, const MassSpringOptions& springs, double seconds);

  /// Forgets shares when those kept take more than 64 MB; they come out the same again.
  void begin_step();
  /// By vertex. Nothing of fixed vertices. Computed when first asked for, valid until the step's end.
  std::span<const Share> from(std::uint32_t vertex);
  /// Of `from(vertex)` that of `other`, 0 when it has none.
  double share(std::uint32_t vertex, std::uint32_t other);

 private:
  struct Neighbor {
    std::uint32_t vertex = 0;
    double stiffness = 0;  // h² k / m
  };

  std::span<const Neighbor> neighbors(std::uint32_t vertex) const {
    return std::span(neighbors_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
  }
  void gather_patch(std::uint32_t vertex);
  void multiply(std::span<const double> parts, std::span<double> product) const;
  void solve();
  std::vector<Share> largest_shares() const;

  std::vector<std::uint8_t> is_fixed_;
  std::vector<std::uint32_t> first_;  // in neighbors_, of each vertex; one more at the end
  std::vector<Neighbor> neighbors_;
  std::vector<std::vector<Share>> shares_;  // by vertex; empty until asked for
  std::size_t share_count_ = 0;

  // Scratch of one patch.
  std::vector<std::uint32_t> patch_, place_;  // vertices, and of each vertex its place among them
  std::vector<double> parts_, residual_, direction_, product_;
};

}  // namespace supple
