"""The queries of a scene: points, rays, regions and distances, and the checks of their answers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _arrays
from ._contracts import contract
from ._core import Error, Stop
from ._tables import Table, record, table

if TYPE_CHECKING:
    from .typing import FoundClosestPoint, FoundRayHit, ListedRayHit, Overlap, ProximityPair


class WrongAnswer(NamedTuple):
    """An answer that differs from that of exact brute force."""

    query: int
    found: str
    expected: str


class Queries:
    """The queries of `Scene`."""

    __slots__ = ()
    _core: Any

    def _id(self, each: Any) -> Any:
        raise NotImplementedError

    def _filter(self, each: Any) -> Any:
        return None if each is None else self._id(each)

    def _query(self, raw: Any) -> Any:
        return table(raw, self._core)

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
    ) -> Table[FoundClosestPoint]:
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
    ) -> Table[FoundRayHit]:
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
    ) -> Table[ListedRayHit]:
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
    ) -> Table[Overlap]:
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
    ) -> Table[Overlap]:
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
    def distance(self, a: Any, b: Any, *, stop: Stop | None = None) -> ProximityPair | None:
        return record(self._core.distance(self._id(a), self._id(b), stop), self._core)

    @contract("Scene::distances")
    def distances(self, max_distance: float = np.inf, *, stop: Stop | None = None) -> Table[ProximityPair]:
        return self._query(self._core.distances(max_distance, stop))

    @contract("Scene::any_contact")
    def any_contact(self, a: Any, b: Any, *, stop: Stop | None = None) -> bool:
        return bool(self._core.any_contact(self._id(a), self._id(b), stop))

    # Checks of answers.

    @contract("verify_closest")
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

    @contract("verify_cast")
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

    @contract("verify_cast_all")
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

    @contract("verify_overlaps")
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

    @contract("verify_overlaps")
    def verify_overlaps_spheres(
        self, centers: Any, radii: Any, found: Table, *, object: Any = None, mask: int = 0xFFFFFFFF
    ) -> list[WrongAnswer]:
        return _wrong(
            self._core.verify_overlaps_spheres(
                _spheres(centers, radii), _bytes(found), self._filter(object), _arrays.count(mask, "mask")
            )
        )

    @contract("verify_inside")
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

    @contract("verify_distance")
    def verify_distance(self, a: Any, b: Any, found: ProximityPair | None) -> list[WrongAnswer]:
        rows = np.empty(0, np.uint8) if found is None else _bytes(found._row)
        return _wrong(self._core.verify_distance(self._id(a), self._id(b), rows))

    @contract("verify_distances")
    def verify_distances(self, max_distance: float, found: Table) -> list[WrongAnswer]:
        return _wrong(self._core.verify_distances(max_distance, _bytes(found)))

    @contract("verify_any_contact")
    def verify_any_contact(self, a: Any, b: Any, found: bool) -> list[WrongAnswer]:
        return _wrong(self._core.verify_any_contact(self._id(a), self._id(b), bool(found)))


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
