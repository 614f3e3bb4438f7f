#!/usr/bin/env python3
"""Repeats the paper: runs all experiments, draws its figures and its table from them, and writes one page.

usage: paper.py [--quick] [--program PROGRAM] [--output FOLDER]

Runs `supple experiment NAME --output FOLDER/NAME` for each experiment that has no page there yet; what is
interrupted goes on, where the experiment can. Then writes FOLDER/paper.html, which needs no other file, and
figures 3 and 5 as videos, FOLDER/figure3.webp and FOLDER/figure5.webp, and says whether the counts are those of
the committed tables. --quick runs the quick versions. Needs matplotlib and scipy, which Debian has as
python3-matplotlib and python3-scipy.
"""

import argparse
import base64
import io
import pathlib
import subprocess
import sys

from judge.pages import COLORS, escaped, page, table, try_debians_python

try:
    import numpy as np

    from judge import report, verdicts
    from judge.tables import Tables
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
    from PIL import Image
except ImportError:
    try_debians_python()
    raise

EXPERIMENTS = ("figures", "table1", "scaling", "arity", "volumes", "claims", "ablation", "trials", "sensitivity")
COMMITTED = pathlib.Path(__file__).resolve().parent.parent / "benchmarks/results/paper"
MEASURED = ("ablation_widths", "figures_1")  # have no counts, or name what the processor has
LIGHT = np.array([0.4, -0.6, 0.7]) / np.linalg.norm([0.4, -0.6, 0.7])
STYLE = "img { max-width: 100%; height: auto; background: #fff; } .figures img { width: 48%; }"


def run_experiments(program, output, quick):
    for name in EXPERIMENTS:
        folder = output / name
        if (folder / f"{name}.html").exists():
            print(f"{folder}: complete; remove it to run the experiment again", file=sys.stderr)
            continue
        command = [program, "experiment", name, "--output", str(folder)]
        command += ["--quick"] if quick else []
        command += ["--resume"] if name in ("table1", "sensitivity") and folder.exists() else []
        print(" ".join(command), file=sys.stderr)
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def compare_counts(output):
    """Says which tables have other counts than those that are committed; counts do not depend on the machine."""
    committed, ours = (Tables(*(path for path in sorted(folder.iterdir()) if path.is_dir())) for folder in (COMMITTED, output))

    def counts(tables, name):
        return {str({column: value for column, value in row.items() if "seconds" not in column}) for row in tables.rows(name)}

    names = [name for name in committed.paths if name in ours and not name.endswith(("_claims", "_options")) and name not in MEASURED]
    differing = [name for name in names if counts(committed, name) != counts(ours, name)]
    print(f"Counts: {len(names) - len(differing)} of {len(names)} tables equal those in {COMMITTED.name}" + (f"; others: {', '.join(differing)}" if differing else ""),
          file=sys.stderr)


# --- figures 3 and 5 ---


class Frames:
    """The data of `supple experiment figures`, by frame."""

    def __init__(self, folder):
        tables = Tables(folder)
        parameters = tables.head("figures_1")
        self.middle = int(parameters["middle"])
        self.pair = [int(index) for index in parameters["objects"].split()]
        self.half = float(parameters["cube"]) / 2
        self.faces, self.object_of_face, vertices, current = [], [], 0, -1
        for line in (folder / "figures.obj").read_text().splitlines():
            kind, *rest = line.split()
            if kind == "o":
                current += 1
            elif kind == "v":
                vertices += 1
            elif kind == "f":
                self.faces.append([int(index) - 1 for index in rest])
                self.object_of_face.append(current)
        self.faces, self.object_of_face = np.array(self.faces), np.array(self.object_of_face)
        self.positions = np.fromfile(folder / "figures_positions.f32", np.float32).reshape(-1, vertices, 3)
        self.regions = self.by_frame(tables.rows("figures_regions"))
        self.spheres = self.by_frame(tables.rows("figures_spheres"))
        self.boxes = self.by_frame(tables.rows("figures_boxes"))

    def by_frame(self, rows):
        result = {}
        for row in rows:
            result.setdefault(int(row["frame"]), []).append(row)
        return result


def box_edges(low, high):
    low, high = np.array(low), np.array(high)
    corners = [np.where([i & 1, i & 2, i & 4], high, low) for i in range(8)]
    return [(corners[i], corners[i | bit]) for i in range(8) for bit in (1, 2, 4) if not i & bit]


def circles(center, radius):
    """Three great circles of a sphere."""
    angle = np.linspace(0, 2 * np.pi, 49)
    zero = 0 * angle
    for x, y, z in ((np.cos(angle), np.sin(angle), zero), (np.cos(angle), zero, np.sin(angle)), (zero, np.cos(angle), np.sin(angle))):
        yield np.array(center) + radius * np.stack([x, y, z], 1)


def new_view(elevation, azimuth):
    figure = Figure(figsize=(6.4, 5.6))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1), projection="3d", elev=elevation, azim=azimuth, computed_zorder=True)
    axes.set_axis_off()
    return figure, axes


def add_objects(axes, frames, frame, objects, alpha=1.0):
    chosen = np.isin(frames.object_of_face, objects)
    corners = frames.positions[frame][frames.faces[chosen]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    brightness = 0.62 + 0.38 * (normals @ LIGHT)
    colors = np.array([[int(COLORS[i % len(COLORS)][k : k + 2], 16) / 255 for k in (1, 3, 5)]
                       for i in frames.object_of_face[chosen]])
    colors = np.concatenate([np.clip(colors * brightness[:, None], 0, 1), np.full((len(colors), 1), alpha)], 1)
    axes.add_collection3d(Poly3DCollection(corners, facecolors=colors, linewidths=0))


def set_limits(axes, low, high):
    for set_limit, a, b in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), low, high):
        set_limit(a, b)
    axes.set_box_aspect(np.array(high) - np.array(low), zoom=1.1)


