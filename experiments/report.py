#!/usr/bin/env python3
"""Writes the report of an experiment: one HTML page with plots, without external resources.

usage: supple-experiment-report FOLDER

FOLDER has the CSV files and the NAME_report.json that `supple experiment NAME` writes; the page is
FOLDER/NAME.html. The plots need matplotlib. The build copies this file beside the program and names it as above.
benchmarks/contest_report.py uses the functions of this file for its page.
"""

import csv
import html
import io
import itertools
import json
import math
import os
import pathlib
import re
import sys

# Distinguishable on white, also for most people with colour vision deficiency.
COLORS = ["#0077bb", "#ee7733", "#009988", "#cc3311", "#9467bd", "#888888", "#33bbee", "#ee3377", "#999933"]
MARKERS = "osv^D"

STYLE = """
:root { color-scheme: light dark; --soft: #8882; --holds: #0b6e3a; --fails: #b3261e; --open: #7a5b00; }
@media (prefers-color-scheme: dark) { :root { --holds: #5fd08f; --fails: #ff8a80; --open: #e6c15a; } }
body { font: 15px/1.5 sans-serif; max-width: 68rem; margin: 2rem auto; padding: 0 1rem; }
.table { overflow-x: auto; margin: 0.6rem 0 1.4rem; }
table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; width: max-content; }
caption { text-align: left; font-weight: bold; padding-bottom: 0.4rem; }
th, td { padding: 0.2rem 0.8rem 0.2rem 0; text-align: right; vertical-align: top; border-bottom: 1px solid #8884;
  white-space: nowrap; }
.text { text-align: left; white-space: normal; max-width: 26rem; }
.claim { background: var(--soft); border-left: 5px solid; padding: 0.6rem 1rem; margin: 0.8rem 0; }
.claim p { margin: 0.15rem 0; } .claim b { text-transform: uppercase; font-size: 0.8rem; letter-spacing: 0.04em; }
.holds { border-color: var(--holds); } .holds b { color: var(--holds); }
.fails { border-color: var(--fails); } .fails b { color: var(--fails); }
.open { border-color: var(--open); } .open b { color: var(--open); }
svg { display: block; max-width: 100%; height: auto; margin: 0.8rem 0; background: #fff; }
"""


def stop(message):
    print(message, file=sys.stderr)
    sys.exit(2)


def try_debians_python():
    """Starts again with Debian's Python, to which Debian's packages belong; another one can be the first in PATH."""
    debian = pathlib.Path("/usr/bin/python3")
    if debian.exists() and debian.resolve() != pathlib.Path(sys.executable).resolve():
        os.execv(debian, [debian, *sys.argv])


# --- pages ---


def escaped(text):
    return html.escape(str(text))


def rounded(value, digits=3):
    """The significant digits of a number, with grouped thousands."""
    if not math.isfinite(value):
        return "–" if math.isnan(value) else "∞" if value > 0 else "-∞"
    if value == 0:
        return "0"
    magnitude = math.floor(math.log10(abs(value)))
    if not -6 < magnitude < 9:
        return f"{value:.{digits - 1}e}"
    return f"{round(value, digits - 1 - magnitude):,.{max(digits - 1 - magnitude, 0)}f}"


def table(heading, rows, text_columns=(0,), caption=""):
    """Cells may be (text, class)."""
    def cell(tag, value, column):
        words, name = value if isinstance(value, tuple) else (value, "")
        classes = " ".join(filter(None, [name, "text" if column in text_columns else ""]))
        return f'<{tag} class="{classes}">{escaped(words)}</{tag}>' if classes else f"<{tag}>{escaped(words)}</{tag}>"

    lines = ["".join(cell("th", name, i) for i, name in enumerate(heading))] if heading else []
    lines += ["".join(cell("td", value, i) for i, value in enumerate(row)) for row in rows]
    body = "\n".join(f"<tr>{line}</tr>" for line in lines)
    return f'<div class="table"><table>\n{f"<caption>{escaped(caption)}</caption>" if caption else ""}{body}\n</table></div>'


def page(title, parts, style=""):
    body = "\n".join([f"<h1>{escaped(title)}</h1>", *parts])
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"/>'
            '<meta name="viewport" content="width=device-width, initial-scale=1"/>'
            f"<title>{escaped(title)}</title><style>{STYLE}{style}</style></head><body>\n{body}\n</body></html>\n")


# --- plots ---


