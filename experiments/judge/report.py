"""The report of an experiment: its claims, plots and tables as one HTML page."""

import argparse
import csv
import io
import math
import pathlib
import re
import sys

import numpy as np

from judge import claims, pages, paper, table1, verdicts
from judge.estimates import LEVEL, ratio_of, text_of
from judge.pages import COLORS, bar_plot, escaped, line_plot, new_plot, page, point_plot, stop, svg_of
from judge.tables import Tables
from judge.text import rounded

TITLES = {
    "table1": "The paper's Table 1: collisions of moving objects",
    "scaling": "Growth of time with objects and with vertices",
    "arity": "Trees of two, four and eight children",
    "volumes": "Bounding volumes and ways to build an octree",
    "claims": "Single claims of the paper",
    "ablation": "From the program of 2007 to today, one choice at a time",
    "trials": "The trials that the paper rejects",
    "sensitivity": "Which settings give the ratios of the paper?",
    "figures": "The figures of the paper, from our own data",
}
CLOCKS = (table1.SIMULATED, table1.DETECTION, table1.PROGRAM)


# --- plots ---


def medians(tables, name, key, number, **wanted):
    """(key, median of the numbers) for each value of the key."""
    found = {}
    for row in tables.rows(name, **wanted):
        found.setdefault(row[key], []).append(number(row))
    return [(value, float(np.median(numbers))) for value, numbers in found.items()]


def formula(points, function):
    """The curve of a formula through the last point."""
    factor = points[-1][1] / function(points[-1][0])
    return [(x, factor * function(x)) for x, _ in points]


def broad_phase_plots(tables):
    methods = dict.fromkeys(tables.column("scaling_broad_phase", "method", moving="all"))
    for title, y_label, number in (("Broad phase: one step, all boxes in motion", "processor microseconds", lambda row: 1e6 * row["seconds"]),
                                   ("Broad phase: tests of a box against a box, or exchanges", "tests", lambda row: row["tests"])):
        curves = {}
        for method in methods:
            points = [(boxes, float(np.median([number(row) for row in tables.rows("scaling_broad_phase", method=method, boxes=boxes, moving="all")
                                               if row["round"]]))) for boxes in claims.box_counts(tables, method)]
            curves[method] = [(x, y) for x, y in points if y > 0]
        curves["n log n"] = formula(curves["octree"], claims.n_log_n)
        yield line_plot(title, "boxes", y_label, {name: points for name, points in curves.items() if points}, dashed=["n log n"])


def vertices_plots(tables):
    tests = {f"surfaces that {'cross' if pose == 'crossing' else 'coincide'}": medians(tables, "scaling_vertices", "vertices", lambda row: row["tests"], pose=pose)
             for pose in ("crossing", "coinciding")}
    tests["the paper's"] = formula(tests["surfaces that coincide"], lambda n: n ** (2 / 3) * math.log(n))
    yield line_plot("Narrow phase: tests of a volume against a volume", "vertices of each object", "tests", tests, dashed=["the paper's"])
    quantities = dict.fromkeys(tables.column("scaling_vertices_times", "quantity"))
    yield line_plot("Building, refitting and descending", "vertices", "processor milliseconds",
                    {name: medians(tables, "scaling_vertices_times", "vertices", lambda row: 1e3 * row["seconds"], quantity=name) for name in quantities})


def relative_plot(title, cases, label="{}", logarithmic=False):
    """`cases`: (case, [(variant, number)]). Points by variant for each case, relative to its first variant."""
    groups = {}
    for place, (_, variants) in enumerate(cases):
        base = variants[0][1]
        for variant, number in variants:
            if base > 0:
                groups.setdefault(label.format(variant), []).append((place, number / base))
    return point_plot(title, "case", f"relative to {label.format(cases[0][1][0][0])}", [re.split(" of |,", name)[0] for name, _ in cases], groups, logarithmic)


def by_case(tables, name, case, variant, number, **wanted):
    return [(value, medians(tables, name, variant, number, **{case: value}, **wanted)) for value in dict.fromkeys(tables.column(name, case))]


def arity_plots(tables):
    for title, leaf_size, number in (("Tests, leaves of one triangle", 1, lambda row: row["tests"]),
                                     ("Tests, leaves of up to 64 triangles", 64, lambda row: row["tests"]),
                                     ("Time of the traversal, leaves of up to 64 triangles", 64, lambda row: row["traversal_seconds"])):
        cases = by_case(tables, "arity_objects", "objects", "arity", number, leaf_size=leaf_size)
        yield relative_plot(title, [(name, variants[::-1]) for name, variants in cases], "{:.0f} children")


