"""Runs every command in docs/paper.md. Each row has a command, or says that the part is not built."""

import os
import re
import unittest

from program import ROOT, ProgramTest

PAGE = (ROOT / "docs/paper.md").read_text()


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
