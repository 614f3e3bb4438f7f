"""The inside of a scene: octree cells, regions, candidates, and why two triangles are no contact."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core
from ._contracts import contract
from ._scene import Scene


class NodePairs(NamedTuple):
    """The pairs of nodes of two octrees that collide, by level: `pairs` (k, 2) are places in `nodes_a` and
    `nodes_b`; level i has the pairs from `level_begin[i]` to `level_begin[i + 1]`."""

    nodes_a: list[dict[str, Any]]
    nodes_b: list[dict[str, Any]]
    pairs: npt.NDArray[np.uint32]
    level_begin: list[int]


class Inspector:
    """Looks into a scene and its last `detect`, for drawing and learning. Boxes are pairs of corners; None
    is empty."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    @contract("SceneInspector::cells")
    def cells(self, object: Any, level: int | None = None) -> list[dict[str, Any]]:
        return list(_core.octree_cells(self._scene._core, self._scene._id(object), level))

    @contract("SceneInspector::leaf")
    def leaf(self, object: Any, triangle: int) -> dict[str, Any]:
        return dict(_core.leaf(self._scene._core, self._scene._id(object), triangle))

    @contract("SceneInspector::node_pairs")
    def node_pairs(self, a: Any, b: Any) -> NodePairs:
        cells_a, cells_b, pairs, begin = _core.node_pairs(
            self._scene._core, self._scene._id(a), self._scene._id(b)
        )
        return NodePairs(cells_a, cells_b, pairs.reshape(-1, 2), begin)

    @contract("SceneInspector::octree_depth")
    def octree_depth(self, object: Any) -> int:
        return int(_core.octree_depth(self._scene._core, self._scene._id(object)))

    @contract("SceneInspector::octree_statistics")
    def octree_statistics(self, object: Any) -> dict[str, Any]:
        return dict(_core.octree_statistics(self._scene._core, self._scene._id(object)))

    @contract("SceneInspector::bounds")
    def bounds(self, object: Any) -> Any:
        return _core.bounds(self._scene._core, self._scene._id(object))

    @contract("SceneInspector::regions", "With an object: the leaf regions that contain it.")
    def regions(self, object: Any = None) -> list[dict[str, Any]]:
        return list(_core.regions(self._scene._core, self._scene._filter(object)))

    @contract(
        "SceneInspector::candidates",
        "Returns the pairs as (k, 4): both objects, then both triangles; and their number.",
    )
    def candidates(self, limit: int) -> tuple[npt.NDArray[np.uint32], int]:
        pairs, total = _core.candidates(self._scene._core, limit)
        return pairs.reshape(-1, 4), total

    @contract("SceneInspector::explain")
    def explain(self, object_a: Any, triangle_a: int, object_b: Any, triangle_b: int) -> dict[str, Any]:
        return dict(
            _core.explain(
                self._scene._core,
                self._scene._id(object_a),
                triangle_a,
                self._scene._id(object_b),
                triangle_b,
            )
        )