def volumes_plots(name, variant):
    def plots(tables):
        yield relative_plot("False candidates", by_case(tables, name, "case", variant, lambda row: row["candidates"] - row["contacts"]))
        yield relative_plot("Time of refit and query", by_case(tables, name, "case", variant, lambda row: row["refit_seconds"] + row["query_seconds"]),
                            logarithmic=True)

    return plots


STAGES = ("bounds", "refit", "broad", "narrow", "exact")


def ablation_plots(tables):
    """The stages of a step, from the program of 2007 down to the defaults."""
    for scene in dict.fromkeys(tables.column("ablation", "scene")):
        stages = {stage: dict(medians(tables, "ablation", "change", lambda row: 1e3 * row[f"{stage}_seconds"], scene=scene)) for stage in STAGES}
        bars = [(change, [(stage, color, stages[stage][change]) for stage, color in zip(STAGES, COLORS)]) for change in stages["refit"]]
        yield bar_plot(f"{verdicts.scene_in_words(scene)}: one choice at a time", "processor milliseconds of a step", bars)


def trials_plots(tables):
    yield relative_plot("Time of a step", by_case(tables, "trials", "scene", "trial", lambda row: row["seconds"]), logarithmic=True)


def with_error(estimate):
    low, high = estimate.interval()
    return estimate.mean, min((high - low) / 2, 9 * estimate.mean)


def sensitivity_plots(tables):
    """The ratios in the broad phase by the clock of the program, and those of the paper."""
    ratios = table1.sensitivity_ratios(tables)
    chosen = {key[0]: of_case for key, of_case in ratios.items() if key[1:] == (table1.PROGRAM, "broad")}
    groups = {f"{objects} objects": [(place, *with_error(of_case[objects])) for place, of_case in enumerate(chosen.values())
                                     if objects in of_case and math.isfinite(of_case[objects].mean)] for objects in (3, 6, 9)}
    yield point_plot("Spheres for each box, whole program, broad phase (the paper: 0.50, 0.82, 0.91)", "setting", "ratio of collisions",
                     list(chosen), {name: points for name, points in groups.items() if points}, True)


def modules_plots(tables):
    """Figure 1: the modules as boxes in the order in which they run, with their times."""
    rows = tables.rows("figures_1")
    figure, axes = new_plot("Figure 1: modules of the program", "", "", height=2.6)
    axes.axis("off")
    for place, row in enumerate(rows):
        axes.text(place, 0.5, f"{row['module']}\n{rounded(1e3 * row['seconds'], 2)} ms per {row['per']}", ha="center", va="center",
                  bbox={"boxstyle": "round,pad=0.7", "facecolor": "#eef4fb", "edgecolor": COLORS[0]})
        if place + 1 < len(rows):
            axes.annotate("", (place + 0.62, 0.5), (place + 0.38, 0.5), arrowprops={"arrowstyle": "->", "color": "#555"})
    axes.annotate("", (1, 0.86), (len(rows) - 1, 0.86),
                  arrowprops={"arrowstyle": "->", "color": "#555", "connectionstyle": "bar,fraction=0.06"})
    axes.text((len(rows)) / 2, 1.02, "each step", ha="center", color="#555")
    axes.set_xlim(-0.5, len(rows) - 0.5)
    axes.set_ylim(0, 1.1)
    yield svg_of(figure)


