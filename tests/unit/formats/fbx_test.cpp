#include <gtest/gtest.h>
#include <ufbx.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "supple/animation.hpp"
#include "unit/files/mesh_files.hpp"

// The reader has a ufbx inside. These tests compare with another one, which they link as a program could.

namespace supple::fbx_test {

constexpr std::int64_t second = 46186158000;  // in the unit of time of FBX

std::string list(const std::vector<double>& numbers) {
  std::string text = "*" + std::to_string(numbers.size()) + " { a: ";
  for (std::size_t i = 0; i < numbers.size(); ++i) text += (i > 0 ? "," : "") + std::to_string(numbers[i]);
  return text + " }\n";
}
std::string whole_list(const std::vector<std::int64_t>& numbers) {
  std::string text = "*" + std::to_string(numbers.size()) + " { a: ";
  for (std::size_t i = 0; i < numbers.size(); ++i) text += (i > 0 ? "," : "") + std::to_string(numbers[i]);
  return text + " }\n";
}

/// Writes a small FBX file as text.
class FbxBuilder {
 public:
  /// Returns the id of the object.
  int add(const std::string& kind, const std::string& name, const std::string& type,
          const std::string& body) {
    const std::string id = std::to_string(++last_id_);
    objects_ += kind + ": " + id + ", \"" + kind + "::" + name + "\", \"" + type + "\" {\n" + body + "}\n";
    return last_id_;
  }
  int add_mesh(const std::vector<double>& points, const std::vector<std::int64_t>& polygons) {
    return add("Geometry", "g", "Mesh",
               "Vertices: " + list(points) + "PolygonVertexIndex: " + whole_list(polygons));
  }
  /// `properties` has lines as `vector` and `number` write them.
  int add_node(const std::string& type, const std::string& properties) {
    return add("Model", "n" + std::to_string(last_id_), type, "Properties70: {\n" + properties + "}\n");
  }
  void connect(int child, int parent, const std::string& property = {}) {
    connections_ += std::string("C: \"") + (property.empty() ? "OO" : "OP") + "\"," + std::to_string(child) +
                    "," + std::to_string(parent) + (property.empty() ? "" : ", \"" + property + "\"") + "\n";
  }
  int add_layer(int stack, const std::string& properties = {}) {
    const int layer = add("AnimationLayer", "l", "", "Properties70: {\n" + properties + "}\n");
    connect(layer, stack);
    return layer;
  }
  int add_stack(const std::string& name) { return add("AnimationStack", name, "", ""); }
  /// Animates one coordinate of a property. `flags` says how keys are joined: 2 by steps, 4 linearly, 264 by
  /// cubic splines with smooth tangents.
  void animate(int layer, int object, const std::string& property, const std::string& coordinate,
               const std::vector<std::int64_t>& times, const std::vector<double>& values, int flags) {
    const int node = add("AnimationCurveNode", "c", "",
                         "Properties70: {\nP: \"d|" + coordinate + "\", \"Number\", \"\", \"A\"," +
                             std::to_string(values[0]) + "\n}\n");
    std::vector<std::int64_t> ticks = times;
    for (std::int64_t& time : ticks) time = time * (second / 10);
    const int curve =
        add("AnimationCurve", "", "",
            "KeyTime: " + whole_list(ticks) + "KeyValueFloat: " + list(values) +
                "KeyAttrFlags: " + whole_list({flags}) + "KeyAttrDataFloat: " + list({0, 0, 0, 0}) +
                "KeyAttrRefCount: " + whole_list({static_cast<std::int64_t>(times.size())}));
    connect(node, layer);
    connect(node, object, property);
    connect(curve, node, "d|" + coordinate);
  }

  std::string text(const std::string& settings = "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",1\n",
                   int version = 7400) const {
    return "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXHeaderVersion: 1003\nFBXVersion: " +
           std::to_string(version) + "\n}\nGlobalSettings: {\nVersion: 1000\nProperties70: {\n" + settings +
           "}\n}\nObjects: {\n" + objects_ + "}\nConnections: {\n" + connections_ + "}\n";
  }

