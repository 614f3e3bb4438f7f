#!/usr/bin/env python3
"""Writes docs/paper.md and two pages of experiments from their templates and the tables in benchmarks/results/paper.

usage: make_paper.py [--check]

With --check it writes nothing and fails when a page is out of date, so each number on these pages is that of a
committed table. The templates are Jinja2; they have these functions:

  verdict(ID, EXPECTED)        the verdict on a claim with its number; fails if EXPECTED is given and differs
  number(ID)                   only the number and its interval
  reason(ID)                   what was measured
  rows(FILE)                   all rows, whose numbers range_of(row, COLUMN) and short(text) write
  runs(FILE)                   the number of runs with different seeds
  strain(FILE, COLUMN)         the least and the greatest of a column, in percent
  commit(FILE), command(FILE), machine(FILE)   from the head of FILE.csv
  claims_table()               all claims of the paper in its order
"""

import csv
import pathlib
import re
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
RESULTS = ROOT / "benchmarks/results/paper"
PAGES = {"docs/paper.md": "paper.md", "experiments/ELEMENTS.md": "elements.md", "experiments/RESULTS.md": "results.md"}  # and their templates
COLUMNS = 110

sys.path.insert(0, str(ROOT / "experiments"))
from report import rounded, try_debians_python  # noqa: E402

try:
    import jinja2
except ImportError:
    try_debians_python()
    raise


def read(path):
    """The comments at the head and the rows of a table."""
    lines = path.read_text(encoding="utf-8").splitlines()
    head = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
    return head, list(csv.DictReader(line for line in lines if not line.startswith("#")))


class Results:
    def __init__(self, folder):
        self.folder = folder
        self.tables = {}
        self.claims = {}
        for path in sorted(folder.glob("*/*_claims.csv")):
            head, rows = read(path)
            for row in rows:
                # table1_program repeats the claims of table1 with fewer runs.
                if row["id"] not in self.claims or path.parent.name == "table1":
                    self.claims[row["id"]] = row | {"command": re.sub(" --(quiet|resume|output [^ ]*)", "", head["command"])}

    def table(self, file):
        if file not in self.tables:
            self.tables[file] = read(self.folder / f"{file}.csv")
        return self.tables[file]

    def claim(self, name):
        if name not in self.claims:
            raise KeyError(f"no table of claims in {self.folder} has the claim {name}")
        return self.claims[name]

    def number(self, name):
        claim = self.claim(name)
        return interval_of(claim["number"], claim["error"])

    def verdict(self, name, expected=None):
        claim = self.claim(name)
        if expected not in (None, claim["verdict"]):
            raise ValueError(f"the template expects of {name}: {expected}; the tables say: {claim['verdict']}")
        number = f" ({claim['quantity']}: {self.number(name)})" if claim["number"] else ""
        return f"**{claim['verdict']}**{number}."

    def reason(self, name):
        return self.claim(name)["reason"]

    def claims_table(self):
        lines = ["| Claim | Where | Verdict | Number [interval] | Command |", "| --- | --- | --- | --- | --- |"]
        for claim in sorted(self.claims.values(), key=lambda claim: (claim["where"] or "9", claim["id"])):
            text = claim["claim"].replace("|", "\\|")
            number = f"{interval_of(claim['number'], claim['error'])}, {claim['quantity']}" if claim["number"] else ""
            lines.append(f"| {text} | {claim['where'] or 'ours'} | {claim['verdict']} | {number} | `{claim['command']}` |")
        return "\n".join(lines)

    def strain(self, file, column):
        numbers = [100 * float(row[column]) for row in self.table(file)[1]]
        return f"{rounded(min(numbers), 2)} to {rounded(max(numbers), 2)} %"

    def functions(self):
        names = ("verdict", "number", "reason", "claims_table", "strain")
        return {name: getattr(self, name) for name in names} | {
            "range_of": lambda row, column: interval_of(row[column], row[f"{column}_error"]),
            "short": lambda text: rounded(float(text)),
            "commit": lambda file: self.table(file)[0]["commit"],
            "command": lambda file: self.table(file)[0]["command"],
            "machine": lambda file: self.table(file)[0]["processor"],
            "holds": "Holds", "fails": "Does not hold",
            "rows": lambda file: self.table(file)[1],
            "runs": lambda file: len({row["seed"] for row in self.table(file)[1]}),
        }


def interval_of(number, error, digits=3):
    if not number:
        return "–"
    value = float(number)
    if not error:  # counted, not measured
        return f"{value:,.0f}" if value == int(value) else rounded(value, digits)
    low, high = value - 2 * float(error), value + 2 * float(error)
    return f"{rounded(value, digits)} [{rounded(low, digits)}, {rounded(high, digits)}]"


def wrapped(page):
    """The page with its paragraphs in lines of at most 110 columns."""
    parts = []
    for part in re.split(r"\n\n+", page.strip()):
        if not part.startswith(("|", "#", "```", "<", "- ", "![")):
            part = textwrap.fill(" ".join(part.split()), COLUMNS, break_long_words=False, break_on_hyphens=False)
        elif part.startswith("- "):
            part = "\n".join(textwrap.fill(" ".join(item.split()), COLUMNS, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)
                             for item in re.split(r"\n(?=- )", part))
        parts.append(part)
    return "\n\n".join(parts) + "\n"


def pages(results=RESULTS):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(ROOT / "experiments/templates"), undefined=jinja2.StrictUndefined,
                                     keep_trailing_newline=True, trim_blocks=True, lstrip_blocks=True)
    functions = Results(results).functions()
    return {page: wrapped(environment.get_template(name).render(functions)) for page, name in PAGES.items()}


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__)
    stale = []
    for name, text in pages().items():
        path = ROOT / name
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        stale.append(name)
        if not check:
            path.write_text(text, encoding="utf-8")
    if check and stale:
        sys.exit(f"{', '.join(stale)}: not what tools/make_paper.py makes of experiments/templates and the results; run it")


if __name__ == "__main__":
    main()
