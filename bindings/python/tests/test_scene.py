"""Scenes: the answers are those of C++, and whatever users do has a defined result."""

import gc
import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest
from conftest import equal, two_spheres

import supple


def test_the_answers_are_those_of_the_program(detect_json, tmp_path, rng):
    mesh = supple.make_model("rabbit")
    other = supple.Mesh(mesh.positions + 0.1 * rng.normal(size=3), mesh.triangles)
    paths = [tmp_path / f"{name}.obj" for name in "ab"]
    for each, path in zip((mesh, other), paths):
        supple.save_mesh(each, path)
    frame = detect_json(*paths, "--self", "--contacts", "intersection,proximity", "--margin", "0.01")
    scene = supple.Scene(contacts={"intersection", "proximity"})
    for path in paths:
        scene.add(path, self_collision=True, margin=0.01)
    result = scene.detect()
    wanted = {(each["a"], each["b"], *pair) for each in frame["triangle_pairs"] for pair in each["pairs"]}
    wanted |= {(each["a"], each["a"], *pair) for each in frame["self"] for pair in each["pairs"]}
    contacts = result.contacts
    found = list(
        zip(*(contacts[name].tolist() for name in ("object_a", "object_b", "triangle_a", "triangle_b")))
    )
    assert set(found) == wanted and len(found) == len(wanted) > 100
    assert len(result.proximity) == frame["stats"]["proximity_pairs"] > 100
    assert scene.verify()


def test_results_stay_valid_while_they_are_held(sphere):
    scene, _, b = two_spheres(sphere)
    held, copies = [], []
    for step in range(12):
        # Every third step moves nothing, so the scene takes the contacts of the step before.
        b.positions = np.asarray(sphere.positions) + [1.5 - 0.02 * (step - step % 3), 0, 0]
        result = scene.detect()
        held.append(result if step % 2 else (result.contacts, result.proximity, result.curves))
        copies.append([np.array(each) for each in (result.contacts, result.proximity, result.curves)])
        assert scene.verify()
        del result
        gc.collect()
    del scene, b
    gc.collect()
    for each, copied in zip(held, copies):
        lists = (each.contacts, each.proximity, each.curves) if isinstance(each, supple.Result) else each
        for found, wanted in zip(lists, copied):
            assert equal(found, wanted)


def test_results_are_read_only_and_without_a_copy(sphere):
    scene, *_ = two_spheres(sphere)
    contacts = scene.detect().contacts
    with pytest.raises(ValueError, match="read-only"):
        contacts["triangle_a"][0] = 3
    assert not contacts["normal"].flags.owndata and np.shares_memory(contacts["normal"], np.asarray(contacts))


def test_columns_that_are_made_of_others(sphere):
    scene, a, b = two_spheres(sphere)
    pairs = scene.detect().proximity
    x = np.stack([a.positions, b.positions])
    points = [
        (
            pairs["barycentric"][:, side, :, None]
            * x[pairs["object"][:, side][:, None], pairs["vertices"][:, side]]
        ).sum(1)
        for side in (0, 1)
    ]
    np.testing.assert_allclose(points[0], pairs["point_a"], atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(points[0] - points[1], axis=1), pairs["distance"], atol=1e-12)
    np.testing.assert_array_equal(pairs["barycentric"][:, 1], pairs["barycentric_b"])
    chosen = pairs[pairs["distance"] < 0.02]
    np.testing.assert_array_equal(chosen["vertices"], pairs["vertices"][pairs["distance"] < 0.02])
    with pytest.raises(KeyError, match="no column 'foo'; it has object_a"):
        pairs["foo"]
    row = pairs[0]
    assert row.distance == pairs["distance"][0] and row.kind_a in ("vertex", "edge", "face")
    assert repr(row).startswith("ProximityPair(object_a=0") and pairs[-1] == pairs[len(pairs) - 1]
    with pytest.raises(IndexError):
        pairs[len(pairs)]
    with pytest.raises(AttributeError, match="has no 'foo'"):
        row.foo


