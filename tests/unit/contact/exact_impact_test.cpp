#include "contact/impact/exact_impact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "support/soups.hpp"
#include "unit/contact/slow_impact.hpp"
#include "unit/contact/triangle_pairs.hpp"

namespace supple::exact_impact_test {

using truth::scaled_count;
using truth::squared_distance_at;
using truth::touch_at;
using Points = std::array<Vec3d, 4>;
using Motion = std::variant<VertexFaceMotion, EdgeEdgeMotion>;

constexpr double unit = std::numeric_limits<double>::epsilon();
constexpr double tiniest = std::numeric_limits<double>::denorm_min();

std::optional<TimeBracket> first_contact(const Motion& motion) {
  return std::visit([](const auto& elements) { return exact_first_contact(elements); }, motion);
}

/// The bracket of a time that is not a double, given the double below it.
TimeBracket above(double low) {
  return {low, std::nextafter(low, 2.0)};
}
TimeBracket exactly(double time) {
  return {time, time};
}

struct Case {
  std::string name;
  Motion motion;
  std::optional<TimeBracket> first;
};
void PrintTo(const Case& named, std::ostream* out) {
  *out << named.name;
}

/// A vertex that moves from `start` to `end`, and a face that is at rest by default.
constexpr Points triangle{{{}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
Case vertex(std::string name, Vec3d start, Vec3d end, std::optional<TimeBracket> first,
            const Points& face_start = triangle, const Points& face_end = triangle) {
  VertexFaceMotion motion{face_start, face_end};
  motion.start[0] = start;
  motion.end[0] = end;
  return {std::move(name), motion, first};
}

Case edges(std::string name, const Points& start, const Points& end, std::optional<TimeBracket> first) {
  return {std::move(name), EdgeEdgeMotion{start, end}, first};
}

/// A vertex that starts and ends at the given z. The face turns so fast that its plane meets the path of the
/// vertex only once: the determinant is z - 9 t².
Case grazing(std::string name, double start, double end, std::optional<TimeBracket> first) {
  return vertex(std::move(name), {0, 0.25, start}, {1, 0.25, end}, first,
                {{{}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{}, {0, 0, 0}, {1, 0, 9}, {0, 1, 0}}});
}

const std::vector<Case> cases{
    vertex("FallsOnTheFace", {1, 1, 1}, {1, 1, -1}, exactly(0.5)),
    vertex("FallsOnTheFaceAtAThird", {1, 1, 1}, {1, 1, -2}, above(0x1.5555555555555p-2)),
    vertex("FallsOnASide", {2, 2, 3}, {2, 2, -1}, exactly(0.75)),
    vertex("FallsOnACorner", {4, 0, 1}, {4, 0, -3}, exactly(0.25)),
    vertex("FallsBeside", {std::nextafter(2.0, 3), 2, 3}, {std::nextafter(2.0, 3), 2, -1}, {}),
    vertex("FallsBesideByTheSmallestNumber", {-tiniest, 1, 1}, {-tiniest, 1, -1}, {}),
    vertex("RestsOnTheFace", {1, 1, 0}, {1, 1, 0}, exactly(0)),
    vertex("RestsAbove", {1, 1, tiniest}, {1, 1, tiniest}, {}),
    vertex("LeavesTheFace", {1, 1, 0}, {1, 1, 1}, exactly(0)),
    vertex("ReachesTheFaceAtLast", {1, 1, 1}, {1, 1, 0}, exactly(1)),
    vertex("NearlyReachesTheFace", {1, 1, 1}, {1, 1, tiniest}, {}),
    vertex("HardlyPassesTheFace", {1, 1, 1}, {1, 1, -tiniest}, above(1 - unit / 2)),
    vertex("HardlyStartsAbove", {1, 1, tiniest}, {1, 1, -1}, TimeBracket{0, tiniest}),
    vertex("PassesAtASurd", {1, 1, -1}, {1, 1, 3}, above(0x1.9e3779b97f4a7p-2),
           {{{}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{}, {0, 0, 0}, {5, 0, 4}, {0, 5, 0}}}),

    // The vertex crosses the side and the plane of the face at different times, with no double in between.
    vertex("FallsBesideByLessThanADouble", {-1, 1, 1}, {2 - unit, 1, -2}, {}),
    vertex("FallsInsideByLessThanADouble", {1, 1, 1}, {-2 + unit, 1, -2}, above(0x1.5555555555555p-2)),

    // In the plane of the face
    vertex("SlidesInFromASide", {-1, 1, 0}, {3, 1, 0}, exactly(0.25)),
    vertex("SlidesInOverACorner", {-1, -1, 0}, {2, 2, 0}, above(0x1.5555555555555p-2)),
    vertex("SlidesAlongASide", {-1, 0, 0}, {3, 0, 0}, exactly(0.25)),
    vertex("SlidesPastACorner", {-1, 1, 0}, {1, -1, 0}, exactly(0.5)),
    vertex("SlidesPastJustOutside", {-1, 1 - unit, 0}, {1, -1 - unit, 0}, {}),
    vertex("SlidesInside", {1, 1, 0}, {1, 2, 0}, exactly(0)),
    vertex("SlidesOnALineThatMissesTheFace", {5, 0, 0}, {9, 0, 0}, {}),
    vertex("FaceGrowsOverIt", {3, 3, 0}, {3, 3, 0}, exactly(0.5), triangle,
           {{{}, {0, 0, 0}, {8, 0, 0}, {0, 8, 0}}}),
    vertex("FaceOpensWithinItsPlane", {0.25, 0.25, 0}, {0.25, 0.25, 0}, above(0x1.5555555555555p-4),
           {{{}, {0, 0, 0}, {1, 0, 0}, {0, 0, 0}}}, {{{}, {0, 0, 0}, {1, 0, 0}, {0, 4, 0}}}),

    // Faces without area
    vertex("MeetsASegment", {1, 0, 1}, {1, 0, -1}, exactly(0.5), {{{}, {0, 0, 0}, {2, 0, 0}, {1, 0, 0}}},
           {{{}, {0, 0, 0}, {2, 0, 0}, {1, 0, 0}}}),
    vertex("PassesASegment", {3, 0, 1}, {3, 0, -1}, {}, {{{}, {0, 0, 0}, {2, 0, 0}, {1, 0, 0}}},
           {{{}, {0, 0, 0}, {2, 0, 0}, {1, 0, 0}}}),
    vertex("RunsIntoTheEndOfASegment", {5, 5, 5}, {1, 1, 1}, exactly(0.75),
           {{{}, {0, 0, 0}, {2, 2, 2}, {1, 1, 1}}}, {{{}, {0, 0, 0}, {2, 2, 2}, {1, 1, 1}}}),
    vertex("MeetsAPoint", {1, 2, 3}, {-1, -2, -3}, exactly(0.5), {}, {}),
    vertex("PassesAPoint", {1, 2, 3}, {-1, -2, -2}, {}, {}, {}),
    vertex("MeetsTheFaceJustWhenItIsFlat", {1, 0, 1}, {1, 0, -1}, exactly(0.5),
           {{{}, {0, 0, 0}, {4, 0, 0}, {0, -1, 1}}}, {{{}, {0, 0, 0}, {4, 0, 0}, {0, 1, -1}}}),
    vertex("PassesJustWhenTheFaceIsFlat", {5, 0, 1}, {5, 0, -1}, {}, {{{}, {0, 0, 0}, {4, 0, 0}, {0, -1, 1}}},
           {{{}, {0, 0, 0}, {4, 0, 0}, {0, 1, -1}}}),
    vertex("MeetsTheFaceJustWhenItIsAPoint", {0, 0, 1}, {0, 0, -2}, above(0x1.5555555555555p-2),
           {{{}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}}}, {{{}, {-2, 0, 0}, {0, -2, 0}, {2, 2, 0}}}),
    vertex("MissesTheFaceJustWhenItIsAPoint", {1, 0, 1}, {1, 0, -2}, {},
           {{{}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}}}, {{{}, {-2, 0, 0}, {0, -2, 0}, {2, 2, 0}}}),

    // Double roots and several roots
    grazing("TouchesWithoutCrossing", -1, 5, above(0x1.5555555555555p-2)),
    grazing("NearlyTouches", std::nextafter(-1.0, -2), 5, {}),
    grazing("CrossesTwice", -0.5, 5.5, above(0x1.8fe5999576089p-4)),
    vertex("CrossesTwiceAndFirstBesideTheFace", {0, -0.25, -0.5}, {1, 0.75, 5.5}, above(0x1.2358a222a6944p-1),
           {{{}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{}, {0, 0, 0}, {1, 0, 9}, {0, 1, 0}}}),

    edges("Cross", {{{-1, 0, 0}, {1, 0, 0}, {0, -1, 1}, {0, 1, 1}}},
          {{{-1, 0, 0}, {1, 0, 0}, {0, -1, -1}, {0, 1, -1}}}, exactly(0.5)),
    edges("CrossAtTheEnds", {{{-1, 0, 0}, {1, 0, 0}, {1, 0, 1}, {1, 1, 1}}},
          {{{-1, 0, 0}, {1, 0, 0}, {1, 0, -3}, {1, 1, -3}}}, exactly(0.25)),
    edges("PassBeyondTheEnds", {{{-1, 0, 0}, {1, 0, 0}, {1 + unit, -1, 1}, {1 + unit, 1, 1}}},
          {{{-1, 0, 0}, {1, 0, 0}, {1 + unit, -1, -1}, {1 + unit, 1, -1}}}, {}),
    edges("ParallelAndOverlapping", {{{0, 0, 0}, {2, 0, 0}, {1, 0, 1}, {5, 0, 1}}},
          {{{0, 0, 0}, {2, 0, 0}, {1, 0, -2}, {5, 0, -2}}}, above(0x1.5555555555555p-2)),
    edges("ParallelAndBesideEachOther", {{{0, 0, 0}, {2, 0, 0}, {3, 0, 1}, {5, 0, 1}}},
          {{{0, 0, 0}, {2, 0, 0}, {3, 0, -2}, {5, 0, -2}}}, {}),
    edges("ParallelJustWhenTheyMeet", {{{0, 0, 0}, {2, 0, 0}, {1, -1, 1}, {3, 1, 1}}},
          {{{0, 0, 0}, {2, 0, 0}, {1, 1, -1}, {3, -1, -1}}}, exactly(0.5)),
    edges("ParallelJustWhenTheyPass", {{{0, 0, 0}, {2, 0, 0}, {3, -1, 1}, {5, 1, 1}}},
          {{{0, 0, 0}, {2, 0, 0}, {3, 1, -1}, {5, -1, -1}}}, {}),
    edges("OnOneLine", {{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {4, 4, 4}}},
          {{{0, 0, 0}, {1, 1, 1}, {0, 0, 0}, {1, 1, 1}}}, above(0x1.5555555555555p-1)),
    edges("OnOneLineApart", {{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {4, 4, 4}}},
          {{{1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}}}, {}),
    edges("OneEdgeIsAPoint", {{{0, 0, 0}, {2, 2, 0}, {1, 1, 1}, {1, 1, 1}}},
          {{{0, 0, 0}, {2, 2, 0}, {1, 1, -1}, {1, 1, -1}}}, exactly(0.5)),
    edges("BothEdgesArePoints", {{{0, 0, 0}, {0, 0, 0}, {1, 1, 1}, {1, 1, 1}}},
          {{{1, 1, 1}, {1, 1, 1}, {0, 0, 0}, {0, 0, 0}}}, exactly(0.5)),
    edges("ScissorsInOnePlane", {{{0, 0, 0}, {4, 0, 0}, {5, 1, 0}, {5, 5, 0}}},
          {{{0, 0, 0}, {4, 0, 0}, {1, -1, 0}, {1, 3, 0}}}, exactly(0.5)),
    edges("CrossInOnePlaneFromTheStart", {{{0, 0, 0}, {4, 0, 0}, {2, -1, 0}, {2, 1, 0}}},
          {{{0, 1, 0}, {4, 1, 0}, {9, -1, 0}, {9, 1, 0}}}, exactly(0)),
    edges("AtRestAndApartInOnePlane", {{{0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {9, 9, 0}}},
          {{{0, 0, 0}, {4, 0, 0}, {0, 1, 0}, {9, 9, 0}}}, {}),

    // Cases that need long integers
    vertex("LargeFace", {1, 1, 1}, {1, 1, -2}, above(0x1.5555555555555p-2),
           {{{}, {0, 0, 0}, {0x1p90, 0, 0}, {0, 0x1p90, 0}}},
           {{{}, {0, 0, 0}, {0x1p90, 0, 0}, {0, 0x1p90, 0}}}),
    vertex("HugeFace", {1e-300, 1e-300, 1}, {1e-300, 1e-300, -2}, above(0x1.5555555555555p-2),
           {{{}, {0, 0, 0}, {1e300, 0, 0}, {0, 1e300, 0}}}, {{{}, {0, 0, 0}, {1e300, 0, 0}, {0, 1e300, 0}}}),
    vertex("BesideAHugeFace", {-1e-300, 1e-300, 1}, {-1e-300, 1e-300, -2}, {},
           {{{}, {0, 0, 0}, {1e300, 0, 0}, {0, 1e300, 0}}}, {{{}, {0, 0, 0}, {1e300, 0, 0}, {0, 1e300, 0}}}),
    vertex("SlidesOntoAHugeFace", {-1e-300, 1, 0}, {1e300, 1, 0}, TimeBracket{0, tiniest},
           {{{}, {0, 0, 0}, {1e300, 0, 0}, {0, 1e300, 0}}}, {{{}, {0, 0, 0}, {1e300, 0, 0}, {0, 1e300, 0}}}),
};

class ExactImpact : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Named, ExactImpact, ::testing::ValuesIn(cases),
                         [](const auto& named) { return named.param.name; });

std::string text(const std::optional<TimeBracket>& first) {
  if (!first) return "never";
  std::ostringstream out;
  out << std::hexfloat << first->low << " to " << first->high;
  return out.str();
}

TEST_P(ExactImpact, HasTheKnownTime) {
  EXPECT_EQ(text(first_contact(GetParam().motion)), text(GetParam().first));
}

template <class Elements, class Change>
Elements changed(const Elements& motion, Change change) {
  Elements result = motion;
  for (Vec3d& p : result.start) p = change(p);
  for (Vec3d& p : result.end) p = change(p);
  return result;
}
template <class Elements>
Elements renumbered(const Elements& motion, const std::array<std::size_t, 4>& order) {
  Elements result;
  for (std::size_t i = 0; i < 4; ++i) {
    result.start[i] = motion.start[order[i]];
    result.end[i] = motion.end[order[i]];
  }
  return result;
}
std::vector<std::array<std::size_t, 4>> orders(const VertexFaceMotion&) {
  return {{0, 1, 3, 2}, {0, 2, 1, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 3, 2, 1}};
}
std::vector<std::array<std::size_t, 4>> orders(const EdgeEdgeMotion&) {
  return {{1, 0, 2, 3}, {0, 1, 3, 2}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 0, 1}, {2, 3, 1, 0}, {3, 2, 1, 0}};
}

