// Variants of files with solids that real programs write, and what is said about broken ones.

#include <gtest/gtest.h>

#include <string>

#include "readers.hpp"
#include "supple/formats.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::volume_errors_test {

using Triangles = std::vector<Triangle>;

const std::string gmsh_nodes =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n9 0 0 1\n$EndNodes\n";

std::string gmsh(const std::string& elements) {
  return gmsh_nodes + "$Elements\n" + elements + "$EndElements\n";
}

std::string error_of_gmsh(const std::string& bytes) {
  return error_of([&] { read_gmsh(bytes, "a.msh"); });
}

TEST(Gmsh, SecondOrderElementsHaveTheirCorners) {
  const std::string nodes =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 10 1 10\n3 1 0 10\n1\n2\n3\n4\n5\n6\n7\n8\n9\n10\n"
      "0 0 0\n2 0 0\n0 2 0\n0 0 2\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n0 1 1\n1 0 1\n$EndNodes\n";
  const TriangleMesh mesh =
      read_gmsh(nodes + "$Elements\n1 1 1 1\n3 1 11 1\n1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n", "a.msh");
  EXPECT_EQ(mesh.positions.size(), 10u);
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}));
  EXPECT_EQ(
      read_gmsh(nodes + "$Elements\n1 1 1 1\n2 1 9 1\n1 1 2 3 5 6 7\n$EndElements\n", "a.msh").triangles,
      (Triangles{{0, 1, 2}}));
}

TEST(Gmsh, SaysWhatIsWrong) {
  EXPECT_EQ(read_gmsh(gmsh("1\n1 2 2 0 0 1 2 9\n"), "a.msh").triangles, (Triangles{{0, 1, 3}}));
  EXPECT_EQ(error_of_gmsh(gmsh("1\n1 2 2 0 0 1 2 4\n")),
            "a.msh:13: an element uses node 4, which the file does not have");
  EXPECT_EQ(
      error_of_gmsh(gmsh("1\n1 35 2 0 0 1 2 4\n")),
      "a.msh:13: elements of type 35 are not supported; in Gmsh, save the mesh with elements of order 1");
  EXPECT_EQ(error_of_gmsh(gmsh("2\n1 2 2 0 0 1 2 3\n")),
            "a.msh:14: expected an integer for the number of an element, found '$EndElements'");
  EXPECT_EQ(error_of_gmsh(gmsh("0\n1 2 2 0 0 1 2 3\n")), "a.msh:13: expected '$EndElements', found '1'");
  EXPECT_EQ(error_of_gmsh(gmsh_nodes), "a.msh:11: the file ends before the elements ($Elements)");
  EXPECT_EQ(error_of_gmsh("$MeshFormat\n3.0 0 8\n"),
            "a.msh:2: this version of Gmsh's format is not supported; in Gmsh, save the mesh as version 4.1 "
            "or 2.2");
  EXPECT_EQ(
      error_of_gmsh("solid a\n"),
      "a.msh:1: expected '$MeshFormat' or '$NOD', with which a .msh file of Gmsh begins, found 'solid'");
  EXPECT_EQ(error_of_gmsh("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n99999999999\n1 0 0 0\n"),
            "a.msh:5: announces 99999999999 of nodes, more than the rest of the file can hold");
  EXPECT_EQ(error_of_gmsh("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n1 0 0 1\n$EndNodes\n"),
            "a.msh:7: two nodes have the number 1");
  EXPECT_EQ(error_of_gmsh("$MeshFormat\n2.2 1 8\n\1\0"),
            "a.msh, byte 20: the file ends before the number 1, which tells the byte order");
}

std::string vtk(const std::string& rest) {
  return "# vtk DataFile Version 2.0\ntitle\nASCII\nDATASET POLYDATA\nPOINTS 5 float\n0 0 0 1 0 0\n0 1 0 1 1 "
         "0 2 2 0\n" +
         rest;
}

