"""An object of a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._contracts import contract
from ._core import Error

if TYPE_CHECKING:
    from ._scene import Scene


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


class Handle:
    """What objects of a scene and of a distributed scene share."""

    __slots__ = ("_scene", "_id")

    def __init__(self, scene: Any, identifier: Any) -> None:
        self._scene = scene
        self._id = identifier

    @property
    def index(self) -> int:
        """The number of the object in `object_a` and `object_b`."""
        return int(self._id.index)

    @property
    def generation(self) -> int:
        """How many objects had this number before."""
        return int(self._id.generation)

    @contract("Scene::set_positions")
    def set_positions(self, positions: Any) -> None:
        self._scene._core.set_positions(self._id, _arrays.positions(positions))

    @contract("Scene::set_motion")
    def set_motion(self, start: Any, end: Any) -> None:
        self._scene._core.set_motion(
            self._id, _arrays.positions(start, "start"), _arrays.positions(end, "end")
        )

    @contract("Scene::set_vertex_groups")
    def set_vertex_groups(self, groups: Any, masks: Any) -> None:
        self._scene._core.set_vertex_groups(
            self._id, _arrays.ids(groups, "groups"), _arrays.ids(masks, "masks")
        )

    def set_static(self, static: bool) -> None:
        """Changes whether the object is static. Call it with False to move a static object."""
        self._scene._core.set_static(self._id, _arrays.truth(static, "static"))

    def set_group(self, group: int, mask: int = 0xFFFFFFFF) -> None:
        """Changes the options `group` and `mask`."""
        self._scene._core.set_group(self._id, _arrays.count(group, "group"), _arrays.count(mask, "mask"))

    def set_margin(self, margin: float) -> None:
        """Changes the option `margin`."""
        self._scene._core.set_margin(self._id, _arrays.number(margin, "margin"))

    def set_min_separation(self, separation: float) -> None:
        """Changes the option `min_separation`."""
        self._scene._core.set_min_separation(self._id, _arrays.number(separation, "separation"))

    def set_self_collision(self, enabled: bool) -> None:
        """Changes the option `self_collision`."""
        self._scene._core.set_self_collision(self._id, _arrays.truth(enabled, "enabled"))

    @contract("Scene::remove")
    def remove(self) -> None:
        self._scene.remove(self)

    def __index__(self) -> int:
        return self.index

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Handle):
            return self._scene is other._scene and (self.index, self.generation) == (
                other.index,
                other.generation,
            )
        return isinstance(other, (int, np.integer)) and self.index == int(other)

    def __hash__(self) -> int:
        return hash(self.index)


class Object(Handle):
    """An object of a scene. `index` is what the results call it; it counts as this number in comparisons.
    A scene uses the number of a removed object again."""

    __slots__ = ()
    _scene: Scene

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
        """The vertex ids of each triangle, (m, 3), as a copy; 0 three times for each that an edit removed."""
        return self._scene._core.triangles(self._id)

    @property
    def mesh_version(self) -> int:
        """0, and one more after each `edit` and `compact`."""
        return int(self._scene._core.mesh_version(self._id))

    @contract(
        "Scene::edit",
        """The arguments are those of `MeshEdit`, and can be left out.""",
    )
    def edit(
        self,
        removed: Any = (),
        added: Any = (),
        new_vertices: Any = (),
        new_starts: Any = (),
        removed_edges: Any = (),
        added_edges: Any = (),
        removed_points: Any = (),
        added_points: Any = (),
    ) -> None:
        self._scene._core.edit(
            self._id,
            _arrays.ids(removed, "removed"),
            _arrays.triangles(added, "added"),
            _arrays.positions(new_vertices, "new_vertices"),
            _arrays.positions(new_starts, "new_starts"),
            _arrays.ids(removed_edges, "removed_edges", 2),
            _arrays.ids(added_edges, "added_edges", 2),
            _arrays.ids(removed_points, "removed_points"),
            _arrays.ids(added_points, "added_points"),
        )

    @contract("Scene::compact")
    def compact(self) -> npt.NDArray[np.uint32]:
        return self._scene._core.compact(self._id)

    @contract("Scene::set_vertices")
    def set_vertices(self, vertices: Any, positions: Any) -> None:
        self._scene._core.set_vertices(
            self._id, _arrays.ids(vertices, "vertices"), _arrays.positions(positions)
        )

    @contract(
        "Scene::share_positions",
        """The object keeps the array until it gets other positions or is removed. After you wrote to the
array, call the function again. An `Error` is raised for what the package would have to convert before the scene
sees it: lists, other types than float32 and float64, another byte order, coordinates that are not aligned, and
memory of a device. Of an array in which x, y and z of a point are not adjacent, such as the transpose of (3, n),
the scene makes its copy in each call, as said above.""",
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

    def __repr__(self) -> str:
        if not self._scene._core.contains(self._id):
            return f"<supple.Object {self.index}, removed>"
        return f"<supple.Object {self.index} {self.name!r}: {self.vertex_count} vertices, {self.triangle_count} triangles>"
