"""Recordings: HDF5 files of frames with all contacts, which ParaView and the viewer open, too."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Iterator, overload

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._contracts import contract
from ._generated import ElementPairKind, FeatureKind
from ._meshes import Mesh
from ._result import _Lists
from ._scene import Scene
from ._simulation import Simulation
from ._tables import table

if TYPE_CHECKING:
    from .typing import StepStats


class Frame(_Lists):
    """One frame of a recording: `time`, `stats`, `positions` and the lists of a `Result` but for groups."""

    def __init__(self, recording: Recording, number: int, facts: dict[str, Any]) -> None:
        self.number = number
        self.time: float = facts["time"]
        self.stats: StepStats = facts["stats"]
        self._recording = recording
        self._tables = {name: table(raw, recording._elements) for name, raw in facts["tables"].items()}

    @property
    def positions(self) -> list[npt.NDArray[np.float64]]:
        """The positions of each object, (n, 3), in the order of `Recording.objects`."""
        return [self._recording.positions(self.number, i) for i in range(len(self._recording.objects))]

    def _list(self, name: str) -> Any:
        return self._tables[name]

    def _names(self) -> list[str]:
        return list(self.__dict__.get("_tables", ()))

    def __repr__(self) -> str:
        return f"<supple.Frame {self.number} at {self.time:g} s: {self._summary()}>"


class RecordedObject:
    """An object of a recording: `index` in the results, `name` and `mesh` at rest."""

    def __init__(self, identifier: Any, name: str, positions: Any, triangles: Any) -> None:
        self.index = int(identifier.index)
        self.name = name
        self.mesh = Mesh(positions, triangles, name=name)

    def __repr__(self) -> str:
        return f"<supple.RecordedObject {self.index} {self.name!r}: {len(self.mesh.positions)} vertices>"


#: The kinds of both elements by the kind of their pair, as the names of the kinds say.
_PAIR_KINDS = np.array([[FeatureKind[part] for part in kind.name.split("_")] for kind in ElementPairKind])


class _Elements:
    """The vertices of the elements of a recording, as a scene knows those of its objects."""

    def __init__(self, objects: list[RecordedObject]) -> None:
        self._triangles = {each.index: np.asarray(each.mesh.triangles) for each in objects}

    def vertices_of(self, record: str, rows: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint32]:
        made = table((record, rows))
        if record == "Contact":
            kinds = np.full((len(made), 2), FeatureKind.face)
            elements = np.repeat(made["triangle"][:, :, None], 2, axis=2)
        else:
            kinds = made["kind"] if made["kind"].ndim == 2 else _PAIR_KINDS[made["kind"]]
            elements = made["element"]
        vertices = np.repeat(elements[:, :, :1], 3, axis=2)
        edges = kinds == FeatureKind.edge
        vertices[edges, 1] = elements[edges, 1]
        for index, triangles in self._triangles.items():
            faces = (kinds == FeatureKind.face) & (made["object"] == index)
            vertices[faces] = triangles[elements[faces, 0]]
        return vertices


class Recording:
    """A recording as a sequence of frames: `recording[3].contacts`, `for frame in recording`."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = _arrays.path(path, "open: the path")
        self._core = _core.Recording(self.path)
        self.objects = [RecordedObject(*each) for each in self._core.objects()]
        self._elements = _Elements(self.objects)

    @property
    def time_step(self) -> float:
        """The time from one frame to the next, in seconds."""
        return float(self._core.time_step())

    @property
    def scene_file(self) -> str:
        """The text of the simulated scene file; empty when there is none."""
        return str(self._core.scene_file())

    def positions(self, frame: int, object: int) -> npt.NDArray[np.float64]:
        """The positions of one object in a frame, (n, 3); `object` is its place in `objects`."""
        return self._core.positions(frame, object)

    def summary(self, frame: int) -> Frame:
        """As `recording[frame]`, but only time, events and statistics, in a fraction of the time."""
        return Frame(self, frame, self._core.summary(frame))

    def __len__(self) -> int:
        return int(self._core.frame_count())

    @overload
    def __getitem__(self, number: int) -> Frame: ...

    @overload
    def __getitem__(self, number: slice) -> list[Frame]: ...

    def __getitem__(self, number: Any) -> Any:
        if isinstance(number, slice):
            return [self[i] for i in range(*number.indices(len(self)))]
        at = number + len(self) if number < 0 else number
        if not 0 <= at < len(self):
            raise IndexError(f"{self.path} has {len(self)} frames; there is no frame {number}")
        return Frame(self, at, self._core.frame(at))

    def __iter__(self) -> Iterator[Frame]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        return f"<supple.Recording {self.path!r}: {len(self)} frames of {len(self.objects)} objects>"


def open(path: str | os.PathLike[str]) -> Recording:  # noqa: A001
    """Opens a recording (.h5) of the command line, of `record`, or of C++."""
    return Recording(path)


class Recorder(_arrays.NotCopied):
    """Writes the steps of a scene or a simulation, whose objects stay the same, as a recording.

    with supple.record("run.h5", simulation) as recorder:
        for result in simulation.run(100):
            recorder.add()
    """

    def __init__(
        self, path: str | os.PathLike[str], source: Scene | Simulation, time_step: float = 0.01
    ) -> None:
        name = _arrays.path(path, "record: the first argument, the path,")
        self._source = source
        self._objects: list[Any] = list(source.objects)
        self._time_step = source.time_step if isinstance(source, Simulation) else time_step
        self._frames = 0
        described = []
        for each in self._objects:
            mesh = (
                each.mesh
                if isinstance(source, Simulation)
                else Mesh(each.positions, each.triangles, name=each.name)
            )
            described.append((each._id, mesh._core, {"name": each.name}))
        self._core = _core.Recorder(name, described, self._time_step)

    @contract(
        "Recorder::add",
        "Adds the present positions and the last result; `time` is that of the simulation, or "
        "the number of frames times the time step.",
    )
    def add(self, time: float | None = None) -> None:
        if time is None:
            time = (
                self._source.time if isinstance(self._source, Simulation) else self._frames * self._time_step
            )
        positions = [_arrays.doubles(each.positions, "positions", -1, 3) for each in self._objects]
        self._core.add(time, positions, self._source.result._core)
        self._frames += 1

    @contract("Recorder::flush")
    def flush(self) -> None:
        self._core.flush()

    @contract("Recorder::close")
    def close(self) -> None:
        self._core.close()

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def record(path: str | os.PathLike[str], source: Scene | Simulation, time_step: float = 0.01) -> Recorder:
    """Begins a recording of a scene or a simulation; `time_step` is that of a scene."""
    return Recorder(path, source, time_step)


@contract("find_first_difference")
def find_first_difference(a: Recording, b: Recording, tolerance: float = 0) -> tuple[int | None, str] | None:
    return _core.find_first_difference(a._core, b._core, tolerance)
