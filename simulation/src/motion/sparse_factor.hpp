#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "motion/symmetric_block.hpp"
#include "supple/types.hpp"

namespace supple {

/// Cholesky's factors L D Lᵀ of a sparse symmetric matrix of 3 × 3 blocks whose pattern stays: Eigen's, on
/// one thread. The pattern is analysed once.
class SparseFactor {
 public:
  /// `pairs` of different rows (i, j), i < j, that have a block; each once. They are named by their place
  /// here. O(entries of the factor).
  SparseFactor(std::uint32_t row_count, std::span<const std::array<std::uint32_t, 2>> pairs);
  ~SparseFactor();
  SparseFactor(SparseFactor&&) noexcept;
  SparseFactor& operator=(SparseFactor&&) noexcept;

  void set_zero();
  void add_diagonal(std::uint32_t row, const SymmetricBlock& block);
  void add(std::uint32_t pair, const SymmetricBlock& block);
  /// p qᵀ at row i and column j of the pair.
  void add(std::uint32_t pair, Vec3d p, Vec3d q);

  void factorise();
  /// L D Lᵀ x = b; `x` may be `b`.
  void solve(std::span<const Vec3d> b, std::span<Vec3d> x);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace supple
