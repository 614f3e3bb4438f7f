#include "contact/intersection/pair_filter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <span>

#include "geometry/vector.hpp"
#include "support/instruction_sets.hpp"
#include "unit/contact/triangle_lists.hpp"
#include "unit/contact/triangle_pairs.hpp"

namespace supple::pair_filter_test {

using truth::converted;
using truth::pair_families;
using truth::PairFamily;
using truth::PairList;
using truth::TrianglePair3d;
using truth::widened;

/// The reference for the filter: one pair in scalar arithmetic, with the same order of operations.
template <class Scalar>
class ScalarTwin {
 public:
  using Point = Vec3<Scalar>;
  using Corners = std::array<Point, 3>;

  ScalarTwin(const Corners& a, const Corners& b) {
    std::array<bool, 3> above_a{}, above_b{};
    bool separated_a = false, separated_b = false;
    const bool certain_a = sides(b, a, above_a, separated_a), certain_b = sides(a, b, above_b, separated_b);
    apart = separated_a || separated_b;
    if (apart || !certain_a || !certain_b) return;
    const Chord chord_a = chord(a, above_a, false), chord_b = chord(b, above_b, true);
    const int first = order(chord_a, chord_a.end, chord_b, chord_b.start);
    const int second = order(chord_a, chord_a.start, chord_b, chord_b.end);
    apart = first > 0 || second < 0;
    crossing = first < 0 && second > 0;
  }

  bool apart = false, crossing = false;

 private:
  static constexpr bool is_single = sizeof(Scalar) == sizeof(float);
  static constexpr Scalar error = is_single ? 10 * Scalar{0x1p-24} : 10 * Scalar{0x1p-53};
  static constexpr Scalar underflow = static_cast<Scalar>(is_single ? 0x1p-110 : 0x1p-1000);

  struct Volume {
    Point normal, magnitude;
    Volume(const Point& u, const Point& v) {
      const Point left{u.y * v.z, u.z * v.x, u.x * v.y}, right{u.z * v.y, u.x * v.z, u.y * v.x};
      normal = left - right;
      magnitude = {std::abs(left.x) + std::abs(right.x), std::abs(left.y) + std::abs(right.y),
                   std::abs(left.z) + std::abs(right.z)};
    }
    Scalar with(const Point& w) const { return normal.x * w.x + normal.y * w.y + normal.z * w.z; }
    Scalar bound(const Point& r) const {
      return error * (magnitude.x * r.x + magnitude.y * r.y + magnitude.z * r.z) +
             underflow * (r.x + r.y + r.z) + underflow;
    }
  };
  struct Chord {
    Point apex, start, end;
    bool above;
  };

  static bool sides(const Corners& plane, const Corners& corners, std::array<bool, 3>& above,
                    bool& separated) {
    const Volume volume(plane[1] - plane[0], plane[2] - plane[0]);
    Point reach{};
    std::array<Scalar, 3> side{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Point w = corners[i] - plane[0];
      for (int axis = 0; axis < 3; ++axis) {
        // The kernels compute the maximum in the same way: it keeps NaN.
        if (!(std::abs(w[axis]) <= reach[axis])) reach[axis] = std::abs(w[axis]);
      }
      side[i] = volume.with(w);
      above[i] = side[i] > 0;
    }
    const Scalar bound = volume.bound(reach);
    separated = (side[0] > bound && side[1] > bound && side[2] > bound) ||
                (-side[0] > bound && -side[1] > bound && -side[2] > bound);
    return std::abs(side[0]) > bound && std::abs(side[1]) > bound && std::abs(side[2]) > bound;
  }
  static Chord chord(const Corners& corners, const std::array<bool, 3>& above, bool is_b) {
    const std::size_t apex = above[1] == above[2] ? 0 : above[0] == above[2] ? 1 : 2;
    const Point &next = corners[(apex + 1) % 3], &last = corners[(apex + 2) % 3];
    return above[apex] == is_b ? Chord{corners[apex], next, last, above[apex]}
                               : Chord{corners[apex], last, next, above[apex]};
  }
  static int order(const Chord& a, const Point& corner_a, const Chord& b, const Point& corner_b) {
    const Volume volume(corner_a - a.apex, b.apex - a.apex);
    const Point w = corner_b - a.apex;
    const Scalar value = a.above != b.above ? -volume.with(w) : volume.with(w);
    const Scalar bound = volume.bound({std::abs(w.x), std::abs(w.y), std::abs(w.z)});
    return value > bound ? 1 : -value > bound ? -1 : 0;
  }
};

template <class Pairs>
PairVerdicts verdicts_on(const Pairs& list, std::size_t count, const Vec3d& of_a = {},
                         const Vec3d& of_b = {}) {
  return filter_pairs(list.a.placed(of_a), list.b.placed(of_b), std::span(list.pairs).first(count));
}

class PairFilterTest : public ::testing::TestWithParam<PairFamily> {};
INSTANTIATE_TEST_SUITE_P(All, PairFilterTest, ::testing::ValuesIn(pair_families()),
                         [](const auto& family) { return family.param.name; });

template <class Scalar>
void expect_true_verdicts(const PairFamily& family) {
  RandomNumbers random(31);
  for (int round = 0; round < 20; ++round) {
    PairList<Scalar> block(pair_filter_capacity);
    PairVerdicts expected;
    std::uint64_t hits = 0, segments = 0, finite = 0;
    for (std::size_t i = 0; i < pair_filter_capacity; ++i) {
      TrianglePair3d pair = family.draw(random);
      const auto a = converted<Scalar>(pair.a), b = converted<Scalar>(pair.b);
      pair = {widened(a), widened(b)};
      block.set(i, a, b);
      const TriangleIntersection shared = intersect_triangles(pair.a, pair.b);
      hits |= std::uint64_t{shared.intersects} << i;
      segments |= std::uint64_t{shared.intersects && shared.kind == IntersectionKind::segment} << i;
      const ScalarTwin<Scalar> twin(a, b);
      bool all_finite = true;
      for (std::size_t k = 0; k < 3; ++k)
        all_finite = all_finite && is_finite(pair.a[k]) && is_finite(pair.b[k]);
      finite |= std::uint64_t{all_finite} << i;
      expected.apart |= std::uint64_t{twin.apart} << i;
      expected.crossing |= std::uint64_t{twin.crossing} << i;
    }
    ASSERT_EQ(expected.apart & hits, 0u);
    ASSERT_EQ(expected.crossing & ~segments, 0u);
    for_each_target([&](const char* target) {
      const PairVerdicts all = verdicts_on(block, pair_filter_capacity);
      EXPECT_EQ(all.apart & finite, expected.apart & finite) << target;
      EXPECT_EQ(all.crossing, expected.crossing) << target;
      for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{13}, std::size_t{63}}) {
        const std::uint64_t asked = (std::uint64_t{1} << count) - 1;
        EXPECT_EQ(verdicts_on(block, count), (PairVerdicts{all.apart & asked, all.crossing & asked}))
            << target;
      }
    });
  }
}

