#!/usr/bin/env python3
"""Compares the longest safe step of Supple with that of the IPC Toolkit (Python package ipctk, with NumPy).

usage: ipc_toolkit.py [--build DIR] [--rounds N] CLOTH...

CLOTH is cloth-ball or cloth-funnel (SUPPLE_DATA names the folder of the meshes). Both libraries run on one thread, in
turn. The IPC Toolkit uses its defaults: the LBVH broad phase and additive CCD, which keeps a tenth of each distance
("conservative rescaling" by 0.9). Supple's collision_free_step keeps a tenth, too; max_step goes on until the first
contact. Prints one row per cloth.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import time

import ipctk
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
STEPS = {"cloth-ball": ("cloth_ball92.ply", "cloth_ball93.ply"), "cloth-funnel": ("227.ply", "228.ply")}


def read_ply(path):
    """Positions and triangles of a binary PLY file of triangles whose vertices begin with their coordinates."""
    data = path.read_bytes()
    header, body = data.split(b"end_header\n", 1)
    sizes = {"float": 4, "float32": 4, "double": 8, "uchar": 1, "uint8": 1, "int": 4, "int32": 4, "uint": 4, "uint32": 4}
    order = ">" if b"big_endian" in header else "<"
    kind = "f8" if b"property double x" in header else "f4"
    counts, stride, element = {}, 0, ""
    for line in header.decode().splitlines():
        words = line.split()
        if words[0] == "element":
            element, counts[words[1]] = words[1], int(words[2])
        elif words[0] == "property" and element == "vertex":
            stride += sizes[words[1]]
    vertices = np.ndarray((counts["vertex"], 3), order + kind, body, 0,
                          (stride, int(kind[1]))).astype(float)
    faces = np.frombuffer(body, np.dtype([("n", "u1"), ("v", f"{order}i4", 3)]), counts["face"], stride * counts["vertex"])
    assert (faces["n"] == 3).all(), path
    return vertices, faces["v"].copy()


def toolkit_step(mesh, start, end):
    """The safe step and its processor time in milliseconds."""
    begin = time.process_time()
    candidates = ipctk.Candidates()
    candidates.build(mesh, start, end, 0, ipctk.LBVH())
    step = candidates.compute_collision_free_stepsize(mesh, start, end, 0, ipctk.AdditiveCCD())
    return step, 1e3 * (time.process_time() - begin)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--rounds", default=5, type=int)
    parser.add_argument("cloth", nargs="+", choices=STEPS)
    arguments = parser.parse_args()
    ipctk.set_num_threads(1)
    ipctk.set_logger_level(ipctk.LoggerLevel.error)
    data = pathlib.Path(os.environ.get("SUPPLE_DATA", ROOT.parent / "shared/data")) / "scalable-ccd"
    print(f"| cloth | max_step | ms | collision_free_step, keep 0.1 | ms | IPC Toolkit {ipctk.__version__}: step | ms | ratios |")
    print("|---|---|---|---|---|---|---|---|")
    for cloth in arguments.cloth:
        (start, triangles), (end, _) = (read_ply(data / cloth / "frames" / name) for name in STEPS[cloth])
        mesh = ipctk.CollisionMesh(start, ipctk.edges(triangles), triangles)
        ours, theirs = [], []
        for _ in range(arguments.rounds):
            command = [arguments.build / "bin/supple_contest", "--rounds", "5", f"step/{cloth}"]
            ours.append(json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["values"])
            theirs.append(toolkit_step(mesh, start, end))
        longest, keeping = (statistics.median(value[name] for value in ours)
                            for name in ("milliseconds", "milliseconds of collision_free_step"))
        their_time = statistics.median(milliseconds for _, milliseconds in theirs)
        print(f"| {cloth} | {ours[0]['safe step']:.4g} | {longest:.3g} "
              f"| {ours[0]['safe step that keeps a share of distances']:.4g} | {keeping:.3g} "
              f"| {theirs[0][0]:.4g} | {their_time:.4g} | {their_time / longest:.3g}, {their_time / keeping:.3g} |")


if __name__ == "__main__":
    main()
