"""Bodies of masses and springs, rigid objects, and objects with a motion of the user, with their
collisions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Iterable, Iterator, Mapping

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._contracts import contract
from ._core import Error, Stop
from ._meshes import Mesh, as_mesh
from ._result import Result
from ._scene import Scene

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .typing import (
        ContactResponse,
        DetectRequest,
        MassSpringMotion,
        MassSpringMotionHandle,
        MassSpringOptions,
        ObjectOptions,
        RigidMotion,
        SimulationOptions,
    )

Motion = Callable[[float, npt.NDArray[np.float64]], Any]


class SimulatedObject:
    """An object of a simulation. `index` is what the results call it."""

    __slots__ = ("_simulation", "_id", "mesh", "options")

    def __init__(self, simulation: Simulation, identifier: Any, mesh: Mesh, options: dict[str, Any]) -> None:
        self._simulation, self._id = simulation, identifier
        self.mesh, self.options = mesh, options

    @property
    def index(self) -> int:
        """The number of the object in `object_a` and `object_b`."""
        return int(self._id.index)

    @property
    def name(self) -> str:
        """The name in messages and results."""
        return str(self._simulation._core.name(self._id))

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """The positions of all vertices, (n, 3), as a copy. Set it to move an object; a body keeps its
        velocities."""
        return self._simulation._core.positions(self._id)

    @positions.setter
    def positions(self, value: Any) -> None:
        self._simulation._core.set_positions(self._id, _arrays.doubles(value, "positions", -1, 3))

    @property
    def velocities(self) -> npt.NDArray[np.float64] | None:
        """The velocities of the vertices of a body of masses and springs, (n, 3), m/s; None for other
        objects."""
        return self._simulation._core.velocities(self._id)

    def __index__(self) -> int:
        return self.index

    def __repr__(self) -> str:
        return f"<supple.SimulatedObject {self.index} {self.name!r}: {len(self.mesh.positions)} vertices>"


class Simulation(_arrays.NotCopied):
    """Moves objects by their own motion, step by step, and finds the collisions between them.

    Options are keywords; `supple.options("SimulationOptions")` lists them, with those of the scene:
    `time_step`, `border` (two corners), `seed`, `response` (a dict; see
    `supple.options("ContactResponse")`), `contacts`, ...

        simulation = supple.Simulation(border=[[-1, -1, -1], [1, 1, 1]], seed=1)
        simulation.add(supple.make_model("rabbit"), springs={"random_speed": 0.4})
        for result in simulation.run(1000, progress=True):
            ...
    """

    __slots__ = ("_core", "_objects", "_result", "_no_result", "__weakref__")

    def __init__(self, **options: Unpack[SimulationOptions]) -> None:
        if options.get("border") is not None:
            options["border"] = _arrays.doubles(options["border"], "the border", 2, 3)
        self._core = _core.Simulation(_arrays.keywords(options))
        self._objects: dict[int, SimulatedObject] = {}
        self._result = self._no_result = Result(_core.Result(), self._core)

    def add(
        self,
        mesh: Any,
        triangles: Any = None,
        *,
        springs: MassSpringMotion | None = None,
        rigid: RigidMotion | None = None,
        motion: Motion | None = None,
        fixed_vertices: Any = None,
        handles: Iterable[tuple[Any, MassSpringMotionHandle]] = (),
        **options: Unpack[ObjectOptions],
    ) -> SimulatedObject:
        """Adds an object with at most one motion.

        `springs`: a body of masses and springs, with the options of `supple.options("MassSpringMotion")`;
        `fixed_vertices` do not move, and each of `handles`, a pair (vertices, {"by": (x, y, z), "seconds":
        s}), moves and then stops. `rigid`: a rigid object, with the options of
        `supple.options("RigidMotion")`. `motion`: a function of (seconds, positions) that changes the array
        or returns a new one; it is called with the GIL once per step. `options` are those of `Scene.add`.
        """
        _arrays.function(motion, "add: motion", "seconds and positions")
        if sum(each is not None for each in (springs, rigid, motion)) > 1:
            raise Error("add: an object has one motion: springs, rigid or motion")
        pulled = list(handles)
        if springs is None and (fixed_vertices is not None or pulled):
            raise Error("add: fixed_vertices and handles need springs")
        for given, chosen in (("springs", springs), ("rigid", rigid)):
            if chosen is not None and not isinstance(chosen, Mapping):
                raise Error(f"add: {given} is {chosen!r}; it must be a dict of options")
        made = as_mesh(mesh, triangles)
        keywords = _arrays.keywords(options)
        keywords.setdefault("name", made.name)
        kind, value = next(
            (
                (kind, dict(value) if isinstance(value, Mapping) else value)
                for kind, value in (("springs", springs), ("rigid", rigid), ("function", motion))
                if value is not None
            ),
            ("", None),
        )
        moved = [
            (_arrays.ids(vertices, "vertices of the handle").tolist(), dict(how)) for vertices, how in pulled
        ]
        identifier = self._core.add(
            made._core,
            keywords,
            kind,
            value,
            None if fixed_vertices is None else _arrays.ids(fixed_vertices, "fixed_vertices"),
            moved,
        )
        added = SimulatedObject(self, identifier, made, keywords)
        self._objects[added.index] = added
        return added

    @contract("Simulation::remove")
    def remove(self, removed: SimulatedObject) -> None:
        self._core.remove(removed._id)
        del self._objects[removed.index]

    @contract("Simulation::detect")
    def detect(self, *, stop: Stop | None = None, **request: Unpack[DetectRequest]) -> Result:
        self._result = self._no_result
        self._result = Result(self._core.detect(request, stop), self._core)
        return self._result

    @contract("Simulation::step")
    def step(self, *, stop: Stop | None = None, **request: Unpack[DetectRequest]) -> Result:
        self._result = self._no_result
        self._result = Result(self._core.step(request, stop), self._core)
        return self._result

    def run(
        self, steps: int, *, progress: bool = False, **request: Unpack[DetectRequest]
    ) -> Iterator[Result]:
        """Takes `steps` steps and gives the result of each. `progress` shows a bar, which needs tqdm."""
        numbers: Any = range(_arrays.count(steps, "steps"))
        if progress:
            from tqdm.auto import tqdm

            numbers = tqdm(numbers, unit="step")
        for _ in numbers:
            yield self.step(**request)

    @property
    def result(self) -> Result:
        """The result of the last step or detection; empty before the first one."""
        return self._result

    @property
    def step_count(self) -> int:
        """Steps taken."""
        return int(self._core.step_count())

    @property
    def time(self) -> float:
        """The time of all steps, in seconds."""
        return float(self._core.time())

    @property
    def time_step(self) -> float:
        """The time from one step to the next, in seconds."""
        return float(self._core.time_step())

    @property
    def motion_seconds(self) -> float:
        """Wall-clock time of the last step without detection."""
        return float(self._core.motion_seconds())

    @property
    def objects(self) -> list[SimulatedObject]:
        """All objects, by ascending index."""
        return [self._objects[index] for index in sorted(self._objects)]

    def __len__(self) -> int:
        return len(self._objects)

    def __iter__(self) -> Iterator[SimulatedObject]:
        return iter(self.objects)

    def __repr__(self) -> str:
        return f"<supple.Simulation: {len(self)} objects, {self.step_count} steps of {self.time_step:g} s>"


class MassSpringBody(_arrays.NotCopied):
    """A mesh as masses at its vertices and springs on its edges, without collisions.

    Options are keywords; `supple.options("MassSpringOptions")` lists them. SI units.
    """

    def __init__(
        self,
        mesh: Any,
        triangles: Any = None,
        *,
        fixed_vertices: Any = None,
        **options: Unpack[MassSpringOptions],
    ) -> None:
        self._core = _core.MassSpringBody(
            as_mesh(mesh, triangles)._core,
            options,
            None if fixed_vertices is None else _arrays.ids(fixed_vertices, "fixed_vertices"),
        )

    @contract("MassSpringBody::step")
    def step(self, seconds: float) -> None:
        self._core.step(seconds)

    @contract("MassSpringBody::undo_step")
    def undo_step(self) -> None:
        self._core.undo_step()

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """The positions of the vertices, (n, 3), as a copy."""
        return self._core.positions()

    @positions.setter
    def positions(self, value: Any) -> None:
        self._core.set_positions(_arrays.doubles(value, "positions", -1, 3))

    @property
    def velocities(self) -> npt.NDArray[np.float64]:
        """The velocities of the vertices, (n, 3), m/s, as a copy."""
        return self._core.velocities()

    @velocities.setter
    def velocities(self, value: Any) -> None:
        self._core.set_velocities(_arrays.doubles(value, "velocities", -1, 3))

    @contract("MassSpringBody::set_external_forces")
    def set_external_forces(self, forces: Any) -> None:
        self._core.set_external_forces(_arrays.doubles(forces, "forces", -1, 3))

    @contract("MassSpringBody::add_drift")
    def add_drift(self, velocity: Any) -> None:
        self._core.add_drift(*_arrays.doubles(velocity, "the velocity", 3).tolist())

    @contract("MassSpringBody::reflect")
    def reflect(self, axis: int) -> None:
        self._core.reflect(axis)

    @contract("MassSpringBody::stable_step")
    def stable_step(self) -> float:
        return float(self._core.stable_step())

    @property
    def vertex_count(self) -> int:
        """The number of vertices."""
        return int(self._core.vertex_count())

    @property
    def energy(self) -> dict[str, float]:
        """Energies in joules: kinetic, elastic, area, volume, gravity and total."""
        return dict(self._core.energy())

    @property
    def momentum(self) -> tuple[float, float, float]:
        """Sum of m v, kg m/s."""
        return self._core.momentum()

    @property
    def angular_momentum(self) -> tuple[float, float, float]:
        """Sum of m x × v about the origin, kg m²/s."""
        return self._core.angular_momentum()

    @property
    def center_of_mass(self) -> tuple[float, float, float]:
        """The centre of mass."""
        return self._core.center_of_mass()

    @property
    def mean_velocity(self) -> tuple[float, float, float]:
        """The mean velocity, m/s."""
        return self._core.mean_velocity()

    @property
    def area(self) -> float:
        """Area of all triangles, m²."""
        return float(self._core.area())

    @property
    def volume(self) -> float:
        """The volume that closed parts enclose, m³; 0 when none is closed."""
        return float(self._core.volume())

    @property
    def area_error(self) -> tuple[float, float]:
        """The largest and the mean relative area error of the triangles."""
        return self._core.area_error()

    @property
    def edge_strain(self) -> tuple[float, float]:
        """The largest and the mean strain of the edges, relative to their rest lengths."""
        return self._core.edge_strain()

    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]] | None:
        """The lowest and the highest coordinates of all vertices; None when a vertex is not finite."""
        return self._core.bounds()

    @property
    def springs(self) -> tuple[npt.NDArray[np.uint32], npt.NDArray[np.float64]]:
        """The vertices of the spring on each edge, (k, 2), sorted, and their present rest lengths, (k,)."""
        (_, ends), (_, lengths) = self._core.springs()
        return ends.reshape(-1, 2), lengths

    def __repr__(self) -> str:
        return f"<supple.MassSpringBody: {self.vertex_count} vertices>"


@contract(
    "respond",
    "`velocities` is an (n, 3) array of float64 without gaps, and is changed in place. `masses` is (n,); "
    "None: all are infinite. `supple.options('ContactResponse')` lists the options.",
)
def respond(
    scene: Scene,
    body: Any,
    velocities: npt.NDArray[np.float64],
    masses: Any,
    dt: float,
    **options: Unpack[ContactResponse],
) -> float:
    if not (
        isinstance(velocities, np.ndarray)
        and velocities.dtype == np.float64
        and velocities.flags.c_contiguous
        and velocities.flags.writeable
        and velocities.ndim == 2
        and velocities.shape[1] == 3
    ):
        raise Error(
            "respond: velocities must be a writable (n, 3) array of float64 without gaps; it is changed in place"
        )
    return float(
        _core.respond(
            scene._core,
            scene._id(body),
            velocities,
            None if masses is None else _arrays.doubles(masses, "masses", -1),
            dt,
            options,
        )
    )
