"""What a change costs: a member of a record needs a line in two files, an option with a rule a line in three, a
kind of contacts ten files. The test makes the change in a copy, compiles it, and finds the member, the option
or the kind where users do."""

import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
COLUMNS = r"""
#include <cstdio>
#include "layout.hpp"
int main() {
  for (const supple::ListLayout& list : supple::list_layouts())
    for (const supple::Column& column : list.columns) std::printf("%s/%s\n", list.group.c_str(), column.name.c_str());
}
"""
PARALLEL_PAIR = r"""
#include <cstdio>
#include "layout.hpp"
#include "reports/reports.hpp"
#include "reports/result_json.hpp"
int main() {
  using namespace supple;
  for (const ListLayout& list : list_layouts())
    for (const Column& column : list.columns) std::printf("%s/%s\n", list.group.c_str(), column.name.c_str());
  const auto kinds = value_of_set<ContactKinds>("proximity,parallel").value();
  for (const std::string& column : cli::csv_columns(kinds, false)) std::printf("CSV %s\n", column.c_str());
  const ParallelPair pairs[] = {{{0, 0}, {1, 0}, 5, 7}};
  DetectResult result;
  result.parallel_pairs = pairs;
  std::fflush(stdout);
  cli::JsonWriter json("-");
  cli::write_other_answers(json, result, kinds);
  json.close();
}
"""
OPTIONS = r"""
#include <cstdio>
#include "options/option_needs.hpp"
#include "session/settings.hpp"
int main() {
  using namespace supple;
  viewer::Overrides<SceneOptions> given;
  given.for_each_setter([&]<class Value>(const auto& field, const Value& value, auto set) {
    std::printf("%s\n", field.key);
    if constexpr (std::is_same_v<Value, double>) {
      const double before = value;
      set(-1.0);
      SceneOptions scene;
      given.apply_to(scene);
      try {
        check(scene);
      } catch (const std::exception& error) {
        std::printf("%s\n", error.what());
      }
      set(before);
    }
  });
  for (const cli::OptionNeed& need : cli::option_needs())
    std::printf("%s needs %s %s\n", need.key, need.decider, need.values);
}
"""


class CostOfChange(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for part in ("include", "libs/describe", "recording", "src/supple", "cli", "viewer/session", "simulation/include", "models/include", "libs/verify/include", "formats/include"):
            shutil.copytree(ROOT / part, self.folder / part)

    def change(self, file, before, after):
        text = (self.folder / file).read_text()
        self.assertEqual(text.count(before), 1, f"{file}: {before}")
        (self.folder / file).write_text(text.replace(before, after))

    def lines_of(self, program, *sources):
        """What a program prints that is compiled with these sources."""
        (self.folder / "main.cpp").write_text(program)
        # Functions that the program does not call need not be linked.
        self.compile("-ffunction-sections", "-Wl,--gc-sections", "main.cpp", *sources, "-o", "program")
        return set(subprocess.run(["./program"], cwd=self.folder, capture_output=True, text=True, check=True).stdout.splitlines())

    def compile(self, *arguments):
        folders = ("include", "recording/include", "recording/src", "libs/describe/include", "src/supple", "cli",
                   "viewer", "viewer/session", "simulation/include", "models/include", "libs/verify/include", "formats/include")
        done = subprocess.run(["c++", "-std=c++20", *(f"-I{folder}" for folder in folders), *arguments],
                              cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_member_of_a_record_takes_two_files(self):
        sources = ["recording/src/layout.cpp", "libs/describe/record_info.cpp", "src/supple/core/error.cpp",
                   "src/supple/core/utf8.cpp"]
        before = self.lines_of(COLUMNS, *sources)
        self.change("include/supple/penetration.hpp", "  Vec3d normal{};  ///< unit vector from the vertex",
                    "  double age = 0;\n  Vec3d normal{};  ///< unit vector from the vertex")
        line = '    field("vertex", &Row::vertex, "Vertex of object a", role::key(Names::vertex, \'a\'));\n' \
               '    field("triangle", &Row::triangle'
        self.change("libs/describe/include/supple/record_descriptions.hpp", line,
                    '    field("age", &Row::age, "Seconds since the vertex entered", {}, "s");\n' + line)
        self.assertEqual(self.lines_of(COLUMNS, *sources) - before, {"penetrations/age"})

    def test_an_option_with_a_rule_takes_three_files(self):
        self.change("include/supple/continuous.hpp", "  bool skip_parting = false;\n",
                    "  bool skip_parting = false;\n  double slack = 0;\n")
        self.change("include/supple/option_descriptions.hpp", "    visitor(Field<Options, bool>{\n        .name = \"skip_parting\",",
                    "    visitor(Field<Options, double>{.name = \"slack\", .member = &Options::slack, .doc = \"As a test\","
                    " .range = ValueRange::from(0, 1)});\n"
                    "    visitor(Field<Options, bool>{\n        .name = \"skip_parting\",")
        self.change("cli/options/option_needs.cpp", '    {"skip_parting", has_continuous,',
                    '    {"slack", has_continuous, "contacts", "continuous"},\n    {"skip_parting", has_continuous,')
        found = self.lines_of(OPTIONS, "cli/options/option_needs.cpp", "src/supple/core/description.cpp",
                              "src/supple/core/error.cpp", "src/supple/core/utf8.cpp")
        self.assertEqual({line for line in found if "slack" in line},
                         {"slack", "slack needs contacts continuous",
                          "ImpactOptions::slack is -1; it must be a number from 0 to 1"})

    def test_a_kind_of_contacts_takes_ten_files(self):
        patch = ROOT / "tests/tools/new_kind.patch"
        self.assertLessEqual(len(re.findall(r"^\+\+\+ b/", patch.read_text(), re.MULTILINE)), 10)
        subprocess.run(["git", "apply", patch], cwd=self.folder, check=True)
        self.compile("-fsyntax-only", "src/supple/answers/parallel/parallel_pass.cpp", "src/supple/answers/detection.cpp")
        found = self.lines_of(PARALLEL_PAIR, "recording/src/layout.cpp", "libs/describe/record_info.cpp",
                              "src/supple/core/error.cpp", "src/supple/core/utf8.cpp", "cli/base/files.cpp",
                              "cli/base/text.cpp", "cli/reports/csv_report.cpp", "cli/reports/result_json.cpp", "-lfmt")
        self.assertLessEqual({"parallel_pairs/triangle_b", "events/parallel_begin/object_a", "CSV frame", "CSV a",
                              "CSV b", "CSV triangle_a", "CSV triangle_b"}, found)
        self.assertIn('"parallel_pairs":[{"a":0,"b":1,"triangle_a":5,"triangle_b":7}]', "".join(found))


if __name__ == "__main__":
    unittest.main()
