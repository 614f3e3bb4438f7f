#!/usr/bin/env python3
"""Measures which lines and branches of the sources the corpora of the fuzz targets and the tests reach.

Build first: cmake --preset coverage && cmake --build --preset coverage. Prints a table by folder; each source
with its uncovered lines and branches is then in build/coverage/report/index.html. With --record, the table is
also written to fuzz/coverage.md. Needs clang-19 and llvm-19.
"""
import argparse
import collections
import datetime
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "coverage"
PAGE = ROOT / "fuzz" / "coverage.md"
SOURCES = ["src", "libs", "simulation", "recording", "formats", "viewer/session", "viewer/export", "viewer/server", "cli",
           "experiments"]
# Tests that kill the program or limit its files and memory, which the counters would not survive, and long ones.
LEFT_OUT = "^(faults|install)|OutOfMemory|cli.recording|cli.usage|viewer_e2e|cli.experiment|cli.paper"


def run_tests(name, *selection):
    """Runs tests, and returns the file with their counters."""
    counters = BUILD / "counters" / name
    counters.mkdir(parents=True, exist_ok=True)
    for old in counters.iterdir():
        old.unlink()
    subprocess.run(["ctest", "--preset", "coverage", "--quiet", *selection], cwd=ROOT, check=True,
                   env={**os.environ, "LLVM_PROFILE_FILE": f"{counters}/%2m.profraw"})
    return merged(name, sorted(counters.glob("*.profraw")))


def merged(name, files):
    result = BUILD / "counters" / f"{name}.profdata"
    subprocess.run(["llvm-profdata-19", "merge", "-sparse", "-o", result, *files], check=True)
    return result


def show(command, counters, *options):
    first, *others = [BUILD / "bin" / name for name in ("supple", "supple_tests")]
    objects = [part for other in others for part in ("-object", other)]
    line = ["llvm-cov-19", command, first, *objects, "-instr-profile", counters, *options, *(ROOT / folder for folder in SOURCES)]
    return subprocess.run([str(part) for part in line], check=True, stdout=subprocess.PIPE, text=True).stdout


def counts_by_folder(counters):
    """For each folder: covered and all lines, covered and all branches."""
    result = collections.Counter()
    for file in json.loads(show("export", counters, "-summary-only"))["data"][0]["files"]:
        folder = pathlib.Path(file["filename"]).relative_to(ROOT).parent.as_posix()
        for what in ("lines", "branches"):
            result[folder, what, "covered"] += file["summary"][what]["covered"]
            result[folder, what, "count"] += file["summary"][what]["count"]
    return result


def table(corpora, both):
    def share(counts, folders, what):
        covered, count = (sum(counts[folder, what, key] for folder in folders) for key in ("covered", "count"))
        return f"{100 * covered / count:.1f} %" if count else "–"

    folders = sorted({folder for folder, what, key in both})
    lines = ["| Folder | Lines | Lines reached | by corpora alone | Branches reached | by corpora alone |", "|---|---|---|---|---|---|"]
    library = [folder for folder in folders if folder.startswith("src/")]
    for name, of in [*((folder, [folder]) for folder in folders), ("all of src", library), ("all", folders)]:
        cells = [share(counts, of, what) for what in ("lines", "branches") for counts in (both, corpora)]
        lines.append(f"| {name} | {sum(both[folder, 'lines', 'count'] for folder in of):,} | {' | '.join(cells)} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--record", action="store_true", help="write the table to fuzz/coverage.md")
    arguments = parser.parse_args()
    if not (BUILD / "bin" / "supple_tests").exists():
        sys.exit("tools/coverage.py: build/coverage has no tests; run: cmake --preset coverage && cmake --build --preset coverage")
    corpora = run_tests("corpora", "-R", "^fuzz\\.", "-E", "^fuzz\\.soak$")
    tests = run_tests("tests", "-E", f"^fuzz\\.([^s]|s[^o])|{LEFT_OUT}")
    both = merged("both", [corpora, tests])
    show("show", both, "-format=html", f"-output-dir={BUILD}/report", "-show-branches=count")
    text = table(counts_by_folder(corpora), counts_by_folder(both))
    print(text)
    if arguments.record:
        commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
        PAGE.write_text("# Coverage\n\n`tools/coverage.py --record` writes this table: the lines and branches that the tests and the corpora reach,\n"
                        "without the tests that kill the program or take minutes, and those that the corpora reach alone.\n"
                        f"{datetime.date.today()}, commit {commit}, clang-19 with -O1.\n[README.md](README.md) says what is left.\n\n{text}\n")


if __name__ == "__main__":
    main()
