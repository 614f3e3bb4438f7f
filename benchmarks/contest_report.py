#!/usr/bin/env python3
"""Makes the page of a contest from its table: tables and plots in one HTML file without external resources.

usage: contest_report.py TABLE.csv [PAGE.html]

TABLE.csv is a file of benchmarks/results or the results.csv of a run. The page is build/contest/TABLE.html by default.
"""

import csv
import html
import math
import pathlib
import sys

from contest_targets import growth_points, judged

# Distinguishable on white and on black, and for most people with colour vision deficiency.
COLORS = {"Supple": "#0077bb", "Embree": "#ee7733", "CGAL": "#009988", "FCL": "#cc3311", "Bullet": "#9467bd",
          "ODE": "#b8860b", "baseline sweep": "#888888", "baseline grid": "#555577"}
STAGES = {"update": "#0077bb", "traversal": "#33aa77", "triangle tests": "#ee7733", "order and events": "#999999"}
REFIT = {"handing over": "#33aa77", "refit": "#0077bb"}
OTHER_COLOR = "#888888"

STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; max-width: 68rem; margin: 2rem auto; padding: 0 1rem;
  color: #1a1a1a; background: #fff; }
table { border-collapse: collapse; margin: 0.6rem 0 1.4rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.18rem 0.7rem 0.18rem 0; text-align: right; border-bottom: 1px solid #8884; white-space: nowrap; }
th:first-child, td:first-child, td.text, th.text { text-align: left; }
.aim { color: #00705a; font-weight: 600; } .reach { color: #0064a0; } .missed { color: #b32400; }
td.text { white-space: normal; }
svg { display: block; max-width: 100%; height: auto; margin: 0.8rem 0; }
svg text { font: 12px system-ui, sans-serif; fill: currentColor; } svg .title { font-size: 14px; font-weight: 600; }
@media (prefers-color-scheme: dark) {
  body { color: #e4e4e4; background: #181818; } .aim { color: #4fd0b0; } .reach { color: #6ab7ee; }
  .missed { color: #ff8a66; }
}
"""


def color_of(name):
    return COLORS.get(name.split(",")[0], OTHER_COLOR)


def rounded(value):
    """Three significant digits with grouped thousands."""
    if value == 0:
        return "0"
    digits = 2 - math.floor(math.log10(abs(value)))
    return f"{round(value, digits):,.{max(digits, 0)}f}"


def escaped(text):
    return html.escape(str(text))


# --- drawing ---


def svg(width, height, title, body):
    return (f'<svg viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img">'
            f'<text class="title" x="0" y="16">{escaped(title)}</text>{body}</svg>')


def text(x, y, words, anchor="start"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escaped(words)}</text>'


def log_ticks(low, high):
    """Powers of ten in the range, also times 2 and 5 if the range is small."""
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    steps = (1,) if last - first > 3 else (1, 2, 5)
    ticks = [step * 10.0**power for power in range(first, last + 1) for step in steps]
    return [tick for tick in ticks if low <= tick <= high]


def short(value):
    for limit, suffix in ((1e6, " M"), (1e3, " k")):
        if value >= limit:
            return f"{value / limit:g}{suffix}"
    return f"{value:g}"


def line_plot(title, x_label, y_label, series):
    """Draws logarithmic axes; series are (name, color, dashed, [(x, y)...])."""
    width, height, left, top, right, bottom = 800, 390, 62, 46, 210, 44
    xs = [x for _, _, _, points in series for x, _ in points]
    ys = [y for _, _, _, points in series for _, y in points]
    low_x, high_x = min(xs) / 1.2, max(xs) * 1.2
    low_y, high_y = min(ys) / 1.5, max(ys) * 1.5
    at_x = lambda x: left + (width - left - right) * math.log(x / low_x) / math.log(high_x / low_x)
    at_y = lambda y: height - bottom - (height - top - bottom) * math.log(y / low_y) / math.log(high_y / low_y)
    body = ""
    for tick in log_ticks(low_y, high_y):
        body += (f'<line x1="{left}" x2="{width - right}" y1="{at_y(tick):.1f}" y2="{at_y(tick):.1f}" '
                 f'stroke="#8885" stroke-width="0.6"/>' + text(left - 6, at_y(tick) + 4, short(tick), "end"))
    for tick in log_ticks(low_x, high_x):
        body += (f'<line y1="{top}" y2="{height - bottom}" x1="{at_x(tick):.1f}" x2="{at_x(tick):.1f}" '
                 f'stroke="#8885" stroke-width="0.6"/>' + text(at_x(tick), height - bottom + 16, short(tick), "middle"))
    body += text((left + width - right) / 2, height - 6, x_label, "middle") + text(left, top - 8, y_label, "end")
    for number, (name, color, dashed, points) in enumerate(series):
        path = " ".join(f"{at_x(x):.1f},{at_y(y):.1f}" for x, y in points)
        dash = ' stroke-dasharray="5 4"' if dashed else ""
        body += f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="2"{dash}/>'
        if not dashed:
            body += "".join(f'<circle cx="{at_x(x):.1f}" cy="{at_y(y):.1f}" r="3" fill="{color}"/>' for x, y in points)
        y = top + 14 + 18 * number
        body += (f'<line x1="{width - right + 12}" x2="{width - right + 34}" y1="{y - 4}" y2="{y - 4}" '
                 f'stroke="{color}" stroke-width="2.5"{dash}/>' + text(width - right + 40, y, name))
    return svg(width, height, title, body)


def bar_plot(title, bars):
    """Draws bars (name, [(part, color, value)...]); parts are stacked, with a legend if there are several."""
    left, right, width = 150, 80, 760
    height = 30 + 22 * len(bars) + 26
    largest = max(sum(value for _, _, value in parts) for _, parts in bars)
    scale = (width - left - right) / largest
    body, named = "", {}
    for number, (name, parts) in enumerate(bars):
        y, x = 30 + 22 * number, left
        body += text(left - 8, y + 13, name, "end")
        for part, color, value in parts:
            body += f'<rect x="{x:.1f}" y="{y}" width="{value * scale:.1f}" height="16" fill="{color}"/>'
            x += value * scale
            if part:
                named[part] = color
        body += text(x + 6, y + 13, rounded(sum(value for _, _, value in parts)))
    x = left
    for part, color in named.items():
        y = 30 + 22 * len(bars) + 6
        body += f'<rect x="{x}" y="{y}" width="12" height="12" fill="{color}"/>' + text(x + 17, y + 10, part)
        x += 40 + 7 * len(part)
    return svg(width, height, title, body)


# --- sections ---


def table(heading, rows, text_columns=1):
    """Makes a table; cells may be (text, class)."""
    def cell(tag, value, column):
        words, name = value if isinstance(value, tuple) else (value, "")
        classes = " ".join(filter(None, [name, "text" if column < text_columns else ""]))
        return f'<{tag}{f" class={chr(34)}{classes}{chr(34)}" if classes else ""}>{escaped(words)}</{tag}>'

    lines = ["<table>", "<tr>" + "".join(cell("th", name, i) for i, name in enumerate(heading)) + "</tr>"]
    lines += ["<tr>" + "".join(cell("td", value, i) for i, value in enumerate(row)) + "</tr>" for row in rows]
    return "\n".join(lines + ["</table>"])


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
                 2)


def judgement_table(judge):
    heading, *lines = rows_of_table(judge)
    return table(heading, [[*line[:-1], (line[-1], line[-1])] for line in lines], 3)


def times_table(cells):
    rows = []
    for cell in cells:
        for i, c in enumerate(cell["contestants"]):
            q1, median, q3 = c["cpu_ms"]
            rows.append([cell["cell"] if i == 0 else "", c["name"], rounded(median), f"{rounded(q1)} – {rounded(q3)}",
                         rounded(c["wall_ms"][1]), c["frames"], f"{c['pairs']:,}"])
        if cell["skipped"]:
            rows.append([cell["cell"], "left out: " + cell["skipped"], "", "", "", "", ""])
    return table(["cell", "contestant", "CPU ms", "quartiles", "wall ms", "frames", "pairs"], rows, 2)


def values_table(cells):
    rows = [[cell["cell"], name, rounded(value)] for cell in cells for name, value in cell["values"].items()
            if name != "triangles" or not cell["contestants"]]
    return table(["cell", "what", "value"], rows, 2) if rows else ""


def box_plots(cells):
    drawings = []
    for field in ("u1", "u8", "clu", "cl8"):
        series = {}
        for cell in cells:
            parts = cell["cell"].split("/")
            if parts[:2] == ["A", field] and len(parts) == 3:
                for c in cell["contestants"]:
                    series.setdefault(c["name"], []).append((int(parts[2]), c["cpu_ms"][1]))
        lines = [(name, color_of(name), False, sorted(points)) for name, points in series.items()]
        if any(len(points) > 1 for _, _, _, points in lines):
            drawings.append(line_plot(f"A, {field}: one frame", "boxes", "ms", lines))
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
    palette = ["#0077bb", "#ee7733", "#009988", "#cc3311", "#9467bd"]
    lines = [(name, palette[i % len(palette)], False, points) for i, (name, points) in enumerate(series)]
    first = series[0][1]
    lines.append(("linear", OTHER_COLOR, True, [first[0], (first[-1][0], first[0][1] * first[-1][0] / first[0][0])]))
    return line_plot("Growth of Supple's frame", "objects or triangles", "ms", lines)


def bars_of(cells, prefix, title):
    return [bar_plot(f"{title}{cell['cell'].removeprefix(prefix)}: ms of processor time per frame", stage_bars(cell))
            for cell in cells if cell["cell"].startswith(prefix) and cell["contestants"]]


def html_of(about, cells):
    """The complete page."""
    judge = judged(cells)
    growth = growth_points(judge)
    parts = ["<h1>Supple against others</h1>", table(["this run", ""], list(about.items()), 2)]
    parts += ["<h2>Targets and results</h2>",
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
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"/><title>Supple against others</title>'
            f"<style>{STYLE}</style></head><body>\n" + "\n".join(parts) + "\n</body></html>\n")


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
