"""`supple simulate` on several ranks: the same motion and contacts."""

import unittest

from ranks import SCENES, RanksTest


class Simulate(RanksTest):
    def test_scenes(self):
        self.assertIn("touches", self.assert_same(SCENES / "nine.toml", "--frames", 8, command="simulate"))
        self.assert_same(SCENES / "rigid.toml", "--frames", 6, "--contacts", "continuous", command="simulate",
                         ranks=(2,))
        self.assert_same(SCENES / "three_bikes.toml", "--frames", 8, command="simulate", ranks=(3,))
        self.assertIn("energy", self.assert_same(SCENES / "spring_lengths.toml", "--frames", 5, command="simulate", ranks=(2,)))

    def test_bodies_that_respond(self):
        """Each body depends on those that others touch."""
        for scene, ranks in (("rabbit_pile", 2), ("fish_tank", 3)):
            out = self.assert_same(SCENES / f"{scene}.toml", "--frames", 12, command="simulate", csv=False, ranks=(ranks,))
            self.assertIn("energy", out)
        self.assert_same(SCENES / "cloth_over_ball.toml", "--frames", 12, command="detect", csv=False, ranks=(2,))

    def test_a_motion_that_blows_up(self):
        scene = self.write("scene.toml", """
            [scene]
            time_step = 0.05
            [[object]]
            model = "box"
            motion = { kind = "mass_spring", velocity = [1, 0, 0] }
            [[object]]
            name = "stiff"
            model = "icosphere"
            translate = [9, 0, 0]
            motion = { kind = "mass_spring", stiffness = 1e5, random_force = 1, deform_seconds = 1 }
            """)
        alone = self.written(0, "simulate", [scene, "--frames", 1001], [])
        self.assertEqual(alone[0], 2)
        self.assertIn("stiff in step", alone[2])
        self.assertIn("is too long for stiff", alone[2])
        self.assertEqual(alone, self.written(2, "simulate", [scene, "--frames", 1001], []))


if __name__ == "__main__":
    unittest.main()
