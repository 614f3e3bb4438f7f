#!/usr/bin/env python3
"""Measures the stages of `supple simulate` on scene files: means over the frames, as a Markdown table.

usage: scene_steps.py [--supple PROGRAM] [--steps N] [--threads N] [SCENE.toml...]

Motion is everything except detection: forces, integration and, if the scene enables it, contact response. Without
arguments it measures all scenes in scenes/.
"""

import argparse
import json
import pathlib
import platform
import subprocess
import sys

from stage_shares import STAGES, processor


def simulate(program, scene, steps, threads):
    """Mean milliseconds of each stage by name, and a description of the scene."""
    command = [program, "simulate", str(scene), "--steps", str(steps), "--threads", str(threads), "--json", "-", "--quiet"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE)
    document = json.load(process.stdout)
    if process.wait() != 0:
        sys.exit(f"{' '.join(command)} failed")
    moved = document["frames"][1:]
    names = ["motion", *STAGES, "total"]
    figures = {name: 1e3 * sum(f["stats"][name + "_seconds"] for f in moved) / len(moved) for name in names}
    figures["vertices"] = sum(o["vertices"] for o in document["objects"])
    figures["objects"] = len(document["objects"])
    figures["contacts"] = sum(f["stats"]["contacts"] for f in moved) / len(moved)
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--supple", default="build/release/bin/supple")
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    scenes = options.scenes or sorted((pathlib.Path(__file__).resolve().parent.parent / "scenes").glob("*.toml"))
    print(f"{processor()}, {platform.system()} {platform.machine()}, means over {options.steps} steps, milliseconds "
          "(share of motion and detection)\n")
    columns = ["scene", "objects", "vertices", "motion", *STAGES, "steps/s", "contacts"]
    print(f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}")
    for scene in scenes:
        f = simulate(options.supple, scene, options.steps, options.threads)
        whole = f["motion"] + f["total"]
        cells = [f"{f[name]:.2f} ({100 * f[name] / whole:.0f} %)" for name in ["motion", *STAGES]]
        print(f"| {scene.stem} | {f['objects']} | {f['vertices']:,} | " + " | ".join(cells)
              + f" | {1e3 / whole:.0f} | {f['contacts']:.0f} |", flush=True)


if __name__ == "__main__":
    main()
