"""Collisions between many objects that bend: every contact, exactly."""

from __future__ import annotations

import atexit
import importlib
import os
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _core
from ._attach import View, attach
from ._broad_phase import BroadPhase, enclosing_boxes
from ._check import CheckReport, FrameCheck, check
from ._core import Error, MotionError, Stop
from ._distributed_scene import DistributedObject, DistributedScene
from ._elements import (
    edge_edge_distance,
    first_contact_by_algebra,
    first_impact,
    intersect_triangles,
    point_edge_distance,
    point_point_distance,
    point_triangle_distance,
    triangles_intersect,
)
from ._experiment import Experiment, experiment, experiments
from ._frames import map_frames
from ._generated import *  # noqa: F403
from ._generated import CONTRACTS
from ._inspection import Inspector, NodePairs
from ._meshes import (
    Mesh,
    MeshPart,
    compute_topology,
    count_inward_triangles,
    fault_of_solid,
    is_open_at_seams,
    load_mesh,
    make_box,
    make_cloth,
    make_icosphere,
    make_model,
    make_torus,
    model_names,
    save_mesh,
    split_into_parts,
    vertices_at_same_position,
    welded,
)
from ._object import Object, rigid_transform
from ._queries import WrongAnswer
from ._recording import Frame, Recorder, Recording, find_first_difference, open, record  # noqa: A004
from ._result import PairContacts, Result, SavedResult
from ._scene import ObjectStep, SafeStep, Scene, VerifyReport
from ._simulation import MassSpringBody, SimulatedObject, Simulation, respond
from ._tables import Record, Table, dtypes
from ._view import view

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from . import compat as compat, plot as plot, torch as torch, typing as typing
    from .typing import SceneOptions
else:

    def __getattr__(name: str) -> Any:
        """Modules that are loaded when they are used: `supple.plot`."""
        if name in ("compat", "plot", "torch", "typing"):
            return importlib.import_module(f"supple.{name}")
        raise AttributeError(f"module 'supple' has no attribute {name!r}")


atexit.register(_core.end_calls)
os.register_at_fork(after_in_child=_core.forget_calls)
for _error in (Error, MotionError):
    _error.__doc__ = CONTRACTS[_error.__name__]
__version__: str = _core.version


class Option(NamedTuple):
    """An option: its keyword, the values, the default, one sentence and the unit."""

    name: str
    values: str
    default: str
    doc: str
    unit: str


def options(structure: str = "SceneOptions") -> list[Option]:
    """The options of a structure: SceneOptions, ObjectOptions, ImpactOptions, StepOptions, SimulationOptions,
    MassSpringOptions, MassSpringMotion, RigidMotion or ContactResponse."""
    found = [Option(*each) for each in _core.options(structure)]
    # The name of the first parameter of methods cannot be a keyword.
    return [each._replace(name="self_collision") if each.name == "self" else each for each in found]


def method_of_2007(**scene: Unpack[SceneOptions]) -> tuple[dict[str, Any], dict[str, Any]]:
    """The method of the paper's program: the options of a scene, with those that are given, and those of its
    objects. `scene, objects = supple.method_of_2007(); s = supple.Scene(**scene); s.add(mesh, **objects)`. A
    simulation also takes `fused_refit=True`; the root of the scene octree is the cube of the scene:
    `scene_octree_root=(x, y, z, edge)`."""
    return _core.method_of_2007(scene)


__all__ = [
    "BoundingVolume",
    "BroadPhase",
    "BroadPhaseMethod",
    "CheckReport",
    "ContactKinds",
    "Containment",
    "ContinuousDifferenceFault",
    "ContinuousListing",
    "CurveKind",
    "Descent",
    "DistributedObject",
    "DistributedScene",
    "ElementKinds",
    "ElementPairKind",
    "Error",
    "Experiment",
    "FeatureKind",
    "Frame",
    "FrameCheck",
    "ImpactCertainty",
    "Inspector",
    "Integrator",
    "IntersectionKind",
    "Lasting",
    "ManifoldSource",
    "MassSpringBody",
    "Mesh",
    "MeshPart",
    "MotionError",
    "Neighbours",
    "NodePairs",
    "NothingToTest",
    "Object",
    "ObjectOctreeBuild",
    "ObjectStep",
    "Option",
    "PairContacts",
    "PairStage",
    "PenetrationDifferenceFault",
    "ProximityDifferenceFault",
    "ProximityListing",
    "Record",
    "Recorder",
    "Recording",
    "RegionSphereTest",
    "Result",
    "ResultPlacement",
    "SafeStep",
    "SavedResult",
    "Scene",
    "SimulatedObject",
    "Simulation",
    "SphereFit",
    "Stop",
    "Table",
    "VerifyReport",
    "View",
    "WrongAnswer",
    "attach",
    "check",
    "compute_topology",
    "count_inward_triangles",
    "dtypes",
    "edge_edge_distance",
    "experiment",
    "experiments",
    "enclosing_boxes",
    "fault_of_solid",
    "find_first_difference",
    "first_contact_by_algebra",
    "first_impact",
    "intersect_triangles",
    "is_open_at_seams",
    "load_mesh",
    "make_box",
    "make_cloth",
    "make_icosphere",
    "make_model",
    "make_torus",
    "map_frames",
    "method_of_2007",
    "model_names",
    "open",
    "options",
    "point_edge_distance",
    "point_point_distance",
    "point_triangle_distance",
    "record",
    "rigid_transform",
    "respond",
    "save_mesh",
    "split_into_parts",
    "triangles_intersect",
    "vertices_at_same_position",
    "view",
    "welded",
]
