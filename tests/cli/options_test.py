"""Checks that every described option passes from the command line into a recording and from there into a new
detection. JSON shows the option at each stage."""

import re
import unittest

from program import ProgramTest, run

SCENE = """[scene]
time_step = 0.01
[[object]]
name = "a"
model = "icosphere"
frequency = 2
motion = { kind = "wave", velocity = [0.1, 0, 0] }
[[object]]
model = "box"
resolution = 3
"""


def flags_of(command):
    """The options in the help of a command with their value names; flags have an empty value name."""
    flags = {}
    for name, value in re.findall(r"^  (?:-\w, ?)?(--[\w-]+)(?:,--[\w-]+)*(?: ([A-Z|a-z0-9,-]+))?(?:  .*| \S.*)?$", run(command, "--help").out, re.M):
        flags[name] = value
    return flags


def other_value(choices, default):
    """A value other than the default, as command-line text and as JSON."""
    if choices.startswith("X,Y,Z,EDGE"):
        return "0.5,1,-2,3", [0.5, 1, -2, 3]
    if "|" in choices:
        words = choices.split("|")
        word = words[(words.index(str(default).replace("_", "-")) + 1) % len(words)]
        return word, word.replace("-", "_")
    if choices == "N":
        number = 4 if default == 8 else default + 3
        return str(number), number
    return "0.125", 0.125


class Options(ProgramTest):
    maxDiff = None

    def setUp(self):
        super().setUp()
        self.write("scene.toml", SCENE)
        result = self.detect("scene.toml")
        self.defaults = result["objects"][1]["options"] | result["options"]

    def others(self):
        """Maps each key to the arguments that change the option, and to the resulting JSON value."""
        flags, others = flags_of("simulate"), {}
        for key, default in self.defaults.items():
            name = "--" + key.replace("_", "-")
            if isinstance(default, bool):
                name = name if not default else "--no-" + name[2:]
                if name in flags:
                    others[key] = [name], not default
            elif name in flags:
                given, told = other_value(flags[name], default)
                others[key] = [name, given], told
        return others

    def test_all_options_but_those_of_scene_files_are_on_the_command_line(self):
        self.assertEqual(set(self.defaults) - set(self.others()), {"static", "group", "mask"})

    def runs(self):
        """Some options have an effect only with others; five runs change all of them."""
        octree = {"broad_phase": (["--broad-phase", "octree"], "octree")}
        intersection = {"contacts": (["--contacts", "intersection"], "intersection")}
        continuous = {"contacts": (["--contacts", "continuous"], "continuous")}
        with_octree = ("region_test", "scene_octree_max_level", "scene_octree_expand_at", "scene_octree_arity", "scene_octree_root", "scene_octree_min_level", "scene_octree_expand_for_large")
        proximity = {"contacts": (["--contacts", "proximity"], "proximity")}
        penetration = {"contacts": (["--contacts", "penetration"], "intersection,penetration")}
        of_continuous = ("min_separation", "undecided", "max_time", "skip_parting", "continuous_listing", "solid")
        of_proximity = ("margin", "proximity_listing", "solid")
        of_intersections = ("neighbours",)
        of_patches = ("manifolds", "curves")
        of_triangles = ("contact_points", "colliding_vertices", "sphere_fit", "descent", "lazy_refit")
        for fixed, without in (
            (octree | continuous, (*of_triangles, *of_proximity, *of_intersections, *of_patches)),
            (octree | intersection, (*of_continuous, *of_proximity, *of_patches, "element_kinds")),
            (intersection, (*of_continuous, *of_proximity, *of_patches, "element_kinds", *with_octree)),
            (proximity, (*of_continuous, *of_triangles, *of_intersections, *with_octree, "curves")),
            (penetration, ("lazy_refit", *(set(of_continuous + of_proximity) - {"solid"}), "element_kinds", *with_octree)),
        ):
            others = {key: other for key, other in (self.others() | fixed).items() if key not in without}
            words = [word for arguments, _ in others.values() for word in arguments]
            yield words, {key: told for key, (_, told) in others.items()}

    def told(self, result):
        return [each["options"] | result["options"] for each in result["objects"]]

    def expect(self, result, expected):
        for told in self.told(result):
            for key, value in expected.items():
                self.assertEqual((key, told[key]), (key, value))

    def test_from_the_command_line_through_a_recording(self):
        changed = set()
        for arguments, expected in self.runs():
            with self.subTest(arguments=arguments):
                self.expect(self.detect("scene.toml", *arguments), expected)
                done = self.run_here("simulate", "scene.toml", *arguments, "--frames", "4", "--quiet", "--json", "s.json", "--record", "run.h5")
                self.assertEqual((done.status, done.error), (0, ""))
                again = self.detect("run.h5")
                self.expect(again, expected)
                self.assertEqual(again["options"], self.detect("run.h5", *arguments)["options"])
                changed |= {key for key, value in expected.items() if value != self.defaults[key]}
        self.assertEqual(set(self.defaults) - changed, {"static", "group", "mask"})

    def test_the_command_line_comes_before_a_recording(self):
        done = self.run_here("simulate", "scene.toml", "--frames", "3", "--quiet", "--leaf-size", "7", "--contacts", "continuous", "--record", "run.h5")
        self.assertEqual((done.status, done.error), (0, ""))
        result = self.detect("run.h5", "--leaf-size", "9", "--broad-phase", "sweep")
        self.expect(result, {"leaf_size": 9, "broad_phase": "sweep", "contacts": "continuous"})
        # Whether an option has an effect depends on the recorded options.
        self.expect(self.detect("run.h5", "--min-separation", "0.5"), {"min_separation": 0.5})
        self.assert_one_line_error(self.run_here("detect", "run.h5", "--no-contact-points"), "--contacts intersection")

    def test_from_a_scene_file_through_a_recording(self):
        keys = 'self = true\nneighbours = "exact"\nmin_separation = 0.5\nweld = true\nstatic = true\nmargin = 0.25\nsolid = true\ngroup = 6\nmask = 5\nmax_level = 3\nleaf_size = 5\ntree_arity = 4\nobject_octree = "regular"\nrebuild_degraded = false\n'
        self.write("scene.toml", SCENE + keys)
        expected = {"self": True, "neighbours": "exact", "min_separation": 0.5, "weld": True, "static": True, "margin": 0.25, "solid": True, "group": 6, "mask": 5, "max_level": 3, "leaf_size": 5, "tree_arity": 4,
                    "object_octree": "regular", "rebuild_degraded": False}
        self.assertEqual(set(expected), set(self.detect("scene.toml")["objects"][1]["options"]))
        done = self.run_here("simulate", "scene.toml", "--frames", "2", "--quiet", "--record", "run.h5")
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertEqual(self.detect("run.h5")["objects"][1]["options"], expected)

    def test_the_older_word_for_waves(self):
        self.write("older.toml", SCENE.replace('"wave"', '"sway"'))
        new, older = (self.run_here("detect", name, "--frames", "5", "--json", "-", "--no-stats").out for name in ("scene.toml", "older.toml"))
        self.assertEqual(older, new)
        self.assertIn('"frame":4', new)

    def test_mistyped_key(self):
        for mistyped, meant in (("leafsize", "leaf_size"), ("own_separation", "min_separation")):
            self.write("scene.toml", SCENE + f"{mistyped} = 3\n")
            self.assert_one_line_error(self.run_here("detect", "scene.toml"), mistyped, f"did you mean {meant}?")


if __name__ == "__main__":
    unittest.main()
