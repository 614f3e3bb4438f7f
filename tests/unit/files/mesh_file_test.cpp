#include <gtest/gtest.h>
#include <sys/stat.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>

#include "supple/mesh.hpp"
#include "supple/mesh_file.hpp"
#include "support/random.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::mesh_file_test {

namespace fs = std::filesystem;

TriangleMesh awkward_mesh() {
  using limits = std::numeric_limits<double>;
  TriangleMesh mesh;
  mesh.name = "awkward";
  mesh.positions = {{0.1, 1.0 / 3, -2e300},
                    {0.0, -0.0, limits::denorm_min()},
                    {limits::quiet_NaN(), limits::infinity(), -limits::infinity()},
                    {-limits::quiet_NaN(), limits::max(), limits::min()},
                    {123456789.123456789, 1e-310, -5e-324}};
  mesh.triangles = {{0, 1, 2}, {4, 4, 4}, {3, 0, 1}, {0, 1, 2}};
  RandomNumbers random(7);
  while (mesh.positions.size() < 1000) {
    const Vec3d point{std::bit_cast<double>(random.bits()), std::bit_cast<double>(random.bits()),
                      std::bit_cast<double>(random.bits())};
    // Text formats do not keep the payload of a NaN.
    if (point == point) mesh.positions.push_back(point);
  }
  return mesh;
}

TEST(MeshFile, SavedMeshesLoadBitForBit) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = awkward_mesh();
  for (const char* name : {"other.obj", "other.off", "other.ply", "upper.OBJ", "mixed.Ply"}) {
    SCOPED_TRACE(name);
    save_mesh(mesh, folder / name);
    const TriangleMesh loaded = load_mesh(folder / name);
    expect_same_mesh(loaded, mesh);
    EXPECT_EQ(loaded.name, fs::path(name).stem());
  }
}

TEST(MeshFile, PlyKeepsTheWholeNan) {
  const TemporaryFolder folder;
  TriangleMesh mesh;
  mesh.positions = {{std::bit_cast<double>(0xfff8000000001234u), 0, 0}};
  save_mesh(mesh, folder / "a.ply");
  expect_same_mesh(load_mesh(folder / "a.ply"), mesh);
}

TEST(MeshFile, EmptyMeshesSaveAndLoad) {
  const TemporaryFolder folder;
  TriangleMesh points;
  points.positions = {{1, 2, 3}};
  for (const char* name : {"a.obj", "a.off", "a.ply"}) {
    save_mesh({}, folder / name);
    expect_same_mesh(load_mesh(folder / name), {});
    save_mesh(points, folder / name);
    expect_same_mesh(load_mesh(folder / name), points);
  }
  save_mesh(points, folder / "a.stl");
  expect_same_mesh(load_mesh(folder / "a.stl"), {});
}

TEST(MeshFile, StlIsSavedInSinglePrecision) {
  const TemporaryFolder folder;
  TriangleMesh mesh;
  mesh.positions = {{9, 9, 9}, {0.1, 0, 0}, {1, 0, 0}, {0, 1e300, 0}, {0, 1, 0}};
  mesh.triangles = {{1, 2, 3}, {1, 2, 4}};
  save_mesh(mesh, folder / "a.stl");
  EXPECT_EQ(fs::file_size(folder / "a.stl"), 84u + 2 * 50);
  const TriangleMesh loaded = load_mesh(folder / "a.stl");
  EXPECT_EQ(loaded.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}}));
  EXPECT_EQ(loaded.positions[0], (Vec3d{double{0.1f}, 0, 0}));
  EXPECT_EQ(loaded.positions[2], (Vec3d{0, std::numeric_limits<double>::infinity(), 0}));

  std::ifstream file(folder / "a.stl", std::ios::binary);
  std::string bytes(184, '\0');
  file.read(bytes.data(), 184);
  float normal[3];
  std::memcpy(normal, bytes.data() + 134, sizeof normal);
  EXPECT_EQ(normal[0], 0.0f);
  EXPECT_EQ(normal[1], 0.0f);
  EXPECT_EQ(normal[2], 1.0f);
}

TEST(MeshFile, OnlyObjHoldsLinesAndPoints) {
  const TemporaryFolder folder;
  TriangleMesh mesh;
  mesh.name = "rod";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.edges = {{0, 1}, {1, 2}};
  mesh.points = {2};
  save_mesh(mesh, folder / "rod.obj");
  const TriangleMesh loaded = load_mesh(folder / "rod.obj");
  EXPECT_EQ(loaded.edges, mesh.edges);
  EXPECT_EQ(loaded.points, mesh.points);
  for (const char* name : {"rod.off", "rod.ply", "rod.stl"}) {
    EXPECT_EQ(error_of([&] { save_mesh(mesh, folder / name); }),
              "cannot write " + (folder / name).string() +
                  ": mesh 'rod' has edges or points of no triangle, which only .obj files hold");
    EXPECT_FALSE(fs::exists(folder / name));
  }
}

