#include "motion/sparse_factor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/elimination_order.hpp"
#include "motion/panel_kernels.hpp"

namespace supple {
namespace {

using Pair = std::array<std::uint32_t, 2>;
using Rows = std::vector<std::uint32_t>;

constexpr std::uint32_t none = ~std::uint32_t{0};

std::size_t padded(std::size_t count) {
  return count + panel_slack;
}

/// Rows below the diagonal of each column, for pairs in the order of elimination.
std::vector<Rows> lower_rows(std::uint32_t count, std::span<const Pair> pairs, const Rows& position) {
  std::vector<Rows> below(count);
  for (const auto& [p, q] : pairs) {
    below[std::min(position[p], position[q])].push_back(std::max(position[p], position[q]));
  }
  for (Rows& rows : below) std::sort(rows.begin(), rows.end());
  return below;
}

/// The first row below each column of the factor (Liu 1990), none for the last.
Rows elimination_tree(std::uint32_t count, std::span<const Pair> pairs, const Rows& position) {
  std::vector<Rows> before(count);
  for (const auto& [p, q] : pairs) {
    before[std::max(position[p], position[q])].push_back(std::min(position[p], position[q]));
  }
  Rows parent(count, none), ancestor(count, none);
  for (std::uint32_t row = 0; row < count; ++row) {
    for (std::uint32_t column : before[row]) {
      while (ancestor[column] != none && ancestor[column] != row) {
        column = std::exchange(ancestor[column], row);
      }
      if (ancestor[column] == none) ancestor[column] = parent[column] = row;
    }
  }
  return parent;
}

/// result[i] is the column that comes as the i-th when each comes right after all that are below it.
Rows postorder(const Rows& parent) {
  const auto count = static_cast<std::uint32_t>(parent.size());
  Rows first_child(count, none), next_sibling(count, none), order, path;
  Rows roots;
  for (std::uint32_t c = count; c-- > 0;) {
    if (parent[c] == none) {
      roots.push_back(c);
    } else {
      next_sibling[c] = std::exchange(first_child[parent[c]], c);
    }
  }
  order.reserve(count);
  while (!roots.empty()) {
    path.push_back(roots.back());
    roots.pop_back();
    while (!path.empty()) {
      const std::uint32_t c = path.back();
      if (first_child[c] != none) {
        path.push_back(std::exchange(first_child[c], next_sibling[first_child[c]]));
      } else {
        order.push_back(c);
        path.pop_back();
      }
    }
  }
  return order;
}

/// Columns next to each other that share their rows below.
struct Columns {
  std::uint32_t first = 0, width = 0;
  Rows below;
  double zeros = 0;  ///< blocks that are stored for nothing