TEST(Vtk, PolygonsStripsAndCellsOfPixels) {
  EXPECT_EQ(
      read_vtk(vtk("VERTICES 1 2\n1 0\nLINES 1 3 2 0 1\nPOLYGONS 2 8\n3 0 1 2\n3 1 3 2\n"), "a").triangles,
      (Triangles{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_EQ(read_vtk(vtk("Triangle_strips 1 6\n5 0 1 2 3 4\nPOINT_DATA 5\n"), "a").triangles,
            (Triangles{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
  EXPECT_EQ(read_vtk(vtk("CELLS 2 9\n4 0 1 2 3\n3 1 4 3\nCELL_TYPES 2\n8 5\n"), "a").triangles,
            (Triangles{{0, 1, 3}, {0, 3, 2}, {1, 4, 3}}));
}

TEST(Vtk, SaysWhatIsWrong) {
  const auto error = [](const std::string& bytes) { return error_of([&] { read_vtk(bytes, "a.vtk"); }); };
  EXPECT_EQ(error(vtk("CELLS 1 5\n4 0 1 2 3\n")),
            "a.vtk:10: the file ends before the types of its cells (CELL_TYPES)");
  EXPECT_EQ(error(vtk("CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n42\n")),
            "a.vtk:11: cell 0 is of type 42, which is not supported; save the mesh with simple cells such as "
            "tetrahedra (type 10) or hexahedra (type 12)");
  EXPECT_EQ(error(vtk("CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n12\n")),
            "a.vtk:11: cell 0 has 4 points; its type needs 8");
  EXPECT_EQ(error(vtk("POLYGONS 1 4\n3 0 1 5\n")),
            "a.vtk:9: point 5 of a cell is out of range; the file has 5 points before it, counted from 0");
  EXPECT_EQ(
      error("# vtk DataFile Version 2.0\n\nASCII\nDATASET STRUCTURED_POINTS\n"),
      "a.vtk:4: a data set of type 'structured_points' has no surface; save its surface as POLYDATA (in "
      "ParaView: Extract Surface)");
  EXPECT_EQ(error(vtk("POLYGONS 3 2\nOFFSETS int\n0 1 3\n")),
            "a.vtk:10: offset 3 is out of range; the offsets go up from 0 to at most 2");
  EXPECT_EQ(error("# vtk DataFile Version 2.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 3 float\n1234567"),
            "a.vtk, byte 0: announces 3 of points, more than the rest of the file can hold");
}

TEST(Medit, TrianglesAndTetrahedra) {
  const TriangleMesh mesh = read_medit(
      "MeshVersionFormatted 1\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\nTriangles 4\n1 3 "
      "2 0\n1 2 4 0\n"
      "2 3 4 0\n3 1 4 0\nTetrahedra 1\n1 2 3 4 0\nEnd\n",
      "a.mesh");
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}));
  EXPECT_EQ(
      read_medit("MeshVersionFormatted 1 Dimension 2 Vertices 3 0 0 1 1 0 1 0 1 1 Triangles 1 1 2 3 0 End",
                 "a")
          .positions,
      (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(Medit, SaysWhatIsWrong) {
  const auto error = [](const std::string& rest) {
    return error_of([&] { read_medit("MeshVersionFormatted 1\nDimension 3\n" + rest, "a.mesh"); });
  };
  EXPECT_EQ(error("Vertices 1\n0 0 0 0\nTriangles 1\n1 1 2 0\n"),
            "a.mesh:6: 'Triangles': vertex 2 is out of range; the file has 1 vertices, counted from 1");
  EXPECT_EQ(error("Vertices 9\n0 0 0 0\n"),
            "a.mesh:3: announces 9 of vertices, more than the rest of the file can hold");
  EXPECT_EQ(error("Triangles 1\n1 1 2 0\n"), "a.mesh:3: 'Triangles' come before the vertices");
  EXPECT_EQ(error_of([] { read_medit("v 0 0 0\n", "a.mesh"); }),
            "a.mesh:1: expected 'MeshVersionFormatted', with which a .mesh file of Medit begins, found 'v'");
}

TEST(Vtk, TextMayEndWithPadding) {
  const std::string bytes = vtk("POLYGONS 1 4\n3 0 1 2\n") + std::string("\x1a\0\0\0", 4);
  EXPECT_EQ(read_vtk(bytes, "a").triangles, (Triangles{{0, 1, 2}}));
}

TEST(Tetgen, EachFileLeadsToTheOthers) {
  const TemporaryFolder folder;
  folder.write("a.1.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n");
  EXPECT_TRUE(error_of([&] { load_any_mesh(folder / "a.1.node"); }).ends_with("add one of them"));
  folder.write("a.1.face", "1 1\n1 2 1 4 -1\n");
  EXPECT_EQ(load_any_mesh(folder / "a.1.face").triangles, (Triangles{{1, 0, 3}}));
  folder.write("a.1.ele", "1 4 0\n1 1 2 3 4\n");
  for (const char* name : {"a.1.node", "a.1.ele", "a.1.face"}) {
    const TriangleMesh mesh = load_any_mesh(folder / name);
    EXPECT_EQ(mesh.name, "a.1");
    EXPECT_EQ(mesh.triangles, (Triangles{{1, 3, 0}, {0, 2, 1}, {1, 2, 3}, {2, 0, 3}}));
  }
  folder.write("a.1.ele", "1 4 0\n1 1 2 3 5\n");
  const std::string ele = folder / "a.1.ele";
  EXPECT_EQ(error_of([&] { load_any_mesh(ele); }),
            ele + ":2: an element uses point 5, which the .node file does not have");
  std::filesystem::remove(folder / "a.1.node");
  EXPECT_TRUE(error_of([&] { load_any_mesh(ele); }).find("a.1.node: No such file") != std::string::npos);
}

TEST(Tetgen, TrianglesOfTwoDimensions) {
  const TriangleMesh mesh =
      read_tetgen({"3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n", "a.node"}, {"1 3 0\n0 0 1 2\n", "a.ele"}, {});
  EXPECT_EQ(mesh.positions[2], (Vec3d{0, 1, 0}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
}

}  // namespace supple::volume_errors_test
