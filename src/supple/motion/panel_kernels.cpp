#include "motion/panel_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "motion/panel_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace supple {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Two vectors of rows against three columns: six sums that stay in registers.
void MultiplyPanel(const double* a, std::size_t pitch, std::size_t rows, std::size_t columns,
                   std::size_t depth, double* u, std::size_t pitch_u) {
  const hn::CappedTag<double, 8> d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t j = 0; j < columns; j += 3) {
    double* const to0 = u + j * pitch_u;
    double* const to1 = to0 + pitch_u;
    double* const to2 = to1 + pitch_u;
    for (std::size_t i = 0; i < rows; i += 2 * lanes) {
      auto low0 = hn::Zero(d), low1 = low0, low2 = low0, high0 = low0, high1 = low0, high2 = low0;
      const double* column = a;
      for (std::size_t k = 0; k < depth; ++k, column += pitch) {
        const auto low = hn::LoadU(d, column + i), high = hn::LoadU(d, column + i + lanes);
        const auto b0 = hn::Set(d, column[j]), b1 = hn::Set(d, column[j + 1]), b2 = hn::Set(d, column[j + 2]);
        // Not MulAdd: it rounds once where there is fma, and twice elsewhere.
        low0 = hn::Add(low0, hn::Mul(low, b0));
        low1 = hn::Add(low1, hn::Mul(low, b1));
        low2 = hn::Add(low2, hn::Mul(low, b2));
        high0 = hn::Add(high0, hn::Mul(high, b0));
        high1 = hn::Add(high1, hn::Mul(high, b1));
        high2 = hn::Add(high2, hn::Mul(high, b2));
      }
      hn::StoreU(low0, d, to0 + i);
      hn::StoreU(low1, d, to1 + i);
      hn::StoreU(low2, d, to2 + i);
      hn::StoreU(high0, d, to0 + i + lanes);
      hn::StoreU(high1, d, to1 + i + lanes);
      hn::StoreU(high2, d, to2 + i + lanes);
    }
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