/// The same motion with renumbered vertices, permuted axes or scaled coordinates.
std::vector<Motion> equal_motions(const Motion& motion) {
  std::vector<Motion> result;
  std::visit(
      [&](const auto& elements) {
        for (const auto& order : orders(elements)) result.push_back(renumbered(elements, order));
        const auto add = [&](auto change) { result.push_back(changed(elements, change)); };
        add([](Vec3d p) { return Vec3d{p.y, p.x, p.z}; });
        add([](Vec3d p) { return Vec3d{p.z, p.x, p.y}; });
        add([](Vec3d p) { return Vec3d{-p.y, p.z, -p.x}; });
        add([](Vec3d p) { return Vec3d{p.x * 4, p.y, p.z * 0x1p20}; });
      },
      motion);
  return result;
}

TEST_P(ExactImpact, DoesNotDependOnOrderAxesAndScale) {
  for (const Motion& equal : equal_motions(GetParam().motion)) {
    EXPECT_EQ(text(first_contact(equal)), text(GetParam().first));
  }
}

TEST(ExactImpact, ScalesByPowersOfTwo) {
  for (const Case& named : cases) {
    const auto smallest_is_lost = [](double x) {
      return x * 0x1p-900 * 0x1p900 != x || !std::isfinite(x * 0x1p900);
    };
    bool lost = false;
    const auto scaled = [&](Vec3d p) {
      lost = lost || smallest_is_lost(p.x) || smallest_is_lost(p.z) || smallest_is_lost(p.y);
      return Vec3d{p.x * 0x1p900, p.y * 0x1p-900, p.z * 0x1p-900};
    };
    const Motion motion =
        std::visit([&](const auto& m) -> Motion { return changed(m, scaled); }, named.motion);
    if (lost) continue;
    EXPECT_EQ(text(first_contact(motion)), text(named.first)) << named.name;
  }
}