def regions_plots(tables):
    """Figure 2: the tree of regions; a region is red with two objects or more, blue with one, and white without."""
    rows = tables.rows("figures_2")
    figure, axes = new_plot("Figure 2: regions of the broad phase; inner regions are grey", "", "level", height=3.4)
    places = {}
    levels = sorted({int(row["level"]) for row in rows})
    for level in levels:
        of_level = sorted((row for row in rows if row["level"] == level), key=lambda row: row["number"])
        for i, row in enumerate(of_level):
            x, y = (i + 0.5) / len(of_level), level
            places[int(row["number"])] = (x, y)
            parent = places.get((int(row["number"]) - 1) // 8) if level else None
            if parent:
                axes.plot([parent[0], x], [parent[1], y], color="#bbb", linewidth=0.7, zorder=1)
            count = int(row["objects"])
            color = "#cccccc" if not row["leaf"] else "#cc3311" if count > 1 else COLORS[6] if count else "white"
            axes.plot(x, y, "s", color=color, markeredgecolor="#555", markersize=9 if level < 2 else 5, zorder=2)
            if row["leaf"] and count > 1:
                axes.annotate(str(count), (x, y), (0, -12), textcoords="offset points", ha="center", fontsize=7)
    axes.grid(visible=False)
    axes.set_xticks([])
    axes.set_yticks(levels)
    axes.set_ylim(max(levels) + 0.4, -0.4)
    yield svg_of(figure)


def descent_plots(tables):
    """Figure 4: the list of pairs by level, and the bound of the paper."""
    rows = tables.rows("figures_4")
    points = {"pairs of nodes that collide": [(row["level"], row["pairs"]) for row in rows],
              "pairs of leaves": [(row["level"], row["leaf_pairs"]) for row in rows if row["leaf_pairs"]],
              "the paper's at most 16 of each": [(row["level"], 16 ** row["level"]) for row in rows if row["level"] < 3]}
    figure, axes = new_plot("Figure 4: the narrow phase, level by level", "level", "pairs")
    for (name, of_name), color in zip(points.items(), COLORS):
        axes.plot(*zip(*of_name), marker="o", markersize=5, label=name, color=color, linestyle="--" if "at most" in name else "-")
    axes.set_yscale("log")
    axes.set_xticks([row["level"] for row in rows])
    yield svg_of(figure)


def table1_plots(tables):
    """The ratio by each clock and in the paper, and the collisions in ten minutes of each clock."""
    names = table1.scenes(tables, table1.PROGRAM)
    for phase in paper.PHASES:
        groups = {}
        for clock in CLOCKS:
            ratios = [(place, table1.ratio(tables, scene, phase, clock)) for place, scene in enumerate(names)]
            groups[clock] = [(place, *with_error(ratio)) for place, ratio in ratios if math.isfinite(ratio.mean)]
        groups["the paper"] = [(place, *with_error(table1.paper_ratio(table1.objects_of(scene), phase))) for place, scene in enumerate(names)
                               if table1.objects_of(scene) in (3, 6, 9)]
        yield point_plot(f"Spheres for each box, {phase} phase", "scene", "ratio of collisions", [verdicts.scene_in_words(name) for name in names],
                         {name: points for name, points in groups.items() if points}, True)


PLOTS = {"table1": (table1_plots,), "scaling": (broad_phase_plots, vertices_plots), "arity": (arity_plots,),
         "volumes": (volumes_plots("volumes", "volume"), volumes_plots("volumes_builds", "build")), "ablation": (ablation_plots,),
         "trials": (trials_plots,), "sensitivity": (sensitivity_plots,), "figures": (modules_plots, regions_plots, descent_plots)}


# --- tables: heading, rows, columns with text, caption ---


def rates(tables):
    """Collisions in ten minutes by each clock, and those of the paper."""
    rows = []
    for scene in table1.scenes(tables, table1.PROGRAM):
        for volume in dict.fromkeys(row["volume"] for row in table1.runs(tables, table1.PROGRAM, scene=scene)):
            for phase in paper.PHASES:
                numbers = []
                for clock in CLOCKS:
                    of_clock = table1.runs(tables, clock, scene=scene, volume=volume)
                    numbers.append(rounded(float(np.mean([table1.collisions(row, phase, clock) for row in of_clock]))) if of_clock else "–")
                objects = table1.objects_of(scene)
                theirs = rounded(float(np.mean(paper.runs(objects, volume, phase)))) if (objects, volume) in paper.TABLE1 else "–"
                rows.append([verdicts.scene_in_words(scene), volume, phase, *numbers, theirs])
    return (["Scene", "Volume", "Phase", *(clock.capitalize() for clock in CLOCKS), "The paper"], rows, (0, 1, 2),
            "Collisions in a run; by a clock, in ten minutes of it")


def ratios(tables):
    """Spheres for each box by each clock, with intervals, and in the paper."""
    rows = []
    for scene in table1.scenes(tables, table1.PROGRAM):
        for phase in paper.PHASES:
            of_paper = text_of(table1.paper_ratio(table1.objects_of(scene), phase)) if table1.objects_of(scene) in (3, 6, 9) else "–"
            rows.append([verdicts.scene_in_words(scene), phase, *(text_of(table1.ratio(tables, scene, phase, clock)) for clock in CLOCKS), of_paper])
    return ["Scene", "Phase", *(clock.capitalize() for clock in CLOCKS), "The paper"], rows, (0, 1), "Collisions with spheres for each with boxes"


def changes(tables):
    """One choice of today at a time."""
    rows = []
    for scene in dict.fromkeys(tables.column("ablation", "scene")):
        seconds = {row["place"]: (row["change"], claims.program_seconds(tables, scene, row["place"])) for row in tables.rows("ablation", scene=scene)}
        for place, (change, of_change) in seconds.items():
            before, first = seconds[max(place - 1, 0)][1], seconds[0][1]
            rows.append([verdicts.scene_in_words(scene), change, rounded(1e3 * float(np.median(of_change))), text_of(ratio_of(before, of_change)),
                         text_of(ratio_of(first, of_change))])
    return ["Scene", "One more choice of today", "ms of a step", "× the row above", "× 2007"], rows, (0, 1), "From the program of 2007 to today"


def strains(tables):
    rows = [[verdicts.scene_in_words(row["scene"]), row["preserved"], *(f"{100 * row[column]:.2g} %" for column in ("mean_area_error", "mean_strain", "largest_strain"))]
            for row in tables.rows("claims_areas")]
    return ["Scene", "Areas preserved", "Mean change of an area", "Mean strain of an edge", "Largest strain"], rows, (0, 1), "Areas and strains"


def averages(_):
    rows = [[objects, volume, phase, f"{by_table:.4g}", f"{text:.4g}", how] for objects, volume, phase, by_table, text, how in paper.averages()]
    return ["Objects", "Volume", "Phase", "Seconds for a collision by Table 1", "in the text", ""], rows, (1, 2, 5), "The averages of the text"


def cell_of(value):
    if value is None:
        return "–"
    return value if isinstance(value, str) else f"{value:,.0f}" if value == int(value) and abs(value) < 1e15 else rounded(value)


def summary(tables, name):
    """A table of files: rows that differ by their round become one, with the medians of its numbers."""
    rows = tables.rows(name)
    columns = list(rows[0])
    first = min((columns.index(column) for column in ("round", "seed") if column in columns), default=None)
    if first is not None:
        of_case = {}
        for row in rows:
            of_case.setdefault(tuple(row[column] for column in columns[:first]), []).append(row)
        measured = [column for column in columns[first + 1 :] if all(isinstance(row[column], float) for row in rows)]
        columns = columns[:first] + measured
        rows = [dict(zip(columns[:first], case)) | {column: float(np.median([row[column] for row in of_rows])) for column in measured}
                for case, of_rows in of_case.items()]
    texts = [i for i, column in enumerate(columns) if any(isinstance(row[column], str) for row in rows)]
    return ([column.replace("_", " ") for column in columns], [[cell_of(row[column]) for column in columns] for row in rows], texts,
            f"{name}.csv" + (": medians of the rounds" if first is not None else ""))


LISTINGS = {"table1": (rates, ratios, averages), "claims": (strains,), "ablation": (changes,)}


# --- the figure of what holds ---


def draw_what_holds(tables, judged, path):
    """Spheres for each box, and brute force against the octree, by the number of objects; intervals as they are judged."""
    import matplotlib.figure
    matplotlib.rcParams.update({"svg.hashsalt": "what_holds", "svg.fonttype": "none", "font.size": 11, "axes.spines.top": False, "axes.spines.right": False})
    figure = matplotlib.figure.Figure(figsize=(11, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2)

    def draw(axes, claim, label, color, shift=1.0):
        lines = [(int(re.sub(r"\D", "", test.when)), test.number.mean, *test.number.interval(test.level)) for test in judged[claim].tests
                 if math.isfinite(test.number.error)]
        sizes, means, lows, highs = np.array(lines).T
        axes.errorbar(sizes * shift, means, (means - lows, highs - means), marker="o", markersize=4, capsize=2.5, color=color, label=label)

    for claim, clock, color, shift in zip(("simulated", "detection", "program"), CLOCKS, COLORS, (0.97, 1, 1.03)):
        draw(left, f"more-with-boxes-{claim}", f"we, {clock}", color, shift)
    left.plot([3, 6, 9], [table1.paper_ratio(objects, "broad").mean for objects in (3, 6, 9)], linestyle="", marker="s", color="black", label="the paper")
    draw(right, "better-than-brute", "plain programs of 2007's kind", COLORS[4])
    draw(right, "better-than-brute-many", "Supple today", COLORS[6])
    for axes, title in ((left, "Collisions found: spheres ÷ boxes"), (right, "Time: brute force ÷ octree")):
        axes.set_title(title, loc="left", fontsize=12)
        axes.set_xlabel("objects")
        axes.axhline(1, color="#888888", linewidth=0.8)
        axes.grid(color="#ddd", linewidth=0.7)
        axes.legend(frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
    pages.set_logarithmic(right.yaxis, 0.01, 1000)
    pages.set_logarithmic(right.xaxis, 3, 100_000)
    pages.set_logarithmic(left.xaxis, 3, 10_000)
    left.set_xticks(sizes := table1.mixed(tables), sizes)
    left.set_ylim(0, 1.6)
    figure.savefig(path, format="svg", metadata={"Date": None, "Creator": None})


# --- the page ---


def html_of_claim(claim):
    kind = "holds" if claim.verdict == verdicts.HOLDS else "fails" if claim.verdict == verdicts.FAILS else "open"
    where = f" (section {claim.where.split(',')[0]})" if claim.where else ""
    parts = [f"<p>{escaped(claim.text)}{where}</p>", f"<p><b>{escaped(claim.verdict)}.</b> {escaped(claim.quantity)}: {escaped(claim.numbers)}</p>"]
    parts += [f"<p>{escaped(text)}</p>" for text in (claim.reading and f"Read as: {claim.reading}", claim.remark) if text]
    return f'<div class="claim {kind}">{"".join(parts)}</div>'


def csv_of(found):
    """The verdicts as a table, which is made again whenever the tables are judged."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["claim", "where", "text", "verdict", "quantity", "numbers"])
    for claim in found:
        writer.writerow([claim.name, claim.where, claim.text, claim.verdict, claim.quantity, claim.numbers])
    return text.getvalue()


def name_of(folder):
    """The experiment whose tables a folder has."""
    stems = {path.stem for path in folder.glob("*.csv")}
    return next((name for name in TITLES if any(stem == name or stem.startswith(f"{name}_") for stem in stems - {f"{name}_claims"})), None)


def html_of(tables, name, found):
    shown = [each for each in tables.paths if not each.endswith("_claims")]
    head = tables.head(shown[0])
    parts = ["<h2>What holds</h2>", f"<p>Numbers with their {100 - 100 * LEVEL:.0f} % intervals. Where many are judged together, their intervals are wider "
             "(Holm). A verdict is undecided when the interval has the limit in it.</p>"] if found else []
    parts += [html_of_claim(claim) for claim in found]
    parts += ["<h2>Measurements</h2>", *(plot for plots in PLOTS.get(name, ()) for plot in plots(tables))]
    parts += [pages.table(*listing(tables)) for listing in LISTINGS.get(name, ())]
    parts += [pages.table(*summary(tables, each)) for each in shown if tables.rows(each)]
    parts += ["<h2>Parameters and machine</h2>", pages.table([], head.items(), (0, 1))]
    return page(TITLES[name], parts)


def main():
    parser = argparse.ArgumentParser(prog="supple-experiment-report", description="Judges the claims of the paper by the tables that `supple experiment` "
                                     "writes into a folder, and makes a page of them.")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--quiet", action="store_true", help="print no verdicts")
    arguments = parser.parse_args()
    name = name_of(arguments.folder)
    if name is None:
        stop(f"supple-experiment-report: {arguments.folder} has no tables of an experiment; give a folder that `supple experiment` has written")
    try:
        tables = Tables(arguments.folder)
        found = verdicts.judged(tables)
        (arguments.folder / f"{name}_claims.csv").write_text(csv_of(found), encoding="utf-8")
        (arguments.folder / f"{name}.html").write_text(html_of(tables, name, found), encoding="utf-8")
    except OSError as error:
        stop(f"supple: {error.filename}: cannot be read or written: {error.strerror}")
    if not arguments.quiet:
        print("\n".join([TITLES[name], "", *(["What holds"] if found else [])]))
        for claim in found:
            print(f"- {claim.text}\n  {claim.verdict}. {claim.quantity}: {claim.numbers}")
        print(f"Written: {arguments.folder / f'{name}.html'}")


if __name__ == "__main__":
    sys.exit(main())
