#include "elements/element_mesh.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "unit/files/mesh_files.hpp"

namespace supple::element_mesh_test {

using Triangles = std::vector<Triangle>;

/// Two tetrahedra with the face 0 1 2 in common, apexes 3 (above) and 4 (below).
ElementMesh two_tetrahedra() {
  ElementMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.add_solid(Solid::tetrahedron, std::array{0u, 1u, 2u, 3u});
  mesh.add_solid(Solid::tetrahedron, std::array{0u, 1u, 2u, 4u});  // inside out
  return mesh;
}

TEST(ElementMesh, FacesOfOneSolidInTheOrderOfSolidsAndFaces) {
  const TriangleMesh mesh = two_tetrahedra().take_surface("file");
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 4, 1}, {1, 4, 2}, {2, 4, 0}}));
  EXPECT_EQ(mesh.positions.size(), 5u);
}

TEST(ElementMesh, PolygonsAloneStayAsTheyAre) {
  ElementMesh elements;
  elements.positions.resize(6);
  elements.add_polygon(std::array{3u, 1u, 2u});
  elements.add_polygon(std::array{1u, 2u});  // a line
  elements.add_polygon(std::array{1u, 3u, 2u});
  elements.add_polygon(std::array{5u, 5u, 2u});
  EXPECT_EQ(elements.take_surface("file").triangles, (Triangles{{3, 1, 2}, {1, 3, 2}, {5, 5, 2}}));
}

TEST(ElementMesh, PolygonsOnTheBoundaryComeFirstAndFaceOutwards) {
  ElementMesh elements = two_tetrahedra();
  elements.add_polygon(std::array{3u, 2u, 1u});  // inwards
  elements.add_polygon(std::array{0u, 1u, 2u});  // between the solids
  elements.add_polygon(std::array{0u, 4u, 1u});  // outwards
  elements.add_polygon(std::array{4u, 1u, 0u});  // the same face again
  elements.add_polygon(std::array{3u, 4u, 1u});  // a shell
  EXPECT_EQ(elements.take_surface("file").triangles,
            (Triangles{{3, 1, 2}, {0, 4, 1}, {3, 4, 1}, {0, 1, 3}, {2, 0, 3}, {1, 4, 2}, {2, 4, 0}}));
}

TEST(ElementMesh, CollapsedSolidsHaveTheFacesThatAreLeft) {
  // A hexahedron whose corners 2 and 3, and 6 and 7, are the same is a prism.
  ElementMesh elements;
  elements.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  elements.add_solid(Solid::hexahedron, std::array{0u, 1u, 2u, 2u, 3u, 4u, 5u, 5u});
  EXPECT_EQ(
      elements.take_surface("file").triangles,
      (Triangles{{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}}));
}

TEST(ElementMesh, FlatAndInfiniteSolidsStayAsNumbered) {
  for (const double z :
       {0.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    ElementMesh elements;
    elements.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, z}};
    elements.add_solid(Solid::tetrahedron, std::array{0u, 2u, 1u, 3u});
    EXPECT_EQ(elements.take_surface("file").triangles,
              (Triangles{{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {1, 0, 3}}))
        << z;
  }
}

// The sign of the volume is 1 bit in 1e-16 of its terms.
TEST(ElementMesh, OutwardsIsExact) {
  for (const double height : {0x1p-52, -0x1p-52}) {
    ElementMesh elements;
    elements.positions = {{1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1.25, 1.25, 1 + height}};
    elements.add_solid(Solid::tetrahedron, std::array{0u, 1u, 2u, 3u});
    const Triangle first = height > 0 ? Triangle{0, 2, 1} : Triangle{0, 1, 2};
    EXPECT_EQ(elements.take_surface("file").triangles[0], first);
  }
}

}  // namespace supple::element_mesh_test
