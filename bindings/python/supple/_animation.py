"""Where frames come from, described so that another process can open them itself."""

from __future__ import annotations

import dataclasses
import glob
import os
import re
from typing import Any, Iterator, NamedTuple, Sequence

import numpy as np

from . import _arrays
from ._core import Error
from ._meshes import Mesh, as_mesh
from ._recording import Recording


class Animation(NamedTuple):
    """Meshes with fixed triangles: names, triangles and the positions of frame 0 of each mesh, then the
    positions of the frames."""

    names: list[str]
    triangles: list[Any]
    first: list[Any]
    frames: Iterator[list[Any]]


class Frames:
    """Numbered frames. A part of them is pickled into a task, which opens it where it runs: files stay names."""

    name: str

    def __len__(self) -> int:
        raise NotImplementedError

    def label(self, frame: int) -> str:
        """A frame as messages name it."""
        return f"frame {frame} of {self.name}"

    def part(self, start: int, stop: int) -> Frames:
        """The frames from `start` to before `stop`."""
        raise NotImplementedError

    def __iter__(self) -> Iterator[Any]:
        """The frames as `map_frames` gives them to a function."""
        raise NotImplementedError

    def open(self) -> Animation:
        """The frames as `check` reads them."""
        raise NotImplementedError


@dataclasses.dataclass(frozen=True)
class Items(Frames):
    """The items of a sequence."""

    items: Sequence[Any]
    word: str = "frame"

    def __len__(self) -> int:
        return len(self.items)

    def label(self, frame: int) -> str:
        return f"{self.word} {frame}"

    def part(self, start: int, stop: int) -> Frames:
        return Items([self.items[i] for i in range(start, stop)])

    def __iter__(self) -> Iterator[Any]:
        return (self.items[i] for i in range(len(self.items)))


@dataclasses.dataclass(frozen=True)
class ArrayFrames(Frames):
    """Positions in memory, for each mesh one array (frames, n, 3) or a list of arrays (n, 3)."""

    name: str
    names: list[str]
    arrays: list[Any]
    faces: list[Any]
    first: list[Any]

    def __len__(self) -> int:
        return len(self.arrays[0]) if self.arrays else 0

    def part(self, start: int, stop: int) -> Frames:
        return dataclasses.replace(self, arrays=[each[start:stop] for each in self.arrays])

    def open(self) -> Animation:
        frames = ([each[i] for each in self.arrays] for i in range(len(self)))
        return Animation(self.names, self.faces, self.first, frames)


@dataclasses.dataclass(frozen=True)
class MeshFiles(Frames):
    """Mesh files, one for each frame."""

    name: str
    files: list[str]
    first: str

    def __len__(self) -> int:
        return len(self.files)

    def label(self, frame: int) -> str:
        return f"frame {frame} ({self.files[frame]})"

    def part(self, start: int, stop: int) -> Frames:
        return dataclasses.replace(self, files=self.files[start:stop])

    def __iter__(self) -> Iterator[Mesh]:
        return map(as_mesh, self.files)

    def open(self) -> Animation:
        first = as_mesh(self.first)
        return Animation([first.name], [first.triangles], [first.positions], self._positions(first))

    def _positions(self, first: Mesh) -> Iterator[list[Any]]:
        for file in self.files:
            mesh = as_mesh(file)
            if not np.array_equal(mesh.triangles, first.triangles):
                raise Error(f"{file} has other triangles than {self.first}; all frames need one topology")
            yield [mesh.positions]


@dataclasses.dataclass(frozen=True)
class RecordingFrames(Frames):
    """Frames of a recording."""

    name: str
    path: str
    numbers: range

    def __len__(self) -> int:
        return len(self.numbers)

    def part(self, start: int, stop: int) -> Frames:
        return dataclasses.replace(self, numbers=self.numbers[start:stop])

    def __iter__(self) -> Iterator[Any]:
        recording = Recording(self.path)
        return (recording[number] for number in self.numbers)

    def open(self) -> Animation:
        recording = Recording(self.path)
        objects = recording.objects
        places = range(len(objects))
        return Animation(
            [each.name for each in objects],
            [each.mesh.triangles for each in objects],
            [recording.positions(0, each) for each in places] if len(recording) else [],
            ([recording.positions(number, each) for each in places] for number in self.numbers),
        )


