#!/usr/bin/env python3
"""Measures how a distributed scene scales, and predicts how it scales on many machines.

usage: distributed_model.py measure PROGRAM     runs PROGRAM, writes benchmarks/results/distributed/ranks.csv
       distributed_model.py                     writes benchmarks/SCALING.md and its figure
       distributed_model.py --check             writes nothing, fails when the page is out of date

PROGRAM is supple_distributed_ranks. The ranks share the cores of one machine, so only counts and the
processor time outside of MPI say something; see benchmarks/distributed_ranks.cpp. A run of all takes 20
minutes and 12 GB.
"""

import csv
import datetime
import json
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path += [str(ROOT / "tools"), str(ROOT / "experiments")]
from make_paper import jinja2, wrapped  # noqa: E402
from judge.pages import COLORS, new_plot, set_logarithmic, try_debians_python  # noqa: E402
from judge.tables import Tables  # noqa: E402
from judge.text import rounded  # noqa: E402

RESULTS = ROOT / "benchmarks/results/distributed/ranks.csv"
STRONG = [(ranks, workload) for workload in ("tiles:1414", "sheet:1414", "balls:512:20") for ranks in (1, 2, 4, 8, 16, 32, 64)]
WEAK = [(1, "tiles:250"), (4, "tiles:500"), (16, "tiles:1000"), (64, "tiles:2000"),
        (1, "balls:27:20"), (8, "balls:216:20"), (64, "balls:1728:20")]
STEPS = 3
PAGE, FIGURE = ROOT / "benchmarks/SCALING.md", ROOT / "docs/figures/distributed_scaling.svg"

FITTED = 16  # the model is fitted to runs on at most so many ranks, and tested on the others
# A rank is a core of Frontier: 64 cores share four network cards of 200 Gb/s.
BYTES_PER_SECOND = 4 * 200e9 / 8 / 64
LATENCY = 2e-6  # of a message between nodes, also what each message costs its sender; an assumption
POSITION = 24  # bytes
ARBORX_BOX, ARBORX_QUERY = 24 + 8, 24 + 8  # bytes: a box of floats and a count; a box and its origin
EXCHANGES = 5  # of a step; each sums one number for each rank (Zoltan_Comm_Invert_Map)