  double blocks() const { return width * (0.5 * (width + 1) + static_cast<double>(below.size())); }
};

/// Wider panels are faster, at the price of some zeros.
bool may_merge(const Columns& child, const Columns& parent, double& zeros) {
  const double merged = (child.width + parent.width) *
                        (0.5 * (child.width + parent.width + 1) + static_cast<double>(parent.below.size()));
  zeros = merged - child.blocks() - parent.blocks() + child.zeros + parent.zeros;
  const std::uint32_t width = child.width + parent.width;
  const double share = width <= 4 ? 0.6 : width <= 16 ? 0.15 : 0.05;
  return zeros <= share * merged;
}

/// `below` is consumed: rows of columns of the matrix, which become those of the factor.
std::vector<Columns> panels_of(std::vector<Rows> below, const Rows& parent) {
  const auto count = static_cast<std::uint32_t>(parent.size());
  Rows merged;
  const auto add_rows = [&](std::uint32_t to, const Rows& rows) {
    merged.clear();
    std::set_union(below[to].begin(), below[to].end(), std::upper_bound(rows.begin(), rows.end(), to),
                   rows.end(), std::back_inserter(merged));
    below[to].swap(merged);
  };
  std::vector<Columns> panels;
  const auto close = [&](Columns panel) {
    double zeros = 0;
    while (!panels.empty()) {
      Columns& before = panels.back();
      const std::uint32_t up = parent[before.first + before.width - 1];
      if (up == none || up >= panel.first + panel.width || !may_merge(before, panel, zeros)) break;
      panel = {before.first, before.width + panel.width, std::move(panel.below), zeros};
      panels.pop_back();
    }
    panels.push_back(std::move(panel));
  };
  Columns open;
  for (std::uint32_t c = 0; c < count; ++c) {
    const bool same = c > 0 && parent[c - 1] == c && open.below.size() == below[c].size() + 1;
    if (same) {
      ++open.width;
      open.below = below[c];
    } else {
      if (c > 0) close(std::move(open));
      open = {c, 1, below[c], 0};
    }
    if (parent[c] != none) add_rows(parent[c], below[c]);
    Rows().swap(below[c]);
  }
  if (count > 0) close(std::move(open));
  return panels;
}

}  // namespace

SparseFactor::SparseFactor(std::uint32_t row_count, std::span<const Pair> pairs) {
  find_panels(row_count, pairs);
  find_updates();
  find_levels();
  places_.reserve(pairs.size());
  for (const auto& [p, q] : pairs) places_.push_back(place_of(p, q));
  diagonal_.reserve(row_count);
  for (std::uint32_t row = 0; row < row_count; ++row) diagonal_.push_back(place_of(row, row));
  solution_.resize(3 * std::size_t{row_count});
}

void SparseFactor::find_panels(std::uint32_t row_count, std::span<const Pair> pairs) {
  const Rows order = elimination_order(row_count, pairs);
  Rows position(row_count);
  for (std::uint32_t i = 0; i < row_count; ++i) position[order[i]] = i;
  // The same tree, its nodes numbered so that panels lie together.
  const Rows renumbered = postorder(elimination_tree(row_count, pairs, position));
  Rows place(row_count);
  for (std::uint32_t i = 0; i < row_count; ++i) place[renumbered[i]] = i;
  position_.resize(row_count);
  for (std::uint32_t row = 0; row < row_count; ++row) position_[row] = place[position[row]];

  panel_of_.resize(row_count);
  std::size_t largest_rows = 0;
  std::size_t values = 0;
  for (const Columns& columns :
       panels_of(lower_rows(row_count, pairs, position_), elimination_tree(row_count, pairs, position_))) {
    Panel panel;
    panel.first_column = columns.first;
    panel.width = columns.width;
    panel.rows = columns.width + static_cast<std::uint32_t>(columns.below.size());
    panel.first_row = rows_.size();
    panel.first_value = values;
    panel.pitch = 3 * std::size_t{panel.rows};
    for (std::uint32_t c = 0; c < columns.width; ++c) {
      panel_of_[columns.first + c] = static_cast<std::uint32_t>(panels_.size());
      rows_.push_back(columns.first + c);
    }
    rows_.insert(rows_.end(), columns.below.begin(), columns.below.end());
    values += panel.pitch * 3 * panel.width + panel_slack;
    entries_ += columns.blocks();
    for (std::uint32_t c = 0; c < columns.width; ++c) {
      const double left = panel.rows - c;
      products_ += 0.5 * left * left;
    }
    largest_rows = std::max(largest_rows, panel.pitch);
    panels_.push_back(panel);
  }
  values_.resize(values);
  in_panel_.resize(largest_rows);
  largest_product_ = 3 * padded(largest_rows);
}

void SparseFactor::find_updates() {
  std::vector<std::vector<Update>> of_panel(panels_.size());
  for (std::uint32_t p = 0; p < panels_.size(); ++p) {
    const Panel& panel = panels_[p];
    const std::uint32_t* const rows = rows_.data() + panel.first_row;
    for (std::uint32_t begin = panel.width; begin < panel.rows;) {
      const std::uint32_t to = panel_of_[rows[begin]];
      std::uint32_t end = begin + 1;
      while (end < panel.rows && panel_of_[rows[end]] == to) ++end;
      of_panel[to].push_back({p, begin, end});
      const std::size_t pitch = padded(3 * std::size_t{panel.rows - begin});
      largest_product_ = std::max(largest_product_, pitch * 3 * (end - begin));
      begin = end;
    }
  }
  for (std::uint32_t p = 0; p < panels_.size(); ++p) {
    panels_[p].first_update = updates_.size();
    updates_.insert(updates_.end(), of_panel[p].begin(), of_panel[p].end());
    panels_[p].last_update = updates_.size();
  }
}

void SparseFactor::find_levels() {
  Rows level(panels_.size(), 0);
  std::uint32_t levels = 0;
  for (std::uint32_t p = 0; p < panels_.size(); ++p) {
    const Panel& panel = panels_[p];
    levels = std::max(levels, level[p] + 1);
    for (std::uint32_t r = panel.width; r < panel.rows; ++r) {
      std::uint32_t& above = level[panel_of_[rows_[panel.first_row + r]]];
      above = std::max(above, level[p] + 1);
    }
  }
  first_of_level_.assign(std::size_t{levels} + 1, 0);
  for (const std::uint32_t l : level) ++first_of_level_[l + 1];
  for (std::uint32_t l = 0; l < levels; ++l) first_of_level_[l + 1] += first_of_level_[l];
  by_level_.resize(panels_.size());
  Rows next(first_of_level_.begin(), first_of_level_.end() - 1);
  for (std::uint32_t p = 0; p < panels_.size(); ++p) by_level_[next[level[p]]++] = p;
}

SparseFactor::Place SparseFactor::place_of(std::uint32_t p, std::uint32_t q) const {
  const std::uint32_t row = std::max(position_[p], position_[q]),
                      column = std::min(position_[p], position_[q]);
  const Panel& panel = panels_[panel_of_[column]];
  const auto first = rows_.begin() + static_cast<std::ptrdiff_t>(panel.first_row);
  const auto at = static_cast<std::size_t>(std::lower_bound(first, first + panel.rows, row) - first);
  return {panel.first_value + 3 * std::size_t{column - panel.first_column} * panel.pitch + 3 * at,
          static_cast<std::uint32_t>(panel.pitch), position_[p] < position_[q]};
}

void SparseFactor::set_zero(const Parallel& parallel) {
  parallel.for_ranges(values_.size(), 65536, [&](std::size_t begin, std::size_t end, std::uint32_t) {
    std::fill(values_.data() + begin, values_.data() + end, 0.0);
  });
}

void SparseFactor::add_diagonal(std::uint32_t row, const SymmetricBlock& block) {
  add(diagonal_[row], block);
}

void SparseFactor::add(const Place& place, const SymmetricBlock& block) {
  double* const c0 = values_.data() + place.first;
  double* const c1 = c0 + place.pitch;
  double* const c2 = c1 + place.pitch;
  c0[0] += block.xx;
  c0[1] += block.xy;
  c0[2] += block.xz;
  c1[0] += block.xy;
  c1[1] += block.yy;
  c1[2] += block.yz;
  c2[0] += block.xz;
  c2[1] += block.yz;
  c2[2] += block.zz;
}

void SparseFactor::add(const Place& place, Vec3d p, Vec3d q) {
  if (place.is_transposed) std::swap(p, q);
  for (int c = 0; c < 3; ++c) {
    double* const column = values_.data() + place.first + static_cast<std::size_t>(c) * place.pitch;
    for (int r = 0; r < 3; ++r) column[r] += p[r] * q[c];
  }
}

void SparseFactor::factorise(double smallest, const Parallel& parallel) {
  while (scratch_.size() < parallel.worker_count()) {
    scratch_.push_back({Rows(position_.size()), std::vector<double>(largest_product_)});
  }
  for (std::size_t level = 0; level + 1 < first_of_level_.size(); ++level) {
    const std::uint32_t first = first_of_level_[level];
    parallel.for_ranges(first_of_level_[level + 1] - first, 1,
                        [&](std::size_t begin, std::size_t end, std::uint32_t worker) {
                          for (std::size_t i = first + begin; i < first + end; ++i) {
                            factorise_panel(panels_[by_level_[i]], smallest, scratch_[worker]);
                          }
                        });
  }
}

void SparseFactor::factorise_panel(const Panel& panel, double smallest, Scratch& scratch) {
  take_updates(panel, scratch);
  factorise_dense(panel, smallest, scratch);
}

void SparseFactor::take_updates(const Panel& panel, Scratch& scratch) {
  const std::uint32_t* const rows = rows_.data() + panel.first_row;
  for (std::uint32_t r = 0; r < panel.rows; ++r) scratch.row_in_panel[rows[r]] = r;
  double* const values = values_.data() + panel.first_value;
  double* const product = scratch.product.data();
  for (std::size_t i = panel.first_update; i < panel.last_update; ++i) {
    const Update& update = updates_[i];
    const Panel& from = panels_[update.panel];
    const std::uint32_t* const from_rows = rows_.data() + from.first_row + update.begin;
    const std::uint32_t row_count = from.rows - update.begin, column_count = update.end - update.begin;
    const std::size_t pitch = padded(3 * std::size_t{row_count});
    multiply_panel(values_.data() + from.first_value + 3 * std::size_t{update.begin}, from.pitch,
                   3 * std::size_t{row_count}, 3 * std::size_t{column_count}, 3 * std::size_t{from.width},
                   product, pitch);
    for (std::uint32_t c = 0; c < column_count; ++c) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        double* const column =
            values + (3 * std::size_t{from_rows[c] - panel.first_column} + axis) * panel.pitch;
        const double* const change = product + (3 * std::size_t{c} + axis) * pitch;
        for (std::uint32_t r = c; r < row_count; ++r) {
          double* const to = column + 3 * std::size_t{scratch.row_in_panel[from_rows[r]]};
          const double* const by = change + 3 * std::size_t{r};
          to[0] -= by[0];
          to[1] -= by[1];
          to[2] -= by[2];
        }
      }
    }
  }
}