@dataclasses.dataclass(frozen=True)
class UsdFrames(Frames):
    """Time codes of a USD file."""

    name: str
    path: str
    codes: list[float]
    start: float

    def __len__(self) -> int:
        return len(self.codes)

    def label(self, frame: int) -> str:
        return f"frame {frame} (time code {self.codes[frame]:g}) of {self.name}"

    def part(self, start: int, stop: int) -> Frames:
        return dataclasses.replace(self, codes=self.codes[start:stop])

    def __iter__(self) -> Iterator[dict[str, Mesh]]:
        names, triangles, _, frames = self.open()
        for positions in frames:
            yield {name: Mesh(xyz, faces, name=name) for name, xyz, faces in zip(names, positions, triangles)}

    def open(self) -> Animation:
        stage, meshes = _usd_meshes(self.path)
        triangles = [
            _fans(
                np.asarray(each.GetFaceVertexCountsAttr().Get()),
                np.asarray(each.GetFaceVertexIndicesAttr().Get()),
                each.GetOrientationAttr().Get() == "leftHanded",
            )
            for each in meshes
        ]
        return Animation(
            [str(each.GetPath()) for each in meshes],
            triangles,
            next(_usd_positions(stage, meshes, [self.start])),
            _usd_positions(stage, meshes, self.codes),
        )


def frames_of_path(path: str | os.PathLike[str]) -> Frames:
    """The frames of a recording, a USD file, or a pattern of mesh files."""
    path = os.fspath(path)
    lower = path.lower()
    if lower.endswith((".h5", ".hdf5")):
        return frames_of_recording(Recording(path))
    if lower.endswith((".usd", ".usda", ".usdc", ".usdz")):
        codes = _usd_time_codes(path)
        return UsdFrames(path, os.path.abspath(path), codes, codes[0])
    if lower.endswith(".abc"):
        raise Error(f"{path}: Alembic is not read; export USD, or a sequence of OBJ files")
    files = sorted(
        glob.glob(path),
        key=lambda name: [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)],
    )
    if not files:
        raise Error(f"{path}: no such file" + ("; quote the pattern" if "*" in path else ""))
    return _files(path, files)


def frames_of_recording(recording: Recording) -> Frames:
    """The frames of an open recording, which tasks open again."""
    return RecordingFrames(recording.path, os.path.abspath(recording.path), range(len(recording)))


def _files(name: str, files: Sequence[Any]) -> Frames:
    absolute = [os.path.abspath(each) for each in files]
    return MeshFiles(name, absolute, absolute[0])


def _are_paths(frames: Any) -> bool:
    return isinstance(frames, (list, tuple)) and all(isinstance(each, (str, os.PathLike)) for each in frames)


def frames_to_map(frames: Any) -> Frames:
    """What `map_frames` takes."""
    if isinstance(frames, Frames):
        return frames
    if isinstance(frames, Recording):
        return frames_of_recording(frames)
    if isinstance(frames, (str, os.PathLike)):
        return frames_of_path(frames)
    if isinstance(frames, dict) or not hasattr(frames, "__len__") or not hasattr(frames, "__getitem__"):
        raise Error(
            f"map_frames: {type(frames).__name__} has no numbered frames; give a path, a recording, an array "
            "or a list"
        )
    return Items(frames)


