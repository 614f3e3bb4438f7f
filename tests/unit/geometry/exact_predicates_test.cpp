#include "geometry/exact_predicates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/numbers/integer_points.hpp"
#include "geometry/plane_filter.hpp"
#include "support/random.hpp"

namespace supple::exact_predicates_test {

namespace mp = boost::multiprecision;
constexpr double smallest = std::numeric_limits<double>::denorm_min();
constexpr double largest = std::numeric_limits<double>::max();

/// value · 2^1074
mp::cpp_int exact(double value) {
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
  const int shift = exponent - 53 + 1074;
  return shift < 0 ? mp::cpp_int(mantissa >> -shift) : mp::cpp_int(mp::cpp_int(mantissa) << shift);
}

int unbounded_orient3d(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  mp::cpp_int rows[3][3];
  for (int axis = 0; axis < 3; ++axis) {
    rows[0][axis] = exact(b[axis]) - exact(a[axis]);
    rows[1][axis] = exact(c[axis]) - exact(a[axis]);
    rows[2][axis] = exact(d[axis]) - exact(a[axis]);
  }
  const mp::cpp_int volume = rows[0][0] * (rows[1][1] * rows[2][2] - rows[1][2] * rows[2][1]) -
                             rows[0][1] * (rows[1][0] * rows[2][2] - rows[1][2] * rows[2][0]) +
                             rows[0][2] * (rows[1][0] * rows[2][1] - rows[1][1] * rows[2][0]);
  return volume.sign();
}

int orient3d(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  bool used_exact = false;
  return supple::orient3d(a, b, c, d, used_exact);
}
int orient2d(const Vec3d& a, const Vec3d& b, const Vec3d& c, int axis) {
  bool used_exact = false;
  return supple::orient2d(a, b, c, axis, used_exact);
}

/// Coordinates that are difficult for filters: few bits, many bits, nearly equal, huge, tiny.
class Coordinates {
 public:
  double draw() {
    const double base = random_.between(-4, 4);
    switch (random_.below(8)) {
      case 0:
        return base * 0.1;
      case 1:
        return std::nextafter(base * 0.1, random_.below(2) ? 1e308 : -1e308);
      case 2:
        return base + std::ldexp(1, -random_.between(0, 59));
      case 3:
        return std::ldexp(base, random_.between(-1000, 999));
      case 4:
        return base * smallest;
      case 5:
        return base / 4 * largest;
      default:
        return base;
    }
  }
  Vec3d point() {
    if (random_.below(2)) return {draw(), draw(), draw()};
    return {double(random_.below(4)), double(random_.below(4)), double(random_.below(4))};
  }
  std::uint64_t bits() { return random_.bits(); }

 private:
  RandomNumbers random_{5};
};

TEST(Orient3d, SignConvention) {
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}), -1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 7, 0}), 0);
}

TEST(Orient3d, EqualsUnboundedArithmetic) {
  Coordinates coordinates;
  int zeros = 0, exact_ones = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3d a = coordinates.point(), b = coordinates.point(), c = coordinates.point();
    Vec3d d = coordinates.point();
    if (i % 3 == 0) d = a + (b - c) * 0.5;
    if (!std::isfinite(d.x) || !std::isfinite(d.y) || !std::isfinite(d.z)) continue;
    bool used_exact = false;
    const int sign = supple::orient3d(a, b, c, d, used_exact);
    ASSERT_EQ(sign, unbounded_orient3d(a, b, c, d));
    zeros += sign == 0;
    exact_ones += used_exact;
  }
  EXPECT_GT(zeros, 100);
  EXPECT_GT(exact_ones, 500);
}

TEST(Orient3d, IsAntisymmetric) {
  Coordinates coordinates;
  for (int i = 0; i < 5000; ++i) {
    const Vec3d a = coordinates.point(), b = coordinates.point(), c = coordinates.point(),
                d = coordinates.point();
    const int sign = orient3d(a, b, c, d);
    ASSERT_EQ(orient3d(b, a, c, d), -sign);
    ASSERT_EQ(orient3d(c, d, a, b), sign);
    ASSERT_EQ(orient3d(d, b, c, a), -sign);
  }
}

