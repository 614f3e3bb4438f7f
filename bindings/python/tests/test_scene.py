"""Scenes: the answers are those of C++, and objects do what they say."""

import numpy as np
import pytest
from conftest import two_spheres

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


def test_the_method_of_2007_finds_the_same_contacts():
    scene_options, object_options = supple.method_of_2007(bounding_volume="sphere")
    assert scene_options["descent"] == "one_side_first" and object_options["leaf_size"] == 1
    as_2007, defaults = supple.Scene(**scene_options), supple.Scene()
    for name in ("pawn", "fish", "rabbit"):
        as_2007.add(supple.make_model(name), **object_options)
        defaults.add(supple.make_model(name))
    found, expected = as_2007.detect(), defaults.detect()
    assert len(expected.contacts) > 100
    for name in ("triangle_a", "triangle_b"):
        assert np.array_equal(found.contacts[name], expected.contacts[name])
    assert len(found.colliding_vertices) > 0
    with pytest.raises(supple.Error, match="aabb or sphere"):
        supple.Scene(lazy_refit=True, bounding_volume="obb")


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


def test_edits_of_meshes(sphere):
    scene, a, b = two_spheres(sphere)
    before = scene.detect()
    began, count = len(before.contacts), a.triangle_count
    touched = np.unique(before.contacts["triangle_a"])
    corners = a.triangles[touched]
    middles = a.positions[corners].mean(axis=1)
    v = np.arange(a.vertex_count, a.vertex_count + len(touched))
    p, q, r = corners.T
    split = np.concatenate([np.stack(side, axis=1) for side in ((p, q, v), (q, r, v), (r, p, v))])
    a.edit(removed=touched, added=split, new_vertices=middles)
    assert a.mesh_version == 1 and a.triangle_count == count + 3 * len(touched)
    assert not a.triangles[touched].any() and (a.triangles[count:] == split).all()
    after = scene.detect()
    assert len(after.contacts) >= began and not np.isin(after.contacts["triangle_a"], touched).any()
    events = after.events  # a pair that touches before and after stays
    assert [len(events[f"contact_{when}"]) for when in ("begin", "stay", "end")] == [0, 1, 0]
    fresh = supple.Scene()
    fresh.add(a.positions, np.delete(a.triangles, touched, axis=0))
    fresh.add(b.positions, b.triangles)
    numbers = a.compact()
    assert (numbers[touched] == 2**32 - 1).all()
    assert scene.detect().contacts.tobytes() == fresh.detect().contacts.tobytes()
    assert scene.verify().agrees
    for wrong, error in (
        ({"removed": [10**6]}, "no triangle 1000000"),
        ({"removed": [5, 5]}, "triangle 5 is removed twice"),
        ({"added": [[0, 1, 10**6]]}, "triangle 0 uses vertex 1000000"),
        ({"new_vertices": [[0, np.nan, 0]]}, "position of new vertex 0 is not finite"),
        ({"new_vertices": [[0, 0, 0]], "new_starts": [[0, 0, 0]]}, "not on a path"),
        ({"removed_edges": [[0, 1]]}, "no edge 0-1 to remove"),
    ):
        with pytest.raises(supple.Error, match=error):
            a.edit(**wrong)
    a.share_positions(a.positions)
    with pytest.raises(supple.Error, match="shares its positions"):
        a.edit(removed=[0])
    assert a.mesh_version == 2


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
    assert inspector.regions() == []  # the grid ran
    octree = supple.Scene(broad_phase="octree")
    inside = octree.add(sphere)
    octree.add(sphere)
    octree.detect()
    regions = supple.Inspector(octree).regions()
    assert regions[0]["level"] == 0 and supple.Inspector(octree).regions(inside)[0]["is_leaf"]


def test_the_broad_phase_alone(rng):
    low = rng.uniform(size=(300, 3))
    boxes = supple.enclosing_boxes(low, low + 0.1)
    wanted = {
        (i, j)
        for i in range(300)
        for j in range(i + 1, 300)
        if (boxes[i, 0] <= boxes[j, 1]).all() and (boxes[j, 0] <= boxes[i, 1]).all()
    }
    for method in ("octree", "grid", "sweep", "brute", "sweep3"):
        assert {tuple(pair) for pair in supple.BroadPhase(method=method).find(boxes).tolist()} == wanted
    with pytest.raises(supple.Error, match="float32"):
        supple.BroadPhase().find(low)
    spheres = np.concatenate([low, np.full((300, 1), 0.05)], axis=1).astype(np.float32)
    assert len(supple.BroadPhase().find(spheres)) > 0
    kinds = np.arange(300) % 2
    found = supple.BroadPhase(kind_pairs=[(0, 1)]).find(boxes, kinds=kinds)
    assert {tuple(pair) for pair in found.tolist()} == {(i, j) for i, j in wanted if kinds[i] != kinds[j]}


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
