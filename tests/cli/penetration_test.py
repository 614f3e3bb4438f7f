"""Tests `supple detect --contacts penetration`: vertices inside solids, contained parts and curves."""

import json
import unittest

from program import ProgramTest, joined, moved

CORNERS = [(x, y, z) for x in (0.0, 2.0) for y in (0.0, 2.0) for z in (0.0, 2.0)]
BOX = (CORNERS, [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)])
SMALL = ([(x / 4, y / 4, z / 4) for x, y, z in CORNERS], BOX[1])
PENETRATION = ("--contacts", "penetration", "--solid")


class Penetration(ProgramTest):
    maxDiff = None

    def setUp(self):
        super().setUp()
        self.write("a.obj", BOX)
        self.write("b.obj", moved(BOX, 1.25, 1.5, 1.625))

    def frame(self, *arguments):
        (frame,) = self.detect(*arguments, *PENETRATION)["frames"]
        return frame

    def test_vertices_inside_both(self):
        frame = self.frame("a.obj", "b.obj", "--verify")
        self.assertEqual([list(group) for group in frame["penetration"]], 2 * [["a", "b", "vertices", "on_surface"]])
        self.assertEqual([(g["a"], g["b"], [row[0::2] for row in g["vertices"]]) for g in frame["penetration"]], [(0, 1, [[7, 0.375]]), (1, 0, [[0, 0.375]])])
        self.assertEqual((frame["containment"], frame["contained_parts"]), ([], []))
        (curve,) = frame["curves"]
        pairs = frame["triangle_pairs"][0]["pairs"]
        self.assertEqual((curve["a"], curve["b"], curve["kind"], curve["segments"]), (0, 1, "closed", len(pairs)))
        verify = frame["penetration_verify"]
        self.assertEqual((verify["inside_vertices"], verify["differences"]), (2, []))
        self.assertEqual((frame["stats"]["penetrations"], frame["stats"]["curves"]), (2, 1))
        self.assertEqual(frame["events"]["penetration"], {"begin": [[0, 1]], "end": []})

    def test_contained_parts(self):
        self.write("within.obj", joined(moved(SMALL, 0.5, 0.5, 0.5), moved(SMALL, 1.25, 1.25, 1.25)))
        frame = self.frame("within.obj", "a.obj", "--verify")
        self.assertEqual(frame["containment"], [[0, 1]])
        self.assertEqual(frame["contained_parts"], [{"inner": 0, "outer": 1, "vertex": v, "vertex_count": 8, "is_whole": True} for v in (0, 8)])
        self.assertEqual((frame["triangle_pairs"], frame["curves"]), ([], []))
        self.assertEqual(len(frame["penetration"][0]["vertices"]), 16)
        self.write("partly.obj", joined(moved(SMALL, 0.5, 0.5, 0.5), moved(SMALL, 1.75, 1.75, 1.75)))
        frame = self.frame("partly.obj", "a.obj", "--verify")
        self.assertEqual((frame["containment"], len(frame["contained_parts"])), ([], 1))

    def test_vertices_on_the_surface(self):
        self.write("touching.obj", moved(SMALL, 2, 0.5, 0.5))
        frame = self.frame("touching.obj", "a.obj", "--verify")
        (group,) = frame["penetration"]
        self.assertEqual((group["vertices"], group["on_surface"]), ([], [0, 1, 2, 3]))

    def test_details(self):
        frame = self.frame("a.obj", "b.obj", "--contact-details")
        first = frame["penetrations"][0]
        self.assertEqual(list(first), ["a", "b", "vertex", "triangle", "feature", "depth", "barycentric", "point", "normal"])
        self.assertEqual((first["point"], first["normal"]), ([2, 2, 1.625], [0, 0, -1]))
        (curve,) = frame["curves"]
        self.assertEqual(list(curve), ["a", "b", "kind", "centroid", "area", "normal", "depth", "segments", "pairs", "points", "enclosed_a", "enclosed_b"])
        self.assertEqual((curve["enclosed_a"], curve["enclosed_b"]), ([7], [0]))
        self.assertEqual((len(curve["pairs"]), len(curve["points"])), (curve["segments"], curve["segments"]))
        self.assertGreater(curve["depth"], 0)

    def test_kinds_in_any_order(self):
        for kinds in ("penetration,proximity", "proximity,intersection,penetration"):
            result = self.detect("a.obj", "b.obj", "--contacts", kinds, "--solid", "--margin", "0.1")
            self.assertEqual(result["options"]["contacts"], "intersection,proximity,penetration")

    def test_scene_file(self):
        self.write("scene.toml", '[scene]\ncontacts = "penetration"\n[[object]]\nmesh = "a.obj"\nsolid = true\n[[object]]\nmesh = "b.obj"\n')
        (frame,) = self.detect("scene.toml")["frames"]
        self.assertEqual([(group["a"], group["b"]) for group in frame["penetration"]], [(1, 0)])

    def test_csv_and_tables(self):
        rows = self.run_here("detect", "a.obj", "b.obj", *PENETRATION, "--csv", "-").out.splitlines()
        self.assertEqual(rows[0], "frame,a,b,vertex,triangle,feature,depth")
        self.assertEqual([row.split(",")[:4] for row in rows[1:]], [["0", "0", "1", "7"], ["0", "1", "0", "0"]])
        done = self.run_here("detect", "a.obj", "b.obj", *PENETRATION, "--fail-on-contact", "--verify")
        self.assertEqual(done.status, 1)
        for words in ("1 curve (1 closed, 0 open, 0 branched)", "vertices inside", "no difference"):
            self.assertIn(words, done.out)

    def test_the_deepest_vertex_and_its_frame(self):
        for frame, depth in enumerate((0.125, 0.75, 0.375, 0.75)):
            self.write(f"f_{frame}.obj", moved(SMALL, 0.75, 0.75, 2 - depth))
        self.write("scene.toml", '[[object]]\nmesh = "a.obj"\nsolid = true\n[[object]]\nsolid = true\nmotion = { kind = "frames", files = "f_*.obj" }\n')
        done = self.run_here("detect", "scene.toml", "--frames", "4", "--contacts", "penetration")
        self.assertIn("The deepest is vertex", done.out)
        self.assertIn(": 0.75 in frame 1.", done.out)

    def test_flush_boxes(self):
        self.write("c.obj", moved(BOX, 0, 1.9375, 0))
        (curve,) = self.frame("a.obj", "c.obj", "--contact-details")["curves"]
        self.assertEqual((curve["kind"], curve["normal"], curve["depth"]), ("branched", [0, -1, 0], 0.0625))

    def test_a_vertex_that_is_not_finite(self):
        """Nothing is inside such a solid, and points on its other triangles are on it, for both commands."""
        corners = [*CORNERS[:7], (float("nan"), 2.0, 2.0)]
        self.write("torn.obj", (corners, BOX[1]))
        self.write("touching.obj", moved(SMALL, -0.5, 0.5, 0.25))
        self.write("within.obj", moved(SMALL, 0.25, 0.25, 0.5))
        self.write("points.txt", "0 0.5 0.25\n0.5 0.5 0.5\n")
        frame = self.frame("touching.obj", "torn.obj", "--verify")
        self.assertEqual([(g["a"], g["vertices"], g["on_surface"]) for g in frame["penetration"]], [(0, [], [4, 5, 6, 7])])
        self.assertEqual(frame["penetration_verify"]["differences"], [])
        self.assertEqual(self.frame("within.obj", "torn.obj")["penetration"], [])
        done = self.run_here("query", "inside", "points.txt", "torn.obj", "--json", "-")
        self.assertEqual(json.loads(done.out)["results"], ["on", "outside"])

    def test_errors(self):
        self.write("open.obj", (BOX[0], BOX[1][1:]))
        self.write("turned.obj", (BOX[0], [(1, 0, 3)] + BOX[1][1:]))
        self.write("scene.toml", '[scene]\ncontacts = "penetration,nothing"\n[[object]]\nmesh = "a.obj"\n')
        for arguments, parts in (
            (("open.obj", *PENETRATION), ("open is no solid", "open at 3 edges (vertices 0-1, 0-3, 1-3)")),
            (("turned.obj", *PENETRATION), ("turned is no solid", "turn against each other at 3 edges")),
            (("a.obj", "--solid"), ("--solid", "--contacts penetration")),
            (("a.obj", "--contacts", "none,penetration"), ("--contacts", "'none,penetration' is not none, or one or more of")),
            (("scene.toml",), ("scene.toml", "contacts", "'penetration,nothing' is not")),
        ):
            self.assert_one_line_error(self.run_here("detect", *arguments), *parts)


if __name__ == "__main__":
    unittest.main()
