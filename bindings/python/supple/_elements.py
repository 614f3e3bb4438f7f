"""Distances, intersections and first impacts of raw elements: many pairs in one call, without the GIL."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._contracts import contract
from ._tables import Table, table

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .typing import FoundElementDistance, FoundImpact, ImpactOptions, TriangleIntersection

Pair = Literal["vertex_face", "edge_edge", "point_point", "point_edge"]


def _elements(value: Any, what: str, points: int) -> npt.NDArray[np.float64]:
    array = _arrays.as_numpy(value, what)
    if points == 1 and array.ndim == 2:
        array = array[:, None, :]
    return _arrays.doubles(array, what, -1, points, 3)


@contract("point_point_distance", "`a` and `b` are (n, 3).")
def point_point_distance(a: Any, b: Any, max_distance: float = np.inf) -> Table[FoundElementDistance]:
    return table(_core.point_point_distance(_elements(a, "a", 1), _elements(b, "b", 1), max_distance))


@contract("point_edge_distance", "`a` is (n, 3) and `b` (n, 2, 3).")
def point_edge_distance(a: Any, b: Any, max_distance: float = np.inf) -> Table[FoundElementDistance]:
    return table(_core.point_edge_distance(_elements(a, "a", 1), _elements(b, "b", 2), max_distance))


@contract("point_triangle_distance", "`a` is (n, 3) and `b` (n, 3, 3).")
def point_triangle_distance(a: Any, b: Any, max_distance: float = np.inf) -> Table[FoundElementDistance]:
    return table(_core.point_triangle_distance(_elements(a, "a", 1), _elements(b, "b", 3), max_distance))


@contract("edge_edge_distance", "`a` and `b` are (n, 2, 3).")
def edge_edge_distance(a: Any, b: Any, max_distance: float = np.inf) -> Table[FoundElementDistance]:
    return table(_core.edge_edge_distance(_elements(a, "a", 2), _elements(b, "b", 2), max_distance))


@contract("triangles_intersect", "`a` and `b` are (n, 3, 3); the answer is (n,) of bool.")
def triangles_intersect(a: Any, b: Any) -> npt.NDArray[np.bool_]:
    return table(_core.triangles_intersect(_elements(a, "a", 3), _elements(b, "b", 3))).view(np.bool_)


@contract(
    "intersect_triangles",
    """`a` and `b` are (n, 3, 3). The answer is a table; the first
`point_count` of `position_0` to `position_5` are the points.""",
)
def intersect_triangles(a: Any, b: Any) -> Table[TriangleIntersection]:
    return table(_core.intersect_triangles(_elements(a, "a", 3), _elements(b, "b", 3)))


_IMPACTS = {"vertex_face": 4, "edge_edge": 4, "point_point": 2, "point_edge": 3}


@contract(
    "first_impact",
    """`kind` is vertex_face, edge_edge, point_point or point_edge; `start` and `end` are
(n, k, 3), with the k points of both elements in the order of the motion's members: a vertex and a face, two
edges, two points, or a point and an edge. Options are those of `supple.options('ImpactOptions')`.""",
)
def first_impact(kind: Pair, start: Any, end: Any, **options: Unpack[ImpactOptions]) -> Table[FoundImpact]:
    if kind not in _IMPACTS:
        raise _core.Error(f"first_impact: the kind is {kind!r}; it must be {', '.join(_IMPACTS)}")
    points = _IMPACTS[kind]
    impact = getattr(_core, f"{kind}_impact")
    return table(impact(_elements(start, "start", points), _elements(end, "end", points), options))


@contract(
    "first_contact_by_algebra",
    """Arguments as for `first_impact`. The answer is (n, 2), the bracket of each time;
NaN for elements that stay apart.""",
)
def first_contact_by_algebra(
    kind: Pair, start: Any, end: Any, min_separation: float = 0
) -> npt.NDArray[np.float64]:
    if kind not in _IMPACTS:
        raise _core.Error(f"first_contact_by_algebra: the kind is {kind!r}; it must be {', '.join(_IMPACTS)}")
    points = _IMPACTS[kind]
    return np.array(
        _core.contact_times_by_algebra(
            kind, _elements(start, "start", points), _elements(end, "end", points), min_separation
        )
    ).reshape(-1, 2)
