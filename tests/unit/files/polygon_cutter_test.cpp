#include "files/polygon/polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "geometry/vector.hpp"
#include "support/polygons.hpp"
#include "support/random.hpp"

namespace supple::polygon_cutter_test {

using polygons::fault_of_cover;
using polygons::Point;
using polygons::Polygon;

struct Cut {
  PolygonShape shape;
  std::vector<Triangle> triangles;
};

Cut cut(const std::vector<Vec3d>& corners) {
  Cut result;
  result.triangles.resize(corners.size() - 2);
  result.shape = cut_polygon(corners, result.triangles);
  return result;
}

/// The polygon in the plane across `axis`, or in a slanted plane for axis 3.
std::vector<Vec3d> in_space(const Polygon& polygon, int axis = 2, double scale = 1) {
  std::vector<Vec3d> corners;
  for (const Point& p : polygon) {
    const double x = static_cast<double>(p[0]), y = static_cast<double>(p[1]);
    Vec3d corner{x, y, x - 3 * y};
    if (axis < 3) {
      corner[(axis + 1) % 3] = x;
      corner[(axis + 2) % 3] = y;
      corner[axis] = 7;
    }
    corners.push_back(corner * scale);
  }
  return corners;
}

std::vector<Triangle> fan(std::uint32_t corners) {
  std::vector<Triangle> triangles;
  for (std::uint32_t k = 2; k < corners; ++k) triangles.push_back({0, k - 1, k});
  return triangles;
}

/// Cuts the polygon from several first corners and in both directions, and checks that no point is lost.
void expect_cover(const Polygon& polygon, const std::string& what, std::size_t step = 1) {
  for (std::size_t first = 0; first < polygon.size(); first += step) {
    Polygon turned = polygons::starting_at(polygon, first);
    for (int direction = 0; direction < 2; ++direction) {
      std::reverse(turned.begin(), turned.end());
      const Cut result = cut(in_space(turned));
      if (const std::string fault = fault_of_cover(turned, result.triangles);
          !fault.empty() || result.shape.crosses) {
        std::string text;
        for (const Point& p : turned) text += " (" + std::to_string(p[0]) + ", " + std::to_string(p[1]) + ")";
        ADD_FAILURE() << what << ": " << fault << (result.shape.crosses ? " crosses" : "") << text;
        return;
      }
    }
  }
}

TEST(PolygonCutter, ConvexPolygonsAreFans) {
  EXPECT_EQ(cut(in_space({{0, 0}, {4, 1}, {5, 5}, {-1, 4}})).triangles, fan(4));
  for (std::uint32_t count = 3; count < 40; ++count) {
    Polygon polygon;
    for (std::int64_t k = 0; k < count; ++k) polygon.push_back({k, k * k});
    for (int axis = 0; axis < 4; ++axis) {
      for (const double scale : {1.0, 0x1p-1040, 0x1p1000}) {
        const Cut result = cut(in_space(polygon, axis, scale));
        EXPECT_EQ(result.triangles, fan(count));
        EXPECT_FALSE(result.shape.concave || result.shape.crosses || result.shape.bent);
      }
    }
  }
}

TEST(PolygonCutter, ConvexPolygonsWithCornersOnOneLineAreFans) {
  const Polygon square{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  for (std::size_t first = 0; first < square.size(); ++first) {
    const Polygon turned = polygons::starting_at(square, first);
    EXPECT_EQ(cut(in_space(turned)).triangles, fan(7));
    EXPECT_EQ(fault_of_cover(turned, fan(7)), "");
  }
}

TEST(PolygonCutter, ConcavePolygons) {
  const Polygon shapes[] = {
      {{3, 1}, {3, 0}, {0, 0}, {0, 3}, {1, 3}, {1, 1}},                  // an L
      {{0, 0}, {4, 0}, {1, 1}, {0, 4}},                                  // an arrow head
      {{0, 0}, {6, 0}, {6, 5}, {4, 5}, {4, 2}, {2, 2}, {2, 5}, {0, 5}},  // a U
      {{0, 0},
       {9, 0},
       {9, 9},
       {1, 9},
       {1, 3},
       {6, 3},
       {6, 6},
       {4, 6},
       {4, 5},
       {5, 5},
       {5, 4},
       {2, 4},
       {2, 8},
       {8, 8},
       {8, 1},
       {0, 1}},                                                                          // a spiral
      {{0, 0}, {8, 0}, {8, 8}, {0, 8}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}},  // a bridge to a hole
      {{0, 0}, {2, 0}, {2, 2}, {4, 4}, {6, 4}, {6, 6}, {4, 6}, {4, 4}, {2, 2}, {0, 2}},  // two squares, one
                                                                                         // path
  };
  for (const Polygon& shape : shapes) {
    expect_cover(shape, "shape");
    EXPECT_TRUE(cut(in_space(shape)).shape.concave);
  }
}

TEST(PolygonCutter, TheNotchOfAnLStaysEmpty) {
  const Polygon shape{{-1, 0}, {1, 0}, {1, 2}, {0, 2}, {0, 1}, {-1, 1}};
  for (int axis = 0; axis < 4; ++axis) {
    for (const double scale : {1.0, 0x1p-1040, 0x1p1000, 1e-3}) {
      const Cut result = cut(in_space(shape, axis, scale));
      EXPECT_EQ(fault_of_cover(shape, result.triangles), "");
      EXPECT_TRUE(result.shape.concave);
    }
  }
}

TEST(PolygonCutter, RandomSimplePolygons) {
  RandomNumbers random(1);
  int tried = 0;
  for (int i = 0; i < 400; ++i) {
    const std::uint32_t corners = 4 + random.below(20);
    const std::uint32_t grid = random.below(2) != 0 ? 6 : 1000;
    const Polygon polygon = polygons::random_simple_polygon(random, corners, grid);
    if (polygon.empty()) continue;
    ++tried;
    expect_cover(polygons::sheared(random, polygon), "random " + std::to_string(i), 1 + random.below(4));
    if (HasFailure()) return;
  }
  EXPECT_GT(tried, 200);
}

TEST(PolygonCutter, PolygonsThatTouchThemselves) {
  RandomNumbers random(2);
  for (int i = 0; i < 600; ++i) {
    const Polygon polygon =
        polygons::random_collapsed_polygon(random, random.between(3, 8), random.between(2, 30));
    if (polygons::doubled_area(polygon) == 0) continue;
    expect_cover(polygons::sheared(random, polygon), "collapsed " + std::to_string(i), 1 + random.below(6));
    if (HasFailure()) return;
  }
}

TEST(PolygonCutter, OutlinesThatCrossThemselves) {
  const Polygon shapes[] = {
      {{0, 0}, {2, 2}, {2, 0}, {0, 2}},                                  // a bow tie without area
      {{0, 0}, {4, 4}, {4, 0}, {0, 3}},                                  // a bow tie
      {{0, 9}, {-6, -8}, {9, 3}, {-9, 3}, {6, -8}},                      // a pentagram: it winds twice inside
      {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}, {2, 0}, {2, 2}, {0, 2}},  // a square twice
      {{0, 0}, {2, 2}, {4, 4}, {4, 0}, {2, 2}, {0, 3}},                  // edges cross in a corner of both
      {{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, -1}, {2, 4}, {0, 4}},         // a spike leaves on the other side
      {{0, 0}, {9, 0}, {9, 9}, {2, 9}, {2, 3}, {-3, 3}, {-3, 5}, {4, 5}, {4, 7}, {0, 7}},  // a folded strip
  };
  for (const Polygon& shape : shapes) {
    for (std::size_t first = 0; first < shape.size(); ++first) {
      const Cut result = cut(in_space(polygons::starting_at(shape, first)));
      EXPECT_TRUE(result.shape.crosses) << shape[1][0];
      EXPECT_FALSE(result.shape.concave);
      std::int64_t area = 0;
      for (const Triangle& t : result.triangles) {
        const auto at = [&](std::uint32_t corner) { return shape[(corner + first) % shape.size()]; };
        area += polygons::doubled_area(at(t[0]), at(t[1]), at(t[2]));
      }
      EXPECT_EQ(area, polygons::doubled_area(shape));
    }
  }
}

