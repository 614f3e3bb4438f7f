#include "view_file/view_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "supple/error.hpp"
#include "view_file/view_members.hpp"

namespace supple::viewer::view_file_test {

namespace fs = std::filesystem;

std::string fault_of(const std::function<void()>& action) {
  try {
    action();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

std::string fault_of(const std::string& view) {
  return fault_of([&] { check_view(view, "view.json"); });
}

TEST(ViewFile, AcceptsEveryMember) {
  EXPECT_EQ(fault_of(R"({"version": 1})"), "");
  EXPECT_EQ(fault_of(R"({"version": 1, "step": 12,
    "camera": {"position": [1, 2.5, -3e2], "target": [0, 0, 0], "zoom": 0.5, "orthographic": true},
    "layers": {"surface": true, "vertices": false}, "octree": {"only_selected": false, "level": -1},
    "nodes": {"objects": [0, 7], "level": -2}, "marks": {"slice": "x", "slice_at": 1, "up": "z", "point_size": 3},
    "objects": {"": {}, "a.obj": {"visible": false, "colour": "#A0b1c2", "opacity": 0.5}}, "filter": "",
    "views": {"layout": "two", "slices": {"second": {"axis": "y", "at": 0.5, "flipped": true}},
              "hidden": {"second": {"a.obj": true}}},
    "tab": "Plots", "panels": true})"),
            "");
  EXPECT_EQ(fault_of(R"({"version": 1, "nodes": {"objects": null}})"), "");
}

TEST(ViewFile, NamesTheMemberAndWhatItMustBe) {
  EXPECT_EQ(fault_of("{"), "view.json: it is not JSON: the error is at byte 1");
  EXPECT_EQ(fault_of("3"), "view.json: it has no members; a view file is an object { … }");
  EXPECT_EQ(fault_of("{}"), "view.json: version is missing; write \"version\": 1");
  const auto fault = [](const std::string& member) { return fault_of("{\"version\": 1, " + member + "}"); };
  EXPECT_EQ(fault_of(R"({"version": 2})"), "view.json: version is not 1");
  EXPECT_EQ(fault(R"("cameras": 1)"), "view.json: cameras is unknown; docs/viewer.md lists the members");
  EXPECT_EQ(fault(R"("camera": [])"), "view.json: camera is not an object { … }");
  EXPECT_EQ(fault(R"("camera": {"zoom": 0})"), "view.json: camera.zoom is not a finite number above 0");
  EXPECT_EQ(fault(R"("camera": {"zoom": 1e999})"), "view.json: it is not JSON: the error is at byte 34");
  EXPECT_EQ(fault(R"("camera": {"target": [1, 2, "3"]})"),
            "view.json: camera.target is not three finite numbers");
  EXPECT_EQ(fault(R"("layers": {"surface": 1})"), "view.json: layers.surface is not true or false");
  EXPECT_EQ(fault(R"("octree": {"level": 1.5})"),
            "view.json: octree.level is not a whole number from -1 to 32");
  EXPECT_EQ(fault(R"("octree": {"level": 33})"),
            "view.json: octree.level is not a whole number from -1 to 32");
  EXPECT_EQ(fault(R"("marks": {"slice": "off x"})"), "view.json: marks.slice is not one of off, x, y, z");
  EXPECT_EQ(fault(R"("objects": {"a.b": {"colour": "#12345g"}})"),
            "view.json: objects.a.b.colour is not a colour such as #8ecae6");
  EXPECT_EQ(fault(R"("views": {"slices": {"third": {"at": 2}}})"),
            "view.json: views.slices.third.at is not a number from 0 to 1");
  EXPECT_EQ(fault(R"("views": {"hidden": {"third": {"a.b": 1}}})"),
            "view.json: views.hidden.third.a.b is not true or false");
  EXPECT_EQ(fault(R"("objects": {"a": {"opacity": 1.5}})"),
            "view.json: objects.a.opacity is not a number from 0 to 1");
  EXPECT_EQ(fault(R"("nodes": {"objects": [0, -1]})"),
            "view.json: nodes.objects is not null, or two objects by their numbers from 0");
}

TEST(ViewFile, SaysWhichFileCannotBeUsed) {
  const fs::path folder = fs::temp_directory_path();
  EXPECT_NE(fault_of([&] { read_view(folder / "supple-no-view.json"); }).find("cannot be read"),
            std::string::npos);
  EXPECT_NE(fault_of([&] { read_view(folder); }).find("it is a folder"), std::string::npos);
  const fs::path file = folder / "supple-large-view.json";
  std::ofstream(file) << std::string(largest_view + 1, ' ');
  EXPECT_NE(fault_of([&] { read_view(file); }).find("larger than any view file"), std::string::npos);
  fs::remove(file);
}

TEST(ViewFile, AnElementOfThePageCannotBeEndedByAText) {
  const std::string page =
      page_with_json("<body><!--supple-cargo--></body>", "supple-view", R"({"a": "</script>"})");
  EXPECT_EQ(
      page,
      "<body><script type=\"application/json\" id=\"supple-view\">{\"a\": \"\\u003c/script>\"}</script>\n"
      "<!--supple-cargo--></body>");
  EXPECT_THROW(page_with_json("<body></body>", "a", "{}"), Error);
}

}  // namespace supple::viewer::view_file_test
