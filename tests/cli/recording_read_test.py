"""Tests commands that read recordings: `supple detect` reproduces the recorded results, `supple diff` reports
differences, and damaged files are errors."""

import gzip
import json
import os
import pathlib
import unittest

from program import ROOT, TRIANGLE, ProgramTest
from recordings import SOLIDS, RecordingTest, h5py, with_h5py

DATA = pathlib.Path(os.environ.get("SUPPLE_DATA", ROOT.parent / "shared/data"))


class Detect(RecordingTest):
    """Detection on a recording gives the recorded results."""

    @with_h5py
    def test_intersections(self):
        self.record("run.h5", 70)
        frames = self.detect("run.h5", "--verify", "--contact-details")["frames"]
        self.assertEqual(len(frames), 70)
        total = 0
        with h5py.File(self.folder / "run.h5", "r") as file:
            for number, frame in enumerate(frames):
                self.assertEqual(frame["verify"]["differences"], [])
                pairs = [tuple(pair) for pair in frame["object_pairs"]]
                self.assertEqual(pairs, self.recorded(file, number, "object_pairs", "object_a", "object_b"))
                contacts = [(c["a"], c["b"], c["triangle_a"], c["triangle_b"], ("point", "segment", "polygon").index(c["kind"]),
                             len(c["points"])) for c in frame["contacts"]]
                columns = ("object_a", "object_b", "triangle_a", "triangle_b", "kind", "point_count")
                self.assertEqual(contacts, self.recorded(file, number, "contacts", *columns))
                points = [p["position"] for c in frame["contacts"] for p in c["points"]]
                self.assertEqual(points, [p for (p,) in self.recorded(file, number, "contact_points", "position")])
                normals = [c["normal"] for c in frame["contacts"]]
                self.assertEqual(normals, [n for (n,) in self.recorded(file, number, "contacts", "normal")])
                for kind in ("volume", "contact"):
                    for event in ("begin", "end"):
                        pairs = [tuple(pair) for pair in frame["events"][f"{kind}s"][event]]
                        stored = self.recorded(file, number, f"events/{kind}_{event}", "object_a", "object_b")
                        self.assertEqual(pairs, stored)
                total += len(contacts)
        self.assertGreater(total, 1000)

    @with_h5py
    def test_colliding_vertices(self):
        self.record("run.h5", 40, "--colliding-vertices", 1)
        frames = self.detect("run.h5", "--colliding-vertices", "--no-stats")["frames"]
        total = 0
        with h5py.File(self.folder / "run.h5", "r") as file:
            self.assertEqual(file.attrs["colliding_vertices"], 1)
            for number, frame in enumerate(frames):
                vertices = [v for (v,) in self.recorded(file, number, "colliding_vertices", "vertex")]
                columns = ("object_a", "object_b", "first_vertex", "count_a", "count_b")
                groups = [
                    {"a": a, "b": b, "vertices_a": vertices[first:first + count_a],
                     "vertices_b": vertices[first + count_a:first + count_a + count_b]}
                    for a, b, first, count_a, count_b in self.recorded(file, number, "colliding_vertex_groups", *columns)
                ]
                self.assertEqual(groups, frame["colliding_vertices"])
                for event in ("begin", "end"):
                    pairs = [tuple(pair) for pair in frame["events"]["narrow_phase"][event]]
                    self.assertEqual(pairs, self.recorded(file, number, f"events/narrow_phase_{event}", "object_a", "object_b"))
                    total += len(pairs)
        self.assertGreater(total, 0)
        # Without the option on the command line, the recorded option applies.
        self.assertEqual(frames, self.detect("run.h5", "--no-stats")["frames"])

    @with_h5py
    def test_continuous_contacts(self):
        self.record("run.h5", 70, "--contacts", "continuous")
        steps = self.detect("run.h5", "--contact-details", "--verify")["frames"]
        self.assertEqual(len(steps), 69)
        total = 0
        with h5py.File(self.folder / "run.h5", "r") as file:
            for number, step in enumerate(steps):
                self.assertEqual(step["verify"]["differences"], [])
                columns = ("object_a", "object_b", "kind", "element_a", "element_b", "toi", "point", "normal")
                stored = self.recorded(file, number + 1, "continuous_contacts", *columns)
                self.assertEqual([s[5:] for s in stored],
                                 [(c["toi"], c["point"], c["normal"]) for c in step["contacts"]])
                total += len(stored)
        self.assertGreater(total, 1000)

    def test_options(self):
        self.record("run.h5", 20)
        before = self.detect("run.h5", "--no-stats")
        for options in (("--broad-phase", "sweep"), ("--threads", "2"), ("--leaf-size", "3")):
            self.assertEqual(self.detect("run.h5", "--no-stats", *options), before)
        more = self.detect("run.h5", "--no-stats", "--self")
        self.assertEqual(more["objects"], before["objects"])
        self.assertEqual([o["name"] for o in more["objects"]], ["sphere", "box", "cloth é"])

    def test_info(self):
        self.record("run.h5", 2)
        self.assertIn("sphere", self.run_here("info", "run.h5").out)

    def test_errors(self):
        self.record("none.h5", 0)
        self.record("one.h5", 1)
        self.write("a.obj", TRIANGLE)
        for arguments, parts in (
            (["none.h5"], ["none.h5: the recording has no frame"]),
            (["one.h5", "--contacts", "continuous"], ["one.h5: one frame has no motion"]),
            (["one.h5", "a.obj"], ["one.h5: a recording must be the only input"]),
            (["one.h5", "--sequence"], ["one.h5: a recording has its own frames; leave out --sequence"]),
            (["one.h5", "--frames", "2"], ["--frames", "one.h5 has 1 frame"]),
            (["missing.h5"], ["missing.h5: there is no such file"]),
        ):
            with self.subTest(arguments=arguments):
                self.assert_one_line_error(self.run_here("detect", *arguments), *parts)