TEST(ExactImpact, NonFiniteCoordinatesTouchNothing) {
  for (const double bad : {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()}) {
    for (std::size_t i = 0; i < 8; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        EdgeEdgeMotion edges;  // all eight points at the origin
        VertexFaceMotion face;
        ASSERT_TRUE(exact_first_contact(edges));
        ASSERT_TRUE(exact_first_contact(face));
        (i < 4 ? edges.start : edges.end)[i % 4][axis] = bad;
        (i < 4 ? face.start : face.end)[i % 4][axis] = bad;
        EXPECT_FALSE(exact_first_contact(edges));
        EXPECT_FALSE(exact_first_contact(face));
      }
    }
  }
}

// Random motion

/// Coordinates from -2 to 2. All, many or none of the points are in one plane or on one line; some coincide.
Points small_points(RandomNumbers& random, std::uint32_t flatness) {
  Points points;
  const std::uint32_t values = 3 + 2 * random.below(2);
  for (Vec3d& p : points) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = random.below(values) - (values / 2.0 - 0.5);
    if (flatness >= 1) p.z = p.x + 2 * p.y;
    if (flatness >= 2) p = {p.x, -p.x, 3 * p.x};
    if (random.below(4) == 0) p = points[random.below(4)];
  }
  return points;
}
Motion small_motion(RandomNumbers& random) {
  const std::uint32_t flatness = random.below(8) / 3;
  const Points start = small_points(random, flatness);
  Points end = small_points(random, flatness);
  for (std::size_t i = 0; i < 4; ++i) {
    if (random.below(5) == 0) end[i] = start[i];
  }
  if (random.below(2) == 0) return VertexFaceMotion{start, end};
  return EdgeEdgeMotion{start, end};
}
Motion perturbed(const Motion& motion, RandomNumbers& random) {
  const auto move = [&](Vec3d p) {
    for (int axis = 0; axis < 3; ++axis) {
      if (random.below(4) == 0) p[axis] += (random.below(2) == 0 ? 1 : -1) * (p[axis] == 0 ? 0x1p-60 : unit);
    }
    return p;
  };
  return std::visit([&](const auto& m) -> Motion { return changed(m, move); }, motion);
}

