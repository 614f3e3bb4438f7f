"""A new member of a record needs a line in its struct and a line in its description: the columns of recordings
then have it, and its JSON and the documents are made from the same description."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = r"""
#include <cstdio>
#include "layout.hpp"
int main() {
  for (const supple::ListLayout& list : supple::list_layouts())
    for (const supple::Column& column : list.columns) std::printf("%s/%s\n", list.group.c_str(), column.name.c_str());
}
"""


class AddField(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for part in ("include", "libs/describe", "recording", "src/supple/core"):
            shutil.copytree(ROOT / part, self.folder / part)

    def change(self, file, before, after):
        text = (self.folder / file).read_text()
        self.assertEqual(text.count(before), 1, f"{file}: {before}")
        (self.folder / file).write_text(text.replace(before, after))

    def columns(self):
        (self.folder / "main.cpp").write_text(PROGRAM)
        includes = ["-Iinclude", "-Irecording/include", "-Irecording/src", "-Ilibs/describe/include",
                    "-Isrc/supple"]
        done = subprocess.run(["c++", "-std=c++20", *includes, "main.cpp", "recording/src/layout.cpp",
                               "libs/describe/record_info.cpp", "src/supple/core/error.cpp",
                               "src/supple/core/utf8.cpp", "-o", "columns"],
                              cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return subprocess.run(["./columns"], cwd=self.folder, capture_output=True, text=True, check=True).stdout.split()

    def test_two_lines_are_enough(self):
        before = self.columns()
        self.change("include/supple/penetration.hpp", "  Vec3d normal{};  ///< unit vector from the vertex",
                    "  double age = 0;\n  Vec3d normal{};  ///< unit vector from the vertex")
        line = '    field("vertex", &Row::vertex, "Vertex of object a", role::key(Names::vertex, \'a\'));\n' \
               '    field("triangle", &Row::triangle'
        self.change("libs/describe/include/supple/record_descriptions.hpp", line,
                    '    field("age", &Row::age, "Seconds since the vertex entered", {}, "s");\n' + line)
        self.assertEqual(set(self.columns()) - set(before), {"penetrations/age"})


if __name__ == "__main__":
    unittest.main()
