#include "supple/animation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "supple/point_cache.hpp"
#include "unit/files/mesh_files.hpp"
#include "unit/formats/gltf_builder.hpp"

namespace supple::animation_test {

constexpr double pi = 3.14159265358979323846;
const std::vector<float> triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/// A triangle at node 0.
GltfBuilder triangle_file() {
  GltfBuilder gltf;
  gltf.json["nodes"] = {{{"mesh", 0}}};
  gltf.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", gltf.add("VEC3", triangle)}}}}}}}};
  return gltf;
}

void add_channel(GltfBuilder& gltf, std::size_t clip, int node, const char* path, const char* interpolation,
                 const std::vector<float>& times, const std::string& type, const std::vector<float>& values) {
  auto& animation = gltf.json["animations"][clip];
  animation["samplers"].push_back({{"input", gltf.add("SCALAR", times)},
                                   {"output", gltf.add(type, values)},
                                   {"interpolation", interpolation}});
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
}

AnimatedMesh load(const GltfBuilder& gltf) {
  const TemporaryFolder folder;
  return AnimatedMesh(folder.write("a.gltf", gltf.text()));
}

std::vector<Vec3d> pose(const AnimatedMesh& mesh, double time, std::size_t clip = 0) {
  std::vector<Vec3d> positions(mesh.mesh().positions.size());
  mesh.positions(clip, time, positions);
  return positions;
}

void expect_near(const std::vector<Vec3d>& given, const std::vector<Vec3d>& expected,
                 double tolerance = 1e-15) {
  ASSERT_EQ(given.size(), expected.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(given[i][axis], expected[i][axis], tolerance) << i;
  }
}

TEST(Animation, ClipsHaveNamesAndTimes) {
  GltfBuilder gltf = triangle_file();
  add_channel(gltf, 0, 0, "translation", "LINEAR", {0.5, 2}, "VEC3", {0, 0, 0, 1, 0, 0});
  add_channel(gltf, 1, 0, "scale", "STEP", {1}, "VEC3", {2, 2, 2});
  gltf.json["animations"][0]["name"] = "walk";
  const AnimatedMesh mesh = load(gltf);
  ASSERT_EQ(mesh.clips().size(), 2u);
  EXPECT_EQ(mesh.clips()[0].name, "walk");
  EXPECT_EQ(mesh.clips()[0].start, 0.5);
  EXPECT_EQ(mesh.clips()[0].end, 2);
  EXPECT_EQ(mesh.clips()[1].name, "clip 1");
  EXPECT_EQ(pose(mesh, 0, 1)[1], (Vec3d{2, 0, 0}));
  EXPECT_EQ(mesh.mesh().positions[1], (Vec3d{1, 0, 0}));
  std::vector<Vec3d> positions(3);
  EXPECT_NE(error_of([&] { mesh.positions(2, 0, positions); }).find("there is no clip 2"), std::string::npos);
  positions.resize(2);
  EXPECT_NE(error_of([&] { mesh.positions(0, 0, positions); }), "");
  positions.resize(3);
  EXPECT_NE(error_of([&] { mesh.positions(0, std::nan(""), positions); }), "");
}

TEST(Animation, StepsLinesAndSplines) {
  GltfBuilder gltf = triangle_file();
  add_channel(gltf, 0, 0, "translation", "STEP", {0, 1, 2}, "VEC3", {0, 0, 0, 4, 0, 0, 8, 0, 0});
  add_channel(gltf, 1, 0, "translation", "LINEAR", {0, 1, 2}, "VEC3", {0, 0, 0, 4, 0, 0, 8, 8, 0});
  // Keys: tangent in, value, tangent out.
  add_channel(gltf, 2, 0, "translation", "CUBICSPLINE", {0, 2}, "VEC3",
              {9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 3, 0, 2, 0, 0, 9, 9, 9});
  const AnimatedMesh mesh = load(gltf);
  const auto x = [&](double time, std::size_t clip) { return pose(mesh, time, clip)[0]; };
  EXPECT_EQ(x(-1, 0), (Vec3d{0, 0, 0}));
  EXPECT_EQ(x(0.99, 0), (Vec3d{0, 0, 0}));
  EXPECT_EQ(x(1, 0), (Vec3d{4, 0, 0}));
  EXPECT_EQ(x(9, 0), (Vec3d{8, 0, 0}));
  EXPECT_EQ(x(0.25, 1), (Vec3d{1, 0, 0}));
  EXPECT_EQ(x(1.5, 1), (Vec3d{6, 4, 0}));
  EXPECT_EQ(x(2, 1), (Vec3d{8, 8, 0}));
  // Hermite at 1/4: h10 = 9/64, h01 = 10/64, h11 = -3/64, and tangents times 2 s.
  EXPECT_EQ(x(0.5, 2), (Vec3d{2 * 9.0 / 64 + 2 * 10.0 / 64, 2 * 3 * -3.0 / 64, 0}));
  EXPECT_EQ(x(2, 2), (Vec3d{2, 0, 0}));
}

TEST(Animation, RotationsTurnEvenlyOnTheShorterWay) {
  const auto half = static_cast<float>(std::sqrt(0.5));
  for (const float sign : {1.0f, -1.0f}) {
    GltfBuilder gltf = triangle_file();
    // From 0 to 90 degrees about z; a quaternion and its negative are the same rotation.
    add_channel(gltf, 0, 0, "rotation", "LINEAR", {0, 1}, "VEC4",
                {0, 0, 0, 1, 0, 0, sign * half, sign * half});
    const AnimatedMesh mesh = load(gltf);
    for (const double time : {0.0, 0.1, 1.0 / 3, 0.5, 0.9, 1.0}) {
      const double angle = time * pi / 2;
      expect_near(pose(mesh, time),
                  {{0, 0, 0}, {std::cos(angle), std::sin(angle), 0}, {-std::sin(angle), std::cos(angle), 0}},
                  1e-7);
    }
  }
}

TEST(Animation, SmallTurnsAreEven) {
  const double angle = 1e-5;
  GltfBuilder gltf = triangle_file();
  const auto sine = static_cast<float>(std::sin(angle / 2)), cosine = static_cast<float>(std::cos(angle / 2));
  add_channel(gltf, 0, 0, "rotation", "LINEAR", {0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, sine, cosine});
  EXPECT_NEAR(pose(load(gltf), 0.25)[1].y, angle / 4, 1e-12);
}

TEST(Animation, ChildrenFollowTheirParents) {
  GltfBuilder gltf = triangle_file();
  gltf.json["nodes"] = {{{"children", {1}}, {"translation", {1, 2, 3}}}, {{"mesh", 0}, {"scale", {2, 2, 2}}}};
  add_channel(gltf, 0, 0, "translation", "LINEAR", {0, 1}, "VEC3", {1, 2, 3, 5, 2, 3});
  EXPECT_EQ(pose(load(gltf), 0.5), (std::vector<Vec3d>{{3, 2, 3}, {5, 2, 3}, {3, 4, 3}}));
}

TEST(Animation, ClipsOfCamerasAreLeftOut) {
  GltfBuilder gltf = triangle_file();
  gltf.json["nodes"].push_back({{"name", "camera"}});
  gltf.json["scenes"] = {{{"nodes", {0, 1}}}};
  add_channel(gltf, 0, 1, "translation", "LINEAR", {0, 1}, "VEC3", {0, 0, 0, 1, 0, 0});
  EXPECT_TRUE(load(gltf).clips().empty());
  add_channel(gltf, 0, 0, "translation", "LINEAR", {0, 1}, "VEC3", {0, 0, 0, 1, 0, 0});
  EXPECT_EQ(load(gltf).clips().size(), 1u);
}

TEST(Animation, MorphTargets) {
  GltfBuilder gltf = triangle_file();
  gltf.json["meshes"][0]["primitives"][0]["targets"] = {
      {{"POSITION", gltf.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})}},
      {{"POSITION", gltf.add<float>("VEC3", {0, 2, 0, 0, 0, 0, 0, 0, 0})}}};
  add_channel(gltf, 0, 0, "weights", "LINEAR", {0, 1}, "SCALAR", {0, 1, 1, 0});
  EXPECT_EQ(pose(load(gltf), 0.25), (std::vector<Vec3d>{{0, 1.5, 0.25}, {1, 0, 0.25}, {0, 1, 0.25}}));
}

