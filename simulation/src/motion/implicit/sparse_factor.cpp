#include "motion/implicit/sparse_factor.hpp"

// Without vector instructions Eigen does the same operations in the same order on every machine.
#define EIGEN_DONT_VECTORIZE
#define EIGEN_DONT_PARALLELIZE
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cstddef>
#include <vector>

namespace supple {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

/// For each column of a block, its first position among the values of the matrix.
using Place = std::array<int, 3>;

}  // namespace

/// The lower triangle. Each block column is three scalar columns, which begin with the diagonal block.
struct SparseFactor::Implementation {
  Matrix matrix;
  std::vector<Place> pairs;
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower> cholesky;
  Eigen::VectorXd right, solution;
  bool is_analysed = false;

  void lay_out(std::uint32_t rows, std::span<const std::array<std::uint32_t, 2>> blocks);
};

void SparseFactor::Implementation::lay_out(std::uint32_t rows,
                                           std::span<const std::array<std::uint32_t, 2>> blocks) {
  std::vector<std::uint32_t> sorted(blocks.size());
  for (std::uint32_t i = 0; i < sorted.size(); ++i) sorted[i] = i;
  std::sort(sorted.begin(), sorted.end(),
            [&](std::uint32_t a, std::uint32_t b) { return blocks[a] < blocks[b]; });
  const auto size = 3 * static_cast<Eigen::Index>(rows);
  matrix.resize(size, size);
  matrix.resizeNonZeros(static_cast<Eigen::Index>(6 * std::size_t{rows} + 9 * blocks.size()));
  pairs.resize(blocks.size());
  int* const outer = matrix.outerIndexPtr();
  int* const inner = matrix.innerIndexPtr();
  int value = 0;
  auto first = sorted.begin();
  for (std::uint32_t column = 0; column < rows; ++column) {
    const auto last =
        std::find_if(first, sorted.end(), [&](std::uint32_t pair) { return blocks[pair][0] != column; });
    for (int c = 0; c < 3; ++c) {
      outer[3 * column + static_cast<std::uint32_t>(c)] = value;
      for (int r = c; r < 3; ++r) inner[value++] = 3 * static_cast<int>(column) + r;
      for (auto pair = first; pair != last; ++pair) {
        pairs[*pair][static_cast<std::size_t>(c)] = value;
        for (int r = 0; r < 3; ++r) inner[value++] = 3 * static_cast<int>(blocks[*pair][1]) + r;
      }
    }
    first = last;
  }
  outer[size] = value;
}

SparseFactor::SparseFactor(std::uint32_t row_count, std::span<const std::array<std::uint32_t, 2>> pairs)
    : implementation_(std::make_unique<Implementation>()) {
  implementation_->lay_out(row_count, pairs);
}
SparseFactor::~SparseFactor() = default;
SparseFactor::SparseFactor(SparseFactor&&) noexcept = default;
SparseFactor& SparseFactor::operator=(SparseFactor&&) noexcept = default;

void SparseFactor::set_zero() {
  Matrix& matrix = implementation_->matrix;
  std::fill_n(matrix.valuePtr(), matrix.nonZeros(), 0.0);
}

void SparseFactor::add_diagonal(std::uint32_t row, const SymmetricBlock& block) {
  Matrix& matrix = implementation_->matrix;
  double* const values = matrix.valuePtr() + matrix.outerIndexPtr()[3 * row];
  double* const second = matrix.valuePtr() + matrix.outerIndexPtr()[3 * row + 1];
  double* const third = matrix.valuePtr() + matrix.outerIndexPtr()[3 * row + 2];
  values[0] += block.xx;
  values[1] += block.xy;
  values[2] += block.xz;
  second[0] += block.yy;
  second[1] += block.yz;
  third[0] += block.zz;
}

void SparseFactor::add(std::uint32_t pair, const SymmetricBlock& block) {
  double* const values = implementation_->matrix.valuePtr();
  const Place& place = implementation_->pairs[pair];
  const std::array<Vec3d, 3> columns{Vec3d{block.xx, block.xy, block.xz}, Vec3d{block.xy, block.yy, block.yz},
                                     Vec3d{block.xz, block.yz, block.zz}};
  for (std::size_t c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) values[place[c] + r] += columns[c][r];
}

void SparseFactor::add(std::uint32_t pair, Vec3d p, Vec3d q) {
  double* const values = implementation_->matrix.valuePtr();
  const Place& place = implementation_->pairs[pair];
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) values[place[static_cast<std::size_t>(c)] + r] += p[c] * q[r];
}

void SparseFactor::factorise() {
  Implementation& own = *implementation_;
  if (!own.is_analysed) own.cholesky.analyzePattern(own.matrix);
  own.is_analysed = true;
  own.cholesky.factorize(own.matrix);
}

void SparseFactor::solve(std::span<const Vec3d> b, std::span<Vec3d> x) {
  Implementation& own = *implementation_;
  own.right.resize(own.matrix.cols());
  Eigen::Index place = 0;
  for (const Vec3d& value : b)
    for (int axis = 0; axis < 3; ++axis) own.right[place++] = value[axis];
  own.solution = own.cholesky.solve(own.right);
  place = 0;
  for (Vec3d& value : x)
    for (int axis = 0; axis < 3; ++axis) value[axis] = own.solution[place++];
}

}  // namespace supple
