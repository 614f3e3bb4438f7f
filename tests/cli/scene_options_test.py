"""Tests the keys of [scene] that choose the method and the bounding volume, and rigid motion."""

import json
import unittest

from program import ROOT, ProgramTest, run

OBJECTS = """
[[object]]
model = "icosphere"
frequency = 2
repeat = [3, 3, 3]
spacing = [1.6, 1.6, 1.6]
motion = { kind = "wave", velocity = [0.2, 0.1, 0], amplitude = 0.2 }
"""
BOUNDS = "bounds = [[-4, -3, -3], [4, 3, 5]]\n"
# The value as text in the file, as JSON, and keys without which it has no effect.
SPHERES, OCTREE = 'bounding_volume = "sphere"\n', 'broad_phase = "octree"\n'
KEYS = {
    "bounding_volume": ('"sphere"', "sphere", ""),
    "broad_phase": ('"sweep"', "sweep", ""),
    "scene_octree_max_level": ("3", 3, OCTREE),
    "scene_octree_expand_at": ("5", 5, OCTREE),
    "scene_octree_arity": ("2", 2, OCTREE),
    "scene_octree_min_level": ("1", 1, OCTREE),
    "scene_octree_expand_for_large": ('"on"', "on", OCTREE + "scene_octree_max_level = 2\n"),
    "descent": ('"one_side_first"', "one_side_first", ""),
    "lazy_refit": ('"on"', "on", ""),
    "scene_octree_root": ("[-1, -2, 0.5, 4]", [-1, -2, 0.5, 4], OCTREE),
    "region_test": ('"grown_box"', "grown_box", OCTREE + SPHERES),
    "sphere_fit": ('"box"', "box", SPHERES),
    "contacts": ('"intersection,continuous"', "intersection,continuous", ""),
    "contact_points": ("false", False, ""),
    "min_separation": ("0.25", 0.25, 'contacts = "continuous"\n'),
    "undecided": ('"report"', "report", 'contacts = "continuous"\n'),
    "max_time": ("0.5", 0.5, 'contacts = "continuous"\n'),
    "skip_parting": ("true", True, 'contacts = "continuous"\n'),
    "element_kinds": ('"edge_edge"', "edge_edge", 'contacts = "proximity"\n'),
    "continuous_listing": ('"first"', "first", 'contacts = "continuous"\n'),
    "manifolds": ("true", True, 'contacts = "proximity"\n'),
    "curves": ("false", False, 'contacts = "penetration"\n'),
    "colliding_vertices": ("true", True, ""),
    "proximity_listing": ('"elements"', "elements", 'contacts = "proximity"\n'),
}


