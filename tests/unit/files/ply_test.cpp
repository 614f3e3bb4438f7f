#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "files/mesh_formats.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::ply_test {

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string faces = "property list uchar int vertex_indices\n";
const std::string strips = "property list int int vertex_indices\n";
const std::string corners = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}
const std::string plain =
    header("ascii", "element vertex 4\n" + xyz + "element face 1\n" + faces);  // 9 lines

// Collects the bytes of values in a given byte order.
class Bytes {
 public:
  explicit Bytes(std::endian order) : order_(order) {}
  template <class Scalar>
  Bytes& add(Scalar value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(Scalar)>>(value);
    if (order_ != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    text_.append(bytes.data(), bytes.size());
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::endian order_;
  std::string text_;
};

struct PlyCase {
  const char* what;
  std::string text;
  std::vector<Triangle> triangles;
  std::size_t vertices = 4;
};

const PlyCase ply_cases[] = {
    {"plain", plain + corners + "3 0 1 2\n", {{0, 1, 2}}},
    {"no line end at the end", plain + corners + "3 0 1 2", {{0, 1, 2}}},
    {"values spread over lines", plain + "0 0\n0 1 0 0 0 1 0 0\n0 1 3\n0 1\n2\n", {{0, 1, 2}}},
    {"comments",
     "ply\ncomment a\nformat ascii 1.0\nobj_info b c\ncomment\nelement vertex 4\ncomment x\n" + xyz +
         "element face 1\n" + faces + "end_header\n" + corners + "3 0 1 2\n",
     {{0, 1, 2}}},
    {"faces before vertices",
     header("ascii", "element face 1\n" + faces + "element vertex 4\n" + xyz) + "3 0 1 3\n" + corners,
     {{0, 1, 3}}},
    {"the other name of the list",
     header("ascii",
            "element vertex 4\n" + xyz + "element face 1\nproperty list uint8 uint32 vertex_index\n") +
         corners + "3 0 1 2\n",
     {{0, 1, 2}}},
    {"more properties and elements",
     header("ascii",
            "element camera 2\nproperty float f\nproperty list char double l\nelement vertex 4\n"
            "property uchar red\n" +
                xyz + "property list int float weights\nelement face 1\nproperty int material\n" + faces +
                "property list uchar float texcoord\nelement nothing 3\nelement edge 1\n"
                "property int vertex1\nproperty int vertex2\n") +
         "1 0\n2 3 a b c\n"
         "9 0 0 0 0\n9 1 0 0 1 5\n9 0 1 0 2 5 6\n9 0 0 1 0\n"
         "7 3 0 1 2 6 0 0 0 0 0 0\n"
         "0 1\n",
     {{0, 1, 2}}},
    {"polygons become fans", plain + corners + "4 3 0 1 2\n", {{3, 0, 1}, {3, 1, 2}}},
    {"a strip that starts again",
     header("ascii", "element vertex 4\n" + xyz + "element tristrips 2\n" + strips) + corners +
         "10 0 1 2 3 -1 -1 3 2 1 0\n0\n",
     {{0, 1, 2}, {2, 1, 3}, {3, 2, 1}, {1, 2, 0}}},
    {"a strip that repeats vertices to go on elsewhere",
     header("ascii", "element vertex 4\n" + xyz + "element tristrips 1\n" + strips) + corners +
         "8 0 1 2 2 3 3 1 0\n",
     {{0, 1, 2}, {1, 3, 0}}},
    {"faces of one corner and of two",
     header("ascii", "element vertex 4\n" + xyz + "element face 3\n" + faces) + corners +
         "1 2\n2 1 0\n3 0 1 2\n",
     {{0, 1, 2}}},
    {"zero bytes at the end", plain + corners + "3 0 1 2\n" + std::string(3, '\0'), {{0, 1, 2}}},
    {"no element face", header("ascii", "element vertex 4\n" + xyz) + corners, {}},
    {"no faces", header("ascii", "element vertex 4\n" + xyz + "element face 0\n") + corners, {}},
    {"nothing", header("ascii", "element vertex 0\nelement face 0\n"), {}, 0},
    {"no elements", header("binary_big_endian", ""), {}, 0},
};

TEST(Ply, ReadsWhatIsAllowed) {
  for (const PlyCase& c : ply_cases) {
    SCOPED_TRACE(c.what);
    TriangleMesh mesh;
    EXPECT_EQ(error_of([&] { mesh = read_ply(c.text, "a.ply"); }), "");
    EXPECT_EQ(mesh.triangles, c.triangles);
    ASSERT_EQ(mesh.positions.size(), c.vertices);
    if (c.vertices == 4) {
      EXPECT_EQ(mesh.positions[1], (Vec3d{1, 0, 0}));
      EXPECT_EQ(mesh.positions[3], (Vec3d{0, 0, 1}));
    }
  }
}

TEST(Ply, EdgesAreThoseOfTheirElement) {
  const std::string edge = "element edge 2\nproperty uchar red\nproperty int vertex2\nproperty int vertex1\n";
  const TriangleMesh after =
      read_ply(header("ascii", "element vertex 4\n" + xyz + edge) + corners + "9 0 3\n9 1 2\n", "a.ply");
  EXPECT_EQ(after.edges, (std::vector<std::array<std::uint32_t, 2>>{{3, 0}, {2, 1}}));
  const TriangleMesh before =
      read_ply(header("ascii", edge + "element vertex 4\n" + xyz) + "9 0 3\n9 1 2\n" + corners, "a.ply");
  EXPECT_EQ(before.edges, after.edges);
  const std::string little_endian =
      header("binary_little_endian",
             "element vertex 2\n" + xyz + "element edge 1\nproperty uint vertex1\nproperty uchar vertex2\n") +
      Bytes(std::endian::little).add(0.0f).add(0.0f).add(0.0f).add(1.0f).add(0.0f).add(0.0f).text() +
      Bytes(std::endian::little).add(std::uint32_t{1}).add(std::uint8_t{0}).text();
  EXPECT_EQ(read_ply(little_endian, "a.ply").edges, (std::vector<std::array<std::uint32_t, 2>>{{1, 0}}));
}

TEST(Ply, TextIsReadAsDouble) {
  const TriangleMesh mesh =
      read_ply(header("ascii", "element vertex 2\n" + xyz) + "0.1 nan -inf\n1e400 1e-400 -0\n", "a.ply");
  EXPECT_EQ(mesh.positions[0].x, 0.1);
  EXPECT_TRUE(std::isnan(mesh.positions[0].y));
  EXPECT_EQ(mesh.positions[0].z, -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(same_bits(mesh.positions[1], {std::numeric_limits<double>::infinity(), 0.0, -0.0}));
}

TEST(Ply, LineEndsOfTheHeader) {
  std::string text = plain + corners + "3 0 1 2\n";
  std::string windows, old_mac;
  for (const char c : text) {
    windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    old_mac += c == '\n' ? '\r' : c;
  }
  expect_same_mesh(read_ply(windows, "a.ply"), read_ply(text, "a.ply"));
  expect_same_mesh(read_ply(old_mac, "a.ply"), read_ply(text, "a.ply"));
}

template <class Count, class Index, class Coordinate>
void expect_binary(const std::string& count, const std::string& index, const std::string& coordinate) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const std::string format = order == std::endian::big ? "binary_big_endian" : "binary_little_endian";
    SCOPED_TRACE(format + " " + count + " " + index + " " + coordinate);
    std::string declared;
    for (const char* name : {"y", "x", "z"}) declared += "property " + coordinate + " " + name + "\n";
    Bytes bytes(order);
    for (int i = 0; i < 4; ++i) {
      bytes.add(std::int16_t{-7});
      for (const int value : {10 + i, 20 + i, 30 + i}) bytes.add(static_cast<Coordinate>(value));
      bytes.add(static_cast<Count>(2)).add(1.5f).add(2.5f);
    }
    bytes.add(static_cast<Count>(4));
    for (const int id : {3, 0, 1, 2}) bytes.add(static_cast<Index>(id));
    const TriangleMesh mesh =
        read_ply(header(format, "element vertex 4\nproperty short s\n" + declared + "property list " + count +
                                    " float l\nelement face 1\nproperty list " + count + " " + index +
                                    " vertex_indices\n") +
                     bytes.text(),
                 "a.ply");
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{3, 0, 1}, {3, 1, 2}}));
    for (int i = 0; i < 4; ++i) EXPECT_EQ(mesh.positions[i], (Vec3d{20.0 + i, 10.0 + i, 30.0 + i}));
  }
}

