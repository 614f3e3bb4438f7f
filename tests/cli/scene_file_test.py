"""Scene files: what they mean, bit for bit, and what is said about a wrong one."""

import hashlib
import math
import unittest

from program import ROOT, TRIANGLE, UPRIGHT, ProgramTest

# A mesh whose coordinates are not symmetric in any way, so that a wrong sign or order shows.
SHAPE = (
    [(0.1, 0.7, -0.3), (1.3, -0.2, 0.45), (-0.6, 0.9, 1.1), (0.25, -1.7, 0.65), (0.9, 0.35, -1.2)],
    [(0, 1, 2), (1, 2, 3), (0, 3, 4)],
)
# Cuts through it.
CUTTER = ([(-3.0, 0.11, -3.0), (3.0, 0.13, -3.0), (0.0, 0.07, 4.0)], [(0, 1, 2)])


class Meaning(ProgramTest):
    maxDiff = None

    def contacts(self, *arguments):
        (frame,) = self.detect(*arguments, "--self")["frames"]
        return frame["contacts"]

    def expect_placement(self, keys, place):
        """An object with these keys is the mesh whose points were placed here."""
        self.write("shape.obj", SHAPE)
        self.write("cutter.obj", CUTTER)
        self.write("placed.obj", ([place(*p) for p in SHAPE[0]], SHAPE[1]))
        self.write("scene.toml", f'[[object]]\nmesh = "cutter.obj"\n[[object]]\nmesh = "shape.obj"\n{keys}\n')
        expected = self.contacts("cutter.obj", "placed.obj")
        self.assertTrue(expected)
        self.assertEqual(self.contacts("scene.toml"), expected)

    def test_scale(self):
        self.expect_placement("scale = 0.3", lambda x, y, z: (x * 0.3, y * 0.3, z * 0.3))

    def test_translate(self):
        self.expect_placement("translate = [0.1, 0.2, 0.3]", lambda x, y, z: (x + 0.1, y + 0.2, z + 0.3))

    def test_quarter_turns_are_exact(self):
        self.expect_placement("rotate_xyz_degrees = [90, 0, 0]", lambda x, y, z: (x, -z, y))
        self.expect_placement("rotate_xyz_degrees = [0, 90, 0]", lambda x, y, z: (z, y, -x))
        self.expect_placement("rotate_xyz_degrees = [0, -90, 0]", lambda x, y, z: (-z, y, x))
        self.expect_placement("rotate_xyz_degrees = [0, 0, 90]", lambda x, y, z: (-y, x, z))
        self.expect_placement("rotate_xyz_degrees = [0, 0, 180]", lambda x, y, z: (-x, -y, z))
        self.expect_placement("rotate_xyz_degrees = [-90, -90, 0]", lambda x, y, z: (y, z, x))
        self.expect_placement("rotate_xyz_degrees = [0, 360, -720]", lambda x, y, z: (x, y, z))

    def test_order_is_scale_rotate_translate(self):
        self.expect_placement(
            "translate = [0.1, 0.2, 0.3]\nscale = 0.7\nrotate_xyz_degrees = [90, 0, 90]",
            lambda x, y, z: (z * 0.7 + 0.1, x * 0.7 + 0.2, y * 0.7 + 0.3),
        )

    def test_any_angle(self):
        self.write("point.obj", ([(1.0, 0.0, 0.0), (3.0, 0.0, 0.0), (3.0, 1.0, 0.0)], [(0, 1, 2)]))
        c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
        near = 1e-9
        box = f'[[object]]\nmodel = "box"\nsize = [{near}, {near}, {near}]\ntranslate = [{c}, {s}, 0]\n'
        self.write("scene.toml", f'{box}[[object]]\nmesh = "point.obj"\nrotate_xyz_degrees = [0, 0, 30]\n')
        self.assertTrue(self.contacts("scene.toml"))

    def test_infinite_coordinates_do_not_spread(self):
        self.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv inf 2 3\nf 1 2 3\nf 1 2 4\n")
        self.write("scene.toml", '[[object]]\nmesh = "open.obj"\ntranslate = [1, 1, 1]\nscale = 2\n')
        (frame,) = self.detect("scene.toml")["frames"]
        self.assertEqual(frame["non_finite"], [{"object": 0, "vertex": 3, "position": ["inf", 5.0, 7.0]}])

    def test_paths_start_at_the_scene_file(self):
        self.write("deep/mesh.obj", TRIANGLE)
        self.write("deep/scene.toml", '[[object]]\nmesh = "mesh.obj"\n')
        self.assertEqual(self.detect("deep/scene.toml")["objects"][0]["name"], "mesh")

    def test_options(self):
        self.write("a.obj", TRIANGLE)
        self.write("b.obj", UPRIGHT)
        scene = '[[object]]\nname = "first"\nmesh = "a.obj"\n{}\n[[object]]\nmesh = "b.obj"\n{}\n'

        def pairs(first, second):
            self.write("scene.toml", scene.format(first, second))
            return self.detect("scene.toml")["frames"][0]["object_pairs"]

        self.assertEqual(pairs("", ""), [[0, 1]])
        self.assertEqual(self.detect("scene.toml")["objects"][0]["name"], "first")
        self.assertEqual(pairs("static = true", ""), [[0, 1]])
        self.assertEqual(pairs("static = true", "static = true"), [])
        self.assertEqual(pairs("group = 2", "mask = 2"), [[0, 1]])
        self.assertEqual(pairs("group = 2", "mask = 1"), [])

    def test_models(self):
        models = {
            'model = "pawn"': (154, 304), 'model = "fish"': (216, 338), 'model = "rabbit"': (453, 902),
            'model = "human"': (1250, 2500), 'model = "bike"': (9543, 18238), 'model = "icosphere"': (642, 1280),
            'model = "icosphere"\nfrequency = 1': (12, 20), 'model = "torus"\nrings = 5\nsides = 4': (20, 40),
            'model = "box"\nresolution = 2': (26, 48), 'model = "cloth"\ncolumns = 3\nrows = 2': (12, 12),
        }
        self.write("scene.toml", "".join(f"[[object]]\n{text}\n" for text in models))
        objects = self.detect("scene.toml", "--contacts", "none")["objects"]
        self.assertEqual([(o["vertices"], o["triangles"]) for o in objects], list(models.values()))

    def test_sway_stays_in_bounds_and_comes_back(self):
        motion = "velocity = [1, 0, 0], amplitude = 0"
        self.write(
            "scene.toml",
            '[scene]\nbounds = [[-1, -1, -1], [2, 1, 1]]\ntime_step = 0.5\n'
            f'[[object]]\nmodel = "box"\nmotion = {{ kind = "sway", {motion} }}\n'
            '[[object]]\nmodel = "box"\nsize = [0.001, 0.001, 0.001]\nscale = 0.5\ntranslate = [1.75, 0.5, 0]\n',
        )
        # The box is at 0, 0.5, 1, 1.5, where its border is the scene's; it comes back, as far as -0.5, and again.
        frames = self.detect("scene.toml", "--steps", "13")["frames"]
        touching = [f["frame"] for f in frames if f["contacts"]]
        self.assertEqual(touching, [3, 11])

    def test_motion_and_contacts_are_the_same_bits_everywhere(self):
        motion = 'motion = {{ kind = "sway", velocity = [{}, 0.3, -0.2], amplitude = 0.07, wavelength = 0.6, seed = {} }}\n'
        self.write(
            "scene.toml",
            "[scene]\nbounds = [[-1, -1, -1], [1, 1, 1]]\ntime_step = 0.07\n"
            '[[object]]\nmodel = "torus"\nrotate_xyz_degrees = [12.3, 45.6, 78.9]\n' + motion.format(0.4, 1) +
            '[[object]]\nmodel = "icosphere"\nscale = 0.4\ntranslate = [0.3, 0.1, 0]\n' + motion.format(-0.5, 2) +
            '[[object]]\nmodel = "cloth"\nself = true\nrotate_xyz_degrees = [-30, 0, 200]\n' + motion.format(0.1, 3),
        )
        done = self.run_here("detect", "scene.toml", "--steps", "60", "--json", "-", "--no-stats")
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertGreater(done.out.count('"segment"'), 1000)
        self.assertEqual(hashlib.sha256(done.out.encode()).hexdigest(), "2549d97f3a9bc71945b231455d358b56e64285918b907fca44052d737779e30c")

    def test_nine_deform_and_collide(self):
        frames = self.detect(ROOT / "scenes/nine.toml", "--steps", "300", "--no-contact-points")["frames"]
        began = [pair for frame in frames for pair in frame["events"]["contacts"]["begin"]]
        ended = [pair for frame in frames for pair in frame["events"]["contacts"]["end"]]
        self.assertGreater(len(began), 20)
        self.assertGreater(len(ended), 20)
        self.assertEqual({object for pair in began for object in pair}, set(range(9)))


