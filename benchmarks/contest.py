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
    --output DIR   the folder for results.json, results.csv and results.html (default: build/contest)
    --save         also store the results in benchmarks/results/, named by date and machine
    --list         print the names of all cells

Each cell runs in a separate process, in which the contestants run frame by frame in turn. Ratios compare
medians of processor time on one thread; cells with two threads compare wall time. Exit status: 3 when
contestants find different pairs, 1 when a cell fails in another way.
"""

import argparse
import csv
import datetime
import fnmatch
import json
import math
import os
import pathlib
import platform
import re
import statistics
import subprocess
import sys
import time

import contest_report

ROOT = pathlib.Path(__file__).resolve().parent.parent
FIELDS = ["u1", "u8", "clu", "cl8"]
BASELINES = {"baseline sweep", "baseline grid"}
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
    + ["build/69620", "build/bunny", "frames/18000x9", "first/cloth-ball", "first/69620x64"]
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


# --- evaluation ---


class Judge:
    """Rows of the table: the result of each cell and its target."""

    def __init__(self, cells):
        self.cells = {cell["cell"]: cell for cell in cells if not cell["skipped"]}
        self.rows = []

    def median(self, cell, name, clock="cpu_ms"):
        for contestant in self.cells.get(cell, {"contestants": []})["contestants"]:
            if contestant["name"] == name:
                return statistics.median(contestant[clock])
        return None

    def best(self, cell, names):
        """The time and name of the fastest contestant that is present."""
        times = [(self.median(cell, name), name) for name in names]
        return min((pair for pair in times if pair[0] is not None), default=(None, None))

    def add(self, row, cell, against, value, reach, aim, smaller_is_better=False):
        if value is None:
            return
        sign = -1 if smaller_is_better else 1
        met = "aim" if sign * value >= sign * aim else "reach" if sign * value >= sign * reach else "missed"
        self.rows.append({"row": row, "cell": cell, "against": against, "ratio": value, "reach": reach, "aim": aim,
                          "smaller_is_better": smaller_is_better, "met": met})

    def add_faster(self, row, cell, names, reach, aim, supple="Supple"):
        """Adds the ratio of the best other contestant's time to Supple's time."""
        best, name = self.best(cell, names)
        own = self.median(cell, supple)
        if best is not None and own:
            self.add(row, cell, name, best / own, reach, aim)

    def libraries(self, cell):
        """The other libraries in their fastest form: without contact points."""
        return [c["name"] for c in self.cells[cell]["contestants"]
                if c["name"] not in BASELINES and not c["name"].startswith("Supple")
                and not c["name"].endswith(", contact points")]

    def matching(self, pattern):
        return [name for name in self.cells if re.fullmatch(pattern, name)]


def exponent(points):
    """The exponent of a power law, fitted by least squares of logarithms."""
    xs, ys = [math.log(x) for x, _ in points], [math.log(y) for _, y in points]
    x_mean, y_mean = statistics.mean(xs), statistics.mean(ys)
    return (sum((x - x_mean) * (y - y_mean) for x, y in zip(xs, ys))
            / sum((x - x_mean) ** 2 for x in xs))


def growth_points(judge):
    """The name and the (size, milliseconds) of each series that shows growth."""
    series = []
    for field in FIELDS:
        points = [(int(cell.split("/")[2]), judge.median(cell, "Supple"))
                  for cell in judge.matching(f"A/{field}/[0-9]+")]
        series.append((f"objects, {field}", sorted(points)))
    points = [(judge.cells[cell]["values"]["triangles"], judge.median(cell, "Supple"))
              for cell in judge.matching("growth/.*")]
    series.append(("triangles, two spheres", sorted(points)))
    return [(name, points) for name, points in series if len(points) >= 3]


def judge_refit(judge, cell):
    """Compares the refit with two ideals: one with as many leaf boxes, so a shallower tree is no advantage,
    and one with four triangles per box."""
    own = next((c for c in judge.cells[cell]["contestants"] if c["name"] == "Supple"), None)
    for row, ideal in (("refit alone, leaves as wide", "ideal, leaves as wide"),
                       ("refit alone, 4 triangles a box", "ideal, 4 per slot")):
        limit = judge.median(cell, ideal)
        if own and limit:
            alone = own["mean_stage_ms"]["refit alone"] / statistics.mean(own["cpu_ms"]) * statistics.median(own["cpu_ms"])
            judge.add(row, cell, ideal, alone / limit, 2, 1.3, True)


def judged(cells):
    judge = Judge(cells)
    copies = [("B 69,620 × 64, contact points, against pairs", "B/69620x64", 5, 8),
              ("B 18,000 × 9 and × 64, contact points, against pairs", "B/18000x(9|64)", 4.5, 7),
              ("B 980 × 64 and × 512, contact points, against pairs", "B/980x(64|512)", 4, 6),
              ("B bunny × 9, contact points, against pairs", "B/bunnyx9", 6, 9),
              ("B with 90 % of the objects at rest, contact points, against pairs", "B/.*-rest", 10, 30)]
    for row, pattern, reach, aim in copies:
        for cell in judge.matching(pattern):
            judge.add_faster(row, cell, judge.libraries(cell), reach, aim)
    for cell in judge.matching("B/.*"):
        judge.add_faster("B, contact points in both", cell, ["Embree, contact points"], 4, 6)
    for cell in judge.matching("B/.*"):
        points, pairs = judge.median(cell, "Supple"), judge.median(cell, "Supple, pairs only")
        if points and pairs:
            judge.add("B, cost of contact points and normals", cell, "Supple, pairs only", points / pairs, 1.15, 1.05,
                      True)
    for cell in judge.matching("limits/refit/.*"):
        judge_refit(judge, cell)
    boxes = judge.matching("A/[a-z0-9]+/[0-9]+")
    for cell in boxes:
        judge.add_faster("A, the best library", cell, judge.libraries(cell), 4, 6)
    for cell in boxes:
        judge.add_faster("A, the baselines", cell, BASELINES, 0.85, 1)
    for cell in judge.matching("A/[a-z0-9]+/100000"):
        judge.add_faster("A, the octree against Embree", cell, ["Embree"], 2.5, 3.8, "Supple octree")
    for cell in judge.matching("A/.*/drift"):
        drifted, fresh = judge.median(cell, "Supple, drifted"), judge.median(cell, "Supple, fresh")
        judge.add("A after 500 frames of drift", cell, "Supple, fresh", drifted / fresh, 1.1, 1, True)
    for cell in judge.matching("A/.*/one-percent"):
        judge.add_faster("A with 1 % of the boxes moving", cell, ["Supple, all move"], 3, 6,
                         "Supple, one percent moves")
        judge.add_faster("A with 1 % of the boxes moving, dirty list", cell, ["Supple, all move"], 3, 6,
                         "Supple, one percent moves, dirty list")
    for cell in judge.matching("C/.*"):
        judge.add_faster("C, candidates and verdicts, against Embree's candidates", cell, ["Embree"], 2.5, 4)
    for cell in judge.matching("E/.*"):
        judge.add_faster("E, element boxes by kinds, against the best library", cell, judge.libraries(cell), 1.5, 2)
    for cell in judge.matching("P/.*"):
        judge.add_faster("P, proximity by features, against Embree with plain distances", cell, ["Embree"], 1.5, 2)
    for cell in judge.matching("Q/(closest|rays)/.*"):
        reach = 0.5 if "rays" in cell else 1
        judge.add_faster(f"Q, {cell.split('/')[1]}, against Embree", cell, ["Embree"], reach, 2 * reach)
    for cell in judge.matching("Q/(closest|inside|penetration)/.*"):
        judge.add_faster(f"Q, {cell.split('/')[1]}, against CGAL", cell, ["CGAL"], 20, 30)
    for cell in judge.matching("Q/distance/.*"):
        judge.add_faster("Q, distance, against FCL", cell, ["FCL"], 10, 20)
    for cell in judge.matching("step/.*"):
        values = judge.cells[cell]["values"]
        judge.add("safe step", cell, "Supple, detect", values["milliseconds"] / values["milliseconds of detect"], 0.5,
                  0.3, True)
    for cell in judge.matching("build/.*"):
        values = judge.cells[cell]["values"]
        balanced = values["milliseconds, balanced"]
        judge.add("build of a balanced octree", cell, "Supple, regular", balanced / values["milliseconds, regular"], 1.1,
                  1, True)
        judge.add("build on two threads", cell, "Supple, 1 thread",
                  balanced / values["milliseconds, balanced, 2 threads"], 1.7, 1.9)
    for cell in judge.matching("first/.*"):
        judge.add_faster("first frame of a process", cell, ["Embree"], 1, 2)
    for cell in judge.matching("frames/.*"):
        values = judge.cells[cell]["values"]
        judge.add("99.9th percentile of frames", cell, "median",
                  values["milliseconds, 99.9th percentile"] / values["milliseconds, median"], 2, 1.3, True)
    for cell in judge.matching("process/.*"):
        judge.add_faster("whole process supple detect", cell, ["CGAL"], 2, 4)
    for cell in judge.matching("threads/.*"):
        one, two = judge.median(cell, "Supple", "wall_ms"), judge.median(cell, "Supple, 2 threads", "wall_ms")
        judge.add("two threads", cell, "Supple, 1 thread", one / two, 1.8, 1.95)
    for name, points in growth_points(judge):
        judge.add("growth, exponent", name, "linear", exponent(points), 1.1, 1.05, True)
    for cell in judge.matching("memory/[^/]*"):
        judge.add("memory besides the mesh, bytes a triangle", cell, "", judge.cells[cell]["values"]
                  ["heap bytes a triangle"], 64, 40, True)
    for cell in judge.matching("memory/moving/.*"):
        judge.add("memory of moving objects, bytes a triangle", cell, "", judge.cells[cell]["values"]
                  ["heap bytes a triangle"], 110, 80, True)
    return judge


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
        "run": "quick" if arguments.quick else "chosen cells" if arguments.only else "full",
        "left out": ", ".join(missing) or "nothing",
    }


def table_of(judge):
    lines = [["workload", "cell", "against", "ratio", "reach", "aim", ""]]
    for row in judge.rows:
        bound = "≤ " if row["smaller_is_better"] else "≥ "
        lines.append([row["row"], row["cell"], row["against"], f"{row['ratio']:.2f}", f"{bound}{row['reach']:g}",
                      f"{bound}{row['aim']:g}", row["met"]])
    return lines


def print_table(lines):
    widths = [max(len(line[i]) for line in lines) for i in range(len(lines[0]))]
    for line in lines:
        print("  ".join(text.ljust(width) for text, width in zip(line, widths)).rstrip())


def summary_of(judge):
    """One line per row of targets: the range over its cells, and how many cells meet the target."""
    lines = [["workload", "against", "lowest", "highest", "reach", "aim", "cells that reach the aim, reach, miss"]]
    groups = {}
    for row in judge.rows:
        groups.setdefault(row["row"], []).append(row)
    for name, rows in groups.items():
        bound = "≤ " if rows[0]["smaller_is_better"] else "≥ "
        ratios = [row["ratio"] for row in rows]
        met = [sum(row["met"] == word for row in rows) for word in ("aim", "reach", "missed")]
        lines.append([name, ", ".join(dict.fromkeys(row["against"] for row in rows)), f"{min(ratios):.2f}",
                      f"{max(ratios):.2f}", f"{bound}{rows[0]['reach']:g}", f"{bound}{rows[0]['aim']:g}",
                      ", ".join(map(str, met))])
    return lines


def markdown_table(lines):
    rows = ["| " + " | ".join(line) + " |" for line in lines]
    return "\n".join([rows[0], "|" + "---|" * len(lines[0]), *rows[1:]])


def times_by_cell(cells):
    """Median processor milliseconds of each workload: one row per cell, one column per contestant."""
    groups = {}
    for cell in cells:
        groups.setdefault(cell["cell"].split("/")[0], []).append(cell)
    for name, group in groups.items():
        compared = [cell for cell in group if any(c["name"] == "Supple" for c in cell["contestants"])]
        names = list(dict.fromkeys(c["name"] for cell in compared for c in cell["contestants"]))
        if name not in ("A", "B", "C", "E", "P", "Q", "process") or not names:
            continue
        lines = [["ms", *names, "pairs"]]
        for cell in compared:
            medians = {c["name"]: statistics.median(c["cpu_ms"]) for c in cell["contestants"]}
            lines.append([cell["cell"], *(contest_report.rounded(medians[name]) if name in medians else ""
                                          for name in names), f"{cell['contestants'][0]['pairs']:,}"])
        yield lines


def markdown_of(about, cells, judge):
    parts = ["# Supple against others, " + about["date"][:10],
             "\n".join(f"- {name}: {value}" for name, value in about.items()),
             "## Targets and results", markdown_table(summary_of(judge)),
             "## Cell by cell", markdown_table(table_of(judge)),
             "## Median milliseconds of processor time"]
    parts += [markdown_table(lines) for lines in times_by_cell(cells)]
    values = [[cell["cell"], name, contest_report.rounded(value)] for cell in cells
              for name, value in cell["values"].items() if name != "triangles"]
    if values:
        parts.append(markdown_table([["cell", "what", "value"], *values]))
    return "\n\n".join(parts) + "\n"


def write_csv(path, cells):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["cell", "contestant", "threads", "pairs", "frames", "cpu_ms_q1", "cpu_ms_median", "cpu_ms_q3",
                         "wall_ms_median"])
        for cell in cells:
            for c in cell["contestants"]:
                q1, q2, q3 = contest_report.quartiles(c["cpu_ms"])
                writer.writerow([cell["cell"], c["name"], c["threads"], c["pairs"], len(c["cpu_ms"]), f"{q1:.4g}",
                                 f"{q2:.4g}", f"{q3:.4g}", f"{statistics.median(c['wall_ms']):.4g}"])


def file_name_of(about):
    machine = re.sub(r"[^a-z0-9.]+", "-", re.sub(r"\(r\)|\(tm\)|intel|amd|cpu|processor|@", " ", about["processor"].lower()))
    limit = about["instruction set"].split()
    return "-".join([about["date"][:10], machine.strip("-"), *(limit if len(limit) == 1 else []), "contest"])


def compact(cells):
    """Keeps only what the tables need, because results are stored for years."""
    kept = []
    for cell in cells:
        contestants = [{key: value for key, value in c.items() if key not in ("cpu_ms", "wall_ms")}
                       | {"frames": len(c["cpu_ms"]), "cpu_ms_quartiles": contest_report.quartiles(c["cpu_ms"]),
                          "wall_ms_quartiles": contest_report.quartiles(c["wall_ms"])} for c in cell["contestants"]]
        kept.append(cell | {"contestants": contestants})
    return kept


def keep(about, cells, judge):
    path = ROOT / "benchmarks/results" / file_name_of(about)
    result = {"about": about, "judgement": judge.rows, "cells": compact(cells)}
    # The name contains dots, so append the extension instead of replacing one.
    path.with_name(path.name + ".json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    path.with_name(path.name + ".md").write_text(markdown_of(about, cells, judge), encoding="utf-8")
    print(f"Kept: {path}.json and .md")


def write_results(arguments, about, cells, judge):
    folder = arguments.output
    result = {"about": about, "judgement": judge.rows, "cells": cells}
    (folder / "results.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    write_csv(folder / "results.csv", cells)
    page = contest_report.html_of(about, cells, judge.rows, growth_points(judge))
    (folder / "results.html").write_text(page, encoding="utf-8")
    print(f"\nWritten: {folder}/results.html, results.json, results.csv")
    if arguments.save:
        keep(about, cells, judge)


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
    if not (arguments.build / "bin/supple_contest").exists():
        sys.exit(f"contest.py: no {arguments.build}/bin/supple_contest; run: make bench")
    missing = subprocess.run([arguments.build / "bin/supple_contest", "--missing"], capture_output=True, text=True,
                             check=True).stdout.split()
    about = description(arguments.build, arguments, missing)
    for name, value in about.items():
        print(f"{name}: {value}")
    print("\nmedian milliseconds of processor time", flush=True)
    arguments.output.mkdir(parents=True, exist_ok=True)
    results, failed, disagree = run_all(arguments, cells)
    judge = judged(results)
    print()
    print_table(table_of(judge))
    write_results(arguments, about, results, judge)
    return 3 if disagree else 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