class SceneOptions(ProgramTest):
    maxDiff = None

    def scene(self, keys, name="scene.toml", objects=OBJECTS):
        self.write(name, "[scene]\n" + keys + objects)
        return name

    def options(self, *arguments):
        return json.loads(self.done("detect", *arguments, "--json", "-").out)["options"]

    def done(self, *arguments):
        done = self.run_here(*arguments)
        self.assertEqual(done.status, 0, arguments)
        self.assertRegex(done.error, r"^(supple: warning: [^\n]*tested: [^\n]*\n)?$", arguments)
        return done

    def test_there_is_a_key_for_each_option(self):
        self.assertEqual(set(self.options(self.scene(""))), set(KEYS))

    def test_each_key_reaches_every_command(self):
        default = self.options(self.scene(""))
        for key, (text, told, others) in KEYS.items():
            with self.subTest(key=key):
                self.assertNotEqual(default[key], told)
                scene = self.scene(f"{others}{key} = {text}\n")
                self.assertEqual(self.options(scene)[key], told)
                self.done("simulate", scene, "--frames", "2", "--quiet", "--json", "s.json", "--record", "run.h5")
                self.assertEqual(json.loads((self.folder / "s.json").read_text())["options"][key], told)
                self.assertEqual(self.options("run.h5")[key], told)
                self.done("info", scene)

    def test_all_methods_find_the_same(self):
        expected = None
        for keys in (
            OCTREE,
            OCTREE + "scene_octree_max_level = 2\nscene_octree_expand_at = 3\nscene_octree_arity = 4\n",
            OCTREE + SPHERES + 'region_test = "grown_box"\nscene_octree_root = [10, 10, 10, 1]\n',
            OCTREE + BOUNDS + 'scene_octree_root = "border"\n',
            'broad_phase = "grid"\n', 'broad_phase = "brute"\n' + SPHERES,
        ):
            # The border changes the motion, so all scenes have it.
            scene = self.scene(keys if "bounds" in keys else keys + BOUNDS)
            result = json.loads(self.done("simulate", scene, "--frames", "20", "--verify", "--json", "-", "--no-stats").out)
            contacts = [frame["triangle_pairs"] for frame in result["frames"]]
            self.assertTrue(any(contacts))
            expected = expected or contacts
            self.assertEqual(contacts, expected, keys)

    def test_flags_come_before_keys(self):
        scene = self.scene(OCTREE + SPHERES + 'scene_octree_arity = 2\nregion_test = "grown_box"\n')
        self.assertEqual(self.options(scene, "--scene-octree-arity", "4")["scene_octree_arity"], 4)
        # The keys of the octree apply to the octree only.
        other = self.options(scene, "--broad-phase", "grid")
        self.assertEqual((other["broad_phase"], other["scene_octree_arity"]), ("grid", 8))
        # Whether a flag has an effect depends on the keys.
        self.assertEqual(self.options(scene, "--sphere-fit", "box")["sphere_fit"], "box")
        self.done("info", scene, "--sphere-fit", "box")
        sweep = self.scene('broad_phase = "sweep"\n')
        self.assert_one_line_error(self.run_here("detect", sweep, "--scene-octree-arity", "2"), "--scene-octree-arity", "--broad-phase octree or automatic")

    def test_root(self):
        scene = self.scene(BOUNDS + OCTREE)
        around_border = [-4, -4, -3, 8]
        self.assertEqual(self.options(scene, "--scene-octree-root", "border")["scene_octree_root"], around_border)
        self.assertEqual(self.options(scene, "--scene-octree-root=-1,2,3e2,0.5")["scene_octree_root"], [-1, 2, 300, 0.5])
        with_key = self.scene(BOUNDS + OCTREE + 'scene_octree_root = "border"\n')
        self.assertEqual(self.options(with_key)["scene_octree_root"], around_border)
        self.done("simulate", with_key, "--frames", "2", "--quiet", "--record", "run.h5")
        self.assertEqual(self.options("run.h5")["scene_octree_root"], around_border)
        self.assertIsNone(self.options(self.scene(OCTREE))["scene_octree_root"])

        for value in ("1,2,3", "1,2,3,0", "1,2,3,-4", "1,2,3,nan", "1,2,3,4,5", "borders"):
            self.assert_one_line_error(self.run_here("detect", scene, f"--scene-octree-root={value}"), "--scene-octree-root", f"'{value}'", "X,Y,Z,EDGE")
        self.assert_one_line_error(self.run_here("detect", self.scene(OCTREE), "--scene-octree-root", "border"), "--scene-octree-root", "bounds")
        for value in ("[1, 2, 3]", "[1, 2, 3, 0]", "[1, 2, 3, -1]", "[1, 2, nan, 1]", '"fitted"', "7"):
            scene = self.scene(f"{OCTREE}scene_octree_root = {value}\n")
            self.assert_one_line_error(self.run_here("detect", scene), "scene.toml:3", "scene_octree_root", "[x, y, z, edge]")
        self.assert_one_line_error(self.run_here("detect", self.scene(OCTREE + 'scene_octree_root = "border"\n')), "scene.toml:3", "bounds")

    def test_a_key_without_effect_is_an_error(self):
        for keys, parts in (
            ('broad_phase = "grid"\nscene_octree_arity = 4\n', ("scene.toml:3", "scene_octree_arity", "broad_phase = octree or automatic")),
            ('broad_phase = "brute"\nscene_octree_root = [0, 0, 0, 1]\n', ("scene_octree_root", "broad_phase")),
            ('broad_phase = "sweep"\nscene_octree_max_level = 3\n', ("scene_octree_max_level", "broad_phase")),
            ('broad_phase = "sweep"\nscene_octree_expand_at = 3\n', ("scene_octree_expand_at", "broad_phase")),
            (OCTREE + 'region_test = "arvo"\n', ("region_test", "bounding_volume = sphere")),
            (SPHERES + 'broad_phase = "grid"\nregion_test = "arvo"\n', ("region_test", "broad_phase")),
            ('sphere_fit = "box"\n', ("sphere_fit", "bounding_volume = sphere")),
            (SPHERES + 'contacts = "continuous"\nsphere_fit = "box"\n', ("sphere_fit", "contacts = intersection or none")),
            ("min_separation = 0.1\n", ("min_separation", "contacts = continuous")),
            ('contacts = "none"\ncontact_points = false\n', ("contact_points", "contacts = intersection")),
        ):
            for command in ("detect", "simulate", "info"):
                with self.subTest(keys=keys, command=command):
                    self.assert_one_line_error(self.run_here(command, self.scene(keys)), *parts)

    def test_a_flag_without_effect_is_an_error(self):
        scene = self.scene(BOUNDS)
        for command in ("detect", "simulate", "view"):
            for given, parts in (
                (("--broad-phase", "grid", "--scene-octree-max-level", "3"), ("--scene-octree-max-level", "--broad-phase octree")),
                (("--broad-phase", "sweep", "--scene-octree-expand-at", "3"), ("--scene-octree-expand-at", "--broad-phase octree")),
                (("--broad-phase", "brute", "--scene-octree-arity", "4"), ("--scene-octree-arity", "--broad-phase octree")),
                (("--broad-phase", "grid", "--scene-octree-root", "border"), ("--scene-octree-root", "--broad-phase octree")),
                (("--broad-phase", "octree", "--region-test", "arvo"), ("--region-test", "--bounding-volume sphere")),
                (("--broad-phase", "grid", "--bounding-volume", "sphere", "--region-test", "arvo"), ("--region-test", "--broad-phase octree")),
                (("--sphere-fit", "box"), ("--sphere-fit", "--bounding-volume sphere")),
                (("--bounding-volume", "sphere", "--contacts", "continuous", "--sphere-fit", "box"), ("--sphere-fit", "--contacts intersection or none")),
                (("--contacts", "none", "--no-contact-points"), ("--no-contact-points", "--contacts intersection")),
            ):
                with self.subTest(command=command, given=given):
                    self.assert_one_line_error(self.run_here(command, scene, *given), *parts)

    def test_a_flag_that_needs_another_flag_with_meshes(self):
        self.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        for given, parts in (
            (("--neighbours", "exact"), ("--neighbours", "--self")),
            (("--contacts", "continuous", "--skip-parting"), ("--skip-parting", "--min-separation")),
            (("--max-time", "0.5"), ("--max-time", "--contacts continuous")),
            (("--element-kinds", "edge-edge"), ("--element-kinds", "--contacts continuous or proximity")),
            (("--contacts", "continuous", "--neighbours", "exact", "--self"), ("--neighbours", "--contacts intersection")),
        ):
            with self.subTest(given=given):
                self.assert_one_line_error(self.run_here("detect", "a.obj", *given), *parts)
        self.done("detect", "a.obj", "--neighbours", "exact", "--self")
        self.done("detect", "a.obj", "--contacts", "continuous", "--skip-parting", "--min-separation", "0.1")

    def test_unknown_keys_and_values(self):
        self.assert_one_line_error(self.run_here("detect", self.scene("broad_fase = 1\n")), "scene.toml:2", "did you mean broad_phase?")
        self.assert_one_line_error(self.run_here("detect", self.scene('broad_phase = "tree"\n')), "'tree' is not one of automatic, octree")
        self.assert_one_line_error(self.run_here("detect", self.scene(OCTREE + "scene_octree_arity = 3\n")), "2, 4 or 8")