TEST(MeshFile, NamesUnreadablePaths) {
  const TemporaryFolder folder;
  const std::string missing = folder / "missing.obj";
  EXPECT_EQ(error_of([&] { load_mesh(missing); }), "cannot open " + missing + ": No such file or directory");
  const std::string directory = folder / "directory.obj";
  fs::create_directory(directory);
  EXPECT_EQ(error_of([&] { load_mesh(directory); }), "cannot open " + directory + ": it is a directory");
  const std::string pipe = folder / "pipe.obj";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(error_of([&] { load_mesh(pipe); }),
            "cannot open " + pipe + ": it is not a regular file but a pipe or a device; give a file");
  const std::string through_file = folder.write("file.obj", "") / "a.obj";
  EXPECT_EQ(error_of([&] { load_mesh(through_file); }), "cannot open " + through_file + ": Not a directory");
}

TEST(MeshFile, NamesUnknownExtensions) {
  EXPECT_EQ(
      error_of([] { load_mesh("a/b.glb"); }),
      "cannot read a/b.glb: the extension '.glb' is none of .obj, .off, .ply and .stl; supple::formats reads "
      "more");
  EXPECT_EQ(
      error_of([] { load_mesh("obj"); }),
      "cannot read obj: the extension '' is none of .obj, .off, .ply and .stl; supple::formats reads more");
  EXPECT_EQ(error_of([] { save_mesh({}, "b.glb"); }),
            "cannot write b.glb: the extension '.glb' is none of .obj, .off, .ply and .stl");
}

TEST(MeshFile, MessagesAreOneLineWhateverTheFileIsCalled) {
  const TemporaryFolder folder;
  const std::string message = error_of([&] { load_mesh(folder.write("a\nb.obj", "f 1 2 3\n")); });
  EXPECT_NE(message.find("a?b.obj:1: face index 1 is out of range"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(MeshFile, MessagesNameTheFileAsGiven) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.ply", "ply\nx\n");
  EXPECT_EQ(error_of([&] { load_mesh(path); }), path + ":2: unknown keyword 'x' in the header");
}

TEST(MeshFile, WritingThatFailsIsAnError) {
  const TemporaryFolder folder;
  const std::string nowhere = folder / "none" / "a.obj";
  EXPECT_EQ(error_of([&] { save_mesh({}, nowhere); }),
            "cannot write " + nowhere + ": No such file or directory");
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "/dev/full does not exist";
  for (const char* name : {"full.obj", "full.ply", "full.stl"}) {
    const std::string full = folder / name;
    fs::create_symlink("/dev/full", full);
    TriangleMesh mesh;
    mesh.positions.resize(3);
    mesh.triangles.resize(1);
    EXPECT_EQ(error_of([&] { save_mesh(mesh, full); }), "cannot write " + full + ": No space left on device");
    mesh.positions.resize(100000);
    mesh.triangles.resize(100000);
    EXPECT_EQ(error_of([&] { save_mesh(mesh, full); }), "cannot write " + full + ": No space left on device");
  }
}

TEST(CheckMesh, NamesTheTriangleAndTheValue) {
  TriangleMesh mesh;
  mesh.name = "rabbit";
  mesh.positions.resize(3);
  mesh.triangles = {{0, 1, 2}, {2, 2, 0}, {0, 3, 1}};
  const std::string message =
      "mesh 'rabbit': triangle 2 uses vertex 3; the mesh has 3 vertices, counted from 0";
  EXPECT_EQ(error_of([&] { check_mesh(mesh); }), message);
  EXPECT_EQ(error_of([&] { save_mesh(mesh, "never-written.obj"); }), message);
  EXPECT_FALSE(fs::exists("never-written.obj"));
  mesh.triangles.pop_back();
  mesh.edges = {{0, 1}, {1, 2}};
  mesh.points = {2, 0};
  EXPECT_EQ(error_of([&] { check_mesh(mesh); }), "");
  mesh.points[1] = 3;
  EXPECT_EQ(error_of([&] { check_mesh(mesh); }),
            "mesh 'rabbit': point 1 uses vertex 3; the mesh has 3 vertices, counted from 0");
  mesh.edges[1] = {1, 1};
  EXPECT_EQ(error_of([&] { check_mesh(mesh); }),
            "mesh 'rabbit': both ends of edge 1 are vertex 1; list it in points");
  mesh.edges[0] = {0, 7};
  EXPECT_EQ(error_of([&] { check_mesh(mesh); }),
            "mesh 'rabbit': edge 0 uses vertex 7; the mesh has 3 vertices, counted from 0");
}

}  // namespace supple::mesh_file_test