def new_plot(title, x_label, y_label, height=4.3):
    try:
        import matplotlib
    except ImportError:
        stop("supple: plots need matplotlib for python3; install it, on Debian by: apt-get install python3-matplotlib; the "
             "tables are written")
    from matplotlib.figure import Figure
    matplotlib.set_loglevel("error")  # the first run would report its cache of fonts
    matplotlib.rcParams.update({"svg.fonttype": "none", "font.size": 11, "axes.spines.top": False,
                                "axes.spines.right": False, "axes.axisbelow": True})
    figure = Figure(figsize=(9.5, height), layout="constrained")
    axes = figure.subplots()
    axes.set_title(title, loc="left", fontweight="bold", fontsize=12)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.grid(color="#ddd", linewidth=0.7)
    return figure, axes


def set_logarithmic(axis, low, high):
    """A logarithmic axis with numbers such as 0.02, 500 and 10 k at powers of ten, and at 2 and 5 times them if few."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
    getattr(axis.axes, f"set_{axis.axis_name}scale")("log")
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 1000 * low else (1,)))
    axis.set_major_formatter(FuncFormatter(
        lambda v, _: f"{v / 1e6:g} M" if v >= 1e6 else f"{v / 1e3:g} k" if v >= 1e3 else f"{v:g}"))
    axis.set_minor_formatter(NullFormatter())


def svg_of(figure, numbers=itertools.count(1)):
    """The plot as an element of a page: without name spaces, and with ids that no other plot has."""
    if handles := figure.axes[0].get_legend_handles_labels()[0]:
        figure.axes[0].legend(handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1), frameon=False)
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata=dict.fromkeys(("Creator", "Date", "Format", "Type")))
    svg = text.getvalue()[text.getvalue().index("<svg"):].replace("xlink:href", "href")
    svg = re.sub(r' xmlns(:\w+)?="[^"]*"', "", svg)
    return re.sub(r'(\bid="|href="#|url\(#)', rf"\1plot{next(numbers)}_", svg)


def line_plot(title, x_label, y_label, curves, dashed=(), colors=None):
    """Logarithmic axes; `curves` are lists of points (x, y) by name."""
    figure, axes = new_plot(title, x_label, y_label)
    for (name, points), color in zip(curves.items(), itertools.cycle(COLORS)):
        style = {"linestyle": "--", "color": "#555555"} if name in dashed else {"marker": "o", "markersize": 4}
        axes.plot(*zip(*points), label=name, **({"color": (colors or {}).get(name, color)} | style))
    for axis, place in ((axes.xaxis, 0), (axes.yaxis, 1)):
        numbers = [point[place] for points in curves.values() for point in points]
        set_logarithmic(axis, min(numbers), max(numbers))
    return svg_of(figure)


def point_plot(title, x_label, y_label, names, groups, logarithmic=False):
    """`names` along x; `groups` are points (place of the name, y) or (place, y, error) by the name of the group."""
    figure, axes = new_plot(title, x_label, y_label)
    for i, (label, points) in enumerate(groups.items()):
        x = [point[0] + 0.6 * ((i + 0.5) / len(groups) - 0.5) for point in points]
        errors = [point[2] if len(point) > 2 else 0 for point in points]
        axes.errorbar(x, [point[1] for point in points], errors, label=label, linestyle="", markersize=6,
                      marker=MARKERS[i % len(MARKERS)], color=COLORS[i % len(COLORS)])
    if logarithmic:
        numbers = [point[1] for points in groups.values() for point in points if point[1] > 0]
        set_logarithmic(axes.yaxis, min(numbers), max(numbers))
    else:
        axes.set_ylim(0, 1.1 * max(point[1] for points in groups.values() for point in points))
    axes.set_xticks(range(len(names)), names, **({"rotation": 20, "ha": "right"} if len(names) > 5 else {}))
    axes.set_xlim(-0.5, len(names) - 0.5)
    return svg_of(figure)


def bar_plot(title, x_label, bars):
    """Horizontal bars (name, [(part, color, value)...]) with stacked parts."""
    figure, axes = new_plot(title, x_label, "", height=1.3 + 0.28 * len(bars))
    axes.grid(visible=False, axis="y")
    named = set()
    for place, (_, parts) in enumerate(bars):
        start = 0
        for part, color, value in parts:
            axes.barh(place, value, left=start, color=color, height=0.7, label=None if part in named else part or None)
            named.add(part)
            start += value
        axes.annotate(rounded(start), (start, place), (4, 0), textcoords="offset points", va="center")
    axes.set_yticks(range(len(bars)), [name for name, _ in bars])
    axes.invert_yaxis()
    axes.margins(x=0.08)
    return svg_of(figure)


# --- the plots of each table ---


def curves_of(rows, by, x, y):
    curves = {}
    for row in rows:
        if row[y]:
            curves.setdefault(row[by], []).append((float(row[x]), float(row[y])))
    return curves


def formula(points, function):
    """The curve of a formula through the last point."""
    factor = points[-1][1] / function(points[-1][0])
    return [(x, factor * function(x)) for x, _ in points]


def broad_phase_plots(rows):
    for y, title, y_label in (("step_ms", "Broad phase: one step, all boxes in motion", "milliseconds"),
                              ("tests", "Broad phase: tests of a box against a box", "tests")):
        curves = curves_of(rows, "method", "objects", y)
        curves["n log n"] = formula(curves["octree"], lambda n: n * math.log(n))
        yield line_plot(title, "boxes", y_label, curves, dashed=["n log n"])


def vertices_plots(rows):
    for y, title, y_label in (("tests", "Narrow phase: tests of a volume against a volume", "tests"),
                              ("traversal_ms", "Narrow phase: traversal of both octrees", "milliseconds")):
        curves = curves_of(rows, "pose", "vertices", y)
        curves["the paper's"] = formula(curves["coinciding"], lambda n: n ** (2 / 3) * math.log(n))
        yield line_plot(title, "vertices of each object", y_label, curves, dashed=["the paper's"])
    columns = {"build": "build_ms", "refit, boxes": "refit_ms", "refit, spheres": "sphere_refit_ms"}
    yield line_plot("Building and refitting an octree", "vertices", "milliseconds",
                    {name: curves_of(rows, "pose", "vertices", y)["crossing"] for name, y in columns.items()})


def relative_plot(title, rows, case, variant, measure, number, label="{}", logarithmic=False):
    """Points by variant for each case, relative to the variant `measure`."""
    cases = list(dict.fromkeys(row[case] for row in rows))
    base = {row[case]: number(row) for row in rows if row[variant] == measure}
    groups = {}
    for row in rows:
        if base[row[case]] > 0:
            groups.setdefault(label.format(row[variant]), []).append(
                (cases.index(row[case]), number(row) / base[row[case]]))
    return point_plot(title, "case", f"relative to {label.format(measure)}", [re.split(" of |,", name)[0] for name in cases],
                      groups, logarithmic)


def arity_plots(rows):
    for title, leaf_size, y in (("Tests, leaves of one triangle", "1", "tests"),
                                ("Tests, leaves of up to 64 triangles", "64", "tests"),
                                ("Time of the traversal, leaves of up to 64 triangles", "64", "traversal_ms")):
        chosen = [row for row in rows if row["leaf_size"] == leaf_size]
        yield relative_plot(title, chosen, "objects", "arity", "8", lambda row: float(row[y]), "{} children")


def volumes_plots(rows):
    variant = list(rows[0])[1]
    measure = rows[0][variant]
    yield relative_plot("False candidates", rows, "case", variant, measure, lambda row: float(row["false_candidates"]))
    yield relative_plot("Time of refit and query", rows, "case", variant, measure,
                        lambda row: float(row["refit_ms"]) + float(row["query_ms"]), logarithmic=True)


STAGES = (("refit", "refit_ms"), ("broad phase", "broad_ms"), ("narrow phase", "narrow_ms"), ("exact stage", "exact_ms"))


def ablation_plots(rows):
    """The stages of a step, from the program of 2007 down to the defaults."""
    for scene in dict.fromkeys(row["scene"] for row in rows):
        bars = [(row["change"], [(stage, color, float(row[key])) for (stage, key), color in zip(STAGES, COLORS)])
                for row in rows if row["scene"] == scene]
        yield bar_plot(f"{scene}: one choice at a time", "milliseconds of a step", bars)


def trials_plots(rows):
    yield relative_plot("Time of a step", rows, "scene", "trial", "the hierarchy", lambda row: float(row["ms"]), logarithmic=True)


def sensitivity_plots(rows):
    """The ratios in the broad phase by the clock of the program, and those of the paper."""
    chosen = [row for row in rows if row["phase"] == "broad" and row["clock"] == "whole program"]
    groups = {f"{n} objects": [(place, float(row[f"ratio_{n}"]), float(row[f"ratio_{n}_error"] or 0))
                               for place, row in enumerate(chosen) if row[f"ratio_{n}"]] for n in (3, 6, 9)}
    yield point_plot("Spheres for each box, whole program, broad phase (the paper: 0.50, 0.82, 0.91)", "setting",
                     "ratio of collisions", [row["setting"] for row in chosen], {n: p for n, p in groups.items() if p}, True)


def modules_plots(rows):
    """Figure 1: the modules as boxes in the order in which they run, with their times."""
    figure, axes = new_plot("Figure 1: modules of the program", "", "", height=2.6)
    axes.axis("off")
    for place, row in enumerate(rows):
        axes.text(place, 0.5, f"{row['module']}\n{rounded(float(row['ms']), 2)} ms per {row['per']}", ha="center", va="center",
                  bbox={"boxstyle": "round,pad=0.7", "facecolor": "#eef4fb", "edgecolor": COLORS[0]})
        if place + 1 < len(rows):
            axes.annotate("", (place + 0.62, 0.5), (place + 0.38, 0.5), arrowprops={"arrowstyle": "->", "color": "#555"})
    axes.annotate("", (1, 0.86), (len(rows) - 1, 0.86),
                  arrowprops={"arrowstyle": "->", "color": "#555", "connectionstyle": "bar,fraction=0.06"})
    axes.text((len(rows)) / 2, 1.02, "each step", ha="center", color="#555")
    axes.set_xlim(-0.5, len(rows) - 0.5)
    axes.set_ylim(0, 1.1)
    yield svg_of(figure)


def regions_plots(rows):
    """Figure 2: the tree of regions; a region is red with two objects or more, blue with one, and white without."""
    figure, axes = new_plot("Figure 2: regions of the broad phase; inner regions are grey", "", "level", height=3.4)
    places = {}
    levels = sorted({int(row["level"]) for row in rows})
    for level in levels:
        of_level = sorted((row for row in rows if int(row["level"]) == level), key=lambda row: int(row["number"]))
        for i, row in enumerate(of_level):
            x, y = (i + 0.5) / len(of_level), level
            places[int(row["number"])] = (x, y)
            parent = places.get((int(row["number"]) - 1) // 8) if level else None
            if parent:
                axes.plot([parent[0], x], [parent[1], y], color="#bbb", linewidth=0.7, zorder=1)
            count = int(row["objects"])
            color = "#cccccc" if row["leaf"] == "0" else "#cc3311" if count > 1 else COLORS[6] if count else "white"
            axes.plot(x, y, "s", color=color, markeredgecolor="#555", markersize=9 if level < 2 else 5, zorder=2)
            if row["leaf"] == "1" and count > 1:
                axes.annotate(str(count), (x, y), (0, -12), textcoords="offset points", ha="center", fontsize=7)
    axes.grid(visible=False)
    axes.set_xticks([])
    axes.set_yticks(levels)
    axes.set_ylim(max(levels) + 0.4, -0.4)
    yield svg_of(figure)


def descent_plots(rows):
    """Figure 4: the list of pairs by level, and the bound of the paper."""
    points = {"pairs of nodes that collide": [(int(row["level"]) + 1, int(row["pairs"])) for row in rows],
              "pairs of leaves": [(int(row["level"]) + 1, int(row["leaf_pairs"])) for row in rows if int(row["leaf_pairs"])],
              "the paper's at most 16 of each": [(int(row["level"]) + 1, 16 ** int(row["level"])) for row in rows
                                                 if int(row["level"]) < 3]}
    figure, axes = new_plot("Figure 4: the narrow phase, level by level", "level", "pairs")
    for (name, of_name), color in zip(points.items(), COLORS):
        axes.plot([x - 1 for x, _ in of_name], [y for _, y in of_name], marker="o", markersize=5, label=name, color=color,
                  linestyle="--" if "at most" in name else "-")
    axes.set_yscale("log")
    axes.set_xticks([int(row["level"]) for row in rows])
    yield svg_of(figure)


def clocks_plots(rows):
    """The ratio by each clock and in the paper, with standard errors."""
    clocks = (("simulated", "simulated time"), ("detection", "detection alone"), ("program", "whole program"), ("paper", "the paper"))
    for phase in ("broad", "narrow"):
        chosen = [row for row in rows if row["phase"] == phase]
        groups = {name: points for clock, name in clocks if (points := [
            (place, float(row[clock]), float(row[f"{clock}_error"] or 0)) for place, row in enumerate(chosen) if row[clock]])}
        if groups:
            yield point_plot(f"Spheres for each box, {phase} phase", "scene", "ratio of collisions", [row["scene"] for row in chosen],
                             groups, True)


def table1_plots(rows, means, seconds, suffix):
    """Our runs as points, and the paper's means with their standard errors, for each number of objects."""
    first_edges = {row["scene"]: row["edge"] for row in reversed(rows)}
    mixed = [row for row in rows if re.fullmatch(r"table1_\d+", row["scene"]) and row["edge"] == first_edges[row["scene"]]]
    sizes = sorted({int(row["objects"]) for row in mixed})
    for phase in ("broad", "narrow") if mixed else ():
        groups = {}
        for row in mixed:
            if not row["failure"]:
                groups.setdefault(f"{row['volume']}, ours", []).append(
                    (sizes.index(int(row["objects"])), 600 / seconds * int(row[phase])))
        for row in means:
            if row["phase"] == phase and row["paper_mean"]:
                groups.setdefault(f"{row['volume']}, the paper's", []).append(
                    (sizes.index(int(row["scene"].split("_")[1])), float(row["paper_mean"]), float(row["paper_error"])))
        yield point_plot(f"{phase.capitalize()} phase{suffix}", "objects", "collisions in ten minutes", sizes, groups, True)


