"""Tests the reports of `supple experiment`: files, CSV, and HTML pages without external resources."""

import csv
import os
import shutil
import unittest
import xml.etree.ElementTree

from program import ProgramTest, run

TINY = ("table1", "--quick", "--runs", "1", "--seconds", "1")


class Experiment(ProgramTest):
    def check_page(self, path, plots):
        page = path.read_text()
        for url in ("http:", "https:", "//", "url(", "@import", "<script", "<link", "<img"):
            self.assertNotIn(url, page.replace("</", "").replace("url(#", ""), url)
        root = xml.etree.ElementTree.fromstring(page.removeprefix("<!DOCTYPE html>"))
        self.assertEqual(len(root.findall(".//svg")), plots)
        ids = [e.get("id") for e in root.iter() if e.get("id")]
        self.assertEqual(len(ids), len(set(ids)), "ids are unique")
        for use in root.iter("use"):
            self.assertIn(use.get("href").removeprefix("#"), ids)
        headings = [h.text for h in root.iter("h2")]
        self.assertEqual(headings[0], "What holds")
        self.assertIn("Parameters and machine", headings)
        verdicts = {b.text.strip() for b in root.iter("b")}
        self.assertLessEqual(verdicts, {"Holds.", "Does not hold.", "Undecided."})
        return page

    def rows(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))

    @unittest.skipUnless(shutil.which("gnuplot"), "needs gnuplot")
    def test_table1(self):
        done = self.run_here("experiment", *TINY, "--output", "out")
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertIn("What holds", done.out)
        self.check_page(self.folder / "out/table1.html", plots=2)
        runs = self.rows("out/table1_runs.csv")
        self.assertEqual({r["scene"] for r in runs}, {"table1_3", "table1_6", "table1_9", "three_humans"})
        self.assertEqual({r["volume"] for r in runs}, {"AABB", "spheres"})
        self.assertEqual({r["steps"] for r in runs}, {"50"})
        paper = self.rows("out/table1_paper.csv")
        self.assertAlmostEqual(float(paper[0]["seconds_per_collision"]), 600 / 24.6)
        self.assertEqual([r["comparison"] for r in paper].count("differs"), 1)

    def test_threads_change_nothing(self):
        for threads in ("1", "3"):
            self.assertEqual(
                self.run_here("experiment", *TINY, "--output", threads, "--threads", threads, "--quiet").status,
                0 if shutil.which("gnuplot") else 2,
            )
        for name in ("table1_runs.csv", "table1_means.csv"):
            self.assertEqual((self.folder / "1" / name).read_text(), (self.folder / "3" / name).read_text())

    def test_by_the_clock(self):
        self.run_here("experiment", *TINY, "--wall-clock", "1", "--output", "out", "--quiet", PATH="/nonexistent")
        self.assertGreater(int(self.rows("out/table1_clock_runs.csv")[0]["steps"]), 0)

    def test_without_gnuplot_tables_are_written(self):
        done = self.run_here("experiment", *TINY, "--output", "out", "--quiet", PATH="/nonexistent")
        self.assert_one_line_error(done, "gnuplot", "apt-get install gnuplot-nox")
        self.check_page(self.folder / "out/table1.html", plots=0)
        self.assertTrue(self.rows("out/table1_runs.csv"))

    @unittest.skipUnless(
        shutil.which("gnuplot") and os.environ.get("SUPPLE_QUICK_EXPERIMENTS") == "1", "takes long unless optimised"
    )
    def test_quick_versions(self):
        for name, plots, table in (("scaling", 5, "scaling_vertices"), ("arity", 3, "arity_objects")):
            done = self.run_here("experiment", name, "--quick")
            self.assertEqual((done.status, done.error), (0, ""))
            page = self.check_page(self.folder / f"experiment_{name}/{name}.html", plots)
            self.assertGreater(len(self.rows(f"experiment_{name}/{table}.csv")), 5)
            self.assertNotIn("nan", page)

    def test_unusable(self):
        self.assert_one_line_error(run("experiment", "table2"), "table2", "table1, scaling or arity")
        self.assert_one_line_error(run("experiment", "scaling", "--runs", "3"), "--runs", "table1")
        self.write("file", "no folder")
        self.assert_one_line_error(
            self.run_here("experiment", *TINY, "--output", "file/below", "--quiet"), "file/below", "--output"
        )

    def test_tree_arity(self):
        expected = self.run_here("detect", "--json", "-", "--no-stats", *self.models()).out
        for arity in ("2", "4", "8"):
            done = self.run_here("detect", "--json", "-", "--no-stats", "--tree-arity", arity, *self.models())
            self.assertEqual((done.status, done.out), (0, expected))
        self.assert_one_line_error(self.run_here("detect", "--tree-arity", "3", *self.models()), "--tree-arity", "2, 4 or 8")

    def models(self):
        scene = "[[object]]\nmodel = 'rabbit'\n[[object]]\nmodel = 'fish'\n"
        return [self.write("scene.toml", scene)]


if __name__ == "__main__":
    unittest.main()