TEST(Orient3d, OneStepOffThePlane) {
  // The volume is 3 · 2^-54, far below the rounding error of its products.
  const Vec3d a{0.5, 0.5, 0.5}, b{12, 12, 12}, c{24, 24, 30}, d{0.5 + 0x1p-53, 0.5, 0.5};
  EXPECT_EQ(orient3d(a, b, c, d), unbounded_orient3d(a, b, c, d));
  EXPECT_NE(orient3d(a, b, c, d), 0);
}

TEST(Orient3d, ProductsThatUnderflowOrOverflow) {
  EXPECT_EQ(orient3d({0, 0, 0}, {smallest, 0, 0}, {0, smallest, 0}, {0, 0, smallest}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {smallest, 0, 0}, {0, smallest, 0}, {0, 0, 0}), 0);
  EXPECT_EQ(orient3d({-largest, 0, 0}, {largest, 0, 0}, {0, largest, 0}, {0, 0, largest}), 1);
  EXPECT_EQ(orient3d({-largest, 0, 0}, {largest, 0, 0}, {0, largest, 0}, {0, -largest, -smallest}), -1);
  // n_y underflows to zero and w_y is huge: the sign is that of a product that underflows in the filter.
  EXPECT_EQ(orient3d({0, 0, 0}, {0, 0, 1e-170}, {1e-170, 0, 0}, {0, 1e300, 0}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {0, 1e-170, 1e-170}, {1e-170, 0, 0}, {0, 1e300, 1.5e300}), -1);
}

TEST(Orient3d, FallsBackOnlyWhereItMust) {
  bool used_exact = false;
  supple::orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.4, 1e-9}, used_exact);
  EXPECT_FALSE(used_exact);
  EXPECT_EQ(supple::orient3d({0.1, 0.2, 5}, {1, 0.7, 5}, {0.3, 1, 5}, {0.3, 0.4, 5}, used_exact), 0);
  EXPECT_FALSE(used_exact) << "equal z coordinates";
  supple::orient3d({0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 2}, used_exact);
  EXPECT_TRUE(used_exact);
}

TEST(Orient2d, SignConvention) {
  // The view along z has the axes x and y; the view along x has y and z; the view along y has z and x.
  EXPECT_EQ(orient2d({0, 0, 9}, {1, 0, 4}, {0, 1, -3}, 2), 1);
  EXPECT_EQ(orient2d({9, 0, 0}, {4, 1, 0}, {-3, 0, 1}, 0), 1);
  EXPECT_EQ(orient2d({0, 9, 0}, {0, 4, 1}, {1, -3, 0}, 1), 1);
  EXPECT_EQ(orient2d({0, 0, 9}, {0, 1, 4}, {1, 0, -3}, 2), -1);
}

TEST(Orient2d, EqualsUnboundedArithmetic) {
  Coordinates coordinates;
  int zeros = 0;
  for (int i = 0; i < 6000; ++i) {
    const Vec3d a = coordinates.point(), b = coordinates.point();
    const Vec3d c = i % 3 == 0 ? a * 0.5 + b * 0.5 : coordinates.point();
    const int axis = i % 3, x = (axis + 1) % 3, y = (axis + 2) % 3;
    const mp::cpp_int turn = (exact(b[x]) - exact(a[x])) * (exact(c[y]) - exact(a[y])) -
                             (exact(b[y]) - exact(a[y])) * (exact(c[x]) - exact(a[x]));
    ASSERT_EQ(orient2d(a, b, c, axis), turn.sign());
    zeros += turn == 0;
  }
  EXPECT_GT(zeros, 100);
}

