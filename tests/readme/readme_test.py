"""The README shows a program, its output and a CMake project; all three are checked against the real thing."""

import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(sys.argv[1])
PROGRAM = sys.argv[2]


def block(language):
    """The README's first block of code in this language."""
    match = re.search(rf"^```{language}\n(.*?)^```$", (ROOT / "README.md").read_text(), re.M | re.S)
    return match[1] if match else None


class Readme(unittest.TestCase):
    maxDiff = None

    def test_program_is_the_example_that_is_compiled(self):
        self.assertEqual(block(r"cpp"), (ROOT / "examples/hello.cpp").read_text())

    def test_output(self):
        done = subprocess.run([PROGRAM], capture_output=True, text=True, check=True)
        self.assertEqual(block(r"text"), done.stdout)

    def test_cmake_project_is_the_one_that_the_install_test_builds(self):
        project = (ROOT / "tests/install/consumer/CMakeLists.txt").read_text()
        self.assertIn(block("cmake"), project)

    def test_links_exist(self):
        links = re.findall(r"\]\(([^)#]+)[^)]*\)", (ROOT / "README.md").read_text())
        self.assertTrue(links)
        for link in links:
            if not link.startswith("http"):
                self.assertTrue((ROOT / link).exists(), link)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
