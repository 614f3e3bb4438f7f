"""Tests `--parts`, which makes each connected part of a mesh an object, and `--manifolds`."""

import json
import unittest

from program import ProgramTest, joined, moved
from penetration_test import BOX

OPEN = (BOX[0], BOX[1][1:])


def scene(*lines):
    return "[[object]]\n" + "\n".join(lines) + "\n"


class Parts(ProgramTest):
    maxDiff = None

    def setUp(self):
        super().setUp()
        self.write("three.obj", joined(joined(BOX, moved(BOX, 1.25, 1.5, 1.625)), moved(OPEN, 9, 0, 0)))

    def test_parts_are_objects(self):
        run = self.detect("three.obj", "--parts")
        self.assertEqual([o["name"] for o in run["objects"]], ["three part 1", "three part 2", "three part 3"])
        self.assertEqual([o["triangles"] for o in run["objects"]], [12, 12, 11])
        parts = [o["part"] for o in run["objects"]]
        self.assertEqual({part["of"] for part in parts}, {"three"})
        self.assertEqual(parts[1], {"of": "three", "vertices": list(range(8, 16)), "triangles": list(range(12, 24))})
        (group,) = run["frames"][0]["triangle_pairs"]
        self.assertEqual((group["a"], group["b"]), (0, 1))
        self.assertNotIn("part", self.detect("three.obj")["objects"][0])
        self.write("box.obj", BOX)
        self.assertEqual([o["name"] for o in self.detect("box.obj", "--parts")["objects"]], ["box"])

    def test_closed_parts_are_solid(self):
        arguments = ("three.obj", "--parts", "--solid", "--contacts", "penetration")
        run = self.detect(*arguments)
        self.assertEqual([o["options"]["solid"] for o in run["objects"]], [True, True, False])
        self.assertEqual([len(g["vertices"]) for g in run["frames"][0]["penetration"]], [1, 1])
        done = self.run_here("detect", *arguments)
        self.assertEqual(done.status, 0, done.error)
        self.assertIn("2 of 3 parts are solid: three part 1, three part 2\nnot solid:\n  three part 3: the surface is open at 3 edges", done.out)
        self.assert_one_line_error(self.run_here("detect", "three.obj", "--solid", "--contacts", "penetration"), "is no solid")

    def test_weld_connects_seams(self):
        corners = [BOX[0][v] for triangle in BOX[1] for v in triangle]
        self.write("soup.obj", (corners, [(3 * t, 3 * t + 1, 3 * t + 2) for t in range(12)]))
        self.assertEqual(len(self.detect("soup.obj", "--parts")["objects"]), 12)
        (part,) = self.detect("soup.obj", "--parts", "--weld", "--solid", "--contacts", "penetration")["objects"]
        self.assertTrue(part["options"]["solid"])

    def test_scene_files_have_parts(self):
        self.write("scene.toml", scene('mesh = "three.obj"', "parts = true", 'motion = { kind = "wave", velocity = [0, 0.1, 0] }') + scene('mesh = "three.obj"', "translate = [0, 20, 0]"))
        self.assertEqual(len(self.detect("scene.toml", "--frames", "2")["objects"]), 4)
        self.assertEqual(len(self.detect("scene.toml", "--parts", "--frames", "2")["objects"]), 6)
        fixed = 'motion = { kind = "mass_spring", fixed = [[[8, -1, -1], [12, 3, 3]]] }'
        self.write("fixed.toml", scene('mesh = "three.obj"', "parts = true", fixed))
        self.assertEqual(len(self.detect("fixed.toml", "--frames", "2")["objects"]), 3)
        self.write("frames.toml", scene('mesh = "three.obj"', "parts = true", 'motion = { kind = "frames", files = "three.obj" }'))
        self.assertEqual(len(self.detect("frames.toml")["objects"]), 3)

    def test_sequences_have_parts(self):
        two = joined(BOX, moved(BOX, 5, 0, 0))
        for frame in range(3):
            self.write(f"f{frame}.obj", joined(BOX, moved(BOX, 5 - 2 * frame, 0, 0)))
        run = self.detect("--sequence", "f0.obj", "f1.obj", "f2.obj", "--parts")
        self.assertEqual([o["name"] for o in run["objects"]], ["f0 part 1", "f0 part 2"])
        self.assertEqual([len(frame["triangle_pairs"]) for frame in run["frames"]], [0, 0, 1])
        # The same frames as two sequences.
        for frame in range(3):
            self.write(f"b{frame}.obj", moved(BOX, 5 - 2 * frame, 0, 0))
        self.write("box.obj", BOX)
        self.write("both.toml", scene('mesh = "box.obj"') + scene('motion = { kind = "frames", files = "b*.obj" }'))
        separate = self.detect("both.toml", "--frames", "3")
        self.assertEqual([frame["triangle_pairs"] for frame in run["frames"]], [frame["triangle_pairs"] for frame in separate["frames"]])

    def test_query_has_parts(self):
        self.write("overlap.obj", joined(BOX, moved(BOX, 1, 0, 0)))
        self.write("points.txt", "1.5 1 1\n")
        inside = lambda *more: json.loads(self.run_here("query", "inside", "points.txt", "overlap.obj", "--json", "-", *more).out)["results"]
        self.assertEqual((inside(), inside("--parts")), (["outside"], ["inside"]))

    def test_says_where_parts_of_a_solid_intersect(self):
        self.write("overlap.obj", joined(BOX, moved(BOX, 1, 0.25, 0.25)))
        self.write("box.obj", moved(BOX, 9, 0, 0))
        arguments = ("detect", "overlap.obj", "box.obj", "--contacts", "penetration", "--solid")
        self.assertIn("overlap: connected parts of this solid intersect", self.run_here(*arguments).error)
        self.assertIn("--parts", self.run_here(*arguments).error)
        self.assertNotIn("--parts", self.run_here(*arguments, "--parts").error)

    def test_info(self):
        done = self.run_here("info", "three.obj", "--parts", "--json", "-")
        self.assertEqual([o["closed"] for o in json.loads(done.out)["objects"]], [True, True, False])


