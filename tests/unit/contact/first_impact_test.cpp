// Compares the first impacts of element pairs with the algebraic reference, for random and adversarial
// motions: a million in optimised builds, fewer in slower builds with sanitizers.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <type_traits>

#include "contact/impact/impact_filter.hpp"
#include "contact/intersection/coplanar_search.hpp"
#include "core/float_rounding.hpp"
#include "geometry/vector.hpp"
#include "supple/continuous.hpp"
#include "supple/error.hpp"
#include "support/instruction_sets.hpp"
#include "support/soups.hpp"
#include "unit/contact/slow_impact.hpp"

namespace supple::first_impact_test {

#if defined(NDEBUG) && !defined(SUPPLE_SANITIZED)
constexpr int queries_per_family = 3000;
#else
constexpr int queries_per_family = 320;
#endif

using Corners = std::array<Vec3d, 4>;
struct Paths {
  Corners start, end;
};

template <class Function>
void for_each_coordinate(Paths& paths, Function function) {
  for (Corners* corners : {&paths.start, &paths.end}) {
    for (Vec3d& p : *corners) {
      for (int axis = 0; axis < 3; ++axis) function(p[axis]);
    }
  }
}

Paths random_paths(RandomNumbers& random, double size, double step) {
  Paths paths;
  for (std::size_t i = 0; i < 4; ++i) {
    paths.start[i] = random.vector(size);
    paths.end[i] = paths.start[i] + random.vector(step);
  }
  return paths;
}

/// Integer coordinates from -n to n, which give mostly degenerate cases.
Paths lattice_paths(RandomNumbers& random, std::uint32_t n) {
  Paths paths;
  for_each_coordinate(paths, [&](double& x) { x = static_cast<double>(random.below(2 * n + 1)) - n; });
  return paths;
}

void nudge(RandomNumbers& random, double& x) {
  const std::uint32_t way = random.below(6);
  if (way == 0) x = std::nextafter(x, 10);
  if (way == 1) x = std::nextafter(x, -10);
}

/// Barycentric coordinates of the four vertices at a common point of both elements; those of the second
/// element are negative.
std::array<double, 4> common_point_weights(RandomNumbers& random, bool edges) {
  // Multiples of 1/8, including both ends: their products with lattice coordinates are exact.
  const auto eighth = [&](std::uint32_t most) { return random.below(most + 1) / 8.0; };
  if (edges) {
    const double s = eighth(8), r = eighth(8);
    return {1 - s, s, -(1 - r), -r};
  }
  const double alpha = eighth(8), beta = eighth(static_cast<std::uint32_t>(8 - 8 * alpha));
  return {1, -(1 - alpha - beta), -alpha, -beta};
}

/// Moves one vertex so that the elements share a point at a multiple of 1/8 of the step, or nearly if nudged.
Paths meeting_paths(RandomNumbers& random, bool edges, bool nudged) {
  Paths paths = lattice_paths(random, 8);
  const std::array<double, 4> weights = common_point_weights(random, edges);
  const double time = random.below(9) / 8.0;
  std::size_t moved = 0;  // a vertex whose weight divides without rounding
  for (std::size_t i = 0; i < 4; ++i) {
    if (std::abs(weights[i]) == 1 || std::abs(weights[i]) == 0.5) moved = i;
  }
  if (std::abs(weights[moved]) < 0.5) return paths;
  for (int axis = 0; axis < 3; ++axis) {
    double gap = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      gap += weights[i] * ((1 - time) * paths.start[i][axis] + time * paths.end[i][axis]);
    }
    paths.start[moved][axis] -= gap / weights[moved];
    paths.end[moved][axis] -= gap / weights[moved];
  }
  if (nudged) for_each_coordinate(paths, [&](double& x) { nudge(random, x); });
  return paths;
}

struct QueryFamily {
  const char* name;
  std::function<Paths(RandomNumbers&, bool edges)> make;
};
/// GoogleTest calls this function; ctest shows the name.
void PrintTo(const QueryFamily& family, std::ostream* out) {
  *out << family.name;
}

