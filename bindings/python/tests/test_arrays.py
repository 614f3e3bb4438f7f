"""Arrays and values of any kind, and those that are refused."""

import gc

import numpy as np
import pytest
from conftest import two_spheres

import supple

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
