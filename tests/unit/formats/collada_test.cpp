#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "assimp/collada_text.hpp"
#include "supple/formats.hpp"
#include "unit/files/mesh_files.hpp"

namespace supple::collada_test {

/// A triangle whose array and accessor have these attributes.
std::string collada(const std::string& array, const std::string& accessor,
                    const std::string& color = "1 0 0 1") {
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1" name="m"/><up_axis> Z_UP </up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><phong><emission><color>)" +
         color + R"(</color></emission></phong></technique></profile_COMMON></effect></library_effects>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" )" +
         array + R"(>0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#pa" )" + accessor +
         R"(><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

const std::vector<Vec3d> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

TEST(Collada, BlanksAroundNumbersAreAllowed) {
  const TemporaryFolder folder;
  for (const char* color : {"1 0 0 1", " 1 0 0 1", "\n 1 0 0 1 \n"}) {
    const MeshFile file =
        read_mesh_file(folder.write("a.dae", collada("count=\"9\"", "count=\"3\" stride=\"3\"", color)));
    EXPECT_EQ(file.mesh.positions, points);
    EXPECT_EQ(file.frame.up, UpAxis::z);
    EXPECT_EQ(file.frame.unit, 1);
  }
}

TEST(Collada, Utf16IsRead) {
  const TemporaryFolder folder;
  std::string text = collada("count=\"9\"", "count=\"3\" stride=\"3\"");
  text.replace(text.find("utf-8"), 5, "utf-16");
  std::string wide = "\xFE\xFF";
  for (const char c : text) wide += {'\0', c};
  EXPECT_EQ(load_any_mesh(folder.write("a.dae", wide)).positions, points);
}

TEST(Collada, OtherXmlInUtf16IsRead) {
  const TemporaryFolder folder;
  const std::string text =
      "<?xml version=\"1.0\" encoding=\"utf-16\"?><X3D profile=\"Interchange\" version=\"3.0\"><Scene><Shape>"
      "<IndexedFaceSet coordIndex=\"0 1 2 -1\"><Coordinate point=\"0 0 0 1 0 0 0 1 0\"/></IndexedFaceSet>"
      "</Shape></Scene></X3D>";
  std::string wide = "\xFF\xFE";
  for (const char c : text) wide += {c, '\0'};
  EXPECT_EQ(load_any_mesh(folder.write("a.x3d", wide)).positions, points);
  const std::string path = folder.write("b.x3d", wide.substr(0, 60));
  EXPECT_NE(error_of([&] { load_any_mesh(path); }).find(path + ", byte "), std::string::npos);
}

TEST(Collada, ArraysThatAreTooShortForTheirAccessor) {
  const TemporaryFolder folder;
  const auto message_for = [&](const std::string& array, const std::string& accessor) {
    const std::string path = folder.write("a.dae", collada(array, accessor));
    const std::string message = error_of([&] { load_any_mesh(path); });
    EXPECT_TRUE(message.starts_with(path + ": array 'pa' has a count of ")) << message;
    return message;
  };
  EXPECT_NE(message_for("count=\"3\"", "count=\"3\" stride=\"3\"")
                .find("a count of 3, fewer than the 3 elements of its accessor need (stride 3)"),
            std::string::npos);
  message_for("", "count=\"3\" stride=\"3\"");
  message_for("count=\"8\"", "count=\"3\" stride=\"3\"");
  message_for("count=\"9\"", "count=\"4\" stride=\"3\"");
  message_for("count=\"9\"", "count=\"3\" stride=\"3\" offset=\"1\"");
  message_for("count=\"9\"", "count=\"3\" stride=\"4\"");
  message_for("count=\"9\"", "count=\"3\" stride=\"18446744073709551615\"");
  message_for("count=\"9\"", "count=\"18446744073709551615\" stride=\"1\"");
  message_for("count=\"9\"", "count=\"3\" stride=\"3\" offset=\"18446744073709551615\"");
}

TEST(Collada, TheLastElementMayBeWithoutItsRest) {
  EXPECT_NE(collada_text(collada("count=\"9\"", "count=\"2\" stride=\"6\""), "a").find("0 1 2</p>"),
            std::string::npos);
}

}  // namespace supple::collada_test
