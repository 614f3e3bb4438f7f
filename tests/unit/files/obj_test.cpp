#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "files/mesh_formats.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::obj_test {

constexpr double inf = std::numeric_limits<double>::infinity();
const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";  // lines 1 to 4

struct ObjCase {
  const char* what;
  std::string text;
  std::vector<Triangle> triangles;
  std::size_t vertices = 4;
};

const ObjCase obj_cases[] = {
    {"plain", corners + "f 1 2 3\n", {{0, 1, 2}}},
    {"no line end at the end", corners + "f 1 2 3", {{0, 1, 2}}},
    {"texture and normal ids",
     corners + "f 1/5 2/6 3/7\nf 1//9 2//9 3//9\nf 2/1/1 3/2/2 4/3/3\nf 1/ 2// 3\n",
     {{0, 1, 2}, {0, 1, 2}, {1, 2, 3}, {0, 1, 2}}},
    {"tabs", "v\t0\t0\t0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf\t1/1\t2/2\t3/3\t\n", {{0, 1, 2}}},
    {"leading and trailing blanks", corners + "  f  1   2 3  \n \t \n", {{0, 1, 2}}},
    {"CR LF", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nv 0 0 1\r\nf 1 2 3\r\n", {{0, 1, 2}}},
    {"CR alone", "v 0 0 0\rv 1 0 0\rv 0 1 0\rv 0 0 1\rf 1 2 3\r", {{0, 1, 2}}},
    {"byte order mark", "\xEF\xBB\xBF" + corners + "f 1 2 3\n", {{0, 1, 2}}},
    {"comments", "# v 9 9 9\n" + corners + "f 1 2 3 # 4\nf 2 3 4#5\n#\n", {{0, 1, 2}, {1, 2, 3}}},
    {"a comment's backslash joins nothing", corners + "# C:\\dir\\\nf 1 2 3\n", {{0, 1, 2}}},
    {"capitals",
     "V 0 0 0\nV 1 0 0\nv 0 1 0\nV 0 0 1\nVT 0 0\nF 1/1 2/1 3/1\nf 2 3 4\n",
     {{0, 1, 2}, {1, 2, 3}}},
    {"continued lines", corners + "f 1 \\\n 2 \\\r\n3\\\n\nv 1 \\\n2 3\n", {{0, 1, 2}}, 5},
    {"a continued keyword that is ignored", corners + "curv 1 2 \\\n3 4\nf 1 2 3\n", {{0, 1, 2}}},
    {"other statements",
     "mtllib a.mtl\no thing\ng a b\n" + corners +
         "vn 0 0 1\nvt 0 0\nvp 1\ns off\nusemtl x\nl 1 2\np 1\nfoo bar\ncurv 0 1 2\nend\nf 1 2 3\nVX 1 2\n",
     {{0, 1, 2}}},
    {"convex polygons become fans",
     "f 5 1 2 3\nv 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n",
     {{4, 0, 1}, {4, 1, 2}, {0, 1, 2}, {0, 2, 3}, {0, 3, 4}},
     5},
    {"concave polygons stay inside their outline",
     "v 3 1 0\nv 3 0 0\nv 0 0 0\nv 0 3 0\nf 1 2 3 4 5 6\nv 1 3 0\nv 1 1 0\nf 1 2 3\n",
     {{5, 0, 1}, {5, 1, 2}, {5, 2, 3}, {5, 3, 4}, {0, 1, 2}},
     6},
    {"relative ids count from where they stand",
     corners + "f -4 -3 -1\nv 1 1 1\nf -1 -5 2\n",
     {{0, 1, 3}, {4, 0, 1}},
     5},
    {"later vertices", "f 1 2 4\n" + corners, {{0, 1, 3}}},
    {"repeated ids stay", corners + "f 1 1 2\nf 3 3 3\n", {{0, 0, 1}, {2, 2, 2}}},
    {"signs", corners + "f +1 +2 +3\nv +1 -2 +.5\n", {{0, 1, 2}}, 5},
    {"weights and colours", "v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 1 .1 .2 .3\nf 1 2 3\n", {{0, 1, 2}}, 3},
    {"zero bytes at the end", corners + "f 1 2 3\n" + std::string(3, '\0'), {{0, 1, 2}}},
    {"end-of-file characters and blanks at the end", corners + "f 1 2 3\x1a \r\n\x1a\n", {{0, 1, 2}}},
    {"the older name of faces", corners + "fo 1 2 3\n", {{0, 1, 2}}},
    {"no faces", corners, {}},
    {"nothing", "", {}, 0},
    {"only blanks", "\n \n\t\r\n", {}, 0},
};

TEST(Obj, ReadsWhatIsAllowed) {
  for (const ObjCase& c : obj_cases) {
    SCOPED_TRACE(c.what);
    TriangleMesh mesh;
    EXPECT_EQ(error_of([&] { mesh = read_obj(c.text, "a.obj"); }), "");
    EXPECT_EQ(mesh.triangles, c.triangles);
    EXPECT_EQ(mesh.positions.size(), c.vertices);
  }
}

TEST(Obj, KeepsCoordinatesAsTheyAre) {
  const TriangleMesh mesh = read_obj(
      "v 0.1 1e400 -1e400\nv nan inf -INF\nv 1e-400 -1e-400 5e-324\nv -0 +1.5 2.5e1 9\nv 1 2 3 4 5 6 7\n",
      "a.obj");
  ASSERT_EQ(mesh.positions.size(), 5u);
  EXPECT_TRUE(same_bits(mesh.positions[0], {0.1, inf, -inf}));
  EXPECT_TRUE(std::isnan(mesh.positions[1].x));
  EXPECT_EQ(mesh.positions[1].y, inf);
  EXPECT_EQ(mesh.positions[1].z, -inf);
  EXPECT_TRUE(same_bits(mesh.positions[2], {0.0, -0.0, 5e-324}));
  EXPECT_TRUE(same_bits(mesh.positions[3], {-0.0, 1.5, 25}));
  EXPECT_TRUE(same_bits(mesh.positions[4], {1, 2, 3}));
}

TEST(Obj, ReadsLinesAndPoints) {
  const TriangleMesh mesh = read_obj(
      "l 1/7 2 \\\n4/1\np 3\n" + corners + "l -1 -4\nf 1 2 3\nl 1 2 3 1 # closed\np 1//2 -1\n", "a.obj");
  EXPECT_EQ(read_obj(corners + "f 1 2\nf -1 2\nf 4\n", "a.obj").edges.size(), 2u);
  using Edges = std::vector<std::array<std::uint32_t, 2>>;
  EXPECT_EQ(mesh.edges, (Edges{{0, 1}, {1, 3}, {3, 0}, {0, 1}, {1, 2}, {2, 0}}));
  EXPECT_EQ(mesh.points, (std::vector<std::uint32_t>{2, 0, 3}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  const TriangleMesh again = read_obj(write_obj(mesh), "b.obj");
  EXPECT_EQ(again.edges, mesh.edges);
  EXPECT_EQ(again.points, mesh.points);
}

struct ErrorCase {
  std::string text;
  const char* message;
};

const ErrorCase obj_errors[] = {
    {corners + "f 0 1 2\n", "a.obj:5: face index 0 is not allowed; OBJ counts vertices from 1"},
    {corners + "\nf 1 2 5\n",
     "a.obj:6: face index 5 is out of range; the file has 4 vertices, counted from 1"},
    {"f 1 2 9\nf 1 2 5\n" + corners,
     "a.obj:1: face index 9 is out of range; the file has 4 vertices, counted from 1"},
    {"f 1 2 3\nf 1 2 5\nf 1 2 9\n" + corners,
     "a.obj:2: face index 5 is out of range; the file has 4 vertices, counted from 1"},
    {corners + "f 1 2 4294967297\n",
     "a.obj:5: face index 4294967297 is out of range; the file has 4 vertices, counted from 1"},
    {corners + "f 1 2 99999999999999999999\n",
     "a.obj:5: expected an integer for a face index, found '99999999999999999999'"},
    {"v 0 0 0\nv 1 0 0\nf -1 -2 -3\n" + corners,
     "a.obj:3: face index -3 is out of range; the file has 2 vertices before it"},
    {corners + "f 2 2\n",
     "a.obj:5: a line joins vertex 2 to itself; leave out the repetition, or write a point: p 2"},
    {corners + "f\n", "a.obj:5: a face has no corners; it needs at least 1"},
    {corners + "f 1 2 x\n", "a.obj:5: expected an integer for a face index, found 'x'"},
    {corners + "f 1 2 3.5\n", "a.obj:5: expected an integer for a face index, found '3.5'"},
    {corners + "f 1 2 /3\n", "a.obj:5: expected an integer for a face index, found '/3'"},
    {corners + "f 1 2 \\\n\\\nx\n", "a.obj:7: expected an integer for a face index, found 'x'"},
    {corners + "l 1\n", "a.obj:5: a line has 1 vertex; it needs at least 2"},
    {corners + "l\n", "a.obj:5: a line has 0 vertices; it needs at least 2"},
    {corners + "l 1 2 2 3\n",
     "a.obj:5: a line joins vertex 2 to itself; leave out the repetition, or write a point: p 2"},
    {corners + "l 0 1\n", "a.obj:5: line index 0 is not allowed; OBJ counts vertices from 1"},
    {corners + "l 1 5\n", "a.obj:5: line index 5 is out of range; the file has 4 vertices, counted from 1"},
    {"p 7\nf 1 2 5\n" + corners,
     "a.obj:1: point index 7 is out of range; the file has 4 vertices, counted from 1"},
    {corners + "p\n", "a.obj:5: a point has no vertex; it needs at least 1"},
    {corners + "p 1 x\n", "a.obj:5: expected an integer for a point index, found 'x'"},
    {corners + "p -5\n", "a.obj:5: point index -5 is out of range; the file has 4 vertices before it"},
    {"v 0 0\n", "a.obj:1: expected a number for z, found the end of the line"},
    {"v 0", "a.obj:1: expected a number for y, found the end of the file"},
    {"v 0 # 1 2\n", "a.obj:1: expected a number for y, found the end of the line"},
    {"\r\n\r\nv 0 abc 0\r\n", "a.obj:3: expected a number for y, found 'abc'"},
    {"v 0 1,5 0\n", "a.obj:1: expected a number for y, found '1,5'"},
    {"v 0 1.5e 0\n", "a.obj:1: expected a number for y, found '1.5e'"},
    {"v 0 0x10 0\n", "a.obj:1: expected a number for y, found '0x10'"},
    {"v \x01" + std::string(60, 'a') + " 0 0\n",
     "a.obj:1: expected a number for x, found '?aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa...'"},
    {std::string("\xFF\xFEv\0 \0\x31\0\n\0", 10),
     "a.obj:1: the text is UTF-16; save the file as UTF-8 or ASCII"},
    {std::string("v 0 0 0\n\0v 1 0 0\n", 17), "a.obj:2: a zero byte; OBJ files are plain text"},
};

TEST(Obj, SaysWhatIsWrongAndWhere) {
  for (const ErrorCase& c : obj_errors) {
    EXPECT_EQ(error_of([&] { read_obj(c.text, "a.obj"); }), c.message) << c.text;
  }
}

}  // namespace supple::obj_test
