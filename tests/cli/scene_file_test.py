"""Tests scene files: their exact meaning and the messages about errors."""

import hashlib
import json
import math
import unittest

from program import ROOT, TRIANGLE, UPRIGHT, ProgramTest

# A mesh without any symmetry, so a wrong sign or order changes the result.
SHAPE = (
    [(0.1, 0.7, -0.3), (1.3, -0.2, 0.45), (-0.6, 0.9, 1.1), (0.25, -1.7, 0.65), (0.9, 0.35, -1.2)],
    [(0, 1, 2), (1, 2, 3), (0, 3, 4)],
)
# A triangle that intersects it.
CUTTER = ([(-3.0, 0.11, -3.0), (3.0, 0.13, -3.0), (0.0, 0.07, 4.0)], [(0, 1, 2)])


class Meaning(ProgramTest):
    maxDiff = None

    def contacts(self, *arguments):
        (frame,) = self.detect(*arguments, "--self", "--contact-details")["frames"]
        return frame["contacts"]

    def expect_placement(self, keys, place):
        """Expects that an object with these keys equals the mesh with its points transformed by `place`."""
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
            f'[[object]]\nmodel = "box"\nmotion = {{ kind = "wave", {motion} }}\n'
            '[[object]]\nmodel = "box"\nsize = [0.001, 0.001, 0.001]\nscale = 0.5\ntranslate = [1.75, 0.5, 0]\n',
        )
        # The box is at 0, 0.5, 1, 1.5; the border reflects it there and again at -0.5.
        frames = self.detect("scene.toml", "--steps", "13")["frames"]
        touching = [f["frame"] for f in frames if f["triangle_pairs"]]
        self.assertEqual(touching, [3, 11])

    def test_motion_and_contacts_are_the_same_bits_everywhere(self):
        motion = 'motion = {{ kind = "wave", velocity = [{}, 0.3, -0.2], amplitude = 0.07, wavelength = 0.6, seed = {} }}\n'
        self.write(
            "scene.toml",
            "[scene]\nbounds = [[-1, -1, -1], [1, 1, 1]]\ntime_step = 0.07\n"
            '[[object]]\nmodel = "torus"\nrotate_xyz_degrees = [12.3, 45.6, 78.9]\n' + motion.format(0.4, 1) +
            '[[object]]\nmodel = "icosphere"\nscale = 0.4\ntranslate = [0.3, 0.1, 0]\n' + motion.format(-0.5, 2) +
            '[[object]]\nmodel = "cloth"\nself = true\nrotate_xyz_degrees = [-30, 0, 200]\n' + motion.format(0.1, 3),
        )
        done = self.run_here("detect", "scene.toml", "--steps", "60", "--json", "-", "--no-stats", "--contact-details")
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertGreater(done.out.count('"segment"'), 1000)
        self.assertEqual(hashlib.sha256(done.out.encode()).hexdigest(), "63f95707f71c544667fbb78096b94de6d5de5bd108e0987d3667076ac3472864")

    def test_nine_deform_and_collide(self):
        frames = self.detect(ROOT / "scenes/nine.toml", "--steps", "300", "--no-contact-points")["frames"]
        began = [pair for frame in frames for pair in frame["events"]["contacts"]["begin"]]
        ended = [pair for frame in frames for pair in frame["events"]["contacts"]["end"]]
        self.assertGreater(len(began), 20)
        self.assertGreater(len(ended), 20)
        self.assertEqual({object for pair in began for object in pair}, set(range(9)))


SPRINGS = 'motion = {{ kind = "mass_spring", {} }}\n'


