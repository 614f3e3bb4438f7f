"""Results and their tables: how long they are valid, their columns, text and conversions."""

import gc
import pickle

import numpy as np
import pytest
from conftest import equal, two_spheres

import supple


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


def padding(dtype):
    """The places of the bytes of a record that belong to no column."""
    used = np.zeros(dtype.itemsize, bool)
    for kind, at in (each[:2] for each in dtype.fields.values()):
        used[at : at + kind.itemsize] = True
    return np.flatnonzero(~used)


def test_bytes_between_columns_are_zero(sphere, tmp_path):
    """So that equal tables have equal bytes, pickles and hashes, whatever was in the memory before."""
    rng = np.random.default_rng(4)
    seen = set()

    def check(table):
        if isinstance(table, supple.Table) and len(table):
            rows = np.ndarray.view(table, np.ndarray).view(np.uint8).reshape(len(table), -1)
            assert not rows[:, padding(table.dtype)].any(), table.record
            seen.add(table.record)

    def found():
        junk = [rng.integers(1, 255, size, dtype=np.uint8) for size in rng.integers(100, 200_000, 50)]
        del junk
        scene, a, b = two_spheres(sphere, apart=1.4)
        scene.add(0.1 * np.asarray(sphere.positions), sphere.triangles, name="inner")
        x = np.array(a.positions)
        for step in range(3):
            b.positions = np.asarray(sphere.positions) + [1.4 + 0.01 * step, 0, 0]
            scene.detect()
        b.set_motion(np.asarray(sphere.positions) + [3, 0, 0], np.asarray(sphere.positions) + [1.4, 0.1, 0])
        kinds = {"intersection", "proximity", "penetration", "continuous"}
        result = scene.detect(contacts=kinds, manifolds=True)
        search = scene.search(contacts=kinds)
        tables = [result._list(name) for name in result._names()] + [
            search._list(name) for name in search._names()
        ]
        directions = rng.normal(size=x.shape) * 0 + [1, 0.1, 0.2]
        tables += [
            scene.closest(x + 0.1),
            scene.cast(x, directions),
            scene.cast_all(x, directions),
            scene.overlaps_boxes(x - 0.1, x + 0.1),
            scene.distances(),
            scene.distance(a, b)._row,
            scene.earliest_impact()._row,
            scene.max_step().limit._row,
            supple.point_triangle_distance(x[:9], x[:27].reshape(9, 3, 3)),
            supple.intersect_triangles(x[:9].reshape(3, 3, 3), x[9:18].reshape(3, 3, 3)),
            supple.first_impact("edge_edge", x[:16].reshape(4, 4, 3), x[16:32].reshape(4, 4, 3)),
        ]
        x[0] = np.nan
        a.positions = x
        tables.append(scene.detect().non_finite_vertices)
        with supple.record(tmp_path / "run.h5", scene) as recorder:
            recorder.add()
        frame = supple.open(tmp_path / "run.h5")[0]
        tables += [frame._list(name) for name in frame._names()]
        for each in tables:
            check(each)
        return [each.tobytes() for each in tables], [pickle.dumps(each) for each in tables]

    first, second = found(), found()
    assert first == second
    assert {name for name in seen if len(padding(supple.dtypes[name]))} >= {
        "Contact",
        "ContinuousContact",
        "ContactPoint",
        "ProximityPair",
        "Penetration",
        "IntersectionCurve",
        "Manifold",
        "FoundClosestPoint",
        "FoundRayHit",
        "FoundElementDistance",
        "FoundImpact",
        "TriangleIntersection",
        "LimitingPair",
    } - {name for name, dtype in supple.dtypes.items() if not len(padding(dtype))}