class Manifolds(ProgramTest):
    maxDiff = None

    def test_a_box_on_a_box(self):
        self.write("floor.obj", moved(BOX, 0, -2, 0))
        self.write("box.obj", moved(BOX, 0.5, 0, 0.25))
        (frame,) = self.detect("floor.obj", "box.obj", "--contacts", "penetration", "--solid", "--manifolds")["frames"]
        (manifold,) = frame["manifolds"]
        self.assertEqual(list(manifold), ["a", "b", "id", "lasting", "source", "normal", "depth", "record", "points"])
        self.assertEqual([manifold[key] for key in ("a", "b", "lasting", "source", "normal", "depth")], [0, 1, "begin", "curve", [0, -1, 0], 0])
        self.assertEqual(sorted(p["position"] for p in manifold["points"]), [[0.5, 0, 0.25], [0.5, 0, 2], [2, 0, 0.25], [2, 0, 2]])
        self.assertEqual(frame["ended_manifolds"], [])

    def test_ids_last(self):
        self.write("floor.obj", moved(BOX, 0, -2.125, 0))
        self.write("box_0.obj", BOX)
        self.write("box_1.obj", moved(BOX, 0.25, 0, 0))
        self.write("box_2.obj", moved(BOX, 0, 5, 0))
        self.write("scene.toml", scene('mesh = "floor.obj"', "margin = 0.125") + scene('mesh = "box_0.obj"', "margin = 0.125", 'motion = { kind = "frames", files = "box_*.obj" }'))
        frames = self.detect("scene.toml", "--frames", "3", "--contacts", "proximity", "--manifolds")["frames"]
        first, second = (frame["manifolds"][0] for frame in frames[:2])
        self.assertEqual((first["lasting"], second["lasting"], first["id"]), ("begin", "stay", second["id"]))
        self.assertEqual(sorted(p["id"] for p in first["points"]), sorted(p["id"] for p in second["points"]))
        self.assertEqual(second["depth"], -0.125)
        self.assertEqual((frames[2]["manifolds"], frames[2]["ended_manifolds"]), ([], [{"a": 0, "b": 1, "id": first["id"]}]))

    def test_needs_penetration_or_proximity(self):
        self.write("box.obj", BOX)
        self.assert_one_line_error(self.run_here("detect", "box.obj", "--manifolds"), "--manifolds", "penetration or proximity")


if __name__ == "__main__":
    unittest.main()
