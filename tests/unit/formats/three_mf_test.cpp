#include <gtest/gtest.h>
#include <zip.h>

#include <map>
#include <string>

#include "readers.hpp"
#include "supple/formats.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::three_mf_test {

using Parts = std::map<std::string, std::string>;
using Triangles = std::vector<Triangle>;

/// A zip archive with these files, in a folder.
std::string zip(const Parts& parts, const TemporaryFolder& folder) {
  const std::string path = folder / "made.zip";
  std::filesystem::remove(path);
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE, nullptr);
  for (const auto& [name, bytes] : parts) {
    zip_source_t* source = zip_source_buffer(archive, bytes.data(), bytes.size(), 0);
    zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8);
  }
  zip_close(archive);
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

MeshFile read(const Parts& parts) {
  const TemporaryFolder folder;
  return read_3mf(zip(parts, folder), "a.3mf");
}
std::string error(const Parts& parts) {
  return error_of([&] { read(parts); });
}

std::string model(const std::string& objects, const std::string& build, const std::string& attributes = "") {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" "
         "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
         "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" "
         "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\" " +
         attributes + "><resources>" + objects + "</resources><build>" + build + "</build></model>";
}
Parts file(const std::string& objects, const std::string& build, const std::string& attributes = "") {
  return {{"3D/3dmodel.model", model(objects, build, attributes)}};
}

const std::string tetrahedron =
    "<vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" "
    "z=\"0\"/>"
    "<vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/>"
    "<triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/><triangle v1=\"2\" v2=\"0\" "
    "v3=\"3\"/></triangles>";
const std::string object = "<object id=\"1\" type=\"model\"><mesh>" + tetrahedron + "</mesh></object>";
const Triangles triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

TEST(ThreeMf, OtherPartsOfTheArchiveAreIgnored) {
  Parts parts = file(object, "<item objectid=\"1\"/>");
  parts["Metadata/thumbnail.png"] = "\x89PNG";
  parts["[Content_Types].xml"] = "<Types/>";
  const MeshFile read_file = read(parts);
  EXPECT_EQ(read_file.mesh.triangles, triangles);
  EXPECT_EQ(read_file.frame.unit, 0.001);
}

TEST(ThreeMf, TheRelationsNameTheModel) {
  const std::string relations =
      "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
      "<Relationship Target=\"/Metadata/t.png\" Id=\"a\" Type=\"http://x/thumbnail\"/>"
      "<Relationship Target=\"/Other/My%20Model.model\" Id=\"b\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
  Parts parts = {{"_rels/.rels", relations},
                 {"other/my model.MODEL", model(object, "<item objectid=\"1\"/>")}};
  EXPECT_EQ(read(parts).mesh.triangles, triangles);
}

TEST(ThreeMf, ItemsAndComponentsPlaceObjects) {
  const std::string group =
      "<object id=\"2\"><components><component objectid=\"1\" transform=\"2 0 0 0 2 0 0 0 2 10 0 0\"/>"
      "<component objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/></components></object>";
  // A quarter of a turn about z, and up by 5.
  const TriangleMesh mesh =
      read(file(object + group,
                "<item objectid=\"2\" transform=\"0 1 0 -1 0 0 0 0 1 0 0 5\"/><item objectid=\"1\"/>"))
          .mesh;
  ASSERT_EQ(mesh.positions.size(), 12u);
  EXPECT_EQ(mesh.positions[1], (Vec3d{0, 12, 5}));
  EXPECT_EQ(mesh.positions[2], (Vec3d{-2, 10, 5}));
  EXPECT_EQ(mesh.positions[5], (Vec3d{0, -1, 5}));
  EXPECT_EQ(mesh.positions[9], (Vec3d{1, 0, 0}));
  EXPECT_EQ(mesh.triangles[0], (Triangle{0, 2, 1}));
  EXPECT_EQ(mesh.triangles[4], (Triangle{4, 5, 6}));  // mirrored
  EXPECT_EQ(mesh.triangles[8], (Triangle{8, 10, 9}));
}

TEST(ThreeMf, ObjectsInOtherParts) {
  Parts parts = file(
      "<object id=\"2\"><components><component p:path=\"/3D/Objects/a.model\" "
      "objectid=\"1\"/></components></object>",
      "<item objectid=\"2\"/><item p:path=\"/3D/Objects/a.model\" objectid=\"1\"/>",
      "requiredextensions=\"p\"");
  EXPECT_EQ(error(parts), "a.3mf, part '3D/Objects/a.model': the archive does not contain it");
  parts["3D/Objects/a.model"] = model(object, "");
  EXPECT_EQ(read(parts).mesh.triangles.size(), 8u);
  parts["3D/Objects/a.model"].replace(parts["3D/Objects/a.model"].find("millimeter"), 10, "inch");
  EXPECT_EQ(error(parts),
            "a.3mf: part '3D/Objects/a.model' has another unit than the file; save it with one unit");
}