# A box, a ball that passes its corner, a small ball that passes into it, and a cloth that ends in it.


class Penetration(RecordingTest):
    def record_scene(self, scene, frames, *arguments, name="run"):
        """Writes a recording of a simulation and returns the frames of the JSON, without their times."""
        self.write("solids.toml", scene)
        done = self.run_here("simulate", "solids.toml", "--frames", frames, "--quiet", "--record", f"{name}.h5", "--json", f"{name}.json",
                             "--contact-details", "--no-stats", *arguments)
        self.assertEqual((done.status, done.error), (0, ""))
        frames = json.loads((self.folder / f"{name}.json").read_text())["frames"]
        for frame in frames:
            del frame["time"]
        return frames

    def assert_detected_again(self, frames):
        detected = self.detect("run.h5", "--contact-details", "--no-stats")["frames"]
        self.assertEqual(len(detected), len(frames))
        for number, frame in enumerate(frames):
            for key, value in frame.items():
                self.assertTrue(detected[number][key] == value, f"frame {number}, {key}")  # too long to print

    def assert_recorded(self, file, number, frame):
        """Compares a frame of a recording with the JSON."""
        recorded = lambda group, *columns: self.recorded(file, number, group, *columns)
        fields = ("vertex", "triangle", "depth", "barycentric", "point", "normal")
        self.assertEqual(recorded("penetrations", "object_a", "object_b", *fields),
                         [(p["a"], p["b"], *(p[field] for field in fields)) for p in frame["penetrations"]])
        self.assertEqual(["vef"[kind] for (kind,) in recorded("penetrations", "feature")], [p["feature"][0] for p in frame["penetrations"]])
        groups = recorded("penetration_groups", "object_a", "object_b", "first_penetration", "penetration_count", "first_on_surface", "on_surface_count")
        vertices = recorded("penetrations", "vertex", "triangle", "depth")
        on_surface = [v for (v,) in recorded("vertices_on_surface", "vertex")]
        self.assertEqual([{"a": a, "b": b, "vertices": [list(row) for row in vertices[first:first + count]],
                           "on_surface": on_surface[first_on:first_on + count_on]} for a, b, first, count, first_on, count_on in groups],
                         frame["penetration"])
        parts = recorded("contained_parts", "object_a", "object_b", "vertex", "vertex_count", "is_whole")
        self.assertEqual(parts, [tuple(part.values()) for part in frame["contained_parts"]])
        self.assertEqual({part[:2] for part in parts if part[4]}, {tuple(pair) for pair in frame["containment"]})
        contacts = recorded("contacts", "triangle_a", "triangle_b")
        along = [list(contacts[contact]) for (contact,) in recorded("curve_contacts", "contact")]
        points = [point for (point,) in recorded("curve_points", "position")]
        enclosed = [v for (v,) in recorded("enclosed_vertices", "vertex")]
        columns = ("object_a", "object_b", "kind", "first_contact", "contact_count", "first_point", "point_count",
                   "first_enclosed", "enclosed_count_a", "enclosed_count_b", "centroid", "area", "normal", "depth")
        curves = []
        for row in recorded("curves", *columns):
            c = dict(zip(columns, row))
            middle = c["first_enclosed"] + c["enclosed_count_a"]
            curves.append({"a": c["object_a"], "b": c["object_b"], "kind": ("closed", "open", "branched")[c["kind"]], "segments": c["contact_count"],
                           "pairs": along[c["first_contact"]:c["first_contact"] + c["contact_count"]],
                           "points": points[c["first_point"]:c["first_point"] + c["point_count"]],
                           "centroid": c["centroid"], "area": c["area"], "normal": c["normal"], "depth": c["depth"],
                           "enclosed_a": enclosed[c["first_enclosed"]:middle], "enclosed_b": enclosed[middle:middle + c["enclosed_count_b"]]})
        self.assertEqual(curves, frame["curves"])
        for event in ("begin", "end"):
            pairs = [tuple(pair) for pair in frame["events"]["penetration"][event]]
            self.assertEqual(recorded(f"events/penetration_{event}", "object_a", "object_b"), pairs)

    def assert_all_recorded(self, frames):
        with h5py.File(self.folder / "run.h5", "r") as file:
            for number, frame in enumerate(frames):
                self.assert_recorded(file, number, frame)
            solid = [int(file[f"objects/{i}"].attrs["solid"]) for i in range(len(file["objects"]))]
            self.assertEqual(solid, [1, 1, 1, 0])

    @with_h5py
    def test_every_field(self):
        frames = self.record_scene(SOLIDS, 8)
        self.assert_all_recorded(frames)
        self.assertGreater(sum(len(frame["penetrations"]) for frame in frames), 50)
        self.assertGreater(sum(len(frame["containment"]) for frame in frames), 1)
        self.assertEqual({curve["kind"] for frame in frames for curve in frame["curves"]} & {"closed", "open"}, {"closed", "open"})
        self.assertGreater(sum(len(frame["events"]["penetration"]["begin"]) for frame in frames), 1)
        self.assertGreater(sum(len(frame["events"]["penetration"]["end"]) for frame in frames), 0)

    def test_detect(self):
        frames = self.record_scene(SOLIDS, 8)
        self.assert_detected_again(frames)
        verified = self.detect("run.h5", "--verify")["frames"]
        self.assertEqual([frame["penetration_verify"]["differences"] for frame in verified], 8 * [[]])
        self.assertGreater(verified[4]["penetration_verify"]["inside_vertices"], 0)
        # Options of the command line replace recorded ones.
        self.assertNotIn("penetration", self.detect("run.h5", "--contacts", "intersection")["frames"][4])

    @with_h5py
    def test_real_meshes(self):
        models = DATA / "models"
        if not models.exists():
            self.skipTest(f"no {models}; set SUPPLE_DATA to the folder of truth.json")
        objects = "".join(f'[[object]]\nmesh = "{models / mesh}"\n{options}\n' for mesh, options in (
            ("spot.obj", "solid = true\nstatic = true"),
            ("spot.obj", 'solid = true\ntranslate = [-0.125, 0.25, 0.125]\nmotion = { kind = "rigid", velocity = [0.5, 0, 0], spin = [0, 40, 0] }'),
            ("spot.obj", 'solid = true\nscale = 0.125\ntranslate = [0, 0.125, -0.25]\nmotion = { kind = "rigid", velocity = [0, 0, 1] }'),
            ("stanford-bunny.obj", "scale = 8\ntranslate = [0, -0.75, 0]"),
        ))
        frames = self.record_scene(f'[scene]\ntime_step = 0.25\ncontacts = "penetration"\n{objects}', 4)
        self.assert_all_recorded(frames)
        self.assert_detected_again(frames)
        self.assertGreater(sum(len(frame["penetrations"]) for frame in frames), 1000)
        self.assertGreater(sum(len(frame["containment"]) for frame in frames), 0)
        self.assertGreater(sum(len(frame["curves"]) for frame in frames), 10)

    @with_h5py
    def test_diff(self):
        self.record_scene(SOLIDS, 6, "--threads", 1)
        self.record_scene(SOLIDS, 6, "--threads", 2, name="other")
        done = self.run_here("diff", "run.h5", "other.h5")
        self.assertEqual((done.status, done.out, done.error), (0, "run.h5 and other.h5 are equal: 6 frames\n", ""))
        with h5py.File(self.folder / "other.h5", "r+") as file:
            row = int(file["penetrations/end"][3])
            file["penetrations/depth"][row] += 0.125
            file["curves/depth"][int(file["curves/end"][4])] += 1
        done = self.run_here("diff", "run.h5", "other.h5")
        self.assertEqual((done.status, done.error), (1, ""))
        self.assertRegex(done.out, r"^run\.h5 and other\.h5 differ in frame 4: penetration 0, vertex \d+ of object 0 'box' and object 1 'ball', "
                                   r"depth: [\d.]+ and [\d.]+\n$")
        done = self.run_here("diff", "run.h5", "other.h5", "--tolerance", "0.5")
        self.assertRegex(done.out, r"differ in frame 5: curve 0, object 0 'box' and object 1 'ball', depth: ")

    @with_h5py
    def test_damaged_files(self):
        self.record_scene(SOLIDS, 6)
        for path, part in (
            ("curve_contacts/contact", "/curve_contacts/contact: row 0 of frame 4 is 4294967295, not below "),
            ("curves/first_enclosed", "/curves/first_enclosed: row 0 of frame 4 is 4294967295, not below "),
            ("penetration_groups/penetration_count", "/penetration_groups/penetration_count: row 0 of frame 4 is 4294967295"),
            ("penetrations/triangle", "/penetrations/triangle: row 0 of frame 4 is 4294967295, not below "),
        ):
            (self.folder / "bad.h5").write_bytes((self.folder / "run.h5").read_bytes())
            with h5py.File(self.folder / "bad.h5", "r+") as file:
                file[path][int(file[path.split("/")[0] + "/end"][3])] = 4294967295
            self.assert_one_line_error(self.run_here("diff", "run.h5", "bad.h5"), "bad.h5: ", part)