std::string describe(const Motion& motion) {
  std::ostringstream out;
  out << std::hexfloat << (motion.index() == 0 ? "vertex-face" : "edge-edge");
  std::visit(
      [&](const auto& m) {
        for (const Points& points : {m.start, m.end}) {
          for (const Vec3d& p : points) out << " {" << p.x << ", " << p.y << ", " << p.z << "}";
        }
      },
      motion);
  return out.str();
}

TEST(ExactImpact, FindsWhatDistancesFind) {
  RandomNumbers random(1);
  // Elements with such coordinates either touch or stay farther apart than this.
  constexpr double near = 1e-6;
  for (int i = 0; i < scaled_count(400); ++i) {
    const Motion motion = small_motion(random);
    const auto first = first_contact(motion);
    const auto slow = std::visit([&](const auto& m) { return truth::advance_until_near(m, near); }, motion);
    ASSERT_EQ(first.has_value(), slow.has_value()) << describe(motion);
    if (!first) continue;
    EXPECT_LE(*slow, first->high) << describe(motion);
    // The distance decreases at least as fast as the square of the remaining time.
    EXPECT_LE(first->low, *slow + 0.01) << describe(motion);
    const double then = std::visit([&](const auto& m) { return squared_distance_at(m, first->low); }, motion);
    EXPECT_LE(then, 1e-28) << describe(motion);
  }
}

