#!/usr/bin/env python3
"""Judges the tables in benchmarks/results/paper and writes docs/what_holds.md and two pages of experiments from
their templates.

usage: make_paper.py [--check]

With --check it writes nothing and fails when a page is out of date, so each number on these pages is that of a
committed table. Otherwise it also draws docs/images/what_holds.svg. The templates are Jinja2; they have these
functions:

  verdict(NAME)           the verdict on a claim, with its numbers when these are few
  word(NAME)              only the verdict
  number(NAME, CASE, OUTCOME, INVERSE)  the number of a claim in a case, or 1 divided by it, and its interval; fails if
                          OUTCOME is given, "holds", "fails" or "undecided", and the tables decide otherwise
  listing(TABLE)          a table of judge/report.py: rates, ratios, averages, strains or changes
  head(TABLE, KEY)        from the comments of TABLE.csv: commit, processor, command
  claims_table()          all claims of the paper in its order, then our own
"""

import pathlib
import re
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
RESULTS = ROOT / "benchmarks/results/paper"
PAGES = {"docs/what_holds.md": "what_holds.md", "experiments/ELEMENTS.md": "elements.md", "experiments/RESULTS.md": "results.md"}  # and their templates
FIGURE = ROOT / "docs/images/what_holds.svg"
COLUMNS = 110
FEW = 2

sys.path.insert(0, str(ROOT / "experiments"))
from judge.pages import try_debians_python  # noqa: E402

try:
    import jinja2

    from judge import report, verdicts
    from judge.tables import Tables
    from judge.text import rounded
except ImportError:
    try_debians_python()
    raise


class Results:
    def __init__(self, folder):
        self.tables = Tables(*sorted(path for path in folder.iterdir() if path.is_dir()))
        self.names = {claim.name for claim, _ in verdicts.CLAIMS}
        self.claims = {claim.name: claim for claim in verdicts.judged(self.tables)}

    def verdict(self, name):
        if name not in self.claims and name in self.names:
            return f"{self.word(name)}: the committed tables do not decide it."
        claim = self.claims[name]
        return f"**{claim.verdict}**" + (f": {claim.quantity} {claim.numbers}." if len(claim.tests) <= FEW else ".")

    def word(self, name):
        return f"**{self.claims[name].verdict}**" if name in self.claims else "**Not measured**"

    def number(self, name, case="", outcome="", inverse=False):
        found = [test for test in self.claims[name].tests if test.when == case]
        if not found:
            raise KeyError(f"{name} has no case {case!r}, but {[test.when for test in self.claims[name].tests]}")
        if outcome and any(test.outcome() != {"holds": True, "fails": False, "undecided": None}[outcome] for test in found):
            raise ValueError(f"the template says {outcome!r} of {name} in the case {case!r}; the tables decide otherwise")
        number, (low, high) = found[0].number, found[0].number.interval(found[0].level)
        mean, low, high = (1 / number.mean, 1 / high, 1 / low) if inverse else (number.mean, low, high)
        return rounded(mean) + (f" ({rounded(low)} to {rounded(high)})" if number.error else "")

    def listing(self, name):
        heading, rows, _, _ = getattr(report, name)(self.tables)
        return markdown(heading, rows)

    def claims_table(self):
        in_order = sorted(self.claims.values(), key=lambda claim: [float(part) for part in (claim.where or "99").split(", ")])
        return markdown(["Claim", "Section, paragraph", "Read as", "Verdict", "Number [interval]"],
                        [[claim.text, claim.where or "ours", claim.reading, claim.verdict, f"{claim.quantity}: {claim.numbers}"] for claim in in_order])

    def functions(self):
        return {name: getattr(self, name) for name in ("verdict", "word", "number", "listing", "claims_table")} | {
            "head": lambda name, key: self.tables.head(name)[key]}


def markdown(heading, rows):
    def line(cells):
        return f"| {' | '.join(str(cell).replace('|', chr(92) + '|') for cell in cells)} |"

    return "\n".join([line(heading), line(["---"] * len(heading)), *map(line, rows)])


def wrapped(page):
    """The page with its paragraphs in lines of at most 110 columns."""
    parts = []
    for part in re.split(r"\n\n+", page.strip()):
        if not part.startswith(("|", "#", "```", "<", "- ", "1. ", "![")):
            part = textwrap.fill(" ".join(part.split()), COLUMNS, break_long_words=False, break_on_hyphens=False)
        elif part.startswith(("- ", "1. ")):
            part = "\n".join(textwrap.fill(" ".join(item.split()), COLUMNS, subsequent_indent=" " * (item.index(" ") + 1), break_long_words=False,
                                           break_on_hyphens=False) for item in re.split(r"\n(?=- |\d\. )", part))
        parts.append(part)
    return "\n\n".join(parts) + "\n"


def pages(results):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(ROOT / "experiments/templates"), undefined=jinja2.StrictUndefined,
                                     keep_trailing_newline=True, trim_blocks=True, lstrip_blocks=True)
    return {page: wrapped(environment.get_template(name).render(results.functions())) for page, name in PAGES.items()}


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__)
    results = Results(RESULTS)
    stale = []
    for name, text in pages(results).items():
        path = ROOT / name
        if path.exists() and path.read_text(encoding="utf-8") == text:
            continue
        stale.append(name)
        if not check:
            path.write_text(text, encoding="utf-8")
    if check and stale:
        sys.exit(f"{', '.join(stale)}: not what tools/make_paper.py makes of experiments/templates and the results; run it")
    if not check:
        report.draw_what_holds(results.tables, results.claims, FIGURE)


if __name__ == "__main__":
    main()
