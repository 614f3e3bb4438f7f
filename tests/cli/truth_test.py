"""Large public meshes whose intersecting triangle pairs are known exactly: every pair must be found, and no other."""

import hashlib
import json
import os
import pathlib
import sys
import unittest

from program import ROOT, ProgramTest

DATA = pathlib.Path(os.environ.get("SUPPLE_DATA", ROOT.parent / "shared/data"))
# The permutations of coordinates that the cases use, as quarter turns about x, then y, then z.
TURNS = {"+x+y+z": [0, 0, 0], "-z+y+x": [0, -90, 0], "+x-z+y": [90, 0, 0], "+y+z+x": [-90, -90, 0]}


def placement(transform):
    """The scene file's keys for a transform such as `s:4,p:-z+y+x,t:0.5:1:0.25`."""
    keys = []
    for step in transform.split(",") if transform != "-" else []:
        kind, value = step.split(":", 1)
        if kind == "s":
            keys.append(f"scale = {float(value)!r}")
        elif kind == "p":
            keys.append(f"rotate_xyz_degrees = {TURNS[value]}")
        else:
            keys.append(f"translate = {[float(t) for t in value.split(':')]}")
    return "\n".join(keys)


def digest(pairs):
    return hashlib.sha256("".join(f"{i} {j}\n" for i, j in pairs).encode()).hexdigest()


class Truth(ProgramTest):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.truth = json.loads((DATA / "truth.json").read_text())

    def expect(self, case, pairs):
        self.assertEqual(len(pairs), case["intersecting_pairs"])
        self.assertEqual(digest(pairs), case["sha256_of_sorted_pairs"])

    def test_self(self):
        for case in self.truth["self"]:
            with self.subTest(case["name"]):
                (frame,) = self.detect(DATA / case["mesh"], "--self", "--no-contact-points")["frames"]
                self.assertEqual(frame["triangle_pairs"], [])
                self.expect(case, [pair for group in frame["self"] for pair in group["pairs"]])

    def test_pairs(self):
        for case in self.truth["pairs"]:
            with self.subTest(case["name"]):
                objects = [f'[[object]]\nmesh = "{DATA / case[m]}"\n{placement(case[t])}\n' for m, t in (("a", "ta"), ("b", "tb"))]
                self.write("scene.toml", "".join(objects))
                (frame,) = self.detect("scene.toml", "--no-contact-points")["frames"]
                self.assertEqual([(g["a"], g["b"]) for g in frame["triangle_pairs"]], [(0, 1)])
                self.expect(case, frame["triangle_pairs"][0]["pairs"])

    def test_sequence(self):
        cases = [case for case in self.truth["self"] if case["name"].startswith("kick-")]
        frames = self.detect("--sequence", DATA / "kick/*.obj", "--self", "--no-contact-points")["frames"]
        self.assertEqual(len(frames), len(cases))
        for case, frame in zip(cases, frames):
            with self.subTest(case["name"]):
                self.expect(case, frame["self"][0]["pairs"])


if __name__ == "__main__":
    if not (DATA / "truth.json").is_file():
        print(f"skipped: no data in {DATA}")
        sys.exit(77)
    unittest.main()