class Version1(ProgramTest):
    """A recording of `SCENE`, written by the last program that used version 1 of the format. Its command was
    `simulate --steps 2 --contacts continuous --bounding-volume sphere
    --region-test grown-box --min-separation 0.001`."""

    SCENE = """[scene]
time_step = 0.25
[[object]]
name = "ball"
model = "icosphere"
frequency = 1
max_level = 3
leaf_size = 5
motion = { kind = "wave", velocity = [2, 0, 0] }
[[object]]
name = "plate"
model = "box"
size = [0.5, 2, 2]
translate = [1.75, 0, 0]
static = true
"""

    def setUp(self):
        super().setUp()
        packed = (pathlib.Path(__file__).parent / "version_1.h5.gz").read_bytes()
        (self.folder / "then.h5").write_bytes(gzip.decompress(packed))

    def test_options_and_defaults(self):
        result = self.detect("then.h5")
        options = {"contacts": "continuous", "bounding_volume": "sphere", "region_test": "grown_box", "min_separation": 0.001,
                   "undecided": "exact", "broad_phase": "octree", "scene_octree_arity": 8}
        self.assertEqual({key: result["options"][key] for key in options}, options)
        ball, plate = (each["options"] for each in result["objects"])
        self.assertEqual((ball["max_level"], ball["leaf_size"], ball["object_octree"], ball["static"]), (3, 5, "balanced", False))
        self.assertEqual((plate["max_level"], plate["leaf_size"], plate["tree_arity"], plate["static"]), (16, 64, 8, True))

    def test_contacts(self):
        self.write("scene.toml", self.SCENE)
        done = self.run_here("simulate", "scene.toml", "--frames", "3", "--contacts", "continuous", "--min-separation", "0.001",
                             "--bounding-volume", "sphere", "--broad-phase", "octree", "--region-test", "grown-box", "--scene-octree-expand-at", "2",
                             "--quiet", "--record", "now.h5", "--json", "now.json", "--contact-details")
        self.assertEqual((done.status, done.error), (0, ""))
        frames = json.loads((self.folder / "now.json").read_text())["frames"]
        again = self.detect("then.h5", "--contact-details")["frames"]
        self.assertGreater(len(again[-1]["contacts"]), 0)
        self.assertEqual([f["contacts"] for f in again], [f["contacts"] for f in frames[1:]])
        # Statistics may differ between versions of the program.
        done = self.run_here("diff", "then.h5", "now.h5", "--json", "-", "--quiet")
        difference = json.loads(done.out)
        self.assertTrue(difference["what"] is None or difference["what"].startswith("statistics"), difference)


