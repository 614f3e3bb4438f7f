"""The check of an animation: which frames intersect, where and how deep."""

from __future__ import annotations

import glob
import html
import os
import pathlib
import re
from typing import Any, Iterator, NamedTuple

import numpy as np

from . import _arrays
from ._core import Error
from ._meshes import Mesh, as_mesh, fault_of_solid, split_into_parts, welded
from ._recording import Recording
from ._scene import Scene


class FrameCheck(NamedTuple):
    """What one frame has: triangle pairs that intersect (`contacts`), of them those of objects with
    themselves (`self_contacts`), vertices inside solid objects, the largest depth of a vertex or a curve, in
    the unit of the coordinates, and the objects of the deepest place."""

    frame: int
    contacts: int
    self_contacts: int
    vertices_inside: int
    depth: float
    worst: str


class CheckReport:
    """The frames of a checked animation. `worst()` sorts them; `to_pandas()` is a table; `save` writes a
    page."""

    def __init__(self, source: str, names: list[str], frames: list[FrameCheck], notes: list[str]) -> None:
        self.source, self.names, self.frames, self.notes = source, names, frames, notes

    def worst(self, count: int = 10) -> list[FrameCheck]:
        """The frames with contacts, the deepest first."""
        hit = [each for each in self.frames if each.contacts or each.vertices_inside]
        return sorted(hit, key=lambda each: (-each.depth, -each.contacts, each.frame))[:count]

    @property
    def clean(self) -> bool:
        """Whether frames were checked and none has a contact."""
        return bool(self.frames) and not self.worst(1)

    def to_pandas(self) -> Any:
        """A pandas.DataFrame with a row for each frame."""
        import pandas

        return pandas.DataFrame(self.frames).set_index("frame")

    def plot(self, axes: Any = None) -> Any:
        """Contacts and depth by frame. Returns the axes."""
        from .plot import _axes

        axes = _axes(axes)
        numbers = [each.frame for each in self.frames]
        axes.plot(numbers, [each.contacts for each in self.frames], label="contacts")
        axes.plot(numbers, [each.self_contacts for each in self.frames], label="of an object with itself")
        axes.set(xlabel="frame", ylabel="triangle pairs", ylim=(0, None))
        axes.legend(loc="upper left")
        deep = axes.twinx()
        deep.plot(numbers, [each.depth for each in self.frames], color="tab:red")
        deep.set_ylabel("depth", color="tab:red")
        deep.set_ylim(0, None)
        return axes

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a page with the plot and the table of the worst frames; it is one file."""
        import io

        from matplotlib import pyplot

        picture = io.StringIO()
        figure = self.plot().figure
        figure.savefig(picture, format="svg")
        pyplot.close(figure)
        svg = picture.getvalue()
        svg = svg[svg.index("<svg") :]
        pathlib.Path(path).write_text(
            "<!doctype html><html lang='en'><meta charset='utf-8'><title>Check</title>"
            "<style>body{font:15px system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem}"
            "table{border-collapse:collapse}td,th{padding:.25rem .8rem;text-align:right;border-bottom:1px solid #ddd}"
            "svg{max-width:100%;height:auto}</style>"
            f"<h1>{html.escape(self.source)}</h1>{svg}{self._repr_html_()}</html>",
            encoding="utf-8",
        )

    def _repr_html_(self) -> str:
        rows = "".join(
            "<tr>"
            + "".join(
                f"<td>{html.escape(f'{value:.6g}' if isinstance(value, float) else str(value))}</td>"
                for value in each
            )
            + "</tr>"
            for each in self.worst()
        )
        head = "".join(f"<th>{name.replace('_', ' ')}</th>" for name in FrameCheck._fields)
        notes = "".join(f"<li>{html.escape(note)}</li>" for note in self.notes)
        table = f"<table><tr>{head}</tr>{rows}</table>" if rows else ""
        return f"<p>{html.escape(self._summary())}</p>{table}<ul>{notes}</ul>"

    def _summary(self) -> str:
        hit = len(self.worst(len(self.frames)))
        if not self.frames:
            return "no frames were checked"
        if not hit:
            return f"{len(self.frames)} frames, none with contacts"
        first = self.worst(1)[0]
        return (
            f"{hit} of {len(self.frames)} frames have contacts; the deepest is frame {first.frame}: "
            f"{first.contacts} contacts, depth {first.depth:.4g} ({first.worst})"
        )

    def __repr__(self) -> str:
        return f"<supple.CheckReport of {self.source}: {self._summary()}>" + "".join(
            f"\n  note: {each}" for each in self.notes
        )


def check(
    animation: Any,
    faces: Any = None,
    *,
    self_collision: bool = True,
    weld: bool = False,
    parts: bool = False,
    progress: bool = False,
) -> CheckReport:
    """Checks all frames of an animation for intersections, self-intersections and depths.

    `animation` is
    - the path of a recording (.h5), or a pattern of mesh files of one topology, such as "frame_*.obj", in
      the order of the numbers in their names,
    - the path of a USD file (.usd, .usda, .usdc), which needs usd-core; its meshes at each time code.
      Alembic is not read: export USD, or a sequence of OBJ files,
    - an array (frames, n, 3) with `faces` (m, 3), or a list of meshes,
    - a dict of arrays by name, with a dict of faces.

    Closed surfaces count as solids, for which vertices inside are counted. `weld` joins vertices with equal
    positions, where a mesh is split along seams. `parts` makes an object of each connected part of a mesh.
    `progress` shows a bar, which needs tqdm.
    """
    source, names, topologies, frames, total = _frames(animation, faces)
    scene = Scene(contacts="penetration")
    notes: list[str] = []
    objects: list[tuple[int, Any, Any]] = []  # of which mesh, its object, its vertices
    checked = []
    numbered = enumerate(frames)
    if progress:
        from tqdm.auto import tqdm

        numbered = tqdm(numbered, total=total, unit="frame")
    for number, positions in numbered:
        if not objects:
            for i, (name, triangles, first) in enumerate(zip(names, topologies, positions)):
                whole = Mesh(first, triangles, name=name)
                split = (
                    [
                        (part.mesh, f"{name}.{k}", part.vertices)
                        for k, part in enumerate(split_into_parts(whole, weld))
                    ]
                    if parts
                    else [(whole, name, slice(None))]
                )
                objects += [
                    (i, _add(scene, label, mesh, self_collision, weld, notes), chosen)
                    for mesh, label, chosen in split
                ]
        for i, each, chosen in objects:
            each.positions = positions[i][chosen]
        checked.append(_check_frame(number, scene))
    return CheckReport(source, names, checked, notes)


def _add(scene: Scene, name: str, mesh: Mesh, self_collision: bool, weld: bool, notes: list[str]) -> Any:
    fault = fault_of_solid(welded(mesh) if weld else mesh)
    if fault or not len(mesh.triangles):
        notes.append(
            f"{name} is not a solid, so vertices inside it are not counted: {fault or 'it has no triangles'}"
        )
    return scene.add(mesh, name=name, self_collision=self_collision, weld=weld, solid=not fault)


def _check_frame(number: int, scene: Scene) -> FrameCheck:
    found = scene.detect()
    contacts, inside, curves = found.contacts, found.penetrations, found.curves
    own = int(np.count_nonzero(contacts["object_a"] == contacts["object_b"]))
    deepest, worst = 0.0, ""
    for table, a, b in ((inside, "object_a", "object_b"), (curves, "a", "b")):
        if len(table) and table["depth"].max() > deepest:
            row = table[int(table["depth"].argmax())]
            deepest = float(row.depth)
            worst = (
                f"{scene[int(row[a])].name} and {scene[int(row[b])].name}"
                if row[a] != row[b]
                else f"{scene[int(row[a])].name} with itself"
            )
    return FrameCheck(number, len(contacts), own, len(inside), deepest, worst)


Frames = tuple[str, list[str], list[Any], Iterator[list[Any]], "int | None"]


def _frames(animation: Any, faces: Any) -> Frames:
    if isinstance(animation, dict):
        if not isinstance(faces, dict) or animation.keys() != faces.keys():
            raise Error("check: a dict of positions needs a dict of faces with the same names")
        arrays = [_arrays.as_numpy(each, "positions") for each in animation.values()]
        return _of_arrays("arrays", list(animation), arrays, list(faces.values()))
    if isinstance(animation, Recording):
        return _of_recording(animation)
    if isinstance(animation, (str, os.PathLike)):
        return _of_path(os.fspath(animation))
    if (
        isinstance(animation, (list, tuple))
        and animation
        and not hasattr(animation[0], "dtype")
        and faces is None
    ):
        return _of_meshes("meshes", [as_mesh(each) for each in animation])
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
    total = counts.pop() if counts else 0
    return source, names, faces, ([each[i] for each in arrays] for i in range(total)), total


def _of_recording(recording: Recording) -> Frames:
    places = range(len(recording.objects))
    return (
        recording.path,
        [each.name for each in recording.objects],
        [each.mesh.triangles for each in recording.objects],
        ([recording.positions(i, each) for each in places] for i in range(len(recording))),
        len(recording),
    )


def _of_meshes(source: str, meshes: list[Mesh]) -> Frames:
    first = meshes[0]
    for i, each in enumerate(meshes):
        if not np.array_equal(each.triangles, first.triangles):
            raise Error(
                f"check: frame {i} of {source} has other triangles than frame 0; all frames need one topology"
            )
    return (
        source,
        [first.name or "mesh"],
        [first.triangles],
        ([each.positions] for each in meshes),
        len(meshes),
    )


def _of_path(path: str) -> Frames:
    lower = path.lower()
    if lower.endswith((".h5", ".hdf5")):
        return _of_recording(Recording(path))
    if lower.endswith((".usd", ".usda", ".usdc", ".usdz")):
        return _of_usd(path)
    if lower.endswith(".abc"):
        raise Error(f"{path}: Alembic is not read; export USD, or a sequence of OBJ files")
    files = sorted(
        glob.glob(path),
        key=lambda name: [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)],
    )
    if not files:
        raise Error(f"{path}: no such file" + ("; quote the pattern" if "*" in path else ""))

    def positions() -> Iterator[list[Any]]:
        for i, name in enumerate(files):
            mesh = as_mesh(name)
            if not np.array_equal(mesh.triangles, first.triangles):
                raise Error(
                    f"{name}: frame {i} has other triangles than {files[0]}; all frames need one topology"
                )
            yield [mesh.positions]

    first = as_mesh(files[0])
    return path, [first.name], [first.triangles], positions(), len(files)


def _of_usd(path: str) -> Frames:
    try:
        from pxr import Usd, UsdGeom
    except ImportError:
        raise Error(f"{path}: USD needs the package usd-core (pip install usd-core)") from None
    stage = Usd.Stage.Open(path)
    meshes = [UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    if not meshes:
        raise Error(f"{path}: the stage has no mesh")
    topologies = [
        _fans(
            np.asarray(each.GetFaceVertexCountsAttr().Get()),
            np.asarray(each.GetFaceVertexIndicesAttr().Get()),
            each.GetOrientationAttr().Get() == "leftHanded",
        )
        for each in meshes
    ]
    codes = sorted(
        {code for each in meshes for code in each.GetPointsAttr().GetTimeSamples()}
        | {code for each in meshes for code in _transform_times(each)}
    ) or [Usd.TimeCode.EarliestTime().GetValue()]

    def frames() -> Iterator[list[Any]]:
        kept = stage  # meshes are valid as long as their stage
        for code in codes:
            assert kept
            cache = UsdGeom.XformCache(code)
            placed = []
            for each in meshes:
                matrix = np.asarray(cache.GetLocalToWorldTransform(each.GetPrim()))
                points = np.asarray(each.GetPointsAttr().Get(code), np.float64)
                placed.append(points @ matrix[:3, :3] + matrix[3, :3])
            yield placed

    return path, [str(each.GetPath()) for each in meshes], topologies, frames(), len(codes)


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


__all__ = ["CheckReport", "FrameCheck", "check"]
