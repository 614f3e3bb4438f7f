#include <draco/compression/encode.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "supple/formats.hpp"
#include "support/random.hpp"
#include "unit/files/mesh_files.hpp"
#include "unit/formats/gltf_builder.hpp"

namespace supple::gltf_test {

const std::vector<float> triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};
const std::vector<Vec3d> triangle_points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// A file whose node 0 shows one primitive.
GltfBuilder shown_primitive(int positions) {
  GltfBuilder gltf;
  gltf.json["nodes"] = {{{"mesh", 0}}};
  gltf.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}}};
  return gltf;
}

TriangleMesh load(const GltfBuilder& gltf) {
  const TemporaryFolder folder;
  return load_any_mesh(folder.write("a.gltf", gltf.text()));
}

std::string error(const GltfBuilder& gltf) {
  return error_of([&] { load(gltf); });
}

template <class Scalar>
void expect_quantized(const std::vector<Scalar>& numbers, bool is_normalized, double expected) {
  GltfBuilder gltf = shown_primitive(0);
  gltf.add("VEC3", numbers, is_normalized);
  gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  EXPECT_EQ(load(gltf).positions, (std::vector<Vec3d>{{0, 0, 0}, {expected, 0, 0}, {0, expected, 0}}));
}

TEST(Gltf, QuantizedPositions) {
  expect_quantized<std::int16_t>({0, 0, 0, 32767, 0, 0, 0, 32767, 0}, true, 1);
  expect_quantized<std::int16_t>({0, 0, 0, -32768, 0, 0, 0, -32768, 0}, true, -1);
  expect_quantized<std::int16_t>({0, 0, 0, 300, 0, 0, 0, 300, 0}, false, 300);
  expect_quantized<std::uint16_t>({0, 0, 0, 13107, 0, 0, 0, 13107, 0}, true, 0.2);
  expect_quantized<std::int8_t>({0, 0, 0, -127, 0, 0, 0, -127, 0}, true, -1);
  expect_quantized<std::uint8_t>({0, 0, 0, 51, 0, 0, 0, 51, 0}, true, 0.2);
  expect_quantized<std::uint8_t>({0, 0, 0, 51, 0, 0, 0, 51, 0}, false, 51);
}

TEST(Gltf, StridesAndOffsets) {
  GltfBuilder gltf = shown_primitive(0);
  gltf.add<std::int16_t>("VEC3", {9, 9, 9, 9, 0, 0, 0, 7, 1, 0, 0, 7, 0, 1, 0, 7});
  gltf.json["accessors"][0]["count"] = 3;
  gltf.json["accessors"][0]["byteOffset"] = 8;
  gltf.json["bufferViews"][0]["byteStride"] = 8;
  EXPECT_EQ(load(gltf).positions, triangle_points);
  gltf.json["accessors"][0]["count"] = 4;
  EXPECT_NE(error(gltf).find("accessors[0]: 4 elements go past the end"), std::string::npos) << error(gltf);
}

TEST(Gltf, SparseAccessors) {
  GltfBuilder gltf = shown_primitive(0);
  gltf.add("VEC3", triangle);
  const int indices = gltf.add<std::uint8_t>("SCALAR", {2});
  const int values = gltf.add<float>("VEC3", {0, 5, 0});
  gltf.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  EXPECT_EQ(load(gltf).positions[2], (Vec3d{0, 5, 0}));
  gltf.json["accessors"][0].erase("bufferView");
  EXPECT_EQ(load(gltf).positions, (std::vector<Vec3d>{{0, 0, 0}, {0, 5, 0}}));
  gltf.json["accessors"][0]["count"] = 4'000'000'000u;
  EXPECT_NE(error(gltf).find("more than the file can hold"), std::string::npos) << error(gltf);
}

TEST(Gltf, UnknownRequiredExtensionsAreNamed) {
  GltfBuilder gltf = shown_primitive(0);
  gltf.add("VEC3", triangle);
  gltf.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_transform", "KHR_technique_webgl"};
  EXPECT_EQ(load(gltf).positions, triangle_points);
  gltf.json["extensionsRequired"] = {"KHR_materials_unlit", "XYZ_curved_triangles"};
  EXPECT_NE(error(gltf).find("requires the extension 'XYZ_curved_triangles'"), std::string::npos)
      << error(gltf);
}

