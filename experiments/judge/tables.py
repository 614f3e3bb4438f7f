"""The CSV files of the experiments."""

import csv
import pathlib


class MissingTable(LookupError):
    """An experiment that has not run."""


class Tables:
    """The tables of some folders, by name; those of one name are one. A number in a field is a number here, an empty
    field None."""

    def __init__(self, *folders):
        self.paths = {}
        for folder in folders:
            for path in sorted(pathlib.Path(folder).glob("*.csv")):
                self.paths.setdefault(path.stem, []).append(path)
        self.read = {}

    def __contains__(self, name):
        return name in self.paths

    def _load(self, name):
        if name not in self.paths:
            raise MissingTable(name)
        if name not in self.read:
            head, rows = {}, []
            for path in self.paths[name]:
                lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
                head = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# ")) | head
                rows += [{column: value_of(text) for column, text in row.items()}
                         for row in csv.DictReader(line for line in lines if not line.startswith("#"))]
            self.read[name] = head, rows
        return self.read[name]

    def head(self, name):
        """The comments of the first file: date, commit, processor, compiler, command, parameters of the experiment."""
        return self._load(name)[0]

    def rows(self, name, **wanted):
        """The rows that have these values. Raises MissingTable without such a table."""
        return [row for row in self._load(name)[1] if all(row[column] == value for column, value in wanted.items())]

    def column(self, name, column, **wanted):
        return [row[column] for row in self.rows(name, **wanted)]

    def by(self, name, key, column, **wanted):
        """The values of a column for each value of another, in their order."""
        found = {}
        for row in self.rows(name, **wanted):
            found.setdefault(row[key], []).append(row[column])
        return found


def value_of(text):
    if not text:
        return None
    try:
        return float(text)
    except ValueError:
        return text