 private:
  int last_id_ = 0;
  std::string objects_, connections_;
};

std::string vector(const std::string& name, double x, double y, double z) {
  return "P: \"" + name + "\", \"" + name + "\", \"\", \"A\"," + std::to_string(x) + "," + std::to_string(y) +
         "," + std::to_string(z) + "\n";
}
std::string number(const std::string& name, const std::string& type, int value) {
  return "P: \"" + name + "\", \"" + type + "\", \"\", \"\"," + std::to_string(value) + "\n";
}

const std::vector<double> triangle_points = {0, 0, 0, 2, 0, 0, 0, 1, 0};
const std::vector<std::int64_t> one_triangle = {0, 1, -3};

/// A triangle at a node with these properties. Its mesh is object 1, its node object 2.
FbxBuilder triangle_at(const std::string& properties) {
  FbxBuilder fbx;
  fbx.add_mesh(triangle_points, one_triangle);
  fbx.add_node("Mesh", properties);
  fbx.connect(2, 0);
  fbx.connect(1, 2);
  return fbx;
}

AnimatedMesh load(const FbxBuilder& fbx) {
  const TemporaryFolder folder;
  return AnimatedMesh(folder.write("a.fbx", fbx.text()));
}

std::vector<Vec3d> pose(const AnimatedMesh& mesh, double time, std::size_t clip = 0) {
  std::vector<Vec3d> positions(mesh.mesh().positions.size());
  mesh.positions(clip, time, positions);
  return positions;
}

void expect_near(const Vec3d& found, const Vec3d& expected) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[axis], expected[axis], 1e-12) << axis;
}

/// The positions by ufbx alone, of each mesh in the order of its nodes.
std::vector<Vec3d> positions_of(const ufbx_scene& scene) {
  std::vector<Vec3d> result;
  std::vector<const ufbx_node*> stack = {scene.root_node};
  while (!stack.empty()) {
    const ufbx_node& node = *stack.back();
    stack.pop_back();
    for (std::size_t i = node.children.count; i-- > 0;) stack.push_back(node.children.data[i]);
    if (node.mesh == nullptr) continue;
    for (std::size_t i = 0; i < node.mesh->num_vertices; ++i) {
      ufbx_vec3 p = node.mesh->skinned_position.values.data[i];
      if (node.mesh->skinned_is_local) p = ufbx_transform_position(&node.geometry_to_world, p);
      result.push_back({p.x, p.y, p.z});
    }
  }
  return result;
}

/// Compares the pose at rest and poses between and at the keys of each clip with those of ufbx.
void expect_what_ufbx_evaluates(const FbxBuilder& fbx) {
  const AnimatedMesh mesh = load(fbx);
  const std::string text = fbx.text();
  ufbx_load_opts options{};
  options.evaluate_skinning = true;
  ufbx_scene* scene = ufbx_load_memory(text.data(), text.size(), &options, nullptr);
  ASSERT_NE(scene, nullptr);
  const auto expect_same = [](const std::vector<Vec3d>& found, const std::vector<Vec3d>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) expect_near(found[i], expected[i]);
  };
  expect_same(mesh.mesh().positions, positions_of(*scene));
  for (std::size_t clip = 0; clip < mesh.clips().size(); ++clip) {
    const AnimationClip& range = mesh.clips()[clip];
    ufbx_evaluate_opts evaluation{};
    evaluation.evaluate_skinning = true;
    for (int k = 0; k <= 10; ++k) {
      const double time = range.start + (range.end - range.start) * k / 10;
      ufbx_scene* posed =
          ufbx_evaluate_scene(scene, scene->anim_stacks.data[clip]->anim, time, &evaluation, nullptr);
      expect_same(pose(mesh, time, clip), positions_of(*posed));
      ufbx_free_scene(posed);
    }
  }
  ufbx_free_scene(scene);
}

TEST(Fbx, VerticesKeepTheirIdsAndPolygonsAreCut) {
  FbxBuilder fbx;
  // Vertex 4 is unused; the polygon is concave at its last corner, and a line follows.
  fbx.add_mesh({0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 0, 9, 9, 9}, {0, 1, 3, -3, 0, -2});
  fbx.add_node("Mesh", vector("Lcl Translation", 0, 0, 7));
  fbx.connect(2, 0);
  fbx.connect(1, 2);
  const AnimatedMesh mesh = load(fbx);
  EXPECT_EQ(mesh.mesh().positions,
            (std::vector<Vec3d>{{0, 0, 7}, {4, 0, 7}, {0, 4, 7}, {1, 1, 7}, {9, 9, 16}}));
  EXPECT_EQ(mesh.mesh().triangles, (std::vector<Triangle>{{0, 1, 3}, {0, 3, 2}}));
  EXPECT_EQ(mesh.mesh().polygons.quads, 1u);
  EXPECT_EQ(mesh.mesh().polygons.concave, 1u);
  EXPECT_TRUE(mesh.mesh().edges.empty());
  EXPECT_TRUE(mesh.clips().empty());
}