class Copies(ProgramTest):
    def objects(self, text, steps=1, *arguments):
        """The names of the objects, and the pairs of objects that touch in each frame."""
        self.write("scene.toml", text)
        result = self.detect("scene.toml", "--steps", str(steps), *arguments)
        return [o["name"] for o in result["objects"]], [f["object_pairs"] for f in result["frames"]]

    def test_names_and_places(self):
        # A grid of 2 x 1 x 3 around (1, 0, 0). The probe comes last and is at the place of one copy.
        grid = '[[object]]\nname = "fish"\nmodel = "box"\nsize = [0.1, 0.1, 0.1]\ntranslate = [1, 0, 0]\n' \
               "repeat = [2, 1, 3]\nspacing = [2, 0, 5]\n"
        for x, z, copy in ((0, -5, 1), (2, -5, 2), (0, 0, 3), (2, 5, 6)):
            probe = f'[[object]]\nmodel = "box"\nsize = [0.01, 0.01, 0.01]\ntranslate = [{x}, 0, {z}]\n'
            names, frames = self.objects(grid + probe)
            self.assertEqual(names, [f"fish {n}" for n in range(1, 7)] + ["box"])
            self.assertEqual(frames, [[[copy - 1, 6]]])

    def test_a_single_copy_keeps_its_name(self):
        self.assertEqual(self.objects('[[object]]\nmodel = "box"\nrepeat = [1, 1, 1]\n')[0], ["box"])

    def test_random_rotation_keeps_shape_and_place_and_follows_the_seed(self):
        bounds = {}
        for seed in (1, 2):
            self.write("scene.toml", f'[scene]\nseed = {seed}\n[[object]]\nmodel = "box"\nsize = [4, 2, 1]\n'
                       "repeat = [3, 1, 1]\nspacing = [10, 0, 0]\nrandom_rotation = true\n")
            done = self.run_here("info", "scene.toml", "--json", "-")
            bounds[seed] = [o["bounds"] for o in json.loads(done.out)["objects"]]
            for copy, (low, high) in enumerate(bounds[seed]):
                center = [(a + b) / 2 for a, b in zip(low, high)]
                for value, expected in zip(center, (10 * (copy - 1), 0, 0)):
                    self.assertAlmostEqual(value, expected)
                # The half sides of a rotated box are between the shortest half side and the half diagonal.
                for a, b in zip(low, high):
                    self.assertTrue(0.5 - 1e-9 <= (b - a) / 2 <= math.sqrt(21) / 2 + 1e-9)
        corners = [str(b) for b in bounds[1] + bounds[2]]
        self.assertEqual(len(set(corners)), 6)

    def test_copies_sway_apart(self):
        text = '[[object]]\nmodel = "box"\nrepeat = [2, 1, 1]\nspacing = [1.05, 0, 0]\n' \
               'motion = { kind = "wave", amplitude = 0.2, seed = 1 }\n'
        _, frames = self.objects(text, 100)
        self.assertIn([], frames)
        self.assertIn([[0, 1]], frames)


class Frames(ProgramTest):
    def setUp(self):
        super().setUp()
        for number, shift in ((1, 0.0), (2, 1.0), (10, 2.0)):
            self.write(f"frames/f_{number}.obj", ([(x + shift, y, z) for x, y, z in TRIANGLE[0]], TRIANGLE[1]))
        # Intersects the placed triangle only at its position in the second frame.
        self.write("probe.obj", ([(12.2, 0.2, -1.0), (12.2, 0.2, 1.0), (12.21, 0.2, 0.0)], [(0, 1, 2)]))

    def touching(self, keys, steps):
        self.write("scene.toml", '[[object]]\nmesh = "probe.obj"\n[[object]]\nscale = 2\ntranslate = [10, 0, 0]\n'
                   f'motion = {{ kind = "frames", files = "frames/f_*.obj"{keys} }}\n')
        frames = self.detect("scene.toml", "--steps", str(steps))["frames"]
        return [f["frame"] for f in frames if f["triangle_pairs"]]

    def test_frame_k_at_step_k_then_the_last_holds(self):
        self.assertEqual(self.touching("", 8), [1])

    def test_loop(self):
        self.assertEqual(self.touching(", loop = true", 8), [1, 4, 7])

    def test_other_topology_is_an_error(self):
        self.write("frames/f_3.obj", (TRIANGLE[0], [(0, 2, 1)]))
        self.write("scene.toml", '[[object]]\nmotion = { kind = "frames", files = "frames/f_*.obj" }\n')
        done = self.run_here("detect", "scene.toml", "--steps", "9", "--quiet")
        self.assert_one_line_error(done, "f_3.obj", "triangle 0")


