#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "files/mesh_formats.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::off_test {

const std::string corners = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";

struct OffCase {
  const char* what;
  std::string text;
  std::vector<Triangle> triangles;
  std::size_t vertices = 4;
};

const OffCase off_cases[] = {
    {"plain", "OFF\n4 1 6\n" + corners + "3 0 1 2\n", {{0, 1, 2}}},
    {"counts on the first line", "OFF 4 1 6\n" + corners + "3 0 1 2", {{0, 1, 2}}},
    {"counts stuck to the keyword", "OFF4 1 6\n" + corners + "3 0 1 2", {{0, 1, 2}}},
    {"no number of edges", "OFF\n4 1\n" + corners + "3 0 1 2\n", {{0, 1, 2}}},
    {"comments and blank lines",
     "# a\n\nOFF # b\n#c\n4 1 0 # d\n\n" + corners + "#e\n3 0 1 2 # f\n\n# g\n",
     {{0, 1, 2}}},
    {"CR LF", "OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n", {{0, 1, 2}}, 3},
    {"byte order mark", "\xEF\xBB\xBFOFF 4 1 0\n" + corners + "3 0 1 2\n", {{0, 1, 2}}},
    {"face colours",
     "OFF\n4 3 0\n" + corners + "3 0 1 2 255 0 0\n3 1 2 3 0.5 0.5 0.5 1\n4 0 1 2 3 7\n",
     {{0, 1, 2}, {1, 2, 3}, {0, 1, 2}, {0, 2, 3}}},
    {"vertex colours", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1\n0 1 0 0\n3 0 1 2\n", {{0, 1, 2}}, 3},
    {"vertex colours without the C",
     "OFF\n3 1 0\n0 0 0 255 0 0\n1 0 0 1 1 1\n0 1 0 0 0 0\n3 0 1 2\n",
     {{0, 1, 2}},
     3},
    {"normals", "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n", {{0, 1, 2}}, 3},
    {"texture", "STOFF\n3 1 0\n0 0 0 0 0\n1 0 0 0 1\n0 1 0 1 1\n3 0 1 2\n", {{0, 1, 2}}, 3},
    {"all of these", "STCNOFF\n3 1 0\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n", {{0, 1, 2}}, 3},
    {"in another order",
     "NCOFF\n3 1 0\n0 0 0 0 0 1 9 9 9\n1 0 0 0 0 1 9 9 9\n0 1 0 0 0 1 9 9 9\n3 0 1 2\n",
     {{0, 1, 2}},
     3},
    {"texture last", "CNSTOFF\n3 1 0\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n", {{0, 1, 2}}, 3},
    {"a face without corners", "OFF\n4 2 0\n" + corners + "0\n3 0 1 2\n", {{0, 1, 2}}},
    {"repeated ids stay", "OFF\n4 1 0\n" + corners + "3 1 1 1\n", {{1, 1, 1}}},
    {"no faces", "OFF\n4 0 0\n" + corners, {}},
    {"nothing", "OFF\n0 0 0\n", {}, 0},
    {"nothing, no line end", "OFF 0 0", {}, 0},
};

TEST(Off, ReadsWhatIsAllowed) {
  for (const OffCase& c : off_cases) {
    SCOPED_TRACE(c.what);
    TriangleMesh mesh;
    EXPECT_EQ(error_of([&] { mesh = read_off(c.text, "a.off"); }), "");
    EXPECT_EQ(mesh.triangles, c.triangles);
    ASSERT_EQ(mesh.positions.size(), c.vertices);
    if (c.vertices >= 3) {
      EXPECT_EQ(mesh.positions[1], (Vec3d{1, 0, 0}));
      EXPECT_EQ(mesh.positions[2], (Vec3d{0, 1, 0}));
    }
  }
}

TEST(Off, KeepsNonFiniteCoordinates) {
  const TriangleMesh mesh = read_off("OFF\n2 0 0\nnan -inf 1e400\n1e-400 +2 -0\n", "a.off");
  constexpr double inf = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(mesh.positions[0].x));
  EXPECT_EQ(mesh.positions[0].y, -inf);
  EXPECT_EQ(mesh.positions[0].z, inf);
  EXPECT_TRUE(same_bits(mesh.positions[1], {0, 2, -0.0}));
}

