"""The scene: objects that bend, and all contacts between them."""

from __future__ import annotations

import operator
import weakref
from typing import Any, Callable, Iterable, Iterator, Mapping, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._contracts import contract
from ._core import Error, Stop
from ._meshes import arrays_of
from ._result import Result, SavedResult
from ._tables import Record, Table, record, table


class SafeStep(NamedTuple):
    """The safe part of a step, 0 to 1, and the pair that ends it; None for the whole step."""

    step: float
    limit: Record | None


class ObjectStep(NamedTuple):
    """The safe part of the step of one object. Objects of one island move by the same part."""

    object: Object
    island: Object
    step: float
    limit: Record | None


class WrongAnswer(NamedTuple):
    """An answer that differs from that of exact brute force."""

    query: int
    found: str
    expected: str


class VerifyReport:
    """What `Scene.verify` compared; the lists of differences are empty when both agree."""

    def __init__(self, facts: Mapping[str, Any], scene: Any) -> None:
        self.stopped: bool = facts["stopped"]
        self.checked = {
            name: value for name, value in facts.items() if isinstance(value, int) and name != "stopped"
        }
        self.differences = {
            name: table(value, scene) for name, value in facts.items() if isinstance(value, tuple)
        }

    @property
    def agrees(self) -> bool:
        """Whether there is no difference."""
        return not any(len(each) for each in self.differences.values())

    def __bool__(self) -> bool:
        return self.agrees and not self.stopped

    def __repr__(self) -> str:
        count = sum(len(each) for each in self.differences.values())
        return f"<supple.VerifyReport: {'agrees' if self.agrees else f'{count} differences'}; {self.checked}>"


class Object:
    """An object of a scene. `index` is what the results call it; it counts as this number in comparisons."""

    __slots__ = ("_scene", "_id")

    def __init__(self, scene: Scene, identifier: Any) -> None:
        self._scene = scene
        self._id = identifier

    @property
    def index(self) -> int:
        """The number of the object in `object_a` and `object_b`. A scene uses the number of a removed object again."""
        return int(self._id.index)

    @property
    def generation(self) -> int:
        """How often the scene used this number before."""
        return int(self._id.generation)

    @property
    def name(self) -> str:
        """The name in messages and results."""
        return str(self._scene._core.name(self._id))

    @property
    def vertex_count(self) -> int:
        """The number of vertices."""
        return int(self._scene._core.vertex_count(self._id))

    @property
    def triangle_count(self) -> int:
        """The number of triangles."""
        return int(self._scene._core.triangle_count(self._id))

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """The positions that the exact tests use, (n, 3), as a copy. Set it to move the object."""
        return self._scene._core.positions(self._id)

    @positions.setter
    def positions(self, value: Any) -> None:
        self._scene._core.set_positions(self._id, _arrays.positions(value))

    @property
    def triangles(self) -> npt.NDArray[np.uint32]:
        """The vertex ids of each triangle, (m, 3), as a copy."""
        return self._scene._core.triangles(self._id)

    @contract("Scene::set_positions")
    def set_positions(self, positions: Any) -> None:
        self.positions = positions

    @contract("Scene::set_vertices")
    def set_vertices(self, vertices: Any, positions: Any) -> None:
        self._scene._core.set_vertices(
            self._id, _arrays.ids(vertices, "vertices"), _arrays.positions(positions)
        )

    @contract(
        "Scene::share_positions",
        """The array stays in use until the object gets other positions or is
removed. It must be an array whose memory the scene can read: an array that had to be copied is an error.""",
    )
    def share_positions(self, positions: Any) -> None:
        array = _arrays.positions(positions)
        if (
            array is not positions
            and not np.may_share_memory(array, _arrays.as_numpy(positions, "positions"))
            and array.size
        ):
            raise Error(
                "these positions cannot be shared, because they are converted; give an array of float32 or float64"
            )
        self._scene._core.share_positions(self._id, array, array)

    @contract("Scene::set_motion")
    def set_motion(self, start: Any, end: Any) -> None:
        self._scene._core.set_motion(
            self._id, _arrays.positions(start, "start"), _arrays.positions(end, "end")
        )

    @contract("Scene::translate")
    def translate(self, offset: Any) -> None:
        self._scene._core.translate(self._id, *_arrays.doubles(offset, "the offset", 3).tolist())

    @contract(
        "Scene::set_transform",
        """`transform` is a (4, 4) or (3, 4) matrix: the rotation in the first three
columns, the translation in the last one. `supple.rigid_transform` makes that of a quaternion.""",
    )
    def set_transform(self, transform: Any) -> None:
        matrix = _arrays.as_numpy(transform, "the transform")
        if matrix.shape == (4, 4) and not np.array_equal(matrix[3], (0, 0, 0, 1)):
            raise Error(f"the last row of the transform is {matrix[3].tolist()}; it must be 0, 0, 0, 1")
        self._scene._core.set_transform(self._id, _arrays.doubles(matrix, "the transform", -1, 4))

    @contract("Scene::set_vertex_groups")
    def set_vertex_groups(self, groups: Any, masks: Any) -> None:
        self._scene._core.set_vertex_groups(
            self._id, _arrays.ids(groups, "groups"), _arrays.ids(masks, "masks")
        )

    @contract("Scene::set_static")
    def set_static(self, static: bool) -> None:
        self._scene._core.set_static(self._id, _arrays.truth(static, "static"))

    @contract("Scene::set_group")
    def set_group(self, group: int, mask: int = 0xFFFFFFFF) -> None:
        self._scene._core.set_group(self._id, _arrays.count(group, "group"), _arrays.count(mask, "mask"))

    @contract("Scene::set_margin")
    def set_margin(self, margin: float) -> None:
        self._scene._core.set_margin(self._id, _arrays.number(margin, "margin"))

    @contract("Scene::set_min_separation")
    def set_min_separation(self, separation: float) -> None:
        self._scene._core.set_min_separation(self._id, _arrays.number(separation, "separation"))

    @contract("Scene::set_self_collision")
    def set_self_collision(self, enabled: bool) -> None:
        self._scene._core.set_self_collision(self._id, _arrays.truth(enabled, "enabled"))

    @contract("Scene::remove")
    def remove(self) -> None:
        self._scene.remove(self)

    def __index__(self) -> int:
        return self.index

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Object):
            return self._scene is other._scene and (self.index, self.generation) == (
                other.index,
                other.generation,
            )
        return isinstance(other, (int, np.integer)) and self.index == int(other)

    def __hash__(self) -> int:
        return hash(self.index)

    def __repr__(self) -> str:
        if not self._scene._core.contains(self._id):
            return f"<supple.Object {self.index}, removed>"
        return f"<supple.Object {self.index} {self.name!r}: {self.vertex_count} vertices, {self.triangle_count} triangles>"


