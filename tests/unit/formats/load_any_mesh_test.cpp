#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "files/byte_order.hpp"
#include "supple/formats.hpp"
#include "supple/mesh_file.hpp"
#include "unit/files/mesh_files.hpp"
#include "unit/formats/gltf_builder.hpp"

namespace supple::load_any_mesh_test {

// A square whose triangles share no vertices, as if their normals differed. Bytes 0-71: points, 72-83: ids.
std::string square_buffer(float side) {
  std::string bytes;
  for (const int value : {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) {
    append_scalar(bytes, side * static_cast<float>(value));
  }
  for (const int id : {0, 1, 2, 3, 4, 5}) append_scalar(bytes, static_cast<std::uint16_t>(id));
  return bytes;
}

// The nodes use the square (mesh 0), the square as two primitives with different materials (mesh 1), and only
// its points (mesh 2).
std::string gltf(const std::string& nodes, float side = 1) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes + R"(],
"materials":[{},{"doubleSided":true}],
"meshes":[
 {"primitives":[{"attributes":{"POSITION":0},"indices":1}]},
 {"primitives":[{"attributes":{"POSITION":0},"indices":2,"material":0},
                {"attributes":{"POSITION":0},"indices":3,"material":1}]},
 {"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":0}]}],
"accessors":[
 {"bufferView":0,"componentType":5126,"count":6,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
 {"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"},
 {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},
 {"bufferView":1,"byteOffset":6,"componentType":5123,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":72},{"buffer":0,"byteOffset":72,"byteLength":12}],
"buffers":[{"byteLength":84,"uri":"data:application/octet-stream;base64,)" +
         base64(square_buffer(side)) + R"("}]})";
}

const std::vector<Vec3d> square_points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
const std::vector<Triangle> square_triangles = {{0, 1, 2}, {1, 3, 2}};

TEST(LoadAnyMesh, GltfVerticesAreJoined) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = load_any_mesh(folder.write("square.gltf", gltf(R"({"mesh":0})")));
  EXPECT_EQ(mesh.name, "square");
  EXPECT_EQ(mesh.positions, square_points);
  EXPECT_EQ(mesh.triangles, square_triangles);
}

TEST(LoadAnyMesh, NearVerticesAreNotJoined) {
  const TemporaryFolder folder;
  const float side = 1e-7f;
  const TriangleMesh mesh = load_any_mesh(folder.write("tiny.gltf", gltf(R"({"mesh":0})", side)));
  ASSERT_EQ(mesh.positions.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(mesh.positions[i], double{side} * square_points[i]);
  EXPECT_EQ(mesh.triangles, square_triangles);
}

TEST(LoadAnyMesh, MaterialsDoNotCutAMeshApart) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = load_any_mesh(folder.write("square.GLTF", gltf(R"({"mesh":1})")));
  EXPECT_EQ(mesh.positions, square_points);
  EXPECT_EQ(mesh.triangles, square_triangles);
}

TEST(LoadAnyMesh, NodesFollowInOrderEachWithItsTransform) {
  const TemporaryFolder folder;
  const TriangleMesh mesh =
      load_any_mesh(folder.write("scene.gltf", gltf(R"({"mesh":0,"translation":[10,0,0],"children":[1,3]},
                            {"mesh":0,"scale":[2,2,2],"translation":[0,5,0],"children":[2]},
                            {"mesh":0,"translation":[0,0,1]},
                            {"mesh":0})")));
  ASSERT_EQ(mesh.positions.size(), 16u);
  ASSERT_EQ(mesh.triangles.size(), 8u);
  const Vec3d origins[] = {{10, 0, 0}, {10, 5, 0}, {10, 5, 2}, {10, 0, 0}};
  const double scales[] = {1, 2, 2, 1};
  for (std::uint32_t node = 0; node < 4; ++node) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      EXPECT_EQ(mesh.positions[4 * node + i], origins[node] + scales[node] * square_points[i])
          << node << ' ' << i;
    }
    EXPECT_EQ(mesh.triangles[2 * node], (Triangle{4 * node, 4 * node + 1, 4 * node + 2}));
  }
}

