// Damages small valid files in thousands of ways. Each result must load as a consistent mesh or throw an
// Error with one line. With sanitizers, this test also finds reads beyond the end.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "files/mesh_formats.hpp"
#include "support/random.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::mutation_test {

using Reader = TriangleMesh (*)(std::string_view, const std::string&);

TriangleMesh small_mesh() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1.25, 0, 0}, {0, 1e-3, 0}, {0, 0, -17}, {5, 6, 7}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

std::string ply_header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment c\nelement extra 2\nproperty list uchar short l\nelement vertex 3\n"
         "property float x\nproperty double y\nproperty int z\nproperty uchar red\nelement face 2\n"
         "property list uchar int vertex_indices\nproperty list ushort float t\nend_header\n";
}

// Zero bytes are valid up to the counts of the faces: they are empty lists and points at the origin.
std::string binary_ply(const std::string& format, const std::string& three_corners) {
  return ply_header(format) + std::string(2 + 3 * 17, '\0') + three_corners + three_corners;
}

struct Seed {
  const char* what;
  Reader read;
  std::string bytes;
};

std::vector<Seed> seeds() {
  const std::string obj =
      "# c\nv 0 0 0\nv 1.5 -2e3 nan 1\nv\t0 1 0\r\nvn 0 0 1\nf 1/1 2/2/2 \\\n3//3\nf -1 -2 -3 1\nl 1 2 "
      "\\\n-1\np 1 3\nf 1 "
      "2 3";
  const std::string coff =
      "COFF\n# c\n4 2 0\n0 0 0 1 1 1 1\n1 0 0 1\n0 1 0 2\n0 0 inf 3\n3 0 1 2 255 0 0\n4 0 1 2 3\n";
  const std::string ascii_ply =
      ply_header("ascii") + "2 5 6\n0\n0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 2 1 .5\n4 0 1 2 0 0\n";
  const std::string ascii_stl =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "nan\nendloop\nendfacet\n"
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex -1 0 0\nvertex 0 1e300 0\nendloop\nendfacet\n"
      "endsolid a\nsolid b\nendsolid b\n";
  using namespace std::string_literals;
  return {
      {"obj", read_obj, obj},
      {"written obj", read_obj, write_obj(small_mesh())},
      {"coff", read_off, coff},
      {"written off", read_off, write_off(small_mesh())},
      {"text ply", read_ply, ascii_ply},
      {"little endian ply", read_ply, binary_ply("binary_little_endian", "\3\0\0\0\0\1\0\0\0\2\0\0\0\0\0"s)},
      {"big endian ply", read_ply, binary_ply("binary_big_endian", "\3\0\0\0\0\0\0\0\1\0\0\0\2\0\0"s)},
      {"written ply", read_ply, write_ply(small_mesh())},
      {"text stl", read_stl, ascii_stl},
      {"binary stl", read_stl, write_stl(small_mesh())}};
}

class Damage {
 public:
  explicit Damage(unsigned seed) : random_(seed) {}

  std::string operator()(std::string bytes) {
    for (std::size_t edits = 1 + below(3); edits > 0 && !bytes.empty(); --edits) edit(bytes);
    return bytes;
  }

 private:
  void edit(std::string& bytes) {
    static const std::string telling = "0123456789-+.einaf/\\#\n\r\t vsolidOFFply\xff\x80\x7f";
    const std::size_t place = below(bytes.size());
    const std::size_t length = below(std::min<std::size_t>(bytes.size() - place, 12)) + 1;
    switch (below(7)) {
      case 0:
        bytes[place] = static_cast<char>(below(256));
        break;
      case 1:
        bytes[place] = telling[below(telling.size())];
        break;
      case 2:
        bytes[place] = static_cast<char>(bytes[place] ^ (1 << below(8)));
        break;
      case 3:
        bytes.resize(place);
        break;
      case 4:
        bytes.erase(place, length);
        break;
      case 5:
        bytes.insert(place, bytes.substr(below(bytes.size()), length));
        break;
      case 6:
        bytes.insert(place, 1, telling[below(telling.size())]);
        break;
    }
  }
  std::size_t below(std::size_t bound) { return random_.below(static_cast<std::uint32_t>(bound)); }

  RandomNumbers random_;
};

// Returns true if the bytes gave a mesh.
bool mesh_or_error(Reader read, const std::string& bytes) {
  // The copy has exactly this size, so sanitizers detect a read of the first byte beyond it.
  const std::vector<char> exact(bytes.begin(), bytes.end());
  TriangleMesh mesh;
  bool read_through = false;
  const std::string message = error_of([&] {
    mesh = read({exact.data(), exact.size()}, "damaged");
    read_through = true;
  });
  if (!read_through) {
    EXPECT_TRUE(message.starts_with("damaged")) << message;
    EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos) << message;
    return false;
  }
  EXPECT_EQ(error_of([&] { check_mesh(mesh); }), "") << bytes;
  // The counts in a header must not determine how much is allocated.
  EXPECT_LE(mesh.positions.capacity(), 64 + 8 * bytes.size());
  EXPECT_LE(mesh.triangles.capacity(), 64 + 8 * bytes.size());
  EXPECT_LE(mesh.edges.capacity() + mesh.points.capacity(), 64 + 8 * bytes.size());
  return true;
}

TEST(DamagedFiles, GiveAMeshOrAnError) {
  for (const Seed& seed : seeds()) {
    SCOPED_TRACE(seed.what);
    ASSERT_TRUE(mesh_or_error(seed.read, seed.bytes)) << error_of([&] { seed.read(seed.bytes, "seed"); });
    Damage damage(1);
    int meshes = 0, errors = 0;
    for (int i = 0; i < 4000 && !testing::Test::HasFailure(); ++i) {
      ++(mesh_or_error(seed.read, damage(seed.bytes)) ? meshes : errors);
    }
    // The test is useful only if the damage is sometimes harmless and sometimes fatal.
    EXPECT_GT(meshes, 100);
    EXPECT_GT(errors, 100);
  }
}

TEST(DamagedFiles, CutAnywhere) {
  for (const Seed& seed : seeds()) {
    SCOPED_TRACE(seed.what);
    for (std::size_t size = 0; size < seed.bytes.size(); ++size)
      mesh_or_error(seed.read, seed.bytes.substr(0, size));
  }
}

TEST(DamagedFiles, FilesOfAnotherFormat) {
  for (const Seed& seed : seeds()) {
    for (const Reader read : {read_obj, read_off, read_ply, read_stl}) {
      SCOPED_TRACE(seed.what);
      mesh_or_error(read, seed.bytes);
    }
  }
}

}  // namespace supple::mutation_test
