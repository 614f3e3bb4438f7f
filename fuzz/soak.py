#!/usr/bin/env python3
"""Runs scenes for many frames with the program soak of a build, and checks that their memory stays flat.

Each run has one of three ways:

    simulate  as `supple simulate` does
    record    also writes a recording; a full file is closed, read and replaced by a new one
    replace   every 100 frames, one object is removed and added again at the same place, one after the other

The program checks each frame (soak.cpp). The first tenth of a run is its warm-up. Memory is flat when the peak of
the second half is at most 1 % above the peak between warm-up and second half, for the heap in use and for the
resident memory; 3 % for recordings, whose rows wait up to a second for a flush. Exits with 1 when a check fails
or memory is not flat.
"""
import argparse
import csv
import datetime
import os
import pathlib
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = ROOT / "scenes"
WAYS = {"simulate": [], "record": ["--record", "run.h5"], "replace": ["--replace-every", "100"]}
MOST_GROWTH = {"simulate": 1, "record": 3, "replace": 1}  # percent
WARM_UP = 0.1  # of the frames
LEAST_ROWS = 10  # with fewer, a part of the run may have none
MOST_ROWS = 20  # of a run in memory.csv
MEGABYTE = 1e6
COLUMNS = ["scene", "way", "commit", "frames", "seconds", "heap_start", "heap_end", "heap_growth", "resident_start", "resident_end",
           "resident_growth", "events", "checked", "replaced", "recordings", "result"]
MEMORY = ["scene", "way", "frame", "heap", "resident", "contacts"]


def run(program, scene, way, arguments):
    """The rows of the program, and why it failed, or an empty text."""
    with tempfile.TemporaryDirectory() as folder:
        command = [program, SCENES / f"{scene}.toml", *WAYS[way], "--frames", arguments.frames, "--seconds", arguments.seconds,
                   "--row-every", arguments.row_every, "--check-every", arguments.check_every]
        done = subprocess.run([str(part) for part in command], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(done.stdout.splitlines())]
    if done.returncode != 0:
        return rows, done.stderr.strip() or f"ended with status {done.returncode}"
    return rows, ""


def growth(rows, name):
    """Growth of the peak in percent: that of the second half above that from the warm-up to the second half."""
    last = rows[-1]["frame"]
    before = max(row[name] for row in rows if WARM_UP * last <= row["frame"] <= last / 2)
    after = max(row[name] for row in rows if row["frame"] >= last / 2)
    return 100 * (after / before - 1) if before > 0 else 0.0


def judge(scene, way, rows, failure, most_growth):
    last = rows[-1] if rows else {}
    summary = dict.fromkeys(COLUMNS, "") | {"scene": scene, "way": way, "commit": output_of("git", "rev-parse", "--short", "HEAD"), "frames": int(last.get("frame", 0)), "seconds": round(last.get("seconds", 0)), "result": failure}
    for name in ("events", "checked", "replaced", "recordings"):
        summary[name] = int(last.get(name, 0))
    if len(rows) < LEAST_ROWS:
        summary["result"] = failure or f"{len(rows)} rows are too few to judge memory: run longer, or give a smaller --row-every"
        return summary
    for name in ("heap", "resident"):
        start = next(row for row in rows if row["frame"] >= WARM_UP * last["frame"])
        summary[f"{name}_start"] = f"{start[name] / MEGABYTE:.2f}"
        summary[f"{name}_end"] = f"{last[name] / MEGABYTE:.2f}"
        summary[f"{name}_growth"] = f"{growth(rows, name):.2f}"
        if growth(rows, name) > most_growth and not summary["result"]:
            summary["result"] = f"{name} grows by {growth(rows, name):.2f} %"
    summary["result"] = summary["result"] or "ok"
    return summary


