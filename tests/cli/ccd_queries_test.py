"""Tests `supple ccd-queries`: published queries of continuous collision, their format and error messages."""

import json
import os
import pathlib
import unittest
from fractions import Fraction

from program import ROOT, ProgramTest, run

DATA = pathlib.Path(os.environ.get("SUPPLE_DATA", ROOT.parent / "shared/data"))
FACE = [(0, 0, 0), (4, 0, 0), (0, 4, 0)]
# A vertex that falls through a face at half of the step, and one that misses the face.
FALLING = [(1, 1, 1), *FACE, (1, 1, -1), *FACE]
BESIDE = [(3, 3, 1), *FACE, (3, 3, -1), *FACE]
# An edge that falls through another edge at a quarter of the step.
CROSSING = [(-1, 0, 1), (1, 0, 1), (0, -1, 0), (0, 1, 0), (-1, 0, -3), (1, 0, -3), (0, -1, 0), (0, 1, 0)]
TOLERANCE = 2.0**-30


def rows(points, answer=None):
    """The text of a query; coordinates are integers, fractions or text."""
    lines = []
    for point in points:
        columns = []
        for c in point:
            columns += [c] if isinstance(c, str) else [Fraction(c).numerator, Fraction(c).denominator]
        lines.append(",".join(map(str, columns + ([] if answer is None else [answer]))))
    return "\n".join(lines) + "\n"


def with_height(start, end):
    return [(1, 1, start), *FACE, (1, 1, end), *FACE]


class Queries(ProgramTest):
    def queries(self, *arguments, status=0):
        done = self.run_here("ccd-queries", *arguments, "--json", "-", "--no-stats")
        self.assertEqual((done.status, done.error), (status, ""))
        return json.loads(done.out)

    def assert_time(self, time, expected):
        self.assertIsNotNone(time)
        self.assertLessEqual(time, expected)
        self.assertGreaterEqual(time, expected - TOLERANCE)


