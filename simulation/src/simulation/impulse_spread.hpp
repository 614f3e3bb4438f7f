#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "supple/mesh.hpp"
#include "supple/motion.hpp"

namespace supple {

/// Distributes an impulse on one vertex of a mass-spring body over the vertices around it within a step, by
/// (1 + h²/m L)⁻¹ as a step of backward Euler would. L is the Laplacian of springs that are at least as
/// stiff as those of the body. An impulse on the vertex alone would strain its springs; for large h² k / m
/// that adds more energy than the impulse removes.
///
/// Shares sum to 1, minus the part of fixed vertices. Only the nearest `patch_size` vertices get a share.
class ImpulseSpread {
 public:
  static constexpr std::size_t patch_size = 1024;

  struct Share {
    std::uint32_t vertex = 0;
    double part = 0;
  };

  ImpulseSpread(const TriangleMesh& rest, const MassSpringOptions& springs, double seconds);

  /// Whether both have the same springs and fixed vertices, and so the same shares. Compares all springs.
  bool has_springs_of(const ImpulseSpread& other) const;

  /// Drops cached shares when they take more than 64 MB. Recomputed shares are equal.
  void begin_step();
  /// One share per vertex, none for fixed vertices. Computed on first use, valid until the end of the step.
  std::span<const Share> from(std::uint32_t vertex);
  /// The share of `other` in `from(vertex)`, or 0 when it has none.
  double share(std::uint32_t vertex, std::uint32_t other);

 private:
  struct Neighbor {
    std::uint32_t vertex = 0;
    double stiffness = 0;  // h² k / m
    bool operator==(const Neighbor&) const = default;
  };

  std::span<const Neighbor> neighbors(std::uint32_t vertex) const {
    return std::span(neighbors_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
  }
  void gather_patch(std::uint32_t vertex);
  void multiply(std::span<const double> parts, std::span<double> product) const;
  void solve();
  void select_largest_shares();

  std::vector<std::uint8_t> is_fixed_;
  std::vector<std::uint32_t> first_;  // offset of each vertex in neighbors_, and the end
  std::vector<Neighbor> neighbors_;
  std::vector<std::vector<Share>> shares_;  // one list per vertex; empty until first used
  std::size_t share_count_ = 0;

  // Scratch memory for one patch.
  std::vector<std::uint32_t> patch_, place_;  // the vertices, and the index of each vertex among them
  std::vector<double> parts_, residual_, direction_, product_;
  std::vector<Share> largest_;
};

}  // namespace supple