TEST(Ply, EveryTypeInBothByteOrders) {
  expect_binary<std::uint8_t, std::int32_t, float>("uchar", "int", "float");
  expect_binary<std::int8_t, std::int8_t, double>("char", "char", "double");
  expect_binary<std::int16_t, std::uint8_t, std::int8_t>("short", "uint8", "int8");
  expect_binary<std::uint16_t, std::int16_t, std::uint8_t>("ushort", "int16", "uchar");
  expect_binary<std::int32_t, std::uint16_t, std::int16_t>("int32", "uint16", "short");
  expect_binary<std::uint32_t, std::uint32_t, std::uint16_t>("uint32", "uint", "ushort");
  expect_binary<std::uint8_t, std::int32_t, std::int32_t>("uint8", "int32", "int");
  expect_binary<std::uint8_t, std::int32_t, std::uint32_t>("uint8", "int32", "uint32");
  expect_binary<std::uint8_t, std::int32_t, float>("uint8", "int32", "float32");
  expect_binary<std::uint8_t, std::int32_t, double>("uint8", "int32", "float64");
}

TEST(Ply, FloatsAreWidenedExactly) {
  Bytes bytes(std::endian::little);
  bytes.add(0.1f).add(-0.0f).add(std::numeric_limits<float>::denorm_min());
  bytes.add(std::numeric_limits<float>::infinity()).add(std::numeric_limits<float>::quiet_NaN()).add(1e38f);
  const TriangleMesh mesh =
      read_ply(header("binary_little_endian", "element vertex 2\n" + xyz) + bytes.text(), "a.ply");
  EXPECT_TRUE(same_bits(mesh.positions[0], {double{0.1f}, -0.0, 0x1p-149}));
  EXPECT_EQ(mesh.positions[1].x, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(mesh.positions[1].y));
  EXPECT_EQ(mesh.positions[1].z, double{1e38f});
}

