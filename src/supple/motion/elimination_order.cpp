#include "motion/elimination_order.hpp"

#define EIGEN_DONT_PARALLELIZE
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace supple {

std::vector<std::uint32_t> elimination_order(std::uint32_t count,
                                             std::span<const std::array<std::uint32_t, 2>> entries) {
  std::vector<Eigen::Triplet<double, int>> both_halves;
  both_halves.reserve(2 * entries.size() + count);
  // Eigen takes a row without its diagonal for a dense one.
  for (std::uint32_t i = 0; i < count; ++i)
    both_halves.emplace_back(static_cast<int>(i), static_cast<int>(i), 1);
  for (const auto& [p, q] : entries) {
    both_halves.emplace_back(static_cast<int>(p), static_cast<int>(q), 1);
    both_halves.emplace_back(static_cast<int>(q), static_cast<int>(p), 1);
  }
  const auto size = static_cast<Eigen::Index>(count);
  Eigen::SparseMatrix<double, Eigen::ColMajor, int> pattern(size, size);
  pattern.setFromTriplets(both_halves.begin(), both_halves.end());
  Eigen::AMDOrdering<int> minimum_degree;
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  minimum_degree(pattern, permutation);
  std::vector<std::uint32_t> order;
  order.reserve(count);
  for (Eigen::Index i = 0; i < size; ++i) {
    order.push_back(static_cast<std::uint32_t>(permutation.indices()[i]));
  }
  return order;
}

}  // namespace supple
