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
PAGE = ROOT / "docs/tutorial.md"
# A code block, optionally preceded by the name of its file.
BLOCK = re.compile(r"(?:^<!-- file: (?P<file>\S+) -->\n)?^```(?P<language>\w+)\n(?P<code>.*?)^```$", re.M | re.S)


def as_pattern(text):
    """A pattern for the text, in which a line '...' matches any lines."""
    lines = [r"(?:.*\n)*?" if line == "..." else re.escape(line) + r"\n" for line in text.splitlines()]
    return "".join(lines) + "$"


class Tutorial(unittest.TestCase):
    maxDiff = None

    def test_page(self):
        environment = os.environ | {"PATH": f"{PROGRAMS}{os.pathsep}{os.environ['PATH']}"}
        examples = {path.read_text(encoding="utf-8"): path.stem for path in (ROOT / "examples").glob("tutorial_*.cpp")}
        output, commands, programs = "", 0, []
        with tempfile.TemporaryDirectory() as folder:
            for block in BLOCK.finditer(PAGE.read_text(encoding="utf-8")):
                code = block["code"]
                if block["file"]:
                    pathlib.Path(folder, block["file"]).write_text(code, encoding="utf-8")
                elif block["language"] == "cpp":
                    self.assertIn(code, examples)
                    programs.append(examples[code])
                    output = subprocess.run([PROGRAMS / f"example_{programs[-1]}"], cwd=folder, check=True, text=True,
                                            capture_output=True).stdout
                elif block["language"] == "sh":
                    output = subprocess.run(["bash", "-e", "-c", code], cwd=folder, env=environment, check=True, text=True,
                                            capture_output=True).stdout
                    commands += 1
                elif block["language"] == "text":
                    self.assertRegex(output, re.compile("^" + as_pattern(code)))
        self.assertGreater(commands, 3)
        self.assertEqual(programs, sorted(examples.values()))

    def test_links_exist(self):
        for link in re.findall(r"\]\(([^)#]+)[^)]*\)", BLOCK.sub("", PAGE.read_text(encoding="utf-8"))):
            if not link.startswith("http"):
                self.assertTrue((PAGE.parent / link).exists(), link)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
