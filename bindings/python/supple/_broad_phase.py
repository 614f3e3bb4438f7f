"""The broad phase alone: boxes or spheres in, overlapping pairs out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._contracts import contract
from ._core import Error

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .typing import BroadPhaseOptions


class BroadPhase(_arrays.NotCopied):
    """Finds the overlapping pairs of volumes, for programs that have no meshes.

    Options are those of `supple.options("BroadPhaseOptions")` and `kind_pairs`, a list of pairs of kinds (0
    to 7). Volume i is the same object in every call.
    """

    def __init__(self, **options: Unpack[BroadPhaseOptions]) -> None:
        self._core = _core.BroadPhase(options)

    @contract(
        "BroadPhase::find_object_pairs",
        """`volumes` is (n, 2, 3), the lowest and the highest corners of boxes, or
(n, 4), the centers and radii of spheres. They must be float32, because rounding to float32 may lose a pair;
`supple.enclosing_boxes` rounds outward. The answer is a copy, (k, 2).""",
    )
    def find(self, volumes: Any, *, kinds: Any = None, dirty: Any = None) -> npt.NDArray[np.uint32]:
        array = _arrays.as_numpy(volumes, "volumes")
        if array.dtype != np.float32:
            raise Error(
                f"volumes are {array.dtype}; they must be float32: supple.enclosing_boxes rounds outward"
            )
        kind = None if kinds is None else _arrays.ids(kinds, "kinds").astype(np.uint8)
        changed = None if dirty is None else _arrays.ids(dirty, "dirty")
        if array.ndim == 3 and array.shape[1:] == (2, 3):
            return self._core.of_boxes(np.ascontiguousarray(array), kind, changed)
        if array.ndim == 2 and array.shape[1] == 4:
            return self._core.of_spheres(np.ascontiguousarray(array), kind, changed)
        raise Error(
            f"volumes have the shape {array.shape}; it must be (n, 2, 3) for boxes or (n, 4) for spheres"
        )

    @property
    def stats(self) -> dict[str, Any]:
        """What the last call did."""
        return dict(self._core.stats())


@contract(
    "enclosing_box", "For many boxes: `lowest` and `highest` are (n, 3); the answer is (n, 2, 3) of float32."
)
def enclosing_boxes(lowest: Any, highest: Any, radius: float = 0) -> npt.NDArray[np.float32]:
    return _core.enclosing_boxes(
        _arrays.doubles(lowest, "lowest", -1, 3), _arrays.doubles(highest, "highest", -1, 3), radius
    )