TEST(Gltf, StripsAndFans) {
  GltfBuilder gltf = shown_primitive(0);
  gltf.add<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  auto& primitive = gltf.json["meshes"][0]["primitives"][0];
  primitive["mode"] = 5;
  const TriangleMesh strip = load(gltf);
  EXPECT_EQ(strip.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  double area = 0;
  for (const Triangle& t : strip.triangles) {
    const Vec3d u = strip.positions[t[1]] - strip.positions[t[0]],
                v = strip.positions[t[2]] - strip.positions[t[0]];
    EXPECT_GT(u.x * v.y - u.y * v.x, 0);
    area += (u.x * v.y - u.y * v.x) / 2;
  }
  EXPECT_EQ(area, 1.5);
  primitive["mode"] = 6;
  EXPECT_EQ(load(gltf).triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {3, 4, 2}}));
}

TEST(Gltf, BrokenFilesNameTheirPlace) {
  GltfBuilder gltf = shown_primitive(7);
  gltf.add("VEC3", triangle);
  EXPECT_NE(error(gltf).find("meshes[0].primitives[0].attributes.POSITION: there is no accessor 7"),
            std::string::npos)
      << error(gltf);
  gltf = shown_primitive(0);
  gltf.add("VEC3", triangle);
  gltf.json["meshes"][0]["primitives"][0]["indices"] = gltf.add<std::uint16_t>("SCALAR", {0, 1, 3});
  EXPECT_NE(error(gltf).find("vertex index 3 is out of range"), std::string::npos) << error(gltf);
  gltf.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"children", {0}}}};
  EXPECT_NE(error(gltf), "");
  gltf.json["asset"]["version"] = "1.0";
  EXPECT_NE(error(gltf).find("export it as glTF 2.0"), std::string::npos) << error(gltf);
}

TEST(Gltf, MeshoptCompression) {
  GltfBuilder gltf = shown_primitive(0);
  gltf.add("VEC3", triangle);
  std::string code(meshopt_encodeVertexBufferBound(3, 12), '\0');
  code.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(code.data()), code.size(),
                                         triangle.data(), 3, 12));
  const int compressed = gltf.add_bytes(code);
  gltf.json["bufferViews"][0] = {{"buffer", 1},
                                 {"byteLength", 36},
                                 {"byteStride", 12},
                                 {"extensions",
                                  {{"EXT_meshopt_compression",
                                    {{"buffer", 0},
                                     {"byteOffset", gltf.json["bufferViews"][compressed]["byteOffset"]},
                                     {"byteLength", code.size()},
                                     {"byteStride", 12},
                                     {"count", 3},
                                     {"mode", "ATTRIBUTES"}}}}}};
  gltf.json["buffers"] = {
      {{"byteLength", 36}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  gltf.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  EXPECT_EQ(load(gltf).positions, triangle_points);
  auto& extension = gltf.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
  extension["byteLength"] = code.size() - 1;
  EXPECT_NE(error(gltf).find("EXT_meshopt_compression"), std::string::npos) << error(gltf);
  extension["count"] = 4'000'000'000u;
  EXPECT_NE(error(gltf).find("is not possible for"), std::string::npos) << error(gltf);
}

TEST(Gltf, DracoCompression) {
  draco::Mesh mesh;
  mesh.set_num_points(3);
  draco::GeometryAttribute attribute;
  attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  const int id = mesh.AddAttribute(attribute, true, 3);
  for (std::uint32_t i = 0; i < 3; ++i)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), triangle.data() + 3 * i);
  mesh.AddFace({draco::PointIndex(0), draco::PointIndex(1), draco::PointIndex(2)});
  draco::EncoderBuffer buffer;
  ASSERT_TRUE(draco::Encoder().EncodeMeshToBuffer(mesh, &buffer).ok());

  GltfBuilder gltf = shown_primitive(0);
  const int view = gltf.add_bytes(std::string(buffer.data(), buffer.size()));
  gltf.json["accessors"] = {{{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}};
  gltf.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view}, {"attributes", {{"POSITION", mesh.attribute(id)->unique_id()}}}};
  gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  TriangleMesh loaded = load(gltf);
  ASSERT_EQ(loaded.triangles.size(), 1u);
  std::sort(loaded.positions.begin(), loaded.positions.end(), [](const Vec3d& a, const Vec3d& b) {
    return std::array{a.x, a.y} < std::array{b.x, b.y};
  });
  EXPECT_EQ(loaded.positions, (std::vector<Vec3d>{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}));
  gltf.json["bufferViews"][view]["byteLength"] = buffer.size() - 8;
  EXPECT_NE(error(gltf).find("KHR_draco_mesh_compression"), std::string::npos) << error(gltf);
}

