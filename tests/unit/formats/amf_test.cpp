#include <gtest/gtest.h>
#include <zip.h>

#include <string>
#include <vector>

#include "supple/formats.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::amf_test {

std::string vertex(int x, int y, int z) {
  return "<vertex><coordinates><x> " + std::to_string(x) + " </x><y>" + std::to_string(y) + "</y><z>" +
         std::to_string(z) + "</z></coordinates></vertex>\n";
}
std::string triangle(int a, int b, int c) {
  return "<triangle><v1>" + std::to_string(a) + "</v1><v2>" + std::to_string(b) + "</v2><v3>" +
         std::to_string(c) + "</v3></triangle>\n";
}
/// A triangle in two volumes, which turn around each other.
std::string object(const std::string& id) {
  return "<object id=\"" + id + "\"><metadata type=\"name\">x</metadata><mesh><vertices>\n" +
         vertex(0, 0, 0) + vertex(1, 0, 0) + vertex(0, 1, 0) + "</vertices><volume>" + triangle(0, 1, 2) +
         "</volume><volume materialid=\"2\">" + triangle(0, 2, 1) + "</volume></mesh></object>\n";
}
std::string amf(const std::string& content, const std::string& unit = "inch") {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<amf unit=\"" + unit + "\">\n" + content + "</amf>\n";
}
std::string instance(const std::string& id, const std::string& places) {
  return "<instance objectid=\"" + id + "\">" + places + "</instance>";
}

TEST(Amf, AllVolumesOfAllObjects) {
  const TemporaryFolder folder;
  const MeshFile file = read_mesh_file(folder.write("a.amf", amf(object("1") + object("7"))));
  EXPECT_EQ(file.frame.unit, 0.0254);
  EXPECT_EQ(file.frame.up, UpAxis::file);
  EXPECT_EQ(file.mesh.positions.size(), 6u);
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 1}, {3, 4, 5}, {3, 5, 4}}));
  EXPECT_FALSE(is_read_by_assimp("a.amf"));
}

TEST(Amf, InstancesTurnAndMove) {
  const TemporaryFolder folder;
  const auto corner = [&](const std::string& places) {
    return load_any_mesh(folder.write("a.amf", amf(object("1") + "<constellation id=\"2\">" +
                                                   instance("1", places) + "</constellation>")))
        .positions;
  };
  EXPECT_EQ(corner("")[1], (Vec3d{1, 0, 0}));
  EXPECT_EQ(corner("<deltax>5</deltax><rz>90</rz>"), (std::vector<Vec3d>{{5, 0, 0}, {5, 1, 0}, {4, 0, 0}}));
  EXPECT_EQ(corner("<deltaz>-2</deltaz><rx>90</rx>"),
            (std::vector<Vec3d>{{0, 0, -2}, {1, 0, -2}, {0, 0, -1}}));
  // About x first: (0, 1, 0) goes to (0, 0, 1), and about y to (1, 0, 0).
  EXPECT_EQ(corner("<rx>90</rx><ry>90</ry>")[2], (Vec3d{1, 0, 0}));
}

TEST(Amf, ConstellationsPlaceConstellations) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = load_any_mesh(folder.write(
      "a.amf", amf("<constellation id=\"3\">" + instance("2", "<deltay>10</deltay><rz>180</rz>") +
                   instance("1", "") + "</constellation>" + object("1") + "<constellation id=\"2\">" +
                   instance("1", "<deltax>1</deltax>") + "</constellation>" + object("4"))));
  ASSERT_EQ(mesh.positions.size(), 9u);
  EXPECT_EQ(mesh.positions[1], (Vec3d{-2, 10, 0}));
  EXPECT_EQ(mesh.positions[4], (Vec3d{1, 0, 0}));
  EXPECT_EQ(mesh.positions[7], (Vec3d{1, 0, 0}));  // of an object that nothing places
}

TEST(Amf, ArchivesAndUtf16) {
  const TemporaryFolder folder;
  const std::string text = amf(object("1"));
  std::string changed = text, wide = "\xFF\xFE";
  changed.replace(changed.find("utf-8"), 5, "utf-16");
  for (const char c : changed) wide += {c, '\0'};
  EXPECT_EQ(load_any_mesh(folder.write("a.amf", wide)).triangles.size(), 2u);

  const std::string path = folder.write("b.amf", "");
  int error = 0;
  zip_t* archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
  ASSERT_NE(archive, nullptr);
  zip_file_add(archive, "Part.AMF", zip_source_buffer(archive, text.data(), text.size(), 0), 0);
  ASSERT_EQ(zip_close(archive), 0);
  EXPECT_EQ(load_any_mesh(path).triangles.size(), 2u);
}

TEST(Amf, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& text, const char* part) {
    const std::string path = folder.write("a.amf", text);
    const std::string message = error_of([&] { load_any_mesh(path); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find(path), std::string::npos) << message;
  };
  const auto with = [](const std::string& part, const std::string& other) {
    std::string text = amf(object("1"));
    return text.replace(text.find(part), part.size(), other);
  };
  expect("<amf", ", byte ");
  expect("<nothing/>", "this is no AMF");
  expect(amf("", "league"), "unknown unit 'league'");
  expect(with("<x> 1 </x>", "<x>one</x>"), "expected a number for x, found 'one'");
  expect(with("<v2>1</v2>", "<v2>3</v2>"), "vertex index 3 of a triangle is out of range; its mesh has 3");
  expect(with("<v2>1</v2>", ""), "expected an integer for v2 of a triangle, found ''");
  expect(amf(object("1") + object("1")), "two objects have the id '1'");
  expect(amf("<constellation id=\"1\">" + instance("5", "") + "</constellation>"), "there is no object '5'");
  expect(amf("<constellation id=\"1\">" + instance("1", "") + "</constellation>"), "contain each other");
  std::string tower = object("0");
  for (int i = 1; i < 40; ++i) {
    tower += "<constellation id=\"" + std::to_string(i) + "\">";
    for (int k = 0; k < 8; ++k) tower += instance(std::to_string(i - 1), "<deltax>1</deltax>");
    tower += "</constellation>";
  }
  expect(amf(tower), "more than 33 million");
}

}  // namespace supple::amf_test
