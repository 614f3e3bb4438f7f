"""The package has a twin of each public name of C++, or a reason why not; docs/api.json lists the names."""

import importlib.util
import inspect
import json
import subprocess
import sys

from conftest import ROOT
from supple._contracts import twins

import supple
from supple import _elements, _meshes, _recording

#: Types whose members are all there, because they are made from the descriptions: columns of tables.
RECORDS = {
    "CollidingVertices",
    "ContactGroup",
    "ContactPoint",
    "ContainedPart",
    "Contact",
    "ContinuousContact",
    "ContinuousDifference",
    "Difference",
    "EndedManifold",
    "IntersectionCurve",
    "LimitingPair",
    "Manifold",
    "ManifoldPoint",
    "NonFiniteVertex",
    "ObjectPair",
    "Overlap",
    "ListedRayHit",
    "Penetration",
    "PenetrationDifference",
    "PenetrationGroup",
    "ProximityDifference",
    "ProximityPair",
    "TriangleIntersection",
    "UntestedKind",
}
FOUND = {"ClosestPoint", "ElementDistance", "Impact", "RayHit"}
#: Keywords.
OPTIONS = {
    "BroadPhaseOptions",
    "ContactResponse",
    "ImpactOptions",
    "MassSpringMotion",
    "MassSpringOptions",
    "ObjectOptions",
    "RigidMotion",
    "SceneOptions",
    "SimulationOptions",
    "StepOptions",
}
NESTED_OPTIONS = {
    "ComparisonOptions",
    "ObjectOctreeOptions",
    "SceneOctreeOptions",
    "MassSpringMotion::Handle",
}
#: Types that are something else in Python; their members go with them.
TYPES = {
    "AreaError": "MassSpringBody.area_error",
    "EdgeStrain": "MassSpringBody.edge_strain",
    "BroadPhase": "BroadPhase.find",
    "BroadPhaseStats": "BroadPhase.stats",
    "CallLimits": "Stop",
    "CandidateList": "Inspector.candidates",
    "CandidatePair": "Inspector.candidates",
    "CastOptions": "Scene.cast",
    "ClosestOptions": "Scene.closest",
    "DetectRequest": "Scene.detect",
    "DetectResult": "Result",
    "DistributedOptions": "DistributedScene",
    "DistributedStats": "DistributedScene.stats",
    "Error": "Error",
    "MeshEdit": "Object.edit",
    "IndexPair": "BroadPhase.find",
    "KindPair": "BroadPhase",
    "MassSpringEnergy": "MassSpringBody.energy",
    "MeshPart": "MeshPart",
    "MeshTopology": "compute_topology",
    "MotionError": "MotionError",
    "NodePairList": "Inspector.node_pairs",
    "NodePairList::Pair": "Inspector.node_pairs",
    "ObjectId": "Object",
    "ObjectPart": "DistributedScene.add_part",
    "ObjectStep": "ObjectStep",
    "OctreeCell": "Inspector.cells",
    "OctreeStatistics": "Inspector.octree_statistics",
    "PairEvents": "Result.events",
    "PairExplanation": "Inspector.explain",
    "PolygonCounts": "Mesh.polygons",
    "QueryBox": "Scene.overlaps_boxes",
    "QueryFilter": "Scene.closest",
    "QuerySphere": "Scene.overlaps_spheres",
    "Ray": "Scene.cast",
    "RecordedEvents": "Frame",
    "RecordedFrame": "Frame",
    "RecordedObject": "Recording",
    "Recorder": "Recorder",
    "Recording": "Recording",
    "RecordingDifference": "find_first_difference",
    "RecordingHeader": "record",
    "RootCube": "Scene",
    "SafeStep": "SafeStep",
    "SceneRegion": "Inspector.regions",
    "StepLimits": "Scene.max_step",
    "StepStats": "Result.stats",
    "TimeBracket": "first_contact_by_algebra",
    "TriangleMesh": "Mesh",
    "VerifyReport": "VerifyReport",
    "WrongAnswer": "WrongAnswer",
    "MassSpringBody::Spring": "MassSpringBody.springs",
    "EdgeEdgeMotion": "first_impact",
    "PointEdgeMotion": "first_impact",
    "PointPointMotion": "first_impact",
    "VertexFaceMotion": "first_impact",
    "ElementVertices": "Table",
    "Feature": "Table",
    "RigidTransform": "Object",
}
#: Functions and aliases with another name or form.
OTHERS = {
    "with_method_of_2007": "method_of_2007",
    "octree_of_2007": "method_of_2007",
    "Border": "Simulation",
    "MotionFunction": "Simulation.add",
    "PairFilter": "Scene.set_pair_filter",
    "Triangle": "Mesh",
    "Scene::triangle": "Object.triangles",
    "Scene::mesh_version": "Object.mesh_version",
    "DistributedScene": "DistributedScene",
    "DistributedScene::objects": "DistributedScene.objects",
    "DistributedScene::part_vertices": "DistributedObject.part_vertices",
    "DistributedScene::positions": "DistributedObject.positions",
    "DistributedScene::rank": "DistributedScene.rank",
    "DistributedScene::rank_count": "DistributedScene.rank_count",
    "DistributedScene::stats": "DistributedScene.stats",
    "EdgePoints": "edge_edge_distance",
    "TrianglePoints": "triangles_intersect",
    "check_mesh": "Mesh",
    "describe_surface": "compute_topology",
    "enclosing_box": "enclosing_boxes",
    "Scene": "Scene",
    "Scene::add": "Scene.add",
    "Scene::contains": "Scene",
    "Scene::set_observer": "attach",
    "Simulation::set_observer": "attach",
    "Scene::detect": "Scene.detect",
    "Scene::for_each_vertex": "Table",
    "Scene::keep_result": "Result",
    "Scene::objects": "Scene.objects",
    "Scene::options": "Scene.options",
    "Scene::overlaps": "Scene.overlaps_boxes",
    "verify_overlaps": "Scene.verify_overlaps_boxes",
    "Scene::position": "Object.positions",
    "Scene::result": "Scene.result",
    "Scene::set_positions": "Object.positions",
    "Scene::triangle_count": "Object.triangle_count",
    "Scene::vertex_count": "Object.vertex_count",
    "Scene::vertices_of": "Table",
    "SceneInspector": "Inspector",
    "Simulation": "Simulation",
    "Simulation::add": "Simulation.add",
    "Simulation::keep_result": "Result",
    "Simulation::motion_seconds": "Simulation.motion_seconds",
    "Simulation::options": "Simulation.time_step",
    "Simulation::positions": "SimulatedObject.positions",
    "Simulation::set_positions": "SimulatedObject.positions",
    "Simulation::step_count": "Simulation.step_count",
    "Simulation::time": "Simulation.time",
    "Simulation::body": "SimulatedObject.velocities",
    "Simulation::scene": "Simulation",
    "MassSpringBody": "MassSpringBody",
    "MassSpringBody::angular_momentum": "MassSpringBody.angular_momentum",
    "MassSpringBody::area": "MassSpringBody.area",
    "MassSpringBody::area_error": "MassSpringBody.area_error",
    "MassSpringBody::edge_strain": "MassSpringBody.edge_strain",
    "MassSpringBody::bounds": "MassSpringBody.bounds",
    "MassSpringBody::center_of_mass": "MassSpringBody.center_of_mass",
    "MassSpringBody::energy": "MassSpringBody.energy",
    "MassSpringBody::mean_velocity": "MassSpringBody.mean_velocity",
    "MassSpringBody::momentum": "MassSpringBody.momentum",
    "MassSpringBody::positions": "MassSpringBody.positions",
    "MassSpringBody::set_positions": "MassSpringBody.positions",
    "MassSpringBody::velocities": "MassSpringBody.velocities",
    "MassSpringBody::set_velocities": "MassSpringBody.velocities",
    "MassSpringBody::springs": "MassSpringBody.springs",
    "MassSpringBody::vertex_count": "MassSpringBody.vertex_count",
    "MassSpringBody::volume": "MassSpringBody.volume",
    "SUPPLE_VERSION": "__version__",
}
IN_NUMPY = "a line of NumPy"
IN_CPP = "serves programs in C++"
LEFT_OUT = {
    **dict.fromkeys(
        (
            "Vec3",
            "Vec3d",
            "Vec3f",
            "dot",
            "cross",
            "norm",
            "squared_norm",
            "Aabb",
            "BoundingSphere",
            "Slab",
            "area",
            "unit_normal",
            "edges_of",
            "count_neighbour_pairs",
            "TrianglePair",
            "cube_around",
        ),
        IN_NUMPY,
    ),
    **dict.fromkeys(
        (
            "MatrixItems",
            "DenseMatrix",
            "Coordinate",
            "PositionsView",
            "VertexIndex",
            "TrianglesView",
            "FailureHandler",
            "set_failure_handler",
            "valid_utf8",
            "one_line",
            "contains",
            "with_included",
            "feature_kinds",
            "ContactSide",
            "any_distance",
            "volume_kind_count",
            "most_full_levels",
            "SUPPLE_VERSION_MAJOR",
            "SUPPLE_VERSION_MINOR",
            "SUPPLE_VERSION_PATCH",
            "Worded",
            "word_of",
            "value_of_word",
            "list_of_words",
            "WordedSet",
            "value_of_set",
            "list_of_set_words",
            "ValueRange",
            "text_of",
            "Names",
            "Role",
            "Field",
            "Description",
            "RecordDescription",
            "Described",
            "for_each_field",
            "for_each_leaf",
            "count_leaves",
            "is_valid",
            "range_of_root_cube",
            "fail_range",
            "check",
            "kind_of_element",
            "ResultList",
            "for_each_list",
            "ScalarType",
            "size_of",
            "FieldInfo",
            "RecordInfo",
            "ListInfo",
            "record_info",
            "list_infos",
            "place_of_list",
            "place_of_answer",
            "for_each_events",
            "SearchedShape",
            "ContactKindInfo",
            "contact_kinds",
            "info_of",
            "number_of",
            "real_number",
            "add_key",
            "ListRows",
            "rows_of",
            "set_rows",
            *(f"role::{each}" for each in ("first_row", "id", "key", "object", "rounded", "rows", "weights")),
        ),
        IN_CPP,
    ),
    "available_threads": "the option threads says how many run",
    "use_comparison_methods": "the import calls it",
    "use_manifolds": "the import calls it",
    "usable_cores": "os.sched_getaffinity",
    "advice_for_open_surface": "part of the messages of errors",
    "sin_turns": "for motions that are equal on all machines",
    "cos_turns": "as sin_turns",
    "toi_tolerance": "a bound of the documentation",
    "toi_relative_tolerance": "as toi_tolerance",
    "toi_tolerance_at": "as toi_tolerance",
    "triangles_intersect_by_axes": "an independent check of the library's own tests",
    "least_margin": "a factor that respond's documentation says",
    "ResponseBody": "respond takes one body",
    "MassSpringBody::try_step": "for builds without exceptions",
    "Simulation::try_step": "for builds without exceptions",
    "Simulation::set_detection": "serves the viewer",
    "SceneObject": "as Simulation::set_detection",
    "MassSpringBody::options": "the keywords that made it",
    "DetectObserver": "as Scene::set_observer",
    "ObjectChanges": "Object has a function for each option",
    "Scene::set_options": "as ObjectChanges",
    "DistributedScene::set_options": "as ObjectChanges",
    "BroadPhase::validate": "for tests of C++",
    "SceneInspector::validate": "for tests of C++",
    "RecordedElsewhere": "Python records in one process",
    "RecordingRank": "as RecordedElsewhere",
    "WaveMotion": "a motion of the paper's scenes; scene files have it",
    "apply_wave_motion": "as WaveMotion",
}


