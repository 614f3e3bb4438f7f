"""Checks large public meshes with exactly known results, namely intersecting triangle pairs, or touching
elements during motion. The program must find all of them and no others."""

import hashlib
import json
import math
import os
import pathlib
import re
import struct
import sys
import unittest

from program import ROOT, ProgramTest

DATA = pathlib.Path(os.environ.get("SUPPLE_DATA", ROOT.parent / "shared/data"))
# The coordinate permutations of the test cases, as quarter turns about x, then y, then z.
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


def read_obj_triangles(path):
    triangles = []
    for line in path.read_text().splitlines():
        if line.startswith("f "):
            corners = [int(corner.split("/")[0]) - 1 for corner in line.split()[1:]]
            triangles += [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]
    return triangles


def read_ply_triangles(path):
    """Reads a binary PLY file of triangles, each with a count of one byte and three ids of four bytes."""
    content = path.read_bytes()
    header = content[: content.index(b"end_header")].decode()
    row = (">" if "big_endian" in header else "<") + "B3i"
    (count,) = re.findall(r"element face (\d+)", header)
    faces = content[len(content) - int(count) * struct.calcsize(row) :]
    return [corners for _, *corners in struct.iter_unpack(row, faces)]


def edge_numbers(path):
    """The published numbers of edges (smaller id, larger id): ordered by the larger, then by the smaller."""
    triangles = read_obj_triangles(path) if path.suffix == ".obj" else read_ply_triangles(path)
    edges = {(min(e), max(e)) for a, b, c in triangles for e in ((a, b), (b, c), (c, a))}
    return {edge: number for number, edge in enumerate(sorted(edges, key=lambda e: (e[1], e[0])))}


