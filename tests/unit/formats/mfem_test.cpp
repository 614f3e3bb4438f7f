#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "supple/formats.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::mfem_test {

const std::string start = "MFEM mesh v1.0\n\n# comment\n\ndimension\n3\n\n";
const std::string tetrahedron = "elements\n1\n1 4 0 1 2 3\n\nboundary\n2\n1 2 0 1 2\n7 2 0 1 3\n\n";
const std::string vertices = "vertices\n4\n3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";

TEST(Mfem, SolidsWithTheirBoundary) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = load_any_mesh(folder.write("a.mesh", start + tetrahedron + vertices));
  EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  // The polygons come first, turned outwards.
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}));
}

TEST(Mfem, EveryElement) {
  const TemporaryFolder folder;
  const auto triangles = [&](const std::string& element, int points) {
    std::string text =
        start + "elements\n1\n" + element + "\nboundary\n0\n\nvertices\n" + std::to_string(points) + "\n3\n";
    for (int i = 0; i < points; ++i)
      text += std::to_string(i % 3) + " " + std::to_string(i * i % 5) + " " + std::to_string(i / 4) + "\n";
    return load_any_mesh(folder.write("a.mesh", text)).triangles.size();
  };
  EXPECT_EQ(triangles("1 0 0", 1), 0u);
  EXPECT_EQ(triangles("1 1 0 1", 2), 0u);
  EXPECT_EQ(triangles("1 2 0 1 2", 3), 1u);
  EXPECT_EQ(triangles("1 3 0 1 2 3", 4), 2u);
  EXPECT_EQ(triangles("1 4 0 1 2 3", 4), 4u);
  EXPECT_EQ(triangles("1 5 0 1 2 3 4 5 6 7", 8), 12u);
  EXPECT_EQ(triangles("1 6 0 1 2 3 4 5", 6), 8u);
  EXPECT_EQ(triangles("1 7 0 1 2 3 4", 5), 6u);
}

TEST(Mfem, CurvedMeshesHaveTheirVerticesFirst) {
  const TemporaryFolder folder;
  const std::string space = "nodes\nFiniteElementSpace\nFiniteElementCollection: ";
  const std::string by_nodes = "\nVDim: 3\nOrdering: 0\n\n0 1 0 0 .5\n0 0 1 0 .5\n0 0 0 1 .5\n";
  const std::string by_dimension = "\nVDim: 3\nOrdering: 1\n\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n.5 .5 .5\n";
  for (const std::string& nodes : {"H1_3D_P2" + by_nodes, "Quadratic" + by_dimension}) {
    const TriangleMesh mesh =
        load_any_mesh(folder.write("a.mesh", start + tetrahedron + "vertices\n4\n\n" + space + nodes));
    EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(mesh.triangles.size(), 4u);
  }
  const std::string path =
      folder.write("a.mesh", start + tetrahedron + "vertices\n4\n\n" + space + "L2_T1_3D_P1" + by_nodes);
  EXPECT_NE(error_of([&] { load_any_mesh(path); }).find("of the space 'L2_T1_3D_P1', which has no vertices"),
            std::string::npos);
}

TEST(Mfem, LaterVersionsAndPlanes) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = load_any_mesh(folder.write(
      "a.mesh",
      "MFEM mesh v1.3\n\ndimension\n2\n\nelements\n1\n1 3 0 1 2 3\n\nattribute_sets\n1\n\"Base\" 1 1\n\n"
      "boundary\n1\n1 1 0 1\n\nvertices\n4\n2\n0 0\n1 0\n1 1\n0 1\n\nmfem_mesh_end\n"));
  EXPECT_EQ(mesh.positions[2], (Vec3d{1, 1, 0}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Mfem, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& text, const char* part) {
    const std::string path = folder.write("a.mesh", text);
    const std::string message = error_of([&] { load_any_mesh(path); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find(path), std::string::npos) << message;
  };
  expect("MFEM NURBS mesh v1.0\n", "only meshes that begin with 'MFEM mesh v1.' are supported");
  expect("MFEM INLINE mesh v1.0\n", "not NURBS, INLINE or NC meshes");
  expect(start + tetrahedron, "the file has no coordinates of its vertices");
  expect(start + "elements\n1\n1 8 0 1 2 3\n", "element 0 is of type 8; the types are 0 to 7");
  expect(start + "elements\n1\n1 4 0 1 2 9\n" + vertices,
         "vertex 9 of an element is out of range; the file has 4");
  expect(start + "elements\n99999999999\n", "more than the rest of the file can hold");
  expect(start + tetrahedron + "vertices\n4\n5\n0 0 0\n", "the vertices have 5 coordinates");
  expect(start + tetrahedron + "vertices\n4\n3\n0 0 0\n1", "the file");
}

}  // namespace supple::mfem_test
