"""Runs the tutorial: writes its files, runs its commands and programs, and compares the output."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv[1])
PROGRAMS = pathlib.Path(sys.argv[2]).resolve()
PAGES = sorted((ROOT / "docs/tutorial").glob("*.md"))
# A code block, optionally preceded by the name of its file.
BLOCK = re.compile(r"(?:^<!-- file: (?P<file>\S+) -->\n)?^```(?P<language>\w+)\n(?P<code>.*?)^```$", re.M | re.S)


def as_pattern(text):
    """A pattern for the text, in which a line '...' matches any lines."""
    lines = [r"(?:.*\n)*?" if line == "..." else re.escape(line) + r"\n" for line in text.splitlines()]
    return "".join(lines) + "$"


class Tutorial(unittest.TestCase):
    maxDiff = None

    def run_page(self, page):
        environment = os.environ | {"PATH": f"{PROGRAMS}{os.pathsep}{os.environ['PATH']}"}
        output, commands = "", 0
        with tempfile.TemporaryDirectory() as folder:
            for block in BLOCK.finditer(page.read_text(encoding="utf-8")):
                code = block["code"]
                if block["file"]:
                    pathlib.Path(folder, block["file"]).write_text(code, encoding="utf-8")
                elif block["language"] == "cpp":
                    name = f"tutorial_{page.stem}"
                    self.assertEqual(code, (ROOT / f"examples/{name}.cpp").read_text(encoding="utf-8"))
                    output = subprocess.run([PROGRAMS / f"example_{name}"], cwd=folder, check=True, text=True,
                                            capture_output=True).stdout
                    commands += 1
                elif block["language"] == "sh":
                    output = subprocess.run(["bash", "-e", "-c", code], cwd=folder, env=environment, check=True, text=True,
                                            capture_output=True).stdout
                    commands += 1
                elif block["language"] == "text":
                    self.assertRegex(output, re.compile("^" + as_pattern(code)), page.name)
        self.assertGreater(commands, 0, page.name)

    def test_pages(self):
        self.assertEqual([page.stem[:2] for page in PAGES], ["1_", "2_", "3_"])
        for page in PAGES:
            with self.subTest(page=page.name):
                self.run_page(page)

    def test_links_exist(self):
        for page in PAGES:
            for link in re.findall(r"\]\(([^)#]+)[^)]*\)", BLOCK.sub("", page.read_text(encoding="utf-8"))):
                if not link.startswith("http"):
                    self.assertTrue((page.parent / link).exists(), f"{page.name}: {link}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
