"""Meshes: files, the built-in models, and meshes of other libraries."""

from __future__ import annotations

import importlib
import os
from typing import Any, Mapping, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _arrays, _core
from ._contracts import contract
from ._core import Error

#: The extensions that the package reads itself.
OWN_FORMATS = (".obj", ".off", ".ply", ".stl")


class Mesh:
    """Vertices and triangles, with edges and points of no triangle; not to be changed.

    `positions` (n, 3) are float64 and `triangles` (m, 3) are vertex ids, counter-clockwise seen from outside.
    """

    def __init__(
        self, positions: Any, triangles: Any = (), *, name: str = "", edges: Any = (), points: Any = ()
    ) -> None:
        self._core = _core.Mesh(
            name,
            _arrays.positions(positions),
            _arrays.triangles(triangles),
            _arrays.ids(edges, "edges", 2),
            _arrays.ids(points, "points"),
        )

    @classmethod
    def _of(cls, core: Any) -> Mesh:
        mesh = cls.__new__(cls)
        mesh._core = core
        return mesh

    @property
    def name(self) -> str:
        """For messages and results; the stem of the file name when loaded."""
        return str(self._core.name())

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """The vertices, (n, 3)."""
        return self._core.positions()

    @property
    def triangles(self) -> npt.NDArray[np.uint32]:
        """The vertex ids of each triangle, (m, 3)."""
        return self._core.triangles()

    vertices, faces = positions, triangles  # the names of other libraries

    @property
    def edges(self) -> npt.NDArray[np.uint32]:
        """Edges of no triangle, (k, 2)."""
        return self._core.edges()

    @property
    def points(self) -> npt.NDArray[np.uint32]:
        """Points of no triangle, (k,)."""
        return self._core.points()

    @property
    def polygons(self) -> dict[str, int]:
        """The faces of the file with more than three corners, before they became triangles."""
        return dict(self._core.polygons())

    def to_pyvista(self) -> Any:
        """A pyvista.PolyData."""
        import pyvista

        return pyvista.PolyData.from_regular_faces(np.array(self.positions), np.array(self.triangles))

    def __reduce__(self) -> Any:
        return _mesh, (self.positions, self.triangles, self.name, self.edges, self.points)

    def __repr__(self) -> str:
        return f"<supple.Mesh {self.name!r}: {len(self.positions)} vertices, {len(self.triangles)} triangles>"


def _mesh(positions: Any, triangles: Any, name: str, edges: Any, points: Any) -> Mesh:
    return Mesh(positions, triangles, name=name, edges=edges, points=points)


@contract("load_mesh")
def load_mesh(path: str | os.PathLike[str]) -> Mesh:
    return Mesh._of(_core.load_mesh(_arrays.path(path, "load_mesh: the path")))


@contract("save_mesh")
def save_mesh(mesh: Any, path: str | os.PathLike[str]) -> None:
    name = _arrays.path(path, "save_mesh: the second argument, the path,")
    _core.save_mesh(as_mesh(mesh)._core, name)


@contract("model_names")
def model_names() -> list[str]:
    return list(_core.model_names())


@contract("make_model")
def make_model(name: str) -> Mesh:
    return Mesh._of(_core.make_model(str(name)))


@contract("make_icosphere")
def make_icosphere(frequency: int) -> Mesh:
    return Mesh._of(_core.make_icosphere(_arrays.count(frequency, "frequency", 1)))


@contract("make_torus")
def make_torus(rings: int, sides: int, major_radius: float = 0.5, minor_radius: float = 0.2) -> Mesh:
    return Mesh._of(
        _core.make_torus(
            _arrays.count(rings, "rings", 3), _arrays.count(sides, "sides", 3), major_radius, minor_radius
        )
    )


@contract("make_box")
def make_box(size: tuple[float, float, float] = (1, 1, 1), resolution: int = 1) -> Mesh:
    return Mesh._of(
        _core.make_box(
            *_arrays.doubles(size, "the size", 3).tolist(), _arrays.count(resolution, "resolution", 1)
        )
    )


@contract("make_cloth")
def make_cloth(columns: int, rows: int, width: float = 1, depth: float = 1) -> Mesh:
    return Mesh._of(
        _core.make_cloth(_arrays.count(columns, "columns", 1), _arrays.count(rows, "rows", 1), width, depth)
    )


@contract("compute_topology", "Returns the counts by name, with `closed` and, in words, `surface`.")
def compute_topology(mesh: Any) -> dict[str, Any]:
    return dict(_core.compute_topology(as_mesh(mesh)._core))


@contract("vertices_at_same_position")
def vertices_at_same_position(positions: Any) -> npt.NDArray[np.uint32]:
    return _core.vertices_at_same_position(_arrays.positions(positions))


@contract("welded")
def welded(mesh: Any) -> Mesh:
    return Mesh._of(_core.welded(as_mesh(mesh)._core))


@contract("is_open_at_seams")
def is_open_at_seams(mesh: Any) -> bool:
    return bool(_core.is_open_at_seams(as_mesh(mesh)._core))


@contract("fault_of_solid")
def fault_of_solid(mesh: Any) -> str:
    return str(_core.fault_of_solid(as_mesh(mesh)._core))