struct ErrorCase {
  std::string text;
  const char* message;
};

const ErrorCase off_errors[] = {
    {"", "a.off:1: expected 'OFF', 'COFF', 'NOFF' or 'STOFF', found the end of the file"},
    {"4 1 0\n" + corners, "a.off:1: expected 'OFF', 'COFF', 'NOFF' or 'STOFF', found '4'"},
    {"4OFF\n1 0 0\n0 0 0 1\n",
     "a.off:1: vertices of other than three dimensions (4OFF, nOFF) are not supported"},
    {"NC4OFF\n1 0 0\n0 0 0 1\n",
     "a.off:1: vertices of other than three dimensions (4OFF, nOFF) are not supported"},
    {"C4nOFF 3\n1 0 0\n0 0 0 1\n",
     "a.off:1: vertices of other than three dimensions (4OFF, nOFF) are not supported"},
    {"nOFF 2\n1 0 0\n0 0\n",
     "a.off:1: vertices of other than three dimensions (4OFF, nOFF) are not supported"},
    {"OFF BINARY\n", "a.off:1: binary OFF is not supported; save it as text, or as binary PLY"},
    {"OFF\n", "a.off:2: expected an integer for the number of vertices, found the end of the file"},
    {"OFF\n4 x 0\n", "a.off:2: expected an integer for the number of faces, found 'x'"},
    {"OFF\n-4 1 0\n", "a.off:2: the number of vertices is -4"},
    {"OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n# not this: 0 0 1\n",
     "a.off:7: the file ends after 3 of the 4 vertices of the header"},
    {"OFF\n4 2 0\n" + corners + "3 0 1 2\n#########\n",
     "a.off:9: the file ends after 1 of the 2 faces of the header"},
    {"OFF\n4 1 0\n" + corners + "3 0 1 4\n",
     "a.off:7: face 0: vertex index 4 is out of range; the file has 4 vertices, counted from 0"},
    {"OFF\n4 1 0\n" + corners + "3 0 -1 2\n",
     "a.off:7: face 0: vertex index -1 is out of range; the file has 4 vertices, counted from 0"},
    {"OFF\n4 1 0\n" + corners + "2 1 1   \n",
     "a.off:7: face 0 is a line that joins vertex 1 to itself; leave it out"},
    {"OFF\n4 1 0\n" + corners + "-3 0 1 2\n", "a.off:7: face 0 has -3 corners"},
    {"OFF\n4 1 0\n" + corners + "4 0 1 2\n",
     "a.off:7: expected an integer for a vertex index, found the end of the line"},
    {"OFF\n4 1 0\n" + corners + "3 0 1 2.0\n",
     "a.off:7: expected an integer for a vertex index, found '2.0'"},
    {"OFF\n4 1 0\n0 0 0\n1 0 \n0 1 0\n0 0 1\n3 0 1 2\n",
     "a.off:4: expected a number for z, found the end of the line"},
    {"OFF\n4 1 0\n" + corners + "3 0 1 2\n3 1 2 3\n",
     "a.off:8: more follows after the 4 vertices and 1 faces of the header"},
    {"OFF\n4000000000 1 0\n" + corners + "3 0 1 2\n",
     "a.off:3: the header announces 4000000000 vertices and 1 faces, more than the 32 bytes after it can "
     "hold"},
    {"OFF\n4 9223372036854775807 0\n" + corners + "3 0 1 2\n",
     "a.off:3: the header announces 4 vertices and 9223372036854775807 faces, more than the 32 bytes after "
     "it "
     "can hold"},
};

TEST(Off, SaysWhatIsWrongAndWhere) {
  for (const ErrorCase& c : off_errors) {
    EXPECT_EQ(error_of([&] { read_off(c.text, "a.off"); }), c.message) << c.text;
  }
}

}  // namespace supple::off_test
