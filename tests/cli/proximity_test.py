"""Tests `supple detect --contacts proximity`: what is within the margins, with distances."""

import unittest

from program import TRIANGLE, ProgramTest, joined, moved

NEAR = ("--contacts", "proximity", "--margin", "0.125")


class Proximity(ProgramTest):
    maxDiff = None

    def setUp(self):
        super().setUp()
        self.write("low.obj", TRIANGLE)
        self.write("high.obj", moved(TRIANGLE, 0, 0, 0.25))

    def frame(self, *arguments):
        (frame,) = self.detect("low.obj", "high.obj", *NEAR, *arguments)["frames"]
        return frame

    def test_features_and_elements(self):
        frame = self.frame("--verify")
        self.assertEqual(list(frame), ["frame", "truncated", "untested", "object_pairs", "proximity", "events", "non_finite", "proximity_verify", "stats"])
        (group,) = frame["proximity"]
        self.assertEqual(list(group), ["a", "b", "vv", "ve", "vf", "ev", "ee", "fv"])
        # Corners lie over corners; each pair once.
        self.assertEqual(group["vv"], [[0, 0, 0.25], [1, 1, 0.25], [2, 2, 0.25]])
        self.assertEqual(frame["events"]["proximity"]["begin"], [[0, 1]])
        self.assertEqual(frame["events"]["contacts"]["begin"], [])
        self.assertEqual(frame["proximity_verify"]["differences"], [])
        self.assertEqual(frame["proximity_verify"]["near_pairs"], frame["stats"]["proximity_pairs"])
        (group,) = self.frame("--proximity-listing", "elements")["proximity"]
        self.assertEqual(list(group), ["a", "b", "vf", "ee", "fv"])
        self.assertEqual(group["vf"], [[v, 0, 0.25] for v in range(3)])
        self.assertEqual(group["fv"], [[0, v, 0.25] for v in range(3)])
        self.assertIn([0, 1, 0, 1, 0.25], group["ee"])

    def test_meshes_that_cut_through_each_other(self):
        """Away from all edges of the plate: no vertex is on a face and no two edges meet."""
        self.write("plate.obj", ([(-4.0, -4.0, 0.0), (8.0, -4.0, 0.0), (-4.0, 8.0, 0.0)], [(0, 1, 2)]))
        self.write("needle.obj", ([(0.0, 0.0, -2.0), (0.25, 0.0, -2.0), (0.0, 0.25, 2.0)], [(0, 1, 2)]))
        for listing in ("features", "elements"):
            for margin in ("0", "0.01"):
                near = ("--contacts", "proximity", "--margin", margin, "--proximity-listing", listing, "--verify")
                (frame,) = self.detect("needle.obj", "plate.obj", *near)["frames"]
                self.assertEqual(frame["proximity"][0]["ef"], [[0, 2, 0, 0], [1, 2, 0, 0]])
                self.assertEqual(frame["proximity_verify"]["differences"], [])
                (frame,) = self.detect("plate.obj", "needle.obj", *near)["frames"]
                self.assertEqual(frame["proximity"][0]["fe"], [[0, 0, 2, 0], [0, 1, 2, 0]])
                self.assertNotIn("ef", frame["proximity"][0])
        done = self.run_here("detect", "needle.obj", "plate.obj", "--contacts", "proximity", "--fail-on-contact")
        self.assertEqual(done.status, 1)
        self.assertNotIn("Nothing is within", done.out)

    def test_one_mesh_is_near_itself(self):
        self.write("both.obj", joined(TRIANGLE, moved(TRIANGLE, 0, 0, 0.25)))
        for arguments in ((), ("--self",)):
            (frame,) = self.detect("both.obj", *NEAR, "--proximity-listing", "elements", *arguments)["frames"]
            (group,) = frame["proximity"]
            self.assertEqual((group["a"], group["b"], group["fv"]), (0, 0, []))
            self.assertEqual(len(group["vf"]), 6)

    def test_a_smaller_margin(self):
        (frame,) = self.detect("low.obj", "high.obj", "--contacts", "proximity", "--margin", "0.1249")["frames"]
        self.assertEqual(frame["proximity"], [])

    def test_details(self):
        pair = self.frame("--contact-details", "--proximity-listing", "elements")["proximity_pairs"][0]
        keys = ["a", "b", "kind_a", "kind_b", "element_a", "element_b", "feature_a", "feature_b", "distance", "barycentric_a", "barycentric_b", "point_a", "point_b", "normal"]
        self.assertEqual(list(pair), keys)
        self.assertEqual((pair["kind_a"], pair["kind_b"], pair["element_a"], pair["element_b"], pair["feature_a"], pair["feature_b"]), ("vertex", "face", 0, 0, "v0", "v0"))
        self.assertEqual((pair["barycentric_a"], pair["barycentric_b"], pair["normal"]), ([1], [1, 0, 0], [0, 0, -1]))

    def test_with_other_kinds(self):
        (frame,) = self.detect("low.obj", "high.obj", "--contacts", "intersection,proximity", "--margin", "0.125", "--verify")["frames"]
        for key in ("triangle_pairs", "proximity", "verify", "proximity_verify"):
            self.assertIn(key, frame)

    def test_csv_and_tables(self):
        rows = self.run_here("detect", "low.obj", "high.obj", *NEAR, "--csv", "-").out.splitlines()
        self.assertEqual(rows[:2], ["frame,a,b,kind_a,kind_b,element_a0,element_a1,element_b0,element_b1,feature_a,feature_b,distance", "0,0,1,vertex,vertex,0,,0,,v0,v0,0.25"])
        done = self.run_here("detect", "low.obj", "high.obj", *NEAR, "--fail-on-contact", "--verify")
        self.assertEqual(done.status, 1)
        self.assertIn("feature pairs", done.out)
        self.assertIn("no difference", done.out)

    def test_errors(self):
        for arguments, part in (
            (("--margin", "1"), "--contacts proximity"),
            (("--contacts", "proximity", "--margin", "-1"), "--margin"),
            (("--proximity-listing", "elements"), "--contacts proximity"),
            (("--contacts", "proximity", "--bounding-volume", "obb"), "--contacts"),
        ):
            self.assert_one_line_error(self.run_here("detect", "low.obj", *arguments), part)


if __name__ == "__main__":
    unittest.main()
