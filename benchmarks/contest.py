#!/usr/bin/env python3
"""Compares Supple with Embree, CGAL, FCL, Bullet, ODE and two short baselines on the workloads of docs/performance.md.

usage: contest.py [--build DIR] [--quick] [--only CELL]... [--seconds S] [--instruction-set SET] [--output DIR] [--save]
       [--list]

    --build DIR    the build with supple_contest in its bin/ (default: build/release)
    --quick        one cell of each kind, about a minute; otherwise all cells, up to 25 minutes
    --only CELL    a cell, or a pattern of cell names such as 'A/u1/*'; may be repeated
    --seconds S    processor time per cell
    --instruction-set SET  avx512, avx2 or sse4 for Supple and Embree, without the cells of whole programs; the others
                   use what they were compiled for
    --output DIR   the folder for results.csv and results.html (default: build/contest)
    --save         also store results.csv in benchmarks/results/, named by date and machine; contest_report.py makes
                   the page from it
    --list         print the names of all cells

Each cell runs in a separate process, in which the contestants run frame by frame in turn. Ratios compare
medians of processor time on one thread; cells with two threads compare wall time. Exit status: 3 when
contestants find different pairs, 1 when a cell fails in another way.
"""

import argparse
import datetime
import fnmatch
import json
import os
import pathlib
import platform
import re
import shlex
import shutil
import statistics
import subprocess
import sys
import time

import contest_report
from contest_targets import FIELDS, judged, summarised

ROOT = pathlib.Path(__file__).resolve().parent.parent
GROWTH = [f"growth/{triangles}x2" for triangles in (500, 5120, 50000, 499280, 1997120)]

COPIES = ["980x64", "980x512", "18000x9", "18000x64", "69620x9", "69620x64", "bunnyx9"]
CLOTHS = ["cloth-funnel", "cloth-ball", "crumpled", "passing", "rods"]

QUERIES = ["Q/closest/bunny-uniform", "Q/closest/bunny-near", "Q/inside/69620", "Q/rays/69620x9", "Q/penetration/69620",
           "Q/penetration/69620-deep", "Q/distance/bunny-apart", "Q/distance/bunny-near"]

FULL = (
    [f"A/{field}/{count}" for field in FIELDS for count in (1000, 10000, 100000, 1000000)]
    + ["A/u1/100000/drift", "A/u1/100000/one-percent"]
    + [f"B/{name}" for name in (*COPIES, "18000x64-rest", "69620x64-rest")]
    + [f"C/{cloth}" for cloth in CLOTHS]
    + [f"{kind}/{cloth}" for kind in "EP" for cloth in CLOTHS[:3]]
    + QUERIES
    + [f"step/{cloth}" for cloth in CLOTHS]
    + ["process/cloth-ball", "process/two-bunnies"]
    + [f"threads/B/{name}" for name in COPIES]
    + [f"threads/C/{cloth}" for cloth in CLOTHS]
    + GROWTH
    + ["limits/bandwidth"]
    + [f"limits/refit/{triangles}" for triangles in (980, 18000, 69620, 1310720)]
    + ["memory/69620", "memory/bunny", "memory/moving/69620"]
    + ["build/69620", "build/bunny", "scale/1310720", "scale/9996980", "frames/18000x9", "frames/surgery", "edit/organ", "game/penetration", "game/proximity",
       "first/cloth-ball", "first/69620x64"]
)
QUICK = (
    [f"A/{field}/10000" for field in FIELDS]
    + ["A/u1/100000", "A/clu/100000", "A/u1/100000/one-percent", "B/980x64", "B/18000x9", "B/bunnyx9",
       "B/18000x64-rest", "C/cloth-funnel", "C/crumpled", "E/crumpled", "P/crumpled", "Q/inside/69620",
       "process/two-bunnies", "threads/B/18000x64"]
    + GROWTH[:3]
    + ["limits/refit/69620", "memory/69620"]
)


class Disagreement(Exception):
    """Raised when contestants find different pairs."""


# --- running ---


def run_cell(arguments, cell):
    """Runs supple_contest on one cell and returns its JSON."""
    command = [arguments.build / "bin/supple_contest", cell, "--seconds", str(arguments.seconds)]
    if arguments.instruction_set:
        command += ["--instruction-set", arguments.instruction_set]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode == 3:
        raise Disagreement(done.stderr.strip())
    if done.returncode != 0:
        raise RuntimeError(f"{cell}: {done.stderr.strip() or f'exit status {done.returncode}'}")
    return json.loads(done.stdout)


