"""Checks the programs, their output and the CMake project in the README."""

import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(sys.argv[1])
PROGRAMS = [pathlib.Path(name) for name in sys.argv[2:]]


def blocks(language):
    """The code blocks of the README in this language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", (ROOT / "README.md").read_text(), re.M | re.S)


class Readme(unittest.TestCase):
    maxDiff = None

    def test_programs_are_the_examples_that_are_compiled(self):
        sources = [ROOT / "examples" / f"{program.name.removeprefix('example_')}.cpp" for program in PROGRAMS]
        self.assertEqual(blocks("cpp"), [source.read_text() for source in sources])

    def test_outputs(self):
        outputs = [subprocess.run([program], capture_output=True, text=True, check=True).stdout
                   for program in PROGRAMS]
        self.assertEqual(blocks("text"), outputs)

    def test_cmake_projects_are_those_that_the_install_tests_build(self):
        installed, fetched = blocks("cmake")
        self.assertIn(installed, (ROOT / "tests/install/consumer/CMakeLists.txt").read_text())
        self.assertIn(fetched, (ROOT / "tests/install/fetching_consumer/CMakeLists.txt").read_text())

    def test_links_exist(self):
        links = re.findall(r"\]\(([^)#]+)[^)]*\)", (ROOT / "README.md").read_text())
        self.assertTrue(links)
        for link in links:
            if not link.startswith("http"):
                self.assertTrue((ROOT / link).exists(), link)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
