#pragma once

#include <cstdint>

namespace supple {

/// Decides when to rebuild the octree of an object: when the accumulated extra query cost reaches the cost of
/// a rebuild. So both together are at most twice the cost of the best choice, whatever the object does next.
///
/// Query costs are those of `query_cost`. Accumulated costs are in queries of the octree as built.
class RebuildPolicy {
 public:
  /// The queries of a test of the object against itself.
  static constexpr double queries_of_self = 8;

  explicit RebuildPolicy(bool is_enabled) : is_enabled_(is_enabled) {}

  /// Call when the octree was built, with the cost at the positions that it was built from.
  void set_cost_when_built(double cost);
  /// Call after each refit. Returns whether to measure the cost and to call `set_cost`: after each refit
  /// while the octree is degraded, otherwise after one in seven, because measuring takes a tenth of a refit.
  bool should_measure();
  void set_cost(double cost) { cost_ = cost; }

  /// A cost relative to the cost when built: 2 when queries cost twice as much; 1 when it is unknown.
  double degradation(double cost) const { return cost > 0 ? cost / cost_when_built_ : 1; }
  /// Whether queries cost so much more that a rebuild can pay.
  bool is_degraded() const;
  /// Adds the queries of a step to the accumulated extra cost. Returns whether it is time to rebuild.
  bool count_queries(double queries);
  /// Returns whether a new octree with this cost should replace the present one. If not, the next attempt
  /// waits for twice the extra cost.
  bool accept(double cost);

 private:
  bool is_enabled_;
  double cost_when_built_ = 1, cost_ = 0;
  std::uint32_t refits_until_measured_ = 1;
  double accumulated_extra_cost_ = 0;
  double backoff_ = 2;  ///< attempt a rebuild at this multiple of its cost
};

}  // namespace supple
