#!/usr/bin/env python3
"""Runs the fuzz targets of a build, each for some seconds on its corpus, and prints how many inputs they ran.

The preset fuzz uses libFuzzer; every other build runs random inputs and changed inputs of the corpora at its own
speed. With --rounds, a machine of any speed runs the same inputs. Exits with 1 when a target fails; the input that
made it fail is then in build/fuzz/failures.
"""
import argparse
import csv
import datetime
import os
import pathlib
import re
import subprocess
import sys
import tarfile
import tempfile
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
FUZZ = ROOT / "fuzz"
LOG = FUZZ / "results.csv"
COLUMNS = ["date", "commit", "machine", "build", "target", "seconds", "executions"]
GOALS = {"Loaders, parsers and commands": (10**9, ["obj", "off", "ply", "stl", "assimp", "volumes", "queries", "scene", "recording", "session", "packed"]),
         "Pairs of triangles and impacts": (10**9, ["triangles", "impacts"]),
         "Lives of scenes and broad phases": (10**8, ["scene_lives", "broad_phases"])}
# About what takes a second with sanitizers.
INPUTS_OF_A_ROUND = {"assimp": 100, "broad_phases": 400, "depths": 25, "impacts": 40, "recording": 70, "scene_lives": 8, "triangles": 1600}
INPUTS_OF_A_ROUND_OF_OTHERS = 2000


def cached(build, name):
    found = re.search(rf"^{name}:\w+=(.*)$", (build / "CMakeCache.txt").read_text(), re.M)
    return found.group(1) if found else ""


def uses_libfuzzer(build):
    return cached(build, "SUPPLE_LIBFUZZER") == "ON"


def programs_of(build, names):
    found = {path.name[len("fuzz_"):]: path for path in sorted((build / "bin").glob("fuzz_*"))}
    for name in names:
        if name not in found:
            sys.exit(f"fuzz/run.py: {build} has no target '{name}'; it has: {', '.join(found) or 'none, so build it first'}")
    if not found:
        sys.exit(f"fuzz/run.py: {build}/bin has no fuzz targets; build it first")
    return {name: found[name] for name in (names or found)}


def kept_inputs(name, build):
    return [path for path in (build / "fuzz" / "corpora" / name, FUZZ / "regressions" / name) if path.is_dir()]


def command_of(name, program, build, seconds, rounds, seed):
    if not uses_libfuzzer(build):
        amount = rounds * INPUTS_OF_A_ROUND.get(name, INPUTS_OF_A_ROUND_OF_OTHERS) if rounds else f"{seconds}s"
        return [program, "--random", amount, seed, *kept_inputs(name, build)]
    grown = build / "fuzz" / "grown" / name
    grown.mkdir(parents=True, exist_ok=True)
    command = [program, grown, *kept_inputs(name, build), f"-max_total_time={seconds}", f"-seed={seed}", "-timeout=300",
               "-rss_limit_mb=3000", "-print_final_stats=1", "-artifact_prefix=./"]
    dictionary = FUZZ / "dictionaries" / f"{name}.dict"
    return command + ([f"-dict={dictionary}"] if dictionary.exists() else [])


