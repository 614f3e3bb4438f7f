"""Checks that the generated documents are current, that the written ones cover all options and keys, and that the
commands of queries and of the viewer in them run."""

import os
import pathlib
import re
import shlex
import subprocess
import tomllib
import unittest

from program import PROGRAM, ROOT, ProgramTest, run

HAS_VIEWER = bool(os.environ.get("SUPPLE_VIEWER_MODULE"))

# A closed surface: an octahedron.
SOLID = (
    [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)],
    [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)],
)
# The same with vertices of its own for each triangle, as exports often have it.
EXPORT = ([SOLID[0][v] for t in SOLID[1] for v in t], [(3 * t, 3 * t + 1, 3 * t + 2) for t in range(len(SOLID[1]))])


def commands_of(kind):
    """The commands `supple KIND` in code of the documents: in blocks, and between backticks with a file or a mesh."""
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("**/*.md"))):
        text = page.read_text()
        blocks = re.findall(r"^```(?:sh|text)\n(.*?)^```", text, re.M | re.S)
        for line in [line for block in blocks for line in block.splitlines()] + re.findall(r"`(supple [^`]*)`", text):
            command = re.match(rf"\s*supple {kind} (.*\.(?:txt|obj|ply|toml|h5)\b.*)", line)
            if command and "OPTIONS" not in line:
                # An explanation follows after two blanks or after #.
                yield page.name, shlex.split(re.split(r"  |#", command[1])[0])


def ply(mesh):
    vertices, triangles = mesh
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", "property float x", "property float y",
             "property float z", f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header"]
    return "\n".join(lines + [" ".join(map(str, v)) for v in vertices] + ["3 " + " ".join(map(str, t)) for t in triangles]) + "\n"


class Documents(ProgramTest):
    def test_generated_documents_are_up_to_date(self):
        done = subprocess.run([ROOT / "tools/generate_docs.sh", "--check", PROGRAM], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_check_notices_a_change(self):
        for name in ("tools/generate_docs.sh", "tools/make_documents.py", "viewer/page/src/protocol/sections_generated.ts"):
            self.write(name, (ROOT / name).read_text()).chmod(0o755)
        self.write("docs/cli.md", (ROOT / "docs/cli.md").read_text().replace("--self", "--elf"))
        done = subprocess.run(
            ["bash", self.folder / "tools/generate_docs.sh", "--check", PROGRAM], capture_output=True, text=True
        )
        self.assertEqual(done.returncode, 1)
        self.assertIn("docs/cli.md: differs", done.stderr)

    def test_manual_page_has_every_option(self):
        page = subprocess.run([ROOT / "tools/make_documents.py", "--man"], input=run("--describe").out,
                              capture_output=True, text=True).stdout.replace("\\-", "-")
        for command in ("detect", "simulate", "view", "info", "query", "ccd-queries", "diff", "experiment"):
            for flag in re.findall(r"^  (--[a-z-]+)", run(command, "--help").out, re.M):
                self.assertIn(flag, page)

    def test_example_of_the_scene_file_page_is_accepted(self):
        page = (ROOT / "docs/scene_file.md").read_text()
        example = re.search(r"```toml\n(.*?)```", page, re.S)[1]
        self.write("scene.toml", example)
        self.write("meshes/cow.obj", ([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [(0, 1, 2)]))
        self.assertEqual([o["name"] for o in self.detect("scene.toml", "--steps", "2")["objects"]], ["cow", "fish"] + [f"ball {n}" for n in range(1, 19)])

    def test_scene_file_page_names_every_key(self):
        page = (ROOT / "docs/scene_file.md").read_text() + (ROOT / "docs/options.md").read_text()
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


class Commands(ProgramTest):
    """Runs the commands of the documents in a folder with files of the names that they have."""

    def setUp(self):
        super().setUp()
        os.symlink(ROOT / "scenes", self.folder / "scenes")
        for name in ("rabbit.obj", "body.obj"):
            self.write(name, SOLID)
        self.write("export.obj", EXPORT)
        for name in ("fish.ply", "frame_1.ply", "frame_2.ply"):
            self.write(name, ply(SOLID))
        for name in ("scene.toml", "moving.toml"):
            self.write(name, "[[object]]\nmodel = 'rabbit'\n")
        self.write("points.txt", "0 0 0\n2 0 0\n")
        self.write("rays.txt", "-3 0.1 0.1 1 0 0\n")
        self.assertEqual(self.run_here("simulate", "scenes/nine.toml", "--frames", 2, "--record", "run.h5", "--quiet").status, 0)
        for name in ("a.h5", "b.h5"):
            os.symlink(self.folder / "run.h5", self.folder / name)

    def check(self, kind, least, options=lambda arguments: arguments):
        commands = [(page, options(arguments)) for page, arguments in commands_of(kind)]
        self.assertGreaterEqual(len(commands), least)
        for page, arguments in commands:
            with self.subTest(page=page, command=arguments):
                done = self.run_here(kind, *arguments)
                self.assertEqual((done.status, done.error), (0, ""))
                self.assertTrue(done.out)

    def test_queries(self):
        self.check("query", 8)

    @unittest.skipUnless(HAS_VIEWER, "built without the viewer")
    def test_views_as_exported_pages(self):
        def exported(arguments):
            # A file that is exported shows a scene or one whole recording.
            served = ("--no-open", "--port", "8080", "--follow", "--spectators", "--compare", "b.h5")
            kept = [word for word in arguments if word not in served]
            return kept if "--export" in kept else [*kept, "--export", "page.html"]

        self.check("view", 7, exported)


if __name__ == "__main__":
    unittest.main()