@contract(
    "RigidTransform::from_quaternion",
    "Returns a (4, 4) matrix for `Object.set_transform`.",
)
def rigid_transform(
    x: float, y: float, z: float, w: float, translation: Any = (0, 0, 0)
) -> npt.NDArray[np.float64]:
    matrix = np.eye(4)
    matrix[:3, :3] = _core.rotation_of_quaternion(x, y, z, w).reshape(3, 3)
    matrix[:3, 3] = _arrays.doubles(translation, "the translation", 3)
    return matrix


PairFilter = Callable[[Object, Object], bool]


class Scene:
    """Deforming objects and all contacts between them.

    Options are keywords; `supple.options("SceneOptions")` lists all with their values and defaults. `contacts`
    is a set of kinds: `{"intersection", "continuous", "proximity", "penetration"}`.

        scene = supple.Scene(contacts={"intersection", "proximity"})
        cloth = scene.add(V, F, name="cloth", self_collision=True, margin=0.002)
        ball = scene.add("ball.obj", static=True, margin=0.002)
        for step in range(300):
            cloth.positions = x = solver.step(scene.result)
            result = scene.detect()

    Calls of one scene from several threads wait for each other, except queries, which run at the same time.
    All calls run without the GIL, so two scenes in two threads use two cores. Ctrl-C stops a call.
    """

    __slots__ = ("_core", "_objects", "_result", "_no_result", "__weakref__")

    def __init__(self, **options: Any) -> None:
        self._core = _core.Scene(_arrays.keywords(options))
        self._objects: dict[int, Object] = {}
        self._result = self._no_result = Result(_core.Result(), self._core)

    def add(
        self,
        mesh: Any,
        triangles: Any = None,
        *,
        edges: Any = None,
        points: Any = None,
        same_vertex: Any = None,
        **options: Any,
    ) -> Object:
        """Adds an object and builds its octree, O(n log n), without the GIL.

        `mesh` is an (n, 3) array of positions with `triangles` (m, 3), the path of a file, or a mesh of supple,
        trimesh, meshio, PyVista or Open3D. `edges` (k, 2) and `points` (k,) belong to no triangle, for rods and
        particles. `supple.options("ObjectOptions")` lists the options: `name`, `self_collision`, `static`, `margin`,
        `solid`, ... Positions are read in the precision and with the strides that they have. Copied once are arrays
        that are not aligned, not in the byte order of the machine, or not of float32, float64, int32, int64, uint16
        or uint32.
        """
        if triangles is None and isinstance(mesh, np.ndarray) and (edges is not None or points is not None):
            triangles = ()  # rods and particles alone
        xyz, faces, name, own_edges, own_points = arrays_of(mesh, triangles)
        options.setdefault("name", name)
        options = _arrays.keywords(options)
        identifier = self._core.add(
            _arrays.positions(xyz),
            _arrays.triangles(faces),
            options,
            None if same_vertex is None else _arrays.ids(same_vertex, "same_vertex"),
            _arrays.ids(own_edges if edges is None else edges, "edges", 2),
            _arrays.ids(own_points if points is None else points, "points"),
        )
        added = Object(self, identifier)
        self._objects[added.index] = added
        return added

    @contract("Scene::remove", "Takes an `Object`, its index or its name.")
    def remove(self, removed: Any) -> None:
        identifier = self._id(removed)
        self._core.remove(identifier)
        del self._objects[int(identifier.index)]

    def set_positions(self, positions: Mapping[Any, Any]) -> None:
        """Sets the positions of several objects, all or none: `scene.set_positions({cloth: x, ball: y})`."""
        if not isinstance(positions, Mapping):
            raise Error("set_positions: give a dict of positions by object")
        found: dict[int, tuple[Object, Any]] = {}
        for each, value in positions.items():
            moved, array = self._one(each), _arrays.positions(value)
            if moved.index in found:
                raise Error(f"set_positions: object {moved.index} ({moved.name}) occurs twice")
            if len(array) != moved.vertex_count:
                raise Error(
                    f"set_positions: {len(array)} positions for {moved.name}, which has {moved.vertex_count} vertices"
                )
            found[moved.index] = moved, array
        for moved, array in found.values():
            self._core.set_positions(moved._id, array)

    @contract(
        "Scene::set_pair_filter",
        """The function gets two `Object`s and returns a bool. It is called with the
GIL, for each pair of objects whose volumes overlap, so it is slow: prefer `group` and `mask`, or vertex groups, which
run without it. It must not call the scene. What it raises ends the call of the scene.""",
    )
    def set_pair_filter(self, accepts: PairFilter | None) -> None:
        self._core.set_pair_filter(self._wrapped(accepts))

    def detect(self, *, stop: Stop | None = None, **request: Any) -> Result:
        """Finds all contacts; see the options of `DetectRequest`: `contacts`, `max_contacts`, those of continuous
        contacts, ... The lists of the last result stay valid as long as you hold the result or one of them."""
        # Nothing of the last result is kept unless somebody holds it.
        self._result = self._no_result
        self._result = Result(self._core.detect(request, stop), self._core)
        return self._result

    @contract("Scene::search", "Its lists are copies.")
    def search(
        self, *, only: PairFilter | None = None, stop: Stop | None = None, **request: Any
    ) -> SavedResult:
        found = self._core.search(request, self._wrapped(only), stop)
        lists = {name: table(raw, self._core) for name, raw in found.items() if isinstance(raw, tuple)}
        return SavedResult(lists, {"stopped": found["stopped"], "truncated": found["truncated"]})

    @property
    def result(self) -> Result:
        """The result of the last `detect`; empty before the first one."""
        return self._result

    @contract("Scene::verify")
    def verify(self, *, stop: Stop | None = None) -> VerifyReport:
        return VerifyReport(self._core.verify(stop), self._core)

    @contract("Scene::earliest_impact")
    def earliest_impact(self) -> Record | None:
        return record(self._core.earliest_impact(), self._core)

    @contract("Scene::max_step")
    def max_step(self) -> SafeStep:
        step, limit = self._core.max_step()
        return SafeStep(step, record(limit, self._core))

    @contract("Scene::collision_free_step")
    def collision_free_step(self, keep: float = 0.2) -> SafeStep:
        step, limit = self._core.collision_free_step(_arrays.number(keep, "keep"))
        return SafeStep(step, record(limit, self._core))

    @contract("Scene::collision_free_steps")
    def collision_free_steps(self, keep: float = 0.2) -> list[ObjectStep]:
        return [
            ObjectStep(self._object(each), self._object(island), step, record(limit, self._core))
            for each, island, step, limit in self._core.collision_free_steps(_arrays.number(keep, "keep"))
        ]

    # Queries.

    @contract(
        "Scene::closest",
        "`points` is (n, 3). The answer is a table with n rows; `found` says which have an answer.",
    )
    def closest(
        self,
        points: Any,
        *,
        max_distance: float = np.inf,
        signed: bool = False,
        object: Any = None,
        mask: int = 0xFFFFFFFF,
        stop: Stop | None = None,
    ) -> Table:
        return self._query(
            self._core.closest(
                _arrays.doubles(points, "points", -1, 3),
                self._filter(object),
                _arrays.count(mask, "mask"),
                max_distance,
                signed,
                stop,
            )
        )

    @contract(
        "Scene::cast",
        "`origins` and `directions` are (n, 3). The answer is a table with n rows; `found` says "
        "which rays hit something.",
    )
    def cast(
        self,
        origins: Any,
        directions: Any,
        *,
        count_hits: bool = False,
        object: Any = None,
        mask: int = 0xFFFFFFFF,
        stop: Stop | None = None,
    ) -> Table:
        return self._query(
            self._core.cast(
                _rows(origins, directions, "origins", "directions"),
                self._filter(object),
                _arrays.count(mask, "mask"),
                count_hits,
                stop,
            )
        )

    @contract("Scene::cast_all", "`origins` and `directions` are (n, 3).")
    def cast_all(
        self,
        origins: Any,
        directions: Any,
        *,
        object: Any = None,
        mask: int = 0xFFFFFFFF,
        stop: Stop | None = None,
    ) -> Table:
        return self._query(
            self._core.cast_all(
                _rows(origins, directions, "origins", "directions"),
                self._filter(object),
                _arrays.count(mask, "mask"),
                stop,
            )
        )

    @contract("Scene::overlaps", "Boxes are their lowest and highest corners, both (n, 3).")
    def overlaps_boxes(
        self,
        lowest: Any,
        highest: Any,
        *,
        object: Any = None,
        mask: int = 0xFFFFFFFF,
        stop: Stop | None = None,
    ) -> Table:
        return self._query(
            self._core.overlaps_boxes(
                _rows(lowest, highest, "lowest", "highest"),
                self._filter(object),
                _arrays.count(mask, "mask"),
                stop,
            )
        )

    @contract("Scene::overlaps", "Spheres are their centers (n, 3) and radii, (n,) or one for all.")
    def overlaps_spheres(
        self,
        centers: Any,
        radii: Any,
        *,
        object: Any = None,
        mask: int = 0xFFFFFFFF,
        stop: Stop | None = None,
    ) -> Table:
        return self._query(
            self._core.overlaps_spheres(
                _spheres(centers, radii), self._filter(object), _arrays.count(mask, "mask"), stop
            )
        )

    @contract(
        "Scene::inside",
        "`points` is (n, 3). The answer is (n,): 0 outside, 1 on a triangle, 2 inside, as "
        "`supple.Containment`.",
    )
    def inside(
        self, points: Any, *, object: Any = None, mask: int = 0xFFFFFFFF, stop: Stop | None = None
    ) -> npt.NDArray[np.uint8]:
        return self._query(
            self._core.inside(
                _arrays.doubles(points, "points", -1, 3),
                self._filter(object),
                _arrays.count(mask, "mask"),
                stop,
            )
        )

    @contract("Scene::distance")
    def distance(self, a: Any, b: Any, *, stop: Stop | None = None) -> Record | None:
        return record(self._core.distance(self._id(a), self._id(b), stop), self._core)

    @contract("Scene::distances")
    def distances(self, max_distance: float = np.inf, *, stop: Stop | None = None) -> Table:
        return self._query(self._core.distances(max_distance, stop))

    @contract("Scene::any_contact")
    def any_contact(self, a: Any, b: Any, *, stop: Stop | None = None) -> bool:
        return bool(self._core.any_contact(self._id(a), self._id(b), stop))

    # Checks of answers.

    @contract("Scene::verify_closest")
    def verify_closest(
        self,
        points: Any,
        answers: Table,
        *,
        max_distance: float = np.inf,
        signed: bool = False,
        object: Any = None,
        mask: int = 0xFFFFFFFF,
    ) -> list[WrongAnswer]:
        return _wrong(
            self._core.verify_closest(
                _arrays.doubles(points, "points", -1, 3),
                _bytes(answers),
                self._filter(object),
                _arrays.count(mask, "mask"),
                max_distance,
                signed,
            )
        )

    @contract("Scene::verify_cast")
    def verify_cast(
        self,
        origins: Any,
        directions: Any,
        answers: Table,
        *,
        count_hits: bool = False,
        object: Any = None,
        mask: int = 0xFFFFFFFF,
    ) -> list[WrongAnswer]:
        return _wrong(
            self._core.verify_cast(
                _rows(origins, directions, "origins", "directions"),
                _bytes(answers),
                self._filter(object),
                _arrays.count(mask, "mask"),
                count_hits,
            )
        )

    @contract("Scene::verify_cast_all")
    def verify_cast_all(
        self, origins: Any, directions: Any, hits: Table, *, object: Any = None, mask: int = 0xFFFFFFFF
    ) -> list[WrongAnswer]:
        return _wrong(
            self._core.verify_cast_all(
                _rows(origins, directions, "origins", "directions"),
                _bytes(hits),
                self._filter(object),
                _arrays.count(mask, "mask"),
            )
        )

    @contract("Scene::verify_overlaps")
    def verify_overlaps_boxes(
        self, lowest: Any, highest: Any, found: Table, *, object: Any = None, mask: int = 0xFFFFFFFF
    ) -> list[WrongAnswer]:
        return _wrong(
            self._core.verify_overlaps_boxes(
                _rows(lowest, highest, "lowest", "highest"),
                _bytes(found),
                self._filter(object),
                _arrays.count(mask, "mask"),
            )
        )

    @contract("Scene::verify_overlaps")
    def verify_overlaps_spheres(
        self, centers: Any, radii: Any, found: Table, *, object: Any = None, mask: int = 0xFFFFFFFF
    ) -> list[WrongAnswer]:
        return _wrong(
            self._core.verify_overlaps_spheres(
                _spheres(centers, radii), _bytes(found), self._filter(object), _arrays.count(mask, "mask")
            )
        )

    @contract("Scene::verify_inside")
    def verify_inside(
        self, points: Any, answers: Any, *, object: Any = None, mask: int = 0xFFFFFFFF
    ) -> list[WrongAnswer]:
        return _wrong(
            self._core.verify_inside(
                _arrays.doubles(points, "points", -1, 3),
                _containments(answers),
                self._filter(object),
                _arrays.count(mask, "mask"),
            )
        )

    @contract("Scene::verify_distance")
    def verify_distance(self, a: Any, b: Any, found: Record | None) -> list[WrongAnswer]:
        rows = np.empty(0, np.uint8) if found is None else _bytes(found._row)
        return _wrong(self._core.verify_distance(self._id(a), self._id(b), rows))

    @contract("Scene::verify_distances")
    def verify_distances(self, max_distance: float, found: Table) -> list[WrongAnswer]:
        return _wrong(self._core.verify_distances(max_distance, _bytes(found)))

    @contract("Scene::verify_any_contact")
    def verify_any_contact(self, a: Any, b: Any, found: bool) -> list[WrongAnswer]:
        return _wrong(self._core.verify_any_contact(self._id(a), self._id(b), bool(found)))

    # Objects.

    @property
    def objects(self) -> list[Object]:
        """All objects, by ascending index."""
        return [self._objects[index] for index in sorted(self._objects)]

    @property
    def options(self) -> dict[str, Any]:
        """The options of the scene."""
        return dict(self._core.options())

    def __getitem__(self, key: int | str) -> Object:
        """The object with this index or name; of several with one name the first."""
        if isinstance(key, str):
            named = [each for each in self.objects if each.name == key]
            if named:
                return named[0]
            names = [each.name for each in self.objects]
            raise KeyError(f"no object of the scene is called {key!r}; there are {names}")
        if isinstance(key, (bool, np.bool_)) or not hasattr(key, "__index__"):
            raise KeyError(f"{key!r} is no object of the scene; give an Object, its index or its name")
        found = self._objects.get(operator.index(key))
        if found is None:
            raise KeyError(f"the scene has no object {operator.index(key)}; it has {sorted(self._objects)}")
        return found

    def __len__(self) -> int:
        return len(self._objects)

    def __iter__(self) -> Iterator[Object]:
        return iter(self.objects)

    def __contains__(self, each: object) -> bool:
        if isinstance(each, Object):
            return each._scene is self and bool(self._core.contains(each._id))
        try:
            return bool(self[each])  # type: ignore[index]
        except KeyError:
            return False

    def __repr__(self) -> str:
        triangles = sum(each.triangle_count for each in self)
        return f"<supple.Scene: {len(self)} objects, {triangles} triangles; contacts: {self.options['contacts']}>"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{each.index}</td><td>{each.name}</td><td>{each.vertex_count}</td>"
            f"<td>{each.triangle_count}</td></tr>"
            for each in self
        )
        return (
            f"<table><tr><th>object</th><th>name</th><th>vertices</th><th>triangles</th></tr>{rows}</table>"
        )

    def _one(self, each: Any) -> Object:
        if not isinstance(each, Object):
            return self[each]
        if each._scene is not self:
            raise Error(f"object {each.index} is of another scene")
        return each

    def _id(self, each: Any) -> Any:
        return self._one(each)._id

    def _filter(self, each: Any) -> Any:
        return None if each is None else self._id(each)

    def _object(self, identifier: Any) -> Object:
        return self._objects[int(identifier.index)]

    def _wrapped(self, accepts: PairFilter | None) -> Any:
        if accepts is None:
            return None
        # The scene keeps the function, so the function must not keep the scene.
        this = weakref.ref(self)

        def decide(a: Any, b: Any) -> bool:
            scene = this()
            answer = True if scene is None else accepts(scene._object(a), scene._object(b))
            return bool(answer) if isinstance(answer, np.bool_) else answer

        return decide

    def _query(self, raw: Any) -> Any:
        return table(raw, self._core)


