"""Tests `supple query`: nearest triangles of points, points inside, first triangles on rays."""

import hashlib
import json
import os
import pathlib
import unittest

from program import ROOT, TRIANGLE, ProgramTest, moved

DATA = pathlib.Path(os.environ.get("SUPPLE_DATA", ROOT.parent / "shared/data"))
SOLID = ([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])


class Query(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("solid.obj", SOLID)
        self.write("above.obj", moved(TRIANGLE, 0, 0, 5))

    def query(self, *arguments):
        done = self.run_here("query", *arguments, "--json", "-")
        self.assertEqual((done.status, done.error), (0, ""))
        return json.loads(done.out)

    def test_closest(self):
        self.write("points.txt", "# x y z\n0.25 0.25 -2\n\n0.25,0.25,4.5  # nearer to the triangle\nnan 0 0\n")
        result = self.query("closest", "points.txt", "solid.obj", "above.obj")
        self.assertEqual(result["query"], "closest")
        self.assertEqual([o["name"] for o in result["objects"]], ["solid", "above"])
        self.assertEqual(result["results"], [[0, 0, 2], [1, 0, 0.5], None])
        near = self.query("closest", "points.txt", "solid.obj", "above.obj", "--max-distance", "1")
        self.assertEqual(near["results"], [None, [1, 0, 0.5], None])

    def test_signed_distances(self):
        self.write("points.txt", "0.1 0.2 0.05\n0.1 0.2 -0.5\n")
        (inside, outside) = self.query("closest", "points.txt", "solid.obj", "--signed")["results"]
        self.assertEqual((inside[2], outside[2]), (-0.05, 0.5))
        self.assertEqual(self.query("closest", "points.txt", "solid.obj")["results"][0][2], 0.05)
        failed = self.run_here("query", "closest", "points.txt", "above.obj", "--signed")
        self.assert_one_line_error(failed, "closest: the surface of above is open")

    def test_inside(self):
        self.write("points.txt", "0.1 0.1 0.1\n0.1 0.1 0\n1 1 1\n")
        self.assertEqual(self.query("inside", "points.txt", "solid.obj")["results"], ["inside", "on", "outside"])
        failed = self.run_here("query", "inside", "points.txt", "above.obj")
        self.assert_one_line_error(failed, "the surface of above is open: the edge of vertices 0 and 1")

    def test_rays(self):
        self.write("rays.txt", "0.25 0.25 -1 0 0 0.5\n0 0 0 0 0 0\n")
        inputs = ("rays.txt", "solid.obj", "above.obj")
        self.assertEqual(self.query("rays", *inputs)["results"], [[0, 0, 2], None])
        self.assertEqual(self.query("rays", *inputs, "--all-hits")["results"], [[0, 0, 2, 3], None])

    def test_table(self):
        self.write("points.txt", "0.25 0.25 -2\n" * 50)
        table = self.run_here("query", "closest", "points.txt", "solid.obj").out
        self.assertIn("0 solid  triangle 0  2\n", table)
        self.assertIn("10 more; --json writes all of them", table)
        self.assertEqual(self.run_here("query", "closest", "points.txt", "solid.obj", "--quiet").out, "")

    def test_errors(self):
        self.write("points.txt", "1 2 3\n4 5\n")
        self.write("words.txt", "1 2 x\n")
        for arguments, message in (
            (("closest", "points.txt", "solid.obj"), "points.txt: line 2: 2 numbers; a line has three: x, y and z"),
            (("closest", "words.txt", "solid.obj"), 'words.txt: line 1: "x" is not a number that a double can hold'),
            (("closest", "none.txt", "solid.obj"), "none.txt: the file cannot be read"),
            (("nearest", "points.txt", "solid.obj"), "nearest is none of closest, inside and rays"),
            (("closest", "points.txt", "solid.obj", "--all-hits"), "--all-hits: has no effect without the question rays"),
            (("rays", "points.txt", "solid.obj", "--signed"), "--signed: has no effect without the question closest"),
            (("rays", "points.txt", "solid.obj", "--max-distance", "1"), "--max-distance: has no effect without"),
        ):
            self.assert_one_line_error(self.run_here("query", *arguments), message)

    def test_published_cases(self):
        if not (DATA / "proximity.json").exists():
            self.skipTest(f"no {DATA}; set SUPPLE_DATA to the folder of truth.json")
        truth = json.loads((DATA / "proximity.json").read_text())
        (case,) = [c for c in truth["containment"] if c["name"] == "nested-lattice"]
        results = self.query("inside", DATA / "proximity/nested-lattice.txt", DATA / case["mesh"])["results"]
        for place in ("inside", "on"):
            listed = "".join(f"{i}\n" for i, result in enumerate(results) if result == place)
            self.assertEqual(hashlib.sha256(listed.encode()).hexdigest(), case[f"sha256_of_{place}"])
        for case in truth["rays"]:
            rays = DATA / "proximity" / f"{case['name']}.txt"
            results = self.query("rays", rays, DATA / case["mesh"], "--all-hits")["results"]
            counts = "".join(f"{i} {result[3] if result else 0}\n" for i, result in enumerate(results))
            self.assertEqual(hashlib.sha256(counts.encode()).hexdigest(), case["sha256_of_counts"])


if __name__ == "__main__":
    unittest.main()