TEST(Fbx, InstancesAndMirrors) {
  FbxBuilder fbx = triangle_at("");
  const int mirrored = fbx.add_node("Mesh", vector("Lcl Scaling", -1, 1, 1));
  fbx.connect(mirrored, 2);
  fbx.connect(1, mirrored);
  const AnimatedMesh mesh = load(fbx);
  ASSERT_EQ(mesh.mesh().positions.size(), 6u);
  EXPECT_EQ(mesh.mesh().positions[4], (Vec3d{-2, 0, 0}));
  EXPECT_EQ(mesh.mesh().triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 5, 4}}));
  expect_what_ufbx_evaluates(fbx);
}

TEST(Fbx, StatesAxesAndUnit) {
  const TemporaryFolder folder;
  const FbxBuilder fbx = triangle_at("");
  const auto frame = [&](const std::string& settings) {
    return read_mesh_file(folder.write("a.fbx", fbx.text(settings))).frame;
  };
  const CoordinateFrame inches = frame(number("UpAxis", "int", 2) + number("UpAxisSign", "int", 1) +
                                       number("FrontAxis", "int", 1) + number("FrontAxisSign", "int", -1) +
                                       number("CoordAxis", "int", 0) + number("CoordAxisSign", "int", 1) +
                                       "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",2.54\n");
  EXPECT_EQ(inches.up, UpAxis::z);
  EXPECT_EQ(inches.unit, 0.0254);
  EXPECT_EQ(frame("").up, UpAxis::file);
  EXPECT_EQ(frame("").unit, 0);
}

TEST(Fbx, ConstantCurvesGiveThePoseAtRest) {
  FbxBuilder fbx = triangle_at(number("RotationActive", "bool", 1) + vector("PreRotation", 0, 0, 90));
  const int layer = fbx.add_layer(fbx.add_stack("turn"));
  fbx.animate(layer, 2, "Lcl Rotation", "X", {0, 10}, {0, 0}, 264);
  const AnimatedMesh mesh = load(fbx);
  ASSERT_EQ(mesh.clips().size(), 1u);
  EXPECT_EQ(mesh.clips()[0].name, "turn");
  expect_near(mesh.mesh().positions[1], {0, 2, 0});
  for (const double time : {0.0, 0.5, 1.0}) expect_near(pose(mesh, time)[1], {0, 2, 0});
  expect_what_ufbx_evaluates(fbx);
}

TEST(Fbx, KeysJoinAsTheFileSays) {
  const auto corner = [](int flags, double time) {
    FbxBuilder fbx = triangle_at("");
    const int layer = fbx.add_layer(fbx.add_stack("move"));
    fbx.animate(layer, 2, "Lcl Translation", "X", {0, 10, 20}, {0, 10, 0}, flags);
    expect_what_ufbx_evaluates(fbx);
    const AnimatedMesh mesh = load(fbx);
    EXPECT_EQ(mesh.clips()[0].start, 0);
    EXPECT_EQ(mesh.clips()[0].end, 2);
    return pose(mesh, time)[1].x;
  };
  EXPECT_EQ(corner(2, 0.5), 2);               // by steps
  EXPECT_EQ(corner(4, 0.5), 7);               // linearly
  EXPECT_NEAR(corner(264, 0.5), 8.25, 1e-5);  // a cubic spline
  for (const int flags : {2, 4, 264}) {
    EXPECT_EQ(corner(flags, -7), 2);
    EXPECT_EQ(corner(flags, 9), 2);
  }
}

TEST(Fbx, LayersAndSeveralClips) {
  FbxBuilder fbx = triangle_at(number("RotationOrder", "enum", 3) + vector("RotationPivot", 1, 0, 0));
  const int first = fbx.add_stack("first"), second_stack = fbx.add_stack("second");
  const int base = fbx.add_layer(first);
  // Adds half of its values.
  const int added = fbx.add_layer(first, "P: \"Weight\", \"Number\", \"\", \"A\",50\n");
  fbx.animate(base, 2, "Lcl Translation", "Y", {0, 10}, {0, 4}, 4);
  fbx.animate(base, 2, "Lcl Rotation", "Z", {0, 10}, {0, 170}, 264);
  fbx.animate(base, 2, "Lcl Rotation", "Y", {0, 10}, {0, 70}, 264);
  fbx.animate(added, 2, "Lcl Translation", "Y", {0, 10}, {0, 2}, 4);
  fbx.animate(fbx.add_layer(second_stack), 2, "Lcl Scaling", "X", {5, 10}, {1, 3}, 4);
  const AnimatedMesh mesh = load(fbx);
  ASSERT_EQ(mesh.clips().size(), 2u);
  EXPECT_EQ(mesh.clips()[1].name, "second");
  EXPECT_EQ(mesh.clips()[1].start, 0.5);
  EXPECT_NEAR(pose(mesh, 0.75, 1)[1].x - pose(mesh, 0.75, 1)[0].x, 4, 1e-12);
  expect_what_ufbx_evaluates(fbx);
}

TEST(Fbx, InheritedScale) {
  for (const auto& [type, x] : {std::pair(0, 9.0), std::pair(1, 9.0), std::pair(2, 5.0)}) {
    FbxBuilder fbx = triangle_at(number("InheritType", "enum", type) + vector("Lcl Translation", 1, 0, 0));
    const int parent = fbx.add_node("Null", vector("Lcl Scaling", 3, 3, 3));
    FbxBuilder nested = fbx;
    nested.connect(parent, 0);
    nested.connect(2, parent);
    expect_what_ufbx_evaluates(nested);
    EXPECT_EQ(load(nested).mesh().positions[1].x, x) << type;
  }
}

/// A triangle whose corner 2 goes up by 4 where the channel has 100 percent, and through another shape at 50.
FbxBuilder shapes(double percent, bool has_between) {
  FbxBuilder fbx = triangle_at("");
  const int deformer = fbx.add("Deformer", "b", "BlendShape", "Version: 100\n");
  const int channel = fbx.add(
      "Deformer", "c", "BlendShapeChannel",
      "Version: 100\nDeformPercent: " + std::to_string(percent) +
          "\nFullWeights: " + list(has_between ? std::vector<double>{50, 100} : std::vector<double>{100}));
  fbx.connect(deformer, 1);
  fbx.connect(channel, deformer);
  for (const double height : has_between ? std::vector<double>{-6, 4} : std::vector<double>{4})
    fbx.connect(fbx.add("Geometry", "s", "Shape",
                        "Version: 100\nIndexes: " + whole_list({2}) + "Vertices: " + list({0, height, 0})),
                channel);
  fbx.animate(fbx.add_layer(fbx.add_stack("grow")), channel, "DeformPercent", "DeformPercent", {0, 10},
              {0, 100}, 4);
  return fbx;
}

TEST(Fbx, ShapesHaveTheirDefaultWeightsAndShapesBetween) {
  EXPECT_EQ(load(shapes(100, false)).mesh().positions[2].y, 5);
  EXPECT_EQ(load(shapes(25, false)).mesh().positions[2].y, 2);
  EXPECT_EQ(load(shapes(25, true)).mesh().positions[2].y, -2);
  const AnimatedMesh mesh = load(shapes(0, true));
  ASSERT_EQ(mesh.clips().size(), 1u);
  EXPECT_NEAR(pose(mesh, 0.5)[2].y, -5, 1e-12);
  EXPECT_NEAR(pose(mesh, 0.75)[2].y, 0, 1e-12);
  for (const bool has_between : {false, true}) expect_what_ufbx_evaluates(shapes(40, has_between));
}

TEST(Fbx, SkinsAndGeometricTransforms) {
  for (const char* method : {"", "SkinningType: \"DualQuaternion\"\n"}) {
    FbxBuilder fbx = triangle_at(vector("GeometricTranslation", 0, 0, 3) +
                                 vector("Lcl Translation", 5, 0, 0) + vector("GeometricRotation", 30, 0, 0));
    const int skin = fbx.add("Deformer", "s", "Skin", std::string("Version: 101\n") + method);
    fbx.connect(skin, 1);
    const int layer = fbx.add_layer(fbx.add_stack("bend"));
    for (int bone = 0; bone < 2; ++bone) {
      const int node = fbx.add_node("LimbNode", vector("Lcl Translation", bone, 0, 0));
      const std::vector<double> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1.0 * bone, 0, 0, 1};
      std::vector<double> inverse = identity;
      inverse[12] = bone;
      const int cluster =
          fbx.add("Deformer", "c", "Cluster",
                  "Version: 100\nIndexes: " + whole_list({0, 1}) + "Weights: " +
                      list(bone == 0 ? std::vector<double>{0.75, 0.5} : std::vector<double>{0.25, 0.5}) +
                      "Transform: " + list(identity) + "TransformLink: " + list(inverse));
      fbx.connect(node, 0);
      fbx.connect(cluster, skin);
      fbx.connect(node, cluster);
      fbx.animate(layer, node, "Lcl Rotation", "Z", {0, 10}, {0, bone * 100 + 40.0}, 264);
    }
    expect_what_ufbx_evaluates(fbx);
    // Corner 2 has no weight: it follows the node of the mesh.
    const AnimatedMesh mesh = load(fbx);
    EXPECT_NEAR(pose(mesh, 1)[2].x, 5, 1e-12);
    EXPECT_GT(std::fabs(pose(mesh, 1)[1].y - pose(mesh, 0)[1].y), 0.5);
  }
}