def frames_to_check(animation: Any, faces: Any) -> Frames:
    """What `check` takes."""
    if isinstance(animation, dict):
        if not isinstance(faces, dict) or animation.keys() != faces.keys():
            raise Error("check: a dict of positions needs a dict of faces with the same names")
        arrays = [_arrays.as_numpy(each, "positions") for each in animation.values()]
        return _of_arrays("arrays", list(animation), arrays, list(faces.values()))
    if isinstance(animation, Recording):
        return frames_of_recording(animation)
    if isinstance(animation, (str, os.PathLike)):
        return frames_of_path(animation)
    if (
        isinstance(animation, (list, tuple))
        and animation
        and not hasattr(animation[0], "dtype")
        and faces is None
    ):
        if _are_paths(animation):
            return _files("files", animation)
        return _of_meshes([as_mesh(each) for each in animation])
    if faces is None:
        raise Error("check: an array of positions needs faces")
    return _of_arrays("array", ["mesh"], [_arrays.as_numpy(animation, "positions")], [faces])


def _of_arrays(source: str, names: list[str], arrays: list[Any], faces: list[Any]) -> Frames:
    for name, each in zip(names, arrays):
        if each.ndim != 3 or each.shape[2] != 3:
            raise Error(
                f"check: the positions of {name} have the shape {each.shape}; it must be (frames, n, 3)"
            )
    counts = {len(each) for each in arrays}
    if len(counts) > 1:
        raise Error(f"check: the objects have {sorted(counts)} frames; they must have equally many")
    first = [each[0] for each in arrays if len(each)]
    return ArrayFrames(source, names, arrays, faces, first)


def _of_meshes(meshes: list[Mesh]) -> Frames:
    first = meshes[0]
    for i, each in enumerate(meshes):
        if not np.array_equal(each.triangles, first.triangles):
            raise Error(
                f"check: frame {i} of meshes has other triangles than frame 0; all frames need one topology"
            )
    positions = [each.positions for each in meshes]
    return ArrayFrames("meshes", [first.name or "mesh"], [positions], [first.triangles], [first.positions])


def _usd_meshes(path: str) -> tuple[Any, list[Any]]:
    """The stage of a USD file, without which its meshes are invalid, and the meshes."""
    try:
        from pxr import Usd, UsdGeom
    except ImportError:
        raise Error(f"{path}: USD needs the package usd-core (pip install usd-core)") from None
    stage = Usd.Stage.Open(path)
    meshes = [UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    if not meshes:
        raise Error(f"{path}: the stage has no mesh")
    return stage, meshes


def _usd_time_codes(path: str) -> list[float]:
    stage, meshes = _usd_meshes(path)
    from pxr import Usd

    return sorted(
        {code for each in meshes for code in each.GetPointsAttr().GetTimeSamples()}
        | {code for each in meshes for code in _transform_times(each)}
    ) or [Usd.TimeCode.EarliestTime().GetValue()]


def _usd_positions(stage: Any, meshes: list[Any], codes: list[float]) -> Iterator[list[Any]]:
    from pxr import UsdGeom

    for code in codes:
        assert stage
        cache = UsdGeom.XformCache(code)
        placed = []
        for each in meshes:
            matrix = np.asarray(cache.GetLocalToWorldTransform(each.GetPrim()))
            points = np.asarray(each.GetPointsAttr().Get(code), np.float64)
            placed.append(points @ matrix[:3, :3] + matrix[3, :3])
        yield placed


def _transform_times(mesh: Any) -> set[float]:
    from pxr import UsdGeom

    times: set[float] = set()
    prim = mesh.GetPrim()
    while prim and not prim.IsPseudoRoot():
        if prim.IsA(UsdGeom.Xformable):
            times |= set(UsdGeom.Xformable(prim).GetTimeSamples())
        prim = prim.GetParent()
    return times


def _fans(counts: Any, corners: Any, flipped: bool) -> Any:
    """Polygons as fans of triangles."""
    triangles = []
    start = 0
    for count in counts.tolist():
        face = corners[start : start + count]
        triangles += [(face[0], face[i], face[i + 1]) for i in range(1, count - 1)]
        start += count
    made = np.array(triangles, np.int64).reshape(-1, 3)
    return made[:, ::-1] if flipped else made
