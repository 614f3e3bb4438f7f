"""The calls of `trimesh.collision`, on supple: `CollisionManager`, `ContactData`, `DistanceData`,
`scene_to_collision`.

    from supple.compat.trimesh import CollisionManager

Differences: meshes are surfaces, never convex solids. Where a mesh is watertight, an object inside it
collides, too. The depth of a contact is that of its curve of intersection: how far the first object must
move along the curve's normal to leave the other one. The distance of objects that intersect is 0, not
negative.

Managers keep what they build. Meshes that are given to `in_collision_single` and `min_distance_single` are
compared with the last ones, by their vertices and faces, and two managers keep the octrees of the objects that
came near each other. `set_transform` takes effect in the next question.
"""

from __future__ import annotations

import itertools
import math
import weakref
from operator import le
from typing import TYPE_CHECKING, Any, Iterable, TypeAlias

import numpy as np
import numpy.typing as npt

from .. import _core
from .._meshes import Mesh, as_mesh, fault_of_solid, split_into_parts
from .._object import Object
from .._scene import Scene

if TYPE_CHECKING:
    from ..typing import ProximityPair

_EXTERNAL = "__external"
_KEPT_EXTERNALS = 8
_FEW_PAIRS = 4096  #: of two managers, for which one comparison of all is faster than the broad phase
_IDENTITY = np.eye(4)
_changes = itertools.count(1)

Floats = npt.NDArray[np.float64]


class ContactData:
    """A contact: the `names` of both objects, `point`, `normal` (from the second object to the first),
    `depth`."""

    def __init__(
        self, names: tuple[str, str], faces: tuple[int, int], point: Any, normal: Any, depth: float
    ) -> None:
        self.names = set(names)
        self._faces = dict(zip(names, faces))
        self.point, self.normal, self.depth = point, normal, depth

    def index(self, name: str) -> int:
        """The face of this object."""
        return self._faces[name]

    def __repr__(self) -> str:
        return f"ContactData({self._faces}, depth={self.depth:.4g})"


class DistanceData:
    """The smallest distance of two objects: their `names`, `distance`, and for each name the nearest face
    and point."""

    def __init__(
        self, names: tuple[str, str], faces: tuple[int, int], points: tuple[Any, Any], distance: float
    ) -> None:
        self.names = set(names)
        self._faces = dict(zip(names, faces))
        self._points = dict(zip(names, points))
        self.distance = distance

    def index(self, name: str) -> int:
        """The nearest face of this object."""
        return self._faces[name]

    def point(self, name: str) -> Any:
        """The nearest point of this object."""
        return self._points[name]

    def __repr__(self) -> str:
        return f"DistanceData({self._faces}, distance={self.distance:.4g})"


class _Entry:
    """A mesh with its transform."""

    def __init__(self, mesh: Mesh, transform: Floats) -> None:
        self.mesh, self.transform = mesh, transform
        self.solid = len(mesh.triangles) > 0 and not fault_of_solid(mesh)
        self.is_empty = len(mesh.positions) == 0
        finite = mesh.positions[np.isfinite(mesh.positions).all(axis=1)]
        lowest, highest = (finite.min(axis=0), finite.max(axis=0)) if len(finite) else np.full((2, 3), np.inf)
        with np.errstate(invalid="ignore"):
            self.center, self.half = 0.5 * lowest + 0.5 * highest, 0.5 * highest - 0.5 * lowest
        self.half = np.nextafter(self.half, np.inf)
        reach = float(np.abs(self.center).max() + self.half.max())
        self._numbers = (self.center.tolist(), self.half.tolist(), reach) if math.isfinite(reach) else None
        self.box: Any = None  #: of the mesh where it is, as lists
        self._parts: npt.NDArray[np.uint32] | None = None

    def placed_box(self) -> tuple[list[float], list[float]]:
        """The lowest and the highest corner of a box around the mesh where it is."""
        if self._numbers is None:
            return [math.inf] * 3, [math.inf] * 3
        (x, y, z), (dx, dy, dz), reach = self._numbers
        lowest, highest = [], []
        for a, b, c, shift in self.transform.tolist()[:3]:
            size_a, size_b, size_c = abs(a), abs(b), abs(c)
            half = size_a * dx + size_b * dy + size_c * dz
            # Rounded corners must not hide a pair.
            half += 1e-12 * ((size_a + size_b + size_c) * reach + abs(shift))
            center = a * x + b * y + c * z + shift
            lowest.append(center - half)
            highest.append(center + half)
        if not math.isfinite(sum(lowest) + sum(highest)):
            raise ValueError(f"the transform of {self.mesh.name} is not finite, or moves it too far")
        return lowest, highest

    def one_vertex_of_each_part(self) -> npt.NDArray[np.uint32]:
        if self._parts is None:
            self._parts = np.array([part.vertices[0] for part in split_into_parts(self.mesh)], np.uint32)
        return self._parts