void SparseFactor::factorise_dense(const Panel& panel, double smallest, Scratch& scratch) {
  const std::size_t rows = 3 * std::size_t{panel.rows}, pitch = panel.pitch;
  for (std::size_t g = 0; g < 3 * std::size_t{panel.width}; g += 3) {
    double* const c0 = values_.data() + panel.first_value + g * pitch;
    double* const c1 = c0 + pitch;
    double* const c2 = c1 + pitch;
    if (g > 0) {
      const std::size_t left = padded(rows - g);
      double* const product = scratch.product.data();
      multiply_panel(values_.data() + panel.first_value + g, pitch, rows - g, 3, g, product, left);
      for (std::size_t r = g; r < rows; ++r) c0[r] -= product[r - g];
      for (std::size_t r = g; r < rows; ++r) c1[r] -= product[left + r - g];
      for (std::size_t r = g; r < rows; ++r) c2[r] -= product[2 * left + r - g];
    }
    const double pivot0 = std::sqrt(std::fmax(c0[g], smallest)), inverse0 = 1 / pivot0;
    for (std::size_t r = g + 1; r < rows; ++r) c0[r] *= inverse0;
    const double l10 = c0[g + 1], l20 = c0[g + 2];
    for (std::size_t r = g + 1; r < rows; ++r) c1[r] -= c0[r] * l10;
    const double pivot1 = std::sqrt(std::fmax(c1[g + 1], smallest)), inverse1 = 1 / pivot1;
    for (std::size_t r = g + 2; r < rows; ++r) c1[r] *= inverse1;
    const double l21 = c1[g + 2];
    for (std::size_t r = g + 2; r < rows; ++r) c2[r] -= c0[r] * l20 + c1[r] * l21;
    const double pivot2 = std::sqrt(std::fmax(c2[g + 2], smallest)), inverse2 = 1 / pivot2;
    for (std::size_t r = g + 3; r < rows; ++r) c2[r] *= inverse2;
    c0[g] = pivot0;
    c1[g + 1] = pivot1;
    c2[g + 2] = pivot2;
  }
}