TEST(ExactImpact, ElementsTouchAtExactTimesAndNeverEarlier) {
  RandomNumbers random(2);
  int exact_times = 0;
  for (int i = 0; i < scaled_count(40); ++i) {
    Motion motion = small_motion(random);
    if (i % 2 == 1) motion = perturbed(motion, random);
    const auto first = first_contact(motion);
    const double end = first ? first->low : 1;
    std::visit(
        [&](const auto& m) {
          const bool exact = first && first->low == first->high;
          EXPECT_TRUE(!exact || touch_at(m, end)) << describe(motion);
          exact_times += exact;
          for (const double part : {0.0, 0.25, 0.5, 0.75, 0.9, 1 - 0x1p-20, 1 - unit, 1.0}) {
            if (part * end == end && exact) continue;
            EXPECT_FALSE(touch_at(m, part * end)) << describe(motion);
          }
        },
        motion);
  }
  EXPECT_GT(exact_times, 10);
}

TEST(ExactImpact, RandomMotionDoesNotDependOnOrderAxesAndScale) {
  RandomNumbers random(3);
  for (int i = 0; i < scaled_count(100); ++i) {
    Motion motion = small_motion(random);
    if (i % 3 != 0) motion = perturbed(motion, random);
    const auto first = first_contact(motion);
    for (const Motion& equal : equal_motions(motion)) {
      ASSERT_EQ(text(first_contact(equal)), text(first)) << describe(motion);
    }
  }
}