class _Places:
    """Where entries are: their boxes, rounded outward to float32, and when they changed."""

    def __init__(self, entries: Iterable[_Entry] = ()) -> None:
        self.entries = list(entries)
        count = len(self.entries)
        self.structure = self.version = next(_changes)  #: of the list of entries, and of where they are
        self.boxes, self.changed = np.empty((count, 2, 3), np.float32), np.empty(count, np.int64)
        self.centers = np.array([entry.center for entry in self.entries]).reshape(-1, 3)
        self.halves = np.array([entry.half for entry in self.entries]).reshape(-1, 3)
        self._index = {id(entry): i for i, entry in enumerate(self.entries)}
        self._moved = set(range(count))

    def move(self, entry: _Entry) -> None:
        self._moved.add(self._index[id(entry)])

    def update(self) -> _Places:
        """Computes the boxes of entries that moved."""
        if not self._moved:
            return self
        moved = list(self._moved)
        # A few numbers for each, which plain Python computes faster than arrays.
        placed = [self.entries[i].placed_box() for i in moved]
        boxes = _core.enclosing_boxes(
            np.array([lowest for lowest, _ in placed]), np.array([highest for _, highest in placed]), 0
        )
        self.boxes[moved] = boxes
        self.version = self.changed[moved] = next(_changes)
        for i, box in zip(moved, boxes.tolist()):
            self.entries[i].box = box
        self._moved = set()
        return self

    def oriented(self) -> tuple[Floats, Floats, Floats]:
        """Of boxes that turn with the entries: centers (n, 3), half edges and their directions (n, 3, 3)."""
        transforms = np.array([entry.transform for entry in self.entries]).reshape(-1, 4, 4)
        turned = transforms[:, :3, :3]
        centers = (turned @ self.centers[:, :, None])[:, :, 0] + transforms[:, :3, 3]
        columns = turned.transpose(0, 2, 1)
        lengths = np.linalg.norm(columns, axis=2, keepdims=True)
        return centers, columns * self.halves[:, :, None], columns / np.where(lengths > 0, lengths, 1)


#: The distance, the two entries and the record; infinite and None without any.
Nearest: TypeAlias = "tuple[float, tuple[_Entry, _Entry] | None, ProximityPair | None]"


