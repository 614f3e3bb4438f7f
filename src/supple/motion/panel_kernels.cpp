#include "motion/panel_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "motion/panel_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Vectors of rows against three columns: sums that stay in registers.
template <int vectors, class D>
HWY_INLINE void multiply_rows(D d, const double* a, std::size_t pitch, std::size_t i, std::size_t j,
                              std::size_t depth, double* to, std::size_t pitch_u) {
  const std::size_t lanes = hn::Lanes(d);
  auto low0 = hn::Zero(d), low1 = low0, low2 = low0, high0 = low0, high1 = low0, high2 = low0;
  const double* column = a;
  for (std::size_t k = 0; k < depth; ++k, column += pitch) {
    const auto b0 = hn::Set(d, column[j]), b1 = hn::Set(d, column[j + 1]), b2 = hn::Set(d, column[j + 2]);
    // Not MulAdd: it rounds once where there is fma, and twice elsewhere.
    const auto low = hn::LoadU(d, column + i);
    low0 = hn::Add(low0, hn::Mul(low, b0));
    low1 = hn::Add(low1, hn::Mul(low, b1));
    low2 = hn::Add(low2, hn::Mul(low, b2));
    if constexpr (vectors == 2) {
      const auto high = hn::LoadU(d, column + i + lanes);
      high0 = hn::Add(high0, hn::Mul(high, b0));
      high1 = hn::Add(high1, hn::Mul(high, b1));
      high2 = hn::Add(high2, hn::Mul(high, b2));
    }
  }
  hn::StoreU(low0, d, to + i);
  hn::StoreU(low1, d, to + pitch_u + i);
  hn::StoreU(low2, d, to + 2 * pitch_u + i);
  if constexpr (vectors == 2) {
    hn::StoreU(high0, d, to + i + lanes);
    hn::StoreU(high1, d, to + pitch_u + i + lanes);
    hn::StoreU(high2, d, to + 2 * pitch_u + i + lanes);
  }
}

void MultiplyPanel(const double* a, std::size_t pitch, std::size_t rows, std::size_t columns,
                   std::size_t depth, double* u, std::size_t pitch_u) {
  const hn::CappedTag<double, 8> d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t j = 0; j < columns; j += 3) {
    // Rows above the diagonal are not asked for.
    std::size_t i = j;
    for (; i + lanes < rows; i += 2 * lanes)
      multiply_rows<2>(d, a, pitch, i, j, depth, u + j * pitch_u, pitch_u);
    if (i < rows) multiply_rows<1>(d, a, pitch, i, j, depth, u + j * pitch_u, pitch_u);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace supple
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace supple {

HWY_EXPORT(MultiplyPanel);

void multiply_panel(const double* a, std::size_t pitch, std::size_t rows, std::size_t columns,
                    std::size_t depth, double* u, std::size_t pitch_u) {
  HWY_DYNAMIC_DISPATCH(MultiplyPanel)(a, pitch, rows, columns, depth, u, pitch_u);
}

}  // namespace supple
#endif
