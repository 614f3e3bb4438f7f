"""Distances, intersections and impacts of raw elements against fractions."""

from fractions import Fraction

import numpy as np
import pytest

import supple


def test_distances_of_points_are_exact(rng):
    a, b = rng.normal(size=(200, 3)), rng.normal(size=(200, 3))
    found = supple.point_point_distance(a, b)
    for i in range(200):
        exact = sum((Fraction(p) - Fraction(q)) ** 2 for p, q in zip(a[i].tolist(), b[i].tolist()))
        low, high = (Fraction(float(np.nextafter(found["distance"][i], side))) for side in (0, np.inf))
        assert low * low <= exact <= high * high
    assert not supple.point_point_distance(a, b, max_distance=0)["found"].any()


def test_distances_of_elements_agree(rng):
    points, triangles = rng.normal(size=(100, 3)), rng.normal(size=(100, 3, 3))
    to_triangle = supple.point_triangle_distance(points, triangles)
    to_edges = [
        supple.point_edge_distance(points, triangles[:, pair])["distance"]
        for pair in ([0, 1], [1, 2], [0, 2])
    ]
    on_border = to_triangle["feature_b_kind"] != supple.FeatureKind.face
    assert 0 < on_border.sum() < 100
    np.testing.assert_allclose(
        np.min(to_edges, axis=0)[on_border], to_triangle["distance"][on_border], rtol=1e-14
    )
    assert (np.min(to_edges, axis=0) >= to_triangle["distance"] - 1e-14).all()
    closest = (to_triangle["barycentric_b"][:, :, None] * triangles).sum(1)
    np.testing.assert_allclose(np.linalg.norm(points - closest, axis=1), to_triangle["distance"], rtol=1e-12)
    edges = supple.edge_edge_distance(triangles[:, :2], triangles[::-1, 1:])
    np.testing.assert_allclose(
        np.linalg.norm(edges["point_a"] - edges["point_b"], axis=1), edges["distance"], atol=1e-14
    )


def test_triangles(rng):
    a, b = rng.integers(-2, 3, size=(2, 400, 3, 3)).astype(float)
    hit = supple.triangles_intersect(a, b)
    found = supple.intersect_triangles(a, b)
    np.testing.assert_array_equal(found["intersects"], hit)
    assert 0 < hit.sum() < 400 and (found["point_count"][hit] > 0).all()
    with pytest.raises(supple.Error, match="same number"):
        supple.triangles_intersect(a, b[:3])
    with pytest.raises(supple.Error, match=r"shape \(400, 9\)"):
        supple.triangles_intersect(a.reshape(-1, 9), b)


@pytest.mark.parametrize(
    "kind, points", [("vertex_face", 4), ("edge_edge", 4), ("point_point", 2), ("point_edge", 3)]
)
def test_impacts_agree_with_algebra(kind, points, rng):
    start = rng.integers(-3, 4, size=(150, points, 3)).astype(float)
    end = rng.integers(-3, 4, size=(150, points, 3)).astype(float)
    found = supple.first_impact(kind, start, end)
    times = supple.first_contact_by_algebra(kind, start, end)
    np.testing.assert_array_equal(found["found"], np.isfinite(times[:, 0]))
    touching = found["found"]
    assert (found["toi"][touching] <= times[touching, 1]).all()
    np.testing.assert_allclose(found["toi"][touching], times[touching, 0], atol=1e-9)
    with pytest.raises(supple.Error, match="max_time is 2"):
        supple.first_impact(kind, start, end, max_time=2)
    with pytest.raises(supple.Error, match="the kind is 'foo'"):
        supple.first_impact("foo", start, end)