def run(name, program, build, seconds, rounds, seed):
    failures = build / "fuzz" / "failures" / name
    failures.mkdir(parents=True, exist_ok=True)
    done = subprocess.run([str(part) for part in command_of(name, program, build, seconds, rounds, seed)], cwd=failures,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    counted = re.search(r"number_of_executed_units: (\d+)|^(\d+) executions$", done.stdout, re.M)
    executions = int(counted.group(1) or counted.group(2)) if counted else 0
    return name, done.returncode, executions, done.stdout


def keep(name, program, build):
    """Writes the smallest set of inputs that reaches all that the corpus reaches."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "-merge=1", "-timeout=300", folder, build / "fuzz" / "grown" / name, *kept_inputs(name, build)], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        (FUZZ / "corpora").mkdir(exist_ok=True)

        def plain(info):
            info.mtime = info.uid = info.gid = 0
            info.uname = info.gname = ""
            return info

        with tarfile.open(FUZZ / "corpora" / f"{name}.tar.xz", "w:xz") as archive:
            for path in sorted(pathlib.Path(folder).iterdir()):
                archive.add(path, arcname=path.name, filter=plain)


def output_of(*command):
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def machine():
    model = re.search(r"model name\s*:\s*(.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return f"{model.group(1) if model else os.uname().machine}, {os.cpu_count()} cores"


def record(build, seconds, counts):
    rows = list(csv.DictReader(LOG.open())) if LOG.exists() else []
    today = datetime.date.today().isoformat()
    commit = output_of("git", "rev-parse", "--short", "HEAD")
    rows += [dict(zip(COLUMNS, [today, commit, machine(), build.name, name, seconds, executions])) for name, executions in counts.items()]
    with LOG.open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    write_page(rows)


def write_page(rows):
    total = {}
    for row in rows:
        name = "sanitizers" if row["build"] in ("asan", "fuzz") else "release speed"
        total.setdefault(row["target"], {"sanitizers": 0, "release speed": 0})[name] += int(row["executions"])
    lines = ["# Fuzzing: how much ran", "",
             "`fuzz/run.py --record` adds each run to `results.csv` and writes this page from it. An execution is one input:",
             "one file, one list of commands, one pair of triangles or elements, or the life of a scene. No recorded run",
             "found a fault that is still there.", "", "| Target | Executions with sanitizers | Executions at release speed |", "|---|---|---|"]
    lines += [f"| `{name}` | {of['sanitizers']:,} | {of['release speed']:,} |" for name, of in sorted(total.items())]
    lines += ["", "| Targets | Executions | Goal |", "|---|---|---|"]
    for what, (goal, names) in GOALS.items():
        lines.append(f"| {what} | {sum(sum(total[n].values()) for n in names if n in total):,} | {goal:,} |")
    lines += ["", "| Date | Commit | Machine | Build | Targets | Seconds for each | Executions |", "|---|---|---|---|---|---|---|"]
    runs = {}
    for row in rows:
        runs.setdefault((row["date"], row["commit"], row["machine"], row["build"], row["seconds"]), []).append(row)
    for key, of_run in runs.items():
        date, commit, on, build, seconds = key
        lines.append(f"| {date} | {commit} | {on} | {build} | {len(of_run)} | {seconds} | {sum(int(r['executions']) for r in of_run):,} |")
    (FUZZ / "results.md").write_text("\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("targets", nargs="*", help="names of targets; default: all")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "fuzz", help="build folder (default: build/fuzz)")
    parser.add_argument("--seconds", type=int, default=30, help="time for each target (default: 30)")
    parser.add_argument("--rounds", type=int, default=0, help="fixed numbers of inputs instead of a time, about what a second allows with sanitizers; not with libFuzzer")
    parser.add_argument("--seed", type=int, default=0, help="of the random numbers; the same seed gives the same inputs (default: any)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="targets at the same time (default: one per core)")
    parser.add_argument("--keep", action="store_true", help="minimise the grown corpora and write them to fuzz/corpora")
    parser.add_argument("--record", action="store_true", help="add the run to fuzz/results.csv and fuzz/results.md")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    if not (build / "CMakeCache.txt").exists():
        sys.exit(f"fuzz/run.py: {build} is no build folder; run: cmake --preset fuzz && cmake --build --preset fuzz")
    if arguments.rounds < 0 or (arguments.rounds and (uses_libfuzzer(build) or arguments.record)):
        parser.error("--rounds needs a number above 0 and a build without libFuzzer, and is not recorded")
    programs = programs_of(build, arguments.targets)

    counts, failed = {}, []
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for name, status, executions, output in pool.map(lambda item: run(*item, build, arguments.seconds, arguments.rounds, arguments.seed), programs.items()):
            counts[name] = executions
            print(f"{name:14} {executions:12,} executions  {'ok' if status == 0 else 'FAILED'}", flush=True)
            if status != 0:
                failed.append(name)
                print("\n".join(output.splitlines()[-60:]))
                print(f"The input is in {build / 'fuzz' / 'failures' / name}. Keep it in fuzz/regressions/{name} when the fault is fixed.")
    if arguments.keep and uses_libfuzzer(build):
        for name, program in programs.items():
            keep(name, program, build)
    if arguments.record:
        record(build, arguments.seconds, counts)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
