#!/usr/bin/env python3
"""Makes the page of a contest from its table: tables and plots in one HTML file without external resources.

usage: contest_report.py TABLE.csv [PAGE.html]

TABLE.csv is a file of benchmarks/results or the results.csv of a run. The page is build/contest/TABLE.html by default.
"""

import csv
import pathlib
import sys

from contest_targets import growth_points, judged

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "experiments"))
from judge.pages import bar_plot, line_plot, page, table  # noqa: E402
from judge.text import rounded  # noqa: E402

COLORS = {"Supple": "#0077bb", "Embree": "#ee7733", "CGAL": "#009988", "FCL": "#cc3311", "Bullet": "#9467bd",
          "ODE": "#b8860b", "baseline sweep": "#888888", "baseline grid": "#555577"}
STAGES = {"update": "#0077bb", "traversal": "#33aa77", "triangle tests": "#ee7733", "order and events": "#999999"}
REFIT = {"handing over": "#33aa77", "refit": "#0077bb"}
OTHER_COLOR = "#888888"

STYLE = ".aim { color: var(--holds); font-weight: 600; } .reach { color: #0a7bbd; } .missed { color: var(--fails); }"


def color_of(name):
    return COLORS.get(name.split(",")[0], OTHER_COLOR)


# --- sections ---


def rows_of_table(judge):
    """The results cell by cell, with a heading."""
    lines = [["workload", "cell", "against", "ratio", "reach", "aim", "met"]]
    for row in judge.rows:
        bound = "≤ " if row["smaller_is_better"] else "≥ "
        lines.append([row["row"], row["cell"], row["against"], f"{row['ratio']:.2f}", f"{bound}{row['reach']:g}",
                      f"{bound}{row['aim']:g}", row["met"]])
    return lines


def summary_table(rows):
    """One line per row of targets: the range over its cells, and how many cells meet the target."""
    groups = {}
    for row in rows:
        groups.setdefault(row["row"], []).append(row)
    lines = []
    for name, group in groups.items():
        bound = "≤ " if group[0]["smaller_is_better"] else "≥ "
        ratios = [row["ratio"] for row in group]
        met = [str(sum(row["met"] == word for row in group)) for word in ("aim", "reach", "missed")]
        lines.append([name, ", ".join(dict.fromkeys(row["against"] for row in group)), f"{min(ratios):.2f}",
                      f"{max(ratios):.2f}", f"{bound}{group[0]['reach']:g}", f"{bound}{group[0]['aim']:g}", ", ".join(met)])
    return table(["workload", "against", "lowest", "highest", "reach", "aim", "cells that reach the aim, reach, miss"], lines,
                 range(2))


def judgement_table(judge):
    heading, *lines = rows_of_table(judge)
    return table(heading, [[*line[:-1], (line[-1], line[-1])] for line in lines], range(3))


def times_table(cells):
    rows = []
    for cell in cells:
        for i, c in enumerate(cell["contestants"]):
            q1, median, q3 = c["cpu_ms"]
            rows.append([cell["cell"] if i == 0 else "", c["name"], rounded(median), f"{rounded(q1)} – {rounded(q3)}",
                         rounded(c["wall_ms"][1]), c["frames"], f"{c['pairs']:,}"])
        if cell["skipped"]:
            rows.append([cell["cell"], "left out: " + cell["skipped"], "", "", "", "", ""])
    return table(["cell", "contestant", "CPU ms", "quartiles", "wall ms", "frames", "pairs"], rows, range(2))


def values_table(cells):
    rows = [[cell["cell"], name, rounded(value)] for cell in cells for name, value in cell["values"].items()
            if name != "triangles" or not cell["contestants"]]
    return table(["cell", "what", "value"], rows, range(2)) if rows else ""


def box_plots(cells):
    drawings = []
    for field in ("u1", "u8", "clu", "cl8"):
        series = {}
        for cell in cells:
            parts = cell["cell"].split("/")
            if parts[:2] == ["A", field] and len(parts) == 3:
                for c in cell["contestants"]:
                    series.setdefault(c["name"], []).append((int(parts[2]), c["cpu_ms"][1]))
        if any(len(points) > 1 for points in series.values()):
            curves = {name: sorted(points) for name, points in series.items()}
            drawings.append(line_plot(f"A, {field}: one frame", "boxes", "milliseconds of processor time", curves,
                                      colors={name: color_of(name) for name in curves}))
    return drawings


def stage_bars(cell):
    """The bars of the contestants that measure their stages."""
    bars = []
    for c in cell["contestants"]:
        median, measured = c["cpu_ms"][1], c["stage_ms"]
        stages = [(name, color, measured.get(name, 0)) for name, color in STAGES.items()]
        if cell["cell"].startswith("limits/") and measured:
            refit = measured["refit alone"]
            stages = [(name, color, value) for (name, color), value in
                      zip(REFIT.items(), (measured["update"] - refit, refit))]
        total = sum(value for _, _, value in stages)
        bars.append((c["name"], [(name, color, value / total * median) for name, color, value in stages if value]
                     if total else [("", OTHER_COLOR, median)]))
    return bars


