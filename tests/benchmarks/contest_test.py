"""Tests the contest with small sizes: contestants agree, the check notices a difference, generators give the
same bits everywhere, and the driver writes correct results."""

import contextlib
import importlib.util
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
import contest_report  # noqa: E402
import contest_targets  # noqa: E402

needs_matplotlib = unittest.skipUnless(importlib.util.find_spec("matplotlib"), "needs matplotlib")

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
                self.assertTrue(contest_targets.judged([{"cell": cell, "skipped": None, "values": values,
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


def contestant_of(name, times, stages=None):
    return {"name": name, "threads": 1, "pairs": 7, "cpu_ms": times, "wall_ms": times, "mean_stage_ms": stages or {}}


def judged(*cells):
    return contest_targets.judged(contest_targets.summarised(cells)).rows


class Judgement(unittest.TestCase):
    @staticmethod
    def cell(name, **milliseconds):
        return {"cell": name, "skipped": None, "values": {}, "contestants": [
            contestant_of(contestant.replace("_", " "), times) for contestant, times in milliseconds.items()]}

    def test_against_the_best_library_and_the_best_baseline(self):
        rows = judged(self.cell("A/u1/1000", Supple=[1, 2, 9], Embree=[9, 9, 9], CGAL=[8, 8, 8],
                                baseline_sweep=[1, 1, 1], baseline_grid=[3, 3, 3]))
        found = {row["row"]: (row["against"], row["ratio"], row["met"]) for row in rows}
        self.assertEqual(found["A, the best library"], ("CGAL", 4, "reach"))
        self.assertEqual(found["A, the baselines"], ("baseline sweep", 0.5, "missed"))

    def test_default_options_against_pairs(self):
        cell = self.cell("B/980x64", Supple=[2, 2, 2], Embree=[8, 8, 8])
        for name, time in (("Supple, pairs only", 1.6), ("Embree, contact points", 9)):
            cell["contestants"].append(contestant_of(name, [time]))
        found = {row["row"]: (row["against"], row["ratio"], row["met"]) for row in judged(cell)}
        self.assertEqual(found["B 980 × 64 and × 512, contact points, against pairs"], ("Embree", 4, "reach"))
        self.assertEqual(found["B, contact points in both"], ("Embree, contact points", 4.5, "reach"))
        self.assertEqual(found["B, cost of contact points and normals"], ("Supple, pairs only", 1.25, "missed"))

    def test_the_refit_alone_is_a_share_of_the_median_frame(self):
        cell = self.cell("limits/refit/980", ideal__leaves_as_wide=[2, 2, 2])
        cell["contestants"][0]["name"] = "ideal, leaves as wide"
        cell["contestants"].append(contestant_of("Supple", [4, 4, 10], {"refit alone": 3}))
        self.assertEqual([row["ratio"] for row in judged(cell)], [1])

    def test_smaller_is_better(self):
        cell = {"cell": "memory/980", "skipped": None, "values": {"heap bytes a triangle": 39.0}, "contestants": []}
        self.assertEqual(judged(cell)[0]["met"], "aim")
        cell["values"]["heap bytes a triangle"] = 64.5
        self.assertEqual(judged(cell)[0]["met"], "missed")

    def test_exponent(self):
        self.assertAlmostEqual(contest_targets.exponent([(1, 2), (10, 20), (100, 200)]), 1)
        self.assertAlmostEqual(contest_targets.exponent([(1, 1), (4, 8), (16, 64)]), 1.5)


class Report(unittest.TestCase):
    def test_a_table_is_read_as_written(self):
        about = {"date": "2026-11-26 08:00 UTC", "command": "contest.py --only 'A/*'"}
        cells = contest_targets.summarised([
            {"cell": "memory/980", "skipped": None, "values": {"heap bytes a triangle": 39.5}, "contestants": []},
            {"cell": "C/rods", "skipped": "no rods, no cell", "values": {}, "contestants": []},
            {"cell": "B/980x64", "skipped": None, "values": {"triangles": 62720}, "contestants": [
                contestant_of("Supple, pairs only", [2, 2, 2], {"update": 1, "order and events": 2}), contestant_of("Embree", [8])]}])
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder) / "table.csv"
            contest_report.write_csv(table, about, cells)
            self.assertEqual(contest_report.read_csv(table), (about, cells))

    @needs_matplotlib
    def test_each_kept_table_makes_a_page(self):
        tables = list((ROOT / "benchmarks/results").glob("*contest.csv"))
        self.assertTrue(tables)
        with tempfile.TemporaryDirectory() as folder:
            for table in tables:
                page = pathlib.Path(folder) / "page.html"
                done = subprocess.run([sys.executable, ROOT / "benchmarks/contest_report.py", table, page],
                                      capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                tree = xml.etree.ElementTree.fromstring(page.read_text(encoding="utf-8").removeprefix("<!DOCTYPE html>\n"))
                self.assertGreaterEqual(len(tree.findall(".//table")), 3, table)
                self.assertIn(contest_report.read_csv(table)[0]["commit"], page.read_text(encoding="utf-8"))


class Driver(unittest.TestCase):
    def test_without_the_programs_it_ends_with_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            build = pathlib.Path(folder)
            (build / "bin").mkdir()
            for name in ("bin/supple_contest", "CMakeCache.txt", "bin/supple"):
                done = subprocess.run([sys.executable, ROOT / "benchmarks/contest.py", "--build", build],
                                      capture_output=True, text=True, check=False)
                self.assertEqual((done.returncode, done.stdout), (1, ""))
                self.assertEqual(done.stderr, f"contest.py: no {build / name}; run: make bench\n")
                (build / name).touch()

    @needs_matplotlib
    def test_writes_results(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [sys.executable, ROOT / "benchmarks/contest.py", "--build", BUILD, "--output", folder, "--seconds",
                 "0.01", "--only", "A/u1/300", "--only", "A/u1/600", "--only", "B/80x8", "--only", "C/crumpled-small",
                 "--only", "limits/refit/80"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            about, cells = contest_report.read_csv(pathlib.Path(folder) / "results.csv")
            self.assertIn("--only limits/refit/80", about["command"])
            self.assertEqual([cell["cell"] for cell in cells],
                             ["A/u1/300", "A/u1/600", "B/80x8", "C/crumpled-small", "limits/refit/80"])
            self.assertIn("baseline sweep", [c["name"] for c in cells[0]["contestants"]])
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
