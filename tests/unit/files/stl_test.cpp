#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "files/byte_order.hpp"
#include "files/mesh_formats.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::stl_test {

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "  facet normal 0 0 1\n    outer loop\n      vertex " + a + "\n      vertex " + b +
         "\n      vertex " + c + "\n    endloop\n  endfacet\n";
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

const std::string two_facets = facet("0 0 0", "1 0 0", "0 1 0") + facet("1 0 0", "1 1 0", "0 1 0");
const std::vector<Triangle> two_triangles = {{0, 1, 2}, {1, 3, 2}};

struct BinaryFacet {
  float normal[3];
  float points[3][3];
};

std::string binary(const std::string& title, std::uint32_t count, const std::vector<BinaryFacet>& facets) {
  std::string bytes = title;
  bytes.resize(80, ' ');
  append_scalar(bytes, count);
  for (const BinaryFacet& f : facets) {
    for (const float value : f.normal) append_scalar(bytes, value);
    for (const auto& point : f.points) {
      for (const float value : point) append_scalar(bytes, value);
    }
    append_scalar(bytes, std::uint16_t{7});
  }
  return bytes;
}

const BinaryFacet one{{0, 0, 1}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
const BinaryFacet other{{0, 0, 1}, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};

struct StlCase {
  const char* what;
  std::string text;
  std::vector<Triangle> triangles;
  std::size_t vertices = 4;
};

const StlCase stl_cases[] = {
    {"text", "solid a name\n" + two_facets + "endsolid a name\n", two_triangles},
    {"no name, no line end", "solid\n" + two_facets + "endsolid", two_triangles},
    {"upper case", upper_case("solid a\n" + two_facets + "endsolid a\n"), two_triangles},
    {"several solids",
     "solid a\n" + facet("0 0 0", "1 0 0", "0 1 0") + "endsolid a\n\nsolid b\n" +
         facet("1 0 0", "1 1 0", "0 1 0") + "endsolid b\n",
     two_triangles},
    {"the end in two words", "solid a\n" + two_facets + "end solid a\nsolid b\nEnd Solid", two_triangles},
    {"all ends in two words",
     "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nend loop\nend "
     "facet\nend "
     "solid\n",
     {{0, 1, 2}},
     3},
    {"a facet of four corners",
     "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 1 0\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n"
     "endloop\nendfacet\nendsolid\n",
     {{0, 1, 2}, {0, 2, 3}}},
    {"a facet of five corners, not convex",
     "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 4 0 0\nvertex 4 4 0\nvertex 3 1 0\n"
     "vertex 0 1 0\nendloop\nendfacet\nendsolid\n",
     {{4, 0, 1}, {1, 2, 3}, {3, 4, 1}},
     5},
    {"zero bytes at the end", "solid a\n" + two_facets + "endsolid a\n" + std::string(9, '\0'),
     two_triangles},
    {"an empty solid", "solid a\nendsolid a\n", {}, 0},
    {"normals that are no numbers",
     "solid\nfacet normal 1.#QNAN nan -nan(ind)\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
     "0\nendloop\n"
     "endfacet\nendsolid\n",
     {{0, 1, 2}},
     3},
    {"binary", binary("made by hand", 2, {one, other}), two_triangles},
    {"binary that begins as text does", binary("solid thing\nfacet", 2, {one, other}), two_triangles},
    {"binary of no facets", binary("solid", 0, {}), {}, 0},
    {"binary with padding", binary("made by hand", 2, {one, other}) + "padding", two_triangles},
    {"zero-area facet", "solid\n" + facet("0 0 0", "0 0 0", "-0 0 -0") + "endsolid\n", {{0, 0, 0}}, 1},
};

TEST(Stl, ReadsWhatIsAllowed) {
  for (const StlCase& c : stl_cases) {
    SCOPED_TRACE(c.what);
    TriangleMesh mesh;
    EXPECT_EQ(error_of([&] { mesh = read_stl(c.text, "a.stl"); }), "");
    EXPECT_EQ(mesh.triangles, c.triangles);
    EXPECT_EQ(mesh.positions.size(), c.vertices);
    if (c.vertices == 4) {
      EXPECT_EQ(mesh.positions[3], (Vec3d{1, 1, 0}));
    }
  }
}

TEST(Stl, CornersWithNanAreNeverJoined) {
  const TriangleMesh mesh =
      read_stl("solid\n" + facet("nan 0 0", "nan 0 0", "1 0 0") + facet("nan 0 0", "1 0 0", "inf 0 0") +
                   facet("inf 0 0", "-inf 0 0", "1 0 0") + "endsolid\n",
               "a.stl");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 2, 4}, {4, 5, 2}}));
  EXPECT_TRUE(std::isnan(mesh.positions[3].x));
}

