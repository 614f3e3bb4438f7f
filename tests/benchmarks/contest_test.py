"""Tests the contest with small sizes: contestants agree, the check notices a difference, generators give the
same bits everywhere, and the driver writes correct results."""

import contextlib
import csv
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))
import contest  # noqa: E402

BUILD = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else ROOT / "build/release"
PROGRAM = BUILD / "bin/supple_contest"


# The pairs of the third frame, equal on every machine. A change of a generator changes them.
KNOWN = {
    "A/u1/300": (146, "bb31efa6c86c9ff2"),
    "A/u8/300": (972, "c085a2c958750839"),
    "A/clu/300": (3, "9889e6e540c3fa0c"),
    "A/cl8/3000": (4401, "8b398c98a987e21d"),
    "B/80x27": (433, "f06c26275e9b4920"),
    "B/980x8": (586, "26afb7f4fd3f4d3e"),
    "B/980x8-rest": (588, "9950207e72b04ad8"),
}


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False)


def contestants_of(cell):
    done = run(cell, "--seconds", "0.01", "--rounds", "3")
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return json.loads(done.stdout)["contestants"]


class Cells(unittest.TestCase):
    def test_all_find_the_same_known_pairs(self):
        for cell, pairs in KNOWN.items():
            with self.subTest(cell=cell):
                for contestant in contestants_of(cell):
                    self.assertEqual((contestant["pairs"], contestant["hash"]), pairs, contestant["name"])

    def test_verdicts_on_a_cloth_are_those_on_all_candidates(self):
        contestants = contestants_of("C/crumpled-small")
        self.assertEqual(contestants[0]["pairs"], 930)
        for contestant in contestants[1:]:
            self.assertEqual(contestant["pairs"], 22954, contestant["name"])

    def test_element_boxes_and_proximity_of_a_cloth(self):
        for contestant in contestants_of("E/crumpled-small"):
            self.assertEqual(contestant["pairs"], 22954, contestant["name"])
        found = contestants_of("P/crumpled-small")
        self.assertEqual(found[0]["pairs"], 494)
        for contestant in found[1:]:
            self.assertEqual(contestant["pairs"], 655, contestant["name"])

    def test_answers_to_queries_agree(self):
        for cell in ("closest/980-uniform", "closest/980-near", "inside/980", "rays/980x4", "penetration/980", "penetration/980-deep", "distance/980-apart", "distance/980-near"):
            with self.subTest(cell=cell):
                self.assertGreater(contestants_of("Q/" + cell)[0]["pairs"], 0)

    def test_a_lost_pair_is_noticed(self):
        done = run("A/u1/300", "--rounds", "1", "--spoil", "baseline grid")
        self.assertEqual(done.returncode, 3)
        self.assertIn("A/u1/300", done.stderr)
        self.assertIn("baseline grid", done.stderr)

    def test_special_cells(self):
        for cell in ("A/u1/300/drift", "A/u1/300/one-percent", "threads/B/80x8", "limits/refit/80", "growth/80x2"):
            with self.subTest(cell=cell):
                self.assertTrue(contestants_of(cell))
        for cell in ("memory/980", "memory/moving/980"):
            with self.subTest(cell=cell):
                values = json.loads(run(cell).stdout)["values"]
                self.assertGreater(values["heap bytes a triangle"], values["octree bytes a triangle"])
        for cell in ("step/crumpled-small", "step/passing", "step/rods", "build/980", "frames/80x2"):
            with self.subTest(cell=cell):
                values = json.loads(run(cell, "--rounds", "20").stdout)["values"]
                times = {name: value for name, value in values.items() if name.startswith("milliseconds")}
                self.assertGreaterEqual(len(times), 2)
                self.assertTrue(all(time > 0 for time in times.values()), times)
                self.assertTrue(contest.judged([{"cell": cell, "skipped": None, "values": values,
                                                 "contestants": []}]).rows)

    def test_bodies_that_move_fast(self):
        for cell in ("C/passing", "C/rods"):
            with self.subTest(cell=cell):
                found = contestants_of(cell)
                self.assertEqual(len({contestant["pairs"] for contestant in found[1:]}), min(1, len(found) - 1))

    def test_wrong_names(self):
        for cell in ("A/u1/0", "A/u2/10", "B/981x2", "B/80x0", "C/flag", "D/1"):
            with self.subTest(cell=cell):
                done = run(cell)
                self.assertEqual(done.returncode, 1)
                self.assertIn("supple_contest: no ", done.stderr)