struct ErrorCase {
  std::string text;
  const char* message;
};

Bytes little() {
  return Bytes(std::endian::little);
}

// A file with the four vertices of the tetrahedron and then `body`, which starts at byte 217.
std::string binary(const Bytes& body, const std::string& index = "int") {
  Bytes bytes = little();
  for (const int value : {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) bytes.add(static_cast<float>(value));
  return header("binary_little_endian", "element vertex 4\n" + xyz + "element face 1\nproperty list uchar " +
                                            index + " vertex_indices\n") +
         bytes.text() + body.text();
}

const ErrorCase ply_errors[] = {
    {"", "a.ply:1: not a PLY file: it does not start with 'ply'"},
    {"plyx\n", "a.ply:1: not a PLY file: it does not start with 'ply'"},
    {"ply\nelement vertex 4\n", "a.ply:3: the file ends within the header"},
    {"ply\nelement vertex 0\nend_header\n", "a.ply:3: the header has no 'format' line"},
    {"ply\nformat binary 1.0\n",
     "a.ply:2: unknown format 'binary'; it may be ascii, binary_little_endian or binary_big_endian"},
    {"ply\nformat ascii 2.0\n", "a.ply:2: unknown version '2.0' of PLY; it may be 1.0"},
    {"ply\nformat ascii 1.0\nfoo\n", "a.ply:3: unknown keyword 'foo' in the header"},
    {"ply\nformat ascii 1.0\nelement vertex -1\n", "a.ply:3: element 'vertex' has the count -1"},
    {"ply\nformat ascii 1.0\nelement vertex\n",
     "a.ply:3: expected an integer for the number of elements, found the end of the line"},
    {"ply\nformat ascii 1.0\nelement vertex 1\nelement vertex 1\n",
     "a.ply:4: element 'vertex' is there twice"},
    {header("ascii", "element vertex 4\n" + xyz + "element tristrips 1\n" + strips) + corners +
         "4 0 1 2 -2\n",
     "a.ply:14: strip 0: vertex index -2 is out of range; the file has 4 vertices, counted from 0"},
    {header("ascii", "element vertex 4\n" + xyz + "element tristrips 1\n" + strips) + corners + "4 0 1 2\n",
     "a.ply:15: the file ends before the last element of the header"},
    {header("ascii", "element vertex 4\n" + xyz + "element tristrips 1\n" + strips) + corners + "-4 0 1 2\n",
     "a.ply:14: strip 0 has -4 vertices"},
    {header("ascii", "element vertex 4\n" + xyz + "element tristrips 1\nproperty int n\n") + corners + "1\n",
     "a.ply:13: element 'tristrips' has no list 'vertex_indices' or 'vertex_index'"},
    {"ply\nformat ascii 1.0\nproperty float x\n", "a.ply:3: a property comes before any element"},
    {"ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n",
     "a.ply:4: unknown type 'half' of a property"},
    {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float\n",
     "a.ply:4: expected the name of a property, found the end of the line"},
    {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty int x\n",
     "a.ply:5: property 'x' of element 'vertex' is there twice"},
    {"ply\nformat ascii 1.0\nelement face 1\nproperty list float int vertex_indices\n",
     "a.ply:4: the count of list 'vertex_indices' must be of an integer type"},
    {"ply\nformat ascii 1.0\nelement face 1\nproperty list uchar float vertex_indices\n",
     "a.ply:4: list 'vertex_indices' must be of an integer type"},
    {header("ascii", "element vertex 1\nproperty float x\nproperty float z\n") + "0 0\n",
     "a.ply:7: element 'vertex' has no scalar property 'y'"},
    {header("ascii", "element vertex 1\n"), "a.ply:5: element 'vertex' has no scalar property 'x'"},
    {header("ascii", "element vertex 1\nproperty list uchar float x\nproperty float y\nproperty float z\n") +
         "1 0 0 0\n",
     "a.ply:8: element 'vertex' has no scalar property 'x'"},
    {header("ascii", "element vertex 4\n" + xyz + "element face 1\nproperty int a\n") + corners + "1\n",
     "a.ply:13: element 'face' has no list 'vertex_indices' or 'vertex_index'"},
    {header("ascii", "element vertex 4\n" + xyz + "element edge 1\nproperty int vertex1\n") + corners + "1\n",
     "a.ply:13: element 'edge' has no scalar property 'vertex2'"},
    {header("ascii",
            "element vertex 4\n" + xyz + "element edge 1\nproperty int vertex1\nproperty float vertex2\n") +
         corners + "1 2\n",
     "a.ply:14: property 'vertex2' of element 'edge' must be of an integer type"},
    {header("ascii",
            "element vertex 4\n" + xyz + "element edge 2\nproperty int vertex1\nproperty int vertex2\n") +
         corners + "1 2\n0 4\n",
     "a.ply:16: edge 1: vertex index 4 is out of range; the file has 4 vertices, counted from 0"},
    {header("ascii",
            "element vertex 4\n" + xyz + "element edge 1\nproperty int vertex1\nproperty int vertex2\n") +
         corners + "1 1\n",
     "a.ply:15: edge 0 joins vertex 1 to itself; leave it out"},
    {plain + corners + "3 0 1 4\n",
     "a.ply:14: face 0: vertex index 4 is out of range; the file has 4 vertices, counted from 0"},
    {plain + corners + "3 0 1 -1\n",
     "a.ply:14: face 0: vertex index -1 is out of range; the file has 4 vertices, counted from 0"},
    {plain + corners + "3 0 1  \n", "a.ply:15: the file ends before the last element of the header"},
    {plain + corners + "3 0 1 2.5\n",
     "a.ply:14: expected an integer for a count or a vertex index, found '2.5'"},
    {plain + "0 0 x\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n",
     "a.ply:10: expected a number for a coordinate, found 'x'"},
    {plain + corners + "3 0 1 2\n3 1 2 3\n", "a.ply:15: more follows after the last element of the header"},
    {header("ascii", "element vertex 4000000000\n" + xyz) + corners,
     "a.ply:8: the header announces 4000000000 of element 'vertex', more than the rest of the file can hold"},
    {header("ascii", "element vertex 4\n" + xyz + "element face 9223372036854775807\n" + faces) + corners,
     "a.ply:10: the header announces 9223372036854775807 of element 'face', more than the rest of the file "
     "can "
     "hold"},
    {binary(little().add(std::uint8_t{3}).add(0).add(1).add(4)),
     "a.ply, byte 226: face 0: vertex index 4 is out of range; the file has 4 vertices, counted from 0"},
    {binary(little().add(std::uint8_t{3}).add(0).add(1).add(-1)),
     "a.ply, byte 226: face 0: vertex index -1 is out of range; the file has 4 vertices, counted from 0"},
    {binary(little().add(std::uint8_t{3}).add(0u).add(1u).add(0xffffffffu), "uint"),
     "a.ply, byte 227: face 0: vertex index 4294967295 is out of range; the file has 4 vertices, counted "
     "from 0"},
    {binary(little().add(std::uint8_t{4}).add(0).add(1).add(2)),
     "a.ply, byte 230: the file ends before the last element of the header"},
    {binary(little().add(std::uint8_t{3}).add(0).add(1)),
     "a.ply, byte 226: the file ends before the last element of the header"},
    {header("binary_little_endian", "element other 1\nproperty list char uchar l\n") + "\xff",
     "a.ply, byte 90: list 'l' has the length -1"},
    {header("binary_little_endian", "element other 1\nproperty list uint double l\n") + "\xff\xff\xff\xff",
     "a.ply, byte 95: the file ends before the last element of the header"},
};

TEST(Ply, SaysWhatIsWrongAndWhere) {
  for (const ErrorCase& c : ply_errors) {
    EXPECT_EQ(error_of([&] { read_ply(c.text, "a.ply"); }), c.message) << c.text;
  }
}

TEST(Ply, CountsOfEmptyElementsAreNotCountedUpTo) {
  const TriangleMesh mesh = read_ply(
      header("ascii", "element nothing 9223372036854775807\nelement vertex 4\n" + xyz) + corners, "a.ply");
  EXPECT_EQ(mesh.positions.size(), 4u);
}

TEST(Ply, FacesWithoutCornersAreNone) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 3\nproperty list uchar int vertex_indices\nend_header\n";
  const TriangleMesh mesh = read_ply(header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n0\n3 2 1 0\n", "a.ply");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 0}}));
  EXPECT_TRUE(mesh.points.empty());
}

}  // namespace supple::ply_test
