"""The calls of other libraries, and the check of animations."""

import numpy as np
import pytest
from supple.compat.ipctk import CollisionMesh

import supple


@pytest.fixture
def at():
    def place(x, y=0, z=0):
        matrix = np.eye(4)
        matrix[:3, 3] = x, y, z
        return matrix

    return place


def test_collision_manager(at):
    trimesh = pytest.importorskip("trimesh")
    from supple.compat.trimesh import CollisionManager, scene_to_collision

    box = trimesh.creation.box()
    manager = CollisionManager()
    manager.add_object("a", box)
    manager.add_object("b", box, at(5))
    assert manager.in_collision_internal() is False
    assert manager.in_collision_single(box, at(0.5), return_names=True) == (True, {"a"})
    hit, names, data = manager.in_collision_single(box, at(5.75), return_names=True, return_data=True)
    assert hit and names == {"b"} and data[0].names == {"b", "__external"} and 0 <= data[0].index("b") < 12
    assert all(each.depth == pytest.approx(0.25) for each in data) and data[0].point.shape == (3,)
    manager.add_object("c", box, at(5.5))
    assert manager.in_collision_internal(return_names=True) == (True, {("b", "c")})
    manager.set_transform("c", at(9))
    assert manager.in_collision_internal(return_names=True) == (False, set())
    manager.add_object("small", box.copy().apply_scale(0.1), at(9))
    assert manager.in_collision_internal(return_names=True) == (True, {("c", "small")})
    manager.remove_object("small")
    other = CollisionManager()
    other.add_object("a", box, at(20))
    other.add_object("d", box, at(9.5))
    assert manager.in_collision_other(other, return_names=True) == (True, {("c", "d")})
    distance, names, data = manager.min_distance_other(other, return_names=True, return_data=True)
    assert distance == 0 and names == ("c", "d")
    assert manager.min_distance_internal(return_names=True) == (3, ("b", "c"))
    assert manager.min_distance_internal("a", return_names=True) == (4, ("a", "b"))
    distance, name, data = manager.min_distance_single(box, at(-3), return_name=True, return_data=True)
    assert (distance, name) == (2, "a") and np.linalg.norm(data.point("a") - data.point("__external")) == 2
    for call in (
        lambda: manager.remove_object("z"),
        lambda: manager.set_transform("z", at(1)),
        lambda: manager.min_distance_internal("z"),
    ):
        with pytest.raises(ValueError, match="z not in collision manager"):
            call()
    scene = trimesh.Scene([box, box.copy().apply_translation([0.5, 0, 0])])
    manager, objects = scene_to_collision(scene)
    assert manager.in_collision_internal() and len(objects) == 2


def test_open_surfaces_are_no_solids(at):
    trimesh = pytest.importorskip("trimesh")
    from supple.compat.trimesh import CollisionManager

    box = trimesh.creation.box()
    opened = trimesh.Trimesh(box.vertices, box.faces[:-1], process=False)
    manager = CollisionManager()
    manager.add_object("open", opened)
    manager.add_object("inside", box.copy().apply_scale(0.1))
    assert manager.in_collision_internal() is False
    assert manager.min_distance_internal() == pytest.approx(0.45)


def brute_pairs(x, edges, faces, dhat):
    """The least distances of all vertex-face and edge-edge pairs, by the functions for elements."""
    found = {}
    for v in range(len(x)):
        for f in range(len(faces)):
            if v not in faces[f]:
                found["fv", f, v] = supple.point_triangle_distance([x[v]], [x[faces[f]]])[0].distance
    for i in range(len(edges)):
        for j in range(i + 1, len(edges)):
            if not set(edges[i]) & set(edges[j]):
                found["ee", i, j] = supple.edge_edge_distance([x[edges[i]]], [x[edges[j]]])[0].distance
    return {key: value for key, value in found.items() if value <= dhat}


def test_pairs_of_the_ipc_toolkit(rng):
    cloth = supple.make_cloth(3, 2)
    x = np.concatenate([cloth.positions, np.asarray(cloth.positions) + [0.05, 0.03, 0.02]])
    faces = np.concatenate([cloth.triangles, np.asarray(cloth.triangles) + len(cloth.positions)]).astype(int)
    x += 0.01 * rng.normal(size=x.shape)
    mesh = CollisionMesh(x, faces=faces)
    found = mesh.collisions(x, 0.1)
    wanted = brute_pairs(x, mesh.edges.tolist(), faces.tolist(), 0.1)
    listed = {("fv", *pair): d for pair, d in zip(found.fv.tolist(), found.fv_distance)}
    listed |= {("ee", *sorted(pair)): d for pair, d in zip(found.ee.tolist(), found.ee_distance)}
    assert len(found) > len(found.fv) > 0 and set(listed) <= set(wanted)
    for key, distance in listed.items():
        assert distance == pytest.approx(wanted[key], rel=1e-12)
    # The nearest pair of all is in one of the lists.
    nearest = min(each.min() for each in found[4:] if len(each))
    assert nearest == pytest.approx(min(wanted.values()), rel=1e-12)
    assert not mesh.has_intersections(x)
    tilted = x.copy()
    tilted[len(cloth.positions) :, 1] = 0.2 * x[len(cloth.positions) :, 0]
    assert mesh.has_intersections(tilted)
    step = mesh.collision_free_step(
        x, x - np.where(np.arange(len(x))[:, None] >= len(cloth.positions), [0, 0.2, 0], 0)
    )
    assert 0 < step < 1
    with pytest.raises(supple.Error, match="missing"):
        CollisionMesh(x, [[0, 1]], faces)


