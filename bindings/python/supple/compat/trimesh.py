"""The calls of `trimesh.collision`, on supple: `CollisionManager`, `ContactData`, `DistanceData`,
`scene_to_collision`.

    from supple.compat.trimesh import CollisionManager

Differences: meshes are surfaces, never convex solids. Where a mesh is watertight, an object inside it
collides, too. The depth of a contact is that of its curve of intersection: how far the first object must
move along the curve's normal to leave the other one. The distance of objects that intersect is 0, not
negative.
"""

from __future__ import annotations

from typing import Any, Iterable

import numpy as np
import numpy.typing as npt

from .._meshes import Mesh, as_mesh, fault_of_solid
from .._object import Object
from .._scene import Scene

_EXTERNAL = "__external"


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
    def __init__(self, mesh: Mesh, transform: npt.NDArray[np.float64], added: Object, solid: bool) -> None:
        self.mesh, self.added, self.solid = mesh, added, solid
        self.corners = _corners(mesh.positions)
        self.transform = transform

    def box(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        placed = self.corners @ self.transform[:3, :3].T + self.transform[:3, 3]
        return placed.min(axis=0), placed.max(axis=0)


def _corners(points: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    finite = points[np.isfinite(points).all(axis=1)]
    if not len(finite):
        return np.full((1, 3), np.inf)
    box = np.stack([finite.min(axis=0), finite.max(axis=0)])
    return np.array([[box[i, 0], box[j, 1], box[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])


class CollisionManager:
    """Named meshes with transforms, and the questions of `trimesh.collision.CollisionManager` about them."""

    def __init__(self) -> None:
        self._scene = Scene(contacts="intersection")
        self._entries: dict[str, _Entry] = {}

    def add_object(self, name: str, mesh: Any, transform: Any = None) -> Object:
        """Adds a mesh with a (4, 4) transform; replaces the one with this name."""
        entry = self._add(mesh, transform, name)
        if name in self._entries:
            self._entries[name].added.remove()
        self._entries[name] = entry
        return entry.added

    def remove_object(self, name: str) -> None:
        """Removes the object with this name."""
        self._entry(name).added.remove()
        del self._entries[name]

    def set_transform(self, name: str, transform: Any) -> None:
        """Replaces the transform of an object."""
        entry = self._entry(name)
        entry.transform = _matrix(transform)
        entry.added.set_transform(entry.transform)

    def in_collision_single(
        self, mesh: Any, transform: Any = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Whether a mesh collides with any object; with the names of these objects and the contacts, if
        wanted."""
        external = self._add(mesh, transform, _EXTERNAL)
        try:
            names = {entry.added.index: name for name, entry in self._entries.items()} | {
                external.added.index: _EXTERNAL
            }
            others = [(entry, external) for entry in self._entries.values()]
            hit, pairs, data = self._collide(self._overlapping(others), names, return_names, return_data)
        finally:
            external.added.remove()
        return _answer(
            hit,
            {name for pair in pairs for name in pair if name != _EXTERNAL},
            data,
            return_names,
            return_data,
        )

    def in_collision_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Whether any two objects collide; with the pairs of their names and the contacts, if wanted."""
        names = {entry.added.index: name for name, entry in self._entries.items()}
        entries = {entry.added.index: entry for entry in self._entries.values()}
        found = self._scene.search(contacts="none").object_pairs
        overlapping = [(entries[a], entries[b]) for a, b in zip(found["a"].tolist(), found["b"].tolist())]
        hit, pairs, data = self._collide(overlapping, names, return_names, return_data)
        return _answer(hit, {tuple(sorted(pair)) for pair in pairs}, data, return_names, return_data)

    def in_collision_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Whether an object collides with one of another manager; names are (own, other)."""
        both = _Both(self, other_manager)
        hit, pairs, data = both.manager._collide(
            both.manager._overlapping(both.pairs), both.names, return_names, return_data
        )
        return _answer(
            hit,
            {both.ordered(pair) for pair in pairs},
            [both.renamed(each) for each in data],
            return_names,
            return_data,
        )

    def min_distance_single(
        self, mesh: Any, transform: Any = None, return_name: bool = False, return_data: bool = False
    ) -> Any:
        """The smallest distance of a mesh to all objects; with the name of the nearest one and data, if
        wanted."""
        external = self._add(mesh, transform, _EXTERNAL)
        try:
            names = {entry.added.index: name for name, entry in self._entries.items()} | {
                external.added.index: _EXTERNAL
            }
            distance, pair, data = self._nearest(
                [(entry, external) for entry in self._entries.values()], names
            )
        finally:
            external.added.remove()
        name = next((each for each in pair or () if each != _EXTERNAL), None)
        return _answer(distance, name, data, return_name, return_data)

    def min_distance_internal(
        self, name: str | None = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """The smallest distance of any two objects, or of one object to all others."""
        names = {entry.added.index: each for each, entry in self._entries.items()}
        entries = list(self._entries.values())
        if name is not None:
            own = self._entry(name)
            pairs = [(own, entry) for entry in entries if entry is not own]
        else:
            pairs = [(a, b) for i, a in enumerate(entries) for b in entries[i + 1 :]]
        distance, pair, data = self._nearest(pairs, names)
        return _answer(
            distance, None if pair is None else tuple(sorted(pair)), data, return_names, return_data
        )

    def min_distance_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """The smallest distance of an object to one of another manager; names are (own, other)."""
        both = _Both(self, other_manager)
        distance, pair, data = both.manager._nearest(both.pairs, both.names)
        return _answer(
            distance,
            None if pair is None else both.ordered(pair),
            None if data is None else both.renamed(data),
            return_names,
            return_data,
        )

    def _add(self, mesh: Any, transform: Any, name: str) -> _Entry:
        matrix = _matrix(transform)
        made = as_mesh(mesh, name=str(name))
        solid = len(made.triangles) > 0 and not fault_of_solid(made)
        added = self._scene.add(made, solid=solid)
        if not np.array_equal(matrix, np.eye(4)):
            added.set_transform(matrix)
        return _Entry(made, matrix, added, solid)

    def _entry(self, name: str) -> _Entry:
        if name not in self._entries:
            raise ValueError(f"{name} not in collision manager!")
        return self._entries[name]

    @staticmethod
    def _overlapping(pairs: Iterable[tuple[_Entry, _Entry]]) -> list[tuple[_Entry, _Entry]]:
        return [(a, b) for a, b in pairs if _box_distance(a.box(), b.box()) == 0]

    def _collide(
        self,
        overlapping: list[tuple[_Entry, _Entry]],
        names: dict[int, str],
        return_names: bool,
        return_data: bool,
    ) -> tuple[bool, list[tuple[str, str]], list[ContactData]]:
        wants_all = return_names or return_data
        touching: list[tuple[str, str]] = []
        others = set()
        for a, b in overlapping:
            if self._scene.any_contact(a.added, b.added):
                touching.append((names[a.added.index], names[b.added.index]))
                if not wants_all:
                    return True, touching, []
            elif a.solid or b.solid:
                others.add(frozenset((a.added.index, b.added.index)))
        if others:
            # They do not touch, so one is inside the other or they are apart.
            search = self._scene.search(
                contacts="penetration",
                depths="deepest",
                only=lambda a, b: frozenset((a.index, b.index)) in others,
            )
            parts = search.contained_parts
            touching += {(names[int(a)], names[int(b)]) for a, b in zip(parts["inner"], parts["outer"])}
        data = self._contact_data(overlapping, names) if return_data else []
        return bool(touching), touching, data

    def _contact_data(
        self, overlapping: list[tuple[_Entry, _Entry]], names: dict[int, str]
    ) -> list[ContactData]:
        wanted = {frozenset((a.added.index, b.added.index)) for a, b in overlapping}
        found = self._scene.search(
            contacts="penetration",
            curves=True,
            depths="deepest",
            only=lambda a, b: frozenset((a.index, b.index)) in wanted,
        )
        contacts, points = found.contacts, found.contact_points["position"]
        depths = np.zeros(len(contacts))
        for curve in found.curves:
            depths[found.curve_contacts[curve.first_contact : curve.first_contact + curve.contact_count]] = (
                curve.depth
            )
        means = (
            np.add.reduceat(points, contacts["first_point"]) / contacts["point_count"][:, None]
            if len(contacts)
            else np.empty((0, 3))
        )
        return [
            ContactData((names[a], names[b]), (ta, tb), mean, normal, float(depth))
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

    def _nearest(
        self, pairs: list[tuple[_Entry, _Entry]], names: dict[int, str]
    ) -> tuple[float, tuple[str, str] | None, DistanceData | None]:
        boxes = {id(each): each.box() for pair in pairs for each in pair}
        bounded = sorted(((_box_distance(boxes[id(a)], boxes[id(b)]), i) for i, (a, b) in enumerate(pairs)))
        best, nearest = np.inf, None
        for bound, i in bounded:
            if bound * (1 - 1e-9) > best:
                break
            found = self._scene.distance(pairs[i][0].added, pairs[i][1].added)
            if found is not None and found.distance < best:
                best, nearest = float(found.distance), found
        if nearest is None:
            return best, None, None
        pair = names[int(nearest.object_a)], names[int(nearest.object_b)]
        points = nearest.point_a, nearest.point_b
        faces = self._face(nearest.object_a, points[0]), self._face(nearest.object_b, points[1])
        return best, pair, DistanceData(pair, faces, points, best)

    def _face(self, index: Any, point: Any) -> int:
        return int(self._scene.closest([point], object=self._scene[int(index)])["triangle"][0])


class _Both:
    """The objects of two managers in one, whose names may be equal."""

    def __init__(self, own: CollisionManager, other: CollisionManager) -> None:
        self.manager = CollisionManager()
        self._places: dict[str, tuple[int, str]] = {}
        sides: list[list[_Entry]] = []
        for side, source in enumerate((own, other)):
            sides.append([])
            for name, entry in source._entries.items():
                key = f"{side}:{name}"
                self._places[key] = (side, name)
                self.manager.add_object(key, entry.mesh, entry.transform)
                sides[-1].append(self.manager._entries[key])
        self.names = {entry.added.index: key for key, entry in self.manager._entries.items()}
        self.pairs = [(a, b) for a in sides[0] for b in sides[1]]

    def ordered(self, pair: tuple[str, str]) -> tuple[str, str]:
        (_, own), (_, other) = sorted(self._places[key] for key in pair)
        return own, other

    def renamed(self, data: Any) -> Any:
        data.names = {self._places[key][1] for key in data.names}
        data._faces = {self._places[key][1]: value for key, value in data._faces.items()}
        if isinstance(data, DistanceData):
            data._points = {self._places[key][1]: value for key, value in data._points.items()}
        return data


def scene_to_collision(scene: Any) -> tuple[CollisionManager, dict[str, Object]]:
    """The manager of all meshes of a `trimesh.Scene`, and its objects by node."""
    manager = CollisionManager()
    objects = {}
    for node in scene.graph.nodes_geometry:
        transform, geometry = scene.graph[node]
        objects[node] = manager.add_object(node, scene.geometry[geometry], transform)
    return manager, objects


def _matrix(transform: Any) -> npt.NDArray[np.float64]:
    matrix = np.eye(4) if transform is None else np.asarray(transform, np.float64)
    if matrix.shape != (4, 4):
        raise ValueError("transform must be (4,4)!")
    return matrix


def _box_distance(a: Any, b: Any) -> float:
    gaps = np.maximum(0, np.maximum(a[0] - b[1], b[0] - a[1]))
    # Rounded corners must not hide a pair.
    scale = max(float(np.abs(each).max()) for each in (*a, *b))
    distance = float(np.linalg.norm(gaps))
    return 0.0 if distance <= 1e-12 * scale else distance


def _answer(first: Any, names: Any, data: Any, return_names: bool, return_data: bool) -> Any:
    answer = [first] + [names] * return_names + [data] * return_data
    return tuple(answer) if len(answer) > 1 else first