const QueryFamily query_families[] = {
    {"Random", [](RandomNumbers& r, bool) { return random_paths(r, 1, 1); }},
    {"Slow", [](RandomNumbers& r, bool) { return random_paths(r, 1, 1e-5); }},
    {"Fast", [](RandomNumbers& r, bool) { return random_paths(r, 1e-2, 3); }},
    {"FarFromTheOrigin",
     [](RandomNumbers& r, bool) {
       Paths paths = random_paths(r, 1, 1);
       for_each_coordinate(paths, [](double& x) { x += 1e7; });
       return paths;
     }},
    {"SinglePrecision",
     [](RandomNumbers& r, bool) {
       Paths paths = random_paths(r, 1, 0.5);
       for_each_coordinate(paths, [](double& x) { x = static_cast<float>(x); });
       return paths;
     }},
    {"SmallLattice", [](RandomNumbers& r, bool) { return lattice_paths(r, 1); }},
    {"Lattice", [](RandomNumbers& r, bool) { return lattice_paths(r, 3); }},
    {"NudgedLattice",
     [](RandomNumbers& r, bool) {
       Paths paths = lattice_paths(r, 2);
       for_each_coordinate(paths, [&](double& x) { nudge(r, x); });
       return paths;
     }},
    {"OnePlane",
     [](RandomNumbers& r, bool) {
       Paths paths = r.below(2) == 0 ? lattice_paths(r, 3) : random_paths(r, 1, 1);
       for (Corners* corners : {&paths.start, &paths.end}) {
         for (Vec3d& p : *corners) p.z = 0.5;
       }
       return paths;
     }},
    {"OneLine",
     [](RandomNumbers& r, bool) {
       Paths paths = lattice_paths(r, 4);
       for (Corners* corners : {&paths.start, &paths.end}) {
         for (Vec3d& p : *corners) p = {p.x, 2 * p.x, -p.x};
       }
       return paths;
     }},
    {"AtRest",
     [](RandomNumbers& r, bool) {
       Paths paths = lattice_paths(r, 2);
       paths.end = paths.start;
       return paths;
     }},
    {"Collapsing",
     [](RandomNumbers& r, bool) {
       Paths paths = lattice_paths(r, 2);
       Corners& corners = r.below(2) == 0 ? paths.start : paths.end;
       corners[1 + r.below(3)] = corners[1 + r.below(3)];
       return paths;
     }},
    {"Meeting", [](RandomNumbers& r, bool edges) { return meeting_paths(r, edges, false); }},
    {"NearlyMeeting", [](RandomNumbers& r, bool edges) { return meeting_paths(r, edges, true); }},
    {"Huge",
     [](RandomNumbers& r, bool) {
       Paths paths = r.below(2) == 0 ? lattice_paths(r, 3) : random_paths(r, 1, 1);
       for_each_coordinate(paths, [](double& x) { x *= 0x1p500; });
       return paths;
     }},
    {"Tiny",
     [](RandomNumbers& r, bool) {
       Paths paths = r.below(2) == 0 ? lattice_paths(r, 3) : random_paths(r, 1, 1);
       for_each_coordinate(paths, [](double& x) { x *= 0x1p-500; });
       return paths;
     }},
    {"MixedScales",
     [](RandomNumbers& r, bool) {
       Paths paths = lattice_paths(r, 2);
       for_each_coordinate(paths, [&](double& x) {
         const std::uint32_t way = r.below(10);
         if (way == 0) x *= 0x1p40;
         if (way == 1) x *= 0x1p-40;
       });
       return paths;
     }},
};

/// One query in this many is also tested with a separation: polynomials of degree six instead of three make
/// the algebra a thousand times slower.
constexpr int separated_share = 16;

class FirstImpact : public ::testing::TestWithParam<QueryFamily> {};

/// The vector filter must keep every motion that touches.
void expect_filter_keeps(const RelativeMotion& motion, double separation) {
  RelativeMotionBlock block;
  block.set(0, motion);
  EXPECT_EQ(may_touch(block, 1, motion.is_square, round_up(separation)), 1u);
}