/// The vertex is on a side of the face at a third of the step, up to one rounding step of one coordinate.
VertexFaceMotion nearly_on_a_side(RandomNumbers& random) {
  VertexFaceMotion motion;
  const auto integers = [&] {
    return Vec3d{random.below(33) - 16.0, random.below(33) - 16.0, random.below(33) - 16.0};
  };
  std::array<Vec3d, 4> then{Vec3d{}, integers(), integers(), integers()};
  then[0] = then[1] + 0.25 * (then[2] - then[1]);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d path = integers();
    motion.start[i] = then[i] - path;
    motion.end[i] = then[i] + 2 * path;
  }
  double& number = motion.end[random.below(4)][static_cast<int>(random.below(3))];
  number = std::nextafter(number, random.below(2) == 0 ? -99.0 : 99.0);
  return motion;
}

TEST(ExactImpact, TellsTimesApartThatNoDoubleSeparates) {
  RandomNumbers random(5);
  int touching = 0;
  const int count = scaled_count(50);
  for (int i = 0; i < count; ++i) {
    const Motion motion = nearly_on_a_side(random);
    const auto first = first_contact(motion);
    touching += first.has_value();
    for (const Motion& equal : equal_motions(motion)) {
      ASSERT_EQ(text(first_contact(equal)), text(first)) << describe(motion);
    }
  }
  EXPECT_GT(touching, count / 4);
  EXPECT_LT(touching, count * 3 / 4);
}

/// Rounds the coordinates so that sums of a few of them are exact.
Vec3d coarse(Vec3d p) {
  return {std::round(p.x * 0x1p44) * 0x1p-44, std::round(p.y * 0x1p44) * 0x1p-44,
          std::round(p.z * 0x1p44) * 0x1p-44};
}

/// The vertex touches the face at the middle of the step, and perhaps earlier.
TEST(ExactImpact, FindsPlantedContacts) {
  RandomNumbers random(4);
  for (int i = 0; i < scaled_count(40); ++i) {
    VertexFaceMotion motion;
    const double alpha = random.below(5) / 8.0, beta = random.below(4) / 8.0;
    std::array<Vec3d, 4> middle;
    for (std::size_t k = 1; k < 4; ++k) middle[k] = coarse(random.vector(1));
    middle[0] = middle[1] + alpha * (middle[2] - middle[1]) + beta * (middle[3] - middle[1]);
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3d path = coarse(random.vector(1));
      motion.start[k] = middle[k] - path;
      motion.end[k] = middle[k] + path;
    }
    ASSERT_TRUE(touch_at(motion, 0.5));
    const auto first = exact_first_contact(motion);
    ASSERT_TRUE(first) << describe(motion);
    EXPECT_LE(first->high, 0.5) << describe(motion);
  }
}

/// Small numbers times one of three powers of two, which differ much.
double hostile_number(RandomNumbers& random, int exponent) {
  const double value = random.between(-3, 3) + (random.below(2) == 0 ? unit : 0);
  return std::ldexp(value, exponent * random.between(-1, 1));
}

/// At rest, with opposite ends, or any.
std::array<Points, 2> hostile_step(RandomNumbers& random, int exponent) {
  std::array<Points, 2> step;
  for (Points& points : step) {
    for (Vec3d& p : points)
      p = {hostile_number(random, exponent), hostile_number(random, exponent),
           hostile_number(random, exponent)};
  }
  auto& [start, end] = step;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t kind = random.below(4);
    if (kind == 0) end[k] = start[k];
    if (kind == 1) end[k] = -1.0 * start[k];
  }
  return step;
}

TEST(ExactImpact, OfHostileCoordinatesIsThatOfAlgebra) {
  RandomNumbers random(5);
  int touching = 0;
  const int count = scaled_count(30);
  for (int i = 0; i < count; ++i) {
    const auto [start, end] = hostile_step(random, i % 8 == 0 ? 200 : 40);
    const double separation = i % 2 == 0 ? 0 : std::fabs(hostile_number(random, 40)) + unit;
    const auto first_of = [&](const auto& motion) {
      return separation > 0 ? exact_first_contact(motion, separation) : exact_first_contact(motion);
    };
    const VertexFaceMotion face{start, end};
    const auto first = first_of(face);
    touching += first.has_value() && first->high > 0;
    ASSERT_EQ(first, first_contact_by_algebra(face, separation)) << i;
    const EdgeEdgeMotion edges{start, end};
    ASSERT_EQ(first_of(edges), first_contact_by_algebra(edges, separation)) << i;
  }
  EXPECT_GT(touching, count / 20);
}

}  // namespace supple::exact_impact_test
