"""Tests the lines and points of OBJ files: rods that fall on meshes, particles near meshes."""

import json
import os
import pathlib
import unittest

from program import ROOT, TRIANGLE, ProgramTest, moved, obj

DATA = pathlib.Path(os.environ.get("SUPPLE_DATA", ROOT.parent / "shared/data"))
FLOOR = obj([(-4.0, 0.0, -4.0), (4.0, 0.0, -4.0), (4.0, 0.0, 4.0), (-4.0, 0.0, 4.0)], [(0, 2, 1), (0, 3, 2)])


def rod(y):
    """A polyline of four vertices across the x axis."""
    return "".join(f"v {x} {y + 0.25 * abs(x)} 0.5\n" for x in (-1.0, 0.0, 1.0, 2.0)) + "l 1 2 3 4\n"


def scene(*objects):
    return "".join(f"[[object]]\n{lines}\n" for lines in objects)


class Lines(ProgramTest):
    maxDiff = None

    def test_a_rod_that_falls_on_a_mesh(self):
        self.write("floor.obj", FLOOR)
        for frame, y in enumerate((1.0, 0.375, -0.375)):
            self.write(f"rod_{frame}.obj", rod(y))
        self.write("scene.toml", scene('mesh = "floor.obj"', 'mesh = "rod_0.obj"\nmotion = { kind = "frames", files = "rod_*.obj" }'))
        first, second = self.detect("scene.toml", "--contacts", "continuous", "--frames", "3", "--verify")["frames"]
        self.assertEqual(first["continuous"], [])
        (group,) = second["continuous"]
        # The last vertex stays above the floor.
        self.assertEqual({v for _, v, _ in group["fv"]}, {0, 1, 2})
        self.assertAlmostEqual(second["earliest"], 0.5, delta=1e-6)
        self.assertEqual(second["verify"]["differences"], [])

    def test_rods_that_cross(self):
        self.write("a.obj", "v -1 0 0\nv 1 0 0\nl 1 2\n")
        for frame, y in enumerate((1, -1)):
            self.write(f"b_{frame}.obj", f"v 0 {y} -1\nv 0 {y} 1\nv 0.5 {y} 0\nl 1 2\np 3\n")
        self.write("scene.toml", scene('mesh = "a.obj"', 'mesh = "b_0.obj"\nmotion = { kind = "frames", files = "b_*.obj" }'))
        (frame,) = self.detect("scene.toml", "--contacts", "continuous", "--frames", "2", "--verify")["frames"]
        (group,) = frame["continuous"]
        self.assertEqual([key for key in group if group[key] != []], ["a", "b", "ee", "ev"])
        self.assertEqual([row[:4] for row in group["ee"]], [[0, 1, 0, 1]])
        self.assertEqual([row[:3] for row in group["ev"]], [[0, 1, 2]])
        self.assertEqual(frame["verify"]["differences"], [])

    def test_a_rod_through_a_mesh(self):
        self.write("floor.obj", FLOOR)
        self.write("rod.obj", "v 1 -1 2\nv 1.5 2 2\nl 1 2\n")
        (frame,) = self.detect("rod.obj", "floor.obj", "--contacts", "proximity", "--verify")["frames"]
        (group,) = frame["proximity"]
        self.assertEqual([key for key in group if group[key] != []], ["a", "b", "ef"])
        self.assertEqual([row[:2] + row[3:] for row in group["ef"]], [[0, 1, 0]])
        self.assertEqual(frame["proximity_verify"]["differences"], [])
        for inputs in (("rod.obj", "floor.obj"), ("floor.obj", "rod.obj")):
            done = self.run_here("query", "distance", *inputs, "--json", "-", "--verify")
            self.assertEqual((done.status, done.error), (0, ""))
            self.assertEqual(json.loads(done.out)["results"][0][:3], [0, 1, 0])
        self.write("above.obj", "v 1 1 2\nv 1.5 2 2\nl 1 2\n")
        done = self.run_here("query", "distance", "above.obj", "rod.obj", "floor.obj", "--json", "-", "--verify")
        self.assertEqual([row[2] for row in json.loads(done.out)["results"]][1:], [1, 0])

    def test_particles_near_a_mesh(self):
        self.write("floor.obj", FLOOR)
        self.write("particles.obj", "v 1 0.125 2\nv -1 2 -1\nv 3 -0.25 -1\np 1 2\np 3\n")
        arguments = ("floor.obj", "particles.obj", "--contacts", "proximity", "--margin", "0.125", "--verify")
        for listing in ("features", "elements"):
            (frame,) = self.detect(*arguments, "--proximity-listing", listing)["frames"]
            (group,) = frame["proximity"]
            self.assertEqual(sorted(v for _, v, _ in group["fv"]), [0, 2])
            self.assertEqual(sorted(distance for _, _, distance in group["fv"]), [0.125, 0.25])
            self.assertEqual(frame["proximity_verify"]["differences"], [])
        rows = self.run_here("detect", *arguments, "--csv", "-").out.splitlines()
        self.assertEqual(len(rows), 3)

    def test_listing_of_elements_with_lines(self):
        self.write("triangle.obj", TRIANGLE)
        self.write("rod.obj", "v 0.5 -0.125 -1\nv 0.5 -0.125 1\nl 1 2\n")
        (frame,) = self.detect("triangle.obj", "rod.obj", "--contacts", "proximity", "--margin", "0.5", "--proximity-listing", "elements")["frames"]
        (group,) = frame["proximity"]
        self.assertEqual(list(group), ["a", "b", "ve", "vf", "ee", "fv"])
        self.assertEqual([row[:3] for row in group["ve"]], [[0, 0, 1], [1, 0, 1]])
        self.assertEqual([row[:4] for row in group["ee"]], [[0, 1, 0, 1], [0, 2, 0, 1], [1, 2, 0, 1]])
        self.assertEqual(len(group["vf"]) + len(group["fv"]), 0)

    def test_a_rod_on_a_real_mesh(self):
        mesh = DATA / "models/spot.obj"
        if not mesh.exists():
            self.skipTest(f"no {DATA}; set SUPPLE_DATA to the folder of truth.json")
        for frame, y in enumerate((2.0, -2.0)):
            self.write(f"rod_{frame}.obj", "".join(f"v {0.01 * i - 0.5!r} {y!r} 0.1\n" for i in range(101)) + "l " + " ".join(str(i + 1) for i in range(101)) + "\np 1 101\n")
        self.write("scene.toml", scene(f'mesh = "{mesh}"', 'mesh = "rod_0.obj"\nmotion = { kind = "frames", files = "rod_*.obj" }'))
        (frame,) = self.detect("scene.toml", "--contacts", "continuous", "--frames", "2", "--verify")["frames"]
        (group,) = frame["continuous"]
        self.assertGreater(len(group["fv"]), 50)
        self.assertGreater(len(group["ee"]), 50)
        self.assertEqual(frame["verify"]["differences"], [])

    def test_recordings(self):
        self.write("floor.obj", FLOOR)
        self.write("rod.obj", rod(0.25) + "p 4\n")
        motion = 'motion = { kind = "rigid", velocity = [0, -1, 0] }'
        self.write("scene.toml", scene('mesh = "floor.obj"\nstatic = true', f'mesh = "rod.obj"\n{motion}'))
        arguments = ("--contacts", "continuous,proximity", "--margin", "0.01", "--no-stats", "--json", "-")
        done = self.run_here("simulate", "scene.toml", "--frames", "41", "--record", "run.h5", *arguments)
        self.assertEqual((done.status, done.error), (0, ""))
        simulated = json.loads(done.out)["frames"]
        self.assertTrue(any(frame["continuous"] for frame in simulated))
        again = self.detect("run.h5", "--no-stats", "--verify")["frames"]
        for before, frame in zip(simulated[1:], again[-40:], strict=True):
            self.assertEqual(frame["continuous"], before["continuous"])
            self.assertEqual(frame["proximity"], before["proximity"])
            self.assertEqual(frame["continuous_verify" if "continuous_verify" in frame else "verify"]["differences"], [])
        self.assertIn("elements per leaf", self.run_here("info", "rod.obj").out)
        self.assertIn("triangles per leaf", self.run_here("info", "floor.obj").out)
        (mesh,) = [m for m in json.loads(self.run_here("info", "run.h5", "--json", "-").out)["objects"] if m["name"] == "rod"]
        self.assertEqual((mesh["lines"], mesh["points"]), (3, 1))

    def test_frames_with_other_lines(self):
        self.write("rod_0.obj", rod(0))
        self.write("rod_1.obj", rod(0).replace("l 1 2 3 4", "l 1 2 4 3"))
        failed = self.run_here("detect", "--sequence", "rod_0.obj", "rod_1.obj", "--self", "--contacts", "continuous")
        self.assert_one_line_error(failed, "rod_1.obj: line 1 has different vertices than in rod_0.obj")
        self.write("rod_1.obj", rod(0) + "p 1\n")
        failed = self.run_here("detect", "--sequence", "rod_0.obj", "rod_1.obj", "--self", "--contacts", "continuous")
        self.assert_one_line_error(failed, "rod_1.obj: has 1 points, but rod_0.obj has 0")

    def test_malformed_lines(self):
        self.write("a.obj", "v 0 0 0\nv 1 0 0\nl 1 3\n")
        self.assert_one_line_error(self.run_here("info", "a.obj"), "a.obj:3: line index 3 is out of range; the file has 2 vertices")

    def test_queries_see_triangles_alone(self):
        self.write("mesh.obj", obj(*moved(TRIANGLE, 0, 0, 5)) + "v 0 0 0\np 4\nl 1 4\n")
        self.write("points.txt", "0 0 0\n")
        done = self.run_here("query", "closest", "points.txt", "mesh.obj", "--json", "-", "--verify")
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertEqual(json.loads(done.out)["results"], [[0, 0, 5]])


if __name__ == "__main__":
    unittest.main()
