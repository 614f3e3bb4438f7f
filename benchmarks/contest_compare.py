#!/usr/bin/env python3
"""Compares this working tree with a commit: Supple alone, both built the same way, run in turn.

usage: contest_compare.py BASE [--only CELL]... [--rounds N] [--seconds S]

    BASE           a commit, such as main or HEAD~3
    --only CELL    a cell of `contest.py --list`, or a pattern; may be repeated (default: some of each kind)
    --rounds N     processes per version, run in turn (default: 5)
    --seconds S    processor time per process (default: 1)

The base is checked out into build/compare with the benchmarks of this tree, so the same program measures both.
Exit status 3 when the two versions find different pairs.
"""

import argparse
import fnmatch
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys

from contest import FULL, ROOT, git, print_table

FOLDER = ROOT / "build/compare"
CELLS = ["A/u1/10000", "A/u1/100000", "A/u8/100000", "A/clu/100000", "A/cl8/100000", "B/980x64", "B/980x512",
         "B/18000x9", "B/18000x64", "B/69620x9", "B/bunnyx9", "B/18000x64-rest", "C/cloth-funnel", "C/cloth-ball",
         "C/crumpled"]


def check_out(base):
    """The sources of the base commit with the benchmarks of this tree, in a git worktree."""
    sources = FOLDER / "base-sources"
    if (sources / ".git").exists():
        subprocess.run(["git", "-C", sources, "checkout", "--quiet", "--force", "--detach", base], check=True)
    else:
        subprocess.run(["git", "-C", ROOT, "worktree", "prune"], check=True)
        subprocess.run(["git", "-C", ROOT, "worktree", "add", "--quiet", "--force", "--detach", sources, base],
                       check=True)
    shutil.rmtree(sources / "benchmarks", ignore_errors=True)
    shutil.copytree(ROOT / "benchmarks", sources / "benchmarks")
    return sources


def build(sources, name, program="supple_contest"):
    """Builds only this program, with the options of the release preset."""
    folder = FOLDER / name
    options = ["FORMATS", "RECORDING", "TOOLS", "TESTS", "EXAMPLES"]
    subprocess.run(["cmake", "-S", sources, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                    "-DCMAKE_CXX_FLAGS_RELEASE=-O3 -DNDEBUG", "-DSUPPLE_BUILD_BENCHMARKS=ON",
                    *(f"-DSUPPLE_BUILD_{option}=OFF" for option in options)], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder, "--target", program, "-j", str(os.cpu_count())], check=True,
                   stdout=subprocess.DEVNULL)
    return folder / "bin" / program


def measure(program, cell, seconds):
    # The sources of the base are in another folder, but use the same data.
    environment = {"SUPPLE_DATA": str(ROOT.parent / "shared/data")} | os.environ
    done = subprocess.run([program, cell, "--only-supple", "--seconds", str(seconds)], capture_output=True, text=True,
                          env=environment, check=False)
    if done.returncode != 0:
        sys.exit(f"contest_compare.py: {cell}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def compare(programs, cell, arguments):
    """One line of the table per contestant, and whether both versions found the same pairs."""
    medians, pairs = {}, {}
    for turn in range(arguments.rounds):
        for name in sorted(programs, reverse=turn % 2 == 1):
            result = measure(programs[name], cell, arguments.seconds)
            if result["skipped"]:
                return [[cell, "left out: " + result["skipped"], "", "", ""]], True
            for c in result["contestants"]:
                medians.setdefault((c["name"], name), []).append(statistics.median(c["cpu_ms"]))
                pairs[c["name"], name] = c["pairs"], c["hash"]
    lines, same = [], True
    for contestant in dict.fromkeys(contestant for contestant, _ in medians):
        base, head = medians[contestant, "base"], medians[contestant, "head"]
        ratios = sorted(b / h for b, h in zip(base, head))
        lines.append([cell, contestant, f"{statistics.median(base):.4g}", f"{statistics.median(head):.4g}",
                      f"{statistics.median(ratios):.3f} ({ratios[0]:.3f} – {ratios[-1]:.3f})"])
        if pairs[contestant, "base"] != pairs[contestant, "head"]:
            print(f"DISAGREEMENT {cell}: base {pairs[contestant, 'base']}, head {pairs[contestant, 'head']}")
            same = False
    return lines, same


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n\n")[0])
    parser.add_argument("base")
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=1)
    arguments = parser.parse_args()
    base = git("rev-parse", "--short", arguments.base + "^{commit}")
    if not base:
        sys.exit(f"contest_compare.py: no commit is named '{arguments.base}'; git log --oneline lists them")
    cells = CELLS if not arguments.only else [
        cell for cell in FULL if any(fnmatch.fnmatch(cell, pattern) for pattern in arguments.only)
        and not cell.startswith("process/")]
    FOLDER.mkdir(parents=True, exist_ok=True)
    programs = {"base": build(check_out(base), "base"), "head": build(ROOT, "head")}
    table, agree = [["cell", "", f"base {base}, ms", "head, ms", "base / head (lowest – highest)"]], True
    for cell in cells:
        lines, same = compare(programs, cell, arguments)
        table += lines
        agree = agree and same
    print_table(table)
    return 0 if agree else 3


if __name__ == "__main__":
    sys.exit(main())
