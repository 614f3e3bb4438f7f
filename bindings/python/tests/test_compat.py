"""The calls of other libraries, and the check of animations."""

import gc

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


def plain_answers(a, b):
    """Whether two placed meshes collide, and their distance, by a scene of their own."""
    scene = supple.Scene(contacts="intersection", threads=1)
    objects = []
    for mesh, matrix in (a, b):
        solid = not supple.fault_of_solid(mesh)
        objects.append(scene.add(mesh, solid=solid))
        objects[-1].set_transform(matrix)
    touch = scene.any_contact(*objects)
    inside = scene.search(contacts="penetration").contained_parts
    return touch or len(inside) > 0, scene.distance(*objects).distance


def test_managers_answer_as_if_they_were_new(rng):
    """Objects come, go and move; meshes of single questions change in place; bodies contain each other."""
    trimesh = pytest.importorskip("trimesh")
    from supple.compat.trimesh import CollisionManager

    def shape():
        kind = rng.integers(5)
        if kind == 0:
            two = [trimesh.creation.icosphere(1, 0.2), trimesh.creation.box((0.3, 0.3, 0.3))]
            return trimesh.util.concatenate([two[0], two[1].apply_translation([1.5, 0, 0])])
        made = [
            trimesh.creation.torus(0.6, 0.2, 12, 8),
            trimesh.creation.box(rng.uniform(0.2, 2, 3)),
            trimesh.creation.icosphere(2, rng.uniform(0.1, 1)),
            trimesh.Trimesh(
                *(lambda box: (box.vertices, box.faces[:-1]))(trimesh.creation.box()), process=False
            ),
        ]
        return made[kind - 1]

    def placed():
        matrix = trimesh.transformations.random_rotation_matrix(rng.random(3))
        matrix[:3, 3] = rng.uniform(-2, 2, 3)
        return matrix

    managers, worlds = [CollisionManager(), CollisionManager()], [{}, {}]
    single, seen = trimesh.creation.icosphere(2, 0.3), {True: 0, False: 0}
    for step in range(40):
        for manager, world in zip(managers, worlds):
            for _ in range(3):
                name = f"{rng.integers(5)}"
                if name in world and rng.random() < 0.2:
                    manager.remove_object(name)
                    del world[name]
                elif name in world and rng.random() < 0.7:
                    world[name] = world[name][0], placed()
                    manager.set_transform(name, world[name][1])
                else:
                    world[name] = shape(), placed()
                    manager.add_object(name, *world[name])
        made = [{n: (supple.Mesh(m.vertices, m.faces), x) for n, (m, x) in world.items()} for world in worlds]
        cross = {(n, k): plain_answers(a, b) for n, a in made[0].items() for k, b in made[1].items()}
        hits = {pair for pair, (hit, _) in cross.items() if hit}
        for _ in range(2):  # also when nothing changed
            assert managers[0].in_collision_other(managers[1], return_names=True) == (bool(hits), hits)
            assert managers[1].in_collision_other(managers[0]) is bool(hits)
        seen[bool(hits)] += 1
        least = min((distance for _, distance in cross.values()), default=np.inf)
        distance, names, data = managers[0].min_distance_other(
            managers[1], return_names=True, return_data=True
        )
        assert distance == pytest.approx(least, rel=1e-9, abs=1e-9)
        if names is not None:
            assert cross[names][1] == pytest.approx(least, rel=1e-9, abs=1e-9)
            assert data.distance == distance
        own = {(n, k): plain_answers(made[0][n], made[0][k]) for n in made[0] for k in made[0] if n < k}
        hits = {pair for pair, (hit, _) in own.items() if hit}
        assert managers[0].in_collision_internal(return_names=True) == (bool(hits), hits)
        least = min((distance for _, distance in own.values()), default=np.inf)
        assert managers[0].min_distance_internal() == pytest.approx(least, rel=1e-9, abs=1e-9)
        if step % 3 == 0:
            single.vertices *= 1.01
        matrix = placed()
        alone = {
            n: plain_answers(a, (supple.Mesh(single.vertices, single.faces), matrix))
            for n, a in made[0].items()
        }
        hits = {n for n, (hit, _) in alone.items() if hit}
        assert managers[0].in_collision_single(single, matrix, return_names=True) == (bool(hits), hits)
        least = min((distance for _, distance in alone.values()), default=np.inf)
        assert managers[0].min_distance_single(single, matrix) == pytest.approx(least, rel=1e-9, abs=1e-9)
    assert min(seen.values()) > 3


