"""The scenes of collision managers: what they keep from question to question."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any, Iterable, TypeAlias

import numpy as np
import numpy.typing as npt

from .. import _core
from .._meshes import Mesh, fault_of_solid, split_into_parts
from .._object import Object
from .._scene import Scene

if TYPE_CHECKING:
    from ..typing import ProximityPair

FEW_PAIRS = 4096  #: of two managers, for which one comparison of all is faster than the broad phase
IDENTITY = np.eye(4)
_changes = itertools.count(1)
Floats = npt.NDArray[np.float64]


class Entry:
    """A mesh with its transform."""

    def __init__(self, mesh: Mesh, transform: Floats) -> None:
        self.mesh, self.transform = mesh, transform
        self.solid = len(mesh.triangles) > 0 and not fault_of_solid(mesh)
        self.is_empty = len(mesh.positions) == 0
        self.places: Any = None  #: where it is one of several, and which one
        self.number = 0
        self._parts: npt.NDArray[np.uint32] | None = None

    def half_box(self) -> tuple[Floats, Floats]:
        """The center and the half edges of the box of the mesh."""
        finite = self.mesh.positions[np.isfinite(self.mesh.positions).all(axis=1)].astype(np.float64)
        lowest, highest = (finite.min(axis=0), finite.max(axis=0)) if len(finite) else np.full((2, 3), np.inf)
        with np.errstate(invalid="ignore"):
            return 0.5 * lowest + 0.5 * highest, np.nextafter(0.5 * highest - 0.5 * lowest, np.inf)

    def may_enclose(self, inner: Entry) -> bool:
        """Whether its box encloses that of another entry."""
        enclosed: bool = self.places.boxes.encloses(self.number, inner.places.boxes, inner.number)
        return enclosed

    def one_vertex_of_each_part(self) -> npt.NDArray[np.uint32]:
        if self._parts is None:
            self._parts = np.array([part.vertices[0] for part in split_into_parts(self.mesh)], np.uint32)
        return self._parts


def check_placed(entry: Entry, is_placed: bool) -> None:
    if not is_placed:
        raise ValueError(f"the transform of {entry.mesh.name} is not finite, or moves it too far")


class Places:
    """Where entries are: their boxes, and when they changed."""

    def __init__(self, entries: Iterable[Entry] = ()) -> None:
        self.entries: list[Entry] = []
        self.structure = self.version = next(_changes)  #: of the list of entries, and of where they are
        self.boxes = _core.PlacedBoxes()
        self.changed: list[int] = []
        for entry in entries:
            self.add(entry)

    def add(self, entry: Entry) -> None:
        check_placed(entry, self.boxes.add(*entry.half_box(), entry.transform))
        entry.places, entry.number = self, len(self.entries)
        self.entries.append(entry)
        self.structure = self.version = next(_changes)
        self.changed.append(self.version)

    def move(self, entry: Entry, transform: Floats) -> None:
        check_placed(entry, self.boxes.place(entry.number, transform))
        entry.transform = transform
        self.changed[entry.number] = self.version = next(_changes)


#: The distance, the two entries and the record; infinite and None without any.
Nearest: TypeAlias = "tuple[float, tuple[Entry, Entry] | None, ProximityPair | None]"


class World:
    """A scene with the entries that a question was about, and the octrees of their meshes."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.core = scene._core
        self._known: dict[int, tuple[Entry, Object]] = {}
        self._placed: dict[int, Floats] = {}
        self._last: Any = None
        self._last_nearest: int | None = None
        self.structure: Any = None
        self._broad_phase = _core.BroadPhase({})
        self._seen: tuple[Any, int] = ((), 0)
        self._overlapping: list[tuple[Entry, Entry]] = []

    def object(self, entry: Entry) -> Object:
        """The object of an entry, where it is now."""
        key = id(entry)
        known = self._known.get(key)
        if known is None:
            known = self._known[key] = entry, self.scene.add(entry.mesh, solid=entry.solid)
            self._placed[key] = IDENTITY
        if self._placed[key] is not entry.transform:
            self.core.set_transform(known[1]._id, entry.transform)
            self._placed[key] = entry.transform
        return known[1]

    def keep(self, entries: Iterable[Entry]) -> None:
        """Removes the objects of all other entries."""
        wanted = {id(entry) for entry in entries}
        for key in [key for key in self._known if key not in wanted]:
            self._known.pop(key)[1].remove()
            del self._placed[key]

    def overlapping(self, *sources: Places) -> list[tuple[Entry, Entry]]:
        """The pairs of entries whose boxes overlap: of one source, or of two sources with each other."""
        structure = tuple(each.structure for each in sources)
        version = max(each.version for each in sources)
        if (structure, version) != self._seen:
            first, last = sources[0], sources[-1]
            is_small = len(sources) == 2 and len(first.entries) * len(last.entries) <= FEW_PAIRS
            pairs = None if is_small else self._search(structure, sources)
            found = first.boxes.near(last.boxes, pairs).tolist()
            self._seen = structure, version
            self._overlapping = [(first.entries[i], last.entries[j]) for i, j in found]
        return self._overlapping

    def _search(self, structure: Any, sources: tuple[Places, ...]) -> npt.NDArray[np.uint32]:
        """The same by the broad phase, along the axes; it searches only the pairs of boxes that changed."""
        volumes, kinds, dirty = np.concatenate([each.boxes.corners() for each in sources]), None, None
        if len(sources) == 2:
            kinds = np.repeat(np.arange(2, dtype=np.uint8), [len(each.entries) for each in sources])
        if structure == self._seen[0]:
            changed = np.concatenate([each.changed for each in sources]) > self._seen[1]
            dirty = np.flatnonzero(changed).astype(np.uint32)
        else:
            pairs = {} if kinds is None else {"kind_pairs": [(0, 1)]}
            self._broad_phase = _core.BroadPhase({"threads": 1, **pairs})
        found: npt.NDArray[np.uint32] = self._broad_phase.of_boxes(volumes, kinds, dirty)
        if kinds is not None:
            found[:, 1] -= np.uint32(len(sources[0].entries))
        return found

    def collide(self, pairs: list[tuple[Entry, Entry]], all_pairs: bool) -> list[tuple[Entry, Entry]]:
        """The pairs that touch, or the first one that is found."""
        found = []
        if self._last in pairs and not all_pairs:  # it probably touches still
            pairs = [self._last, *pairs]
        for a, b in pairs:
            if self._touch(a, b):
                self._last = a, b
                found.append((a, b))
                if not all_pairs:
                    break
        return found

    def _touch(self, a: Entry, b: Entry) -> bool:
        ids = self.object(a)._id, self.object(b)._id
        return self.core.any_contact(*ids, None) or self._contains(b, a) or self._contains(a, b)

    def _contains(self, outer: Entry, inner: Entry) -> bool:
        """Whether a part of an entry is inside a solid one that it does not touch."""
        if not outer.solid or inner.is_empty:
            return False
        vertices = inner.one_vertex_of_each_part()
        if len(vertices) == 1 and not outer.may_enclose(inner):
            return False
        points = self.core.positions(self.object(inner)._id)[vertices]
        return bool((self.scene.inside(points, object=self.object(outer)) > 0).any())

    def first_contact(self, pairs: list[tuple[Entry, Entry]]) -> Nearest | None:
        """The distance 0 of a pair whose surfaces touch, which takes less time than a distance."""
        for a, b in [self._last, *pairs] if self._last in pairs else pairs:
            if self.core.any_contact(self.object(a)._id, self.object(b)._id, None):
                self._last = a, b
                return 0.0, (a, b), None
        return None

    def nearest(self, bounds: Floats, a: list[Entry], b: list[Entry]) -> Nearest:
        """The nearest pair with its distance; `bounds` are lower bounds of the distances, (len(a), len(b))."""
        least = bounds.ravel()
        best, nearest, record = np.inf, None, None
        tried: set[int] = set()
        if not least.size or np.isnan(least).all():
            return best, nearest, record

        def attempt(i: int) -> None:
            nonlocal best, nearest, record
            if best == 0 or i in tried or not least[i] * (1 - 1e-9) <= best:
                return
            tried.add(i)
            pair = a[i // len(b)], b[i % len(b)]
            found = self.scene.distance(self.object(pair[0]), self.object(pair[1]))
            if found is not None and (record is None or found.distance < best):
                best, nearest, record = float(found.distance), pair, found

        if self._last_nearest is not None and self._last_nearest < least.size:
            attempt(self._last_nearest)  # the last answer, wherever it is now, excludes most others
        attempt(int(np.nanargmin(least)))
        near = np.flatnonzero(least * (1 - 1e-9) <= best)
        for i in near[np.argsort(least[near], kind="stable")].tolist():
            attempt(i)
        self._last_nearest = None if nearest is None else a.index(nearest[0]) * len(b) + b.index(nearest[1])
        return best, nearest, record


def near_entries(places: Places, place: Places, external: Entry) -> list[tuple[Entry, Entry]]:
    """The entries whose boxes overlap that of the only one of `place`."""
    return [(places.entries[i], external) for i in places.boxes.near(place.boxes, None)[:, 0].tolist()]


def lower_bounds(a: Places, b: Places) -> Floats:
    """Lower bounds of the distances of all entries of a to those of b; NaN of entries without vertices."""
    bounds: Floats = a.boxes.bounds(b.boxes).reshape(len(a.entries), len(b.entries))
    return bounds
