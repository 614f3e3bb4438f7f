"""Checks that the generated documents are current and that the written ones cover all options and keys."""

import pathlib
import re
import subprocess
import tomllib
import unittest

from program import PROGRAM, ROOT, ProgramTest, run


class Documents(ProgramTest):
    def test_generated_documents_are_up_to_date(self):
        done = subprocess.run([ROOT / "tools/generate_docs.sh", "--check", PROGRAM], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_check_notices_a_change(self):
        self.write("tools/generate_docs.sh", (ROOT / "tools/generate_docs.sh").read_text())
        self.write("docs/supple.1", (ROOT / "docs/supple.1").read_text())
        self.write("docs/cli.md", (ROOT / "docs/cli.md").read_text().replace("--self", "--elf"))
        done = subprocess.run(
            ["bash", self.folder / "tools/generate_docs.sh", "--check", PROGRAM], capture_output=True, text=True
        )
        self.assertEqual(done.returncode, 1)
        self.assertIn("docs/cli.md: differs", done.stderr)

    def test_manual_page_has_every_option(self):
        page = (ROOT / "docs/supple.1").read_text().replace("\\-", "-")
        for command in ("detect", "simulate", "info", "ccd-queries", "diff", "experiment"):
            for flag in re.findall(r"^  (--[a-z-]+)", run(command, "--help").out, re.M):
                self.assertIn(flag, page)

    def test_unknown_document(self):
        self.assert_one_line_error(run("--generate", "pdf"), "pdf", "man, markdown, tables")

    def test_example_of_the_scene_file_page_is_accepted(self):
        page = (ROOT / "docs/scene_file.md").read_text()
        example = re.search(r"```toml\n(.*?)```", page, re.S)[1]
        self.write("scene.toml", example)
        self.write("meshes/cow.obj", ([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [(0, 1, 2)]))
        self.assertEqual([o["name"] for o in self.detect("scene.toml", "--steps", "2")["objects"]], ["cow", "fish"] + [f"ball {n}" for n in range(1, 19)])

    def test_scene_file_page_names_every_key(self):
        page = (ROOT / "docs/scene_file.md").read_text()
        for section, keys in (
            ("[scene]\nx = 1\n", r"allowed here: (.*?);? "),
            ("[[object]]\nmodel = 'box'\nx = 1\n", r"allowed here: (.*?)$"),
            ("[scene]\nresponse = {x = 1}\n", r"allowed here: (.*?)$"),
            ("[[object]]\nmodel = 'box'\nmotion = {kind = 'wave', x = 1}\n", r"allowed here: (.*?)$"),
            ("[[object]]\nmodel = 'box'\nmotion = {kind = 'mass_spring', x = 1}\n", r"allowed here: (.*?)$"),
            ("[[object]]\nmotion = {kind = 'frames', files = 'x.toml', x = 1}\n", r"allowed here: (.*?)$"),
        ):
            error = self.run_here("detect", self.write("x.toml", section)).error.strip()
            for key in error.split("allowed here: ")[1].split(", "):
                self.assertIn(f"`{key}`" if key != "kind" else "`kind = ", page)


if __name__ == "__main__":
    unittest.main()
