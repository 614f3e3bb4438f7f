"""The CSV of each kind of contacts has the records that the JSON has with details, cell by cell."""

import csv
import io
import unittest

from program import TRIANGLE, ProgramTest, joined, moved

CORNERS = [(x, y, z) for x in (0.0, 2.0) for y in (0.0, 2.0) for z in (0.0, 2.0)]
BOX = (CORNERS, [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)])
RODS = "v -4 0.5 1\nv 4 0.5 1\nv 1 1 2.0625\nl 1 2\np 3\n"
LISTS = {"intersection": "contacts", "continuous": "contacts", "proximity": "proximity_pairs", "penetration": "penetrations"}
SCENE = """
[scene]
time_step = 1
[[object]]
name = "fixed"
mesh = "box.obj"
solid = true
self = true
margin = 0.125
[[object]]
name = "falling"
mesh = "falling.obj"
margin = 0.125
motion = { kind = "rigid", velocity = [0, 0, -0.75] }
[[object]]
name = "rods"
mesh = "rods.obj"
margin = 0.125
motion = { kind = "rigid", velocity = [0, 0, 0.25] }
"""


def cells_of(key, value):
    """The columns of a member of the JSON."""
    if key in ("element_a", "element_b"):
        ids = value if isinstance(value, list) else [value, ""]
        return {f"{key}{i}": id for i, id in enumerate(ids)}
    if key.startswith("barycentric"):
        return {f"{key}{i}": weight for i, weight in enumerate([*value, "", ""][:3])}
    if key == "points":
        return {}
    if isinstance(value, list):
        return {f"{key}_{axis}": number for axis, number in zip("xyz", value, strict=True)}
    return {key: value}


def parsed(cell):
    try:
        return float(cell)
    except ValueError:
        return {"true": True, "false": False}.get(cell, cell)


class Csv(ProgramTest):
    maxDiff = None

    def setUp(self):
        super().setUp()
        self.write("box.obj", BOX)
        self.write("falling.obj", moved(joined(BOX, moved(TRIANGLE, 0.25, 0.5, -1)), 0.5, 0.25, 2.5))
        self.write("rods.obj", RODS)
        self.write("scene.toml", SCENE)

    def arguments(self, kind):
        return ("scene.toml", "--frames", "4", "--contacts", kind)

    def rows(self, *arguments):
        done = self.run_here("detect", *arguments, "--csv", "-")
        self.assertEqual((done.status, done.error), (0, ""))
        return list(csv.DictReader(io.StringIO(done.out)))

    def test_every_kind_with_details(self):
        for kind, name in LISTS.items():
            with self.subTest(kind):
                rows = self.rows(*self.arguments(kind), "--contact-details")
                frames = self.detect(*self.arguments(kind), "--contact-details")["frames"]
                records = [(frame["frame"], record) for frame in frames for record in frame[name]]
                self.assertGreater(len(records), 1)
                expected = []
                for frame, record in records:
                    cells = {"frame": frame}
                    for key, value in record.items():
                        cells |= cells_of(key, value)
                    expected.append(cells)
                self.assertEqual([{key: parsed(cell) for key, cell in row.items()} for row in rows], expected)
                self.assertEqual([list(row) for row in rows], [list(cells) for cells in expected])

    def test_without_details(self):
        columns = {
            "intersection": "frame,a,b,triangle_a,triangle_b,kind",
            "continuous": "frame,a,b,kind,element_a0,element_a1,element_b0,element_b1,certainty,touching_at_start,toi,start_distance",
            "proximity": "frame,a,b,kind_a,kind_b,element_a0,element_a1,element_b0,element_b1,feature_a,feature_b,distance",
            "penetration": "frame,a,b,vertex,triangle,feature,depth",
        }
        for kind, names in columns.items():
            details = self.rows(*self.arguments(kind), "--contact-details")
            rows = self.rows(*self.arguments(kind))
            self.assertEqual(",".join(rows[0]), names)
            self.assertEqual(rows, [{name: row[name] for name in names.split(",")} for row in details])

    def test_only_edges_have_a_second_vertex(self):
        rows = self.rows(*self.arguments("continuous"))
        self.assertIn("e", "".join(row["kind"] for row in rows))
        for row in rows:
            for side, kind in zip("ab", row["kind"]):
                self.assertEqual(row[f"element_{side}1"] != "", kind == "e", row)

    def test_what_has_no_table(self):
        for arguments in (("--contacts", "none"), ("--contacts", "intersection,proximity")):
            done = self.run_here("detect", "scene.toml", "--frames", "2", *arguments, "--csv", "-")
            self.assert_one_line_error(done, "--csv: has no effect without contacts of one kind")
        done = self.run_here("detect", "scene.toml", "--frames", "2", "--contact-details")
        self.assert_one_line_error(done, "--json or --csv")


if __name__ == "__main__":
    unittest.main()