TEST(Stl, JoinsManyCornersByFirstUse) {
  std::string text = "solid\n";
  constexpr int size = 40;
  const auto point = [](int i) { return std::to_string(i % size) + " " + std::to_string(i / size) + " 0"; };
  for (int i = 0; i < size * size; ++i) text += facet(point(i), point(i * 7 % (i + 1)), point(i / 2));
  const TriangleMesh mesh = read_stl(text + "endsolid\n", "a.stl");
  ASSERT_EQ(mesh.positions.size(), static_cast<std::size_t>(size * size));
  for (int i = 0; i < size * size; ++i) {
    const auto id = static_cast<std::uint32_t>(i);
    EXPECT_EQ(mesh.positions[id], (Vec3d{double(i % size), double(i / size), 0}));
    EXPECT_EQ(mesh.triangles[id], (Triangle{id, id * 7 % (id + 1), id / 2}));
  }
}

TEST(Stl, TextIsReadAsDouble) {
  const TriangleMesh mesh =
      read_stl("solid\n" + facet("0.1 0 0", "1e400 0 0", "0 1 0") + "endsolid\n", "a.stl");
  EXPECT_EQ(mesh.positions[0].x, 0.1);
  EXPECT_EQ(mesh.positions[1].x, std::numeric_limits<double>::infinity());
}

struct ErrorCase {
  std::string text;
  const char* message;
};

const ErrorCase stl_errors[] = {
    {"",
     "a.stl: not an STL file: neither text that starts with 'solid' nor the 84 bytes that a binary one has "
     "at "
     "least"},
    {"hello",
     "a.stl: not an STL file: neither text that starts with 'solid' nor the 84 bytes that a binary one has "
     "at least"},
    {binary("x", 2, {one}),
     "a.stl: truncated, or no STL file: the header announces 2 facets, which need 184 bytes; the file has "
     "134"},
    {binary("solid", 2, {one}),
     "a.stl: truncated, or no STL file: the header announces 2 facets, which need 184 bytes; the file has "
     "134"},
    {binary("x", 0xffffffff, {one}),
     "a.stl: truncated, or no STL file: the header announces 4294967295 facets, which need 214748364834 "
     "bytes; the file has "
     "134"},
    {"solid a\n", "a.stl:2: expected 'facet' or 'endsolid', found the end of the file"},
    {"solid a\n" + two_facets, "a.stl:16: expected 'facet' or 'endsolid', found the end of the file"},
    {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0",
     "a.stl:5: expected a number for z, found the end of the file"},
    {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
     "a.stl:6: a facet has 2 corners; it needs at least 3"},
    {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertices 0 1 0\n",
     "a.stl:7: expected 'vertex' or 'endloop', found 'vertices'"},
    {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 x 0\n",
     "a.stl:4: expected a number for y, found 'x'"},
    {"solid a\nend facet\n", "a.stl:2: expected 'facet' or 'endsolid', found 'end'"},
    {std::string("\xFF\xFEs\0o\0", 6), "a.stl:1: the text is UTF-16; save the file as UTF-8 or ASCII"},
    {"solid a\nendsolid a\nrubbish\n", "a.stl:3: expected 'solid', found 'rubbish'"},
};

TEST(Stl, SaysWhatIsWrongAndWhere) {
  for (const ErrorCase& c : stl_errors) {
    EXPECT_EQ(error_of([&] { read_stl(c.text, "a.stl"); }), c.message) << c.text;
  }
}

// Some programs never fill in the number of facets.
TEST(Stl, ANumberOfZeroWithFacetsAfterIt) {
  std::string bytes(84, ' ');
  for (std::size_t i = 80; i < 84; ++i) bytes[i] = '\0';
  EXPECT_EQ(read_stl(bytes, "a.stl").triangles.size(), 0u);
  for (int facet = 0; facet < 3; ++facet) {
    for (const int value : {0, 0, 1, facet, 0, 0, 1, 0, 0, 0, 1, 0})
      append_scalar(bytes, static_cast<float>(value));
    append_scalar(bytes, std::uint16_t{0});
  }
  const TriangleMesh mesh = read_stl(bytes, "a.stl");
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.positions.size(), 4u);
}

}  // namespace supple::stl_test
