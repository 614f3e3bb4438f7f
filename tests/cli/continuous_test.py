"""Tests `supple detect --contacts continuous`: elements that touch between two frames, and their times."""

import json
import unittest

from program import FAR, FLOOR, ROOT, SPIKE, TRIANGLE, UPRIGHT, ProgramTest, joined, moved

CONTINUOUS = ("--contacts", "continuous")
TOLERANCE = 2.0**-30
# Two upright blades in crossing planes. The first falls; its lower edge 0-1 passes through the upper edge 0-1
# of the second.
BLADE = ([(-1.0, 0.0, 1.0), (1.0, 0.0, 1.0), (0.0, 0.0, 9.0)], [(0, 1, 2)])
UPPER_EDGE = ([(0.0, -1.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, -9.0)], [(0, 1, 2)])


def rounded(rows):
    """Rounds times to multiples of 1/1024, like the expected ones; reported times may be slightly early."""
    return [[*row[:-1], round(row[-1] * 1024) / 1024] for row in rows]


class ContinuousTest(ProgramTest):
    maxDiff = None

    def fall(self, mesh, falling, *heights):
        """Writes frames frame_0.obj, … of one object: `mesh`, and `falling` raised by each of the heights."""
        for number, height in enumerate(heights):
            self.write(f"frame_{number}.obj", joined(mesh, moved(falling, 0, 0, height)))

    def write_scene(self, *objects):
        """Writes a scene of (name, mesh, velocity) with steps of one second."""
        text = "[scene]\ntime_step = 1\n"
        for name, mesh, velocity in objects:
            self.write(f"{name}.obj", mesh)
            text += f'[[object]]\nmesh = "{name}.obj"\n'
            if velocity:
                text += f'motion = {{ kind = "wave", velocity = {velocity}, amplitude = 0 }}\n'
        self.write("scene.toml", text)

    def steps(self, *arguments):
        return self.detect(*arguments, *CONTINUOUS)["frames"]

    def assert_groups(self, step, expected):
        groups = [{key: rounded(v) if isinstance(v, list) else v for key, v in group.items()} for group in step["continuous"]]
        self.assertEqual(groups, expected)
        times = [row[-1] for g in step["continuous"] for key in ("vf", "fv", "ee") for row in g.get(key, [])]
        self.assertEqual(step["earliest"], min(times, default=None))
        for time in times:
            self.assertLessEqual(time, round(time * 1024) / 1024)
            self.assertGreaterEqual(time, round(time * 1024) / 1024 - TOLERANCE)