class Springs(ProgramTest):
    def touching(self, scene, motion, steps=40):
        """The frames in which the moving box touches the plate, which is perpendicular to the x axis at 1."""
        self.write("scene.toml", f"[scene]\ntime_step = 0.1\n{scene}\n"
                   '[[object]]\nname = "plate"\nmodel = "box"\nsize = [0.01, 9, 9]\ntranslate = [1.005, 0, 0]\nstatic = true\n'
                   f'[[object]]\nmodel = "box"\n{SPRINGS.format(motion)}')
        frames = self.detect("scene.toml", "--steps", str(steps), "--no-contact-points")["frames"]
        return [f["frame"] for f in frames if f["triangle_pairs"]]

    def test_kind_alone_is_enough_and_rests(self):
        self.assertEqual(self.touching("", "stiffness = 50.0"), [])

    def test_velocity(self):
        # From 0.5 to 1 at 0.25 m/s takes 2 s, which are 20 steps up to rounding.
        self.assertIn(self.touching("", "velocity = [0.25, 0, 0]")[0], (20, 21))

    def test_gravity_of_the_scene_and_of_its_own(self):
        # From 0.5 to 1 at 1 m/s² takes 1 s.
        for keys in ("", ", integrator = 'symplectic_euler'", ", integrator = 'backward_euler'", ", substeps = 4"):
            self.assertIn(self.touching("gravity = [1, 0, 0]", "damping = 0" + keys)[0], (9, 10, 11))
        self.assertEqual(self.touching("gravity = [1, 0, 0]", "gravity = [0, 0, 0]"), [])
        self.assertIn(self.touching("", "gravity = [1, 0, 0]")[0], (9, 10, 11))

    def test_border_turns_back(self):
        self.assertEqual(self.touching("bounds = [[-2, -2, -2], [0.9, 2, 2]]", "velocity = [0.25, 0, 0]"), [])

    def test_fixed_holds_against_gravity(self):
        motion = "gravity = [1, 0, 0], stiffness = 50, damping = 5, substeps = 4"
        self.assertTrue(self.touching("", motion))
        self.assertEqual(self.touching("", motion + ", fixed = [[[-0.5, -1, -1], [-0.5, 1, 1]]]", 200), [])

    def test_pull_moves_in_its_time_and_holds(self):
        # The side at 0.5 is pulled by 1 in 2 s: it reaches the plate after 1 s and stays beyond it.
        touching = self.touching("", "pull = [{ box = [[0.5, -1, -1], [0.5, 1, 1]], by = [1, 0, 0], seconds = 2 }]")
        self.assertIn(touching[0], (10, 11))
        self.assertEqual(touching, list(range(touching[0], 40)))

    def test_response_stops(self):
        response = "response = { thickness = 0.01, iterations = 8 }"
        self.assertEqual(self.touching(response, "velocity = [0.25, 0, 0], stiffness = 500, substeps = 4"), [])

    def test_response_raises_margins_to_three_quarters_of_its_thickness(self):
        def near(thickness):
            self.write("scene.toml", f'[scene]\ncontacts = "proximity"\nresponse = {{ thickness = {thickness} }}\n'
                       '[[object]]\nmodel = "box"\n[[object]]\nmodel = "box"\ntranslate = [1.014, 0, 0]\n')
            return bool(self.detect("scene.toml")["frames"][0].get("proximity"))

        self.assertTrue(near(0.01))
        self.assertFalse(near(0.009))

    def test_connected_pieces_stay_together(self):
        # Two triangles; one is fixed, and gravity pulls the other one to the plate.
        self.write("pieces.obj", ([(-0.4, 0, 0), (-0.4, 1, 0), (-0.4, 0, 1), (0.3, 0, 0), (0.6, 1, 0), (0.8, 0, 1)],
                                  [(0, 1, 2), (3, 4, 5)]))

        def touches(keys):
            motion = "gravity = [1, 0, 0], stiffness = 50, damping = 5, substeps = 4, fixed = [[[-0.5, 0, 0], [-0.3, 1, 1]]]"
            self.write("scene.toml", '[scene]\ntime_step = 0.1\n[[object]]\nmodel = "box"\nsize = [0.01, 9, 9]\n'
                       'translate = [1.005, 0, 0]\n[[object]]\nmesh = "pieces.obj"\n' + SPRINGS.format(motion + keys))
            return any(f["triangle_pairs"] for f in self.detect("scene.toml", "--steps", "40")["frames"])

        self.assertTrue(touches(""))
        self.assertFalse(touches(", connect_pieces = true"))

    def test_seed_decides_unless_the_object_has_one(self):
        def contacts(seed, keys):
            self.write("scene.toml", f'[scene]\nseed = {seed}\n[[object]]\nmodel = "icosphere"\n[[object]]\nmodel = "icosphere"\n'
                       + SPRINGS.format("random_speed = 1" + keys))
            return self.detect("scene.toml", "--steps", "20")["frames"][-1]["triangle_pairs"]

        self.assertEqual(contacts(1, ""), contacts(1, ""))
        self.assertNotEqual(contacts(1, ""), contacts(2, ""))
        self.assertNotEqual(contacts(1, ", seed = 5"), contacts(1, ", seed = 6"))


