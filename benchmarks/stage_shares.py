#!/usr/bin/env python3
"""Measures the stages of `supple detect`: medians over several runs, as a Markdown table.

usage: stage_shares.py [--supple PROGRAM] [--runs N] NAME ARGUMENT... [-- NAME ARGUMENT...]...

Each group is a name and the arguments of `supple detect`, for example

    stage_shares.py cloth-ball --self --threads 1 cloth_ball92.ply -- bunnies --threads 1 two_bunnies.toml

Each run is a separate process, so this measures the first step with cold memory. The times exclude
building the octrees and include the growth of buffers.
"""

import json
import os
import platform
import statistics
import subprocess
import sys
import time

STAGES = ["refit", "broad_phase", "traversal", "exact", "finish"]
CANDIDATES = ["candidate_pairs", "vertex_face_candidates", "edge_edge_candidates"]


def run(program, arguments):
    """Milliseconds of the last frame and of the whole process, its peak memory, and the statistics of the frame."""
    start = time.perf_counter()
    process = subprocess.Popen([program, "detect", *arguments, "--json", "-", "--quiet"], stdout=subprocess.PIPE)
    text = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    whole = 1e3 * (time.perf_counter() - start)
    if status != 0:
        sys.exit(f"supple detect {' '.join(arguments)} failed")
    stats = json.loads(text)["frames"][-1]["stats"]
    figures = {stage: 1e3 * stats[stage + "_seconds"] for stage in STAGES}
    figures["detect"] = 1e3 * stats["total_seconds"]
    figures["process"] = whole
    figures["megabytes"] = usage.ru_maxrss / 1024
    return figures, stats


def groups_of(words):
    group = []
    for word in words + ["--"]:
        if word != "--":
            group.append(word)
        elif group:
            yield group[0], group[1:]
            group = []


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as lines:
        return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), "unknown")


def main():
    program, runs, words = "build/release/bin/supple", 9, sys.argv[1:]
    while words and words[0] in ("--supple", "--runs"):
        if words[0] == "--supple":
            program = words[1]
        else:
            runs = int(words[1])
        words = words[2:]
    if not words or words[0] in ("-h", "--help"):
        sys.exit(__doc__)
    print(f"{processor()}, {platform.system()} {platform.machine()}, median of {runs} runs, milliseconds "
          "(share of detect)\n")
    print("| workload | " + " | ".join(STAGES) + " | detect | whole process | peak MB | candidates | contacts |")
    print("|---|" + "---|" * (len(STAGES) + 5))
    for name, arguments in groups_of(words):
        results = [run(program, arguments) for _ in range(runs)]
        median = {key: statistics.median(result[0][key] for result in results) for key in results[0][0]}
        stats = results[-1][1]
        candidates = sum(stats[kind] for kind in CANDIDATES)
        cells = [f"{median[stage]:.2f} ({100 * median[stage] / median['detect']:.0f} %)" for stage in STAGES]
        print(f"| {name} | " + " | ".join(cells) + f" | {median['detect']:.1f} | {median['process']:.0f} "
              f"| {median['megabytes']:.0f} | {candidates:,} | {stats['contacts']:,} |")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
