"""The scene: objects that bend, and all contacts between them."""

from __future__ import annotations

import math
import operator
import weakref
from typing import TYPE_CHECKING, Any, Callable, Iterator, Mapping, NamedTuple

import numpy as np

from . import _arrays, _core
from ._contracts import contract
from ._core import Error, Stop
from ._meshes import arrays_of_object
from ._object import Object
from ._queries import Queries
from ._result import Result, SavedResult
from ._tables import record, table

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .typing import ContinuousContact, DetectRequest, LimitingPair, ObjectOptions, SceneOptions


class SafeStep(NamedTuple):
    """The safe part of a step, 0 to 1, and the pair that ends it; None for the whole step.

    `stopped`: `stop` or `seconds` ended the call before its search was complete; the step is 0, although there
    may be a larger one.
    """

    step: float
    limit: LimitingPair | None
    stopped: bool = False


class ObjectStep(NamedTuple):
    """The safe part of the step of one object. Objects of one island move by the same part."""

    object: Object
    island: Object
    step: float
    limit: LimitingPair | None
    stopped: bool = False


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


PairFilter = Callable[[Object, Object], bool]


class Scene(Queries, _arrays.NotCopied):
    """Deforming objects and all contacts between them.

    Options are keywords; `supple.options("SceneOptions")` lists all with their values and defaults.
    `contacts` is a set of kinds: `{"intersection", "continuous", "proximity", "penetration"}`.

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

    def __init__(self, **options: Unpack[SceneOptions]) -> None:
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
        **options: Unpack[ObjectOptions],
    ) -> Object:
        """Adds an object and builds its octree, O(n log n), without the GIL.

        `mesh` is an (n, 3) array of positions with `triangles` (m, 3), the path of a file, or a mesh of
        supple, trimesh, meshio, PyVista or Open3D. `edges` (k, 2) and `points` (k,) belong to no triangle,
        for rods and particles. `supple.options("ObjectOptions")` lists the options: `name`,
        `self_collision`, `static`, `margin`, `solid`, ... Positions are read in the precision and with the
        strides that they have. Copied once are arrays that are not aligned, not in the byte order of the
        machine, or not of float32, float64, int32, int64, uint16 or uint32.
        """
        xyz, faces, keywords, edges, points = arrays_of_object(mesh, triangles, edges, points, options)
        if same_vertex is not None:
            same_vertex = _arrays.ids(same_vertex, "same_vertex")
        identifier = self._core.add(_arrays.positions(xyz), faces, keywords, same_vertex, edges, points)
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
GIL, for each pair of objects whose volumes overlap, so it is slow: prefer `group` and `mask`, or vertex
groups, which run without it. It must not call the scene. What it raises ends the call of the scene.""",
    )
    def set_pair_filter(self, accepts: PairFilter | None) -> None:
        self._core.set_pair_filter(self._wrapped(accepts, "set_pair_filter: the filter"))

    def detect(self, *, stop: Stop | None = None, **request: Unpack[DetectRequest]) -> Result:
        """Finds all contacts.

        Options of the scene can have other values for this call: `contacts`, those of continuous contacts
        (`supple.options("ImpactOptions")`), `proximity_listing`, `element_kinds`, `continuous_listing`,
        `manifolds` and `curves`. `max_contacts` is the largest number of contacts of each kind: the first
        ones in canonical order. The last result stays valid as long as you hold it or one of its lists.
        """
        # Nothing of the last result is kept unless somebody holds it.
        self._result = self._no_result
        self._result = Result(self._core.detect(request, stop), self._core)
        return self._result

    @contract("Scene::search", "Its lists are copies.")
    def search(
        self, *, only: PairFilter | None = None, stop: Stop | None = None, **request: Unpack[DetectRequest]
    ) -> SavedResult:
        found = self._core.search(request, self._wrapped(only, "search: only"), stop)
        lists = {name: table(raw, self._core) for name, raw in found.items() if isinstance(raw, tuple)}
        return SavedResult(lists, {"stopped": found["stopped"], "truncated": found["truncated"]})

    @property
    def result(self) -> Result:
        """The result of the last `detect`; empty before the first one."""
        return self._result

    @contract("verify")
    def verify(self, *, stop: Stop | None = None) -> VerifyReport:
        return VerifyReport(self._core.verify(stop), self._core)

    @contract("Scene::earliest_impact")
    def earliest_impact(self, *, stop: Stop | None = None) -> ContinuousContact | None:
        return record(self._core.earliest_impact(stop), self._core)

    @contract("Scene::max_step")
    def max_step(self, *, seconds: float = math.inf, stop: Stop | None = None) -> SafeStep:
        step, limit, stopped = self._core.max_step(_arrays.number(seconds, "seconds"), stop)
        return SafeStep(step, record(limit, self._core), stopped)

    @contract("Scene::collision_free_step")
    def collision_free_step(
        self, keep: float = 0.2, *, seconds: float = math.inf, stop: Stop | None = None
    ) -> SafeStep:
        step, limit, stopped = self._core.collision_free_step(
            _arrays.number(keep, "keep"), _arrays.number(seconds, "seconds"), stop
        )
        return SafeStep(step, record(limit, self._core), stopped)

    @contract("Scene::collision_free_steps")
    def collision_free_steps(
        self, keep: float = 0.2, *, seconds: float = math.inf, stop: Stop | None = None
    ) -> list[ObjectStep]:
        steps = self._core.collision_free_steps(
            _arrays.number(keep, "keep"), _arrays.number(seconds, "seconds"), stop
        )
        return [
            ObjectStep(self._object(each), self._object(island), step, record(limit, self._core), stopped)
            for each, island, step, limit, stopped in steps
        ]

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

    def _object(self, identifier: Any) -> Object:
        return self._objects[int(identifier.index)]

    def _wrapped(self, accepts: PairFilter | None, what: str) -> Any:
        _arrays.function(accepts, what, "two objects")
        if accepts is None:
            return None
        # The scene keeps the function, so the function must not keep the scene.
        this = weakref.ref(self)

        def decide(a: Any, b: Any) -> bool:
            scene = this()
            answer = True if scene is None else accepts(scene._object(a), scene._object(b))
            return bool(answer) if isinstance(answer, np.bool_) else answer

        return decide
