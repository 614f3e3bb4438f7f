"""The method of the paper's program: the preset, its key in scene files, and changes of it."""

import json
import unittest

from program import CROSSED, ROOT, TRIANGLE, UPRIGHT, ProgramTest

SCENE = """[scene]
bounds = [[-3, -3, -3], [3, 3, 3]]
time_step = 0.02
%s
[[object]]
model = "fish"
motion = { kind = "mass_spring", stiffness = 8, damping = 0.25, random_force = 0.03, force_change_seconds = 1, random_speed = 0.4 }
[[object]]
model = "pawn"
translate = [0.2, 0.3, 0]
%s
"""
# What the preset sets, as JSON.
PRESET = {
    "broad_phase": "octree",
    "scene_octree_max_level": 2,
    "scene_octree_expand_at": 2,
    "scene_octree_expand_for_large": "on",
    "scene_octree_min_level": 1,
    "region_test": "grown_box",
    "scene_octree_root": [-3, -3, -3, 6],
    "contact_points": False,
    "colliding_vertices": True,
    "descent": "one_side_first",
    "lazy_refit": "on",
}
OCTREE = {"object_octree": "regular", "leaf_size": 1}


class MethodOf2007(ProgramTest):
    def result(self, *arguments):
        done = self.run_here("simulate", *arguments, "--frames", "30", "--quiet", "--json", "-")
        self.assertEqual((done.status, done.error), (0, ""), arguments)
        return json.loads(done.out)

    def contacts(self, result):
        return [[(group["a"], group["b"], group["pairs"]) for group in frame["triangle_pairs"]] for frame in result["frames"]]

    def check_options(self, result, **others):
        for key, value in (PRESET | others).items():
            if key not in OCTREE:
                self.assertEqual((key, result["options"][key]), (key, value))
        for each in result["objects"]:
            for key, value in OCTREE.items():
                self.assertEqual(each["options"][key], others.get(key, value))

    def test_the_preset_and_the_key_are_the_same(self):
        self.write("plain.toml", SCENE % ("", ""))
        self.write("key.toml", SCENE % ('method = "2007"', ""))
        plain, preset, key = self.result("plain.toml"), self.result("plain.toml", "--as-2007"), self.result("key.toml")
        self.check_options(preset)
        self.check_options(key)
        self.assertEqual(self.contacts(preset), self.contacts(key))
        self.assertEqual(self.contacts(preset), self.contacts(plain))
        self.assertGreater(sum(map(len, self.contacts(plain))), 5)
        self.assertTrue(any(frame["colliding_vertices"] for frame in preset["frames"]))

    def test_options_change_parts_of_it(self):
        self.write("key.toml", SCENE % ('method = "2007"\nlazy_refit = "off"\nbounding_volume = "sphere"', "leaf_size = 4"))
        changed = self.result("key.toml")
        self.assertEqual(changed["objects"][1]["options"]["leaf_size"], 4)
        self.assertEqual((changed["options"]["lazy_refit"], changed["options"]["descent"]), ("off", "one_side_first"))
        self.write("plain.toml", SCENE % ("", ""))
        for arguments, expected in (
            (("--lazy-refit", "off"), {"lazy_refit": "off"}),
            (("--fused-refit", "off"), {}),
            (("--bounding-volume", "sphere"), {"bounding_volume": "sphere"}),
            (("--scene-octree-root", "-4,-4,-4,8"), {"scene_octree_root": [-4, -4, -4, 8]}),
            (("--descent", "both-sides", "--leaf-size", "8"), {"descent": "both_sides", "leaf_size": 8}),
        ):
            with self.subTest(arguments):
                self.check_options(self.result("plain.toml", "--as-2007", *arguments), **expected)

    def test_its_steps_work_with_the_defaults(self):
        self.write("plain.toml", SCENE % ("", ""))
        expected = self.contacts(self.result("plain.toml"))
        for arguments in (("--lazy-refit", "on"), ("--lazy-refit", "on", "--fused-refit", "on"), ("--descent", "one-side-first"),
                          ("--broad-phase", "octree", "--scene-octree-min-level", "2"),
                          ("--scene-octree-max-level", "3", "--scene-octree-expand-for-large", "on")):
            with self.subTest(arguments):
                self.assertEqual(self.contacts(self.result("plain.toml", *arguments)), expected)

    def test_of_meshes_and_statistics(self):
        self.write("a.obj", TRIANGLE)
        self.write("b.obj", UPRIGHT)
        done = self.run_here("detect", "a.obj", "b.obj", "--as-2007", "--verify", "--json", "-")
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertEqual(json.loads(done.out)["frames"][0]["colliding_vertices"][0]["vertices_a"], [0, 1, 2])
        self.write("c.obj", CROSSED)
        done = self.run_here("info", "c.obj", "--as-2007", "--json", "-")
        self.assertEqual(json.loads(done.out)["objects"][0]["octree"]["leaves"], 2)

    def test_errors(self):
        self.write("a.obj", TRIANGLE)
        for arguments, words in (
            (("--as-2007", "--contacts", "proximity", "--margin", "1"), ("--as-2007", "intersection or none")),
            (("--as-2007", "--scene-octree-max-level", "0"), ("max_level", "from 1 to 6")),
            (("--lazy-refit", "on", "--bounding-volume", "obb"), ("--lazy-refit", "aabb or sphere")),
            (("--lazy-refit", "on", "--contacts", "continuous"), ("--lazy-refit", "intersection or none")),
            (("--descent", "one-side-first", "--contacts", "continuous"), ("--descent", "intersection or none")),
            (("--scene-octree-min-level", "1", "--broad-phase", "grid"), ("--scene-octree-min-level", "octree or automatic")),
        ):
            with self.subTest(arguments):
                self.assert_one_line_error(self.run_here("detect", "a.obj", "a.obj", *arguments), *words)
        for keys, words in (
            ('method = "2008"', ("method", "2007")),
            ('method = "2007"\ncontacts = "continuous"', ("method", "intersections")),
            ('fused_refit = "on"', ("fused_refit", "lazy_refit")),
        ):
            with self.subTest(keys):
                self.write("scene.toml", SCENE % (keys, ""))
                self.assert_one_line_error(self.run_here("simulate", "scene.toml"), *words)
        self.write("scene.toml", SCENE % ("", ""))
        self.assert_one_line_error(self.run_here("simulate", "scene.toml", "--fused-refit", "on"), "--fused-refit", "--lazy-refit on")


if __name__ == "__main__":
    unittest.main()
