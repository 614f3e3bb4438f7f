#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "motion/symmetric_block.hpp"
#include "supple/types.hpp"

namespace supple {

/// Cholesky's factor L Lᵀ of a sparse symmetric matrix of 3 × 3 blocks whose pattern stays.
///
/// Columns that have the same rows below them form a panel, a dense matrix: almost all the work is products
/// of panels. A panel takes what panels before it give, in one order; panels of one level of the elimination
/// tree need nothing of each other and are factored side by side. So the bits are the same for any number of
/// threads.
class SparseFactor {
 public:
  /// Where a block lies, in the panels.
  struct Place {
    std::size_t first = 0;
    std::uint32_t pitch = 0;
    bool is_transposed = false;  ///< the row of the pair comes before its column in the elimination
  };

  /// `pairs` of different rows that have a block; each once. Places of them are in the same order. O(entries
  /// of the factor).
  SparseFactor(std::uint32_t row_count, std::span<const std::array<std::uint32_t, 2>> pairs);

  std::span<const Place> places() const { return places_; }
  /// Multiplications that a factorisation takes, and entries that a solution goes through twice, both of 3 ×
  /// 3 blocks.
  double products() const { return products_; }
  double entries() const { return entries_; }

  void set_zero(const Parallel& parallel);
  void add_diagonal(std::uint32_t row, const SymmetricBlock& block);
  void add(const Place& place, const SymmetricBlock& block);
  /// p qᵀ at the rows of p and the columns of q.
  void add(const Place& place, Vec3d p, Vec3d q);

  /// Pivots below `smallest`, which bounds the eigenvalues, are rounding and become that.
  void factorise(double smallest, const Parallel& parallel);
  /// L Lᵀ x = b; `x` may be `b`.
  void solve(std::span<const Vec3d> b, std::span<Vec3d> x);

 private:
  struct Panel {
    std::uint32_t first_column = 0, width = 0;
    std::uint32_t rows = 0;       // of the triangle on the diagonal and below
    std::size_t first_row = 0;    // in rows_
    std::size_t first_value = 0;  // in values_
    std::size_t pitch = 0;
    std::size_t first_update = 0, last_update = 0;
  };
  /// Rows [begin, end) of an earlier panel are columns of this.
  struct Update {
    std::uint32_t panel = 0, begin = 0, end = 0;
  };
  struct Scratch {
    std::vector<std::uint32_t> row_in_panel;
    std::vector<double> product;
  };

  void find_panels(std::uint32_t row_count, std::span<const std::array<std::uint32_t, 2>> pairs);
  void find_updates();
  void find_levels();
  Place place_of(std::uint32_t p, std::uint32_t q) const;
  void factorise_panel(const Panel& panel, double smallest, Scratch& scratch);
  void take_updates(const Panel& panel, Scratch& scratch);
  void factorise_dense(const Panel& panel, double smallest, Scratch& scratch);

  std::vector<std::uint32_t> position_;  // of each row, in the elimination
  std::vector<Panel> panels_;
  std::vector<std::uint32_t> panel_of_;  // each column
  std::vector<std::uint32_t> rows_;      // of panels, in increasing order
  std::vector<Update> updates_;
  std::vector<std::uint32_t> by_level_, first_of_level_;  // panels; one more at the end
  std::vector<Place> places_, diagonal_;
  std::vector<double> values_;
  std::vector<Scratch> scratch_;  // of each worker
  std::size_t largest_product_ = 0;
  std::vector<double> solution_, in_panel_;
  double products_ = 0, entries_ = 0;
};

}  // namespace supple
