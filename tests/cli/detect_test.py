"""Tests the results of `supple detect`: JSON as described in docs/json.md, CSV, tables, sequences."""

import json
import os
import pty
import subprocess
import unittest

from program import CROSSED, FAR, PROGRAM, ROOT, TRIANGLE, UPRIGHT, ProgramTest

STATS = {"broad_phase_method", 
    "refit_seconds", "broad_phase_seconds", "traversal_seconds", "exact_seconds", "sort_and_events_seconds", "total_seconds",
    "rebuild_seconds", "objects_refitted", "triangles_refitted", "octrees_rebuilt", "triangles_rebuilt", "object_pairs_tested", "object_pairs", "node_pairs_visited",
    "broad_phase_method", "boxes_tested", "candidate_pairs", "vertex_face_candidates", "edge_edge_candidates", "exact_fallbacks", "contacts", "proximity_pairs", "penetration_seconds", "manifold_seconds",
    "penetrations", "curves",
}


class Json(ProgramTest):
    maxDiff = None

    def setUp(self):
        super().setUp()
        for name, mesh in (("a", TRIANGLE), ("b", UPRIGHT), ("far", FAR), ("crossed", CROSSED)):
            self.write(f"{name}.obj", mesh)

    def test_two_meshes(self):
        result = self.detect("a.obj", "b.obj", "--contact-details")
        self.assertEqual(list(result), ["supple", "options", "objects", "frames", "truncated"])
        for given in result["objects"]:
            self.assertEqual(given.pop("options")["max_level"], 16)
        self.assertEqual(
            result["objects"],
            [{"name": "a", "vertices": 3, "triangles": 1}, {"name": "b", "vertices": 3, "triangles": 1}],
        )
        (frame,) = result["frames"]
        stats = frame.pop("stats")
        self.assertEqual(set(stats), STATS)
        self.assertEqual(stats["contacts"], 1)
        points = [
            {"position": [0.25, 0.25, 0.0], "feature_a": "f", "feature_b": "e0"},
            {"position": [0.75, 0.25, 0.0], "feature_a": "e1", "feature_b": "v2"},
        ]
        (contact,) = frame.pop("contacts")
        self.assertCountEqual(contact.pop("points"), points)
        self.assertEqual(contact, {"a": 0, "b": 1, "triangle_a": 0, "triangle_b": 0, "kind": "segment", "normal": [0.0, 1.0, 0.0]})
        self.assertEqual(
            frame,
            {
                "frame": 0,
                "truncated": False,
                "untested": [],
                "object_pairs": [[0, 1]],
                "triangle_pairs": [{"a": 0, "b": 1, "pairs": [[0, 0]]}],
                "self": [],
                "events": {"volumes": {"begin": [[0, 1]], "end": []}, "contacts": {"begin": [[0, 1]], "end": []}},
                "non_finite": [],
            },
        )

    def test_a_process_on_one_core_lacks_no_threads(self):
        done = subprocess.run(
            [PROGRAM, "detect", "a.obj", "b.obj"], cwd=self.folder, capture_output=True, text=True,
            preexec_fn=lambda: os.sched_setaffinity(0, [min(os.sched_getaffinity(0))]),
        )
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_without_contact(self):
        (frame,) = self.detect("a.obj", "far.obj")["frames"]
        for key in ("object_pairs", "triangle_pairs", "self", "non_finite"):
            self.assertEqual(frame[key], [], key)

    def test_self(self):
        (frame,) = self.detect("crossed.obj", "--self")["frames"]
        self.assertEqual(frame["self"], [{"a": 0, "pairs": [[0, 1]]}])
        self.assertEqual(frame["triangle_pairs"], [])
        (frame,) = self.detect("crossed.obj")["frames"]
        self.assertEqual(frame["self"], [])

    def test_contacts_none_finds_object_pairs_only(self):
        (frame,) = self.detect("a.obj", "b.obj", "--contacts", "none")["frames"]
        self.assertEqual(frame["object_pairs"], [[0, 1]])
        self.assertEqual((frame["triangle_pairs"], frame["self"]), ([], []))

    def test_no_contact_points(self):
        (frame,) = self.detect("a.obj", "b.obj", "--no-contact-points", "--contact-details")["frames"]
        self.assertEqual(frame["contacts"], [{"a": 0, "b": 1, "triangle_a": 0, "triangle_b": 0, "kind": "segment"}])

    def test_no_stats(self):
        result = self.detect("a.obj", "b.obj", "--no-stats")
        self.assertNotIn("stats", result["frames"][0])
        self.assertNotIn("options", result)
        self.assertEqual(list(result["objects"][0]), ["name", "vertices", "triangles"])

    def test_contacts_only_with_details(self):
        (frame,) = self.detect("a.obj", "b.obj")["frames"]
        self.assertNotIn("contacts", frame)

    def test_faces(self):
        self.write("quads.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 3 4\nf 2 1 5\n")
        faces = self.detect("quads.obj", "--faces")["objects"][0]["faces"]
        self.assertEqual(faces, [[0, 1, 2], [0, 2, 3], [1, 0, 4]])

    def test_colliding_vertices(self):
        (frame,) = self.detect("a.obj", "b.obj", "far.obj", "--colliding-vertices")["frames"]
        self.assertEqual(frame["colliding_vertices"], [{"a": 0, "b": 1, "vertices_a": [0, 1, 2], "vertices_b": [0, 1, 2]}])
        self.assertEqual(frame["events"]["narrow_phase"], {"begin": [[0, 1]], "end": []})

    def test_node_pairs(self):
        octree = ("--object-octree", "regular", "--leaf-size", "1")
        self.write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 8 8 8\nv 9 8 8\nv 8 9 8\nf 1 2 3\nf 4 5 6\n")
        self.write("near.obj", "v 8 8 7\nv 8 8 9\nv 9 9 8\nf 1 2 3\n")
        (frame,) = self.detect("two.obj", "near.obj", "--node-pairs", "0", "1", *octree)["frames"]
        # The root of two.obj has two children. The last one, its eighth octant, collides with the only node of
        # near.obj.
        levels = [[[[0, 0], [0, 0]]], [[[8, 1], [0, 0]]]]
        self.assertEqual(frame["node_pairs"], {"a": 0, "b": 1, "levels": levels})
        done = self.run_here("detect", "two.obj", "near.obj", "--node-pairs", "0", "1", *octree)
        self.assertRegex(done.out, r"(?m)^ +0 +1 +0   A\(0, 0\) A\(0, 0\)\n +1 +1 +1   A\(8, 1\) A\(0, 0\)$")
        done = self.run_here("detect", "two.obj", "near.obj", "--node-pairs", "1", "0", "--bounding-volume", "sphere", *octree)
        self.assertRegex(done.out, r"S\(0, 0\) S\(8, 1\)")
        # The octant 8 of the root has two triangles, which are in different octants of its octant 64.
        self.write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 8 8 8\nv 9 8 8\nv 8 9 8\nv 8 8 8.7\nv 9 8 8.7\nv 8 9 8.7\nf 1 2 3\nf 4 5 6\nf 7 8 9\n")
        (frame,) = self.detect("two.obj", "near.obj", "--node-pairs", "0", "1", *octree)["frames"]
        deepest = frame["node_pairs"]["levels"][-1]
        self.assertEqual(len(frame["node_pairs"]["levels"]), 3)
        for (h, k), _ in deepest:
            level, first = 0, 0
            while h > 8 * first:
                level, first = level + 1, 8 * first + 1
            self.assertEqual(k, level)
            self.assertGreater(k, 2)
        done = self.run_here("detect", "a.obj", "far.obj", "--node-pairs", "0", "1")
        self.assertIn("the broad phase does not report this pair", done.out)
        for wrong, message in (
            (("0", "7"), "there is no object 7; there are 2"),
            (("1", "1"), "object 1 is not tested against itself; add --self"),
            (("0", "x"), "--node-pairs"),
        ):
            self.assert_one_line_error(self.run_here("detect", "two.obj", "near.obj", "--node-pairs", *wrong), message)
        quiet = self.run_here("detect", "two.obj", "near.obj", "--node-pairs", "0", "1", "--quiet")
        self.assert_one_line_error(quiet, "has no effect without --json or tables")

    def test_csv_of_colliding_vertices(self):
        done = self.run_here("detect", "a.obj", "b.obj", "far.obj", "--colliding-vertices", "--csv", "-")
        vertices = [f"0,0,1,vertex_a,{v}," for v in range(3)] + [f"0,0,1,vertex_b,,{v}" for v in range(3)]
        rows = ["0,0,1,contact,0,0", *vertices, "0,0,1,narrow_phase_begin,,"]
        self.assertEqual(done.out.splitlines(), ["frame,a,b,kind,i,j", *rows])
        done = self.run_here("detect", "a.obj", "b.obj", "--colliding-vertices", "--contacts", "none", "--csv", "-")
        self.assertEqual(done.out.splitlines(), ["frame,a,b,kind,i,j", *rows[1:]])

    def test_verify(self):
        (frame,) = self.detect("a.obj", "b.obj", "--verify")["frames"]
        self.assertEqual(frame["verify"], {"triangle_pairs_checked": 1, "intersecting_pairs": 1, "differences": []})

    def test_non_finite_vertices(self):
        self.write("bad.obj", "v 0 0 nan\nv inf 0 0\nv 0 1 -inf\nv 2 0 0\nf 1 2 3\n")
        (frame,) = self.detect("bad.obj", "a.obj")["frames"]
        self.assertEqual(
            frame["non_finite"],
            [
                {"object": 0, "vertex": 0, "position": [0.0, 0.0, "nan"]},
                {"object": 0, "vertex": 1, "position": ["inf", 0.0, 0.0]},
                {"object": 0, "vertex": 2, "position": [0.0, 1.0, "-inf"]},
            ],
        )
        self.assertEqual(frame["triangle_pairs"], [])

    def test_numbers_read_back_to_the_same_bits(self):
        tip = (0.1, 1e-300, 123456789.12345679)
        self.write("tip.obj", ([tip, (1.0, 5.0, 123456789.5), (0.5, 5.0, 123456790.5)], [(0, 1, 2)]))
        self.write("other.obj", ([tip, (-1.0, -5.0, 0.0), (-1.0, -6.0, 0.5)], [(0, 1, 2)]))
        (frame,) = self.detect("tip.obj", "other.obj", "--contact-details")["frames"]
        (contact,) = frame["contacts"]
        self.assertEqual(contact["kind"], "point")
        self.assertEqual(contact["points"], [{"position": list(tip), "feature_a": "v0", "feature_b": "v0"}])

    def test_names_that_are_not_text(self):
        name = os.fsdecode(b"caf\xe9 \xc3\xa9\xed\xa0\x80.obj")
        self.write(name, TRIANGLE)
        self.assertEqual(self.detect(name)["objects"][0]["name"], "caf\ufffd \u00e9\ufffd\ufffd\ufffd")

    def test_to_a_file_next_to_tables(self):
        done = self.run_here("detect", "a.obj", "b.obj", "--json", "result.json")
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertIn("1 triangle pair", done.out)
        result = json.loads((self.folder / "result.json").read_text())
        self.assertEqual(len(result["frames"]), 1)

    def test_several_inputs_to_standard_output_are_one_document(self):
        result = self.detect("a.obj", "b.obj", "far.obj", "crossed.obj")
        self.assertEqual([o["name"] for o in result["objects"]], ["a", "b", "far", "crossed"])
        pairs = [(g["a"], g["b"]) for g in result["frames"][0]["triangle_pairs"]]
        self.assertEqual(pairs, [(0, 1), (0, 3), (1, 3)])

    def test_csv_has_the_same_pairs(self):
        arguments = ("a.obj", "b.obj", "crossed.obj", "--self")
        done = self.run_here("detect", *arguments, "--csv", "-")
        self.assertEqual((done.status, done.error), (0, ""))
        (frame,) = self.detect(*arguments, "--contact-details")["frames"]
        rows = [f"0,{c['a']},{c['b']},{c['triangle_a']},{c['triangle_b']},{c['kind']}" for c in frame["contacts"]]
        self.assertEqual(done.out.splitlines(), ["frame,a,b,triangle_a,triangle_b,kind", *rows])
        self.assertIn("0,2,2,0,1", [row.rsplit(",", 1)[0] for row in rows])


