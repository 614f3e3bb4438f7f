#!/usr/bin/env python3
"""Fails when the project is larger than tools/budgets.toml allows.

usage: budgets.py [--write]

Without an option it prints each figure above its budget and exits with 1, also when a figure has fallen below its
budget, because budgets fall with the figures: --write lowers them. Only a person raises one, with a line in
[raised] that says why. Figures are counts of files that git tracks, so they are the same on every machine; times
are measured by hand and only kept there.
"""
import pathlib
import re
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUDGETS = ROOT / "tools" / "budgets.toml"
SOURCES = {".cpp", ".hpp", ".h", ".ts", ".tsx", ".py", ".css"}


def tracked(folder):
    names = subprocess.run(["git", "ls-files", "-z", "--", folder], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [ROOT / name for name in names.split("\0") if name and (ROOT / name).is_file()]


def line_count(path):
    return len(path.read_text(encoding="utf-8").splitlines())


def source_lines(folder):
    return {path: line_count(path) for path in tracked(folder) if path.suffix in SOURCES}


def pages():
    return [line_count(path) for path in tracked("docs") if path.suffix == ".md"]


def functions_of_scene():
    text = (ROOT / "include/supple/scene.hpp").read_text(encoding="utf-8")
    scene = text[text.index("\nclass Scene {"):]
    scene = scene[:scene.index("\n};")]
    return len(re.findall(r"^  [A-Za-z~].*\(.*|^  [A-Za-z].*\($", scene, re.MULTILINE))


FIGURES = {
    "lines": lambda folder: sum(source_lines(folder).values()),
    "largest_file": lambda folder: max(source_lines(folder).values()),
    "documents": lambda name: len(pages()) if name == "pages" else sum(pages()),
    "interface": lambda name: functions_of_scene() if name == "functions_of_scene" else len([p for p in tracked("include/supple") if p.suffix == ".hpp"]),
}


def main():
    if sys.argv[1:] not in ([], ["--write"]):
        sys.exit(__doc__)
    text = BUDGETS.read_text(encoding="utf-8")
    budgets = tomllib.loads(text)
    above = below = 0
    for table, figure in FIGURES.items():
        for name, budget in budgets[table].items():
            now = figure(name)
            if now > budget:
                above += 1
                print(f"{table} of {name}: {now:,}, and the budget is {budget:,}. Delete something, or raise the budget in tools/budgets.toml and say why in [raised]")
            elif now < budget:
                below += 1
                text = re.sub(rf'(\[{table}\][^\[]*?"?{re.escape(name)}"? *= *){budget}\b', rf"\g<1>{now}", text, count=1)
                if "--write" not in sys.argv:
                    print(f"{table} of {name}: {now:,}, less than its budget of {budget:,}; tools/budgets.py --write lowers it")
    if "--write" in sys.argv:
        BUDGETS.write_text(text, encoding="utf-8")
    sys.exit(1 if above or (below and "--write" not in sys.argv) else 0)


if __name__ == "__main__":
    main()