class Rigid(ProgramTest):
    def frames(self, scene, *arguments):
        done = self.run_here("simulate", scene, *arguments, "--json", "-")
        self.assertEqual((done.status, done.error), (0, ""))
        return json.loads(done.out)["frames"]

    def scene(self, motion, scene='broad_phase = "octree"', name="scene.toml"):
        self.write(name, f"""[scene]
bounds = [[-2, -2, -2], [2, 2, 2]]
seed = 5
{scene}
[[object]]
model = "rabbit"
repeat = [2, 2, 2]
spacing = [1.5, 1.5, 1.5]
motion = {{ kind = "rigid", {motion} }}
""")
        return name

    def test_a_translation_refits_nothing(self):
        for frame in self.frames(self.scene("random_speed = 1"), "--frames", "100", "--verify")[1:]:
            self.assertEqual((frame["stats"]["objects_refitted"], frame["stats"]["triangles_refitted"]), (0, 0))
        spinning = self.frames(self.scene("random_speed = 1, random_spin = 90"), "--frames", "20", "--verify")
        self.assertEqual({frame["stats"]["objects_refitted"] for frame in spinning[1:]}, {8})

    def test_the_seed_chooses_the_velocities(self):
        scene = self.scene("random_speed = 2, random_spin = 90")
        pairs = lambda *arguments: [frame["triangle_pairs"] for frame in self.frames(scene, "--frames", "150", *arguments)]
        first = pairs()
        self.assertTrue(any(first))
        self.assertEqual(pairs("--threads", "3"), first)
        self.assertNotEqual(pairs("--seed", "6"), first)

    def test_recording(self):
        scene = self.scene("random_speed = 2, random_spin = 90")
        expected = [frame["triangle_pairs"] for frame in self.frames(scene, "--frames", "100", "--record", "run.h5")]
        self.assertTrue(any(expected))
        done = self.run_here("detect", "run.h5", "--json", "-", "--verify")
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertEqual([frame["triangle_pairs"] for frame in json.loads(done.out)["frames"]], expected)

    def test_each_copy_has_its_own_seed(self):
        apart = self.frames(self.scene("random_speed = 0.5, seed = 3"), "--frames", "300", "--contacts", "none")
        self.assertTrue(any(frame["object_pairs"] for frame in apart), "with equal velocities the copies never meet")

    def test_the_scene_of_supple(self):
        frames = self.frames(ROOT / "scenes/rigid.toml", "--frames", "200", "--verify")
        self.assertTrue(any(frame["triangle_pairs"] for frame in frames))
        # Two rings spin and two rabbits deform; the other eight objects are only translated.
        self.assertEqual({frame["stats"]["objects_refitted"] for frame in frames[1:]}, {4})

    def test_errors(self):
        for motion, part in (("random_speed = -1", "a finite number from 0 up"), ("spin = 3", "three finite numbers"),
                             ("stiffness = 3", "unknown key"), ("random_spin = inf", "a finite number from 0 up")):
            self.assert_one_line_error(self.run_here("simulate", self.scene(motion)), "scene.toml:9", part)
        self.write("scene.toml", '[[object]]\nmodel = "box"\nstatic = true\nmotion = { kind = "rigid" }\n')
        self.assert_one_line_error(self.run_here("simulate", "scene.toml"), "static")


class SpringLengths(ProgramTest):
    def test_the_scene_of_supple(self):
        done = run("simulate", ROOT / "scenes/spring_lengths.toml", "--frames", "301", "--json", "-", "--no-stats")
        self.assertEqual((done.status, done.error), (0, ""))
        pairs = [[(group["a"], group["b"]) for group in frame["triangle_pairs"]] for frame in json.loads(done.out)["frames"]]
        self.assertEqual(pairs[0], [], "the balls are apart at first")
        self.assertEqual(pairs[-1], [(1, 2)], "the ball that grows reaches into its neighbour")
        self.assertFalse(any((0, 1) in frame for frame in pairs))


if __name__ == "__main__":
    unittest.main()