TEST(PolygonCutter, FindsAllCrossings) {
  RandomNumbers random(3);
  int crossing = 0, simple = 0;
  for (int i = 0; i < 4000 && !HasFailure(); ++i) {
    Polygon polygon;
    const std::uint32_t grid = 2 + random.below(4);
    for (std::uint32_t k = 0, corners = 4 + random.below(4); k < corners; ++k)
      polygon.push_back({random.below(grid), random.below(grid)});
    const bool expected = polygons::crosses_itself(polygon);
    const Cut result = cut(in_space(polygon));
    std::string text;
    for (const Point& p : polygon) text += " (" + std::to_string(p[0]) + ", " + std::to_string(p[1]) + ")";
    EXPECT_EQ(result.shape.crosses, expected) << text;
    if (!expected && polygons::doubled_area(polygon) != 0) {
      EXPECT_EQ(fault_of_cover(polygon, result.triangles), "") << text;
    }
    ++(expected ? crossing : simple);
  }
  EXPECT_GT(crossing, 500);
  EXPECT_GT(simple, 500);
}

TEST(PolygonCutter, PolygonsWithoutArea) {
  const std::vector<std::vector<Vec3d>> shapes = {
      {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}},                        // a point
      {{0, 0, 0}, {1, 2, 3}, {3, 6, 9}, {2, 4, 6}, {-1, -2, -3}},          // a line
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}},                        // a path and back
      {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 0, 0}, {4, 0, 0}, {2, 0, 0}},  // a path with a fork
  };
  for (const std::vector<Vec3d>& corners : shapes) {
    const Cut result = cut(corners);
    EXPECT_FALSE(result.shape.crosses);
    EXPECT_EQ(result.triangles.size(), corners.size() - 2);
    for (const Triangle& t : result.triangles)
      EXPECT_EQ(cross(corners[t[1]] - corners[t[0]], corners[t[2]] - corners[t[0]]), (Vec3d{0, 0, 0}));
  }
}