def figure3(frames, frame):
    """The scene octree with spheres."""
    figure, axes = new_view(24, -62)
    add_objects(axes, frames, frame, range(9))
    for region in frames.regions[frame]:
        if not region["leaf"]:
            continue
        low = np.array([region["x"], region["y"], region["z"]])
        count = region["objects"]
        color, width = ("#cc3311", 1.1) if count > 1 else ("#33bbee", 0.8) if count else ("#cccccc", 0.4)
        axes.add_collection3d(Line3DCollection(box_edges(low, low + region["edge"]), colors=color, linewidths=width))
    for sphere in frames.spheres[frame]:
        axes.add_collection3d(Line3DCollection(list(circles([sphere[k] for k in "xyz"], sphere["radius"])),
                                               colors="#555555", linewidths=0.6))
    set_limits(axes, [-frames.half] * 3, [frames.half] * 3)
    return figure


def figure5(frames, frame):
    """The boxes of the colliding leaves of two objects."""
    figure, axes = new_view(18, -50)
    add_objects(axes, frames, frame, frames.pair, alpha=0.45)
    for box in frames.boxes.get(frame, []):
        color = COLORS[int(box["object"]) % len(COLORS)]
        axes.add_collection3d(Line3DCollection(box_edges([box[k + "0"] for k in "xyz"], [box[k + "1"] for k in "xyz"]),
                                               colors=color, linewidths=0.8))
    vertices = frames.positions[frames.middle][np.unique(frames.faces[np.isin(frames.object_of_face, frames.pair)])]
    middle, half = (vertices.min(0) + vertices.max(0)) / 2, (vertices.max(0) - vertices.min(0)).max() / 2
    set_limits(axes, middle - half, middle + half)
    return figure


def image_of(figure, dpi):
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dpi)
    return Image.open(buffer).convert("RGB")


def write_videos(output):
    frames = Frames(output / "figures")
    for name, draw in (("figure3", figure3), ("figure5", figure5)):
        images = [image_of(draw(frames, frame), 75) for frame in range(len(frames.positions))]
        images[0].save(output / f"{name}.webp", save_all=True, append_images=images[1:], duration=60, loop=0, quality=60, method=4)
        image_of(draw(frames, frames.middle), 110).save(output / f"{name}.png", optimize=True)


# --- the page ---


def picture(path, text):
    data = base64.b64encode(path.read_bytes()).decode()
    return f'<img alt="{escaped(text)}" src="data:image/{path.suffix[1:]};base64,{data}"/>'


def page_of(output):
    tables = Tables(*(output / name for name in EXPERIMENTS))
    head = tables.head("figures_1")
    parts = [f"<p>All figures, the table and the claims of <em>Collision Detection for Deformable Objects using Octrees</em> "
             f"(2007), from our own data. The figures show the collision of {escaped(head['collision'])}.</p>",
             "<h2>Figure 1</h2>", *report.modules_plots(tables), "<h2>Figure 2</h2>", *report.regions_plots(tables),
             "<h2>Figure 3: the octree in the broad phase with spheres</h2>",
             "<p>Red regions have two objects or more, blue ones have one.</p>",
             f'<div class="figures">{picture(output / "figure3.png", "regions of the scene octree and spheres")}'
             f'{picture(output / "figure3.webp", "the same as a video")}</div>',
             "<h2>Figure 4</h2>", *report.descent_plots(tables), table(*report.summary(tables, "figures_4")),
             "<h2>Figure 5: a collision in the narrow phase with boxes</h2>",
             "<p>The boxes of the leaves that collide, of both objects.</p>",
             f'<div class="figures">{picture(output / "figure5.png", "boxes of the colliding leaves of two objects")}'
             f'{picture(output / "figure5.webp", "the same as a video")}</div>',
             "<h2>Table 1: collisions in ten minutes, by three clocks, and in the paper</h2>",
             *report.table1_plots(tables), *(table(*listing(tables)) for listing in (report.rates, report.ratios, report.averages)),
             "<h2>From 2007 to today</h2>", *report.ablation_plots(tables),
             "<h2>Settings that the paper does not state</h2>", *report.sensitivity_plots(tables), "<h2>What holds</h2>"]
    parts += map(report.html_of_claim, verdicts.judged(tables))
    parts += ["<h2>Where it comes from</h2>",
              f"<p>Commit {escaped(head['commit'])}, {escaped(head['processor'])}. "
              "Each folder beside this page has the tables and the page of one experiment.</p>"]
    return page("The paper, repeated" + (" (quick version)" if "--quick" in head["command"] else ""), parts, STYLE)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="the quick version of each experiment")
    parser.add_argument("--program", default="supple", help="the program (default: supple, in PATH)")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("paper"), help="the folder (default: paper)")
    arguments = parser.parse_args()
    run_experiments(arguments.program, arguments.output, arguments.quick)
    if not arguments.quick and COMMITTED.exists():
        compare_counts(arguments.output)
    write_videos(arguments.output)
    path = arguments.output / "paper.html"
    path.write_text(page_of(arguments.output), encoding="utf-8")
    print(f"Written: {path}")


if __name__ == "__main__":
    main()
