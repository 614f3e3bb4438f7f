"""The paper's experiments: runs them with the program, and reads their tables."""

from __future__ import annotations

import csv
import os
import pathlib
import tempfile
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _program
from ._core import Error


class Experiment:
    """The results of an experiment: `tables` by name, each a dict of columns, and the `page` of the
    report."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = pathlib.Path(folder)
        files = sorted(self.folder.glob("*.csv"))
        if not files:
            raise Error(f"{self.folder}: has no tables (*.csv) of an experiment")
        self.tables = {path.stem: _read(path) for path in files}
        self.page = next(iter(sorted(self.folder.glob("*.html"))), None)

    def to_pandas(self) -> dict[str, Any]:
        """A pandas.DataFrame for each table."""
        import pandas

        return {name: pandas.DataFrame(columns) for name, columns in self.tables.items()}

    def __repr__(self) -> str:
        sizes = ", ".join(
            f"{name} ({len(next(iter(table.values()), ()))} rows)" for name, table in self.tables.items()
        )
        return f"<supple.Experiment {str(self.folder)!r}: {sizes}>"


def _read(path: pathlib.Path) -> dict[str, npt.NDArray[Any]]:
    with path.open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    if not rows:
        return {}
    return {
        name: _column([row[i] if i < len(row) else "" for row in rows[1:]]) for i, name in enumerate(rows[0])
    }


def _column(texts: list[str]) -> npt.NDArray[Any]:
    try:
        return np.array([float(text) if text else np.nan for text in texts])
    except ValueError:
        return np.array(texts)


def experiment(name: str, output: str | os.PathLike[str] | None = None, **options: Any) -> Experiment:
    """Runs an experiment of the paper: table1, scaling, arity, volumes, claims, ablation, trials, sensitivity or
    figures.

    Options are those of `supple experiment --help` with underscores: `experiment("table1", quick=True,
    objects=(3, 6))`. `output` is the folder of the tables and the page; without it, a temporary one. Needs
    the command line program. `Experiment(folder)` reads the tables of an earlier run.
    """
    folder = os.fspath(output) if output is not None else tempfile.mkdtemp(prefix="supple-")
    arguments = []
    for key, value in options.items():
        if value is False or value is None:
            continue
        arguments.append("--" + key.replace("_", "-"))
        if value is not True:
            arguments.append(",".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value))
    _program.run("experiment", name, "--output", folder, "--quiet", *arguments)
    return Experiment(folder)