def _rows(a: Any, b: Any, what_a: str, what_b: str) -> npt.NDArray[np.float64]:
    first, second = _arrays.doubles(a, what_a, -1, 3), _arrays.doubles(b, what_b, -1, 3)
    if len(first) != len(second):
        raise Error(f"there are {len(first)} {what_a} and {len(second)} {what_b}; they must be equally many")
    return np.concatenate([first, second], axis=1)


def _spheres(centers: Any, radii: Any) -> npt.NDArray[np.float64]:
    points = _arrays.doubles(centers, "centers", -1, 3)
    radius = (
        np.broadcast_to(np.asarray(radii, np.float64), (len(points),))
        if np.ndim(radii) == 0
        else _arrays.doubles(radii, "radii", -1)
    )
    if len(radius) != len(points):
        raise Error(f"there are {len(points)} centers and {len(radius)} radii; they must be equally many")
    return np.concatenate([points, radius[:, None]], axis=1)


def _bytes(answers: Any) -> npt.NDArray[np.uint8]:
    if not isinstance(answers, Table):
        raise Error("the answers must be the table that the query returned")
    return np.ascontiguousarray(np.ndarray.view(answers, np.ndarray)).view(np.uint8).reshape(-1)


def _containments(answers: Any) -> npt.NDArray[np.uint8]:
    array = _arrays.as_numpy(answers, "answers")
    if (
        array.dtype.kind not in "iu"
        or array.ndim != 1
        or (array.size and not 0 <= array.min() <= array.max() <= 2)
    ):
        raise Error("the answers must be the numbers of supple.Containment, 0 to 2")
    return np.ascontiguousarray(array, np.uint8)


def _wrong(answers: Iterable[tuple[int, str, str]]) -> list[WrongAnswer]:
    return [WrongAnswer(*each) for each in answers]
