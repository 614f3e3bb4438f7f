"""`supple detect` on several ranks: the same contacts, reports and errors."""

import unittest

from ranks import DATA, SCENES, RanksTest, launch
from program import CROSSED, FAR, FLOOR, SPIKE, TRIANGLE, UPRIGHT, joined, moved

# A tetrahedron, wound outward.
SOLID = ([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)],
         [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
NAN = float("nan")


class Detect(RanksTest):
    def test_scenes(self):
        self.assertIn("touches", self.assert_same(SCENES / "nine.toml", "--frames", 4))
        self.assert_same(SCENES / "rigid.toml", "--frames", 4, "--contacts", "continuous", ranks=(3,))
        self.assert_same(SCENES / "nine.toml", "--contacts", "intersection,continuous,proximity", "--margin", 0.05,
                         "--frames", 3, "--self", csv=False, ranks=(2,))
        # A response needs a step, which the start does not.
        self.assert_same(SCENES / "rabbit_pile.toml", csv=False, ranks=(3,))

    def test_brute_force(self):
        out = self.assert_same(SCENES / "nine.toml", "--verify", "--frames", 2, csv=False, ranks=(3,))
        self.assertIn("brute force", out)
        self.assert_same(SCENES / "nine.toml", "--verify", "--frames", 2, csv=False, command="simulate", ranks=(2,))

    def test_solids_and_parts(self):
        a, b = self.write("a.obj", SOLID), self.write("b.obj", moved(SOLID, 0.125, 0.125, 0.25))
        out = self.assert_same(a, b, "--contacts", "penetration", "--solid", ranks=(1, 2))
        self.assertIn("is inside", out)
        both = self.write("both.obj", CROSSED)
        self.assert_same(both, "--parts", ranks=(2,))

    def test_frames_of_files(self):
        for number in range(3):
            self.write(f"frame_{number}.obj", moved(SPIKE, 0.0, 0.0, -float(number)))
        self.write("floor.obj", FLOOR)
        scene = self.write("scene.toml", """
            [[object]]
            mesh = "floor.obj"
            [[object]]
            motion = { kind = "frames", files = "frame_*.obj" }
            """)
        self.assertIn("touches", self.assert_same(scene, "--contacts", "continuous", ranks=(2,)))

    def test_public_meshes(self):
        if not DATA.exists():
            self.skipTest(f"needs {DATA}")
        self.assert_same("--self", DATA / "models/self_intersectA.obj", ranks=(2,))
        self.assert_same(DATA / "models/spot.obj", DATA / "models/stanford-bunny.obj", ranks=(3,))
        frames = DATA / "kick/4[3-6].obj"
        self.assertIn("itself", self.assert_same("--sequence", "--self", frames, ranks=(2,)))
        self.assert_same("--sequence", "--self", "--contacts", "continuous", frames, ranks=(3,))

    def test_seams_of_an_object_that_moves(self):
        """Rank 1 has its positions, and rank 0 reports on them."""
        corners, faces = joined(TRIANGLE, moved(TRIANGLE, 0.0, 0.0, 0.0))
        self.write("frame_0.obj", (corners, faces))
        self.write("frame_1.obj", moved((corners, faces), 0.5, 0.0, 0.0))
        self.write("far.obj", joined(FAR, FAR))
        scene = self.write("scene.toml", """
            [[object]]
            mesh = "far.obj"
            [[object]]
            motion = { kind = "frames", files = "frame_*.obj" }
            self = true
            """)
        self.assertIn("vertices at equal positions", self.assert_same(scene, ranks=(2,)))

    def test_says_what_was_not_tested(self):
        a, far = self.write("a.obj", TRIANGLE), self.write("far.obj", FAR)
        broken = self.write("broken.obj", ([(NAN, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [(0, 1, 2)]))
        solid = self.write("solid.obj", SOLID)
        points = self.write("points.obj", "v 0 0 0\nv 1 0 0\np 1\np 2\n")
        for reason, arguments in {
            "only one object": [a],
            "only one object has a triangle": [a, broken],
            "not finite": [broken, broken],
            "no object has a triangle": [points, points],
            "nothing moves": [a, far, "--contacts", "continuous"],
        }.items():
            with self.subTest(reason):
                self.assertIn(reason, self.assert_same(*arguments, ranks=(2,)))
        for arguments in ([a, far], [solid, moved_file(self, SOLID), "--contacts", "penetration", "--solid"]):
            self.assertNotIn("tested", self.assert_same(*arguments, ranks=(2,)))
        scene = self.write("static.toml", """
            [[object]]
            mesh = "a.obj"
            static = true
            [[object]]
            mesh = "far.obj"
            static = true
            """)
        self.assertIn("all objects are static", self.assert_same(scene, ranks=(2,)))

    def test_exit_status(self):
        a, b = self.write("a.obj", TRIANGLE), self.write("b.obj", UPRIGHT)
        self.assertEqual(launch(2, "detect", a, b, "--fail-on-contact", "--quiet").returncode, 1)

    def test_errors_are_those_of_one_process(self):
        a = self.write("a.obj", TRIANGLE)
        for arguments in (["missing.obj"], [a, "--contact"]):
            with self.subTest(arguments):
                alone = self.written(0, "detect", arguments, [])
                self.assertEqual((alone[0], len(alone[2].splitlines())), (2, 1))
                self.assertEqual(alone, self.written(2, "detect", arguments, []))

    def test_an_error_of_one_rank_names_it(self):
        a = self.write("a.obj", TRIANGLE)
        self.write("frame_0.obj", TRIANGLE)
        self.write("frame_1.obj", CROSSED)
        scene = self.write("scene.toml", """
            [[object]]
            mesh = "a.obj"
            [[object]]
            motion = { kind = "frames", files = "frame_*.obj" }
            """)
        status, out, error, _ = self.written(2, "detect", [scene], [])
        self.assertEqual((status, out), (2, ""))
        self.assertRegex(error, r"^supple: rank 1: \S*frame_1.obj: has 6 vertices, but \S+ has 3;[^\n]*$")
        self.assertTrue(a.exists())

    def test_what_several_ranks_do_not_have(self):
        a, b = self.write("a.obj", TRIANGLE), self.write("b.obj", UPRIGHT)
        for what, options in {
            "--max-contacts": ["--max-contacts", 3],
            "weld": ["--weld"],
        }.items():
            with self.subTest(what):
                status, out, error, _ = self.written(2, "detect", [a, b, *options], [])
                self.assertEqual((status, out), (2, ""))
                self.assertEqual(error, f"supple: {what}: several ranks do not have it; leave it out, or start "
                                        "one process")


def moved_file(test, mesh):
    return test.write("moved.obj", moved(mesh, 5.0, 0.0, 0.0))


if __name__ == "__main__":
    unittest.main()
