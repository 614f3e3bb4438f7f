"""Tests `supple query`: nearest triangles of points, points inside, first triangles on rays."""

import hashlib
import json
import os
import pathlib
import unittest

from program import ROOT, TRIANGLE, UPRIGHT, ProgramTest, moved

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

    def test_rays_through_the_notch_of_a_concave_polygon_hit_nothing(self):
        outline = [(3, 1), (3, 0), (0, 0), (0, 3), (1, 3), (1, 1)]
        self.write("notch.txt", "1.2 1.5 5 0 0 -1\n2 1.5 5 0 0 -1\n0.5 2.5 5 0 0 -1\n")
        for first in range(6):
            for step in (1, -1):
                corners = [outline[(first + step * k) % 6] for k in range(6)]
                self.write("l.obj", "".join(f"v {x} {y} 0\n" for x, y in corners) + "f 1 2 3 4 5 6\n")
                self.write("l.off", "OFF\n6 1 0\n" + "".join(f"{x} {y} 0\n" for x, y in corners) + "6 0 1 2 3 4 5\n")
                for name in ("l.obj", "l.off"):
                    left, right, inside = self.query("rays", "notch.txt", name, "--all-hits")["results"]
                    self.assertEqual((left, right), (None, None), (name, corners))
                    self.assertEqual(inside[2], 5)

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
        self.assert_one_line_error(failed, "the surface of above is open, 3 boundary edges: the edge of vertices 0 and 1")

    def test_rays(self):
        self.write("rays.txt", "0.25 0.25 -1 0 0 0.5\n0 0 0 0 0 0\n")
        inputs = ("rays.txt", "solid.obj", "above.obj")
        self.assertEqual(self.query("rays", *inputs)["results"], [[0, 0, 2], None])
        self.assertEqual(self.query("rays", *inputs, "--all-hits")["results"], [[0, 0, 2, 3], None])

    def test_distance(self):
        self.write("beside.obj", moved(SOLID, 0, -2, 0))
        inputs = ("solid.obj", "above.obj", "beside.obj")
        result = self.query("distance", *inputs)
        self.assertEqual((result["query"], len(result["objects"])), ("distance", 3))
        corner, along, aslant = result["results"]
        self.assertEqual(corner, [0, 1, 4, "vv", 3, 0, [0, 0, 1], [0, 0, 5]])
        self.assertEqual(along, [0, 2, 1, "vv", 0, 2, [0, 0, 0], [0, -1, 0]])
        self.assertEqual(aslant[:2], [1, 2])
        near = self.query("distance", *inputs, "--max-distance", "1", "--verify")
        self.assertEqual(near["results"], [along])
        self.assertEqual(near["verify"], {"answers_checked": 1, "differences": []})
        self.write("upright.obj", UPRIGHT)
        self.write("flat.obj", TRIANGLE)
        ((a, b, distance, *_),) = self.query("distance", "upright.obj", "flat.obj", "--verify")["results"]
        self.assertEqual((a, b, distance), (0, 1, 0))
        self.write("three.toml", '[[object]]\nmodel = "box"\nrepeat = [3, 1, 1]\nspacing = [2, 1, 1]\n')
        self.assertEqual([row[2] for row in self.query("distance", "three.toml")["results"]], [1, 3, 1])

    def test_table_of_distances(self):
        table = self.run_here("query", "distance", "solid.obj", "above.obj", "--verify").out
        self.assertIn("  0 solid  1 above  4  vertex 3 to vertex 0  (0, 0, 1) to (0, 0, 5)\n", table)
        self.assertIn("verified: 1 answer checked by brute force, no difference\n", table)
        far = self.run_here("query", "distance", "solid.obj", "above.obj", "--max-distance", "3")
        self.assertEqual((far.status, far.out), (0, "No two objects are within the distance.\n"))

    def test_verify(self):
        self.write("points.txt", "0.1 0.2 0.05\n0 0 0\nnan 0 0\n" * 100)
        self.write("rays.txt", "0.25 0.25 -1 0 0 0.5\n0 0 0 0 0 0\n")
        for arguments, count in (
            (("closest", "points.txt", "solid.obj"), 300),
            (("closest", "points.txt", "solid.obj", "--signed", "--max-distance", "0.01"), 300),
            (("inside", "points.txt", "solid.obj"), 300),
            (("rays", "rays.txt", "solid.obj", "above.obj"), 2),
            (("rays", "rays.txt", "solid.obj", "above.obj", "--all-hits"), 2),
        ):
            verify = self.query(*arguments, "--verify")["verify"]
            self.assertEqual(verify, {"answers_checked": count, "differences": []})
        self.assertNotIn("verify", self.query("inside", "points.txt", "solid.obj"))

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
            (("closest", "none.txt", "solid.obj"), "none.txt: there is no such file"),
            (("nearest", "points.txt", "solid.obj"), "nearest is none of closest, inside, rays and distance"),
            (("distance", "solid.obj"), "solid.obj: has 1 object; distances need two"),
            (("distance",), "MESH|SCENE.toml|RUN.h5 is required"),
            (("closest",), "FILE.txt is required"),
            (("closest", "points.txt"), "MESH|SCENE.toml|RUN.h5 is required"),
            (("distance", "solid.obj", "above.obj", "--signed"), "--signed: has no effect without the question closest"),
            (("distance", "solid.obj", "above.obj", "--all-hits"), "--all-hits: has no effect without the question rays"),
            (("inside", "points.txt", "solid.obj", "--max-distance", "1"), "has no effect without the question closest or distance"),
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