/// The vector from the point of the second element to that of the first at the time of the impact.
template <class Motion>
Vec3d difference_at_impact(const Motion& motion, const Impact& impact) {
  Vec3d difference;
  const double t = impact.toi;
  for (std::size_t i = 0; i < 4; ++i) {
    const bool of_first = i == 0 || (std::is_same_v<Motion, EdgeEdgeMotion> && i == 1);
    const double weight = of_first ? impact.barycentric[i] : -impact.barycentric[i];
    difference = difference + weight * ((1 - t) * motion.start[i] + t * motion.end[i]);
  }
  return difference;
}

/// With a separation, the normal is the direction between the closest points.
template <class Motion>
void expect_normal_between_points(const Motion& motion, const Impact& impact, double separation) {
  const Vec3d d = difference_at_impact(motion, impact);
  const double length = std::hypot(d.x, d.y, d.z);
  double size = 0;
  for (const Corners* corners : {&motion.start, &motion.end}) {
    for (const Vec3d& p : *corners) size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  if (length < 1e-9 * size || separation < 1e-9 * size) return;
  EXPECT_GT(dot(d, impact.normal), (1 - 1e-6) * length);
  EXPECT_LE(length, separation + 1e-8 * size);
}

template <class Motion>
void expect_start_distance(const Motion& motion, const Impact& impact) {
  const truth::Rational square = truth::squared_distance_at(motion, truth::Rational(0));
  const auto distance = static_cast<double>(std::sqrt(static_cast<long double>(square)));
  EXPECT_NEAR(impact.start_distance, distance, 0x1p-20 * distance);
}

template <class Motion>
void expect_first_impact(const Motion& motion, double separation, int& touching) {
  const std::optional<Impact> impact = first_impact(motion, {.min_separation = separation});
  const std::optional<TimeBracket> truth = first_contact_by_algebra(motion, separation);
  ASSERT_EQ(impact.has_value(), truth.has_value());
  if (!truth) return;
  ++touching;
  expect_filter_keeps(relative_motion(motion), separation);
  EXPECT_EQ(impact->certainty, ImpactCertainty::certain);
  EXPECT_LE(impact->toi, truth->low);
  EXPECT_GE(impact->toi, truth->high - toi_tolerance_at(truth->high));
  EXPECT_GE(impact->toi, 0);
  EXPECT_EQ(impact->touching_at_start, truth->high == 0);
  EXPECT_EQ(impact->toi > 0, truth->low > 0);
  if (separation > 0) {
    expect_start_distance(motion, *impact);
    expect_normal_between_points(motion, *impact, separation);
  }
  for (const double weight : impact->barycentric) {
    EXPECT_GE(weight, 0);
    EXPECT_LE(weight, 1);
  }
  EXPECT_NEAR(std::accumulate(impact->barycentric.begin(), impact->barycentric.end(), 0.0), 2, 1e-12);
  const Vec3d n = impact->normal;
  const double length = std::hypot(n.x, n.y, n.z);
  EXPECT_TRUE(length == 0 || std::abs(length - 1) < 1e-12) << length;
}

template <class Motion>
void expect_family(const QueryFamily& family, bool edges, std::uint64_t seed) {
  RandomNumbers random(seed);
  int touching = 0;
  for (int query = 0; query < queries_per_family; ++query) {
    const Paths paths = family.make(random, edges);
    const Motion motion{paths.start, paths.end};
    expect_first_impact(motion, 0, touching);
    if (query % separated_share == 0) {
      const double size = std::abs(paths.start[0].x) + std::abs(paths.start[1].y);
      const double separation = std::ldexp(size, -static_cast<int>(random.below(8)));
      expect_first_impact(motion, separation, touching);
    }
    if (::testing::Test::HasFailure()) FAIL() << "query " << query;
  }
  EXPECT_GT(touching, 0);
}

TEST_P(FirstImpact, OfVertexAndFaceEqualsAlgebra) {
  expect_family<VertexFaceMotion>(GetParam(), false, 1);
}

TEST_P(FirstImpact, OfTwoEdgesEqualsAlgebra) {
  expect_family<EdgeEdgeMotion>(GetParam(), true, 2);
}

TEST(FirstImpactAtStart, KeepsTheSideOfElementsThatPartWithinTheSeparation) {
  RandomNumbers random(11);
  const Vec3d v{.3, .05, -.3};
  for (int i = 0; i < 200; ++i) {
    const Vec3d step = std::pow(10.0, -static_cast<double>(random.below(20))) * random.vector(0.01);
    const VertexFaceMotion motion{{v, {0, 0, 0}, {1, 0, 0}, {0, 0, -1}},
                                  {v + step, {0, 0, 0}, {1, 0, 0}, {0, 0, -1}}};
    const auto impact = first_impact(motion, {.min_separation = 0.1});
    ASSERT_TRUE(impact.has_value());
    EXPECT_TRUE(impact->touching_at_start);
    EXPECT_EQ(impact->toi, 0);
    EXPECT_EQ(impact->start_distance, 0.05);
    EXPECT_NEAR(impact->normal.y, 1, 1e-15) << step.y;
  }
}

/// Elements that are much closer than the separation, down to 1e-300, with velocities in all directions.
TEST(FirstImpactAtStart, NormalIsTheDirectionOfTheGap) {
  RandomNumbers random(12);
  for (const double gap : {1e-2, 1e-5, 1e-9, 1e-15, 1e-40, 1e-300}) {
    for (int i = 0; i < 20; ++i) {
      const Corners face{
          {{random.below(3) / 4.0, 0, random.below(3) / 4.0}, {-1, 0, -1}, {2, 0, -1}, {0, 0, 3}}};
      const double side = i % 2 == 0 ? 1 : -1;
      VertexFaceMotion motion{face, face};
      motion.start[0].y = side * gap;
      for (Vec3d& p : motion.end) p = p + random.vector(0.1);
      const auto impact = first_impact(motion, {.min_separation = 0.1});
      ASSERT_TRUE(impact && impact->touching_at_start);
      EXPECT_NEAR(impact->normal.y, side, 1e-12) << gap;
      EXPECT_NEAR(impact->start_distance / gap, 1, 1e-6);
    }
  }
}

/// Elements that start outside the separation by any gap and close it: the time is positive and exact to the
/// relative tolerance.
TEST(FirstImpactAtStart, IsPositiveWhereElementsAreApart) {
  for (const double separation : {0.0, 1e-300, 1e-12, 1e-6, 1e-3, 0.1}) {
    for (int exponent = 4; exponent <= 300; exponent += exponent < 20 ? 1 : 28) {
      const double height = separation + std::pow(10.0, -exponent);
      if (height == separation) continue;
      for (const double fall : {1e-3, 1.0, 1.7}) {
        const VertexFaceMotion vertex{{{{.25, height, .25}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}}},
                                      {{{.25, height - fall, .25}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}}}};
        const EdgeEdgeMotion edge{
            {{{-1, height, .5}, {1, height, .5}, {.2, 0, 0}, {.2, 0, 1}}},
            {{{-1, height - fall, .5}, {1, height - fall, .6}, {.2, 0, 0}, {.2, 0, 1}}}};
        int touching = 0;
        expect_first_impact(vertex, separation, touching);
        expect_first_impact(edge, separation, touching);
        EXPECT_EQ(touching, separation < height && fall > height - separation ? 2 : 0)
            << separation << ' ' << exponent << ' ' << fall;
      }
    }
  }
}