/// A strip whose upper points follow joint 2, which turns about (0, 1, 0).
GltfBuilder bending_strip() {
  GltfBuilder gltf;
  gltf.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                        {{"children", {2}}},
                        {{"translation", {0, 1, 0}}}};
  gltf.json["scenes"] = {{{"nodes", {0, 1}}}};
  const int points = gltf.add<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 2, 0});
  const int joints = gltf.add<std::uint16_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  // Weights of 255ths; the third vertex follows both joints, and its weights do not have the sum 1.
  const int weights =
      gltf.add<std::uint8_t>("VEC4", {255, 0, 0, 0, 255, 0, 0, 0, 100, 100, 0, 0, 255, 0, 0, 0}, true);
  const int indices = gltf.add<std::uint8_t>("SCALAR", {0, 1, 2, 1, 3, 2});
  gltf.json["meshes"] = {
      {{"primitives",
        {{{"attributes", {{"POSITION", points}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
          {"indices", indices}}}}}};
  gltf.json["skins"] = {
      {{"joints", {1, 2}},
       {"inverseBindMatrices", gltf.add<float>("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1})}}};
  return gltf;
}

TEST(Animation, SkinsFollowTheirJoints) {
  GltfBuilder gltf = bending_strip();
  const auto half = static_cast<float>(std::sqrt(0.5));
  add_channel(gltf, 0, 2, "rotation", "LINEAR", {0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, half, half});
  add_channel(gltf, 0, 1, "translation", "LINEAR", {0, 1}, "VEC3", {0, 0, 0, 0, 0, 8});
  const AnimatedMesh mesh = load(gltf);
  EXPECT_EQ(mesh.mesh().positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 2, 0}}));
  for (const double time : {0.0, 0.3, 1.0}) {
    const double angle = time * pi / 2, c = std::cos(angle), s = std::sin(angle);
    expect_near(pose(mesh, time),
                {{0, 0, 8 * time}, {1, 0, 8 * time}, {0, 1, 8 * time}, {c - s, 1 + s + c, 8 * time}}, 1e-7);
  }
}

// Both joints move in the same way, so every vertex does, without rounding.
TEST(Animation, AgreeingJointsAreExact) {
  GltfBuilder gltf = bending_strip();
  add_channel(gltf, 0, 1, "translation", "LINEAR", {0, 1}, "VEC3", {0, 0, 0, 0.1f, 0, 0});
  const AnimatedMesh mesh = load(gltf);
  EXPECT_EQ(pose(mesh, 1)[2], (Vec3d{0.1f, 1, 0}));
}

TEST(Animation, ColladaNodes) {
  const TemporaryFolder folder;
  const AnimatedMesh mesh(folder.write("a.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_animations><animation id="n-move">
<source id="t"><float_array id="ta" count="2">0 2</float_array>
<technique_common><accessor source="#ta" count="2" stride="1"><param name="TIME" type="float"/></accessor></technique_common></source>
<source id="o"><float_array id="oa" count="6">0 0 0 0 0 4</float_array>
<technique_common><accessor source="#oa" count="2" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<sampler id="sm"><input semantic="INPUT" source="#t"/><input semantic="OUTPUT" source="#o"/></sampler>
<channel source="#sm" target="n/move"/></animation></library_animations>
<library_visual_scenes><visual_scene id="w"><node id="n" name="n"><translate sid="move">0 0 0</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene>
</COLLADA>)"));
  ASSERT_EQ(mesh.clips().size(), 1u);
  EXPECT_EQ(mesh.clips()[0].end, 2);
  EXPECT_EQ(pose(mesh, 1), (std::vector<Vec3d>{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}));
  EXPECT_EQ(mesh.frame().up, UpAxis::z);
  EXPECT_EQ(mesh.frame().unit, 0.01);
}

TEST(Animation, OtherFormatsHaveNoClips) {
  const TemporaryFolder folder;
  const AnimatedMesh mesh(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  EXPECT_TRUE(mesh.clips().empty());
  EXPECT_EQ(mesh.mesh().triangles.size(), 1u);
}

TEST(PointCache, BothFormats) {
  const TemporaryFolder folder;
  std::string pc2("POINTCACHE2\0", 12);
  for (const std::uint32_t word : {1u, 2u}) append_scalar(pc2, word);
  append_scalar(pc2, 0.0f);
  append_scalar(pc2, 1.0f);
  append_scalar(pc2, std::uint32_t{3});
  for (int i = 0; i < 18; ++i) append_scalar(pc2, static_cast<float>(i));
  std::string mdd;
  const auto append_big = [&](auto value) {
    std::string bytes;
    append_scalar(bytes, value);
    mdd.append(bytes.rbegin(), bytes.rend());
  };
  for (const std::uint32_t word : {3u, 2u}) append_big(word);
  for (const float time : {0.0f, 0.5f, 1.0f}) append_big(time);
  for (int i = 0; i < 18; ++i) append_big(static_cast<float>(i));

  for (const auto& path : {folder.write("a.pc2", pc2), folder.write("a.mdd", mdd)}) {
    const PointCache cache(path);
    EXPECT_EQ(cache.frame_count(), 3u);
    EXPECT_EQ(cache.vertex_count(), 2u);
    std::vector<Vec3d> positions(2);
    cache.positions(2, positions);
    EXPECT_EQ(positions, (std::vector<Vec3d>{{12, 13, 14}, {15, 16, 17}}));
    EXPECT_NE(error_of([&] { cache.positions(3, positions); }).find("there is no frame 3"),
              std::string::npos);
  }
  pc2.pop_back();
  EXPECT_NE(error_of([&] { PointCache(folder.write("b.pc2", pc2)); }).find("was it written completely?"),
            std::string::npos);
  EXPECT_NE(error_of([&] { PointCache(folder.write("c.pc2", mdd)); }).find("POINTCACHE2"), std::string::npos);
}

/// As `add_channel`, by KHR_animation_pointer.
void add_pointer(GltfBuilder& gltf, const char* pointer, const std::vector<float>& times,
                 const std::string& type, const std::vector<float>& values) {
  add_channel(gltf, 0, 0, "pointer", "LINEAR", times, type, values);
  auto& target = gltf.json["animations"][0]["channels"].back()["target"];
  target.erase("node");
  target["extensions"]["KHR_animation_pointer"]["pointer"] = pointer;
}

TEST(Animation, PointersToNodes) {
  GltfBuilder gltf = triangle_file();
  gltf.json["extensionsRequired"] = {"KHR_animation_pointer"};
  add_pointer(gltf, "/nodes/0/translation", {0, 1}, "VEC3", {0, 0, 0, 4, 0, 0});
  add_pointer(gltf, "/nodes/0/scale", {0, 1}, "VEC3", {1, 1, 1, 3, 1, 1});
  add_pointer(gltf, "/materials/0/pbrMetallicRoughness/baseColorFactor", {0, 9}, "VEC4",
              {0, 0, 0, 0, 1, 1, 1, 1});
  const AnimatedMesh mesh = load(gltf);
  ASSERT_EQ(mesh.clips().size(), 1u);
  EXPECT_EQ(mesh.clips()[0].end, 1);
  expect_near({pose(mesh, 0.5)[1]}, {Vec3d{2 + 2 * triangle[3], triangle[4], triangle[5]}});
}

TEST(Animation, PointersToWeights) {
  for (const char* pointer :
       {"/nodes/0/weights", "/meshes/0/weights", "/nodes/0/weights/1", "/meshes/0/weights/1"}) {
    GltfBuilder gltf = triangle_file();
    gltf.json["meshes"][0]["primitives"][0]["targets"] = {
        {{"POSITION", gltf.add<float>("VEC3", {0, 0, 5, 0, 0, 5, 0, 0, 5})}},
        {{"POSITION", gltf.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})}}};
    gltf.json["meshes"][0]["weights"] = {1, 0};
    const bool is_one = std::string(pointer).ends_with("/1");
    add_pointer(gltf, pointer, {0, 1}, "SCALAR",
                is_one ? std::vector<float>{0, 2} : std::vector<float>{1, 0, 1, 2});
    const AnimatedMesh mesh = load(gltf);
    ASSERT_EQ(mesh.clips().size(), 1u) << pointer;
    EXPECT_EQ(mesh.mesh().positions[0].z, triangle[2] + 5) << pointer;
    EXPECT_EQ(pose(mesh, 0.5)[0].z, triangle[2] + 6) << pointer;
    EXPECT_EQ(pose(mesh, 1)[0].z, triangle[2] + 7) << pointer;
  }
}

}  // namespace supple::animation_test
