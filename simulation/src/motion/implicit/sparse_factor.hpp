#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "motion/implicit/symmetric_block.hpp"
#include "supple/types.hpp"

namespace supple {

/// Cholesky factors L D Lᵀ of a sparse symmetric matrix of 3 × 3 blocks with a fixed pattern, which is
/// analysed once. Uses Eigen on one thread.
class SparseFactor {
 public:
  /// `pairs` lists the off-diagonal blocks (i, j), i < j, each once; `add` refers to them by index.
  /// O(entries of the factor).
  SparseFactor(std::uint32_t row_count, std::span<const std::array<std::uint32_t, 2>> pairs);
  ~SparseFactor();
  SparseFactor(SparseFactor&&) noexcept;
  SparseFactor& operator=(SparseFactor&&) noexcept;

  void set_zero();
  void add_diagonal(std::uint32_t row, const SymmetricBlock& block);
  void add(std::uint32_t pair, const SymmetricBlock& block);
  /// Adds p qᵀ to the block of the pair.
  void add(std::uint32_t pair, Vec3d p, Vec3d q);

  void factorise();
  /// Solves L D Lᵀ x = b; `x` may be `b`.
  void solve(std::span<const Vec3d> b, std::span<Vec3d> x);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple
