"""One scene over the ranks of MPI. Its compiled module is loaded when a scene is made."""

from __future__ import annotations

import atexit
import functools
import importlib
import math
import os
import sys
import weakref
from typing import TYPE_CHECKING, Any, Callable

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._contracts import contract
from ._core import Error, Stop
from ._generated import ResultPlacement
from ._meshes import arrays_of_object
from ._object import Handle
from ._result import Result
from ._scene import SafeStep, VerifyReport
from ._tables import Table, record, table

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .typing import (
        ContinuousContact,
        DetectRequest,
        FoundClosestPoint,
        ObjectOptions,
        ProximityPair,
        SceneOptions,
    )


class DistributedObject(Handle):
    """An object of a distributed scene, or the part of it that this rank has. `index` is its number in the
    results; it counts as this number in comparisons."""

    __slots__ = ()

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """The positions of the vertices that this rank has, (n, 3), as a copy. Set it to move them."""
        return self._scene._core.positions(self._id)

    @positions.setter
    def positions(self, value: Any) -> None:
        self._scene._core.set_positions(self._id, _arrays.positions(value))

    @property
    def part_vertices(self) -> npt.NDArray[np.uint32]:
        """The numbers of the vertices of the part that this rank has, ascending, as a copy; empty for a whole
        object."""
        return self._scene._core.part_vertices(self._id)

    def __repr__(self) -> str:
        return f"<supple.DistributedObject {self.index}>"


class DistributedScene(_arrays.NotCopied):
    """One scene over all ranks of a communicator of mpi4py. Its results equal those of one `Scene`.

    Options are those of `Scene`, and three more: `results` says on which rank the contacts are
    (`supple.ResultPlacement`), `cluster_triangles` is the largest number of triangles that are sent
    together, and `max_imbalance` the work of the busiest rank divided by the mean, above which space is
    divided again.

        scene = supple.DistributedScene(MPI.COMM_WORLD, contacts="proximity")
        ball = scene.add(V, F, id=scene.rank, margin=0.01)  # each rank its own objects
        for step in range(300):
            ball.positions = x = solver.step()
            result = scene.detect()  # all ranks call it; the contacts are on rank 0

    `add`, `add_part`, `set_pair_filter` and the functions of an object are calls of one rank. All others are
    collective: all ranks make them, in the same order and with the same arguments. An error on one rank is
    raised on all of them. Calls run without the GIL; Ctrl-C does not stop them. Start programs with
    `mpirun -n 4 python -m mpi4py program.py`, so that an exception on one rank ends all.
    """

    __slots__ = ("_communicator", "_core", "__weakref__")

    def __init__(
        self,
        communicator: Any,
        *,
        results: str | ResultPlacement = "gathered",
        cluster_triangles: int = 2048,
        max_imbalance: float = 1.25,
        **options: Unpack[SceneOptions],
    ) -> None:
        compiled = _compiled()
        self._communicator = _checked(communicator, compiled)
        self._core = compiled.DistributedScene(
            communicator.py2f(),
            _arrays.keywords(options),
            int(_placement(results)),
            _arrays.count(cluster_triangles, "cluster_triangles", 1),
            _arrays.number(max_imbalance, "max_imbalance"),
        )

    @contract(
        "DistributedScene::add",
        "`id` is the number of the object in the results. The mesh and the options are those of `Scene.add`.",
    )
    def add(
        self,
        mesh: Any,
        triangles: Any = None,
        *,
        id: int,
        generation: int = 0,
        edges: Any = None,
        points: Any = None,
        **options: Unpack[ObjectOptions],
    ) -> DistributedObject:
        xyz, *others = arrays_of_object(mesh, triangles, edges, points, options)
        identifier = _identifier(id, generation)
        self._core.add(identifier, _arrays.positions(xyz), *others)
        return DistributedObject(self, identifier)

    @contract(
        "DistributedScene::add_part",
        """`vertex_numbers` and `triangle_numbers` are the numbers that the vertices and triangles of the
part have in the whole object, both ascending.""",
    )
    def add_part(
        self,
        positions: Any,
        triangles: Any,
        vertex_numbers: Any,
        triangle_numbers: Any,
        *,
        id: int,
        generation: int = 0,
        **options: Unpack[ObjectOptions],
    ) -> DistributedObject:
        identifier = _identifier(id, generation)
        self._core.add_part(
            identifier,
            _arrays.positions(positions),
            _arrays.triangles(triangles),
            _arrays.ids(vertex_numbers, "vertex_numbers"),
            _arrays.ids(triangle_numbers, "triangle_numbers"),
            _arrays.keywords(options),
        )
        return DistributedObject(self, identifier)

    @contract("DistributedScene::remove", "Takes a `DistributedObject` or its id.")
    def remove(self, removed: Any) -> None:
        self._core.remove(_id_of(removed))

    @contract(
        "DistributedScene::set_pair_filter",
        """The function gets two `DistributedObject`s, which other ranks may have, and returns a bool. It
must not call the scene. What it raises is an `Error` on all ranks.""",
    )
    def set_pair_filter(self, accepts: Callable[[DistributedObject, DistributedObject], bool] | None) -> None:
        _arrays.function(accepts, "set_pair_filter: the filter", "two objects")
        if accepts is None:
            self._core.set_pair_filter(None)
            return
        # The scene keeps the function, so the function must not keep the scene.
        this = weakref.ref(self)

        def decide(a: Any, b: Any) -> Any:
            answer = accepts(DistributedObject(this(), a), DistributedObject(this(), b))
            return bool(answer) if isinstance(answer, np.bool_) else answer

        self._core.set_pair_filter(decide)

    @contract(
        "DistributedScene::detect",
        """The options are those of `Scene.detect`. The lists are copies, which stay valid. Tables have no
column `vertices`, because a rank does not have the triangles of others. `stop` on one rank, or Ctrl-C, stops
the call on all of them.""",
    )
    def detect(self, *, stop: Stop | None = None, **request: Unpack[DetectRequest]) -> Result:
        return Result(self._core.detect(request, stop), None)

    @contract(
        "DistributedScene::verify",
        "`stop` on one rank, or Ctrl-C, stops the call on all of them; `stopped` then says so.",
    )
    def verify(self, *, stop: Stop | None = None) -> VerifyReport:
        return VerifyReport(self._core.verify(stop), None)

    @contract("DistributedScene::earliest_impact")
    def earliest_impact(self, *, stop: Stop | None = None) -> ContinuousContact | None:
        return record(self._core.earliest_impact(stop))

    @contract("DistributedScene::max_step")
    def max_step(self, *, seconds: float = math.inf, stop: Stop | None = None) -> SafeStep:
        step, limit, stopped = self._core.max_step(_arrays.number(seconds, "seconds"), stop)
        return SafeStep(step, record(limit), stopped)

    @contract("DistributedScene::collision_free_step")
    def collision_free_step(
        self, keep: float = 0.2, *, seconds: float = math.inf, stop: Stop | None = None
    ) -> SafeStep:
        step, limit, stopped = self._core.collision_free_step(
            _arrays.number(keep, "keep"), _arrays.number(seconds, "seconds"), stop
        )
        return SafeStep(step, record(limit), stopped)

    @contract("DistributedScene::distances", "`stop` on one rank, or Ctrl-C, stops the call on all of them.")
    def distances(self, max_distance: float = np.inf, *, stop: Stop | None = None) -> Table[ProximityPair]:
        return table(self._core.distances(_arrays.number(max_distance, "max_distance"), stop))

    @contract(
        "DistributedScene::closest",
        """`points` is (n, 3), other points on each rank. `object` is a `DistributedObject` or the id of an
object of any rank. The answer is a table with n rows; `found` says which have an answer.""",
    )
    def closest(
        self,
        points: Any,
        *,
        max_distance: float = np.inf,
        object: Any = None,
        mask: int = 0xFFFFFFFF,
    ) -> Table[FoundClosestPoint]:
        return table(
            self._core.closest(
                self._together(lambda: _arrays.doubles(points, "points", -1, 3)),
                None if object is None else _id_of(object),
                _arrays.count(mask, "mask"),
                _arrays.number(max_distance, "max_distance"),
            )
        )

    @contract("DistributedScene::save")
    def save(self, path: str | os.PathLike[str]) -> None:
        self._core.save(_arrays.path(path, "save: the path"))

    @contract("DistributedScene::load")
    def load(self, path: str | os.PathLike[str]) -> None:
        self._core.load(_arrays.path(path, "load: the path"))

    @property
    def objects(self) -> list[DistributedObject]:
        """The objects of which this rank has all or a part, by ascending id."""
        return [DistributedObject(self, each) for each in self._core.objects()]

    @property
    def rank(self) -> int:
        """The number of this rank."""
        return int(self._core.rank())

    @property
    def rank_count(self) -> int:
        """The number of ranks."""
        return int(self._core.rank_count())

    @property
    def stats(self) -> dict[str, Any]:
        """What this rank did in the last collective call: `bytes_sent` and `messages_sent` to other ranks,
        `clusters` of its objects, `cluster_pairs` that it tests, `triangles` that it needs for them,
        `imbalance`, the work of the busiest rank divided by the mean, and `divided`, whether space was
        divided again."""
        return dict(self._core.stats())

    def __repr__(self) -> str:
        return f"<supple.DistributedScene: rank {self.rank} of {self.rank_count}>"

    def _together(self, work: Callable[[], Any]) -> Any:
        """What `work` returns on this rank. Its error on one rank is raised on all."""
        found, error = None, None
        try:
            found = work()
        except Error as raised:
            error = str(raised)
        for rank, each in enumerate(self._communicator.allgather(error)):
            if each is not None:
                raise Error(f"rank {rank}: {each}")
        return found