def growth_plot(series):
    first = series[0][1]
    linear = [first[0], (first[-1][0], first[0][1] * first[-1][0] / first[0][0])]
    return line_plot("Growth of Supple's frame", "objects or triangles", "milliseconds of processor time",
                     {**dict(series), "linear": linear}, dashed=["linear"])


def bars_of(cells, prefix, title):
    return [bar_plot(title + cell["cell"].removeprefix(prefix), "milliseconds of processor time per frame", stage_bars(cell))
            for cell in cells if cell["cell"].startswith(prefix) and cell["contestants"]]


def html_of(about, cells):
    """The complete page."""
    judge = judged(cells)
    growth = growth_points(judge)
    parts = [table(["this run", ""], about.items(), range(2)), "<h2>Targets and results</h2>",
              "<p>Ratios of medians in this run. Where the bound is ≥, the ratio is how many times faster Supple is than "
              "the best other contestant of the cell. docs/performance.md explains the workloads and the words.</p>",
              summary_table(judge.rows), "<h2>Cell by cell</h2>", judgement_table(judge)]
    parts += ["<h2>Boxes</h2>", *box_plots(cells)]
    parts += ["<h2>Deforming objects</h2>", *bars_of(cells, "B/", "B, ")]
    parts += ["<h2>Cloth</h2><p>Supple's time includes exact verdicts, that of the others only candidates.</p>",
              *bars_of(cells, "C/", "C, ")]
    parts += ["<h2>Proximity</h2><p>Supple finds features with points and normals, Embree's user distances.</p>",
              *bars_of(cells, "P/", "P, ")]
    if growth:
        parts += ["<h2>Growth</h2>", growth_plot(growth)]
    parts += bars_of(cells, "limits/refit/", "Refit, triangles: ")
    parts += ["<h2>All times</h2>", times_table(cells), values_table(cells)]
    return page("Supple against others", parts, STYLE)


# --- the table ---


TIMES = ["cpu_ms_q1", "cpu_ms_median", "cpu_ms_q3", "wall_ms_q1", "wall_ms_median", "wall_ms_q3"]
COLUMNS = ["cell", "name", "value", "threads", "pairs", "frames", *TIMES, "stage_ms"]


def write_csv(path, about, cells):
    """Writes the description of a run as comments, then a row per value and per contestant of each cell."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        file.writelines(f"# {name}: {value}\n" for name, value in about.items())
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for cell in cells:
            values = cell["values"] | ({"left out": cell["skipped"]} if cell["skipped"] else {})
            for name, value in values.items():
                text = value if name == "left out" else f"{value:.6g}"
                writer.writerow({"cell": cell["cell"], "name": name, "value": text})
            for c in cell["contestants"]:
                times = (f"{time:.5g}" for time in (*c["cpu_ms"], *c["wall_ms"]))
                stages = "; ".join(f"{name}: {ms:.4g}" for name, ms in c["stage_ms"].items())
                writer.writerow({"cell": cell["cell"], "name": c["name"], "threads": c["threads"], "pairs": c["pairs"],
                                 "frames": c["frames"], "stage_ms": stages} | dict(zip(TIMES, times)))


def read_csv(path):
    """The description of a run and its cells."""
    lines = pathlib.Path(path).read_text(encoding="utf-8").splitlines()
    head = [line for line in lines if line.startswith("# ")]
    about = dict(line[2:].split(": ", 1) for line in head)
    cells = {}
    for row in csv.DictReader(lines[len(head):]):
        cell = cells.setdefault(row["cell"], {"cell": row["cell"], "skipped": None, "values": {}, "contestants": []})
        if row["name"] == "left out":
            cell["skipped"] = row["value"]
        elif row["value"]:
            cell["values"][row["name"]] = float(row["value"])
        else:
            times = [float(row[name]) for name in TIMES]
            stages = dict(stage.split(": ") for stage in row["stage_ms"].split("; ") if stage)
            cell["contestants"].append({
                "name": row["name"], "threads": int(row["threads"]), "pairs": int(row["pairs"]), "frames": int(row["frames"]),
                "cpu_ms": times[:3], "wall_ms": times[3:], "stage_ms": {name: float(ms) for name, ms in stages.items()}})
    return about, list(cells.values())


def main():
    if len(sys.argv) not in (2, 3) or not pathlib.Path(sys.argv[1]).is_file():
        sys.exit("usage: contest_report.py TABLE.csv [PAGE.html], where TABLE.csv is a file of benchmarks/results")
    table_path = pathlib.Path(sys.argv[1])
    folder = pathlib.Path(__file__).resolve().parent.parent / "build/contest"
    page = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else folder / (table_path.name.removesuffix(".csv") + ".html")
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text(html_of(*read_csv(table_path)), encoding="utf-8")
    print(f"Written: {page}")


if __name__ == "__main__":
    main()