def test_check_of_an_animation(tmp_path):
    box, ball = supple.make_box(), supple.make_icosphere(3)
    frames = 6
    moving = np.stack([np.asarray(ball.positions) * 0.5 + [2 - 0.4 * i, 0, 0] for i in range(frames)])
    still = np.repeat(np.asarray(box.positions)[None], frames, axis=0)
    report = supple.check(
        {"box": still, "ball": moving}, {"box": box.triangles, "ball": ball.triangles}, progress=True
    )
    assert not report.clean and [each.contacts + each.vertices_inside > 0 for each in report.frames] == 3 * [
        False
    ] + 3 * [True]
    worst = report.worst(1)[0]
    assert (
        worst.depth == max(each.depth for each in report.frames)
        and "box" in worst.worst
        and worst.vertices_inside > 0
    )
    assert len(report.to_pandas()) == frames and "frames have contacts" in repr(report)
    report.save(tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text()
    assert "<svg" in page and f"<td>{worst.frame}</td>" in page
    for i in range(frames):
        supple.save_mesh(supple.Mesh(moving[i], ball.triangles), tmp_path / f"ball_{i}.obj")
    assert supple.check(tmp_path / "ball_*.obj").clean
    assert supple.check(moving, ball.triangles, parts=True).clean
    assert supple.check([supple.Mesh(each, ball.triangles) for each in moving]).clean
    supple.save_mesh(box, tmp_path / "ball_9.obj")
    for animation, message in [
        (tmp_path / "ball_*.obj", "other triangles than"),
        (tmp_path / "none_*.obj", "no such file"),
        ("x.abc", "Alembic"),
        (moving, "needs faces"),
        (moving[0], "needs faces"),
    ]:
        with pytest.raises(supple.Error, match=message):
            supple.check(animation)
    with pytest.raises(supple.Error, match=r"\(frames, n, 3\)"):
        supple.check(moving[0], ball.triangles)


def test_check_of_usd(tmp_path):
    pytest.importorskip("pxr")
    from pxr import Gf, Usd, UsdGeom, Vt

    stage = Usd.Stage.CreateNew(str(tmp_path / "scene.usda"))
    box = supple.make_box()
    for name in ("a", "b"):
        mesh = UsdGeom.Mesh.Define(stage, f"/{name}")
        mesh.CreatePointsAttr(Vt.Vec3fArray([Gf.Vec3f(*map(float, p)) for p in box.positions]))
        mesh.CreateFaceVertexCountsAttr([3] * 12)
        mesh.CreateFaceVertexIndicesAttr([int(v) for v in np.asarray(box.triangles).ravel()])
    move = UsdGeom.Xformable(stage.GetPrimAtPath("/b")).AddTranslateOp()
    for code in range(5):
        move.Set(Gf.Vec3d(2 - 0.5 * code, 0.1, 0.1), code)
    stage.Save()
    report = supple.check(str(tmp_path / "scene.usda"))
    assert [each.contacts > 0 for each in report.frames] == [False, False, True, True, True]


def test_plots():
    import matplotlib

    matplotlib.use("Agg")
    from supple import plot

    simulation = supple.Simulation(border=[[-1, -1, -1], [1, 1, 1]], seed=3)
    for name in ("rabbit", "fish"):
        simulation.add(supple.make_model(name), springs={"random_speed": 0.5})
    results = list(simulation.run(10))
    assert plot.counts(results).get_ylabel() == "count"
    assert plot.times(results).get_legend() is not None
    matplotlib.pyplot.close("all")


def test_pages_of_the_viewer(program, tmp_path):
    scene = supple.Scene()
    scene.add(supple.make_box(), name="a")
    scene.add(supple.make_box(), name="b")
    scene.detect()
    page = supple.view(scene, tmp_path / "page.html")
    text = page.path.read_text()
    assert len(text) > 100_000 and "<iframe srcdoc=" in page._repr_html_() and "page.html" in repr(page)
    with pytest.raises(supple.Error, match="missing.h5"):
        supple.view(tmp_path / "missing.h5")


def test_experiments(program, tmp_path):
    found = supple.experiment("claims", tmp_path / "claims", quick=True)
    assert found.page is not None and found.tables and "rows)" in repr(found)
    again = supple.Experiment(tmp_path / "claims")
    assert again.tables.keys() == found.to_pandas().keys() == found.tables.keys()
    with pytest.raises(supple.Error, match="no tables"):
        supple.Experiment(tmp_path)
    with pytest.raises(supple.Error, match="foo"):
        supple.experiment("foo")


def test_the_command(program):
    import subprocess
    import sys

    done = subprocess.run(
        [sys.executable, "-m", "supple", "--version"], capture_output=True, text=True, check=True
    )
    assert done.stdout.split()[-1] == supple.__version__ == program("--version").split()[-1]
