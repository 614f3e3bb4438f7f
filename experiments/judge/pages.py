"""HTML pages with tables and plots, without external resources. benchmarks/contest_report.py uses them, too."""

import html
import io
import itertools
import os
import pathlib
import re
import sys

from judge.text import rounded

# Distinguishable on white, also for most people with colour vision deficiency.
COLORS = ["#0077bb", "#ee7733", "#009988", "#cc3311", "#9467bd", "#888888", "#33bbee", "#ee3377", "#999933", "#222222", "#44bb99"]
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
        stop("supple: plots need matplotlib for python3; install it, on Debian by: apt-get install python3-matplotlib")
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
        numbers = [point[1] for points in groups.values() for point in points if point[1] > 0] or [1]
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