class Answers(Queries):
    maxDiff = None

    def test_json(self):
        self.write("vf.csv", rows(FALLING, 1) + rows(BESIDE, 0))
        result = self.queries("vf.csv", "--verify")
        (file,) = result["files"]
        (time, nothing) = file.pop("times")
        self.assert_time(time, 0.5)
        self.assertIsNone(nothing)
        counts = {"queries": 2, "touching": 1, "within_tolerance": 0}
        self.assertEqual(
            file,
            {"file": "vf.csv", "kind": "vertex-face", **counts, "compared": True, "false_negatives": [],
             "false_positives": [], "differences": []},
        )
        self.assertEqual(result["min_separation"], 0)
        self.assertEqual(
            result["total"], {**counts, "compared": 2, "false_negatives": 0, "false_positives": 0, "differences": 0}
        )

    def test_stats(self):
        self.write("vf.csv", rows(FALLING, 1))
        done = self.run_here("ccd-queries", "vf.csv", "--json", "result.json")
        self.assertEqual(done.status, 0)
        result = json.loads((self.folder / "result.json").read_text())
        for part in (result["files"][0], result["total"]):
            self.assertGreater(part["seconds_per_query"], 0)
            self.assertLess(part["seconds_per_query"], 1)

    def test_false_answers(self):
        self.write("ee.csv", rows(CROSSING, 0) + rows(CROSSING, 1))
        self.write("vf.csv", rows(BESIDE, 0) + rows(BESIDE, 0) + rows(BESIDE, 1))
        ee, vf = self.queries("ee.csv", "vf.csv", status=3)["files"]
        self.assertEqual((ee["false_negatives"], ee["false_positives"]), ([], [0]))
        self.assertEqual((vf["false_negatives"], vf["false_positives"]), ([2], []))
        done = self.run_here("ccd-queries", "ee.csv", "vf.csv", "--list-false")
        self.assertEqual((done.status, done.error), (3, ""))
        self.assertIn("2 are false", done.out)
        self.assertRegex(done.out, r"(?m)^ee\.csv: query 0: false positive, said to touch at 0\.2")
        self.assertRegex(done.out, r"(?m)^vf\.csv: query 2: false negative$")
        self.assertNotIn("query 1", done.out)
        self.assertEqual(self.run_here("ccd-queries", "ee.csv", "--quiet").out, "")

    def test_tables(self):
        self.write("vf.csv", rows(FALLING, 1) + rows(BESIDE, 0))
        self.write("ee.csv", rows(CROSSING))
        done = self.run_here("ccd-queries", "vf.csv", "ee.csv")
        self.assertEqual((done.status, done.error), (0, ""))
        columns = [line.split()[:5] for line in done.out.splitlines()[1:4]]
        self.assertEqual(
            columns, [["vf.csv", "2", "1", "0", "0"], ["ee.csv", "1", "1", "-", "-"], ["total", "3", "2", "0", "0"]]
        )
        self.assertIn("2 queries compared with answers, none is false\n1 query without an answer", done.out)
        self.assertIn("no answers to compare with", self.run_here("ccd-queries", "ee.csv").out)

    def test_empty_file(self):
        for text in ("", "\n\n"):
            self.write("vf.csv", text)
            self.assertEqual(self.queries("vf.csv")["total"]["queries"], 0)
            self.assertIn("There are no queries.", self.run_here("ccd-queries", "vf.csv").out)
        self.write("answers.json", "[]")
        self.assertEqual(self.queries("vf.csv", "--answers", "answers.json")["total"]["queries"], 0)

    def test_answers_from_json(self):
        self.write("vf.csv", rows(FALLING) + rows(BESIDE))
        self.write("ee.csv", rows(CROSSING))
        self.write("vf.json", "[true, false]")
        self.write("ee.json", "\n[ true ]\n")
        self.assertEqual(self.queries("vf.csv", "ee.csv", "--answers", "vf.json", "--answers", "ee.json")["total"]["compared"], 3)
        self.assertEqual(self.queries("??.csv", "--answers", "??.json")["total"]["compared"], 3)
        self.write("vf.json", "[false, false]")
        self.assertEqual(self.queries("vf.csv", "--answers", "vf.json", status=3)["files"][0]["false_positives"], [0])

    def test_min_separation(self):
        self.write("vf.csv", rows(with_height(1, 0.25)) + rows(with_height(1, Fraction(1, 1 << 20))))
        times = self.queries("vf.csv")["files"][0]["times"]
        self.assertEqual(times, [None, None])
        near = self.queries("vf.csv", "--min-separation", "0.25", "--verify")
        self.assertEqual(near["min_separation"], 0.25)
        self.assert_time(near["files"][0]["times"][0], 1)
        self.assert_time(near["files"][0]["times"][1], 0.75 / (1 - 2.0**-20))

    def test_undecided(self):
        # A vertex that moves in the plane of the face and only just reaches its corner.
        self.write("vf.csv", rows([(-1, -1, 0), *FACE, (0, 0, 0), *FACE]))
        exact, reported = (self.queries("vf.csv", "--undecided", how)["files"][0] for how in ("exact", "report"))
        self.assertEqual((exact["touching"], exact["within_tolerance"]), (1, 0))
        self.assertEqual((reported["touching"], reported["within_tolerance"]), (1, 1))


