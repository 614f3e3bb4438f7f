#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "files/byte_order.hpp"
#include "supple/formats.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::coordinates_test {

const std::vector<Vec3d> points = {{0, 0, 5}, {1, 0, 5}, {0, 1, 5}};

std::string collada(const std::string& asset) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>)" +
         asset + R"(</asset>
<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="9">0 0 5 1 0 5 0 1 5</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene>
</COLLADA>)";
}

MeshFile read(const std::string& name, const std::string& bytes) {
  const TemporaryFolder folder;
  return read_mesh_file(folder.write(name, bytes));
}

TEST(Coordinates, ColladaKeepsItsAxesAndUnit) {
  const std::pair<const char*, UpAxis> axes[] = {
      {"", UpAxis::y}, {"X_UP", UpAxis::x}, {"Y_UP", UpAxis::y}, {"Z_UP", UpAxis::z}};
  const std::pair<const char*, double> units[] = {
      {"", 1}, {"0.01", 0.01}, {"0.0254", 0.0254}, {"1", 1}, {"1000", 1000}};
  for (const auto& [axis, up] : axes) {
    for (const auto& [metres, unit] : units) {
      std::string asset;
      if (*metres != '\0') asset += std::string("<unit name=\"u\" meter=\"") + metres + "\"/>";
      if (*axis != '\0') asset += std::string("<up_axis>") + axis + "</up_axis>";
      const MeshFile file = read("a.dae", collada(asset));
      EXPECT_EQ(file.mesh.positions, points) << asset;
      EXPECT_EQ(file.frame.up, up) << asset;
      EXPECT_EQ(file.frame.unit, unit) << asset;
    }
  }
}

/// A chunk of a 3DS file.
std::string chunk(std::uint16_t id, const std::string& content) {
  std::string bytes;
  append_scalar(bytes, id);
  append_scalar(bytes, static_cast<std::uint32_t>(6 + content.size()));
  return bytes + content;
}

TEST(Coordinates, A3dsFileKeepsItsAxesAndItsScale) {
  std::string vertices, faces, scale;
  append_scalar(vertices, std::uint16_t{3});
  for (const Vec3d& p : points) {
    for (int axis = 0; axis < 3; ++axis) append_scalar(vertices, static_cast<float>(p[axis]));
  }
  append_scalar(faces, std::uint16_t{1});
  for (const int id : {0, 1, 2, 0}) append_scalar(faces, static_cast<std::uint16_t>(id));
  append_scalar(scale, 25.4f);
  const std::string object =
      std::string("part\0", 5) + chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4120, faces));
  const MeshFile file =
      read("a.3ds", chunk(0x4d4d, chunk(0x3d3d, chunk(0x0100, scale) + chunk(0x4000, object))));
  EXPECT_EQ(file.mesh.positions, points);
  EXPECT_EQ(file.frame.up, UpAxis::z);
  EXPECT_EQ(file.frame.unit, 0);
}

// DirectX files have left-handed axes, and clockwise triangles seen from outside: with the coordinates as
// they are, these are counter-clockwise.
TEST(Coordinates, DirectXKeepsItsCoordinates) {
  const MeshFile file =
      read("a.x", "xof 0303txt 0032\nMesh m {\n3;\n0;0;5;,\n1;0;5;,\n0;1;5;;\n1;\n3;0,1,2;;\n}\n");
  EXPECT_EQ(file.mesh.positions, points);
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

std::string fbx(int up, double unit) {
  return R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7300
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UpAxis", "int", "Integer", "",)" +
         std::to_string(up) + R"(
		P: "UpAxisSign", "int", "Integer", "",1
		P: "UnitScaleFactor", "double", "Number", "",)" +
         std::to_string(unit) + R"(
	}
}
Objects:  {
	Geometry: 1, "Geometry::g", "Mesh" {
		Vertices: *9 {
			a: 0,0,5,1,0,5,0,1,5
		}
		PolygonVertexIndex: *3 {
			a: 0,1,-3
		}
		GeometryVersion: 124
	}
	Model: 2, "Model::m", "Mesh" {
		Version: 232
	}
}
Connections:  {
	C: "OO",2,0
	C: "OO",1,2
}
)";
}

TEST(Coordinates, FbxKeepsItsAxesAndUnit) {
  const MeshFile file = read("a.fbx", fbx(2, 2.54));
  EXPECT_EQ(file.mesh.positions, points);
  EXPECT_EQ(file.frame.up, UpAxis::z);
  EXPECT_EQ(file.frame.unit, 0.0254);
  EXPECT_EQ(read("a.fbx", fbx(1, 1)).frame.up, UpAxis::y);
  EXPECT_EQ(read("a.fbx", fbx(1, 1)).frame.unit, 0.01);
}

TEST(Coordinates, ConversionOnRequest) {
  const auto converted = [](CoordinateFrame frame, CoordinateConversion wanted) {
    std::vector<Vec3d> positions = {{1, 2, 3}};
    convert(positions, frame, wanted);
    return positions[0];
  };
  EXPECT_EQ(converted({UpAxis::y, 0}, {UpAxis::z, {}}), (Vec3d{1, -3, 2}));
  EXPECT_EQ(converted({UpAxis::z, 0}, {UpAxis::y, {}}), (Vec3d{1, 3, -2}));
  EXPECT_EQ(converted({UpAxis::x, 0}, {UpAxis::y, {}}), (Vec3d{-2, 1, 3}));
  EXPECT_EQ(converted({UpAxis::z, 0}, {UpAxis::z, {}}), (Vec3d{1, 2, 3}));
  EXPECT_EQ(converted({UpAxis::file, 0.01}, {UpAxis::z, LengthUnit::mm}), (Vec3d{10, 20, 30}));
  EXPECT_EQ(converted({UpAxis::y, 0.0254}, {{}, LengthUnit::in}), (Vec3d{1, 2, 3}));
  EXPECT_EQ(converted({UpAxis::y, 0}, {{}, LengthUnit::m}), (Vec3d{1, 2, 3}));
  // There and back, and the same point by either way.
  for (const UpAxis from : {UpAxis::x, UpAxis::y, UpAxis::z}) {
    for (const UpAxis to : {UpAxis::x, UpAxis::y, UpAxis::z}) {
      std::vector<Vec3d> positions = {{1, 2, 3}};
      convert(positions, {from, 0}, {to, {}});
      const int up_before = static_cast<int>(from) - 1, up_after = static_cast<int>(to) - 1;
      EXPECT_EQ(positions[0][up_after], (Vec3d{1, 2, 3})[up_before]);
      convert(positions, {to, 0}, {from, {}});
      EXPECT_EQ(positions[0], (Vec3d{1, 2, 3}));
    }
  }
  EXPECT_TRUE(can_convert({UpAxis::y, 0}, {UpAxis::z, {}}));
  EXPECT_FALSE(can_convert({UpAxis::y, 0}, {{}, LengthUnit::m}));
  EXPECT_FALSE(can_convert({}, {UpAxis::z, LengthUnit::m}));
}

}  // namespace supple::coordinates_test