TEST(PolygonCutter, CornersThatAreNotFinite) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Cut result = cut({{3, 1, 0}, {3, 0, 0}, {0, 0, value}, {0, 3, 0}, {1, 3, 0}, {1, 1, 0}});
    EXPECT_EQ(result.triangles, fan(6));
    EXPECT_FALSE(result.shape.concave || result.shape.crosses || result.shape.bent);
  }
}

TEST(PolygonCutter, NamesWhatIsNotFlat) {
  const auto roof = [](double height) {
    return cut({{0, 0, height}, {10, 0, 0}, {10, 10, height}, {0, 10, 0}}).shape.bent;
  };
  EXPECT_FALSE(roof(0));
  EXPECT_FALSE(roof(0.019));
  EXPECT_TRUE(roof(0.021));
  EXPECT_TRUE(roof(1e100));
  // Nearly flat polygons are cut inside their outline, too.
  RandomNumbers random(4);
  for (int i = 0; i < 100; ++i) {
    const Polygon polygon = polygons::random_simple_polygon(random, 12, 100);
    if (polygon.empty()) continue;
    std::vector<Vec3d> corners = in_space(polygon, 3);
    for (Vec3d& corner : corners) corner = corner + random.vector(1e-3);
    const Cut result = cut(corners);
    EXPECT_FALSE(result.shape.bent || result.shape.crosses);
    EXPECT_EQ(fault_of_cover(polygon, result.triangles), "");
  }
}

TEST(PolygonCutter, HugeTinyAndSlimPolygons) {
  // An L whose legs are 2^-900 wide and 2^900 long, far from the origin of the other axis.
  const double wide = 0x1p-900, far = 0x1p900;
  const std::vector<Vec3d> corners{{far, wide, 5}, {far, 0, 5},    {0, 0, 5},
                                   {0, far, 5},    {wide, far, 5}, {wide, wide, 5}};
  const Polygon shape{{9, 1}, {9, 0}, {0, 0}, {0, 9}, {1, 9}, {1, 1}};
  const Cut result = cut(corners);
  EXPECT_EQ(fault_of_cover(shape, result.triangles), "");
  EXPECT_TRUE(result.shape.concave);
  // Coordinates whose differences overflow.
  constexpr double largest = std::numeric_limits<double>::max();
  const Cut wide_cut = cut({{largest, -largest / 2, 0},
                            {largest, -largest, 0},
                            {-largest, -largest, 0},
                            {-largest, largest, 0},
                            {-largest / 2, largest, 0},
                            {-largest / 2, -largest / 2, 0}});
  EXPECT_EQ(fault_of_cover(shape, wide_cut.triangles), "");
  EXPECT_TRUE(wide_cut.shape.concave);
}