class Errors(ProgramTest):
    def expect(self, text, line, *parts):
        with self.subTest(text=text):
            self.write("scene.toml", text)
            self.assert_one_line_error(self.run_here("detect", "scene.toml"), f"scene.toml:{line}: ", *parts)

    def test_toml(self):
        self.expect('[[object]\nmodel = "box"\n', 1, "TOML")
        self.expect('[[object]]\nmodel = "box"\nmodel = "box"\n', 3, "TOML")

    def test_text_that_the_parser_cannot_take(self):
        for text, line, part in (
            (".".join(["a"] * 500_000) + " = 1\n", 1, "more than 64 parts"),
            ("\n\n[" + " . ".join(["a"] * 70) + "]\n", 3, "more than 64 parts"),
            ("a = " + "[" * 100_000, 1, "more than 64 levels"),
            ("a = " + "{ a = " * 100_000, 1, "more than 64 levels"),
            ("# ä\n[*", 2, "byte 0x2a outside of a string"),
            ("a = 1\nb = [[-3, }", 2, "'}' closes nothing that is open"),
            ("\n [ # name\n]", 2, "a table needs a name"),
            ("[[=", 1, "a table needs a name"),
            ("\ufedf", 1, "byte 0xef outside of a string"),
            ("a = 'b\na = \"\"\"\n*\n\"\"\" *\n", 4, "byte 0x2a"),
        ):
            self.expect(text, line, "not valid TOML", part)
        # Strings and comments may have everything.
        text = "\ufeff# a.b.c.[[[[ ä\n'" + "a." * 100 + "' = '''\n[[*\n'''\n" + r'"ä\"*" = [0.5, [1.5, 2.5]]' + "\n"
        self.expect(text, 2, "unknown key")
        with open(self.folder / "large.toml", "wb") as file:
            file.truncate(2**26 + 1)
        self.assert_one_line_error(self.run_here("detect", "large.toml"), "large.toml: a scene file has at most 64 MB")

    def test_unknown_keys_say_which_there_are(self):
        self.expect('[[object]]\nmodel = "box"\nscael = 2\n', 3, "[[object]] 0: scael", "scale", "translate")
        self.expect('[scene]\nborder = 1\n[[object]]\nmodel = "box"\n', 2, "[scene]: border", "bounds")
        self.expect('[[objects]]\nmodel = "box"\n', 1, "objects", "object")
        self.expect('[[object]]\nmodel = "box"\nfrequency = 3\n', 3, "frequency", "resolution")
        self.expect('[[object]]\nmodel = "box"\nmotion = { kind = "wave", speed = 1 }\n', 3, "motion: speed", "velocity")

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
        self.expect(box + 'motion = { kind = "swim" }\n', 3, "kind", "'swim'", "wave, mass_spring, rigid, frames")
        self.expect(box + 'motion = { velocity = [0, 0, 0] }\n', 3, "motion", "kind", "wave", "mass_spring", "frames")
        self.expect(box + 'motion = { kind = "wave", period = 0 }\n', 3, "period", "above 0")
        self.expect(box + 'motion = { kind = "wave", seed = -1 }\n', 3, "seed", "from 0 up")
        self.expect(box + 'static = true\nmotion = { kind = "wave" }\n', 4, "motion", "static")

    def test_scene(self):
        box = '[[object]]\nmodel = "box"\n'
        self.expect("[scene]\nseed = -1\n" + box, 2, "seed", "from 0 up")
        self.expect("[scene]\ngravity = 9.81\n" + box, 2, "gravity", "three finite numbers")
        self.expect("[scene]\nresponse = true\n" + box, 2, "response", "table")
        for text, parts in (
            ("thickness = 0", ["thickness", "above 0"]), ("restitution = 2", ["restitution", "0 to 1"]),
            ("friction = -1", ["friction", "from 0 up"]), ("iterations = 0", ["iterations", "1 to"]),
            ("hardness = 1", ["hardness", "thickness, restitution, friction, iterations"]),
        ):
            self.expect(f"[scene]\nresponse = {{ {text} }}\n" + box, 2, "[scene]: response", *parts)

    def test_copies(self):
        box = '[[object]]\nmodel = "box"\n'
        self.expect(box + "repeat = 3\n", 3, "repeat", "three whole numbers")
        self.expect(box + "repeat = [0, 1, 1]\n", 3, "repeat", "from 1 to")
        self.expect(box + "repeat = [2, 1, 1]\n", 3, "repeat", "spacing")
        self.expect(box + "repeat = [9999, 9999, 1]\nspacing = [1, 1, 1]\n", 3, "repeat", "allowed")
        self.expect(box + "spacing = [1, 1, 1]\n", 3, "spacing", "repeat")
        self.expect(box + "random_rotation = 1\n", 3, "random_rotation", "true or false")

    def test_springs(self):
        box = '[[object]]\nmodel = "box"\n'
        for text, parts in (
            ("integrator = 'euler'", ["integrator", "'euler'", "verlet, symplectic_euler, backward_euler"]),
            ("substeps = 0", ["substeps", "1 to"]), ("mass = 0", ["mass", "above 0"]),
            ("stiffness = -1", ["stiffness", "from 0 up"]), ("damping = -1", ["damping", "from 0 up"]),
            ("air_friction = -1", ["air_friction", "from 0 up"]), ("bending_stiffness = -1", ["bending_stiffness", "from 0 up"]),
            ("area_stiffness = -1", ["area_stiffness", "from 0 up"]),
            ("volume_stiffness = -1", ["volume_stiffness", "from 0 up"]), ("max_strain = 0", ["max_strain", "above 0"]),
            ("yield_strain = -1", ["yield_strain", "from 0 up"]), ("plastic_rate = 0", ["plastic_rate", "above 0"]),
            ("random_speed = -1", ["random_speed", "from 0 up"]), ("random_force = -1", ["random_force", "from 0 up"]),
            ("deform_seconds = -1", ["deform_seconds", "from 0 up"]), ("seed = 1.5", ["seed", "whole number"]),
            ("amplitude = 1", ["amplitude", "unknown key", "stiffness"]),
            ("fixed = 1", ["fixed", "array of boxes"]), ("fixed = [[[0, 0, 0]]]", ["fixed", "array of boxes"]),
            ("fixed = [[[0, 0, 0], [1, -1, 1]]]", ["fixed", "corner"]),
            ("fixed = [[[-9, -9, -9], [9, 9, 9]], [[5, 5, 5], [6, 6, 6]]]", ["fixed", "box 1 holds no vertex"]),
            ("pull = 1", ["pull", "pull = [{"]), ("pull = [{ by = [0, 0, 0] }]", ["pull 0", "box"]),
            ("pull = [{ box = [[0, 0, 0], [1, 1, 1]] }]", ["pull 0", "by"]),
            ("pull = [{ box = [[0, 0, 0], [1, 1, 1]], by = [0, 0, 0], seconds = 0 }]", ["pull 0", "seconds", "above 0"]),
            ("pull = [{ box = [[5, 5, 5], [6, 6, 6]], by = [0, 0, 0] }]", ["pull", "box 0 holds no vertex"]),
            ("fixed = [[[-9, -9, -9], [9, 9, 9]]], pull = [{ box = [[0, 0, 0], [1, 1, 1]], by = [0, 0, 0] }]", ["pull", "box 0", "fixed"]),
        ):
            self.expect(box + SPRINGS.format(text), 3, "[[object]] 0: motion", *parts)

    def test_frames(self):
        self.expect('[[object]]\nmotion = { kind = "frames" }\n', 2, "motion", "files")
        self.expect('[[object]]\nmotion = { kind = "frames", files = "f_*.ply" }\n', 2, "files", "f_*.ply", "no file matches")
        self.expect('[[object]]\nmotion = { kind = "frames", files = "f.ply" }\n', 2, "files", "f.ply", "no file")

    def test_file(self):
        self.assert_one_line_error(self.run_here("detect", "none.toml"), "none.toml", "there is no such file")
        self.write("empty.toml", "")
        self.assert_one_line_error(self.run_here("detect", "empty.toml"), "empty.toml", "[[object]]")


if __name__ == "__main__":
    unittest.main()
