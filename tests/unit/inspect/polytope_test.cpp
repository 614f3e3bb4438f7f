#include "inspect/polytope.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace supple::polytope_test {

TEST(Polytope, EdgesAndSurfaceOfKnownShapes) {
  std::vector<Slab> cube{{{1, 0, 0}, -1, 1}, {{0, 1, 0}, -1, 1}, {{0, 0, 1}, -1, 1}};
  EXPECT_EQ(Polytope(cube).edges().size(), 12u);
  EXPECT_DOUBLE_EQ(Polytope(cube).surface(), 24);
  // The diagonals cut the cube down to the octahedron |x| + |y| + |z| <= 1.
  for (const Vec3f& direction : {Vec3f{1, 1, 1}, Vec3f{1, 1, -1}, Vec3f{1, -1, 1}, Vec3f{1, -1, -1}})
    cube.push_back({direction, -1, 1});
  EXPECT_EQ(Polytope(cube).edges().size(), 12u);
  EXPECT_NEAR(Polytope(cube).surface(), 4 * std::sqrt(3.0), 1e-12);
  // A cube without its corners: 8 triangles and 6 octagons.
  for (std::size_t i = 3; i < cube.size(); ++i) cube[i].low = -2, cube[i].high = 2;
  EXPECT_EQ(Polytope(cube).edges().size(), 24u);
}

}  // namespace supple::polytope_test
