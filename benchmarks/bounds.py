#!/usr/bin/env python3
"""Time and peak memory of hostile and costly searches (bounds.cpp), in this working tree and in a commit.

usage: bounds.py BASE [WORD]...

Runs the cases whose names contain one of the words, by default all, and prints a table in Markdown.
"""

import subprocess
import sys

from contest import ROOT, git
from contest_compare import FOLDER, build, check_out


def measure(program, words):
    lines = subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout.splitlines()
    return {name: rest for name, *rest in ([cell.strip() for cell in line.split("|")[1:-1]] for line in lines[2:])}


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__.split("\n\n")[1])
    commit = git("rev-parse", "--short", sys.argv[1] + "^{commit}")
    if not commit:
        sys.exit(f"bounds.py: no commit is named '{sys.argv[1]}'; git log --oneline lists them")
    FOLDER.mkdir(parents=True, exist_ok=True)
    programs = [build(check_out(commit), "base", "supple_bounds"), build(ROOT, "head", "supple_bounds")]
    base, head = (measure(program, sys.argv[2:]) for program in programs)
    print(f"| case | results | {commit}, ms | now, ms | {commit}, peak MB | now, peak MB |\n|---|---|---|---|---|---|")
    for name, (results, time, memory) in head.items():
        base_results, base_time, base_memory = base[name]
        found = results if base_results == results else f"{base_results} → {results}"
        print("|", " | ".join([name, found, base_time, time, base_memory, memory]), "|")


if __name__ == "__main__":
    main()