class Judgement(unittest.TestCase):
    @staticmethod
    def cell(name, **milliseconds):
        return {"cell": name, "skipped": None, "values": {}, "contestants": [
            {"name": contestant.replace("_", " "), "cpu_ms": times, "wall_ms": times, "mean_stage_ms": {}}
            for contestant, times in milliseconds.items()]}

    def test_against_the_best_library_and_the_best_baseline(self):
        rows = contest.judged([self.cell("A/u1/1000", Supple=[1, 2, 9], Embree=[9, 9, 9], CGAL=[8, 8, 8],
                                         baseline_sweep=[1, 1, 1], baseline_grid=[3, 3, 3])]).rows
        judged = {row["row"]: (row["against"], row["ratio"], row["met"]) for row in rows}
        self.assertEqual(judged["A, the best library"], ("CGAL", 4, "reach"))
        self.assertEqual(judged["A, the baselines"], ("baseline sweep", 0.5, "missed"))

    def test_default_options_against_pairs(self):
        cell = self.cell("B/980x64", Supple=[2, 2, 2], Embree=[8, 8, 8])
        for name, time in (("Supple, pairs only", 1.6), ("Embree, contact points", 9)):
            cell["contestants"].append({"name": name, "cpu_ms": [time], "wall_ms": [time], "mean_stage_ms": {}})
        judged = {row["row"]: (row["against"], row["ratio"], row["met"]) for row in contest.judged([cell]).rows}
        self.assertEqual(judged["B 980 × 64 and × 512, contact points, against pairs"], ("Embree", 4, "reach"))
        self.assertEqual(judged["B, contact points in both"], ("Embree, contact points", 4.5, "reach"))
        self.assertEqual(judged["B, cost of contact points and normals"], ("Supple, pairs only", 1.25, "missed"))

    def test_smaller_is_better(self):
        cell = {"cell": "memory/980", "skipped": None, "values": {"heap bytes a triangle": 39.0}, "contestants": []}
        self.assertEqual(contest.judged([cell]).rows[0]["met"], "aim")
        cell["values"]["heap bytes a triangle"] = 64.5
        self.assertEqual(contest.judged([cell]).rows[0]["met"], "missed")

    def test_exponent(self):
        self.assertAlmostEqual(contest.exponent([(1, 2), (10, 20), (100, 200)]), 1)
        self.assertAlmostEqual(contest.exponent([(1, 1), (4, 8), (16, 64)]), 1.5)


class Driver(unittest.TestCase):
    def test_writes_results(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [sys.executable, ROOT / "benchmarks/contest.py", "--build", BUILD, "--output", folder, "--seconds",
                 "0.01", "--only", "A/u1/300", "--only", "A/u1/600", "--only", "B/80x8", "--only", "C/crumpled-small",
                 "--only", "limits/refit/80"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            results = json.loads((pathlib.Path(folder) / "results.json").read_text(encoding="utf-8"))
            self.assertEqual([cell["cell"] for cell in results["cells"]],
                             ["A/u1/300", "A/u1/600", "B/80x8", "C/crumpled-small", "limits/refit/80"])
            with open(pathlib.Path(folder) / "results.csv", encoding="utf-8") as file:
                self.assertIn("baseline sweep", [row["contestant"] for row in csv.DictReader(file)])
            page = (pathlib.Path(folder) / "results.html").read_text(encoding="utf-8")
            tree = xml.etree.ElementTree.fromstring(page.removeprefix("<!DOCTYPE html>\n"))
            self.assertGreaterEqual(len(tree.findall(".//svg")), 4)
            self.assertNotIn("http", page)

    def test_a_failed_cell_fails_the_run(self):
        arguments = contest.parsed(["--build", str(BUILD), "--seconds", "0.01"])
        with contextlib.redirect_stdout(io.StringIO()) as judged:
            results, failed, disagree = contest.run_all(arguments, ["A/u2/10"])
        self.assertEqual((results, failed, disagree), ([], True, False))
        self.assertIn("A/u2/10", judged.getvalue())

    def test_a_pattern_that_matches_nothing_is_an_error(self):
        self.assertGreater(len(contest.chosen_cells(contest.parsed(["--only", "A/u1/*", "--only", "B/80x8"]))), 4)
        with self.assertRaisesRegex(SystemExit, "no cell matches A/u1/\\*,B/\\*"):
            contest.chosen_cells(contest.parsed(["--only", "A/u1/*,B/*"]))


if __name__ == "__main__":
    unittest.main()