/// Where the kernel decides, a pair has the same result alone and in a block of any size, on every
/// instruction set.
TEST_P(FirstImpact, IsTheSameForBlocksOfPairs) {
  RandomNumbers random(7);
  for (int round = 0; round < 2 * std::max(queries_per_family / 1000, 1); ++round) {
    const bool edges = round % 2 == 1;
    constexpr std::size_t count = MotionBlock::capacity;
    std::array<std::optional<Impact>, count> singles;
    MotionBlock block;
    for (std::size_t k = 0; k < count; ++k) {
      const Paths paths = GetParam().make(random, edges);
      const VertexFaceMotion face{paths.start, paths.end};
      const EdgeEdgeMotion edge{paths.start, paths.end};
      block.set(k, edges ? relative_motion(edge) : relative_motion(face));
      singles[k] = edges ? first_impact(edge) : first_impact(face);
    }
    for_each_target([&](const char* target) {
      CoplanarSearch all, some;
      search_coplanar_times(block, count, edges, all);
      search_coplanar_times(block, 17, edges, some);
      EXPECT_EQ(some.apart, all.apart & 0x1ffff) << target;
      EXPECT_EQ(some.touching, all.touching & 0x1ffff) << target;
      EXPECT_EQ(all.apart & all.touching, 0u) << target;
      for (std::size_t k = 0; k < count; ++k) {
        if ((all.apart >> k & 1) != 0) {
          EXPECT_FALSE(singles[k]) << target;
        }
        if ((all.touching >> k & 1) != 0) {
          ASSERT_TRUE(singles[k]) << target;
          EXPECT_EQ(singles[k]->toi, all.times[k]) << target;
        }
      }
    });
  }
}