TEST(ThreeMf, NamesMayHavePrefixes) {
  const std::string text =
      "<m:model xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
      "unit=\"inch\"><m:resources><m:object id=\"1\"><m:mesh>"
      "<m:vertices><m:vertex x=\"1\" y=\"2\" z=\"3e0\"/></m:vertices><m:triangles><m:triangle v1=\"0\" "
      "v2=\"0\" v3=\"0\"/></m:triangles></m:mesh>"
      "</m:object></m:resources><m:build><m:item objectid=\"1\"/></m:build></m:model>";
  const MeshFile read_file = read({{"3D/3dmodel.model", text}});
  EXPECT_EQ(read_file.mesh.positions, (std::vector<Vec3d>{{1, 2, 3}}));
  EXPECT_EQ(read_file.frame.unit, 0.0254);
}

TEST(ThreeMf, RequiredExtensionsThatChangeShapesAreErrors) {
  const std::string item = "<item objectid=\"1\"/>";
  EXPECT_EQ(read(file(object, item, "requiredextensions=\" p \"")).mesh.triangles, triangles);
  EXPECT_EQ(error(file(object, item, "requiredextensions=\"p b\"")),
            "a.3mf, part '3D/3dmodel.model', byte 40: the file requires the extension 'b' of 3MF "
            "(http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02), which is not supported; "
            "export the mesh "
            "without it, or as STL");
}

TEST(ThreeMf, SaysWhatIsWrong) {
  EXPECT_EQ(error({{"word/document.xml", ""}}),
            "a.3mf: the zip archive has no 3D model, so it is not a 3MF file");
  EXPECT_TRUE(
      error_of([] { read_3mf("PK\3\4", "a.3mf"); }).starts_with("a.3mf: cannot read the zip archive: "));
  EXPECT_EQ(error(file(object, "")),
            "a.3mf: the build of the file has no items, so no object is placed (it has 1); place them in the "
            "program that wrote "
            "the file");
  EXPECT_EQ(error(file(object, "<item objectid=\"3\"/>")),
            "a.3mf: there is no object '3' in part '3D/3dmodel.model'");
  EXPECT_TRUE(error(file(object, "<item objectid=\"1\" transform=\"1 2 3\"/>"))
                  .ends_with("the transform '1 2 3' has 3 numbers; it needs 12"));
  EXPECT_TRUE(
      error(
          file(
              "<object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"a\" z=\"0\"/></vertices></mesh></object>",
              ""))
          .ends_with("expected a number for y of a vertex, found 'a'"));
  EXPECT_TRUE(
      error(file("<object id=\"1\"><mesh><triangles><triangle v1=\"0\" v2=\"0\" "
                 "v3=\"0\"/></triangles></mesh></object>",
                 ""))
          .ends_with(
              "vertex index 0 of a triangle is out of range; its object has 0 vertices, counted from 0"));
  EXPECT_TRUE(error({{"3D/3dmodel.model", "<model><resources>"}})
                  .starts_with("a.3mf, part '3D/3dmodel.model', byte "));
}

TEST(ThreeMf, ComponentsThatRepeatWithoutEndAreErrors) {
  EXPECT_EQ(error(file("<object id=\"1\"><components><component objectid=\"1\"/></components></object>",
                       "<item objectid=\"1\"/>")),
            "a.3mf: object '1' is nested more than 100 deep; does it contain itself?");
  // Each object has ten of the one before it.
  std::string objects = object;
  for (int id = 2; id <= 12; ++id) {
    objects += "<object id=\"" + std::to_string(id) + "\"><components>";
    for (int i = 0; i < 10; ++i) objects += "<component objectid=\"" + std::to_string(id - 1) + "\"/>";
    objects += "</components></object>";
  }
  EXPECT_EQ(read(file(objects, "<item objectid=\"4\"/>")).mesh.triangles.size(), 4000u);
  EXPECT_EQ(error(file(objects, "<item objectid=\"12\"/>")),
            "a.3mf: its components repeat objects until there are more than 33 million vertices and "
            "triangles; place fewer copies");
}

TEST(ThreeMf, ArchivesThatExpandTooMuchAreErrors) {
  Parts parts = file(object, "<item objectid=\"1\"/>");
  parts["3D/3dmodel.model"].append(24 << 20, ' ');
  EXPECT_EQ(error(parts),
            "a.3mf, part '3D/3dmodel.model': the archive expands to more than 16 MiB and 200 times its size; "
            "compress it less");
}

}  // namespace supple::three_mf_test