def measure(program):
    """Runs all, one after the other."""
    from contest import git, processor
    launcher = ["mpirun", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1", "-n"]
    environment = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    rows, commit = [], git("rev-parse", "--short", "HEAD")
    for ranks, workload in STRONG + WEAK:
        done = subprocess.run([*launcher, str(ranks), program, workload, str(STEPS)], capture_output=True, text=True,
                              env=environment, check=True)
        rows.append(json.loads(done.stdout))
        compiler = rows[-1].pop("compiler")
        print(rows[-1], flush=True)
    with RESULTS.open("w", newline="", encoding="utf-8") as file:
        for key, value in {"date": datetime.date.today(), "commit": commit,
                           "processor": f"{processor()}, {os.cpu_count()} cores", "compiler": compiler,
                           "command": " ".join([*launcher, "RANKS supple_distributed_ranks WORKLOAD", str(STEPS)])}.items():
            file.write(f"# {key}: {value}\n")
        table = csv.DictWriter(file, rows[0], lineterminator="\n")
        table.writeheader()
        table.writerows(rows)



class Scene:
    """A workload: its rows of strong scaling, and the model that is fitted to them."""

    def __init__(self, rows, name, workload, dimensions, is_placed):
        self.name, self.workload, self.dimensions, self.is_placed = name, workload, dimensions, is_placed
        self.rows = [row for row in rows if row["workload"] == workload]
        self.weak = [row for row in rows if row["workload"] in dict(map(reversed, WEAK)) and row["workload"][0] == workload[0]]
        self.triangles = self.rows[0]["triangles"]
        fitted = [row for row in self.rows if row["ranks"] <= FITTED]
        several = [row for row in fitted if row["ranks"] > 1]

        def mean(column, shape, of=several):
            return statistics.mean(column(row) / shape(row) for row in of)

        own = lambda row: row["triangles"] / row["ranks"]  # noqa: E731
        self.cluster = mean(lambda row: row["triangles"], lambda row: row["clusters"], fitted)
        self.seconds = mean(lambda row: row["cpu_seconds"], lambda row: row["needed_triangles"], fitted)
        self.collectives = fitted[-1]["collectives"]
        self.layer = 0
        for _ in range(20):  # Newton's method, so that the needed triangles agree in the mean
            error = mean(lambda row: row["needed_triangles"], lambda row: self.needed(own(row), row["ranks"]) * row["ranks"]) - 1
            slope = mean(lambda row: sum(cut - 1 for cut in self.cuts(row["ranks"])), lambda row: row["triangles"] ** (1 / dimensions))
            self.layer += error / slope
        self.unevenness = mean(lambda row: row["imbalance"] / self.inner(own(row), row["ranks"]) - 1, lambda row: 1 / own(row))
        self.bytes_each = mean(lambda row: row["bytes"] / row["ranks"], lambda row: self.sent(own(row), row["ranks"]))
        self.sends_of_message = several[0]["sends_of_rank"] / several[0]["messages_of_rank"]
        self.sends_each = mean(lambda row: row["sends_of_rank"] - self.sends_to_all(row["ranks"]),
                               lambda row: self.partners(own(row), row["ranks"]))

    def cuts(self, ranks):
        """The number of regions along each axis."""
        halvings = math.log2(ranks)
        if halvings != int(halvings):
            return [ranks ** (1 / self.dimensions)] * self.dimensions
        return [2 ** ((int(halvings) + axis) // self.dimensions) for axis in range(self.dimensions)]

    def needed(self, own, ranks):
        """Triangles that a rank needs: a layer of constant width around its own, towards other regions."""
        side = (own * ranks) ** (1 / self.dimensions)
        return own * math.prod(1 + self.layer * (regions - 1) / side for regions in self.cuts(ranks))

    def inner(self, own, ranks):
        """What a rank inside of the scene needs, with neighbours on all sides, by the mean."""
        side = (own * ranks) ** (1 / self.dimensions)
        return own / self.needed(own, ranks) * math.prod(1 + self.layer * min(2, regions - 1) / 2 * regions / side
                                                         for regions in self.cuts(ranks))

    def imbalance(self, own, ranks):
        return self.inner(own, ranks) * (1 + self.unevenness / own * (ranks > 1))

    def sent(self, own, ranks):
        """Triangles that a rank needs and that are on another one."""
        needed = self.needed(own, ranks)
        return needed - own if self.is_placed else needed * (1 - 1 / ranks)

    def partners(self, own, ranks):
        """With which others a rank exchanges clusters: its neighbours, or those that have its balls at random."""
        if self.is_placed:
            return math.prod(min(3, regions) for regions in self.cuts(ranks)) - 1
        balls = self.needed(own, ranks) / self.triangles * float(self.workload.split(":")[1])
        return (ranks - 1) * (1 - (1 - 1 / ranks) ** balls)

    def sends_to_all(self, ranks):
        """The first home of an object in parts sends its box to all ranks whose regions it meets."""
        return self.sends_of_message * (ranks - 1) * self.is_placed

    def sends(self, own, ranks):
        """Of the busiest rank."""
        return self.sends_each * self.partners(own, ranks) + self.sends_to_all(ranks)

    def bytes_of_rank(self, own, ranks):
        return self.bytes_each * self.sent(own, ranks)

    def parts(self, own, ranks):
        """The seconds of a step."""
        needed, imbalance = self.needed(own, ranks), self.imbalance(own, ranks)
        levels = math.log2(ranks)
        return {
            "own triangles": self.seconds * own,
            "surface": self.seconds * (needed - own),
            "imbalance": self.seconds * needed * (imbalance - 1),
            "bytes": self.bytes_of_rank(own, ranks) * imbalance / BYTES_PER_SECOND,
            "messages": self.sends(own, ranks) * LATENCY,
            "collectives": levels * (self.collectives * LATENCY + EXCHANGES * 4 * ranks / BYTES_PER_SECOND),
        }

    def step(self, own, ranks):
        return sum(self.parts(own, ranks).values())

    def efficiency(self, own, ranks):
        return self.seconds * own / self.step(own, ranks)

    def work(self, own, ranks):
        return self.needed(own, ranks) * self.imbalance(own, ranks)

    def most_ranks(self, triangles):
        """The most ranks with an efficiency of at least a half, as a power of two."""
        return max(2 ** i for i in range(0, 24) if self.efficiency(triangles / 2 ** i, 2 ** i) >= 0.5)

    def residuals(self, row):
        """Model by measurement, less 1."""
        ranks, own = row["ranks"], row["triangles"] / row["ranks"]
        return {"needed triangles": self.needed(own, ranks) * ranks / row["needed_triangles"] - 1,
                "work of the busiest rank by the mean": self.imbalance(own, ranks) / row["imbalance"] - 1,
                "bytes": self.bytes_of_rank(own, ranks) * ranks / row["bytes"] - 1,
                "sends of the busiest rank": self.sends(own, ranks) / row["sends_of_rank"] - 1}

    def tests(self):
        """The rows that the model is not fitted to, with more ranks."""
        return [row for row in self.rows + self.weak if row["ranks"] > FITTED]


def scenes():
    rows = Tables(RESULTS.parent).rows(RESULTS.stem)
    return (Scene(rows, "one mesh in tiles", "tiles:1414", 2, True), Scene(rows, "balls dealt in turn", "balls:512:20", 3, False),
            Scene(rows, "one mesh in strips", "sheet:1414", 2, False))


def draw(tiles, balls):
    try:
        import matplotlib
    except ImportError:
        try_debians_python()
        raise
    figure, axes = new_plot("", "", "", height=4.1)
    axes.remove()
    figure.set_size_inches(12.5, 4.1)
    sent, speed, weak = figure.subplots(1, 3)
    powers = [2 ** i for i in range(15)]
    for panel, title, y_label in ((sent, "Sent in a step, 4 million triangles", "megabytes of a rank, mean"),
                                  (speed, "Speed-up", ""),
                                  (weak, "Time of a step, predicted", "seconds")):
        panel.set_title(title, loc="left", fontweight="bold", fontsize=12)
        panel.set_xlabel("ranks")
        panel.set_ylabel(y_label)
        panel.grid(color="#ddd", linewidth=0.7)
    for scene, color, marker in ((tiles, COLORS[0], "o"), (balls, COLORS[1], "s")):
        ranks = powers[1:8]
        own = lambda p, total=scene.triangles: total / p  # noqa: E731
        sent.plot(ranks, [scene.bytes_of_rank(own(p), p) / 1e6 for p in ranks], color=color)
        for panel, value in ((sent, lambda row: row["bytes"] / row["ranks"] / 1e6),
                             (speed, work_speed_up)):
            for is_fitted in (True, False):
                chosen = [row for row in scene.rows if (row["ranks"] <= FITTED) == is_fitted and value(row) > 0]
                panel.plot([row["ranks"] for row in chosen], [value(row) for row in chosen], linestyle="", marker=marker, color=color,
                           markersize=6, markerfacecolor=color if is_fitted else "white", zorder=3)
        chosen = scene.rows[1:]
        sent.plot([row["ranks"] for row in chosen], [row["surface_positions"] * POSITION / row["ranks"] / 1e6 for row in chosen],
                  color=color, linestyle=":", marker=".")
        ranks = [p for p in powers if scene.triangles / p > scene.cluster]
        speed.plot(ranks, [p * own(p) / scene.work(own(p), p) for p in ranks], color=color)
        speed.plot(powers, [p * scene.efficiency(1e10 / p, p) for p in powers], color=color, linestyle="--")
    sent.set_ylim(0.003, 60)
    sent.annotate("balls dealt in turn", (12, 11), color=COLORS[1])
    sent.annotate("one mesh in tiles", (12, 1.5), color=COLORS[0])
    sent.annotate("surface: must be sent at least", (2.1, 0.009), color="#555555")
    speed.plot(powers, powers, color="#888888", linewidth=0.8)
    speed.annotate("ideal", (14, 55), color="#888888")
    speed.annotate("10¹⁰ triangles:\ntime, predicted", (1100, 130), color="#555555")
    speed.annotate("4 million triangles: work,\nmeasured and predicted", (45, 1.1), color="#555555")
    parts = [tiles.parts(1e6, p) for p in powers]
    weak.stackplot(powers, [[part[name] for part in parts] for name in parts[0]], labels=list(parts[0]),
                   colors=["#0077bb", "#77b5dd", "#cde4f3", "#009988", "#cc3311", "#ee7733"])
    weak.legend(*[list(reversed(each)) for each in weak.get_legend_handles_labels()], loc="upper left", frameon=False)
    weak.set_ylim(0, 0.33)
    weak.annotate("one mesh in tiles, a million\ntriangles on each rank", (2, 0.02), color="white")
    for axis in (sent.xaxis, sent.yaxis, speed.xaxis, speed.yaxis, weak.xaxis):
        set_logarithmic(axis, 1, 1e4)
    matplotlib.rcParams["svg.hashsalt"] = "scaling"
    figure.savefig(FIGURE, metadata=dict.fromkeys(("Creator", "Date", "Format", "Type")), facecolor="white")


def work_speed_up(row):
    return row["ranks"] * row["triangles"] / row["needed_triangles"] / row["imbalance"]


def cells(row):
    """Of the table of counts."""
    ranks, needed = row["ranks"], row["needed_triangles"] / row["triangles"]
    mean_and_most = [rounded(value, 2) for value in (row["bytes"] / ranks / 1e6, row["bytes_of_rank"] / 1e6)]
    surface = rounded(row["surface_positions"] * POSITION / ranks / 1e6, 2)
    return (f"{ranks:.0f} | {needed:.2f} | {row['imbalance']:.2f} | {work_speed_up(row):.1f} | {mean_and_most[0]} ({mean_and_most[1]}) | "
            f"{surface} | {row['messages'] / ranks:.0f} ({row['messages_of_rank']:.0f}) |")


def page():
    """The page, from its template."""
    head = Tables(RESULTS.parent).head(RESULTS.stem)
    dask = re.search(r"scheduler alone.*?\| ([\d,]+) \|", (ROOT / "docs/distributed.md").read_text(encoding="utf-8"))
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(ROOT / "benchmarks/templates"), undefined=jinja2.StrictUndefined,
                                     keep_trailing_newline=True, trim_blocks=True, lstrip_blocks=True)
    tiles, balls, strips = scenes()
    text = wrapped(environment.get_template("SCALING.md").render(
        globals() | {"head": head, "tiles": tiles, "balls": balls, "strips": strips, "short": rounded,
                     "percent": lambda value: f"{100 * value:.0f}", "signed": lambda value: f"{round(100 * value):+d} %".replace("-", "−"),
                     "tasks": float(dask[1].replace(",", "")), "log2": math.log2}))
    return re.sub(r" +\n", "\n", text)


def main():
    if sys.argv[1:2] == ["measure"]:
        return measure(sys.argv[2])
    now = page()
    if sys.argv[1:] == ["--check"]:
        if now != PAGE.read_text(encoding="utf-8"):
            sys.exit(f"distributed_model.py: {PAGE.relative_to(ROOT)} is out of date; run benchmarks/distributed_model.py")
        return None
    PAGE.write_text(now, encoding="utf-8")
    return draw(*scenes()[:2])


if __name__ == "__main__":
    main()
