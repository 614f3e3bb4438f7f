"""Losses of PyTorch that keep surfaces apart.

Detection finds the pairs; distances and depths are computed again from the positions, so that autograd gives
their gradient. The gradient is exact where the set of pairs and their features do not change. The losses are
continuous where a pair comes within the margin. They are not where a pair of triangles begins or ends to cut
through each other (`penetration_loss`, `self_penetration_loss`: by the depth of the pair there, which is 0,
times the number of pairs; so the value is continuous and its gradient is not), and where other features
become the nearest.

Tensors may be float32 or float64, on any device: positions are copied to the host for the detection.

A loss is NaN where a coordinate is not finite, and so is its gradient at this coordinate: triangles of such a
vertex touch nothing, and an optimizer that blew up must not look like one that has finished.

The losses have a gradient only at vertices of pairs, and know nothing of the rest of a shape. Where each vertex
is free, single vertices move, the surface crumples, and contacts can become more: optimize the parameters of a
pose or a deformation, or add a term that keeps the shape, such as the squared changes of edge lengths.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import torch as _torch

from ._core import Error
from ._meshes import Mesh, fault_of_solid
from ._scene import Scene

Tensor: TypeAlias = _torch.Tensor
_AXES = [(i, j) for i in range(3) for j in range(3)]


def proximity_loss(
    vertices_a: Tensor, faces_a: Any, vertices_b: Tensor, faces_b: Any, margin: float
) -> Tensor:
    """The sum of (1 - d / margin)² over all pairs of features of two meshes with a distance d below the
    margin.

    `vertices_a` is (n, 3) or a batch (b, n, 3), `vertices_b` (m, 3) or (b, m, 3), and `faces_*` (k, 3).
    Returns a scalar, or (b,) for a batch. Each call keeps the octrees of the faces in `Pairs`; use it for
    many calls.
    """
    return Pairs((faces_a, faces_b), margin=margin).proximity(vertices_a, vertices_b)


def penetration_loss(vertices: Tensor, faces: Any, solid_vertices: Tensor, solid_faces: Any) -> Tensor:
    """The sum of the squared depths of the vertices of a mesh inside a solid, whose surface is closed.

    Shapes as for `proximity_loss`. The depth of a vertex is its distance to the surface; its gradient moves
    the vertex out and the surface towards it.
    """
    return Pairs((faces, solid_faces), solid=True).penetration(vertices, solid_vertices)


def self_penetration_loss(vertices: Tensor, faces: Any, margin: float = 0) -> Tensor:
    """The sum over a mesh with itself, for `vertices` (n, 3) or a batch (b, n, 3): of the squared depth of
    each two triangles that intersect, and of (margin - d)² for each two features with a distance d below the
    margin.

    The depth of two triangles is the length of the shortest translation that separates them: of a closed
    surface whose triangles are oriented alike, only translations count that bring each triangle to the outer
    side of the other one, so that all pairs of a deep fold push the same way. Triangles with a common vertex
    do not count. Returns a scalar, or (b,) for a batch.
    """
    return Pairs((faces,), margin=margin).self_penetration(vertices)


class Pairs:
    """The losses for meshes whose faces stay: their octrees are kept from call to call."""

    def __init__(self, faces: Any, *, margin: float = 0, solid: bool = False) -> None:
        self._faces = [np.asarray(each.cpu() if hasattr(each, "cpu") else each) for each in faces]
        self._tensors = [_torch.as_tensor(each.astype(np.int64)) for each in self._faces]
        self._margin = float(margin)
        self._solid = solid
        self._scenes: list[Scene] = []
        self._is_closed: bool | None = None

    def proximity(self, vertices_a: Tensor, vertices_b: Tensor) -> Tensor:
        """See `proximity_loss`."""
        return self._over_batch((vertices_a, vertices_b), "proximity", self._proximity)

    def penetration(self, vertices: Tensor, solid_vertices: Tensor) -> Tensor:
        """See `penetration_loss`."""
        return self._over_batch((vertices, solid_vertices), "penetration", self._penetration)

    def self_penetration(self, vertices: Tensor) -> Tensor:
        """See `self_penetration_loss`."""
        kinds = "intersection,proximity" if self._margin > 0 else "intersection"
        return self._over_batch((vertices,), kinds, self._self_penetration)

    def _over_batch(self, meshes: tuple[Tensor, ...], contacts: str, loss: Any) -> Tensor:
        batch = {len(each) for each in meshes if each.dim() == 3}
        if len(batch) > 1 or any(each.dim() not in (2, 3) for each in meshes):
            raise Error(
                f"vertices have the shapes {[tuple(each.shape) for each in meshes]}; they must be (n, 3), or (b, n, 3) "
                "with one b"
            )
        if not batch:
            return self._detect(0, meshes, contacts, loss)
        losses = [
            self._detect(i, tuple(each[i] if each.dim() == 3 else each for each in meshes), contacts, loss)
            for i in range(batch.pop())
        ]
        return _torch.stack(losses) if losses else meshes[0].new_zeros(0)

    def _detect(self, place: int, meshes: tuple[Tensor, ...], contacts: str, loss: Any) -> Tensor:
        arrays = [each.detach().cpu().numpy() for each in meshes]
        if place == len(self._scenes):
            scene = Scene(contacts=contacts, contact_points=False)
            for i, (positions, faces) in enumerate(zip(arrays, self._faces)):
                scene.add(
                    positions,
                    faces,
                    margin=self._margin / 2,
                    self_collision=len(arrays) == 1,
                    solid=self._solid and i == 1,
                )
            self._scenes.append(scene)
        else:
            scene = self._scenes[place]
            for each, positions in zip(scene.objects, arrays):
                each.positions = positions
        found: Tensor = loss(scene.detect(contacts=contacts), meshes)
        return found if all(np.isfinite(each).all() for each in arrays) else found + _nan(meshes)

    def _proximity(self, found: Any, meshes: tuple[Tensor, ...]) -> Tensor:
        if not self._margin > 0:
            return _zero(meshes)
        distances = _distances(found.proximity_pairs, meshes)
        return (_torch.clamp(1 - distances / self._margin, min=0) ** 2).sum()

    def _penetration(self, found: Any, meshes: tuple[Tensor, ...]) -> Tensor:
        deep = found.penetrations
        deep = deep[deep["object_a"] == 0]
        vertices, solid = meshes
        if not len(deep):
            return _zero(meshes)
        corners = solid[self._tensors[1].to(solid.device)[_index(deep["triangle"], solid)]]
        closest = (_like(deep["barycentric"], solid)[:, :, None] * corners).sum(dim=1)
        depth = (
            (closest - vertices[_index(deep["vertex"], vertices)].to(solid.device))
            * _like(deep["normal"], solid)
        ).sum(dim=1)
        return (depth**2).sum()

    def _self_penetration(self, found: Any, meshes: tuple[Tensor, ...]) -> Tensor:
        (vertices,) = meshes
        faces = self._tensors[0].to(vertices.device)
        contacts = found.contacts
        a, b = (vertices[faces[_index(contacts[f"triangle_{side}"], vertices)]] for side in "ab")
        loss = (_depths_of_triangles(a, b, self._orientation(vertices)) ** 2).sum()
        if self._margin > 0:
            pairs = found.proximity_pairs
            distances = _distances(pairs, (vertices, vertices))
            loss = loss + (_torch.clamp(self._margin - distances, min=0) ** 2).sum()
        return loss

    def _orientation(self, vertices: Tensor) -> int:
        """1 when the normals of a closed surface point outward, -1 when they point inward, 0 for an open
        one."""
        if self._is_closed is None:
            self._is_closed = not fault_of_solid(Mesh(np.zeros((len(vertices), 3)), self._faces[0]))
        if not self._is_closed:
            return 0
        a, b, c = vertices.detach()[self._tensors[0].to(vertices.device)].unbind(dim=1)
        return 1 if float((a * _torch.linalg.cross(b, c)).sum()) >= 0 else -1


def _zero(meshes: tuple[Tensor, ...]) -> Tensor:
    return sum(0 * each.sum() for each in meshes)  # type: ignore[return-value, unused-ignore]


def _nan(meshes: tuple[Tensor, ...]) -> Tensor:
    """NaN, whose gradient is NaN at the coordinates that are not finite and 0 at the others."""
    return sum(0 * (each * each).sum() for each in meshes)  # type: ignore[return-value, unused-ignore]


def _index(ids: Any, like: Tensor) -> Tensor:
    return _torch.as_tensor(np.ascontiguousarray(ids, np.int64), device=like.device)


def _like(values: Any, like: Tensor) -> Tensor:
    return _torch.tensor(values, dtype=like.dtype, device=like.device)


def _distances(pairs: Any, meshes: tuple[Tensor, ...]) -> Tensor:
    """The distances of pairs along their normals, with the barycentric coordinates fixed: at the closest
    points the distance does not change with them to first order."""
    ids, weights = pairs["vertices"], pairs["barycentric"]
    points = [
        (_like(weights[:, side], mesh)[:, :, None] * mesh[_index(ids[:, side], mesh)]).sum(dim=1)
        for side, mesh in enumerate(meshes)
    ]
    return ((points[0] - points[1]) * _like(pairs["normal"], meshes[0])).sum(dim=1)


def _depths_of_triangles(a: Tensor, b: Tensor, orientation: int) -> Tensor:
    """The shortest translations that separate triangles a from b, (k, 3, 3) each, by their separating axes.
    With an orientation of the normals: only those that bring a to the outer side of b, and b to that of
    a."""
    edges_a, edges_b = a[:, [1, 2, 0]] - a, b[:, [1, 2, 0]] - b
    normal_a = _torch.linalg.cross(edges_a[:, 0], edges_a[:, 1])
    normal_b = _torch.linalg.cross(edges_b[:, 0], edges_b[:, 1])
    axis = _torch.stack(
        [normal_a, normal_b, *(_torch.linalg.cross(edges_a[:, i], edges_b[:, j]) for i, j in _AXES)], dim=1
    )
    squared = (axis**2).sum(dim=2)
    usable = squared.detach() > 1e-12 * squared.detach().amax(dim=1, keepdim=True)
    unit = axis / _torch.sqrt(_torch.where(usable, squared, _torch.ones_like(squared)))[:, :, None]
    along_a = _torch.einsum("kac,kvc->kav", unit, a)
    along_b = _torch.einsum("kac,kvc->kav", unit, b)
    forward = along_b.amax(dim=2) - along_a.amin(dim=2)
    backward = along_a.amax(dim=2) - along_b.amin(dim=2)
    if orientation:
        way = orientation * (_unit(normal_b) - _unit(normal_a)).detach()
        turn = _torch.einsum("kac,kc->ka", unit.detach(), way)
        depth = _torch.where(turn > 0, forward, backward)
        usable = usable & (turn.abs() > 1e-3)
    else:
        depth = _torch.minimum(forward, backward)
    smallest = _torch.where(usable, depth, _torch.full_like(depth, _torch.inf)).amin(dim=1)
    return _torch.where(_torch.isfinite(smallest), smallest, _torch.zeros_like(smallest))


def _unit(vectors: Tensor) -> Tensor:
    return _torch.nn.functional.normalize(vectors, dim=-1)
