#pragma once

#include <cstddef>

namespace supple {

/// Numbers that `multiply_panel` may read and write beyond the last row, whatever the instruction set.
constexpr std::size_t panel_slack = 8;

/// u[i + j pitch_u] = Σ_k a[i + k pitch] a[j + k pitch] with k < `depth` in this order, for columns j <
/// `columns`, a multiple of 3, and rows i < `rows` from the multiple of 3 at or below j on. Other rows become
/// anything. `pitch_u` is at least `rows` + `panel_slack`. Chooses the widest instruction set at run time;
/// the sums are equal on all.
void multiply_panel(const double* a, std::size_t pitch, std::size_t rows, std::size_t columns,
                    std::size_t depth, double* u, std::size_t pitch_u);

}  // namespace supple