# --- the report ---


def rows_of(folder, name):
    with open(folder / f"{name}.csv", encoding="utf-8", errors="replace", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def plots_of(folder, name, parameters):
    """The plots of a table."""
    if name == "table1_runs":
        return table1_plots(rows_of(folder, name), rows_of(folder, "table1_means"), float(parameters["--seconds"]), "")
    if name == "table1_program_runs":
        return table1_plots(rows_of(folder, name), rows_of(folder, "table1_program_means"),
                            float(parameters["--program-clock"]), ", by the clock of the program")
    plots = {"ablation": ablation_plots, "trials": trials_plots, "sensitivity": sensitivity_plots, "table1_clocks": clocks_plots,
             "figures_1": modules_plots, "figures_2": regions_plots, "figures_4": descent_plots,
             "scaling_broad_phase": broad_phase_plots, "scaling_vertices": vertices_plots, "arity_objects": arity_plots,
             "volumes": volumes_plots, "volumes_builds": volumes_plots}
    return plots[name](rows_of(folder, name)) if name in plots else ()


def is_number(text):
    return re.fullmatch(r"-?(\d[\d.e+-]*|inf|nan)|", text) is not None


def cell_of(text, digits):
    if text.isdigit():
        return f"{int(text):,}"
    return rounded(float(text), digits) if text and is_number(text) else text or "–"


def table_of(folder, described):
    rows = [list(row.values()) for row in rows_of(folder, described["name"])]
    texts = [i for i, cells in enumerate(zip(*rows)) if not all(map(is_number, cells))]
    digits = [column["digits"] for column in described["columns"]]
    return table([column["heading"] for column in described["columns"]],
                 [[cell_of(cell, digits[i]) for i, cell in enumerate(row)] for row in rows], texts, described["caption"])


def html_of_claim(claim):
    verdict = claim["verdict"].strip()
    kind = {"Holds.": "holds", "Does not hold.": "fails"}.get(verdict, "open")
    return (f'<div class="claim {kind}"><p>{escaped(claim["paper"])}</p>'
            f"<p><b>{verdict}</b> {escaped(claim['reason'])}</p></div>")


def html_of(folder, report):
    parts = [f"<p>{escaped(report['summary'])}</p>", *(["<h2>What holds</h2>"] if report["claims"] else [])]
    parts += map(html_of_claim, report["claims"])
    for section in report["sections"]:
        parts += [f"<h2>{escaped(section['heading'])}</h2>", *(f"<p>{escaped(text)}</p>" for text in section["paragraphs"])]
        for described in section["tables"]:
            parts += plots_of(folder, described["name"], report["parameters"])
        parts += [table_of(folder, described) for described in section["tables"]]
    parts += ["<h2>Parameters and machine</h2>", table([], (report["parameters"] | report["machine"]).items(), (0, 1))]
    return page(report["title"], parts)


def main():
    if len(sys.argv) != 2 or not (reports := list(pathlib.Path(sys.argv[1]).glob("*_report.json"))):
        stop("usage: supple-experiment-report FOLDER, where FOLDER has the files that `supple experiment` writes")
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        try_debians_python()
    try:
        for path in reports:
            report = json.loads(path.read_text(encoding="utf-8"))
            (path.parent / f"{report['name']}.html").write_text(html_of(path.parent, report), encoding="utf-8")
    except OSError as error:
        stop(f"supple: {error.filename}: cannot be read or written: {error.strerror}")


if __name__ == "__main__":
    main()