def read_contacts(path):
    """The time of each published contact (kind, first, second) as text."""
    rows = (line.split() for line in path.read_text().splitlines())
    return {(kind, int(first), int(second)): time for kind, first, second, time in rows}


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

    def numbered(self, group, meshes):
        """The pairs of each kind as published: the number of an edge in place of its two vertices."""
        edges = [edge_numbers(mesh) for mesh in meshes]
        pairs = {}
        for kinds in group.keys() - {"a", "b"}:
            pairs[kinds] = []
            for row in group[kinds]:
                ids, numbers = iter(row[:-1]), []
                for kind, of_mesh in zip(kinds, (edges[0], edges[-1])):
                    numbers.append(of_mesh[next(ids), next(ids)] if kind == "e" else next(ids))
                if len(meshes) == 1 and kinds in ("vv", "ee"):
                    numbers.sort()
                pairs[kinds].append(tuple(numbers))
            pairs[kinds].sort()
        return pairs

    def test_proximity(self):
        for case in json.loads((DATA / "proximity.json").read_text())["proximity"]:
            meshes = [DATA / case[m] for m in ("mesh", "a", "b") if m in case]
            margin = repr(float(case["D"]) / 2)
            inputs = meshes
            if len(meshes) == 2:
                inputs = ["scene.toml"]
                objects = [f'[[object]]\nmesh = "{m}"\n{placement(case[t])}\n' for m, t in zip(meshes, ("ta", "tb"))]
                self.write("scene.toml", "".join(objects))
            for listing in ("elements", "features"):
                with self.subTest(case["name"], listing=listing):
                    arguments = ("--contacts", "proximity", "--margin", margin, "--proximity-listing", listing)
                    (frame,) = self.detect(*inputs, *arguments)["frames"]
                    (group,) = frame["proximity"]
                    found = self.numbered(group, meshes)
                    kinds = ("vf", "fv", "ee") if listing == "elements" else case["features"]
                    expected = case if listing == "elements" else case["features"]
                    for kind in kinds:
                        if kind in expected:
                            truth, pairs = expected[kind], found[kind.lower()]
                            self.assertEqual((len(pairs), digest(pairs)), (truth["pairs"], truth["sha256_of_sorted_pairs"]), kind)

    def pair(self, case):
        """A scene file with both meshes of a case in their places."""
        objects = [f'[[object]]\nmesh = "{DATA / case[m]}"\n{placement(case["t" + m])}\n' for m in "ab"]
        self.write("scene.toml", "".join(objects))
        return "scene.toml"

    def test_vertices_inside_and_their_depths(self):
        for case in json.loads((DATA / "proximity.json").read_text())["depth"]:
            with self.subTest(case["name"]):
                (frame,) = self.detect(self.pair(case), "--contacts", "penetration", "--solid")["frames"]
                (rows,) = [group["vertices"] for group in frame["penetration"] if group["a"] == 0]
                self.assertEqual(len(rows), case["inside"])
                text = "".join(f"{vertex}\n" for vertex, _, _ in rows)
                self.assertEqual(hashlib.sha256(text.encode()).hexdigest(), case["sha256_of_inside"])
                self.assertAlmostEqual(math.fsum(depth for _, _, depth in rows) / float(case["depth"]["sum"]), 1, 14)
                self.assertEqual(frame["containment"], [[0, 1]] if case["inside"] == case["query_points"] else [])

    def test_curves(self):
        for case in json.loads((DATA / "proximity.json").read_text())["contours"]:
            with self.subTest(case["name"]):
                (frame,) = self.detect(self.pair(case), "--contacts", "penetration")["frames"]
                found = [(curve["segments"], curve["kind"]) for curve in frame["curves"]]
                self.assertEqual(found, [(segments, kind) for _, _, segments, kind in case["curve_list"]])

    def expect_step(self, case, step, edges):
        self.assertEqual(len(edges), case["edges"])
        (group,) = step["continuous"]
        found = {("vf", v, f): time for v, f, time in group["vf"]}
        for a0, a1, b0, b1, time in group["ee"]:
            pair = sorted((edges[a0, a1], edges[b0, b1]))
            found["ee", *pair] = time
        self.assertEqual(len(found), len(group["vf"]) + len(group["ee"]))
        for kind in ("vf", "ee"):
            pairs = sorted((first, second) for k, first, second in found if k == kind)
            truth = case[f"touching_{kind}"]
            self.assertEqual((len(pairs), digest(pairs)), (truth["pairs"], truth["sha256_of_sorted_pairs"]))
        self.expect_times(found, read_contacts(DATA / f"contacts/{case['name']}.txt"))

    def expect_times(self, found, published):
        self.assertEqual(set(found), set(published))
        for contact, text in published.items():
            # Published times have fifteen digits; the exact time is within half a unit of the last one.
            early, late = float(text) * (1 - 1e-14) - 2.0**-30, float(text) * (1 + 1e-14)
            self.assertTrue(early <= found[contact] <= late, f"{contact}: {found[contact]}, published {text}")

    def test_steps(self):
        cases = {case["name"]: case for case in self.truth["steps"]}
        for name in ("cloth-funnel-227-228", "cloth-ball-92-93"):
            with self.subTest(name):
                case = cases[name]
                frames = [DATA / case["frame0"], DATA / case["frame1"]]
                (step,) = self.detect("--contacts", "continuous", "--self", "--sequence", *frames)["frames"]
                self.expect_step(case, step, edge_numbers(frames[0]))

    def test_sequence_of_steps(self):
        cases = [case for case in self.truth["steps"] if case["name"].startswith("kick-")]
        edges = edge_numbers(DATA / cases[0]["frame0"])
        steps = self.detect("--contacts", "continuous", "--self", "--sequence", DATA / "kick/*.obj")["frames"]
        self.assertEqual(len(steps), len(cases))
        for case, step in zip(cases, steps):
            with self.subTest(case["name"]):
                if case["touching_vf"]["pairs"] + case["touching_ee"]["pairs"] == 0:
                    self.assertEqual((step["continuous"], step["earliest"]), ([], None))
                else:
                    self.expect_step(case, step, edges)


if __name__ == "__main__":
    if not (DATA / "truth.json").is_file():
        print(f"skipped: no data in {DATA}")
        sys.exit(77)
    unittest.main()
