"""docs/distributed.md has parts of the example that is compiled, and its output, which any number of ranks prints."""

import pathlib
import re
import subprocess
import sys
import unittest

ROOT, MPIEXEC, PROGRAM = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```$", (ROOT / "docs/distributed.md").read_text(), re.M | re.S)


class Document(unittest.TestCase):
    def test_its_parts_are_those_of_the_example(self):
        program = (ROOT / "examples/distributed/many_ranks.cpp").read_text()
        self.assertTrue(blocks("cpp"))
        for block in blocks("cpp"):
            self.assertIn(block, program)

    def test_any_number_of_ranks_prints_the_output(self):
        for ranks in (1, 2, 3):
            run = subprocess.run([MPIEXEC, "-n", str(ranks), PROGRAM], capture_output=True, text=True, check=True)
            self.assertEqual([run.stdout], blocks("text"), ranks)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
