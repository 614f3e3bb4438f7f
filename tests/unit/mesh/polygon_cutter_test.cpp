#include "mesh/polygon_cutter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/polygons.hpp"
#include "support/random.hpp"

namespace supple {
namespace {

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
  result.shape = PolygonCutter().cut(corners, result.triangles);
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

}  // namespace
}  // namespace supple