class Json(ContinuousTest):
    def test_sequence(self):
        self.fall(FLOOR, SPIKE, 0, -2)
        result = self.detect("--sequence", "frame_?.obj", "--self", *CONTINUOUS)
        self.assertEqual([o["name"] for o in result["objects"]], ["frame_0"])
        (step,) = result["frames"]
        keys = ["frame", "files", "truncated", "untested", "object_pairs", "continuous", "earliest", "events", "non_finite", "stats"]
        self.assertEqual(list(step), keys)
        self.assert_groups(step, [{"a": 0, "b": 0, "vf": [[3, 0, 0.5]], "ee": []}])
        self.assertEqual(step["stats"]["contacts"], 1)
        self.assertGreaterEqual(step["stats"]["vertex_face_candidates"], 1)

    def test_sequence_is_tested_step_by_step(self):
        self.fall(FLOOR, SPIKE, 4, 1, -2, -30, -34)
        steps = self.steps("--sequence", "frame_?.obj", "--self")
        self.assertEqual([s["frame"] for s in steps], [1, 2, 3, 4])
        self.assertEqual([s["files"][0]["file"] for s in steps], [f"frame_{k}.obj" for k in (1, 2, 3, 4)])
        self.assertEqual([len(s["continuous"]) for s in steps], [0, 1, 1, 0])
        self.assertEqual((steps[0]["earliest"], steps[3]["earliest"]), (None, None))
        for number, step in enumerate(steps):
            (single,) = self.steps("--sequence", f"frame_{number}.obj", f"frame_{number + 1}.obj", "--self")
            self.assertEqual(step["continuous"], single["continuous"])

    def test_without_self_a_sequence_touches_nothing(self):
        self.fall(FLOOR, SPIKE, 0, -2)
        self.assert_groups(self.steps("--sequence", "frame_?.obj")[0], [])

    def test_two_objects(self):
        self.write_scene(("floor", FLOOR, None), ("spike", SPIKE, [0, 0, -2]))
        (step,) = self.steps("scene.toml")
        self.assert_groups(step, [{"a": 0, "b": 1, "vf": [], "fv": [[0, 0, 0.5]], "ee": []}])
        self.assertEqual(step["object_pairs"], [[0, 1]])
        self.write_scene(("spike", SPIKE, [0, 0, -2]), ("floor", FLOOR, None))
        self.assert_groups(self.steps("scene.toml")[0], [{"a": 0, "b": 1, "vf": [[0, 0, 0.5]], "fv": [], "ee": []}])

    def test_edges(self):
        self.write_scene(("blade", BLADE, [0, 0, -4]), ("upper", UPPER_EDGE, None))
        self.assert_groups(self.steps("scene.toml")[0], [{"a": 0, "b": 1, "vf": [], "fv": [], "ee": [[0, 1, 0, 1, 0.25]]}])
        self.write("frame_0.obj", joined(UPPER_EDGE, BLADE))
        self.write("frame_1.obj", joined(UPPER_EDGE, moved(BLADE, 0, 0, -4)))
        (step,) = self.steps("--sequence", "frame_?.obj", "--self")
        self.assert_groups(step, [{"a": 0, "b": 0, "vf": [], "ee": [[0, 1, 3, 4, 0.25]]}])

    def test_steps_of_a_scene_and_events(self):
        self.write_scene(("floor", FLOOR, None), ("spike", moved(SPIKE, 0, 0, 2), [0, 0, -2]))
        steps = self.steps("scene.toml", "--frames", "7")
        self.assertEqual([s["frame"] for s in steps], [1, 2, 3, 4, 5, 6])
        self.assert_groups(steps[1], [{"a": 0, "b": 1, "vf": [], "fv": [[0, 0, 0.5]], "ee": []}])
        touching = [s["frame"] for s in steps if s["continuous"]]
        self.assertEqual(touching, [2, 4])  # at 3.5 the upper vertices of the spike pass
        self.assertEqual([s["frame"] for s in steps if s["events"]["contacts"]["begin"]], [2, 4])
        self.assertEqual([s["frame"] for s in steps if s["events"]["contacts"]["end"]], [3, 5])

    def test_static_meshes_are_at_rest(self):
        self.write("a.obj", TRIANGLE)
        self.write("b.obj", UPRIGHT)
        self.write("far.obj", FAR)
        (step,) = self.steps("a.obj", "b.obj", "far.obj")
        # A tip of b is on the hypotenuse of a.
        self.assert_groups(
            step, [{"a": 0, "b": 1, "vf": [], "fv": [[0, 2, 0.0]], "ee": [[1, 2, 0, 2, 0.0], [1, 2, 1, 2, 0.0]]}]
        )
        self.assertEqual(step["earliest"], 0)

    def test_details(self):
        self.write_scene(("floor", FLOOR, None), ("spike", SPIKE, [0, 0, -2]))
        (step,) = self.steps("scene.toml", "--contact-details")
        (contact,) = step["contacts"]
        time, weights, point = contact.pop("toi"), contact.pop("barycentric_a"), contact.pop("point")
        self.assertEqual(time, step["earliest"])
        for given, expected in zip(weights + point, [0.5, 0.25, 0.25, 1, 1, 0]):
            self.assertAlmostEqual(given, expected, delta=1e-8)
        normal = [0.0, 0.0, -1.0]
        expected = {"a": 0, "b": 1, "kind": "fv", "element_a": 0, "element_b": 0, "touching_at_start": False, "start_distance": 1.0, "certainty": "certain", "barycentric_b": [1.0], "normal": normal}
        self.assertEqual(contact, expected)
        self.write_scene(("blade", BLADE, [0, 0, -4]), ("upper", UPPER_EDGE, None))
        (contact,) = self.steps("scene.toml", "--contact-details")[0]["contacts"]
        self.assertEqual((contact["kind"], contact["element_a"], contact["element_b"]), ("ee", [0, 1], [0, 1]))
        self.assertEqual((len(contact["barycentric_a"]), len(contact["barycentric_b"])), (2, 2))

    def test_min_separation(self):
        self.write_scene(("floor", FLOOR, None), ("spike", SPIKE, [0, 0, -0.5]))
        self.assert_groups(self.steps("scene.toml")[0], [])
        (step,) = self.steps("scene.toml", "--min-separation", "0.75", "--verify")
        self.assert_groups(step, [{"a": 0, "b": 1, "vf": [], "fv": [[0, 0, 0.5]], "ee": []}])
        self.assertEqual(step["verify"]["differences"], [])

    def test_undecided(self):
        # The spike slides in the plane of the floor and only just reaches its corner.
        flat = ([(-1.0, -1.0, 0.0), (-3.0, -2.0, 0.0), (-2.0, -3.0, 0.0)], [(0, 1, 2)])
        self.write_scene(("floor", FLOOR, None), ("flat", flat, [1, 1, 0]))
        (exact,) = self.steps("scene.toml")
        self.assertNotIn("within_tolerance", exact["continuous"][0])
        (step,) = self.steps("scene.toml", "--undecided", "report", "--contact-details")
        (group,) = step["continuous"]
        uncertain = group["within_tolerance"]
        self.assertEqual(list(uncertain), ["vf", "fv", "ee"])
        self.assertTrue(uncertain["fv"] + uncertain["vf"] + uncertain["ee"])
        certainty = [(c["kind"], c["certainty"] == "certain") for c in step["contacts"]]
        for kind in ("vf", "fv", "ee"):
            rows = [certain for name, certain in certainty if name == kind]
            self.assertEqual([row for row, certain in enumerate(rows) if not certain], uncertain[kind])
        csv = self.run_here("detect", "scene.toml", *CONTINUOUS, "--undecided", "report", "--csv", "-").out
        self.assertEqual(csv.count(",within_tolerance"), sum(len(rows) for rows in uncertain.values()))

    def test_verify(self):
        self.fall(joined(FLOOR, UPPER_EDGE), joined(SPIKE, BLADE), 0, -4)
        (step,) = self.steps("--sequence", "frame_?.obj", "--self", "--verify")
        touching = sum(len(group[kind]) for group in step["continuous"] for kind in ("vf", "ee"))
        checked = step["verify"].pop("element_pairs_checked")
        self.assertEqual(checked, 12 * 4 + 12 * 11 // 2)  # 12 vertices with 4 faces, and pairs of 12 edges
        self.assertGreater(touching, 2)
        self.assertEqual(step["verify"], {"touching_element_pairs": touching, "differences": []})
        done = self.run_here("detect", "--sequence", "frame_?.obj", "--self", "--verify", *CONTINUOUS)
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertIn(f"{checked} element pairs checked by brute force, no difference", done.out)

    def test_frames_that_are_not_the_same_object(self):
        self.fall(FLOOR, SPIKE, 0, -2)
        self.write("frame_2.obj", TRIANGLE)
        done = self.run_here("detect", "--quiet", "--sequence", "frame_?.obj", *CONTINUOUS)
        self.assert_one_line_error(done, "frame_2.obj", "3 vertices", "6")

    def test_positions_that_are_not_finite(self):
        self.write("frame_0.obj", joined(FLOOR, SPIKE))
        self.write("frame_1.obj", (self.folder / "frame_0.obj").read_text().replace("v 1.0 1.0 1.0", "v 1 1 -inf"))
        (step,) = self.steps("--sequence", "frame_?.obj", "--self")
        self.assertEqual([(v["object"], v["vertex"]) for v in step["non_finite"]], [(0, 3)])
        self.assert_groups(step, [])


class Tables(ContinuousTest):
    def test_csv(self):
        self.write_scene(("floor", FLOOR, None), ("spike", SPIKE, [0, 0, -2]), ("blade", moved(BLADE, 9, 9, 0), [0, 0, -4]), ("upper", moved(UPPER_EDGE, 9, 9, 0), None))
        done = self.run_here("detect", "scene.toml", *CONTINUOUS, "--csv", "-")
        self.assertEqual((done.status, done.error), (0, ""))
        header, *rows = done.out.splitlines()
        self.assertEqual(header, "frame,a,b,kind,element_a0,element_a1,element_b0,element_b1,certainty,touching_at_start,toi,start_distance")
        columns = [row.split(",") for row in rows]
        expected = ["1,0,1,fv,0,,0,,certain,false,0.5", "1,2,3,ee,0,1,0,1,certain,false,0.25"]
        self.assertEqual([",".join([*c[:10], str(round(float(c[10]) * 1024) / 1024)]) for c in columns], expected)

    def test_text(self):
        self.fall(FLOOR, SPIKE, 4, 0, -2)
        done = self.run_here("detect", "--sequence", "frame_?.obj", "--self", *CONTINUOUS)
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertIn("1 object, 2 triangles, 2 steps\n", done.out)
        self.assertRegex(done.out, r"(?m)^2 +1 +0 +0\.(5|49999999)\d*$")
        self.assertRegex(done.out, r"(?m)^0 frame_0 +itself +1 +1 +0$")
        done = self.run_here("detect", "--sequence", "frame_1.obj", "frame_1.obj", "--self", *CONTINUOUS)
        self.assertIn("Nothing touches.", done.out)


class SameBytes(ContinuousTest):
    """The same input gives the same bytes with every broad phase and number of threads."""

    def output(self, *arguments):
        scene = ROOT / "scenes/nine.toml"
        done = self.run_here("detect", scene, "--frames", 13, "--self", "--json", "-", "--no-stats", *CONTINUOUS, *arguments)
        self.assertEqual((done.status, done.error), (0, ""))
        return done.out

    def test_threads_and_broad_phases(self):
        expected = self.output("--threads", "1", "--contact-details")
        steps = json.loads(expected)["frames"]
        self.assertGreater(sum(len(s["contacts"]) for s in steps), 100)
        for arguments in (["--threads", "2"], ["--threads", "5"], ["--broad-phase", "sweep"], ["--broad-phase", "brute"], ["--broad-phase", "sweep3"]):
            with self.subTest(arguments=arguments):
                self.assertEqual(self.output(*arguments, "--contact-details"), expected)

    def test_octree_options_and_spheres_find_the_same_contacts(self):
        def contacts(*arguments):
            return [(s["continuous"], s["earliest"]) for s in json.loads(self.output(*arguments))["frames"]]

        expected = contacts()
        for arguments in (["--max-level", "3"], ["--leaf-size", "1"], ["--bounding-volume", "sphere"]):
            with self.subTest(arguments=arguments):
                self.assertEqual(contacts(*arguments), expected)


if __name__ == "__main__":
    unittest.main()