class SameBytes(ProgramTest):
    """The same input gives the same bytes with every broad phase and number of threads."""

    def output(self, *arguments):
        scene = ROOT / "scenes/nine.toml"
        done = self.run_here("detect", scene, "--steps", 12, "--self", "--json", "-", "--no-stats", "--contact-details", *arguments)
        self.assertEqual((done.status, done.error), (0, ""))
        return done.out

    def test_threads_and_broad_phases(self):
        expected = self.output("--threads", "1")
        self.assertIn('"pairs":[[', expected)
        for arguments in (["--threads", "2"], ["--threads", "5"], ["--broad-phase", "sweep"], ["--broad-phase", "brute"], ["--broad-phase", "sweep3"]):
            with self.subTest(arguments=arguments):
                self.assertEqual(self.output(*arguments), expected)

    def test_octree_options_and_spheres_find_the_same_contacts(self):
        def contacts(*arguments):
            frames = json.loads(self.output(*arguments))["frames"]
            return [(f["triangle_pairs"], f["self"], f["contacts"]) for f in frames]

        expected = contacts()
        sphere = ("--bounding-volume", "sphere")
        bottom_up = ("--object-octree", "bottom-up")
        for arguments in (["--max-level", "3"], ["--leaf-size", "1"], [*sphere], [*sphere, "--region-test", "grown-box"],
                          ["--object-octree", "regular"], [*bottom_up], [*bottom_up, "--tree-arity", "2"],
                          [*bottom_up, "--leaf-size", "1", *sphere], [*bottom_up, *sphere, "--sphere-fit", "minimal"]):
            with self.subTest(arguments=arguments):
                self.assertEqual(contacts(*arguments), expected)


