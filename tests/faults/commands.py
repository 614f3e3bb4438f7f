"""Commands of the program on small inputs, and what must hold after each of them."""

import dataclasses
import json
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from program import FLOOR, PROGRAM, SPIKE, obj  # noqa: E402

# An octahedron.
BALL = (
    [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0)],
    [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1), (5, 2, 1), (5, 3, 2), (5, 4, 3), (5, 1, 4)],
)
SCENE = """[scene]
time_step = 0.02
[[object]]
name = "waves"
mesh = "ball.obj"
motion = { kind = "wave", velocity = [0.5, 0, 0], amplitude = 0.04, period = 1.1, seed = 1 }
[[object]]
name = "springs"
mesh = "ball.obj"
translate = [0.7, 0.1, 0]
motion = { kind = "mass_spring", velocity = [-1, 0, 0] }
"""
QUERY = "1,1,1,1,1,1\n0,1,0,1,0,1\n4,1,0,1,0,1\n0,1,4,1,0,1\n1,1,1,1,-1,1\n0,1,0,1,0,1\n4,1,0,1,0,1\n0,1,4,1,0,1\n"
FRAMES = 4


@dataclasses.dataclass
class Command:
    name: str
    arguments: list
    outputs: tuple = ()
    has_threads: bool = True

    def line(self, threads="1"):
        return [PROGRAM, *self.arguments, *(["--threads", threads] if self.has_threads and threads else [])]


COMMANDS = [
    Command("detect", ["detect", "ball.obj", "floor.obj", "--json", "out.json", "--csv", "out.csv"], ("out.json", "out.csv")),
    Command("simulate", ["simulate", "scene.toml", "--frames", str(FRAMES), "--record", "out.h5"], ("out.h5", "out.xdmf")),
    Command("view", ["view", "run.h5", "--export", "out.html"], ("out.html",), False),
    Command("query", ["query", "closest", "points.txt", "ball.obj", "--json", "out.json"], ("out.json",)),
    Command("ccd-queries", ["ccd-queries", "vf.csv", "--json", "out.json"], ("out.json",), False),
    Command("info", ["info", "run.h5"], (), False),
    Command("diff", ["diff", "run.h5", "scene.h5"], (), False),
]


def write_inputs(folder):
    """Writes what the commands read. `run.h5` and `scene.h5` are two different recordings."""
    for name, mesh in (("ball", BALL), ("floor", FLOOR), ("spike", SPIKE)):
        (folder / f"{name}.obj").write_text(obj(*mesh))
    (folder / "scene.toml").write_text(SCENE)
    (folder / "points.txt").write_text("0 0 0\n1 1 1\n0.3 0.2 0.1\n")
    (folder / "vf.csv").write_text(QUERY)
    for name, frames in (("run", 3), ("scene", 2)):
        line = [PROGRAM, "simulate", "scene.toml", "--frames", str(frames), "--record", f"{name}.h5", "--quiet"]
        subprocess.run(line, cwd=folder, check=True)
        (folder / f"{name}.xdmf").unlink()


def without_times(value):
    """JSON without measured times, which must be finite and not negative."""
    if isinstance(value, list):
        return [without_times(item) for item in value]
    if not isinstance(value, dict):
        return value
    for key, number in value.items():
        if "seconds" in key and not (isinstance(number, (int, float)) and 0 <= number < float("inf")):
            raise ValueError(f"{key} is {number}")
    return {key: without_times(item) for key, item in value.items() if "seconds" not in key}


def frames_of(recording):
    """The number of whole frames, or None when the program cannot open the recording."""
    done = subprocess.run([PROGRAM, "info", recording], capture_output=True, text=True)
    frames = re.search(r"(\d+) frames?", done.stdout)
    return int(frames[1]) if done.returncode == 0 and frames else None


def content_of(path):
    """What two successful runs have in common."""
    match path.suffix:
        case ".json":
            return without_times(json.loads(path.read_text()))
        case ".h5":
            return frames_of(path)
        case ".csv":
            # The columns of times differ.
            header, *rows = [line.split(",") for line in path.read_text().splitlines()]
            return [[cell for name, cell in zip(header, row, strict=True) if "seconds" not in name] for row in rows]
        case ".txt":
            # The words of each line; times are numbers.
            text = re.sub(r"[-+.,\d]+( [mµn]?s\b|e[-+]\d+)*", "#", path.read_text())
            return [line.split() for line in text.splitlines()]
        case _:
            return path.read_bytes()


def contents(command, folder):
    return {name: content_of(folder / name) for name in (*command.outputs, "stdout.txt") if (folder / name).exists()}