TEST(Fbx, AnimationsOfOtherThingsAreNoClips) {
  FbxBuilder fbx = triangle_at("");
  const int other = fbx.add_node("Camera", "");
  fbx.connect(other, 0);
  fbx.animate(fbx.add_layer(fbx.add_stack("camera")), other, "Lcl Translation", "X", {0, 10}, {0, 1}, 4);
  fbx.add_stack("empty");
  EXPECT_TRUE(load(fbx).clips().empty());
}

TEST(Fbx, Version6100IsRead) {
  const TemporaryFolder folder;
  const std::string text = R"(; FBX 6.1.0 project file
FBXHeaderExtension: {
  FBXHeaderVersion: 1003
  FBXVersion: 6100
}
Objects: {
  Model: "Model::n", "Mesh" {
    Version: 232
    Properties60: {
      Property: "Lcl Translation", "Lcl Translation", "A+",1,2,3
    }
    Vertices: 0,0,0,2,0,0,0,1,0
    PolygonVertexIndex: 0,1,-3
    GeometryVersion: 124
  }
}
Connections: {
  Connect: "OO", "Model::n", "Model::Scene"
}
Takes: {
  Current: "Take 001"
  Take: "Take 001" {
    FileName: "Take_001.tak"
    LocalTime: 0,46186158000
    ReferenceTime: 0,46186158000
    Model: "Model::n" {
      Version: 1.1
      Channel: "Transform" {
        Channel: "T" {
          Channel: "X" {
            Default: 1
            KeyVer: 4005
            KeyCount: 2
            Key: 0,1,L,46186158000,5,L
          }
        }
      }
    }
  }
}
)";
  const AnimatedMesh mesh(folder.write("a.fbx", text));
  EXPECT_EQ(mesh.mesh().positions, (std::vector<Vec3d>{{1, 2, 3}, {3, 2, 3}, {1, 3, 3}}));
  ASSERT_EQ(mesh.clips().size(), 1u);
  EXPECT_NEAR(pose(mesh, 0.5)[0].x, 3, 1e-12);
}

TEST(Fbx, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  const auto message_for = [&](const std::string& text) {
    return error_of([&] { load_any_mesh(folder.write("a.fbx", text)); });
  };
  const std::string text = triangle_at("").text();
  for (const std::string& broken : {std::string("; FBX "), text.substr(0, text.size() / 2),
                                    std::string("Kaydara FBX Binary  \0\x1a\0\0\0", 23)}) {
    const std::string message = message_for(broken);
    EXPECT_NE(message.find("cannot read "), std::string::npos) << message;
    EXPECT_NE(message.find("a.fbx: "), std::string::npos) << message;
  }
  FbxBuilder fbx;
  fbx.add_mesh(triangle_points, {0, 1, -9});
  fbx.add_node("Mesh", "");
  fbx.connect(2, 0);
  fbx.connect(1, 2);
  EXPECT_NE(message_for(fbx.text()).find("a.fbx: its content is damaged, or an index is out of range; is"),
            std::string::npos)
      << message_for(fbx.text());
  EXPECT_FALSE(is_read_by_assimp("a.fbx"));
}

}  // namespace supple::fbx_test
