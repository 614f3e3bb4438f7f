"""For users of the IPC Toolkit: near pairs as arrays of indices, and the safe step.

    mesh = supple.compat.ipctk.CollisionMesh(rest_positions, edges, faces)
    near = mesh.collisions(vertices, dhat)            # near.vv, near.ev, near.fv, near.ee
    step = mesh.collision_free_step(x0, x1)

Differences. Verdicts are exact: a pair is listed when its distance is at most `dhat`, as exact arithmetic
decides, and a step is never too long. Each pair of features is listed once; the toolkit's listing of
vertex-edge and vertex-vertex pairs with multiplicities (weights) and its mollifier of nearly parallel edges
are not computed. `min_distance` of a step is the separation that all elements keep if they have it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _arrays
from .._core import Error
from .._scene import Scene

Ids = npt.NDArray[np.int64]


class Collisions(NamedTuple):
    """Pairs of features within the distance, as indices, (k, 2) each, with their distances, (k,)."""

    vv: Ids  #: two vertices
    ev: Ids  #: an edge and a vertex
    fv: Ids  #: a face and a vertex
    ee: Ids  #: two edges
    vv_distance: npt.NDArray[np.float64]
    ev_distance: npt.NDArray[np.float64]
    fv_distance: npt.NDArray[np.float64]
    ee_distance: npt.NDArray[np.float64]

    def __len__(self) -> int:
        return sum(map(len, (self.vv, self.ev, self.fv, self.ee)))


class CollisionMesh:
    """One mesh that collides with itself: vertices (n, 3), edges (k, 2) and faces (m, 3).

    Edges that are no edge of a face are rods; vertices of no edge and no face are particles.
    """

    def __init__(self, rest_positions: Any, edges: Any = (), faces: Any = ()) -> None:
        positions = _arrays.positions(rest_positions, "rest_positions")
        self.faces = _arrays.ids(faces, "faces", 3).astype(np.int64)
        own = np.sort(self.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        self.edges = _arrays.ids(edges, "edges", 2).astype(np.int64) if len(edges) else np.unique(own, axis=0)
        self._count = len(positions)
        ordered = np.sort(self.edges, axis=1)
        keys = self._keys(ordered)
        if len(np.unique(keys)) != len(keys):
            raise Error("edges: an edge occurs twice")
        self._order = np.argsort(keys)
        self._sorted_keys = keys[self._order]
        missing = np.setdiff1d(self._keys(own), keys)
        if len(missing):
            raise Error(f"edges: the edge {divmod(int(missing[0]), self._count)} of a face is missing")
        rods = ordered[~np.isin(keys, self._keys(own))]
        particles = np.setdiff1d(
            np.arange(self._count), np.concatenate([self.faces.ravel(), self.edges.ravel()])
        )
        self._scene = Scene(contacts="proximity", contact_points=False)
        self._object = self._scene.add(
            positions, self.faces, edges=rods, points=particles, self_collision=True
        )

    def _keys(self, edges: Ids) -> Ids:
        return edges[:, 0] * self._count + edges[:, 1]

    def collisions(self, vertices: Any, dhat: float) -> Collisions:
        """All pairs of features without a common vertex whose distance is at most `dhat`."""
        self._object.set_margin(dhat / 2)
        self._object.positions = vertices
        pairs = self._scene.detect(contacts="proximity").proximity_pairs
        kinds, elements, distances = pairs["kind"], pairs["element"].astype(np.int64), pairs["distance"]
        # The larger feature first, as in the names of the lists.
        swap = kinds[:, 1] > kinds[:, 0]
        kinds = np.where(swap[:, None], kinds[:, ::-1], kinds)
        elements = np.where(swap[:, None, None], elements[:, ::-1], elements)
        numbers = elements[:, :, 0].copy()
        edges = kinds == 1
        numbers[edges] = self._edge_numbers(elements[edges])

        def chosen(a: int, b: int) -> npt.NDArray[np.bool_]:
            return (kinds[:, 0] == a) & (kinds[:, 1] == b)

        lists = [chosen(0, 0), chosen(1, 0), chosen(2, 0), chosen(1, 1)]
        return Collisions(*(numbers[each] for each in lists), *(distances[each] for each in lists))

    def _edge_numbers(self, edges: Ids) -> Ids:
        return self._order[np.searchsorted(self._sorted_keys, self._keys(edges))]

    def collision_free_step(self, start: Any, end: Any, min_distance: float = 0, keep: float = 0.2) -> float:
        """A part of the step, 0 to 1, after which nothing has crossed; see `Scene.collision_free_step`."""
        if min_distance != self._separation:
            self._object.set_min_separation(min_distance / 2)
            self._separation = min_distance
        self._object.set_motion(start, end)
        return self._scene.collision_free_step(keep).step

    def has_intersections(self, vertices: Any) -> bool:
        """Whether any two triangles without a common vertex intersect."""
        self._object.positions = vertices
        return len(self._scene.detect(contacts="intersection", max_contacts=1).contacts) > 0

    _separation = 0.0