LAYOUTS = {
    "float32": lambda x: x.astype(np.float32),
    "column-major": np.asfortranarray,
    "every second": lambda x: np.repeat(x, 2, axis=0)[::2],
    "reversed twice": lambda x: np.ascontiguousarray(x[::-1])[::-1],
    "a part of a record": lambda x: np.array([(7, row) for row in x], dtype=[("i", "i8"), ("x", "f8", 3)])[
        "x"
    ],
    "not aligned": lambda x: np.array([(7, row) for row in x], dtype=[("i", "i1"), ("x", "f8", 3)])["x"],
    "of the other byte order": lambda x: x.astype(x.dtype.newbyteorder()),
    "a list": lambda x: x.tolist(),
    "read-only": lambda x: np.frombuffer(x.tobytes()).reshape(-1, 3),
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_positions_of_any_layout(layout, sphere):
    x = np.asarray(sphere.positions).astype(np.float32).astype(np.float64)
    scene = supple.Scene()
    each = scene.add(LAYOUTS[layout](x), sphere.triangles)
    np.testing.assert_array_equal(each.positions, x)
    each.positions = LAYOUTS[layout](x + 1)
    expected = x + 1
    if layout == "float32":
        expected = expected.astype(np.float32).astype(np.float64)
    np.testing.assert_array_equal(each.positions, expected)


@pytest.mark.parametrize(
    "scalar", [np.int8, np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.uint64, ">i4"]
)
def test_triangles_of_any_integer(scalar):
    box = supple.make_box()
    each = supple.Scene().add(box.positions, np.asarray(box.triangles).astype(scalar)[::-1, ::-1])
    np.testing.assert_array_equal(each.triangles, np.asarray(box.triangles)[::-1, ::-1])


def test_arrays_that_cannot_be_read(sphere):
    scene = supple.Scene()
    box = supple.make_box()
    x, faces = np.asarray(box.positions), np.asarray(box.triangles)
    bad_faces, negative, outside = faces.astype(float), faces.astype(np.int64), faces.astype(np.int64)
    negative[3, 1], outside[5, 2] = -1, 8
    for arguments, message in [
        ((x[:, :2], faces), r"shape \(8, 2\)"),
        ((x.ravel(), faces), "reshape"),
        ((x.T.copy(), faces), r"use \.T"),
        ((x.astype(complex), faces), "complex128"),
        ((x.astype(object), faces), "object"),
        (([["a"]], faces), "<U1"),
        ((x, bad_faces), "whole numbers"),
        ((x, faces[:, :2]), r"shape \(12, 2\)"),
        ((x, np.tile(faces, 2)), "polygons"),
        ((x, negative), "triangle 3 uses vertex -1"),
        ((x, outside), "triangle 5 uses vertex 8"),
        ((x, np.array([[0, 1, 2**64 - 1]], np.uint64)), "at most"),
        (([[1, 2], [3]], faces), "must be an array"),
    ]:
        with pytest.raises(supple.Error, match=message):
            scene.add(*arguments)
    assert len(scene) == 0
    each = scene.add(box)
    for value in (x[:7], x[0], None):
        with pytest.raises(supple.Error):
            each.positions = value
    np.testing.assert_array_equal(each.positions, x)


def test_numbers_that_are_not_finite(sphere):
    scene, a, b = two_spheres(sphere)
    x = np.array(sphere.positions)
    x[3] = np.nan
    a.positions = x
    result = scene.detect()
    assert result.non_finite_vertices["vertex"].tolist() == [3] and len(result.contacts) > 0
    assert scene.verify()
    a.positions = np.full_like(x, 1e308)
    assert len(scene.detect().contacts) == 0


def test_options_and_their_errors():
    names = {each.name for each in supple.options("SceneOptions")}
    assert {"contacts", "threads", "broad_phase", "min_separation"} <= names
    assert (
        supple.Scene(contacts="penetration,proximity").options["contacts"]
        == "intersection,proximity,penetration"
    )
    kinds = supple.ContactKinds.continuous | supple.ContactKinds.proximity
    assert supple.Scene(contacts=kinds).options["contacts"] == "continuous,proximity"
    assert supple.Scene(impact={"min_separation": 0.5}).options["min_separation"] == 0.5
    assert supple.Scene(bounding_volume=supple.BoundingVolume.sphere).options["bounding_volume"] == "sphere"
    for keyword, value, message in [
        ("threads", -1, "threads is -1; it must be a whole number from 0 to 1024"),
        ("threads", True, "threads is True"),
        ("threads", 1.5, "threads is 1.5"),
        ("contacts", "foo", "contacts is 'foo'"),
        ("contacts", {"a", 1}, "contacts is"),
        ("min_separation", -1, "finite number from 0"),
        ("min_separation", float("nan"), "min_separation is nan"),
        ("broad_phase", 77, "automatic, octree"),
        ("contact_points", 2, "True or False"),
        ("max_exact_bits", 10, "53 to 2098"),
        ("scene_octree_root", (1, 2), "three coordinates"),
    ]:
        with pytest.raises(supple.Error, match=message):
            supple.Scene(**{keyword: value})
    with pytest.raises(TypeError, match="no option 'treads'"):
        supple.Scene(treads=3)
    with pytest.raises(supple.Error, match="there are no options 'Foo'"):
        supple.options("Foo")
    scene = supple.Scene()
    with pytest.raises(TypeError, match="fixed when the scene is made"):
        scene.detect(threads=2)
    with pytest.raises(supple.Error, match="penetration needs all"):
        scene.detect(contacts="penetration", max_contacts=3)


def test_objects_and_their_names(sphere):
    scene, a, b = two_spheres(sphere)
    assert (
        scene["a"] == a == scene[0] == 0
        and scene[b] is b
        and len(scene) == 2
        and a in scene
        and list(scene) == [a, b]
    )
    assert {a, b} == set(scene.objects) and np.arange(3)[b] == 1
    np.testing.assert_array_equal(a.triangles, sphere.triangles)
    with pytest.raises(KeyError, match="no object of the scene is called 'c'"):
        scene["c"]
    with pytest.raises(supple.Error, match="of another scene"):
        supple.Scene().distance(a, b)
    a.remove()
    assert a not in scene and "removed" in repr(a)
    for use in (
        lambda: setattr(a, "positions", sphere.positions),
        lambda: a.name,
        a.remove,
        lambda: a.set_margin(1),
    ):
        with pytest.raises(supple.Error, match="not in the scene"):
            use()
    c = scene.add(sphere)
    assert c.index == 0 and c.generation == 1 and c != a
    assert scene.detect().contacts["object_a_generation"].max(initial=0) == 1


def test_motion_and_safe_steps(sphere):
    scene = supple.Scene(contacts="continuous")
    x = np.asarray(sphere.positions)
    a = scene.add(sphere, static=True)
    b = scene.add(x + [3, 0, 0], sphere.triangles)
    b.set_motion(x + [3, 0, 0], x)
    result = scene.detect()
    assert len(result.continuous) > 0
    first = scene.earliest_impact()
    step = scene.max_step()
    assert first.toi == step.step == result.continuous["toi"].min() and step.limit.element_a == pytest.approx(
        first.element_a
    )
    free = scene.collision_free_step(keep=0.2)
    assert 0 < free.step < step.step and free.limit.vertices.shape == (2, 3)
    assert [each.object for each in scene.collision_free_steps()] == [a, b]
    b.positions = x + [3, 0, 0] + free.step * np.array([-3.0, 0, 0])
    assert scene.distance(a, b).distance > 0
    with pytest.raises(supple.Error, match="static"):
        a.positions = x


def test_transforms(sphere):
    scene, a, b = two_spheres(sphere)
    matrix = np.eye(4)
    matrix[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    matrix[:3, 3] = [1, 2, 3]
    a.set_transform(matrix)
    x = np.asarray(sphere.positions)
    np.testing.assert_allclose(a.positions, x @ matrix[:3, :3].T + matrix[:3, 3])
    a.translate([1, 0, 0])
    np.testing.assert_allclose(a.positions, x @ matrix[:3, :3].T + matrix[:3, 3] + [1, 0, 0])
    a.set_transform(supple.rigid_transform(0, 0, 1, 1, (1, 2, 3)))
    np.testing.assert_allclose(a.positions, x @ matrix[:3, :3].T + matrix[:3, 3], atol=1e-15)
    with pytest.raises(supple.Error, match="not zero"):
        supple.rigid_transform(0, 0, 0, 0)
    for wrong in (np.eye(3), np.eye(4) * 2, np.full((4, 4), np.nan)):
        with pytest.raises(supple.Error):
            a.set_transform(wrong)
    vertices = [3, 5]
    b.set_vertices(vertices, [[9, 9, 9], [8, 8, 8]])
    assert b.positions[5].tolist() == [8, 8, 8]
    with pytest.raises(supple.Error, match="-1; it must be from 0"):
        b.set_vertices([-1], [[0, 0, 0]])


def test_shared_positions_are_read_in_place(sphere):
    scene, a, b = two_spheres(sphere)
    x = np.array(sphere.positions)
    a.share_positions(x)
    before = len(scene.detect().contacts)
    x += [10, 0, 0]
    a.share_positions(x)
    assert before > 0 == len(scene.detect().contacts)
    del x
    gc.collect()
    assert len(scene.detect(contacts="intersection").contacts) == 0
    with pytest.raises(supple.Error, match="cannot be shared"):
        a.share_positions(np.asarray(sphere.positions).astype(np.float16))


def test_filters(sphere):
    scene, a, b = two_spheres(sphere)
    assert len(scene.detect().contacts) > 0
    a.set_group(2, 2)
    assert len(scene.detect().contacts) == 0
    a.set_group(1)
    seen = []
    scene.set_pair_filter(lambda p, q: seen.append((p, q)) or False)
    result = scene.detect()
    assert len(result.contacts) == 0 and (a, b) in seen and result.untested["intersection"] == "filter"
    for broken, error in (
        (lambda p, q: 1 / 0, ZeroDivisionError),
        (lambda p, q: "yes", TypeError),
        (lambda p, q: scene.detect(), supple.Error),
        (lambda p: True, TypeError),
    ):
        scene.set_pair_filter(broken)
        with pytest.raises(error):
            scene.detect()
    scene.set_pair_filter(lambda p, q: p.name == "a" and q.vertex_count > 3)
    assert len(scene.detect().contacts) > 0
    scene.set_pair_filter(None)
    assert len(scene.detect().contacts) > 0 and scene.verify()
    found = scene.search(contacts="intersection", only=lambda p, q: False)
    assert len(found.contacts) == 0
    groups = np.ones(a.vertex_count, np.uint32)
    masks = np.zeros(a.vertex_count, np.uint32)
    for each in (a, b):
        each.set_vertex_groups(groups, masks)
    assert len(scene.detect(contacts="intersection").contacts) == 0


def test_queries_are_right(sphere, rng):
    scene, a, b = two_spheres(sphere)
    points = rng.uniform(-2, 3, size=(500, 3))
    points[7] = np.nan
    closest = scene.closest(points, max_distance=1.5)
    assert not closest["found"][7] and closest["found"].sum() > 100
    assert scene.verify_closest(points, closest, max_distance=1.5) == []
    signed = scene.closest(points, signed=True, object=a)
    assert (signed["distance"] < 0).any() and scene.verify_closest(
        points, signed, signed=True, object=a
    ) == []
    inside = scene.inside(points)
    assert set(inside) == {0, 2} and scene.verify_inside(points, inside) == []
    directions = rng.normal(size=(500, 3))
    hits = scene.cast(points, directions, count_hits=True)
    assert hits["found"].any() and scene.verify_cast(points, directions, hits, count_hits=True) == []
    every = scene.cast_all(points, directions)
    assert (
        len(every) == hits["hits"][hits["found"]].sum()
        and scene.verify_cast_all(points, directions, every) == []
    )
    spheres = scene.overlaps_spheres(points, 0.3)
    assert len(spheres) and scene.verify_overlaps_spheres(points, 0.3, spheres) == []
    boxes = scene.overlaps_boxes(points - 0.2, points + 0.2, object=b)
    assert len(boxes) and scene.verify_overlaps_boxes(points - 0.2, points + 0.2, boxes, object=b) == []
    nearest = scene.distance(a, b)
    assert nearest.distance == 0 and scene.verify_distance(a, b, nearest) == []
    assert scene.verify_distances(1, scene.distances(1)) == []
    assert scene.any_contact(a, b) and scene.verify_any_contact(a, b, True) == []
    wrong = scene.verify_any_contact(a, b, False)
    assert len(wrong) == 1 and "contact" in (wrong[0].found + wrong[0].expected)
    for call in (
        lambda: scene.closest(points[0]),
        lambda: scene.cast(points, directions[:3]),
        lambda: scene.distance(a, a),
        lambda: scene.closest(points, max_distance=-1),
        lambda: scene.overlaps_spheres(points, [1, 2]),
        lambda: scene.verify_closest(points, np.zeros(3)),
    ):
        with pytest.raises(supple.Error):
            call()


def test_text_of_results(sphere):
    scene, *_ = two_spheres(sphere)
    assert repr(scene.result).startswith("<supple.Result of step 0: no contacts") and len(scene.result) == 0
    result = scene.detect()
    assert f"{len(result.contacts)} contacts" in repr(result) and "ms>" in repr(result)
    assert "<table>" in result._repr_html_() and "(length)" in result.proximity._repr_html_()
    lone = supple.Scene()
    lone.add(sphere)
    assert "intersection: nothing to test (one_object)" in repr(lone.detect())
    assert repr(result.contacts).startswith(f"Table of {len(result.contacts)} Contact\n  Contact(object_a=0")
    assert "2 objects" in repr(scene) and "<table>" in scene._repr_html_()
    (pair,) = list(result)
    assert (pair.object_a, pair.object_b) == (0, 1) and len(pair.contacts) == len(result.contacts)
    assert len(result) == len(result.contacts) + len(result.proximity) + len(result.penetrations)


def test_results_are_pickled(sphere):
    scene, *_ = two_spheres(sphere)
    result = scene.detect()
    again = pickle.loads(pickle.dumps(result))
    assert equal(again.contacts, result.contacts) and again.step == result.step
    np.testing.assert_array_equal(again.proximity["vertices"], result.proximity["vertices"])
    np.testing.assert_array_equal(again.proximity[3:5]["vertices"], result.proximity[3:5]["vertices"])
    assert equal(again.events["contact_begin"], result.events["contact_begin"])
    assert pickle.loads(pickle.dumps(again)).contacts[0] == result.contacts[0]
    mesh = pickle.loads(pickle.dumps(sphere))
    np.testing.assert_array_equal(mesh.positions, sphere.positions)


def test_pandas(sphere):
    pytest.importorskip("pandas")
    scene, *_ = two_spheres(sphere)
    frames = scene.detect().to_pandas()
    table = frames["proximity_pairs"]
    assert {"kind_a", "normal_x", "barycentric_a_0"} <= set(table.columns) and set(table["kind_a"]) <= {
        "vertex",
        "edge",
        "face",
    }


def test_two_threads(sphere):
    """Calls of one scene wait for each other; two scenes run at once."""
    scene, a, b = two_spheres(sphere, threads=1)
    wanted = len(scene.detect().contacts)
    failed = []

    def work():
        try:
            for _ in range(20):
                result = scene.detect()
                assert len(result.contacts) == wanted
                scene.closest([[0, 0, 3.0]])
        except Exception as error:  # noqa: BLE001
            failed.append(error)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert failed == []


def busy_scene():
    """A scene whose detection takes seconds."""
    scene = supple.Scene(contacts="proximity", threads=1)
    mesh = supple.make_icosphere(40)
    for _ in range(2):
        scene.add(mesh, margin=0.3)
    return scene


def test_a_stop_from_another_thread():
    scene, stop = busy_scene(), supple.Stop()
    stop.request()
    result = scene.detect(stop=stop)
    assert result.stopped and len(result) == 0 and "stopped" in repr(result)


@pytest.fixture
def on_interrupt():
    """Sets the handler of Ctrl-C, which a test run in the background ignores."""
    before = signal.getsignal(signal.SIGINT)
    yield lambda handler: signal.signal(signal.SIGINT, handler)
    signal.signal(signal.SIGINT, before)


def interrupt_after(condition):
    """A thread that presses Ctrl-C once the condition holds."""

    def interrupt():
        while not condition():
            time.sleep(0.001)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    return thread


def test_ctrl_c_stops_a_call(on_interrupt):
    on_interrupt(signal.default_int_handler)
    scene = busy_scene()
    calls = []
    scene.set_pair_filter(lambda a, b: calls.append(1) or True)
    thread = interrupt_after(lambda: calls)
    with pytest.raises(KeyboardInterrupt):
        scene.detect()
        time.sleep(60)  # the interrupt may come after the call
    thread.join()
    assert scene.detect(contacts="intersection", max_contacts=1).stopped is False


def test_an_ignored_ctrl_c_changes_nothing(on_interrupt, sphere):
    on_interrupt(signal.SIG_IGN)
    scene, *_ = two_spheres(sphere)
    calls = []
    scene.set_pair_filter(lambda a, b: calls.append(1) or True)
    thread = interrupt_after(lambda: calls)
    while thread.is_alive():
        assert len(scene.detect().contacts) > 0
    thread.join()


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_fork(sphere):
    scene, *_ = two_spheres(sphere)
    scene.detect()
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        answer = b"no error"
        try:
            scene.detect()
        except supple.Error as error:
            answer = str(error).encode()
        fresh, *_ = two_spheres(sphere)
        answer += b"; fresh: %d" % len(fresh.detect().contacts)
        os.write(write, answer)
        os._exit(0)
    assert os.waitpid(child, 0)[1] == 0
    answer = os.read(read, 1000).decode()
    assert "before fork" in answer and f"fresh: {len(scene.result.contacts)}" in answer


def test_a_process_made_by_fork_during_a_call_ends():
    import subprocess
    import sys

    program = """
import os, threading, time, supple
mesh = supple.make_icosphere(30)
scene = supple.Scene()
a, b = scene.add(mesh), scene.add(mesh)
def work():
    while True:
        a.positions = mesh.positions
        scene.detect()
threading.Thread(target=work, daemon=True).start()
time.sleep(0.1)
child = os.fork()
if child:
    raise SystemExit(os.waitpid(child, 0)[1])
"""
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", program], capture_output=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr


def test_scenes_are_freed(sphere):
    """Neither filters, results nor objects keep a scene."""
    import weakref

    scene, a, _ = two_spheres(sphere)
    scene.set_pair_filter(lambda p, q: p.index >= 0)
    contacts = scene.detect().contacts
    gone = weakref.ref(scene)
    del scene, a, _
    gc.collect()
    assert gone() is None and len(contacts) > 0


def test_inspector(sphere):
    scene, a, b = two_spheres(sphere)
    scene.detect()
    inspector = supple.Inspector(scene)
    leaves = inspector.cells(a)
    assert (
        sum(each["triangle_count"] for each in leaves)
        == a.triangle_count
        == inspector.octree_statistics(a)["triangles"]
    )
    pairs, total = inspector.candidates(5)
    assert pairs.shape == (5, 4) and total >= len(scene.result.contacts)
    contact = scene.result.contacts[0]
    assert inspector.explain(a, contact.triangle_a, b, contact.triangle_b)["stage"] == "contact"
    assert inspector.node_pairs(a, b).level_begin[0] == 0 and inspector.leaf(a, 0)["is_leaf"]
    assert inspector.bounds(a)[0][0] == pytest.approx(-1) and inspector.octree_depth(a) > 0
    assert inspector.regions() == [] or inspector.regions()[0]["level"] == 0


def test_the_broad_phase_alone(rng):
    low = rng.uniform(size=(300, 3))
    boxes = supple.enclosing_boxes(low, low + 0.1)
    wanted = {
        (i, j)
        for i in range(300)
        for j in range(i + 1, 300)
        if (boxes[i, 0] <= boxes[j, 1]).all() and (boxes[j, 0] <= boxes[i, 1]).all()
    }
    for method in ("octree", "grid", "sweep", "brute"):
        assert {tuple(pair) for pair in supple.BroadPhase(method=method).find(boxes).tolist()} == wanted
    with pytest.raises(supple.Error, match="float32"):
        supple.BroadPhase().find(low)
    spheres = np.concatenate([low, np.full((300, 1), 0.05)], axis=1).astype(np.float32)
    assert len(supple.BroadPhase().find(spheres)) > 0
    kinds = np.arange(300) % 2
    found = supple.BroadPhase(kind_pairs=[(0, 1)]).find(boxes, kinds=kinds)
    assert {tuple(pair) for pair in found.tolist()} == {(i, j) for i, j in wanted if kinds[i] != kinds[j]}


def test_a_handler_of_ctrl_c_that_raises_nothing_does_not_change_answers(on_interrupt):
    scene = supple.Scene(threads=1)
    mesh = supple.make_icosphere(20)
    scene.add(mesh)
    points = np.random.default_rng(0).uniform(-1, 1, (200_000, 3))
    wanted = scene.inside(points)
    seen = []
    on_interrupt(lambda *_: seen.append(1))
    for _ in range(5):
        timer = threading.Timer(0.01, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        np.testing.assert_array_equal(scene.inside(points), wanted)
        timer.join()
    assert seen


def test_a_stopped_query_has_no_answer(sphere):
    scene, a, b = two_spheres(sphere)
    scene.detect()
    stop = supple.Stop()
    stop.request()
    assert stop.requested
    for query in (
        lambda: scene.any_contact(a, b, stop=stop),
        lambda: scene.distance(a, b, stop=stop),
        lambda: scene.inside([[0, 0, 0]], stop=stop),
        lambda: scene.closest([[0, 0, 0]], stop=stop),
        lambda: scene.verify(stop=stop),
    ):
        with pytest.raises(supple.Error, match="stopped, so there is no answer"):
            query()
    assert "(stopped)" in repr(scene.search(contacts="intersection", stop=stop))


def test_the_interpreter_ends_while_a_call_runs(tmp_path):
    import subprocess
    import sys

    for call in ("scene.detect(); a.positions = x", "supple.Scene().add(mesh)", "scene.closest(x)"):
        program = f"""
import threading, time, supple
mesh = supple.make_icosphere(40)
x = mesh.positions
scene = supple.Scene()
a, b = scene.add(mesh), scene.add(x + [0.1, 0, 0], mesh.triangles)
def work():
    while True:
        {call}
threading.Thread(target=work, daemon=True).start()
time.sleep(0.2)
"""
        done = subprocess.run(
            [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False
        )
        assert done.returncode == 0 and "terminate" not in done.stderr, done.stderr


def test_objects_by_number_and_name(sphere):
    scene, a, b = two_spheres(sphere)
    for key in (1.7, True, None, b"a", float("nan"), 5, "c"):
        assert key not in scene
        with pytest.raises(KeyError):
            scene[key]
        if key is not None:
            with pytest.raises(KeyError):
                scene.closest([[0, 0, 0]], object=key)
    assert "a" in scene and 1 in scene and np.int64(1) in scene
    scene.remove("a")
    assert len(scene) == 1 and scene.objects == [b]
    scene.remove(np.int64(1))
    assert len(scene) == 0 and "0 objects" in repr(scene)
    with pytest.raises(AttributeError):
        scene.contacts = "proximity"


def test_positions_of_several_objects_are_set_together(sphere):
    scene, a, b = two_spheres(sphere)
    x = a.positions
    for wrong in ({a: x + 1, b: x[:3]}, {a: x + 1, "a": x}, [(a, x)], {a: x + 1, "z": x}):
        with pytest.raises((supple.Error, KeyError)):
            scene.set_positions(wrong)
        np.testing.assert_array_equal(a.positions, x)
    scene.set_positions({a: x + 1, "b": x})
    np.testing.assert_array_equal(a.positions, x + 1)
    x += 1  # a copy of one's own


def test_values_of_numpy_are_options(sphere):
    scene = supple.Scene(contacts="proximity", contact_points=np.bool_(False), threads=np.int64(1))
    a = scene.add(sphere, margin=np.float32(0.25), static=np.True_)
    scene.add(sphere)
    scene.set_pair_filter(lambda p, q: np.bool_(False))
    assert scene.options["contact_points"] is False and len(scene.detect().proximity) == 0
    a.set_static(np.False_)
    for wrong in (
        lambda: a.set_static(1),
        lambda: a.set_self_collision("x"),
        lambda: a.set_group(-1),
        lambda: a.set_margin("1"),
        lambda: scene.closest([[0, 0, 0]], mask=-1),
        lambda: supple.make_icosphere(-1),
        lambda: supple.make_cloth(-1, 2),
        lambda: scene.add(np.ma.masked_array(sphere.positions), sphere.triangles),
        lambda: scene.add(np.array([[2**53 + 1, 0, 0]] * 3), [[0, 1, 2]]),
        lambda: scene.add("cube.obj", sphere.triangles),
        lambda: supple.Simulation().add(sphere, springs=True),
    ):
        with pytest.raises(supple.Error):
            wrong()
    points = scene.add(np.zeros((3, 3)), points=[0, 1])
    assert points.triangle_count == 0
    assert "self_collision" in {each.name for each in supple.options("ObjectOptions")}


def test_tables_of_other_shapes_and_reports(sphere):
    scene, a, b = two_spheres(sphere)
    result = scene.detect()
    pairs = result.proximity
    for odd in (pairs[None], pairs[:4].reshape(2, 2)):
        for column in ("barycentric", "vertices", "object"):
            with pytest.raises(supple.Error, match="one dimension"):
                odd[column]
    np.testing.assert_array_equal(pairs[::-2]["barycentric"], pairs["barycentric"][::-2])
    assert pairs[:0]["vertices"].shape == (0, 2, 3) == pairs[:0]["barycentric"].shape
    assert pickle.loads(pickle.dumps(scene.verify())).agrees
    assert [pair.object_a for pair in pickle.loads(pickle.dumps(result))] == [0]
    with pytest.raises(supple.Error, match="0 to 2"):
        scene.verify_inside([[0, 0, 0]], [7], object=a)
