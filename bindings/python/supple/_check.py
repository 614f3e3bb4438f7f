"""The check of an animation: which frames intersect, where and how deep."""

from __future__ import annotations

import dataclasses
import html
import os
import pathlib
from typing import Any, Iterator, NamedTuple

import numpy as np

from ._animation import Frames, frames_to_check
from ._core import Stop
from ._frames import AnyExecutor, Progress, run
from ._meshes import Mesh, fault_of_solid, split_into_parts, welded
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
    progress: Progress = False,
    client: AnyExecutor | None = None,
    stop: Stop | None = None,
    retries: int = 2,
    chunk: int | None = None,
) -> CheckReport:
    """Checks all frames of an animation for intersections, self-intersections and depths.

    `animation` is
    - the path of a recording (.h5), a list of mesh files of one topology, or a pattern of them, such as
      "frame_*.obj", in the order of the numbers in their names,
    - the path of a USD file (.usd, .usda, .usdc), which needs usd-core; its meshes at each time code.
      Alembic is not read: export USD, or a sequence of OBJ files,
    - an array (frames, n, 3) with `faces` (m, 3), or a list of meshes,
    - a dict of arrays by name, with a dict of faces.

    Closed surfaces count as solids, for which vertices inside are counted. `weld` joins vertices with equal
    positions, where a mesh is split along seams. `parts` makes an object of each connected part of a mesh.

    `client` runs the frames on many threads, processes or machines: an executor, as `map_frames` takes it
    and with the same report as without. `progress`, `stop`, `retries` and `chunk` are those of `map_frames`.
    With `client`, each task builds a scene from frame 0, uses one thread and opens files by their absolute
    paths. Raises `Error`, which names the frame, for frames that cannot be read or have other triangles.
    """
    frames = frames_to_check(animation, faces)
    checked: list[_Checked] = run(
        "check",
        _CheckFrames(self_collision, weld, parts, 0 if client is None else 1),
        frames,
        client,
        progress=progress,
        stop=stop,
        retries=retries,
        chunk=chunk,
    )
    names, notes = (checked[0].names, checked[0].notes) if checked else (frames.open().names, [])
    return CheckReport(
        frames.name, names, [each.check._replace(frame=i) for i, each in enumerate(checked)], notes
    )


class _Checked(NamedTuple):
    """A frame, and what all frames have in common."""

    check: FrameCheck
    names: list[str]
    notes: list[str]


@dataclasses.dataclass(frozen=True)
class _CheckFrames:
    """Checks consecutive frames in one scene, which is made from frame 0 of the animation."""

    self_collision: bool
    weld: bool
    parts: bool
    threads: int

    def __call__(self, frames: Frames) -> Iterator[_Checked]:
        names, triangles, first, positions = frames.open()
        scene = Scene(contacts="penetration", curves=True, threads=self.threads)
        notes: list[str] = []
        objects: list[tuple[int, Any, Any]] = []  # of which mesh, its object, its vertices
        for i, (name, faces, xyz) in enumerate(zip(names, triangles, first)):
            whole = Mesh(xyz, faces, name=name)
            split = (
                [
                    (part.mesh, f"{name}.{k}", part.vertices)
                    for k, part in enumerate(split_into_parts(whole, self.weld))
                ]
                if self.parts
                else [(whole, name, slice(None))]
            )
            objects += [
                (i, _add(scene, label, mesh, self.self_collision, self.weld, notes), chosen)
                for mesh, label, chosen in split
            ]
        for number, placed in enumerate(positions):
            for i, each, chosen in objects:
                each.positions = placed[i][chosen]
            yield _Checked(_check_frame(number, scene), names, notes)


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


__all__ = ["CheckReport", "FrameCheck", "check"]
