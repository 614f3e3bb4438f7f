"""The paper's experiments: runs them with the program, and reads their tables."""

from __future__ import annotations

import csv
import dataclasses
import os
import pathlib
import tempfile
from typing import Any, Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from . import _program
from ._animation import Frames, Items
from ._core import Error, Stop
from ._frames import AnyExecutor, Progress, run


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


def experiments(
    name: str,
    parameters: Sequence[Mapping[str, Any]],
    executor: AnyExecutor | None = None,
    output: str | os.PathLike[str] | None = None,
    *,
    progress: Progress = False,
    stop: Stop | None = None,
    **options: Any,
) -> list[Experiment]:
    """Runs an experiment with each of several sets of options, on an executor as `map_frames` takes it, and
    returns the results in their order: `experiments("table1", [{"objects": 3}, {"objects": 6}], pool,
    quick=True)`.

    `options` are the same for all sets. Set i writes its tables to the folder i of `output`, or to a temporary
    folder of the machine that runs it; the tables are in the results, too. Each run is a task. Counts are equal
    to those of runs one after the other; times are not, because runs at the same time share memory and cores.
    `progress` and `stop` are those of `map_frames`. Raises `Error`, which names the set, when a run fails.
    """
    folder = None if output is None else os.path.abspath(output)
    sets = [
        ({**options, **each}, None if folder is None else os.path.join(folder, str(i)))
        for i, each in enumerate(parameters)
    ]
    frames = Items(sets, "parameter set")
    return run("experiments", _Runs(name), frames, executor, progress=progress, stop=stop, chunk=1)


@dataclasses.dataclass(frozen=True)
class _Runs:
    """Runs an experiment with each set of options."""

    name: str

    def __call__(self, frames: Frames) -> Iterator[Experiment]:
        return (experiment(self.name, output, **options) for options, output in frames)