class Diff(RecordingTest):
    def setUp(self):
        super().setUp()
        self.record("a.h5", 10)
        self.record("b.h5", 10, "--frames-between-flushes", 3)

    def test_equal(self):
        done = self.run_here("diff", "a.h5", "b.h5")
        self.assertEqual((done.status, done.out, done.error), (0, "a.h5 and b.h5 are equal: 10 frames\n", ""))
        done = self.run_here("diff", "a.h5", "b.h5", "--quiet")
        self.assertEqual((done.status, done.out, done.error), (0, "", ""))

    @with_h5py
    def test_different(self):
        with h5py.File(self.folder / "b.h5", "r+") as file:
            file["objects/2/positions"][7, 11, 1] += 0.125
        done = self.run_here("diff", "a.h5", "b.h5")
        self.assertEqual((done.status, done.error), (1, ""))
        self.assertRegex(done.out, r"^a\.h5 and b\.h5 differ in frame 7: position of vertex 11 of object 2 'cloth é': "
                                   r"\(.*\) and \(.*\)\n$")
        done = self.run_here("diff", "a.h5", "b.h5", "--json", "-", "--tolerance", "0.1")
        result = json.loads(done.out)
        self.assertEqual(done.status, 1)
        self.assertEqual(result["recordings"], ["a.h5", "b.h5"])
        self.assertEqual((result["equal"], result["frame"], result["frames"]), (False, 7, [10, 10]))
        self.assertIn("vertex 11", result["what"])
        self.assertEqual(self.run_here("diff", "a.h5", "b.h5", "--quiet").status, 1)
        self.assertEqual(self.run_here("diff", "a.h5", "b.h5", "--tolerance", "0.125").status, 0)

    def test_number_of_frames(self):
        self.record("b.h5", 9)
        done = self.run_here("diff", "a.h5", "b.h5")
        self.assertEqual((done.status, done.out), (1, "a.h5 and b.h5 differ: number of frames: 10 and 9\n"))

    def test_errors(self):
        text = self.write("text.h5", "no recording")
        (self.folder / "cut.h5").write_bytes((self.folder / "a.h5").read_bytes()[:100000])
        for arguments, parts in (
            (["a.h5"], ["RECORDING"]),
            (["a.h5", "b.h5", "a.h5"], ["RECORDING.h5"]),
            (["a.h5", "b.h5", "--tolerance", "-1"], ["--tolerance"]),
            (["a.h5", "missing.h5"], ["missing.h5: there is no such file"]),
            (["a.h5", text], ["text.h5: is no recording"]),
            (["a.h5", "cut.h5"], ["cut.h5: is damaged or cut short"]),
            (["a.h5", "."], [".: is a folder"]),
        ):
            with self.subTest(arguments=arguments):
                self.assert_one_line_error(self.run_here("diff", *arguments), *parts)

    @with_h5py
    def test_damaged_files(self):
        def delete(file):
            del file["contacts/kind"]

        def raise_version(file):
            file.attrs["version"] = 5

        for change, part in ((delete, "/contacts/kind: is missing"), (raise_version, "is a recording of version 5")):
            (self.folder / "bad.h5").write_bytes((self.folder / "a.h5").read_bytes())
            with h5py.File(self.folder / "bad.h5", "r+") as file:
                change(file)
            self.assert_one_line_error(self.run_here("diff", "a.h5", "bad.h5"), "bad.h5: ", part)

    @with_h5py
    def test_data_outside_of_the_file(self):
        """A recording from somewhere must not make the program read other files."""
        with h5py.File(self.folder / "a.h5", "r") as file:
            values = file["time"][()]
        (self.folder / "secret").write_bytes(values.tobytes())

        def replace(file, **storage):
            del file["time"]
            file.create_dataset("time", shape=values.shape, dtype=values.dtype, maxshape=(None,), **storage)

        def link(file, target):
            del file["time"]
            file["time"] = target

        def link_softly(file):
            file.move("objects/0/positions", "objects/0/others")
            file["objects/0/positions"] = h5py.SoftLink("/objects/0/others")

        def map_virtually(file):
            del file["time"]
            layout = h5py.VirtualLayout(values.shape, values.dtype)
            layout[:] = h5py.VirtualSource("a.h5", "time", values.shape)
            file.create_virtual_dataset("time", layout)

        def store_outside(file):
            del file["time"]
            file.create_dataset("time", shape=values.shape, dtype=values.dtype, external="secret")

        for change, part in (
            (lambda file: link(file, h5py.ExternalLink("a.h5", "/time")), "/time: is a soft or an external link"),
            (link_softly, "/objects/0/positions: is a soft or an external link"),
            (map_virtually, "/time: is not stored plainly"),
            (store_outside, "/time: is not stored plainly"),
            (lambda file: replace(file, chunks=(4,), compression="lzf"), "/time: is not stored plainly"),
            (lambda file: replace(file, chunks=(4,), shuffle=True), "/time: is not stored plainly"),
        ):
            (self.folder / "bad.h5").write_bytes((self.folder / "a.h5").read_bytes())
            with h5py.File(self.folder / "bad.h5", "r+") as file:
                change(file)
            for arguments in (["diff", "a.h5", "bad.h5"], ["detect", "bad.h5"], ["info", "bad.h5"]):
                with self.subTest(part=part, arguments=arguments):
                    self.assert_one_line_error(self.run_here(*arguments), "bad.h5: ", part)
        (self.folder / "same.h5").write_bytes((self.folder / "a.h5").read_bytes())
        with h5py.File(self.folder / "same.h5", "r+") as file:
            replace(file, chunks=(4,), compression="gzip")
            file["time"][()] = values
        done = self.run_here("diff", "a.h5", "same.h5")
        self.assertEqual((done.status, done.error), (0, ""))
        os.mkfifo(self.folder / "pipe.h5")
        self.assert_one_line_error(self.run_here("info", "pipe.h5"), "pipe.h5: is a pipe or a device")


if __name__ == "__main__":
    unittest.main()