def load_checker():
    specification = importlib.util.spec_from_file_location("check_api", ROOT / "tools/check_api.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def python_names():
    """The C++ names that are there, each with its Python name."""
    names = {**TYPES, **OTHERS}
    # Calls of an object are those of both scenes.
    names |= {
        cpp.replace("Scene::", "DistributedScene::"): f"DistributedObject.{name}"
        for cpp, name in twins(supple.DistributedObject).items()
    }
    for place, owner in (
        ("Scene.", supple.Scene),
        ("DistributedScene.", supple.DistributedScene),
        ("Object.", supple.Object),
        ("Inspector.", supple.Inspector),
        ("Simulation.", supple.Simulation),
        ("MassSpringBody.", supple.MassSpringBody),
        ("Recorder.", supple.Recorder),
        ("BroadPhase.", supple.BroadPhase),
        ("", supple),
    ):
        names |= {cpp: place + name for cpp, name in twins(owner).items()}
    return names


def test_all_of_cpp_is_there_or_has_a_reason():
    checker = load_checker()
    api = json.loads((ROOT / "docs/api.json").read_text())
    enums = {
        each["name"] for header in api["headers"] for each in header["entities"] if each["kind"] == "enum"
    }
    whole = {
        *RECORDS,
        *FOUND,
        *OPTIONS,
        *NESTED_OPTIONS,
        *TYPES,
        *(name for name in enums if hasattr(supple, name.replace("::", ""))),
    }
    every = {
        each.name
        for each in checker.declarations(api)
        if "operator" not in each.name and each.key != "constructors"
    }
    names = python_names().keys() | whole | {name for name in every if name.rpartition("::")[0] in whole}
    left_out = {name: reason for name, reason in LEFT_OUT.items() if name in every}
    assert left_out.keys() == LEFT_OUT.keys()
    libraries = ["comparison", "core", "describe", "distributed", "files", "inspect", "manifold", "models", "recording", "simulation", "verify"]
    binding = {
        "names": [name for name in names if name in every and name not in left_out],
        "left_out": left_out,
        "libraries": libraries,
    }
    assert list(checker.binding_problems(api, binding)) == []


def test_twins_exist():
    for cpp, name in python_names().items():
        found = supple
        for part in name.split("."):
            assert hasattr(found, part), f"{cpp}: supple.{name} does not exist"
            found = getattr(found, part)
    assert RECORDS <= supple.dtypes.keys() and {f"Found{name}" for name in FOUND} <= supple.dtypes.keys()
    for name in OPTIONS:
        assert len(supple.options(name)) > 0


def test_all_functions_are_documented():
    for module in (supple, _elements, _meshes, _recording):
        for name in dir(module):
            each = getattr(module, name)
            if name.startswith("_") or not getattr(each, "__module__", "").startswith("supple"):
                continue
            assert each.__doc__, name
            for member, value in inspect.getmembers(each) if inspect.isclass(each) else ():
                if not member.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
                    assert value.__doc__, f"{name}.{member}"


def test_enumerations_have_the_words_of_cpp():
    options = {each.name: each.values for each in supple.options("SceneOptions")}
    assert options["broad_phase"].split(", ") == [each.name for each in supple.BroadPhaseMethod]
    contacts = supple.Scene().result.contacts
    assert contacts.words("kind").size == 0 and len(supple.IntersectionKind) == 3


def test_modules_are_loaded_when_they_are_used():
    """As the pages write it: `import supple`, then `supple.plot`."""
    program = """
import sys, supple
before = {name for name in sys.modules if name.startswith("supple.")}
assert not {"supple.compat", "supple.plot", "supple.torch", "supple.typing", "matplotlib", "torch"} & sys.modules.keys()
assert supple.plot.counts and supple.compat.trimesh.CollisionManager and supple.compat.ipctk.CollisionMesh
assert supple.typing.SceneOptions and "numpy" in sys.modules and "torch" not in sys.modules
try:
    supple.plots
except AttributeError as error:
    assert "plots" in str(error)
else:
    raise AssertionError
assert not hasattr(supple.compat, "fcl")
try:
    import torch
except ImportError:
    pass
else:
    assert supple.torch.proximity_loss
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