def output_of(*command):
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def processor():
    model = re.search(r"model name\s*:\s*(.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return model.group(1) if model else os.uname().machine


def default_folder():
    machine = re.sub(r"[^a-z0-9.]+", "-", re.sub(r"\(r\)|\(tm\)|intel|amd|cpu|processor|@", " ", processor().lower())).strip("-")
    return ROOT / "benchmarks" / "results" / f"{datetime.date.today().isoformat()}-{machine}-soak"


def store(folder, summaries, rows_of):
    """Adds runs to a folder of results, in place of earlier ones of the same scenes and ways."""
    folder.mkdir(parents=True, exist_ok=True)
    key = lambda row: (row["scene"], row["way"])
    runs = {key(row): row for row in read_csv(folder / "runs.csv")} | {key(row): row for row in summaries}
    memory = [row for row in read_csv(folder / "memory.csv") if key(row) not in rows_of]
    for (scene, way), rows in rows_of.items():
        every = -(-len(rows) // MOST_ROWS)
        memory += [{"scene": scene, "way": way} | {name: f"{row[name]:.10g}" for name in MEMORY[2:]}
                   for i, row in enumerate(rows) if i % every == 0 or i + 1 == len(rows)]
    write_csv(folder / "runs.csv", COLUMNS, sorted(runs.values(), key=key))
    write_csv(folder / "memory.csv", MEMORY, sorted(memory, key=key))


def read_csv(path):
    if not path.exists():
        return []
    return list(csv.DictReader(line for line in path.read_text().splitlines() if not line.startswith("#")))


def write_csv(path, columns, rows):
    with path.open("w", newline="") as file:
        file.writelines(f"# {name}: {value}\n" for name, value in (
            ("date", datetime.date.today().isoformat()), ("commit", "of each run in runs.csv"),
            ("machine", f"{processor()}, {os.cpu_count()} cores"), ("compiler", output_of("c++", "--version").split("\n")[0]),
            ("command", " ".join(["fuzz/soak.py", *sys.argv[1:]]))))
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    known = sorted(path.stem for path in SCENES.glob("*.toml"))
    parser.add_argument("--scenes", nargs="+", choices=known, default=known, metavar="SCENE", help="names in scenes/ (default: all)")
    parser.add_argument("--ways", nargs="+", choices=WAYS, default=list(WAYS), metavar="WAY", help="simulate, record, replace (default: all)")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release", help="build folder (default: build/release)")
    parser.add_argument("--frames", type=int, default=10**6, help="of each run (default: 1000000)")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="end each run after this time (default: after its frames)")
    parser.add_argument("--row-every", type=int, default=100, help="frames between measurements of memory (default: 100)")
    parser.add_argument("--check-every", type=int, default=10**4,
                        help="frames between checks of all invariants and by brute force (default: 10000)")
    parser.add_argument("--most-growth", type=float, help="of memory, in percent (default: 1, for recordings 3)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="runs at the same time (default: one per core)")
    parser.add_argument("--record", nargs="?", type=pathlib.Path, const=default_folder(), metavar="FOLDER",
                        help="store tables in this folder (default: benchmarks/results/DATE-MACHINE-soak)")
    arguments = parser.parse_args()
    program = arguments.build.resolve() / "bin" / "soak"
    if not program.exists():
        sys.exit(f"fuzz/soak.py: {program} does not exist; build it: cmake --build {arguments.build} --target fuzz_soak")

    summaries, rows_of = [], {}
    runs = [(scene, way) for scene in arguments.scenes for way in arguments.ways]
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for (scene, way), (rows, failure) in zip(runs, pool.map(lambda run_of: run(program, *run_of, arguments), runs)):
            summary = judge(scene, way, rows, failure, arguments.most_growth or MOST_GROWTH[way])
            summaries.append(summary)
            if rows:
                rows_of[scene, way] = rows
            print(f"{scene:18} {way:9} {summary['frames']:10,} frames {summary['seconds']:6} s  heap {summary['heap_end']:>7} MB "
                  f"{summary['heap_growth']:>6} %  resident {summary['resident_end']:>7} MB {summary['resident_growth']:>6} %  "
                  f"{summary['result']}", flush=True)
    if arguments.record:
        store(arguments.record.resolve(), summaries, rows_of)
    sys.exit(0 if all(summary["result"] == "ok" for summary in summaries) else 1)


if __name__ == "__main__":
    main()
