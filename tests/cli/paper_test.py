"""Runs every command in experiments/ELEMENTS.md. Each row has a command, or says that the part is not built. The numbers
on the pages are those of committed tables."""

import importlib.util
import json
import os
import re
import subprocess
import sys
import unittest

from program import ROOT, ProgramTest, run

PAGE = (ROOT / "experiments/ELEMENTS.md").read_text()
RESULTS = ROOT / "benchmarks/results/paper"


def rows():
    """The cells of all rows of the tables."""
    for line in PAGE.splitlines():
        if line.startswith("| ") and not line.startswith(("| The paper |", "| --- |")):
            yield [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]


class Paper(ProgramTest):
    def test_each_row_has_a_command_or_is_not_built(self):
        for row in rows():
            self.assertEqual(len(row), 4, row)
            self.assertTrue(row[2].startswith("`supple ") or row[1] in ("not built", "not used"), row)

    @unittest.skipUnless(importlib.util.find_spec("jinja2"), "needs jinja2")
    def test_the_pages_are_made_from_the_tables(self):
        done = subprocess.run([sys.executable, ROOT / "tools/make_paper.py", "--check"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_each_table_names_its_commit_and_machine(self):
        tables = sorted(RESULTS.glob("*/*.csv"))
        self.assertGreater(len(tables), 20)
        commits = set()
        for path in tables:
            head = dict(line[2:].split(": ", 1) for line in path.read_text().splitlines() if line.startswith("# "))
            self.assertLessEqual({"date", "commit", "processor", "compiler", "command"}, head.keys(), path)
            self.assertRegex(head["commit"], "^[0-9a-f]+$", f"{path}: from changed sources")
            commits.add(head["commit"])
        if subprocess.run(["git", "rev-parse", "--is-shallow-repository"], cwd=ROOT, capture_output=True, text=True).stdout == "false\n":
            for commit in commits:
                subprocess.run(["git", "cat-file", "-e", commit], cwd=ROOT, check=True)

    def test_level_allowed_changes_the_work_of_its_example(self):
        command = next(row[2].strip("`") for row in rows() if "--scene-octree-max-level 3" in row[2] and "simulate" in row[2])
        tests = []
        for level in ("2", "3"):
            done = run(*command.replace("max-level 3", f"max-level {level}").split()[1:], "--quiet", "--json", "-", folder=ROOT)
            self.assertEqual(done.error, "")
            tests.append(sum(frame["stats"]["object_pairs_tested"] for frame in json.loads(done.out)["frames"]))
        self.assertLess(2 * tests[1], tests[0])

    @unittest.skipUnless(os.environ.get("SUPPLE_LONG_TESTS"), "runs experiments; the test cli.paper_commands runs it")
    def test_each_command_runs(self):
        os.symlink(ROOT / "scenes", self.folder / "scenes")
        commands = dict.fromkeys(row[2].strip("`") for row in rows() if row[2])
        self.assertGreater(len(commands), 30)
        for command in commands:
            with self.subTest(command):
                done = self.run_here(*command.split()[1:])
                self.assertEqual((done.status, done.error), (0, ""))
                self.assertTrue(done.out)


if __name__ == "__main__":
    unittest.main()
