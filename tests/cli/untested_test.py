"""Tests that the program never says "Nothing touches" where nothing was tested."""

import json
import unittest

from program import CROSSED, FAR, FLOOR, SPIKE, TRIANGLE, UPRIGHT, ProgramTest, joined, moved

BOX = (
    [(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)],
    [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)],
)
POINTS = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n"


def split(mesh):
    """Gives each triangle its own vertices, as exports for renderers do."""
    return ([mesh[0][v] for t in mesh[1] for v in t], [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(len(mesh[1]))])


def turned(mesh, quarters):
    """Turned about an axis along z through (3, 3)."""
    vertices = mesh[0]
    for _ in range(quarters):
        vertices = [(3 - (y - 3), 3 + (x - 3), z) for x, y, z in vertices]
    return (vertices, mesh[1])


class Untested(ProgramTest):
    def setUp(self):
        super().setUp()
        meshes = {"a": TRIANGLE, "b": UPRIGHT, "far": FAR, "crossed": CROSSED, "box": BOX, "apart": joined(BOX, moved(BOX, 5, 0, 0)), "far_box": moved(BOX, 9, 0, 0)}
        for name, mesh in meshes.items():
            self.write(f"{name}.obj", mesh)
        self.write("points.ply", POINTS)
        self.write("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.write("line.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")
        self.write("fan.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n")

    def expect(self, *arguments, kind, reason, says):
        """The tables, the JSON and --fail-on-contact say that a kind was not tested."""
        with self.subTest(arguments=arguments):
            done = self.run_here("detect", *arguments)
            self.assertEqual((done.status, done.error), (0, ""))
            self.assertNotIn("Nothing touches", done.out)
            self.assertNotIn("Nothing is within", done.out)
            self.assertNotIn("No vertex is inside", done.out)
            self.assertRegex(done.out, says)
            done = self.run_here("detect", *arguments, "--json", "-")
            self.assertEqual(done.status, 0)
            self.assertRegex(done.error, rf"^supple: warning: [^\n]*{says}[^\n]*\n$")
            for frame in json.loads(done.out)["frames"]:
                self.assertIn({"kind": kind, "reason": reason}, frame["untested"])
            done = self.run_here("detect", *arguments, "--fail-on-contact", "--quiet")
            self.assertEqual((done.status, done.out), (2, ""))
            self.assertRegex(done.error, rf"^supple: --fail-on-contact: [^\n]*{says}[^\n]*\n$")
            done = self.run_here("detect", *arguments, "--quiet")
            self.assertEqual((done.status, done.out, done.error), (0, "", ""))

    def test_no_triangles(self):
        says = "othing was tested: no object has a triangle"
        self.expect("points.ply", "--self", kind="intersection", reason="no_elements", says=says)
        self.expect("points.ply", "points.ply", kind="intersection", reason="no_elements", says=says)
        self.expect("line.obj", "line.obj", kind="intersection", reason="no_elements", says=says + "; lines and points")
        self.expect("nan.obj", "nan.obj", kind="intersection", reason="not_finite", says="not finite")

    def test_one_object(self):
        self.expect("box.obj", kind="intersection", reason="one_object", says="othing was tested: there is only one object; --self")
        self.expect("a.obj", kind="intersection", reason="one_object", says="there is only one object; give another one")
        self.expect("a.obj", "nan.obj", kind="intersection", reason="one_object", says="only one object has a triangle of finite coordinates; give another one")
        self.expect("a.obj", "line.obj", kind="intersection", reason="one_object", says="give another one; lines and points take part in --contacts continuous and proximity")
        self.expect("crossed.obj", kind="intersection", reason="one_object", says="--self tests it against itself, --parts makes an object of each of its 2 connected parts")
        done = self.run_here("detect", "crossed.obj", "--parts", "--fail-on-contact", "--quiet")
        self.assertEqual((done.status, done.error), (1, ""))
        self.expect("a.obj", "points.ply", kind="intersection", reason="one_object", says="only one object has a triangle")
        for neighbours in ("skip", "exact"):
            self.expect("a.obj", "--self", "--neighbours", neighbours, kind="intersection", reason="one_object", says="there is only one object; give another one")
        done = self.run_here("detect", "fan.obj", "--self")
        self.assertRegex(done.out, r"share a vertex (was|were) not tested; --neighbours exact")
        self.expect("--sequence", "box.obj", "far_box.obj", kind="intersection", reason="one_object", says="--self")

    def test_penetration_without_a_solid(self):
        self.expect("box.obj", "far_box.obj", "--contacts", "penetration", kind="penetration", reason="no_solid", says="enetration could not be tested: no object is solid; --solid")
        done = self.run_here("detect", "a.obj", "b.obj", "--contacts", "penetration", "--fail-on-contact", "--quiet")
        self.assertEqual((done.status, done.error), (1, ""), "they intersect, solid or not")

    def test_nothing_moves(self):
        continuous = ("--contacts", "continuous")
        self.expect("a.obj", "far.obj", *continuous, kind="continuous", reason="no_motion", says="nothing moves; if the meshes are frames of one object, give --sequence")
        self.expect("a.obj", "far_box.obj", *continuous, kind="continuous", reason="no_motion", says="nothing moves; give frames")

    def test_no_margin(self):
        self.expect("a.obj", "far.obj", "--contacts", "proximity", kind="proximity", reason="no_margin", says="all margins are 0, .*--margin")

    def test_static_objects_and_groups(self):
        two = '[[object]]\nmesh = "a.obj"\n{0}\n[[object]]\nmesh = "far.obj"\n{0}\n'
        self.write("static.toml", two.format("static = true"))
        self.expect("static.toml", kind="intersection", reason="all_static", says="all objects are static")
        self.write("groups.toml", two.format("group = 1\nmask = 2"))
        self.expect("groups.toml", kind="intersection", reason="groups", says="groups and masks exclude all pairs")

    def test_what_is_tested_is_not_named(self):
        for arguments in (("a.obj", "far.obj"), ("apart.obj", "--self"), ("box.obj", "far_box.obj", "--contacts", "penetration", "--solid"), ("a.obj", "far.obj", "--contacts", "proximity", "--margin", "0.1"), ("--sequence", "apart.obj", "apart.obj", "--self", "--contacts", "continuous,intersection")):
            with self.subTest(arguments):
                done = self.run_here("detect", *arguments, "--fail-on-contact", "--quiet")
                self.assertEqual((done.status, done.error), (0, ""))
                for frame in self.detect(*arguments)["frames"][-1:]:
                    self.assertEqual(frame["untested"], [])

    def test_one_tested_frame_is_enough(self):
        self.write("broken.obj", "v nan 0 0\nv nan 0 0\nv nan 1 0\nv nan 0 0\nv nan 0 0\nv nan 1 0\nf 1 2 3\nf 4 5 6\n")
        self.write("whole.obj", joined(TRIANGLE, moved(TRIANGLE, 0, 0, 4)))
        done = self.run_here("detect", "--sequence", "broken.obj", "whole.obj", "--self", "--fail-on-contact", "--quiet")
        self.assertEqual((done.status, done.error), (0, ""))

    def test_simulate(self):
        self.write("one.toml", '[[object]]\nmodel = "box"\n')
        done = self.run_here("simulate", "one.toml", "--frames", "2", "--fail-on-contact", "--quiet")
        self.assertEqual((done.status, done.out), (2, ""))
        self.assertIn("nothing was tested: there is only one object", done.error)

    def test_half_turns(self):
        mesh = joined(BOX, moved(BOX, 3, 0, 2))
        for number, quarters in enumerate((0, 2, 2, 3)):
            self.write(f"turn_{number}.obj", turned(mesh, quarters))
        arguments = ("--contacts", "continuous", "--self", "--fail-on-contact", "--sequence")
        done = self.run_here("detect", *arguments, "turn_0.obj", "turn_1.obj", "--quiet")
        self.assertEqual(done.status, 1, done.error)  # the collapsing boxes touch
        done = self.run_here("detect", *arguments, "turn_0.obj", "turn_1.obj", "turn_2.obj")
        self.assertIn("In 1 step, first from frame 0 to 1, objects turn by more than 120 degrees, first turn_0", done.out)
        frames = self.detect(*arguments[:3], "--sequence", "turn_1.obj", "turn_2.obj", "turn_3.obj")["frames"]
        self.assertEqual([frame["untested"] for frame in frames], [[], []], "a quarter turn is motion")
        self.write("spin.toml", '[scene]\ntime_step = 0.01\n[[object]]\nmodel = "box"\nmotion = { kind = "rigid", spin = [0, 0, 18000] }\n'
                   '[[object]]\nmodel = "box"\ntranslate = [9, 0, 0]\n')
        done = self.run_here("detect", "spin.toml", "--contacts", "continuous", "--frames", "3", "--fail-on-contact", "--json", "out.json", "--quiet")
        self.assertEqual(done.status, 2, done.error)
        self.assertIn("in 2 steps, first from frame 0 to 1", done.error)
        frames = json.loads((self.folder / "out.json").read_text())["frames"]
        self.assertEqual(frames[0]["untested"], [{"kind": "continuous", "reason": "half_turn", "object": 0}])
        done = self.run_here("detect", "spin.toml", "--contacts", "intersection,continuous", "--frames", "3")
        self.assertIn("In 2 steps, first from frame 0 to 1", done.out, "the first frame has no step")


class Seams(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("soup.obj", split(BOX))
        self.write("box.obj", BOX)
        self.write("p.txt", "0.5 0.5 0.5\n9 0 0\n")

    def test_inside_and_info_agree(self):
        done = self.run_here("query", "inside", "p.txt", "soup.obj")
        self.assert_one_line_error(done, "the surface of soup is open, 36 boundary edges", "seams", "--weld")
        self.assertNotIn("holes", done.error)
        done = self.run_here("query", "inside", "p.txt", "soup.obj", "--weld", "--json", "-")
        self.assertEqual((done.status, json.loads(done.out)["results"]), (0, ["inside", "outside"]))
        done = self.run_here("info", "soup.obj")
        self.assertIn("open, 36 boundary edges", done.out)
        self.assertIn("--weld", done.out)
        self.assertIn("surface      closed\n", self.run_here("info", "soup.obj", "--weld").out)
        self.write("odd.obj", ([*BOX[0], (5.0, 5.0, 5.0)], [*BOX[1], (0, 1, 8)]))
        done = self.run_here("query", "inside", "p.txt", "odd.obj")
        words = "open, 2 boundary edges, 1 edge of another odd number of triangles, 1 non-manifold edge"
        self.assert_one_line_error(done, words, "close the holes")
        self.assertIn(words, self.run_here("info", "odd.obj").out)
        info = json.loads(self.run_here("info", "odd.obj", "--json", "-").out)["objects"][0]
        self.assertEqual((info["closed"], info["odd_edges"], info["open_at_seams"]), (False, 3, False))

    def test_solids(self):
        done = self.run_here("detect", "soup.obj", "box.obj", "--contacts", "penetration", "--solid")
        self.assert_one_line_error(done, "soup is no solid", "seams", "--weld")

    def test_contacts_at_seams(self):
        for kinds in (("intersection",), ("continuous",), ("proximity", "--margin", "0.01")):
            done = self.run_here("detect", "soup.obj", "--self", "--contacts", *kinds)
            self.assertRegex(done.out, r"\d+ of \d+ contacts of 0 soup with itself are between vertices at equal positions.*--weld")
            for others in (("soup.obj", "--weld"), ("box.obj",)):
                done = self.run_here("detect", *others, "--self", "--contacts", *kinds)
                self.assertNotIn("equal positions", done.out)

    def test_neighbours(self):
        self.write("two.obj", joined(BOX, moved(BOX, 4, 0, 0)))
        done = self.run_here("detect", "two.obj", "--self")
        self.assertRegex(done.out, r"(?m)^\d+ pairs of triangles that share a vertex were not tested; --neighbours exact tests them\.$")
        self.assertNotIn("not tested", self.run_here("detect", "two.obj", "--self", "--neighbours", "exact").out)

    def test_queries_without_triangles(self):
        self.write("points.ply", POINTS)
        for kind, given in (("inside", ("p.txt",)), ("closest", ("p.txt",)), ("distance", ())):
            done = self.run_here("query", kind, *given, "points.ply", *(["points.ply"] if kind == "distance" else []))
            self.assert_one_line_error(done, "no object has a triangle")
        done = self.run_here("query", "inside", "p.txt", "box.obj", "points.ply")
        self.assertEqual(done.status, 0)
        self.assertIn("1 object without triangles of finite coordinates, which no query finds; the first: 1 points", done.error)


if __name__ == "__main__":
    unittest.main()