TEST(Gltf, Instances) {
  GltfBuilder gltf = shown_primitive(0);
  gltf.add("VEC3", triangle);
  gltf.json["nodes"][0]["translation"] = {0, 0, 100};
  gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", gltf.add<float>("VEC3", {10, 0, 0, 20, 0, 0})},
      {"SCALE", gltf.add<float>("VEC3", {1, 1, 1, 2, 2, 2})}};
  gltf.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  EXPECT_EQ(load(gltf).positions,
            (std::vector<Vec3d>{
                {10, 0, 100}, {11, 0, 100}, {10, 1, 100}, {20, 0, 100}, {22, 0, 100}, {20, 2, 100}}));
}

TEST(Gltf, ASkinnedMeshFollowsItsJointsAndNotItsNode) {
  GltfBuilder gltf = shown_primitive(0);
  gltf.add("VEC3", triangle);
  auto& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = gltf.add<std::uint8_t>("VEC4", std::vector<std::uint8_t>(12, 0));
  attributes["WEIGHTS_0"] = gltf.add<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  gltf.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {10, 0, 0}}}, {{"name", "joint"}}};
  gltf.json["scenes"] = {{{"nodes", {0, 1}}}};
  gltf.json["skins"] = {{{"joints", {1}}}};
  EXPECT_EQ(load(gltf).positions, triangle_points);
  gltf.json["nodes"][1]["translation"] = {0, 3, 0};
  EXPECT_EQ(load(gltf).positions, (std::vector<Vec3d>{{0, 3, 0}, {1, 3, 0}, {0, 4, 0}}));
  // The bind pose undoes it.
  gltf.json["skins"][0]["inverseBindMatrices"] =
      gltf.add<float>("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -3, 0, 1});
  EXPECT_EQ(load(gltf).positions, triangle_points);
  gltf.json["skins"][0]["joints"] = nlohmann::json::array();
  EXPECT_NE(error(gltf).find("a vertex follows joint 0"), std::string::npos) << error(gltf);
}

TEST(Gltf, MorphTargetsHaveTheirDefaultWeights) {
  GltfBuilder gltf = shown_primitive(0);
  gltf.add("VEC3", triangle);
  gltf.json["meshes"][0]["primitives"][0]["targets"] = {
      {{"POSITION", gltf.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})}}};
  EXPECT_EQ(load(gltf).positions, triangle_points);
  gltf.json["meshes"][0]["weights"] = {0.5};
  EXPECT_EQ(load(gltf).positions, (std::vector<Vec3d>{{0, 0, 0.5}, {1, 0, 0.5}, {0, 1, 0.5}}));
  gltf.json["nodes"][0]["weights"] = {2};
  EXPECT_EQ(load(gltf).positions[0], (Vec3d{0, 0, 2}));
}

// Equal points of other skin weights move apart, so they must stay two vertices.
TEST(Gltf, VerticesWithOtherWeightsAreNotJoined) {
  GltfBuilder gltf = shown_primitive(0);
  gltf.add<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0});
  auto& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = gltf.add<std::uint8_t>("VEC4", std::vector<std::uint8_t>(24, 0));
  std::vector<float> weights(24);
  for (std::size_t i = 0; i < 24; i += 4) weights[i] = 1;
  attributes["WEIGHTS_0"] = gltf.add("VEC4", weights);
  gltf.json["nodes"] = {
      {{"mesh", 0}, {"skin", 0}, {"children", {1, 2}}}, nlohmann::json::object(), nlohmann::json::object()};
  gltf.json["skins"] = {{{"joints", {1, 2}}}};
  EXPECT_EQ(load(gltf).positions.size(), 3u);
  std::vector<std::uint8_t> joints(24);
  joints[12] = 1;
  attributes["JOINTS_0"] = gltf.add("VEC4", joints);
  EXPECT_EQ(load(gltf).positions.size(), 4u);
}

