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

import weakref
from typing import Any

import numpy as np

from .._meshes import Mesh, as_mesh
from .._object import Object
from .._scene import Scene
from ._world import IDENTITY, Entry, Floats, Nearest, Places, World, lower_bounds, near_entries

_EXTERNAL = "__external"
_KEPT_EXTERNALS = 8


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


class CollisionManager:
    """Named meshes with transforms, and the questions of `trimesh.collision.CollisionManager` about them."""

    def __init__(self) -> None:
        self._entries: dict[str, Entry] = {}
        self._names: dict[int, str] = {}
        self._world = World(Scene(contacts="intersection"))
        self._scene = self._world.scene
        self._places = Places()
        self._externals: list[Places] = []
        self._shared: weakref.WeakKeyDictionary[CollisionManager, World] = weakref.WeakKeyDictionary()

    def add_object(self, name: str, mesh: Any, transform: Any = None) -> Object:
        """Adds a mesh with a (4, 4) transform; replaces the one with this name."""
        entry = Entry(as_mesh(mesh, name=str(name)), _matrix(transform))
        Places([entry])  # refuses the transform before anything changes
        added, replaced = self._world.object(entry), name in self._entries
        self._entries[name] = entry
        if replaced:
            self._change()
        else:
            self._names[id(entry)] = name
            self._places.add(entry)
        return added

    def remove_object(self, name: str) -> None:
        """Removes the object with this name."""
        self._entry(name)
        del self._entries[name]
        self._change()

    def set_transform(self, name: str, transform: Any) -> None:
        """Replaces the transform of an object."""
        self._places.move(self._entry(name), _matrix(transform))

    def in_collision_single(
        self, mesh: Any, transform: Any = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Whether a mesh collides with any object; with the names of these objects and the contacts, if
        wanted."""
        external, place = self._external(mesh, transform)
        pairs = near_entries(self._places, place, external)
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
        found = self._world.first_contact(near_entries(self._places, place, external)) or self._world.nearest(
            lower_bounds(self._places, place), self._places.entries, [external]
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
        pairs = self._world.overlapping(self._places)
        if own is not None:
            pairs = [pair for pair in pairs if own in pair]
        found = self._world.first_contact(pairs) or self._world.nearest(
            self._inner_bounds(own), self._places.entries, self._places.entries
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
        own, other = self._places, other_manager._places
        found = world.first_contact(world.overlapping(own, other))
        found = found or world.nearest(lower_bounds(own, other), own.entries, other.entries)
        names = {**self._names, **other_manager._names}
        return _answer(*self._distance(found, world, names, return_data), return_names, return_data)

    def _inner_bounds(self, own: Entry | None) -> Floats:
        """Bounds of each pair once; NaN elsewhere."""
        bounds, count = lower_bounds(self._places, self._places), len(self._entries)
        left_out = np.tri(count, dtype=bool)
        if own is not None:
            left_out = np.arange(count)[:, None] != own.number
            bounds[own.number, own.number] = np.nan
        return np.where(left_out, np.nan, bounds)

    def _change(self) -> None:
        self._names = {id(entry): name for name, entry in self._entries.items()}
        self._places = Places(self._entries.values())
        self._keep()

    def _keep(self) -> None:
        self._world.keep([*self._entries.values(), *(each.entries[0] for each in self._externals)])

    def _entry(self, name: str) -> Entry:
        if name not in self._entries:
            raise ValueError(f"{name} not in collision manager!")
        return self._entries[name]

    def _external(self, mesh: Any, transform: Any) -> tuple[Entry, Places]:
        """A mesh of one question, with its octree where it was in one of the last questions."""
        matrix, made = _matrix(transform), as_mesh(mesh, name=_EXTERNAL)
        known = [each for each in self._externals if _equal(each.entries[0].mesh, made)]
        place = known[0] if known else Places([Entry(made, matrix)])
        place.move(place.entries[0], matrix)
        self._externals = [place, *(each for each in self._externals if each is not place)][:_KEPT_EXTERNALS]
        if not known:
            self._keep()
        return place.entries[0], place

    def _world_with(self, other: CollisionManager) -> World:
        """The scene of what two managers have near each other."""
        if other is self:
            raise ValueError(
                "a manager has no collisions with itself as another one; use in_collision_internal"
            )
        world = self._shared.get(other)
        if world is None:
            world = self._shared[other] = World(Scene(contacts="intersection", threads=1))
        structure = self._places.structure, other._places.structure
        if world.structure != structure:
            world.structure = structure
            world.keep([*self._entries.values(), *other._entries.values()])
        return world

    def _answer(
        self,
        world: World,
        pairs: list[tuple[Entry, Entry]],
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
        found: Nearest, world: World, names: dict[int, str], return_data: bool
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
    world: World, touching: list[tuple[Entry, Entry]], names: dict[int, str]
) -> list[ContactData]:
    """All contacts of pairs that touch. A contact is as deep as its curve, and the only curve of two objects is
    at least as deep as their deepest vertex."""
    of_objects = {world.object(entry).index: names[id(entry)] for pair in touching for entry in pair}
    wanted = {frozenset((world.object(a).index, world.object(b).index)) for a, b in touching}
    found = world.scene.search(
        contacts="penetration",
        curves=True,
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
    matrix = IDENTITY if transform is None else np.array(transform, np.float64, order="C")
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
