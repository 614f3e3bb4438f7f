#include "supple/trigonometry.hpp"

#include <cmath>

namespace supple {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Taylor series at 0, with an error below half an ulp for |x| <= pi/4.
double sin_series(double x) {
  const double x2 = x * x;
  double sum = -1.0 / 1307674368000.0;  // 15!
  sum = sum * x2 + 1.0 / 6227020800.0;
  sum = sum * x2 - 1.0 / 39916800.0;
  sum = sum * x2 + 1.0 / 362880.0;
  sum = sum * x2 - 1.0 / 5040.0;
  sum = sum * x2 + 1.0 / 120.0;
  sum = sum * x2 - 1.0 / 6.0;
  return x + x * x2 * sum;
}

double cos_series(double x) {
  const double x2 = x * x;
  double sum = 1.0 / 20922789888000.0;  // 16!
  sum = sum * x2 - 1.0 / 87178291200.0;
  sum = sum * x2 + 1.0 / 479001600.0;
  sum = sum * x2 - 1.0 / 3628800.0;
  sum = sum * x2 + 1.0 / 40320.0;
  sum = sum * x2 - 1.0 / 720.0;
  sum = sum * x2 + 1.0 / 24.0;
  sum = sum * x2 - 0.5;
  return 1.0 + x2 * sum;
}

}  // namespace

double sin_turns(double turns) {
  const double quarters = std::nearbyint(turns * 4);
  const double x = (turns * 4 - quarters) * (pi / 2);
  const double quadrant = quarters - 4 * std::floor(quarters / 4);
  if (quadrant == 0) return sin_series(x);
  if (quadrant == 1) return cos_series(x);
  if (quadrant == 2) return -sin_series(x);
  return -cos_series(x);
}

double cos_turns(double turns) {
  return sin_turns(turns + 0.25);
}

}  // namespace supple