class _World:
    """A scene with the entries that a question was about, and the octrees of their meshes."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.core = scene._core
        self._known: dict[int, tuple[_Entry, Object]] = {}
        self._placed: dict[int, Floats] = {}
        self._last: Any = None
        self._last_nearest: int | None = None
        self.structure: Any = None
        self._broad_phase = _core.BroadPhase({})
        self._seen: tuple[Any, int] = ((), 0)
        self._overlapping: list[tuple[_Entry, _Entry]] = []

    def object(self, entry: _Entry) -> Object:
        """The object of an entry, where it is now."""
        key = id(entry)
        known = self._known.get(key)
        if known is None:
            known = self._known[key] = entry, self.scene.add(entry.mesh, solid=entry.solid)
            self._placed[key] = _IDENTITY
        if self._placed[key] is not entry.transform:
            self.core.set_transform(known[1]._id, entry.transform)
            self._placed[key] = entry.transform
        return known[1]

    def keep(self, entries: Iterable[_Entry]) -> None:
        """Removes the objects of all other entries."""
        wanted = {id(entry) for entry in entries}
        for key in [key for key in self._known if key not in wanted]:
            self._known.pop(key)[1].remove()
            del self._placed[key]

    def overlapping(self, *sources: _Places) -> list[tuple[_Entry, _Entry]]:
        """The pairs of entries whose boxes overlap: of one source, or of two sources with each other."""
        structure = tuple(each.update().structure for each in sources)
        version = max(each.version for each in sources)
        if (structure, version) == self._seen:
            return self._overlapping
        first, last = sources[0], sources[-1]
        if len(sources) == 2 and len(first.entries) * len(last.entries) <= _FEW_PAIRS:
            overlap = first.boxes[:, None, 0] <= last.boxes[:, 1]
            overlap &= last.boxes[:, 0] <= first.boxes[:, None, 1]
            found = np.argwhere(overlap.all(axis=2)).tolist()
        else:
            found = self._search(structure, sources)
        self._seen = structure, version
        self._overlapping = [(first.entries[i], last.entries[j]) for i, j in found]
        return self._overlapping

    def _search(self, structure: Any, sources: tuple[_Places, ...]) -> list[list[int]]:
        """The same by the broad phase, which searches only the pairs of boxes that changed."""
        volumes, kinds, dirty = np.concatenate([each.boxes for each in sources]), None, None
        if len(sources) == 2:
            kinds = np.repeat(np.arange(2, dtype=np.uint8), [len(each.entries) for each in sources])
        if structure == self._seen[0]:
            changed = np.concatenate([each.changed for each in sources]) > self._seen[1]
            dirty = np.flatnonzero(changed).astype(np.uint32)
        else:
            pairs = {} if kinds is None else {"kind_pairs": [(0, 1)]}
            self._broad_phase = _core.BroadPhase({"threads": 1, **pairs})
        found = self._broad_phase.of_boxes(volumes, kinds, dirty)
        if kinds is not None:
            found[:, 1] -= np.uint32(len(sources[0].entries))
        return found.tolist()

    def collide(self, pairs: list[tuple[_Entry, _Entry]], all_pairs: bool) -> list[tuple[_Entry, _Entry]]:
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

    def _touch(self, a: _Entry, b: _Entry) -> bool:
        ids = self.object(a)._id, self.object(b)._id
        return self.core.any_contact(*ids, None) or self._contains(b, a) or self._contains(a, b)

    def _contains(self, outer: _Entry, inner: _Entry) -> bool:
        """Whether a part of an entry is inside a solid one that it does not touch."""
        if not outer.solid or inner.is_empty:
            return False
        (low, high), (inner_low, inner_high) = outer.box, inner.box
        is_within = all(map(le, low, inner_low)) and all(map(le, inner_high, high))
        vertices = inner.one_vertex_of_each_part()
        if not is_within and len(vertices) == 1:
            return False
        points = self.core.positions(self.object(inner)._id)[vertices]
        return bool((self.scene.inside(points, object=self.object(outer)) > 0).any())

    def first_contact(self, pairs: list[tuple[_Entry, _Entry]]) -> Nearest | None:
        """The distance 0 of a pair whose surfaces touch, which takes less time than a distance."""
        for a, b in [self._last, *pairs] if self._last in pairs else pairs:
            if self.core.any_contact(self.object(a)._id, self.object(b)._id, None):
                self._last = a, b
                return 0.0, (a, b), None
        return None

    def nearest(self, bounds: Floats, a: list[_Entry], b: list[_Entry]) -> Nearest:
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


def _near(places: _Places, place: _Places, external: _Entry) -> list[tuple[_Entry, _Entry]]:
    """The entries whose boxes overlap that of the only one of `place`."""
    overlap = (places.boxes[:, 0] <= place.boxes[0, 1]) & (place.boxes[0, 0] <= places.boxes[:, 1])
    return [(places.entries[i], external) for i in np.flatnonzero(overlap.all(axis=1)).tolist()]


def _bounds(a: _Places, b: _Places) -> Floats:
    """Lower bounds of the distances of all entries of a to those of b: of their boxes along the axes, and of
    their boxes that turn with them, along the edges of these."""
    with np.errstate(invalid="ignore", over="ignore"):
        lows = np.subtract(a.boxes[:, None, 0], b.boxes[None, :, 1], dtype=np.float64)
        highs = np.subtract(b.boxes[None, :, 0], a.boxes[:, None, 1], dtype=np.float64)
        bounds: Floats = np.linalg.norm(np.maximum(0, np.maximum(lows, highs)), axis=2)
        (centers_a, edges_a, axes_a), (centers_b, edges_b, axes_b) = a.oriented(), b.oriented()
        between = centers_a[:, None] - centers_b[None, :]
        # More than rounding loses, also of coordinates that are far from 0.
        slack = 1e-12 * (np.abs(centers_a).sum(axis=1)[:, None] + np.abs(centers_b).sum(axis=1))
        for axes, own, others, shape in (
            (axes_a, edges_a, edges_b, "ikc,jlc->ijkl"),
            (axes_b, edges_b, edges_a, "jkc,ilc->ijkl"),
        ):
            gaps = np.abs(np.einsum("ijc,ikc->ijk" if shape[0] == "i" else "ijc,jkc->ijk", between, axes))
            radii = np.abs(np.einsum("nkc,nlc->nkl", axes, own)).sum(axis=2)
            gaps -= radii[:, None] if shape[0] == "i" else radii[None, :]
            gaps -= np.abs(np.einsum(shape, axes, others)).sum(axis=3)
            bounds = np.fmax(bounds, gaps.max(axis=2) * (1 - 1e-9) - slack)
    return bounds


class CollisionManager:
    """Named meshes with transforms, and the questions of `trimesh.collision.CollisionManager` about them."""

    def __init__(self) -> None:
        self._entries: dict[str, _Entry] = {}
        self._names: dict[int, str] = {}
        self._world = _World(Scene(contacts="intersection"))
        self._scene = self._world.scene
        self._places = _Places()
        self._externals: list[_Entry] = []
        self._shared: weakref.WeakKeyDictionary[CollisionManager, _World] = weakref.WeakKeyDictionary()

    def add_object(self, name: str, mesh: Any, transform: Any = None) -> Object:
        """Adds a mesh with a (4, 4) transform; replaces the one with this name."""
        entry = _Entry(as_mesh(mesh, name=str(name)), _matrix(transform))
        added = self._world.object(entry)
        self._entries[name] = entry
        self._change()
        return added

    def remove_object(self, name: str) -> None:
        """Removes the object with this name."""
        self._entry(name)
        del self._entries[name]
        self._change()

    def set_transform(self, name: str, transform: Any) -> None:
        """Replaces the transform of an object."""
        entry = self._entry(name)
        entry.transform = _matrix(transform)
        self._places.move(entry)

    def in_collision_single(
        self, mesh: Any, transform: Any = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Whether a mesh collides with any object; with the names of these objects and the contacts, if
        wanted."""
        external, place = self._external(mesh, transform)
        places = self._places.update()
        pairs = _near(places, place, external)
        names = {**self._names, id(external): _EXTERNAL}
        return self._answer(self._world, pairs, names, lambda a, b: a, return_names, return_data)

    def in_collision_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Whether any two objects collide; with the pairs of their names and the contacts, if wanted."""
        pairs = self._world.overlapping(self._places)
        return self._answer(
            self._world, pairs, self._names, lambda a, b: tuple(sorted((a, b))), return_names, return_data
        )

    def in_collision_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Whether an object collides with one of another manager; names are (own, other)."""
        world = self._world_with(other_manager)
        pairs = world.overlapping(self._places, other_manager._places)
        names = {**self._names, **other_manager._names}
        return self._answer(world, pairs, names, lambda a, b: (a, b), return_names, return_data)

    def min_distance_single(
        self, mesh: Any, transform: Any = None, return_name: bool = False, return_data: bool = False
    ) -> Any:
        """The smallest distance of a mesh to all objects; with the name of the nearest one and data, if
        wanted."""
        external, place = self._external(mesh, transform)
        places = self._places.update()
        found = self._world.first_contact(_near(places, place, external)) or self._world.nearest(
            _bounds(places, place), places.entries, [external]
        )
        distance, names, data = self._distance(
            found, self._world, {**self._names, id(external): _EXTERNAL}, return_data
        )
        return _answer(distance, None if names is None else names[0], data, return_name, return_data)

    def min_distance_internal(
        self, name: str | None = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """The smallest distance of any two objects, or of one object to all others."""
        own = None if name is None else self._entry(name)
        places = self._places.update()
        pairs = self._world.overlapping(places)
        if own is not None:
            pairs = [pair for pair in pairs if own in pair]
        found = self._world.first_contact(pairs) or self._world.nearest(
            self._inner_bounds(places, own), places.entries, places.entries
        )
        distance, names, data = self._distance(found, self._world, self._names, return_data)
        return _answer(
            distance, None if names is None else tuple(sorted(names)), data, return_names, return_data
        )

    def min_distance_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """The smallest distance of an object to one of another manager; names are (own, other)."""
        world = self._world_with(other_manager)
        own, other = self._places.update(), other_manager._places.update()
        found = world.first_contact(world.overlapping(own, other))
        found = found or world.nearest(_bounds(own, other), own.entries, other.entries)
        names = {**self._names, **other_manager._names}
        return _answer(*self._distance(found, world, names, return_data), return_names, return_data)

    @staticmethod
    def _inner_bounds(places: _Places, own: _Entry | None) -> Floats:
        """Bounds of each pair once; NaN elsewhere."""
        bounds, count = _bounds(places, places), len(places.entries)
        left_out = np.tri(count, dtype=bool)
        if own is not None:
            at = places.entries.index(own)
            left_out = np.arange(count)[:, None] != at
            bounds[at, at] = np.nan
        return np.where(left_out, np.nan, bounds)

    def _change(self) -> None:
        self._names = {id(entry): name for name, entry in self._entries.items()}
        self._places = _Places(self._entries.values())
        self._world.keep([*self._entries.values(), *self._externals])

    def _entry(self, name: str) -> _Entry:
        if name not in self._entries:
            raise ValueError(f"{name} not in collision manager!")
        return self._entries[name]

    def _external(self, mesh: Any, transform: Any) -> tuple[_Entry, _Places]:
        """A mesh of one question, with its octree where it was in one of the last questions."""
        matrix, made = _matrix(transform), as_mesh(mesh, name=_EXTERNAL)
        known = [each for each in self._externals if _equal(each.mesh, made)]
        entry = known[0] if known else _Entry(made, matrix)
        entry.transform = matrix
        self._externals = [entry, *(each for each in self._externals if each is not entry)][:_KEPT_EXTERNALS]
        if not known:
            self._world.keep([*self._entries.values(), *self._externals])
        return entry, _Places([entry]).update()

    def _world_with(self, other: CollisionManager) -> _World:
        """The scene of what two managers have near each other."""
        if other is self:
            raise ValueError(
                "a manager has no collisions with itself as another one; use in_collision_internal"
            )
        world = self._shared.get(other)
        if world is None:
            world = self._shared[other] = _World(Scene(contacts="intersection", threads=1))
        structure = self._places.structure, other._places.structure
        if world.structure != structure:
            world.structure = structure
            world.keep([*self._entries.values(), *other._entries.values()])
        return world

    def _answer(
        self,
        world: _World,
        pairs: list[tuple[_Entry, _Entry]],
        names: dict[int, str],
        named: Any,
        return_names: bool,
        return_data: bool,
    ) -> Any:
        touching = world.collide(pairs, return_names or return_data)
        found = {named(names[id(a)], names[id(b)]) for a, b in touching} if return_names else None
        data = _contact_data(world, touching, names) if return_data else None
        return _answer(bool(touching), found, data, return_names, return_data)

    @staticmethod
    def _distance(
        found: Nearest, world: _World, names: dict[int, str], return_data: bool
    ) -> tuple[float, tuple[str, str] | None, DistanceData | None]:
        distance, nearest, record = found
        if nearest is None:
            return distance, None, None
        a, b = names[id(nearest[0])], names[id(nearest[1])]
        if not return_data:
            return distance, (a, b), None
        objects = [world.object(each) for each in nearest]
        record = record or world.scene.distance(*objects)
        assert record is not None
        points = [record.point_a, record.point_b]
        if objects[0].index != int(record.object_a):
            points.reverse()
        faces = [
            int(world.scene.closest([point], object=each)["triangle"][0])
            for point, each in zip(points, objects)
        ]
        data = DistanceData((a, b), (faces[0], faces[1]), (points[0], points[1]), distance)
        return distance, (a, b), data


def _contact_data(
    world: _World, touching: list[tuple[_Entry, _Entry]], names: dict[int, str]
) -> list[ContactData]:
    """All contacts of pairs that touch. A contact is as deep as its curve, and the only curve of two objects is
    at least as deep as their deepest vertex."""
    of_objects = {world.object(entry).index: names[id(entry)] for pair in touching for entry in pair}
    wanted = {frozenset((world.object(a).index, world.object(b).index)) for a, b in touching}
    found = world.scene.search(
        contacts="penetration",
        depths="deepest",
        only=lambda a, b: frozenset((a.index, b.index)) in wanted,
    )
    deepest: dict[frozenset[int], float] = {}
    for vertex in found.penetrations:
        pair = frozenset((int(vertex.object_a), int(vertex.object_b)))
        deepest[pair] = max(deepest.get(pair, 0.0), float(vertex.depth))
    curves = [frozenset((int(curve.a), int(curve.b))) for curve in found.curves]
    contacts, points = found.contacts, found.contact_points["position"]
    depths = np.zeros(len(contacts))
    for pair, curve in zip(curves, found.curves):
        least = deepest.get(pair, 0.0) if curves.count(pair) == 1 else 0.0
        own = found.curve_contacts[curve.first_contact : curve.first_contact + curve.contact_count]
        depths[own] = max(float(curve.depth), least)
    means = (
        np.add.reduceat(points, contacts["first_point"]) / contacts["point_count"][:, None]
        if len(contacts)
        else np.empty((0, 3))
    )
    return [
        ContactData((of_objects[a], of_objects[b]), (ta, tb), mean, normal, float(depth))
        for a, b, ta, tb, mean, normal, depth in zip(
            contacts["object_a"].tolist(),
            contacts["object_b"].tolist(),
            contacts["triangle_a"].tolist(),
            contacts["triangle_b"].tolist(),
            means,
            contacts["normal"],
            depths,
        )
    ]


def scene_to_collision(scene: Any) -> tuple[CollisionManager, dict[str, Object]]:
    """The manager of all meshes of a `trimesh.Scene`, and its objects by node."""
    manager = CollisionManager()
    objects = {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        objects[node] = manager.add_object(node, scene.geometry[geometry], transform)
    return manager, objects


def _matrix(transform: Any) -> Floats:
    matrix = _IDENTITY if transform is None else np.array(transform, np.float64, order="C")
    if matrix.shape != (4, 4):
        raise ValueError("transform must be (4,4)!")
    if matrix[3].tolist() != [0, 0, 0, 1]:
        raise ValueError(f"the last row of the transform is {matrix[3].tolist()}; it must be 0, 0, 0, 1")
    return matrix


def _equal(a: Mesh, b: Mesh) -> bool:
    return all(
        np.array_equal(getattr(a, name), getattr(b, name), equal_nan=name == "positions")
        for name in ("positions", "triangles", "edges", "points")
    )


def _answer(first: Any, names: Any, data: Any, return_names: bool, return_data: bool) -> Any:
    answer = [first] + [names] * return_names + [data] * return_data
    return tuple(answer) if len(answer) > 1 else first