class Polygons(ProgramTest):
    def test_nothing_touches_in_the_notch_of_a_concave_polygon(self):
        corners = "v -1 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 0 1 0\nv -1 1 0\n"
        self.write("notched.obj", corners + "f 1 2 3 4 5 6\n")
        self.write("inside.obj", ([(-0.1, 1.5, -1.0), (-0.1, 1.5, 1.0), (-0.12, 1.52, 1.0)], [(0, 1, 2)]))
        self.write("crossing.obj", ([(0.1, 1.5, -1.0), (0.1, 1.5, 1.0), (0.12, 1.52, 1.0)], [(0, 1, 2)]))
        (frame,) = self.detect("notched.obj", "inside.obj")["frames"]
        self.assertEqual(frame["triangle_pairs"], [])
        (frame,) = self.detect("notched.obj", "crossing.obj")["frames"]
        self.assertEqual(len(frame["triangle_pairs"]), 1)


class Sequence(ProgramTest):
    def setUp(self):
        super().setUp()
        for number in (1, 2, 9, 10, 11):
            shift = 0.1 * number
            moved = [(x + shift, y, z) for x, y, z in CROSSED[0][3:]]
            self.write(f"frame_{number}.obj", (CROSSED[0][:3] + moved, CROSSED[1]))

    def test_quoted_pattern_is_in_natural_order(self):
        result = self.detect("--sequence", "frame_*.obj", "--self", "--contact-details")
        self.assertEqual([o["name"] for o in result["objects"]], ["frame_1"])
        self.assertEqual([f["frame"] for f in result["frames"]], [0, 1, 2, 3, 4])
        singles = [self.detect(f"frame_{n}.obj", "--self", "--contact-details")["frames"][0] for n in (1, 2, 9, 10, 11)]
        for frame, single in zip(result["frames"], singles):
            for key in ("self", "contacts"):
                self.assertEqual(frame[key], single[key])
        files = [[f"frame_{n}.obj"] for n in (1, 2, 9, 10, 11)]
        self.assertEqual([[o["file"] for o in frame["files"]] for frame in result["frames"]], files)
        self.assertNotEqual(result["frames"][0]["contacts"], result["frames"][2]["contacts"])

    def test_files_keep_their_order(self):
        forward = self.detect("--sequence", "frame_1.obj", "frame_9.obj", "--self", "--contact-details")["frames"]
        backward = self.detect("--sequence", "frame_9.obj", "frame_1.obj", "--self", "--contact-details")["frames"]
        self.assertEqual(forward[0]["contacts"], backward[1]["contacts"])
        self.assertEqual(forward[1]["contacts"], backward[0]["contacts"])

    def test_number_of_frames(self):
        for flag in ("--frames", "--steps"):
            result = self.detect("--sequence", "frame_*.obj", flag, "3")
            self.assertEqual([f["frame"] for f in result["frames"]], [0, 1, 2])
        done = self.run_here("detect", "--sequence", "frame_*.obj", "--frames", "6")
        self.assert_one_line_error(done, "--frames", "frame_1.obj has 5 frames")

    def test_other_counts_are_an_error(self):
        self.write("frame_12.obj", TRIANGLE)
        done = self.run_here("detect", "--quiet", "--sequence", "frame_*.obj")
        self.assert_one_line_error(done, "frame_12.obj", "3 vertices", "6", "scene file", 'kind = "frames"')

    def test_other_triangles_are_an_error(self):
        self.write("frame_12.obj", (CROSSED[0], [(0, 1, 2), (3, 5, 4)]))
        done = self.run_here("detect", "--quiet", "--sequence", "frame_*.obj")
        self.assert_one_line_error(done, "frame_12.obj", "triangle 1")

    def test_gaps_in_the_numbers_are_named(self):
        note = "note: the numbers of the frames have 1 gap: frame 9 follows frame 2 directly\n"
        self.assertTrue(self.run_here("detect", "--sequence", "frame_*.obj", "--self").out.startswith(note))
        self.assertNotIn("note", self.run_here("detect", "--sequence", "frame_?.obj", "--self", "--json", "-").out)
        for files in (["frame_1.obj", "frame_9.obj"], ["frame_9.obj", "frame_10.obj", "frame_11.obj"]):
            self.assertNotIn("note", self.run_here("detect", "--sequence", *files, "--self").out)

    def test_folders_and_number_formats_are_answered_with_a_pattern(self):
        self.write("notes.txt", "")
        for mode in (["--sequence"], []):
            done = self.run_here("detect", *mode, self.folder)
            self.assert_one_line_error(done, f"{self.folder}: is a folder; give its files as a quoted pattern: '{self.folder}/frame_*.obj'")
            for name in ("frame_%d.obj", "frame_%04d.obj", "frame_####.obj"):
                self.assert_one_line_error(self.run_here("detect", *mode, name), f"{name}: no file has this name", "'frame_*.obj'")
        self.write("empty/notes.txt", "")
        self.assert_one_line_error(self.run_here("detect", "empty"), "empty: is a folder without mesh files")
        self.write("odd_%d.obj", TRIANGLE)
        self.assertEqual(len(self.detect("odd_%d.obj")["objects"]), 1)

    def test_stl_frames_in_which_corners_meet(self):
        def facets(*triangles):
            corners = ["\n".join(f"vertex {x} {y} {z}" for x, y, z in t) for t in triangles]
            return "solid\n" + "\n".join(f"facet normal 0 0 1\nouter loop\n{c}\nendloop\nendfacet" for c in corners) + "\nendsolid\n"

        low = ((0, 0, 0), (1, 0, 0), (0, 1, 0))
        self.write("m_1.stl", facets(low, ((0, 0, 2), (1, 0, 2), (0, 1, 2))))
        self.write("m_2.stl", facets(low, ((0, 0, 0), (1, 0, 2), (0, 1, 2))))
        first, second = self.detect("--sequence", "m_?.stl", "--self")["frames"]
        self.assertEqual(first["self"], [])
        self.assertEqual(second["self"], [{"a": 0, "pairs": [[0, 1]]}])
        # A vertex of the first frame cannot be at two places later.
        done = self.run_here("detect", "--sequence", "m_2.stl", "m_1.stl", "--self")
        self.assert_one_line_error(done, "m_1.stl: corners of vertex 0 part", "m_2.stl", "PLY")

    def test_pattern_with_characters_of_patterns_in_the_name(self):
        self.write("odd[1].obj", TRIANGLE)
        self.assertEqual(len(self.detect("odd[1].obj")["objects"]), 1)


class Streaming(ProgramTest):
    """A run of a thousand million frames prints its first results immediately."""

    def start(self, *arguments, **streams):
        process = subprocess.Popen([PROGRAM, "detect", ROOT / "scenes/nine.toml", "--steps", "1000000000", *arguments], **streams)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_json_and_csv(self):
        for flag in ("--json", "--csv"):
            process = self.start(flag, "-", stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
            self.assertEqual(len(process.stdout.read(100000)), 100000)
            process.stdout.close()

    def test_progress_on_a_terminal(self):
        try:
            terminal, its_side = pty.openpty()
        except OSError as error:
            self.skipTest(f"no terminal available: {error}")
        self.addCleanup(os.close, terminal)
        self.start(stdout=subprocess.DEVNULL, stderr=its_side)
        os.close(its_side)
        self.assertRegex(os.read(terminal, 200).decode(), r"^\r\[[#.]+\] frame \d+ of 1000000000")

    def test_no_progress_elsewhere(self):
        done = self.run_here("detect", ROOT / "scenes/nine.toml", "--steps", "2")
        self.assertEqual((done.status, done.error), (0, ""))


if __name__ == "__main__":
    unittest.main()