void SparseFactor::solve(std::span<const Vec3d> b, std::span<Vec3d> x) {
  for (std::size_t row = 0; row < position_.size(); ++row) {
    for (int axis = 0; axis < 3; ++axis) solution_[3 * std::size_t{position_[row]} + axis] = b[row][axis];
  }
  double* const t = in_panel_.data();
  for (const Panel& panel : panels_) {
    const std::uint32_t* const panel_rows = rows_.data() + panel.first_row;
    const std::size_t rows = 3 * std::size_t{panel.rows}, columns = 3 * std::size_t{panel.width};
    double* const own = solution_.data() + 3 * std::size_t{panel.first_column};
    std::copy(own, own + columns, t);
    std::fill(t + columns, t + rows, 0.0);
    const double* c0 = values_.data() + panel.first_value;
    for (std::size_t g = 0; g < columns; g += 3, c0 += 3 * panel.pitch) {
      const double* const c1 = c0 + panel.pitch;
      const double* const c2 = c1 + panel.pitch;
      const double x0 = t[g] / c0[g];
      const double x1 = (t[g + 1] - c0[g + 1] * x0) / c1[g + 1];
      const double x2 = (t[g + 2] - (c0[g + 2] * x0 + c1[g + 2] * x1)) / c2[g + 2];
      t[g] = x0;
      t[g + 1] = x1;
      t[g + 2] = x2;
      for (std::size_t r = g + 3; r < rows; ++r) t[r] -= (c0[r] * x0 + c1[r] * x1) + c2[r] * x2;
    }
    std::copy(t, t + columns, own);
    for (std::uint32_t r = panel.width; r < panel.rows; ++r) {
      double* const to = solution_.data() + 3 * std::size_t{panel_rows[r]};
      for (std::size_t axis = 0; axis < 3; ++axis) to[axis] += t[3 * std::size_t{r} + axis];
    }
  }
  for (std::size_t p = panels_.size(); p-- > 0;) {
    const Panel& panel = panels_[p];
    const std::uint32_t* const panel_rows = rows_.data() + panel.first_row;
    const std::size_t rows = 3 * std::size_t{panel.rows}, columns = 3 * std::size_t{panel.width};
    double* const own = solution_.data() + 3 * std::size_t{panel.first_column};
    std::copy(own, own + columns, t);
    for (std::uint32_t r = panel.width; r < panel.rows; ++r) {
      const double* const from = solution_.data() + 3 * std::size_t{panel_rows[r]};
      for (std::size_t axis = 0; axis < 3; ++axis) t[3 * std::size_t{r} + axis] = from[axis];
    }
    for (std::size_t g = columns; g > 0;) {
      g -= 3;
      const double* const c0 = values_.data() + panel.first_value + g * panel.pitch;
      const double* const c1 = c0 + panel.pitch;
      const double* const c2 = c1 + panel.pitch;
      // Three sums a column, one for each axis, so that additions need not wait for each other.
      std::array<double, 3> s0{}, s1{}, s2{};
      for (std::size_t r = g + 3; r < rows; r += 3) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          s0[axis] += c0[r + axis] * t[r + axis];
          s1[axis] += c1[r + axis] * t[r + axis];
          s2[axis] += c2[r + axis] * t[r + axis];
        }
      }
      t[g + 2] = (t[g + 2] - (s2[0] + s2[1] + s2[2])) / c2[g + 2];
      t[g + 1] = (t[g + 1] - (s1[0] + s1[1] + s1[2]) - c1[g + 2] * t[g + 2]) / c1[g + 1];
      t[g] = (t[g] - (s0[0] + s0[1] + s0[2]) - c0[g + 1] * t[g + 1] - c0[g + 2] * t[g + 2]) / c0[g];
    }
    std::copy(t, t + columns, own);
  }
  for (std::size_t row = 0; row < position_.size(); ++row) {
    for (int axis = 0; axis < 3; ++axis) x[row][axis] = solution_[3 * std::size_t{position_[row]} + axis];
  }
}

}  // namespace supple