class Errors(ProgramTest):
    def expect(self, text, line, *parts):
        with self.subTest(text=text):
            self.write("scene.toml", text)
            self.assert_one_line_error(self.run_here("detect", "scene.toml"), f"scene.toml:{line}: ", *parts)

    def test_toml(self):
        self.expect('[[object]\nmodel = "box"\n', 1, "TOML")
        self.expect('[[object]]\nmodel = "box"\nmodel = "box"\n', 3, "TOML")

    def test_unknown_keys_say_which_there_are(self):
        self.expect('[[object]]\nmodel = "box"\nscael = 2\n', 3, "[[object]] 0: scael", "scale", "translate")
        self.expect('[scene]\nborder = 1\n[[object]]\nmodel = "box"\n', 2, "[scene]: border", "bounds")
        self.expect('[[objects]]\nmodel = "box"\n', 1, "objects", "object")
        self.expect('[[object]]\nmodel = "box"\nfrequency = 3\n', 3, "frequency", "resolution")
        self.expect('[[object]]\nmodel = "box"\nmotion = { kind = "sway", speed = 1 }\n', 3, "motion: speed", "velocity")

    def test_values(self):
        box = '[[object]]\nmodel = "box"\n'
        self.expect(box + "scale = '2'\n", 3, "scale", "finite number")
        self.expect(box + "scale = nan\n", 3, "scale", "finite number")
        self.expect(box + "translate = [0, 1]\n", 3, "translate", "three")
        self.expect(box + "translate = [0, 1, inf]\n", 3, "translate", "three finite numbers")
        self.expect(box + "self = 1\n", 3, "self", "true or false")
        self.expect(box + "name = 1\n", 3, "name", "string")
        self.expect(box + "group = -1\n", 3, "group", "0 to 4294967295")
        self.expect(box + "max_level = 33\n", 3, "max_level", "0 to 32")
        self.expect(box + "leaf_size = 0\n", 3, "leaf_size", "1 to")
        self.expect(box + "resolution = 0\n", 3, "resolution", "1 to")
        self.expect(box + "size = [1, 0, 1]\n", 3, "size", "above 0")
        self.expect('[scene]\nbounds = [[0, 0, 0], [1, 0, 1]]\n' + box, 2, "bounds", "below")
        self.expect('[scene]\ntime_step = 0\n' + box, 2, "time_step", "above 0")

    def test_shape(self):
        self.expect('[[object]]\nname = "x"\n', 1, "[[object]] 0", "mesh", "model")
        self.expect('[[object]]\nmodel = "box"\nmesh = "a.obj"\n', 2, "mesh", "model")
        self.expect('[[object]]\nmodel = "cow"\n', 2, "model", "cow", "pawn", "icosphere")
        self.expect('[[object]]\nmesh = "nothing.obj"\n', 2, "mesh", "nothing.obj")

    def test_motion(self):
        box = '[[object]]\nmodel = "box"\n'
        self.expect(box + 'motion = "sway"\n', 3, "motion", "table")
        self.expect(box + 'motion = { kind = "swim" }\n', 3, "kind", "sway")
        self.expect(box + 'motion = { kind = "sway", period = 0 }\n', 3, "period", "above 0")
        self.expect(box + 'motion = { kind = "sway", seed = -1 }\n', 3, "seed", "0 to")
        self.expect(box + 'static = true\nmotion = { kind = "sway" }\n', 4, "motion", "static")

    def test_file(self):
        self.assert_one_line_error(self.run_here("detect", "none.toml"), "none.toml", "cannot read")
        self.write("empty.toml", "")
        self.assert_one_line_error(self.run_here("detect", "empty.toml"), "empty.toml", "[[object]]")


if __name__ == "__main__":
    unittest.main()
