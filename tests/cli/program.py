"""Runs the program under test and writes meshes for it."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("SUPPLE_PROGRAM", str(ROOT / "build/release/bin/supple"))
HAS_VIEWER = bool(os.environ.get("SUPPLE_VIEWER_MODULE", ""))
BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
CAN_RENDER = HAS_VIEWER and (bool(os.environ.get("SUPPLE_CHROMIUM")) or any(map(shutil.which, BROWSERS)))


class Result:
    def __init__(self, done):
        self.status = done.returncode
        self.out = done.stdout
        self.error = done.stderr


def run(*arguments, folder=None, **environment):
    return Result(
        subprocess.run(
            [PROGRAM, *map(str, arguments)],
            cwd=folder,
            capture_output=True,
            text=True,
            errors="surrogateescape",
            env={**os.environ, **environment},
        )
    )


def obj(vertices, triangles):
    """The text of an OBJ file. The triangles given here count vertices from 0."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles]
    return "\n".join(lines) + "\n"


TRIANGLE = ([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [(0, 1, 2)])
# Perpendicular to TRIANGLE: they share the segment from (0.25, 0.25, 0) to (0.75, 0.25, 0).
UPRIGHT = ([(0.25, 0.25, -1.0), (0.25, 0.25, 1.0), (0.75, 0.25, 0.0)], [(0, 1, 2)])
FAR = ([(5.0, 0.0, 0.0), (6.0, 0.0, 0.0), (5.0, 1.0, 0.0)], [(0, 1, 2)])
# Two intersecting triangles without a common vertex.
CROSSED = (TRIANGLE[0] + UPRIGHT[0], [(0, 1, 2), (3, 4, 5)])

# A face, and a triangle whose vertex 0 points down at it. If moved down by 2, it passes through the face at
# half of the step.
FLOOR = ([(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0)], [(0, 1, 2)])
SPIKE = ([(1.0, 1.0, 1.0), (1.25, 1.0, 5.0), (1.0, 1.25, 5.0)], [(0, 1, 2)])


def moved(mesh, x, y, z):
    return ([(vx + x, vy + y, vz + z) for vx, vy, vz in mesh[0]], mesh[1])


def joined(a, b):
    """Joins two meshes; the vertices and triangles of the second follow those of the first."""
    first = len(a[0])
    return (a[0] + b[0], a[1] + [tuple(v + first for v in t) for t in b[1]])


class ProgramTest(unittest.TestCase):
    """A test with a temporary folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, content):
        """Writes a file and returns its path. A mesh (vertices, triangles) is written as OBJ."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(obj(*content) if isinstance(content, tuple) else content)
        return path

    def run_here(self, *arguments, **environment):
        return run(*arguments, folder=self.folder, **environment)

    def detect(self, *arguments):
        """Returns the JSON of a run that must succeed. It may warn that nothing was tested."""
        done = self.run_here("detect", *arguments, "--json", "-")
        self.assertEqual(done.status, 0, done.error)
        self.assertRegex(done.error, r"^(supple: warning: [^\n]*tested: [^\n]*\n)?$")
        return json.loads(done.out)

    def assert_one_line_error(self, done, *parts):
        """Expects status 2, no standard output, and one line of standard error with each of the parts."""
        self.assertEqual((done.status, done.out), (2, ""), done.error)
        self.assertTrue(done.error.endswith("\n"), done.error)
        self.assertEqual(len(done.error.splitlines()), 1, done.error)
        for part in parts:
            self.assertIn(part, done.error)
