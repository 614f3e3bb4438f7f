"""For users of the IPC Toolkit: near pairs as arrays of indices, and the safe step.

    mesh = supple.compat.ipctk.CollisionMesh(rest_positions, edges, faces)
    near = mesh.collisions(vertices, dhat)            # near.vv, near.ev, near.fv, near.ee
    step = mesh.collision_free_step(x0, x1)

Differences. Verdicts are exact: a pair is listed when its distance is at most `dhat`, as exact arithmetic
decides, and a step is never too long, by whichever method: the toolkit takes tight inclusion by default, and
additive CCD where it is given. Each pair of features is listed once; the toolkit's weights of repeated pairs
and its mollifier of nearly parallel edges are not computed. `min_distance` of a step is the separation that all
elements keep if they have it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _arrays
from .._core import Error
from .._scene import Scene

if TYPE_CHECKING:
    from .._tables import Table
    from ..typing import ProximityPair

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
        self._has_lone = len(rods) + len(particles) > 0
        self._is_particle = np.isin(np.arange(max(self._count, 1)), particles)
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
        listing: Literal["elements", "features"] = "elements" if self._has_lone else "features"
        pairs = self._scene.detect(contacts="proximity", proximity_listing=listing).proximity_pairs
        distances = pairs["distance"]
        if self._has_lone:
            kinds, elements, kept = self._closest_features(pairs)
            distances = distances[kept]
        else:
            kinds, elements = pairs["kind"], pairs["element"].astype(np.int64)
        # The larger feature first, as in the names of the lists.
        swap = kinds[:, 1] > kinds[:, 0]
        kinds = np.where(swap[:, None], kinds[:, ::-1], kinds)
        elements = np.where(swap[:, None, None], elements[:, ::-1], elements)
        numbers = elements[:, :, 0].copy()
        edges = kinds == 1
        numbers[edges] = self._edge_numbers(elements[edges])
        if self._has_lone:  # several elements have the same closest features
            same = kinds[:, 0] == kinds[:, 1]
            numbers[same] = np.sort(numbers[same], axis=1)
            once = np.unique(np.concatenate([kinds, numbers], axis=1), axis=0, return_index=True)[1]
            kinds, numbers, distances = kinds[once], numbers[once], distances[once]

        def chosen(a: int, b: int) -> npt.NDArray[np.bool_]:
            return (kinds[:, 0] == a) & (kinds[:, 1] == b)

        lists = [chosen(0, 0), chosen(1, 0), chosen(2, 0), chosen(1, 1)]
        found: list[Any] = [of[each] for of in (numbers, distances) for each in lists]
        return Collisions(*found)

    def _closest_features(self, pairs: Table[ProximityPair]) -> tuple[Any, Ids, npt.NDArray[np.bool_]]:
        """The kinds and elements of the closest features of pairs of elements, and which pairs they are: faces
        with vertices, edges with edges, particles with edges of no face, and particles with particles. Pairs of
        edges and faces have the vertices of rods already."""
        kind, element = pairs["kind"], pairs["element"].astype(np.int64)
        is_particle = self._is_particle[np.where(kind == 0, element[:, :, 0], 0)]
        below_face = kind.max(axis=1) < 2
        kept = ~below_face | (kind.min(axis=1) == 1) | (is_particle | (kind == 1)).all(axis=1)
        kind, element, corners = kind[kept], element[kept], pairs["vertices"].astype(np.int64)[kept]
        features = [[pairs[f"feature_{side}_{of}"][kept] for side in "ab"] for of in ("kind", "index")]
        kinds, first = (np.stack(each, axis=1).astype(np.int64) for each in features)
        second = (first + 1) % np.maximum(kind + 1, 1)
        ends = [np.take_along_axis(corners, each[:, :, None], axis=2) for each in (first, second)]
        of_corners = np.concatenate([ends[0], np.where(kinds[:, :, None] == 1, ends[1], ends[0])], axis=2)
        of_corners.sort(axis=2)
        return kinds, np.where(kinds[:, :, None] == 2, element, of_corners), kept

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