TEST(CoplanarSearch, DecidesMostPairsInGeneralPosition) {
  RandomNumbers random(8);
  int touching = 0, decided = 0;
  for (int round = 0; round < 100; ++round) {
    const bool edges = round % 2 == 1;
    MotionBlock block;
    for (std::size_t k = 0; k < MotionBlock::capacity; ++k) {
      const Paths paths = random_paths(random, 1, 1);
      const VertexFaceMotion face{paths.start, paths.end};
      const EdgeEdgeMotion edge{paths.start, paths.end};
      touching += edges ? first_impact(edge).has_value() : first_impact(face).has_value();
      block.set(k, edges ? relative_motion(edge) : relative_motion(face));
    }
    CoplanarSearch search;
    search_coplanar_times(block, MotionBlock::capacity, edges, search);
    decided += std::popcount(search.touching);
  }
  EXPECT_GT(touching, 200);
  EXPECT_GT(decided, touching * 19 / 20);
}

INSTANTIATE_TEST_SUITE_P(Families, FirstImpact, ::testing::ValuesIn(query_families),
                         [](const auto& family) { return family.param.name; });

TEST(ImpactFilter, KeepsWhatTouchesOnEveryInstructionSet) {
  RandomNumbers random(3);
  for (int round = 0; round < 20; ++round) {
    for (const bool edges : {false, true}) {
      RelativeMotionBlock block;
      std::uint64_t touching = 0;
      for (std::size_t k = 0; k < 64; ++k) {
        const Paths paths = meeting_paths(random, edges, true);
        const VertexFaceMotion face{paths.start, paths.end};
        const EdgeEdgeMotion edge{paths.start, paths.end};
        const bool touches = edges ? first_impact(edge).has_value() : first_impact(face).has_value();
        touching |= std::uint64_t{touches} << k;
        block.set(k, edges ? relative_motion(edge) : relative_motion(face));
      }
      for_each_target([&](const char* target) {
        EXPECT_EQ(touching & ~may_touch(block, 64, edges, 0), 0u) << target;
        EXPECT_EQ(may_touch(block, 17, edges, 0) >> 17, 0u) << target;
      });
    }
  }
}

TEST(ImpactFilter, TellsMostPairsApart) {
  RandomNumbers random(4);
  int left = 0;
  for (int query = 0; query < 1000; ++query) {
    const Paths paths = random_paths(random, 1, 0.1);
    RelativeMotionBlock block;
    block.set(0, relative_motion(EdgeEdgeMotion{paths.start, paths.end}));
    left += may_touch(block, 1, true, 0) != 0 ? 1 : 0;
  }
  EXPECT_LT(left, 200);
}