TEST(FindProjection, KeepsTheAreaAndSaysTheTurn) {
  bool used_exact = false;
  const auto expect = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c, int axis, int turn) {
    EXPECT_EQ(find_projection(a, b, c, used_exact).axis, axis);
    EXPECT_EQ(find_projection(a, b, c, used_exact).turn, turn);
  };
  expect({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 1);
  expect({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, 2, -1);
  expect({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0, 1);
  expect({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 1, 1);
  expect({0, 0, 0}, {1, 1, 1}, {3, 3, 3}, -1, 0);
  expect({1, 2, 3}, {1, 2, 3}, {1, 2, 3}, -1, 0);
  // Three points that are collinear except for one rounding step in one projection.
  expect({0, 0, 0}, {smallest, smallest, 0}, {2 * smallest, smallest, 0}, 2, -1);
  expect({0, 0, 0}, {0, 1, 0}, {0, 1, smallest}, 0, 1);
}

TEST(FilteredPlane, NeverClaimsAWrongSign) {
  Coordinates coordinates;
  int certain = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3d a = coordinates.point(), b = coordinates.point(), c = coordinates.point();
    const TrianglePoints triangle{coordinates.point(), coordinates.point(), coordinates.point()};
    const FilteredSides sides(FilteredPlane(a, b, c), triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      const Filtered side{sides.value[k], sides.bound};
      if (!side.certain()) continue;
      ++certain;
      ASSERT_EQ(side.sign(), orient3d(a, b, c, triangle[k]));
      ASSERT_EQ(side.sign(), unbounded_orient3d(a, b, c, triangle[k]));
    }
  }
  EXPECT_GT(certain, 1000);
}

TEST(IntegerPoints, SmallDeterminantEqualsTheUnbounded) {
  Coordinates coordinates;
  for (int i = 0; i < 20000; ++i) {
    Vector3<std::int64_t> small[3];
    Vector3<UnboundedInteger> large[3];
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int shift = 3 + static_cast<int>(coordinates.bits() % 61);
        std::int64_t value = static_cast<std::int64_t>(coordinates.bits()) >> shift;
        if (i % 4 == 0) value = (std::int64_t{1} << 61) - 1 - value % 3;
        if (i % 8 == 0 && (row + axis) % 2) value = -value;
        small[row][axis] = value;
        large[row][axis] = value;
      }
    }
    const Int192 found = determinant(small[0], small[1], small[2]);
    const UnboundedInteger expected = determinant(large[0], large[1], large[2]);
    ASSERT_EQ(sign(found), expected.sign());
    const UnboundedInteger distance = abs(expected);
    if (distance == 0) {
      ASSERT_EQ(magnitude(found), 0);
    } else {
      ASSERT_NEAR(magnitude(found) / distance.convert_to<double>(), 1, 0x1p-50);
    }
  }
}

TEST(IntegerPoints, MagnitudesOfVeryLongIntegersKeepTheirRatio) {
  const UnboundedInteger one = UnboundedInteger(1) << 6000;
  const auto [p, q] = relative_magnitudes(UnboundedInteger(-one * 3), UnboundedInteger(one * 4));
  EXPECT_EQ(p / q, 0.75);
  const auto [zero, large] = relative_magnitudes(UnboundedInteger(1), one);
  EXPECT_EQ(zero / large, 0);
}

TEST(Dyadic, RoundTrips) {
  for (const double value : {1.0, -0.1, smallest, -7 * smallest, largest, 0x1p-1022, 0.0}) {
    const Dyadic dyadic(value);
    const double magnitude = std::ldexp(static_cast<double>(dyadic.mantissa), dyadic.exponent);
    EXPECT_EQ(dyadic.negative ? -magnitude : magnitude, value);
  }
}

TEST(LexicographicallyLess, ComparesXThenYThenZ) {
  EXPECT_TRUE(lexicographically_less({1, 9, 9}, {2, 0, 0}));
  EXPECT_TRUE(lexicographically_less({1, 1, 9}, {1, 2, 0}));
  EXPECT_TRUE(lexicographically_less({1, 1, 1}, {1, 1, 2}));
  EXPECT_FALSE(lexicographically_less({1, 1, 1}, {1, 1, 1}));
  EXPECT_FALSE(lexicographically_less({2, 0, 0}, {1, 9, 9}));
}

}  // namespace supple::exact_predicates_test