TEST_P(PairFilterTest, EqualsTheScalarTwinAndIsNeverWrong) {
  expect_true_verdicts<double>(GetParam());
}

TEST_P(PairFilterTest, NeverWrongInSinglePrecision) {
  expect_true_verdicts<float>(GetParam());
}

/// Objects with different precisions and translations: the filter translates them in double precision.
template <class ScalarA, class ScalarB>
void expect_verdicts_where_they_are() {
  RandomNumbers random(34);
  for (const PairFamily& family : pair_families()) {
    const Vec3d shift_a{0.375, -1e-3, 7}, shift_b{0.1, 0.2, 7.25};
    PairList<ScalarA, ScalarB> block(pair_filter_capacity);
    PairVerdicts expected;
    std::uint64_t finite = 0;
    for (std::size_t i = 0; i < pair_filter_capacity; ++i) {
      const TrianglePair3d pair = family.draw(random);
      const auto a = converted<ScalarA>(pair.a);
      const auto b = converted<ScalarB>(pair.b);
      block.set(i, a, b);
      TrianglePoints placed_a = widened(a), placed_b = widened(b);
      bool all_finite = true;
      for (std::size_t k = 0; k < 3; ++k) {
        placed_a[k] = placed_a[k] + shift_a;
        placed_b[k] = placed_b[k] + shift_b;
        all_finite = all_finite && is_finite(placed_a[k]) && is_finite(placed_b[k]);
      }
      const ScalarTwin<double> twin(placed_a, placed_b);
      finite |= std::uint64_t{all_finite} << i;
      expected.apart |= std::uint64_t{twin.apart} << i;
      expected.crossing |= std::uint64_t{twin.crossing} << i;
    }
    for_each_target([&](const char* target) {
      const PairVerdicts all = verdicts_on(block, pair_filter_capacity, shift_a, shift_b);
      EXPECT_EQ(all.apart & finite, expected.apart & finite) << target << ' ' << family.name;
      EXPECT_EQ(all.crossing, expected.crossing) << target << ' ' << family.name;
    });
  }
}

TEST(PairFilterPlaces, TranslatedObjectsOfEitherPrecision) {
  expect_verdicts_where_they_are<float, float>();
  expect_verdicts_where_they_are<float, double>();
  expect_verdicts_where_they_are<double, float>();
  expect_verdicts_where_they_are<double, double>();
}

TEST(PairFilterRate, MostSeparatedPairsAreRejected) {
  RandomNumbers random(32);
  int rejected = 0;
  for (int round = 0; round < 20; ++round) {
    PairList<double> block(pair_filter_capacity);
    for (std::size_t i = 0; i < pair_filter_capacity; ++i) {
      TrianglePair3d pair = pair_families()[0].draw(random);
      for (std::size_t k = 0; k < 3; ++k) pair.b[k] = pair.a[k] * 0.99 + Vec3d{0.5, 0.3, 0.2};
      block.set(i, pair.a, pair.b);
    }
    rejected += std::popcount(verdicts_on(block, pair_filter_capacity).apart);
  }
  EXPECT_GT(rejected, 1200);
}

template <class Scalar>
int undecided_in_general_position() {
  RandomNumbers random(33);
  int undecided = 0;
  for (int round = 0; round < 20; ++round) {
    PairList<Scalar> block(pair_filter_capacity);
    for (std::size_t i = 0; i < pair_filter_capacity; ++i) {
      const TrianglePair3d pair = pair_families()[0].draw(random);
      block.set(i, converted<Scalar>(pair.a), converted<Scalar>(pair.b));
    }
    const PairVerdicts verdicts = verdicts_on(block, pair_filter_capacity);
    undecided += std::popcount(~(verdicts.apart | verdicts.crossing));
  }
  return undecided;
}

TEST(PairFilterRate, FewPairsInGeneralPositionStayUndecided) {
  EXPECT_EQ(undecided_in_general_position<double>(), 0);
  EXPECT_LT(undecided_in_general_position<float>(), 4);
}

}  // namespace supple::pair_filter_test