def test_boxes_are_never_further_apart_than_what_they_enclose(rng):
    """Turned, stretched, sheared, mirrored, flat and far from the origin; flush ones, too."""
    from supple import _core

    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    faces = [[0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7], [0, 5, 1], [0, 4, 5], [2, 3, 7], [2, 7, 6]]
    faces += [[0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    apart = 0
    for turn in range(400):
        scene, boxes, objects = supple.Scene(threads=1), [], []
        far = rng.choice([0, 1, 1e6])
        for _ in range(2):
            low, size, matrix = rng.uniform(-1, 0, 3), rng.uniform(0, 2, 3) * (rng.random(3) < 0.8), np.eye(4)
            if turn % 4:
                linear = rng.normal(size=(3, 3))
                matrix[:3, :3] = linear if turn % 4 == 1 else np.linalg.qr(linear)[0]
            else:
                low, size = np.round(4 * low) / 4, np.round(4 * size) / 4
            matrix[:3, 3] = far + (rng.uniform(-1, 1, 3) if turn % 4 else 0)
            objects.append(scene.add(corners * size + low, faces))
            objects[-1].set_transform(matrix)
            boxes.append(_core.PlacedBoxes())
            assert boxes[-1].add(low + size / 2, size / 2, matrix)
        bound, distance = boxes[0].bounds(boxes[1])[0], scene.distance(*objects).distance
        assert bound <= distance
        assert len(boxes[0].near(boxes[1], None)) == 1 or distance > 0
        apart += bound > 0
    assert 150 < apart < 350


def test_many_objects_of_two_managers(at):
    """More pairs than are compared at once: the broad phase finds those near each other."""
    trimesh = pytest.importorskip("trimesh")
    from supple.compat.trimesh import CollisionManager

    box, own, other = trimesh.creation.box((0.5, 0.5, 0.5)), CollisionManager(), CollisionManager()
    for i in range(80):
        own.add_object(f"own {i}", box, at(i))
        other.add_object(f"other {i}", box, at(i, 3))
    assert own.in_collision_other(other) is False and own.min_distance_other(other) == 2.5
    for i in (7, 70):
        other.set_transform(f"other {i}", at(i + 0.1, 0.3))
        assert own.in_collision_other(other, return_names=True) == (True, {(f"own {i}", f"other {i}")})
        other.set_transform(f"other {i}", at(i, 2))
        assert own.in_collision_other(other) is False and own.min_distance_other(other) == 1.5
        other.set_transform(f"other {i}", at(i, 3))


def test_managers_keep_what_stays(at, monkeypatch):
    """Octrees are built once: of each mesh that comes near, and of the meshes of single questions."""
    trimesh = pytest.importorskip("trimesh")
    from supple.compat.trimesh import CollisionManager

    added = []
    add = supple.Scene.add
    monkeypatch.setattr(supple.Scene, "add", lambda *a, **k: added.append(1) or add(*a, **k))
    box, ball, own, other = (
        trimesh.creation.box(),
        trimesh.creation.icosphere(2),
        CollisionManager(),
        CollisionManager(),
    )
    own.add_object("box", box)
    other.add_object("ball", ball, at(1.2))
    other.add_object("far", ball, at(90))
    assert len(added) == 3
    for x in (1.2, 0.5, 3, 1.1, 3):
        other.set_transform("ball", at(x))
        assert own.in_collision_other(other) is (x < 1.5)
        assert own.min_distance_other(other) == pytest.approx(max(0, x - 1.5), abs=0.02)
    assert len(added) == 5
    for i in range(30):
        mesh = ball.copy().apply_scale(1 + 0.1 * (i % 8))
        assert own.in_collision_single(mesh, at(0.3 * i)) is (0.3 * i - 0.5 < 1 + 0.1 * (i % 8))
        assert len(added) == 5 + min(i + 1, 8)
    other.remove_object("ball")
    assert not own.in_collision_other(other) and len(next(iter(own._shared.values()))._known) == 1
    del other
    gc.collect()
    assert len(own._shared) == 0
    for matrix in (np.eye(3), np.diag([1, 1, 1, 2.0])):
        with pytest.raises(ValueError, match="transform"):
            own.set_transform("box", matrix)
    with pytest.raises(ValueError, match="the transform of box is not finite"):
        own.set_transform("box", np.diag([1, np.nan, 1, 1]))
    far = np.eye(4)
    far[:3] = 1.5e308
    for name in ("box", "new"):  # a transform that is refused changes nothing
        with pytest.raises(ValueError, match=f"the transform of {name} is not finite"):
            own.add_object(name, box, far)
    assert own.in_collision_internal() is False and own.in_collision_single(box) is True
    with pytest.raises(ValueError, match="the transform of __external is not finite"):
        own.in_collision_single(box, np.diag([1, np.inf, 1, 1]))


def test_contacts_are_as_deep_as_their_curve_and_their_vertices(at):
    trimesh = pytest.importorskip("trimesh")
    from supple.compat.trimesh import CollisionManager

    manager = CollisionManager()
    manager.add_object("floor", trimesh.creation.box((4, 4, 1)))
    for depth in (0.0625, 0.25):
        for x in (0.1, 1.5):  # in the middle, and flush with a side
            found = manager.in_collision_single(
                trimesh.creation.box(), at(x, 0.2, 1 - depth), return_data=True
            )[1]
            assert len(found) > 0 and all(each.depth == pytest.approx(depth) for each in found), x


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


def test_rods_and_particles_of_the_ipc_toolkit(rng):
    """A vertex is near a rod once: as the end of it, or as its inside."""

    def pairs(x, edges, faces=()):
        return CollisionMesh(np.array(x, float), edges, faces).collisions(np.array(x, float), 0.1)

    rod = [[0, 0, 0], [1, 0, 0]]
    for points, edges, vv, ev in (
        ([[0.02, 0.05, 0]], [], [], [[0, 2]]),
        ([[-0.02, 0.05, 0]], [], [[0, 2]], []),
        ([[0.5, 0.05, 0], [0.5, 1, 0]], [[2, 3]], [], [[0, 2]]),
        ([[-0.05, 0, 0], [-0.5, 1, 0]], [[2, 3]], [[0, 2]], []),
        ([[5, 0, 0], [5, 0.01, 0]], [], [[2, 3]], []),
    ):
        found = pairs([*rod, *points], [[0, 1], *edges])
        assert (found.vv.tolist(), found.ev.tolist(), len(found)) == (vv, ev, 1)
    # In general position: the closest features of the pairs of elements of a mesh with rods and particles.
    both = 0
    for _ in range(30):
        n, dhat = 20, 0.3
        x = rng.uniform(size=(n, 3))
        faces, rods = rng.permutation(n)[:6].reshape(-1, 3), np.empty((0, 2), int)
        rest = np.setdiff1d(np.arange(n), faces)
        rods, particles = rest[:6].reshape(-1, 2), rest[6:]
        edges = np.concatenate([rods, faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)])
        mesh = CollisionMesh(x, edges, faces)
        found = mesh.collisions(x, dhat)
        wanted = set()

        def add(p, q, record):
            def feature(element, kind, index):
                if kind == "face" or len(element) == 1:
                    return tuple(sorted(element))
                ends = (
                    [element[index]]
                    if kind == "vertex"
                    else [element[index], element[(index + 1) % len(element)]]
                )
                return tuple(sorted(ends))

            if not set(p) & set(q) and record.distance <= dhat:
                a = feature(p, record.feature_a_kind, record.feature_a_index)
                b = feature(q, record.feature_b_kind, record.feature_b_index)
                wanted.add(frozenset((a, b)))

        for v in range(n):
            for f in faces.tolist():
                add([v], f, supple.point_triangle_distance([x[v]], [x[f]])[0])
        for i, e in enumerate(edges.tolist()):
            for k in edges.tolist()[i + 1 :]:
                add(e, k, supple.edge_edge_distance([x[e]], [x[k]])[0])
        for v in particles.tolist():
            for e in rods.tolist():
                add([v], e, supple.point_edge_distance([x[v]], [x[e]])[0])
            for w in particles.tolist():
                if v < w:
                    add([v], [w], supple.point_point_distance([x[v]], [x[w]])[0])
        e, f = (
            [tuple(sorted(each)) for each in edges.tolist()],
            [tuple(sorted(each)) for each in faces.tolist()],
        )
        listed = [frozenset(((v,), (w,))) for v, w in found.vv.tolist()]
        listed += [frozenset((e[i], (v,))) for i, v in found.ev.tolist()]
        listed += [frozenset((f[i], (v,))) for i, v in found.fv.tolist()]
        listed += [frozenset((e[i], e[k])) for i, k in found.ee.tolist()]
        assert len(listed) == len(set(listed)) and set(listed) == wanted
        both += bool(len(found.vv) and len(found.ev) and len(found.fv) and len(found.ee))
    assert both > 10


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