/// A file with a skin, a morph target, an animation, instances and a sparse accessor.
std::string everything() {
  GltfBuilder gltf = shown_primitive(0);
  gltf.add("VEC3", triangle);
  auto& primitive = gltf.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["JOINTS_0"] = gltf.add<std::uint8_t>("VEC4", std::vector<std::uint8_t>(12, 0));
  primitive["attributes"]["WEIGHTS_0"] = gltf.add<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  primitive["targets"] = {{{"POSITION", gltf.add("VEC3", triangle)}}};
  primitive["indices"] = gltf.add<std::uint8_t>("SCALAR", {0, 1, 2});
  gltf.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"children", {1}}}, {{"rotation", {0, 0, 0, 1}}}};
  gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", gltf.add<float>("VEC3", {10, 0, 0, 20, 0, 0})}};
  gltf.json["skins"] = {{{"joints", {1}}}};
  const int times = gltf.add<float>("SCALAR", {0, 1});
  const int values = gltf.add<float>("SCALAR", {0, 1});
  gltf.json["animations"] = {
      {{"samplers", {{{"input", times}, {"output", values}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
  return gltf.text();
}

// Each damaged file is either read or an error.
TEST(Gltf, DamagedFiles) {
  const TemporaryFolder folder;
  const std::string text = everything();
  EXPECT_EQ(load_any_mesh(folder.write("a.gltf", text)).positions.size(), 6u);
  RandomNumbers random(1);
  std::size_t errors = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string damaged = text;
    constexpr std::string_view replacements = "0123456789-.,:[]{}\"ae";
    const auto size = static_cast<std::uint32_t>(damaged.size());
    for (int k = 0; k < 2; ++k)
      damaged[random.below(size)] =
          replacements[random.below(static_cast<std::uint32_t>(replacements.size()))];
    if (i % 4 == 0) damaged.resize(random.below(size));
    const auto path = folder.write("b.gltf", damaged);
    errors += !error_of([&] { check_mesh(load_any_mesh(path)); }).empty();
  }
  EXPECT_GT(errors, 500u);
}

/// A binary file of chunks that are not filled up to a multiple of four bytes.
std::string unpadded_glb(const std::string& json, const std::string& bytes) {
  const auto number = [](std::size_t value) {
    std::string text;
    append_scalar(text, static_cast<std::uint32_t>(value));
    return text;
  };
  return "glTF" + number(2) + number(28 + json.size() + bytes.size()) + number(json.size()) + "JSON" + json +
         number(bytes.size()) + std::string("BIN\0", 4) + bytes;
}

TEST(Gltf, BinaryFilesWithoutPadding) {
  const TemporaryFolder folder;
  std::string points;
  for (const int value : {0, 0, 0, 1, 0, 0, 0, 1, 0}) append_scalar(points, static_cast<float>(value));
  std::string json =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[
{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]})";
  for (int more = 0; more < 4; ++more, json += ' ')
    EXPECT_EQ(load_any_mesh(folder.write("a.glb", unpadded_glb(json, points))).triangles.size(), 1u);
}

TEST(Gltf, Version1IsNamed) {
  const TemporaryFolder folder;
  for (const char* text :
       {R"({"asset":{"version":"1.0"}})", R"({"asset":{"version":1.0},"meshes":{}})",
        R"({"meshes":{"m":{"primitives":[]}},"nodes":{}})", R"({"asset":{},"nodes":{}})"}) {
    const std::string path = folder.write("a.gltf", text);
    EXPECT_EQ(error_of([&] { load_any_mesh(path); }),
              path + ": has version '1.0' of glTF; export it as glTF 2.0");
  }
  const std::string binary = folder.write("a.glb", std::string("glTF\1\0\0\0\14\0\0\0", 12));
  EXPECT_EQ(error_of([&] { load_any_mesh(binary); }),
            binary + ": has version '1.0' of glTF; export it as glTF 2.0");
}

TEST(Gltf, ProjectionsAreNoTransforms) {
  const TemporaryFolder folder;
  const auto message_for = [&](int place, double value) {
    GltfBuilder gltf;
    gltf.json["nodes"] = {{{"mesh", 0}}};
    gltf.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", gltf.add("VEC3", triangle)}}}}}}}};
    std::vector<double> matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1};
    matrix[static_cast<std::size_t>(place)] = value;
    gltf.json["nodes"][0]["matrix"] = matrix;
    const std::string path = folder.write("a.gltf", gltf.text());
    return error_of([&] { load_any_mesh(path); });
  };
  for (const auto& [place, value] :
       {std::pair(3, 0.5), std::pair(7, -1.0), std::pair(11, 1.0), std::pair(15, 2.0)})
    EXPECT_NE(message_for(place, value).find("nodes[0].matrix: the last row of a matrix is not 0 0 0 1"),
              std::string::npos);
  EXPECT_EQ(message_for(15, 1 + 1e-7), "");
}

}  // namespace supple::gltf_test
