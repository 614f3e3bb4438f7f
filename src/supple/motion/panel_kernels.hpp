#pragma once

#include <cstddef>

namespace supple {

/// Numbers that `multiply_panel` may read and write beyond the last row, whatever the instruction set.
constexpr std::size_t panel_slack = 16;

/// u[i + j pitch_u] = Σ_k a[i + k pitch] a[j + k pitch] for rows i < `rows` and columns j < `columns`, a
/// multiple of 3, with k < `depth` in this order. Chooses the widest instruction set at run time; the sums
/// are equal on all. `pitch_u` is at least `rows` and a multiple of `panel_slack`; rows between the two
/// become anything.
void multiply_panel(const double* a, std::size_t pitch, std::size_t rows, std::size_t columns,
                    std::size_t depth, double* u, std::size_t pitch_u);

}  // namespace supple