TEST(PolygonCutter, LargePolygonsTakeNearlyLinearTime) {
  // A comb, and a comb of slanted teeth, whose boxes all overlap.
  for (const std::int64_t slant : {0, 1}) {
    constexpr std::int64_t teeth = 20000;
    Polygon polygon{{0, -1}, {3 * teeth, -1}};
    for (std::int64_t i = teeth; i-- > 0;) {
      polygon.push_back({3 * i + 2 + slant * 3 * teeth, 3 * teeth});
      polygon.push_back({3 * i, 0});
    }
    const Cut result = cut(in_space(polygon));
    EXPECT_TRUE(result.shape.concave);
    std::int64_t area = 0;
    for (const Triangle& t : result.triangles) {
      const std::int64_t part = polygons::doubled_area(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
      EXPECT_GE(part, 0);
      area += part;
    }
    EXPECT_EQ(area, polygons::doubled_area(polygon));
  }
}

/// Cuts a large polygon that does not cross itself, and checks the area, and that nothing turns the other
/// way.
void expect_large_cover(const Polygon& polygon, const std::string& what) {
  const Cut result = cut(in_space(polygon));
  EXPECT_FALSE(result.shape.crosses) << what;
  const std::int64_t whole = polygons::doubled_area(polygon);
  std::int64_t area = 0, turned = 0;
  for (const Triangle& t : result.triangles) {
    const std::int64_t part = polygons::doubled_area(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
    turned += (part < 0) != (whole < 0) && part != 0;
    area += part;
  }
  EXPECT_EQ(turned, 0) << what;
  EXPECT_EQ(area, whole) << what;
}

/// Shapes of `count` parts that come back to places and edges again and again.
std::vector<std::pair<std::string, Polygon>> pinched_polygons(std::int64_t count) {
  Polygon petals, beads, holes, slit, teeth, stairs;
  const std::int64_t radius = 16 * count;
  for (std::int64_t i = 0; i < count; ++i) {  // all petals meet in one corner
    petals.push_back({0, 0});
    petals.push_back({radius, 4 * i});
    petals.push_back({radius, 4 * i + 3});
  }
  for (std::int64_t i = 0; i < count; ++i) {  // each bead touches the next one in a corner
    beads.push_back({4 * i, 0});
    beads.push_back({4 * i + 2, -1});
  }
  for (std::int64_t i = count; i > 0; --i) {
    beads.push_back({4 * i, 0});
    beads.push_back({4 * i - 2, 1});
  }
  holes = {{0, 0}};  // a bridge leads from the lower side to each hole
  for (std::int64_t i = 0; i < count; ++i) {
    for (const Point& p : Polygon{{2, 0}, {2, 2}, {1, 4}, {3, 4}, {2, 2}, {2, 0}})
      holes.push_back({4 * i + p[0], p[1]});
  }
  for (const Point& p : Polygon{{4 * count, 0}, {4 * count, 6}, {0, 6}}) holes.push_back(p);
  slit = {{0, -3}, {4 * count + 4, -3}, {4 * count + 4, 3}, {0, 3}, {0, 0}};  // a path to a hole, and back
  for (std::int64_t i = 1; i <= count; ++i) slit.push_back({2 * i, i % 2});
  slit.push_back({2 * count + 1, 2});
  slit.push_back({2 * count + 1, -1});
  for (std::int64_t i = count; i > 0; --i) slit.push_back({2 * i, i % 2});
  slit.push_back({0, 0});
  teeth = {{0, 0}, {4 * count, 0}, {4 * count, 9}};  // teeth stand on the inside of one long edge
  for (std::int64_t i = count; i-- > 0;) {
    teeth.push_back({4 * i + 3, 5});
    teeth.push_back({4 * i + 2, 0});
    teeth.push_back({4 * i + 1, 5});
  }
  teeth.push_back({0, 9});
  for (std::int64_t i = 0; i < count; ++i) {  // corners of each chain touch the edges of the other
    stairs.push_back({4 * i, 4 * (i % 2)});
    stairs.push_back({4 * i + 2, 2});
  }
  stairs.push_back({4 * count, 0});
  stairs.push_back({4 * count, 9});
  for (std::int64_t i = count; i-- > 0;) {
    stairs.push_back({4 * i + 2, 2});
    stairs.push_back({4 * i + 1, 9});
  }
  return {{"petals", petals}, {"beads", beads}, {"holes", holes},
          {"slit", slit},     {"teeth", teeth}, {"stairs", stairs}};
}

TEST(PolygonCutter, PinchedPolygons) {
  for (const std::int64_t count : {1, 2, 3, 5, 8}) {
    for (const auto& [name, polygon] : pinched_polygons(count))
      expect_cover(polygon, name + " " + std::to_string(count));
  }
}

TEST(PolygonCutter, LargePinchedPolygonsTakeNearlyLinearTime) {
  for (const auto& [name, polygon] : pinched_polygons(20000)) expect_large_cover(polygon, name);
}

TEST(PolygonCutter, CrossingsWhereTheLastCornerRepeatsTheFirst) {
  Polygon shape{{1, 0}, {0, 1}, {2, 0}, {0, -1}, {-2, -2}, {0, 2}, {1, 0}};
  for (int repeated = 0; repeated < 3; ++repeated) {
    EXPECT_TRUE(cut(in_space(shape)).shape.crosses);
    shape.insert(shape.begin(), shape.front());
  }
  Polygon convex{{0, 0}, {0, 0}, {4, 1}, {5, 5}, {-1, 4}, {0, 0}, {0, 0}};
  EXPECT_FALSE(cut(in_space(convex)).shape.crosses);
  EXPECT_EQ(fault_of_cover(convex, cut(in_space(convex)).triangles), "");
}

}  // namespace supple::polygon_cutter_test
