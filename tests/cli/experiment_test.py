"""Tests the reports of `supple experiment`: files, CSV, and HTML pages without external resources."""

import csv
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest
import xml.etree.ElementTree

from program import CAN_RENDER, PROGRAM, ROOT, ProgramTest, run

# The report needs matplotlib and scipy; the program looks for Debian's Python, too.
PYTHON = next((python for python in ("python3", "/usr/bin/python3")
               if shutil.which(python) and subprocess.run([python, "-c", "import matplotlib, scipy"], capture_output=True).returncode == 0), None)
HAS_MATPLOTLIB = PYTHON is not None


def without_seconds(rows):
    """The rows without the columns that depend on the machine."""
    return [{name: value for name, value in row.items() if not name.endswith("_seconds")} for row in rows]


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
        if path.name != "figures.html":  # which judges nothing
            self.assertEqual(headings[0], "What holds")
        self.assertIn("Parameters and machine", headings)
        for verdict in (b.text for b in root.iter("b")):
            self.assertRegex(verdict, r"^((Holds|Does not hold)( if .+)?|Undecided)\.$")
        return page

    def rows(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#")))

    def head(self, name):
        lines = (self.folder / name).read_text().splitlines()
        return dict(line[2:].split(": ", 1) for line in lines if line.startswith("#"))

    @unittest.skipUnless(HAS_MATPLOTLIB, "needs matplotlib")
    def test_table1(self):
        done = self.run_here("experiment", *TINY, "--output", "out")
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertIn("What holds", done.out)
        page = self.check_page(self.folder / "out/table1.html", plots=2)
        self.assertIn("The averages of the text", page)
        runs = self.rows("out/table1_runs.csv")
        self.assertEqual({r["scene"] for r in runs}, {"table1_3", "table1_6", "table1_9", "three_humans"})
        self.assertEqual({r["volume"] for r in runs}, {"aabb", "sphere"})
        self.assertEqual({(r["scene"], r["edge"]) for r in runs if r["edge"] != "6"}, {("table1_9", "4")})
        self.assertEqual({r["steps"] for r in runs}, {"50"})
        for run in runs:
            self.assertGreater(float(run["bounds_seconds"]), 0)
        verdicts = {r["claim"]: r["verdict"] for r in self.rows("out/table1_claims.csv")}
        self.assertEqual(verdicts["averages"], "Does not hold")
        self.assertIn("more-with-boxes-detection", verdicts)

    def test_threads_change_nothing(self):
        for threads in ("1", "3"):
            self.assertEqual(
                self.run_here("experiment", *TINY, "--output", threads, "--threads", threads, "--quiet").status,
                0 if HAS_MATPLOTLIB else 2,
            )
        # Runs side by side end in any order.
        one, three = (sorted(map(str, without_seconds(self.rows(f"{threads}/table1_runs.csv")))) for threads in "13")
        self.assertTrue(one)
        self.assertEqual(one, three)

    def table1(self, *arguments):
        """Runs the experiment, with plots if matplotlib is there. Returns the rows of its runs in simulated time."""
        done = self.run_here("experiment", "table1", *arguments, "--output", "out", "--quiet")
        self.assertTrue(done.status == 0 or "matplotlib" in done.error, done.error)
        rows = without_seconds(self.rows("out/table1_runs.csv"))
        cases = list(dict.fromkeys((row["scene"], row["edge"], row["volume"]) for row in sorted(rows, key=lambda row: int(row["seed"]))))
        return sorted(rows, key=lambda row: (cases.index((row["scene"], row["edge"], row["volume"])), int(row["seed"])))

    def test_the_scene_files_are_mixed_scenes(self):
        for objects in ("6", "9"):
            file = str(ROOT / f"scenes/table1_{objects}.toml")
            runs = self.table1("--objects", objects, "--scene", file, "--seconds", "12", "--runs", "2")
            self.assertEqual(len(runs), 8)
            counts = {}
            for run in runs:
                counts.setdefault(run["scene"], []).append([run[c] for c in ("broad", "narrow", "exact", "steps")])
            self.assertEqual(counts[f"table1_{objects}"], counts[file])
            self.assertTrue(any(run["narrow"] != "0" for run in runs))

    def test_any_scene_and_method(self):
        size = ("--scene", ROOT / "scenes/nine.toml", "--scene-size", "5,4", "--seconds", "4", "--runs", "2")
        paper = self.table1(*size)
        self.assertEqual([r["edge"] for r in paper[::2]], ["5", "5", "4", "4"])
        self.assertNotEqual(paper[0]["broad"] + paper[0]["narrow"], paper[1]["broad"] + paper[1]["narrow"])
        self.assertEqual(paper, self.table1(*size, "--broad-phase", "brute"))
        shallow = self.table1(*size, "--max-level", "0", "--bounding-volume", "sphere,aabb")
        self.assertEqual([r["volume"] for r in shallow[::2]], ["sphere", "aabb", "sphere", "aabb"])
        for run in shallow:
            self.assertEqual(run["narrow"], run["broad"])

    def test_an_interrupted_experiment_goes_on(self):
        command = ("experiment", "table1", "--objects", "3", "--bounding-volume", "aabb", "--runs", "2", "--seconds", "0",
                   "--program-clock", "1", "--output", "out", "--quiet")  # fmt: skip
        process = subprocess.Popen([PROGRAM, *command], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        path = self.folder / "out/table1_program_runs.csv"
        deadline = time.monotonic() + 60
        while not (path.exists() and len(self.rows("out/table1_program_runs.csv")) == 1):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        error = process.communicate()[1]
        self.assertEqual(process.returncode, 130)
        self.assertIn("--resume", error)
        first = self.rows("out/table1_program_runs.csv")
        self.assertEqual(len(first), 1)
        self.assert_one_line_error(
            self.run_here(*command, "--resume", "--broad-phase", "grid"), "--broad-phase grid", "same command"
        )
        self.assert_one_line_error(self.run_here(*command, "--resume", PATH="/nonexistent"), "matplotlib")
        runs = self.rows("out/table1_program_runs.csv")
        self.assertEqual(runs[:1], first)
        self.assertEqual([r["seed"] for r in runs], ["1", "2"])
        for run in runs:
            self.assertGreaterEqual(float(run["detection_seconds"]) + float(run["motion_seconds"]), 1)
        self.assertFalse((self.folder / "out/table1_runs.csv").exists())

    def test_without_python_or_matplotlib_tables_are_written(self):
        self.write("broken/matplotlib.py", "raise ImportError")
        for environment in ({"PATH": "/nonexistent"}, {"PYTHONPATH": str(self.folder / "broken")}):
            done = self.run_here("experiment", *TINY, "--output", "out", "--quiet", **environment)
            self.assert_one_line_error(done, "matplotlib", "apt-get install python3-matplotlib")
            self.assertTrue(self.rows("out/table1_runs.csv"))
            self.assertFalse((self.folder / "out/table1.html").exists())
        head = self.head("out/table1_runs.csv")
        self.assertEqual(head["command"], "supple experiment " + " ".join(TINY) + " --output out")
        self.assertLess({"date", "commit", "processor", "compiler"}, head.keys())

    @unittest.skipUnless(HAS_MATPLOTLIB, "needs matplotlib")
    def test_the_script_makes_the_page_later(self):
        self.run_here("experiment", *TINY, "--output", "out", "--quiet", PATH="/nonexistent")
        script = pathlib.Path(PROGRAM).parent / "supple-experiment-report"
        done = subprocess.run([script, self.folder / "out"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("What holds", done.stdout)
        self.check_page(self.folder / "out/table1.html", plots=2)
        done = subprocess.run([script, self.folder], capture_output=True, text=True)
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1))

    @unittest.skipUnless(
        HAS_MATPLOTLIB and os.environ.get("SUPPLE_LONG_TESTS"), "takes long; the test cli.experiment_quick runs it"
    )
    def test_quick_versions(self):
        for name, plots, table in (("scaling", 4, "scaling_vertices"), ("arity", 3, "arity_objects"),
                                   ("volumes", 4, "volumes"), ("claims", 0, "claims_motion"),
                                   ("ablation", 2, "ablation"), ("trials", 1, "trials"), ("sensitivity", 1, "sensitivity"),
                                   ("figures", 3, "figures_2")):
            done = self.run_here("experiment", name, "--quick", "--output", f"paper/{name}")
            self.assertEqual((done.status, done.error), (0, ""))
            page = self.check_page(self.folder / f"paper/{name}/{name}.html", plots)
            self.assertGreater(len(self.rows(f"paper/{name}/{table}.csv")), 4)
            self.assertNotIn("nan", page)
        quantities = {row["quantity"]: set() for row in self.rows("paper/scaling/scaling_vertices_times.csv")}
        for row in self.rows("paper/scaling/scaling_vertices_times.csv"):
            quantities[row["quantity"]].add(row["vertices"])
        self.assertEqual([len(sizes) for sizes in quantities.values()], 6 * [4])
        self.assertEqual({row["arity"] for row in self.rows("paper/arity/arity_objects.csv")}, {"2", "4", "8"})
        self.check_claims()
        if CAN_RENDER:
            self.check_paper()

    def check_claims(self):
        """Each claim has a name of its own, a verdict, and numbers with what they are."""
        names = set()
        for path in (self.folder / "paper").glob("*/*_claims.csv"):
            for claim in self.rows(path.relative_to(self.folder)):
                self.assertNotIn(claim["claim"], names)
                names.add(claim["claim"])
                self.assertRegex(claim["verdict"], "^((Holds|Does not hold)( if .+)?|Undecided)$")
                self.assertTrue(claim["quantity"] and claim["numbers"], claim["claim"])
        self.assertGreater(len(names), 30)

    def check_paper(self):
        """One page of all experiments; those that are complete are not repeated, only table1 runs."""
        command = [PYTHON, ROOT / "experiments/paper.py", "--quick", "--program", PROGRAM, "--output", "paper"]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (0, "Written: paper/paper.html\n"), done.stderr)
        self.assertEqual(done.stderr.count("complete"), 8)
        self.assertIn("(quick version)", (self.folder / "paper/paper.html").read_text())
        page = (self.folder / "paper/paper.html").read_text()
        for heading in ("Figure 1", "Figure 2", "Figure 3", "Figure 4", "Figure 5", "Table 1", "What holds"):
            self.assertIn(f"<h2>{heading}", page)
        self.assertEqual(page.count("data:image/webp"), 2)
        for name in ("figure3.webp", "figure5.webp"):
            self.assertEqual((self.folder / "paper" / name).read_bytes()[8:12], b"WEBP")

    def test_unusable(self):
        self.assert_one_line_error(run("experiment", "table2"), "table2", "table1, scaling, arity, volumes, claims, ablation, trials, sensitivity or figures")
        self.assert_one_line_error(run("experiment", "scaling", "--runs", "3"), "--runs", "table1")
        self.assert_one_line_error(run("experiment", "scaling", "--threads", "3"), "--threads", "table1 or sensitivity")
        self.assert_one_line_error(run("experiment", "arity", "--max-level", "3"), "--max-level", "table1")
        for arguments, parts in (
            (["--objects", "1"], ["--objects", "from 2"]),
            (["--objects", "3,6,3"], ["'3' is given twice"]),
            (["--seconds", "0"], ["--seconds", "--program-clock"]),
            (["--bounding-volume", "aabb", "--sphere-fit", "box"], ["--sphere-fit", "--bounding-volume sphere"]),
            (["--broad-phase", "sweep", "--scene-octree-arity", "2"], ["--scene-octree-arity", "octree"]),
            (["--objects", "9", "--scene-size", "2"], ["--scene-size", "at least 3.6"]),
            (["--scene", ROOT / "scenes/nine.toml", "--integrator", "verlet"], ["--integrator", "no mass-spring body"]),
            (["--resume", "--output", "none"], ["--resume", "none"]),
        ):
            self.assert_one_line_error(self.run_here("experiment", "table1", *arguments), *parts)
            self.assertFalse(list(self.folder.iterdir()))
        self.write("file", "no folder")
        self.assert_one_line_error(
            self.run_here("experiment", *TINY, "--output", "file/below", "--quiet"), "file/below", "--output"
        )

    def test_without_its_program(self):
        alone = shutil.copy(PROGRAM, self.folder / "supple")
        done = subprocess.run([alone, "experiment", "table1"], capture_output=True, text=True, env={"PATH": "/nonexistent"})
        self.assertEqual((done.returncode, done.stdout, len(done.stderr.splitlines())), (2, "", 1))
        self.assertIn("supple-experiment", done.stderr)
        os.symlink(pathlib.Path(PROGRAM).parent / "supple-experiment", self.folder / "supple-experiment")
        self.assertEqual(subprocess.run([alone, "experiment", "--help"], stdout=subprocess.DEVNULL).returncode, 0)

    def test_tree_arity(self):
        expected = self.run_here("detect", "--json", "-", "--no-stats", *self.models()).out
        for arity in ("2", "4", "8"):
            done = self.run_here("detect", "--json", "-", "--no-stats", "--object-octree", "regular", "--tree-arity", arity, *self.models())
            self.assertEqual((done.status, done.out), (0, expected))
        self.assert_one_line_error(self.run_here("detect", "--tree-arity", "3", *self.models()), "--tree-arity", "2, 4 or 8")
        self.assert_one_line_error(self.run_here("detect", "--tree-arity", "4", *self.models()), "balanced octree", "arity of 4", "regular or bottom-up")

    def models(self):
        scene = "[[object]]\nmodel = 'rabbit'\n[[object]]\nmodel = 'fish'\n"
        return [self.write("scene.toml", scene)]


if __name__ == "__main__":
    unittest.main()
