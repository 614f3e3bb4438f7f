#!/usr/bin/env python3
"""Repeats the paper: runs all experiments, draws its figures and its table from them, and writes one page.

usage: paper.py [--quick] [--program PROGRAM] [--output FOLDER]

Runs `supple experiment NAME --output FOLDER/NAME` for each experiment that has no page there yet; what is
interrupted goes on, where the experiment can. Then writes FOLDER/paper.html, which needs no other file, and
figures 3 and 5 as videos, FOLDER/figure3.webp and FOLDER/figure5.webp, and says whether the counts are those of
the committed tables. --quick runs the quick versions. Needs matplotlib and scipy, which Debian has as
python3-matplotlib and python3-scipy, and a Chromium for `supple render`.
"""

import argparse
import base64
import json
import pathlib
import subprocess
import sys
import tempfile

from judge.pages import escaped, page, table, try_debians_python

try:
    import matplotlib  # noqa: F401

    from judge import report, verdicts
    from judge.tables import Tables
    from PIL import Image
except ImportError:
    try_debians_python()
    raise

EXPERIMENTS = ("figures", "table1", "scaling", "arity", "volumes", "claims", "ablation", "trials", "sensitivity")
ROOT = pathlib.Path(__file__).resolve().parent.parent
COMMITTED = ROOT / "benchmarks/results/paper"
MEASURED = ("ablation_widths", "figures_1")  # have no counts, or name what the processor has
STYLE = "img { max-width: 100%; height: auto; background: #fff; } .figures img { width: 48%; }"


def run_experiments(names, arguments):
    for name in names:
        folder = arguments.output / name
        if (folder / f"{name}.html").exists():
            print(f"{folder}: complete; remove it to run the experiment again", file=sys.stderr)
            continue
        command = [arguments.program, "experiment", name, "--output", str(folder)]
        command += ["--quick"] if arguments.quick else []
        command += ["--resume"] if name in ("table1", "sensitivity") and folder.exists() else []
        print(" ".join(command), file=sys.stderr)
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def compare_counts(output):
    """Says which tables have other counts than those that are committed; counts do not depend on the machine."""
    committed, ours = (Tables(*(path for path in sorted(folder.iterdir()) if path.is_dir())) for folder in (COMMITTED, output))

    def counts(tables, name):
        return {str({column: value for column, value in row.items() if "seconds" not in column}) for row in tables.rows(name)}

    names = [name for name in committed.paths if name in ours and not name.endswith("_claims") and name not in MEASURED]
    differing = [name for name in names if counts(committed, name) != counts(ours, name)]
    print(f"Counts: {len(names) - len(differing)} of {len(names)} tables equal those in {COMMITTED.name}" + (f"; others: {', '.join(differing)}" if differing else ""),
          file=sys.stderr)


# --- figures 3 and 5 ---


def draw(program, output, head, name, volume, view):
    """The frames around the collision as a video, and that of the collision as a picture."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "view.json"
        file.write_text(json.dumps({"version": 1, **view}))
        command = [program, "render", ROOT / "scenes/table1_9.toml", "--as-2007", "--bounding-volume", volume, "--contacts", "none",
                   "--seed", head["seed"], "--frames", head["frames"], "--size", "640x560", "--dpi", "96", "--view", file, "-o", f"{folder}/%05d.png"]
        if status := subprocess.run(command, stdout=subprocess.DEVNULL).returncode:
            sys.exit(status)
        frames = {int(path.stem): Image.open(path).convert("RGB") for path in sorted(pathlib.Path(folder).glob("*.png"))}
        frames[int(head["step"])].save(output / f"{name}.png", optimize=True)
        first, *others = frames.values()
        first.save(output / f"{name}.webp", save_all=True, append_images=others, duration=60, loop=0, quality=40, method=4)


def draw_figures(program, output):
    head = Tables(output / "figures").head("figures_1")
    pair, place = [int(index) for index in head["objects"].split()], [float(x) for x in head["place"].split()]
    names = [f"{model} {copy}" for model in ("pawn", "fish", "rabbit") for copy in (1, 2, 3)]
    draw(program, output, head, "figure3", "sphere", {
        "camera": {"position": [2, 6.5, 12], "target": [0, -0.5, 0]}, "layers": {"regions": True, "octree": True}, "octree": {"level": 0}})
    draw(program, output, head, "figure5", "aabb", {
        "camera": {"position": [x + dx for x, dx in zip(place, (0.6, 0.8, 1.8))], "target": place},
        "layers": {"nodes": True}, "nodes": {"objects": pair}, "objects": {name: {"visible": i in pair, "opacity": 0.45} for i, name in enumerate(names)}})


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
             "<p>Regions have the colour of their level.</p>",
             f'<div class="figures">{picture(output / "figure3.png", "regions of the scene octree and spheres")}'
             f'{picture(output / "figure3.webp", "the same as a video")}</div>',
             "<h2>Figure 4</h2>", *report.descent_plots(tables), table(*report.summary(tables, "figures_4")),
             "<h2>Figure 5: a collision in the narrow phase with boxes</h2>",
             "<p>The boxes of the leaves that collide, of both objects, in the colour of their level.</p>",
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
    run_experiments(EXPERIMENTS[:1], arguments)
    draw_figures(arguments.program, arguments.output)  # so that hours of work do not end without a Chromium
    run_experiments(EXPERIMENTS[1:], arguments)
    if not arguments.quick and COMMITTED.exists():
        compare_counts(arguments.output)
    path = arguments.output / "paper.html"
    path.write_text(page_of(arguments.output), encoding="utf-8")
    print(f"Written: {path}")


if __name__ == "__main__":
    main()