TEST(FirstImpactDetails, OfAVertexThatFallsOnAFace) {
  const VertexFaceMotion motion{{{{1, 1, 1}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
                                {{{1, 1, -1}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}};
  const std::optional<Impact> impact = first_impact(motion);
  ASSERT_TRUE(impact);
  EXPECT_NEAR(impact->toi, 0.5, 1e-12);
  EXPECT_EQ(impact->normal, (Vec3d{0, 0, 1}));
  EXPECT_NEAR(impact->barycentric[1], 0.5, 1e-12);
  const std::optional<Impact> sooner = first_impact(motion, {.min_separation = 0.5});
  ASSERT_TRUE(sooner);
  EXPECT_NEAR(sooner->toi, 0.25, 1e-9);
  EXPECT_LE(sooner->toi, 0.25);
  EXPECT_NEAR(sooner->point.z, 0.25, 1e-9);
  EXPECT_EQ(sooner->normal, (Vec3d{0, 0, 1}));
}

/// Coordinates up to the largest double change the scale, nothing else.
TEST(FirstImpactDetails, AreThoseOfSmallCoordinatesUpToTheLargestDouble) {
  RandomNumbers random(12);
  const double factor = 0x1p1023;
  int checked = 0;
  for (int query = 0; query < 2000; ++query) {
    const Paths small = random_paths(random, 1, 1);
    Paths large = small;
    for (Corners* corners : {&large.start, &large.end}) {
      for (Vec3d& p : *corners) p = factor * p;
    }
    for (const double separation : {0.0, 0.05}) {
      for (const bool are_edges : {false, true}) {
        const auto impact_of = [&](const Paths& paths, double scale) {
          const ImpactOptions options{.min_separation = scale * separation};
          return are_edges ? first_impact(EdgeEdgeMotion{paths.start, paths.end}, options)
                           : first_impact(VertexFaceMotion{paths.start, paths.end}, options);
        };
        const auto expected = impact_of(small, 1), found = impact_of(large, factor);
        ASSERT_EQ(found.has_value(), expected.has_value()) << query;
        if (!found) continue;
        EXPECT_NEAR(found->toi, expected->toi, 0x1p-29) << query;
        EXPECT_EQ(found->touching_at_start, expected->touching_at_start) << query;
        EXPECT_TRUE(is_finite(found->point)) << query;
        EXPECT_NEAR(dot(found->normal, found->normal), 1, 1e-12) << query;
        EXPECT_NEAR(std::accumulate(found->barycentric.begin(), found->barycentric.end(), 0.0), 2, 1e-9)
            << query;
        EXPECT_NEAR(found->start_distance / factor, expected->start_distance, 1e-5) << query;
        if (dot(found->normal, expected->normal) < 0.9) continue;  // nearly parallel elements
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_NEAR(found->point[axis] / factor, expected->point[axis], 1e-5) << query;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 500);
}

TEST(FirstImpactDetails, NormalsPointToWhereTheFirstElementCameFrom) {
  RandomNumbers random(5);
  int checked = 0;
  for (int query = 0; query < 3000; ++query) {
    const Paths paths = random_paths(random, 1, 1);
    const EdgeEdgeMotion motion{paths.start, paths.end};
    const std::optional<Impact> impact = first_impact(motion);
    if (!impact || impact->toi < 1e-3) continue;
    // Just before the impact, the two points are separated along the normal.
    const double t = impact->toi - 1e-4;
    Vec3d gap;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3d p = (1 - t) * paths.start[i] + t * paths.end[i];
      gap = gap + (i < 2 ? 1.0 : -1.0) * impact->barycentric[i] * p;
    }
    EXPECT_GT(gap.x * impact->normal.x + gap.y * impact->normal.y + gap.z * impact->normal.z, 0) << query;
    ++checked;
  }
  EXPECT_GT(checked, 100);
}

TEST(FirstImpactDetails, DoNotDependOnTheOrderOfTheElements) {
  RandomNumbers random(6);
  for (int query = 0; query < 2000; ++query) {
    const Paths paths = meeting_paths(random, true, query % 2 == 1);
    const auto swapped = [](const Corners& p) { return Corners{p[3], p[2], p[0], p[1]}; };
    const std::optional<Impact> one = first_impact(EdgeEdgeMotion{paths.start, paths.end});
    const std::optional<Impact> other =
        first_impact(EdgeEdgeMotion{swapped(paths.start), swapped(paths.end)});
    ASSERT_EQ(one.has_value(), other.has_value());
    if (one) {
      EXPECT_NEAR(one->toi, other->toi, toi_tolerance);
    }
  }
}

TEST(FirstImpactOfPoints, EqualsAlgebraAndTheFaceThatItSpans) {
  RandomNumbers random(8);
  for (int i = 0; i < queries_per_family / 2; ++i) {
    const bool is_planar = i % 2 == 0, is_lattice = i % 3 == 0;
    const auto point = [&] {
      Vec3d p = random.vector(1);
      if (is_lattice) p = {std::nearbyint(2 * p.x), std::nearbyint(2 * p.y), std::nearbyint(2 * p.z)};
      if (is_planar) p.z = 0;
      return p;
    };
    const double separation = i % 5 < 2 ? 0.1 : 0;
    const PointEdgeMotion edge{{point(), point(), point()}, {point(), point(), point()}};
    const PointPointMotion points{{edge.start[0], edge.start[1]}, {edge.end[0], edge.end[1]}};
    const auto check = [&](const auto& motion, const VertexFaceMotion& face) {
      const std::optional<TimeBracket> truth = first_contact_by_algebra(motion, separation);
      const std::optional<Impact> impact = first_impact(motion, {.min_separation = separation});
      ASSERT_EQ(impact.has_value(), truth.has_value()) << i;
      if (!impact) return;
      EXPECT_LE(impact->toi, truth->low);
      EXPECT_GE(impact->toi, truth->high - toi_tolerance_at(truth->high));
      EXPECT_EQ(impact->toi, first_impact(face, {.min_separation = separation})->toi);
      EXPECT_EQ(impact->barycentric[0], 1);
      EXPECT_NEAR(impact->barycentric[1] + impact->barycentric[2], 1, 1e-12);
      EXPECT_EQ(impact->barycentric[3], 0);
      if (is_planar) {
        EXPECT_EQ(impact->normal.z, 0);
      }
    };
    const auto& [s, e] = edge;
    check(edge, {{s[0], s[1], s[2], s[2]}, {e[0], e[1], e[2], e[2]}});
    check(points, {{s[0], s[1], s[1], s[1]}, {e[0], e[1], e[1], e[1]}});
  }
}

TEST(FirstImpactOfPoints, InAPlaneHasTheNormalOfTheEdge) {
  const PointEdgeMotion motion{{Vec3d{0.3, 1, 0}, {0, 0, 0}, {1, 0, 0}},
                               {Vec3d{0.9, -1, 0}, {0, 0, 0}, {1, 0, 0}}};
  const std::optional<Impact> impact = first_impact(motion);
  ASSERT_TRUE(impact);
  EXPECT_NEAR(impact->toi, 0.5, 1e-8);
  EXPECT_NEAR(impact->normal.y, 1, 1e-12);
  EXPECT_NEAR(impact->barycentric[2], 0.6, 1e-7);
  EXPECT_FALSE(first_impact(motion, {.max_time = 0.4}));
  EXPECT_TRUE(first_impact(motion, {.max_time = 0.6}));
}

TEST(FirstImpactOptions, MaxTimeLeavesOutWhatIsReportedLater) {
  RandomNumbers random(9);
  std::size_t found = 0;
  for (int i = 0; i < 2 * queries_per_family; ++i) {
    const Paths paths = random_paths(random, 1, 1);
    const VertexFaceMotion motion{paths.start, paths.end};
    const double separation = i % 2 == 0 ? 0.05 : 0;
    const std::optional<Impact> impact = first_impact(motion, {.min_separation = separation});
    if (!impact) continue;
    ++found;
    for (const double until : {0.0, 0.3, impact->toi, std::nextafter(impact->toi, 0)}) {
      const bool is_reported =
          first_impact(motion, {.min_separation = separation, .max_time = until}).has_value();
      EXPECT_EQ(is_reported, impact->toi <= until) << i;
    }
  }
  EXPECT_GT(found, static_cast<std::size_t>(queries_per_family / 40));
  EXPECT_THROW(first_impact(VertexFaceMotion{}, {.max_time = 1.5}), Error);
}

TEST(FirstImpactErrors, AreForSeparationsThatAreNone) {
  const VertexFaceMotion motion{};
  for (const double wrong :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(first_impact(motion, {.min_separation = wrong}), Error);
  }
}

TEST(FirstImpactErrors, NothingTouchesWhatIsNotFinite) {
  EdgeEdgeMotion motion{};  // all points at the origin
  EXPECT_TRUE(first_impact(motion));
  motion.end[2].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(first_impact(motion));
  motion.end[2].y = -std::numeric_limits<double>::infinity();
  EXPECT_FALSE(first_impact(motion));
}

}  // namespace supple::first_impact_test