@contract("count_inward_triangles")
def count_inward_triangles(mesh: Any) -> int:
    return int(_core.count_inward_triangles(as_mesh(mesh)._core))


class MeshPart(NamedTuple):
    """A connected part of a mesh, with the vertices and triangles of the whole mesh that it has."""

    mesh: Mesh
    vertices: npt.NDArray[np.uint32]
    triangles: npt.NDArray[np.uint32]


@contract("split_into_parts")
def split_into_parts(mesh: Any, weld: bool = False) -> list[MeshPart]:
    return [
        MeshPart(Mesh._of(part), vertices, triangles)
        for part, vertices, triangles in _core.split_into_parts(as_mesh(mesh)._core, weld)
    ]


def arrays_of(mesh: Any, faces: Any = None) -> tuple[Any, Any, str, Any, Any]:
    """Positions, triangles, name, edges and points of a mesh of any library, or of two arrays."""
    if faces is not None:
        if isinstance(mesh, (str, os.PathLike, Mesh)):
            raise Error("give either a mesh, or positions and triangles")
        return mesh, faces, "", (), ()
    if isinstance(mesh, (str, os.PathLike)):
        mesh = _load(os.fspath(mesh))
    if isinstance(mesh, Mesh):
        return mesh.positions, mesh.triangles, mesh.name, mesh.edges, mesh.points
    if isinstance(mesh, tuple) and len(mesh) == 2:
        return mesh[0], mesh[1], "", (), ()
    if hasattr(mesh, "cells_dict") and hasattr(mesh, "points"):  # meshio
        others = set(mesh.cells_dict) - {"triangle", "line", "vertex"}
        if "triangle" not in mesh.cells_dict:
            raise Error(
                f"the mesh has no triangles; it has cells of type {', '.join(sorted(others)) or 'none'}"
            )
        if others:
            raise Error(
                f"the mesh has cells of type {', '.join(sorted(others))}; divide them into triangles, or "
                "take the surface of solids"
            )
        points = np.asarray(mesh.points)
        points = np.pad(points, ((0, 0), (0, 3 - points.shape[1]))) if points.shape[1] < 3 else points
        return points, mesh.cells_dict["triangle"], "", mesh.cells_dict.get("line", ()), ()
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):  # trimesh and others
        return mesh.vertices, mesh.faces, "", (), ()
    if hasattr(mesh, "vertices") and hasattr(mesh, "triangles"):  # Open3D
        return np.asarray(mesh.vertices), np.asarray(mesh.triangles), "", (), ()
    if hasattr(mesh, "vertex") and hasattr(mesh, "triangle"):  # Open3D's tensors
        return mesh.vertex.positions.numpy(), mesh.triangle.indices.numpy(), "", (), ()
    if hasattr(mesh, "points") and hasattr(mesh, "regular_faces"):  # PyVista
        surface = mesh if mesh.is_all_triangles else mesh.triangulate()
        return np.asarray(surface.points), np.asarray(surface.regular_faces), "", (), ()
    raise Error(
        f"{type(mesh).__name__} is not a mesh; give positions and triangles, the path of a file, or a mesh of "
        "supple, trimesh, meshio, PyVista or Open3D"
    )


def arrays_of_object(
    mesh: Any, triangles: Any, edges: Any, points: Any, options: Mapping[str, Any]
) -> tuple[Any, Any, dict[str, Any], Any, Any]:
    """What the compiled modules take of an object: positions, which are converted by the caller, triangles,
    options, edges and points."""
    if triangles is None and isinstance(mesh, np.ndarray) and (edges is not None or points is not None):
        triangles = ()  # rods and particles alone
    xyz, faces, name, own_edges, own_points = arrays_of(mesh, triangles)
    return (
        xyz,
        _arrays.triangles(faces),
        _arrays.keywords({"name": name, **options}),
        _arrays.ids(own_edges if edges is None else edges, "edges", 2),
        _arrays.ids(own_points if points is None else points, "points"),
    )


def _load(path: str) -> Any:
    if path.lower().endswith(OWN_FORMATS):
        return load_mesh(path)
    problems = []
    for library in ("meshio", "trimesh"):
        try:
            module = importlib.import_module(library)
            return (
                module.read(path) if library == "meshio" else module.load(path, force="mesh", process=False)
            )
        except ImportError:
            continue
        except (Exception, SystemExit) as error:  # meshio ends the program for unknown formats
            problems.append(f"{library}: {error}")
    if problems:
        raise Error(f"{path}: cannot be read: {'; '.join(problems)}")
    raise Error(
        f"{path}: the package reads {', '.join(OWN_FORMATS)}; for other formats install trimesh or meshio, or "
        "export the mesh to one of these"
    )


def as_mesh(mesh: Any, faces: Any = None, name: str = "") -> Mesh:
    """The same as a `Mesh`."""
    if isinstance(mesh, Mesh) and not name:
        return mesh
    positions, triangles, own_name, edges, points = arrays_of(mesh, faces)
    return Mesh(positions, triangles, name=name or own_name, edges=edges, points=points)
