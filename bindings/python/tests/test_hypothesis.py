"""Any meshes through the binding: equal to exact brute force and to the program."""

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import supple

# Few values, so that meshes touch, coincide and degenerate.
coordinate = st.sampled_from([0, 1, -1, 0.5, 2, 1e-30, 1e30, float("nan"), float("inf")]) | st.floats(
    -2, 2, width=32
)
small = settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


@st.composite
def mesh(draw):
    count = draw(st.integers(3, 8))
    positions = np.array(
        draw(st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=count, max_size=count))
    )
    faces = draw(st.lists(st.tuples(*[st.integers(0, count - 1)] * 3), max_size=8))
    return positions.astype(draw(st.sampled_from([np.float32, np.float64]))), np.array(
        faces, np.int64
    ).reshape(-1, 3)


@small
@given(st.lists(mesh(), min_size=1, max_size=3), st.booleans(), st.sampled_from([0, 0.25, 1]))
def test_brute_force_agrees(meshes, self_collision, margin):
    scene = supple.Scene(contacts={"intersection", "proximity", "continuous"})
    objects = [scene.add(*each, self_collision=self_collision, margin=margin) for each in meshes]
    for each, (positions, _) in zip(objects, meshes):
        each.set_motion(positions, np.roll(positions, 1, axis=0))
    result = scene.detect()
    assert scene.verify(), scene.verify().differences
    assert len(result.contacts["triangle_a"]) == result.stats["contacts"] - len(result.continuous)


@small
@given(mesh(), mesh())
def test_the_program_agrees(detect_json, tmp_path, first, second):
    for name, (positions, faces) in (("a", first), ("b", second)):
        positions[~np.isfinite(positions)] = 0
        supple.save_mesh(supple.Mesh(positions, faces), tmp_path / f"{name}.obj")
    frame = detect_json(tmp_path / "a.obj", tmp_path / "b.obj", "--self")
    scene = supple.Scene()
    for name, each in (("a", first), ("b", second)):
        # The format has the shortest text of each number, so the file has the same numbers.
        scene.add(*each, name=name, self_collision=True)
    contacts = scene.detect().contacts
    wanted = sorted(
        [
            *(
                ((each["a"], each["b"]), tuple(pair))
                for each in frame["triangle_pairs"]
                for pair in each["pairs"]
            ),
            *(((each["a"], each["a"]), tuple(pair)) for each in frame["self"] for pair in each["pairs"]),
        ]
    )
    found = sorted(zip(map(tuple, contacts["object"].tolist()), map(tuple, contacts["triangle"].tolist())))
    assert found == wanted