TEST(LoadAnyMesh, MirroredTrianglesAreTurnedAround) {
  const TemporaryFolder folder;
  const TriangleMesh mesh =
      load_any_mesh(folder.write("mirror.gltf", gltf(R"({"mesh":0,"scale":[-1,1,1]})")));
  EXPECT_EQ(mesh.positions[1], (Vec3d{-1, 0, 0}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 2, 1}, {1, 2, 3}}));
}

TEST(LoadAnyMesh, PointsAreDropped) {
  const TemporaryFolder folder;
  const TriangleMesh points = load_any_mesh(folder.write("points.gltf", gltf(R"({"mesh":2})")));
  EXPECT_TRUE(points.positions.empty());
  EXPECT_TRUE(points.triangles.empty());
  const TriangleMesh both =
      load_any_mesh(folder.write("both.gltf", gltf(R"({"mesh":2,"children":[1]},{"mesh":0})")));
  EXPECT_EQ(both.positions, square_points);
  EXPECT_EQ(both.triangles, square_triangles);
}

TEST(LoadAnyMesh, Collada) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = load_any_mesh(folder.write("square.dae", R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g" name="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>0 0 3</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)"));
  ASSERT_EQ(mesh.positions.size(), 4u);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  double area = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const Vec3d u = mesh.positions[triangle[1]] - mesh.positions[triangle[0]];
    const Vec3d v = mesh.positions[triangle[2]] - mesh.positions[triangle[0]];
    area += (u.x * v.y - u.y * v.x) / 2;
  }
  EXPECT_EQ(area, 1);
  for (const Vec3d& position : mesh.positions) EXPECT_EQ(position.z, 3);
}

TEST(LoadAnyMesh, NativeFormatsAreLeftToLoadMesh) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.OBJ", "v 0.1 0 0\nv 0.1 0 0\nv 0 1 0\nf 1 2 3\n");
  const TriangleMesh mesh = load_any_mesh(path);
  expect_same_mesh(mesh, load_mesh(path));
  EXPECT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.positions[0].x, 0.1);
}

TEST(LoadAnyMesh, SaysWhyAFileCannotBeRead) {
  const TemporaryFolder folder;
  const std::string missing = folder / "missing.glb";
  EXPECT_EQ(error_of([&] { load_any_mesh(missing); }),
            "cannot open " + missing + ": No such file or directory");
  const std::string directory = folder / "directory.fbx";
  std::filesystem::create_directory(directory);
  EXPECT_EQ(error_of([&] { load_any_mesh(directory); }), "cannot open " + directory + ": it is a directory");
  EXPECT_EQ(error_of([] { load_any_mesh("a.xyz1"); }),
            "cannot read a.xyz1: unknown extension '.xyz1'; .obj, .off, .ply, .stl, .gltf, .glb, .fbx, .dae, "
            ".3ds, .3mf, .msh, .vtk and more are supported");
  for (const char* name : {"a.gltf", "a.glb", "a.fbx", "a.dae", "a.3ds"}) {
    const std::string broken = folder.write(name, "{\n\"not\"\n");
    const std::string message = error_of([&] { load_any_mesh(broken); });
    // A text names the place of the fault.
    EXPECT_TRUE(message.starts_with("cannot read " + broken + ": ") ||
                message.starts_with(broken + ", byte "))
        << message;
    EXPECT_GT(message.size(), broken.size() + 20) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(LoadAnyMesh, NodesNeedTheirMeshes) {
  EXPECT_NE(error_of([] { load_any_mesh(SUPPLE_DUMP); }).find("is out of range; the file has"),
            std::string::npos);
}

TEST(SupportedExtensions, NativeOnesAndThoseOfAssimp) {
  const auto extensions = supported_extensions();
  EXPECT_TRUE(std::is_sorted(extensions.begin(), extensions.end()));
  EXPECT_EQ(std::adjacent_find(extensions.begin(), extensions.end()), extensions.end());
  for (const std::string_view extension :
       {".obj", ".off", ".ply", ".stl", ".gltf", ".glb", ".fbx", ".dae", ".3ds", ".x3d"}) {
    EXPECT_NE(std::find(extensions.begin(), extensions.end(), extension), extensions.end()) << extension;
  }
}

}  // namespace supple::load_any_mesh_test