@functools.cache
def _compiled() -> Any:
    try:
        compiled = importlib.import_module("supple._distributed")
    except ModuleNotFoundError:
        raise Error(
            "DistributedScene: this package was built without MPI; install MPI and Zoltan (Debian: "
            "apt install libopenmpi-dev libtrilinos-zoltan-dev) and mpi4py, and build the package from its "
            "sources: pip install . --config-settings cmake.define.SUPPLE_BUILD_DISTRIBUTED=ON"
        ) from None
    atexit.register(compiled.end_calls)
    os.register_at_fork(after_in_child=compiled.forget_calls)
    return compiled


def _checked(communicator: Any, compiled: Any) -> Any:
    # Who has a communicator has loaded mpi4py.
    mpi = sys.modules.get("mpi4py.MPI")
    if mpi is None or not isinstance(communicator, mpi.Intracomm) or not communicator:
        raise Error(
            f"DistributedScene: the communicator is {communicator!r}; it must be one of mpi4py with ranks, such "
            "as mpi4py.MPI.COMM_WORLD"
        )
    if not mpi.Is_initialized() or mpi.Is_finalized():
        raise Error("DistributedScene: MPI is not initialized, or has ended")
    theirs, own = (of.rstrip("\0 ") for of in (mpi.Get_library_version(), compiled.library_version()))
    if theirs != own:
        raise Error(
            f"DistributedScene: mpi4py uses {theirs}, and supple was built with {own}; build both "
            "with the same MPI: pip install --no-binary mpi4py mpi4py"
        )
    return communicator


def _placement(results: Any) -> ResultPlacement:
    try:
        return ResultPlacement[results] if isinstance(results, str) else ResultPlacement(results)
    except (KeyError, ValueError):
        names = ", ".join(each.name for each in ResultPlacement)
        raise Error(f"DistributedScene: results is {results!r}; it must be one of {names}") from None


def _identifier(id: Any, generation: Any) -> Any:
    return _core.ObjectId(_arrays.count(id, "id"), _arrays.count(generation, "generation"))


def _id_of(each: Any) -> Any:
    return each._id if isinstance(each, DistributedObject) else _identifier(each, 0)