class Format(Queries):
    def test_kind_is_told_by_the_path_or_by_an_option(self):
        text = rows(CROSSING)
        for name in ("edge-edge/data.csv", "edge-edge/deep/data.csv", "vertex-face/edge-edge/data.csv", "edge-edge/7ee.csv", "7ee.csv"):
            self.write(name, text)
            self.assertEqual(self.queries(name)["files"][0]["kind"], "edge-edge", name)
        self.write("vertex-face/data.csv", rows(FALLING))
        self.assertEqual(self.queries("vertex-face/data.csv")["files"][0]["kind"], "vertex-face")
        self.assertEqual(self.queries("7ee.csv", "--kind", "vertex-face")["files"][0]["kind"], "vertex-face")
        for name in ("data.csv", "eevf/data.csv", "vertex-face/7ee.csv"):
            self.write(name, text)
            self.assert_one_line_error(self.run_here("ccd-queries", name), name, "--kind")
            self.assertEqual(self.queries(name, "--kind", "edge-edge")["files"][0]["kind"], "edge-edge")

    def test_kind_of_the_folder_one_is_in(self):
        self.write("edge-edge/data.csv", rows(CROSSING))
        done = run("ccd-queries", "data.csv", "--json", "-", folder=self.folder / "edge-edge")
        self.assertEqual(json.loads(done.out)["files"][0]["kind"], "edge-edge")

    def test_quoted_pattern_is_in_natural_order(self):
        for number in (1, 2, 10):
            self.write(f"edge-edge/data_{number}.csv", rows(CROSSING))
        names = [f["file"] for f in self.queries("edge-edge/*.csv")["files"]]
        self.assertEqual(names, [f"edge-edge/data_{n}.csv" for n in (1, 2, 10)])

    def test_blanks_blank_lines_and_windows_line_ends(self):
        text = rows(FALLING, 1).replace(",", " ,\t").replace("\n", " \r\n\r\n")
        self.write("vf.csv", "\n" + text)
        self.assertEqual(self.queries("vf.csv")["total"]["touching"], 1)

    def test_every_exact_double_is_read(self):
        tiny, huge = Fraction(1, 2**1074), Fraction(2**1024 - 2**971)
        third = Fraction(0.1)
        for start, end in ((tiny, -tiny), (third, -third), ("7" * 50 + "," + "7" * 50, -1), ("-10,-10", -1), ("+1,1", -1),
                           ("0008,008", -1), (1, "3,-3"), (1, "-0000,1"), (2**200, -(2**200))):
            self.write("vf.csv", rows(with_height(start, end)))
            (time,) = self.queries("vf.csv")["files"][0]["times"]
            self.assert_time(time, 1.0 if end == "-0000,1" else 0.5)
        self.write("vf.csv", rows([(0, 0, 0), *[(huge, huge, huge)] * 7]))
        self.assert_time(self.queries("vf.csv")["files"][0]["times"][0], 1)

    def expect(self, text, *parts, name="vf.csv", arguments=()):
        with self.subTest(text=text[:100]):
            self.write(name, text)
            self.assert_one_line_error(self.run_here("ccd-queries", name, *arguments), *parts)

    def test_negative_and_large_denominators(self):
        denominators = (1, 3, 2**65, 7 * 2**65) * 2
        lines = [",".join(f"{-c * n},{-n}" for c in point) for point, n in zip(FALLING, denominators)]
        self.write("vf.csv", "\n".join(lines) + "\n")
        (file,) = self.queries("vf.csv")["files"]
        self.assert_time(file["times"][0], 0.5)

    def test_numbers_that_are_no_double(self):
        for value, parts in (
            (Fraction(1, 3), ("z = 1/3", "6004799503160661/18014398509481984")),
            (2**53 + 1, (f"z = {2**53 + 1}/1", f"{2**53}/1")),
            (Fraction(1, 2**1075), ("z = 1/404", "nearest")),
            (2**1024, ("z = 1797", "scale")),
        ):
            self.expect(rows(FALLING) + rows(with_height(value, 1)), "vf.csv:9: ", "double", *parts)
        self.expect("1,1,1,1,1,-3\n" * 8, "vf.csv:1: ", "z = 1/-3", "-6004799503160661/18014398509481984")

    def test_wrong_rows(self):
        good = rows(FALLING)
        self.expect(good + "1,2,3\n", "vf.csv:9: ", "3 columns", "6 or 7", "numerator,denominator")
        self.expect(good + "1,1,1,1,1,1,0,0\n", "vf.csv:9: ", "8 columns")
        self.expect(good + rows(BESIDE, 1), "vf.csv:9: ", "7 columns", "first row has 6")
        self.expect("x,y,z,1,1,1\n" + good, "vf.csv:1: ", "'x'", "whole number")
        self.expect(good.replace("1,1", "1.5,1", 1), "vf.csv:1: ", "'1.5'", "whole number")
        self.expect(good.replace("1,1", ",1", 1), "vf.csv:1: ", "''", "whole number")
        self.expect(good.replace("1,1", "1,-", 1), "vf.csv:1: ", "'-'", "whole number")
        self.expect(good + good.replace("1,1", "1,0", 1), "vf.csv:9: ", "x = 1/0", "denominator")
        self.expect("z" * 10000 + ",1,1,1,1,1\n", "vf.csv:1: ", "zzz...")

    def test_rows_that_are_not_whole_queries(self):
        self.expect(rows(FALLING) + rows(FALLING[:7]), "vf.csv:15: ", "7 rows", "eight rows")

    def test_wrong_answers(self):
        self.expect(rows(FALLING, 2), "vf.csv:1: ", "'2'", "0 or 1")
        self.expect(rows(FALLING, ""), "vf.csv:1: ", "''", "0 or 1")
        self.expect(rows(FALLING[:5], 1) + rows(FALLING[5:], 0), "vf.csv:6: ", "the answer is 0", "1 in the rows")

    def test_wrong_answer_files(self):
        def expect(answers, *parts, queries=rows(FALLING) + rows(BESIDE)):
            self.write("a.json", answers)
            self.expect(queries, *parts, arguments=("--answers", "a.json"))

        expect("[true]", "a.json", "1 answer", "vf.csv", "2 queries")
        expect("[true, 0]", "a.json", "entry 1", "true or false")
        expect('{"answers": []}', "a.json", "list of true and false")
        expect("[true,\n\nfalse", "a.json:3: ", "JSON")
        expect("[true,\n[true]]", "a.json:2: ", "entry 1", "true or false")
        expect("[" * 1000000, "a.json:1: ", "entry 0", "true or false")
        expect("true", "a.json:1: ", "list of true and false")
        expect("[true, false] true", "a.json:1: ", "JSON")
        expect("", "a.json:1: ", "JSON")
        expect("[true]", "vf.csv", "a.json", "column of answers", queries=rows(FALLING, 1))
        self.expect(rows(FALLING), "none.json", "there is no such file", arguments=("--answers", "none.json"))
        self.write("ee.csv", rows(CROSSING))
        self.write("a.json", "[true]")
        self.expect(rows(FALLING), "--answers", "1 file for 2", arguments=("ee.csv", "--answers", "a.json"))

    def test_inputs(self):
        for name in ("none.csv", "no*.csv"):
            self.assert_one_line_error(self.run_here("ccd-queries", name), name)
        (self.folder / "ee").mkdir()
        self.assert_one_line_error(self.run_here("ccd-queries", "ee"), "ee", "a folder")

    def test_options(self):
        text = rows(FALLING)
        self.expect(text, "--kind", "'face'", "vertex-face, edge-edge", arguments=("--kind", "face"))
        self.expect(text, "--min-separation", "'-1'", "finite number", arguments=("--min-separation", "-1"))
        self.expect(text, "--min-separation", "'nan'", arguments=("--min-separation", "nan"))
        self.expect(text, "--undecided", "'maybe'", "report, exact", arguments=("--undecided", "maybe"))
        self.expect(text, "--no-stats", "--json", arguments=("--no-stats",))
        self.expect(text, "--list-false", arguments=("--list-false", "--quiet"))
        self.expect(text, "/dev/full", "disk full", arguments=("--json", "/dev/full"))


@unittest.skipUnless((DATA / "truth.json").is_file(), f"no data in {DATA}")
class Published(Queries):
    def test_no_answer_is_false(self):
        cases = json.loads((DATA / "truth.json").read_text())["queries"]
        for case in cases:
            with self.subTest(case["name"]):
                answers = ["--answers", DATA / case["flags"]] if "flags" in case else []
                total = self.queries(DATA / case["file"], *answers, "--verify")["total"]
                expected = {"queries": case["queries"], "compared": case["queries"], "touching": case["exact_yes"],
                            "within_tolerance": 0, "false_negatives": 0, "false_positives": 0, "differences": 0}
                self.assertEqual(total, expected)
        self.assertEqual(sum(case["queries"] for case in cases), 2179)


if __name__ == "__main__":
    unittest.main()