def shared_data():
    return pathlib.Path(os.environ.get("SUPPLE_DATA", ROOT.parent / "shared/data"))


def shifted_copy(mesh, folder):
    """Returns an OBJ file with 0.025 added to every x; writes it on first use."""
    copy = folder / f"{mesh.stem}-shifted.obj"
    if not copy.exists():
        lines = []
        for line in mesh.read_text(encoding="utf-8").splitlines():
            words = line.split()
            if words[:1] == ["v"]:
                line = f"v {float(words[1]) + 0.025:.9g} {words[2]} {words[3]}"
            lines.append(line)
        copy.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return copy


def time_process(command):
    """Processor and wall milliseconds of a process pinned to one core."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL,
                               preexec_fn=lambda: os.sched_setaffinity(0, {min(os.sched_getaffinity(0))}))
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    wall = 1e3 * (time.perf_counter() - start)
    if process.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: exit status {process.returncode}")
    return 1e3 * (usage.ru_utime + usage.ru_stime), wall


def pairs_in(path):
    """The number of pairs in the output of either program."""
    result = json.loads(path.read_text(encoding="utf-8"))
    if "pairs" in result:
        return result["pairs"]
    frame = result["frames"][0]
    return [pair for group in frame["self"] + frame["triangle_pairs"] for pair in group["pairs"]]


def run_process_cell(build, cell, seconds, folder):
    """Times whole processes in turn: read, detect, write JSON."""
    data = shared_data()
    if cell == "process/cloth-ball":
        meshes, options = [data / "scalable-ccd/cloth-ball/frames/cloth_ball92.ply"], ["--self"]
    else:
        bunny = data / "models/stanford-bunny.obj"
        meshes, options = [bunny, bunny], []
    result = {"cell": cell, "skipped": None, "values": {}, "contestants": []}
    if not meshes[0].exists():
        return result | {"skipped": f"no {meshes[0].name}; set SUPPLE_DATA"}
    if not (build / "bin/supple_cgal_detect").exists():
        return result | {"skipped": "built without CGAL"}
    if len(meshes) == 2:
        meshes[1] = shifted_copy(meshes[1], folder)
    outputs = {"Supple": folder / "supple.json", "Supple, pairs only": folder / "supple_pairs.json",
               "CGAL": folder / "cgal.json"}
    detect = [build / "bin/supple", "detect", *options, "--threads", "1", "--quiet"]
    commands = {
        "Supple": [*detect, "--json", outputs["Supple"], *meshes],
        "Supple, pairs only": [*detect, "--no-contact-points", "--json", outputs["Supple, pairs only"], *meshes],
        "CGAL": [build / "bin/supple_cgal_detect", outputs["CGAL"], *meshes],
    }
    times = {name: [] for name in commands}
    start = time.perf_counter()
    while len(times["CGAL"]) < 5 or time.perf_counter() - start < 2 * seconds:
        for name, command in commands.items():
            times[name].append(time_process(command))
    found = {name: pairs_in(path) for name, path in outputs.items()}
    for name in ("Supple", "Supple, pairs only"):
        if sorted(found[name]) != sorted(found["CGAL"]):
            raise Disagreement(f"{cell}: CGAL finds {len(found['CGAL'])} pairs, {name} {len(found[name])}, "
                               "or as many others")
    for name in commands:
        result["contestants"].append({
            "name": name, "threads": 1, "pairs": len(found[name]), "hash": "", "mean_stage_ms": {},
            "cpu_ms": [cpu for cpu, _ in times[name]], "wall_ms": [wall for _, wall in times[name]]})
    return result


# --- output ---


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as lines:
        return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), "unknown")


def git(*arguments):
    done = subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True, check=False)
    return done.stdout.strip()


def cache_entry(build, name):
    for line in (build / "CMakeCache.txt").read_text(encoding="utf-8").splitlines():
        if line.startswith(name + ":"):
            return line.split("=", 1)[1]
    return ""


def description(build, arguments, missing):
    compiler = cache_entry(build, "CMAKE_CXX_COMPILER") or "c++"
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=False).stdout.split("\n")[0]
    return {
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        "commit": git("rev-parse", "--short", "HEAD") + (" with changes" if git("status", "--porcelain", "src", "include")
                                                         else ""),
        "processor": processor(),
        "cores": str(os.cpu_count()),
        "system": f"{platform.system()} {platform.release()}",
        "compiler": f"{version}, {cache_entry(build, 'CMAKE_BUILD_TYPE')}",
        "instruction set": arguments.instruction_set or "the best of each library",
        "load at the start": f"{os.getloadavg()[0]:.1f} processes",
        "command": " ".join(["benchmarks/contest.py", *map(shlex.quote, sys.argv[1:])]),
        "run": "quick" if arguments.quick else "chosen cells" if arguments.only else "full",
        "left out": ", ".join(missing) or "nothing",
    }


def print_table(lines):
    widths = [max(len(line[i]) for line in lines) for i in range(len(lines[0]))]
    for line in lines:
        print("  ".join(text.ljust(width) for text, width in zip(line, widths)).rstrip())


def file_name_of(about):
    machine = re.sub(r"[^a-z0-9.]+", "-", re.sub(r"\(r\)|\(tm\)|intel|amd|cpu|processor|@", " ", about["processor"].lower()))
    limit = about["instruction set"].split()
    return "-".join([about["date"][:10], machine.strip("-"), *(limit if len(limit) == 1 else []), "contest"])


def write_results(arguments, about, cells):
    table = arguments.output / "results.csv"
    contest_report.write_csv(table, about, cells)
    (arguments.output / "results.html").write_text(contest_report.html_of(about, cells), encoding="utf-8")
    print(f"\nWritten: {arguments.output}/results.html, results.csv")
    if arguments.save:
        kept = ROOT / "benchmarks/results" / (file_name_of(about) + ".csv")
        shutil.copy(table, kept)
        print(f"Kept: {kept}")


def chosen_cells(arguments):
    cells = QUICK if arguments.quick else FULL
    if arguments.instruction_set:
        cells = [cell for cell in cells if not cell.startswith("process/")]
    if not arguments.only:
        return cells
    for pattern in arguments.only:
        if "*" in pattern and not fnmatch.filter(FULL, pattern):
            sys.exit(f"contest.py: no cell matches {pattern}; --list prints all, and --only takes one name or pattern "
                     "and may be repeated")
    chosen = [cell for cell in FULL if any(fnmatch.fnmatch(cell, pattern) for pattern in arguments.only)]
    # A name that is in no list may still be a cell, such as B/5120x27.
    chosen += [name for name in arguments.only if name not in chosen and "*" not in name]
    return chosen


def run_all(arguments, cells):
    """Results, whether any cell failed, and whether contestants disagreed."""
    results, failed, disagree = [], False, False
    for number, cell in enumerate(cells, 1):
        start = time.perf_counter()
        try:
            if cell.startswith("process/"):
                result = run_process_cell(arguments.build, cell, arguments.seconds, arguments.output)
            else:
                result = run_cell(arguments, cell)
        except Disagreement as error:
            print(f"DISAGREEMENT {error}", flush=True)
            disagree = True
            continue
        except (RuntimeError, json.JSONDecodeError) as error:
            print(f"FAILED {error}", flush=True)
            failed = True
            continue
        results.append(result)
        summary = ", ".join(f"{c['name']} {statistics.median(c['cpu_ms']):.3g}" for c in result["contestants"])
        if result["values"] and not summary:
            summary = ", ".join(f"{name} {value:.3g}" for name, value in result["values"].items())
        print(f"[{number}/{len(cells)}, {time.perf_counter() - start:.0f} s] {cell}: "
              f"{'left out: ' + result['skipped'] if result['skipped'] else summary}", flush=True)
    return results, failed, disagree


def parsed(words):
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n\n")[0])
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--instruction-set", choices=["avx512", "avx2", "sse4"])
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "build/contest")
    parser.add_argument("--save", action="store_true")
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args(words)
    if arguments.seconds is None:
        arguments.seconds = 1 if arguments.quick else 5
    return arguments


def main():
    arguments = parsed(sys.argv[1:])
    cells = chosen_cells(arguments)
    if arguments.list:
        print("\n".join(cells))
        return 0
    needed = ["bin/supple_contest", "CMakeCache.txt", *(["bin/supple"] if any(cell.startswith("process/") for cell in cells) else [])]
    for name in needed:
        if not (arguments.build / name).exists():
            sys.exit(f"contest.py: no {arguments.build / name}; run: make bench")
    missing = subprocess.run([arguments.build / "bin/supple_contest", "--missing"], capture_output=True, text=True,
                             check=True).stdout.split()
    about = description(arguments.build, arguments, missing)
    for name, value in about.items():
        print(f"{name}: {value}")
    print("\nmedian milliseconds of processor time", flush=True)
    arguments.output.mkdir(parents=True, exist_ok=True)
    results, failed, disagree = run_all(arguments, cells)
    cells = summarised(results)
    print()
    print_table(contest_report.rows_of_table(judged(cells)))
    write_results(arguments, about, cells)
    return 3 if disagree else 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
