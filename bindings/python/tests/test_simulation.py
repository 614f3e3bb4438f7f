"""Simulations, bodies of masses and springs, the response, and recordings."""

import numpy as np
import pytest
from conftest import equal

import supple


def test_the_simulation_is_that_of_the_program(program, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text("""[scene]
bounds = [[-1, -1, -1], [1, 1, 1]]
seed = 5
[[object]]
model = "rabbit"
motion = { kind = "mass_spring", random_speed = 0.6 }
[[object]]
model = "fish"
motion = { kind = "mass_spring", random_speed = 0.6 }
""")
    program("simulate", scene, "--frames", "20", "--record", tmp_path / "cli.h5", "--quiet")
    simulation = supple.Simulation(border=[[-1, -1, -1], [1, 1, 1]], seed=5)
    for name in ("rabbit", "fish"):
        simulation.add(supple.make_model(name), name=name, springs={"random_speed": 0.6})
    theirs = supple.open(tmp_path / "cli.h5")
    assert len(theirs) == 20 and [each.name for each in theirs.objects] == ["rabbit", "fish"]
    for frame in theirs:
        result = simulation.step() if frame.number else simulation.detect()
        for place, each in enumerate(simulation):
            np.testing.assert_array_equal(each.positions, frame.positions[place])
        assert equal(result.contacts, frame.contacts)
    assert sum(len(frame.contacts) for frame in theirs) > 0 and simulation.step_count == 19


def test_recordings(tmp_path):
    simulation = supple.Simulation(contacts={"intersection", "penetration"}, curves=True, seed=1)
    box = simulation.add(supple.make_box(), rigid={"velocity": (1, 0, 0)}, name="box", solid=True)
    moved = simulation.add(
        supple.make_icosphere(3), motion=lambda seconds, x: x + [0, 0.01, 0], name="ball", solid=True
    )
    simulation.add(
        supple.make_cloth(3, 3),
        springs={"gravity": (0, -9.81, 0)},
        fixed_vertices=[0],
        handles=[([3], {"by": (0, 1, 0), "seconds": 0.1})],
    )
    results = []
    with supple.record(tmp_path / "run.h5", simulation) as recorder:
        for result in simulation.run(5, progress=True):
            recorder.add()
            results.append(result)
    recording = supple.open(tmp_path / "run.h5")
    assert len(recording) == 5 and recording.time_step == 0.01 and recording[-1].time == pytest.approx(0.05)
    for frame, result in zip(recording, results):
        np.testing.assert_array_equal(frame.contacts["vertices"], result.contacts["vertices"])
        for name in ("contacts", "penetrations", "curves", "object_pairs"):
            assert equal(getattr(frame, name), getattr(result, name))
    assert len(results[0].penetrations) > 0
    np.testing.assert_array_equal(recording.positions(4, 0), box.positions)
    np.testing.assert_allclose(moved.positions[0], supple.make_icosphere(3).positions[0] + [0, 0.05, 0])
    assert supple.find_first_difference(recording, recording) is None
    assert "contacts" in repr(recording[0]) and recording.summary(3).stats["contacts"] == len(
        results[3].contacts
    )
    assert [each.number for each in recording[1:3]] == [1, 2]
    with pytest.raises(IndexError, match="has 5 frames; there is no frame 5"):
        recording[5]
    with pytest.raises(supple.Error, match="closed"):
        recorder.add()
    (tmp_path / "bad.h5").write_bytes(b"no recording")
    for path in (tmp_path / "bad.h5", tmp_path / "missing.h5"):
        with pytest.raises(supple.Error, match=path.name):
            supple.open(path)


def test_a_scene_is_recorded(tmp_path):
    scene = supple.Scene()
    a = scene.add(supple.make_box(), name="a")
    scene.add(supple.make_box(), name="b")
    with supple.record(tmp_path / "run.h5", scene, time_step=0.5) as recorder:
        for step in range(3):
            a.positions = supple.make_box().positions + [0.4 * step, 0, 0]
            scene.detect()
            recorder.add()
    recording = supple.open(tmp_path / "run.h5")
    assert [frame.time for frame in recording] == [0, 0.5, 1] and len(recording[2].contacts) == len(
        scene.result.contacts
    )


def test_errors_of_simulations():
    simulation = supple.Simulation()
    box = supple.make_box()
    for options, message in [
        ({"springs": {}, "rigid": {}}, "one motion"),
        ({"fixed_vertices": [1]}, "need springs"),
        ({"springs": {"stiffness": -1}}, "stiffness is -1"),
        ({"rigid": {"spin": 3}}, "three numbers"),
        ({"springs": {}, "fixed_vertices": [99]}, "99"),
    ]:
        with pytest.raises(supple.Error, match=message):
            simulation.add(box, **options)
    with pytest.raises(TypeError, match="no option 'stifness'"):
        simulation.add(box, springs={"stifness": 1})
    for options in (
        {"border": [[0, 0, 0]]},
        {"time_step": 0},
        {"response": {"thickness": -1}},
        {"response": 3},
    ):
        with pytest.raises(supple.Error):
            supple.Simulation(**options)
    unstable = supple.Simulation(time_step=1)
    unstable.add(box, name="unstable", springs={"stiffness": 1e6, "random_force": 1e3, "deform_seconds": 1})
    with pytest.raises(supple.MotionError, match="unstable"):
        for _ in unstable.run(50):
            pass
    simulation.add(box, motion=lambda seconds, x: x[:3])
    with pytest.raises(supple.Error, match="3 positions for 8 vertices"):
        simulation.step()
    failing = supple.Simulation()
    failing.add(box, motion=lambda seconds, x: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        failing.step()


def test_a_body_of_masses_and_springs():
    body = supple.MassSpringBody(supple.make_cloth(4, 4), gravity=(0, -9.81, 0), fixed_vertices=[0, 4])
    before = body.energy["total"]
    for _ in range(10):
        body.step(0.5 * body.stable_step())
    assert body.positions[-1, 1] < 0 and body.energy["kinetic"] > 0 and body.energy["total"] <= before + 1e-9
    assert np.all(body.velocities[0] == 0) and body.vertex_count == 25
    ends, lengths = body.springs
    assert ends.shape == (len(lengths), 2) and body.area_error[0] >= body.area_error[1] >= 0
    x = body.positions
    strains = np.abs(np.linalg.norm(x[ends[:, 0]] - x[ends[:, 1]], axis=1) / lengths - 1)
    assert np.allclose(body.edge_strain, (strains.max(), strains.mean()), rtol=1e-12)
    assert np.allclose(body.bounds, (x.min(axis=0), x.max(axis=0)), rtol=0)
    body.undo_step()
    with pytest.raises(supple.Error):
        body.undo_step()
    with pytest.raises(supple.Error, match="3; it must be 0, 1 or 2"):
        body.reflect(3)


def test_the_response_keeps_bodies_apart():
    scene = supple.Scene()
    ball = scene.add(supple.make_icosphere(6), margin=0.02)
    cloth = supple.make_cloth(10, 10)
    x = np.asarray(cloth.positions) + [0, 1.05, 0]
    body = scene.add(x, cloth.triangles, margin=0.02, self_collision=True)
    v = np.zeros_like(x)
    masses = np.full(len(x), 0.01)
    for _ in range(20):
        v[:, 1] -= 0.02 * 9.81
        part = supple.respond(scene, body, v, masses, 0.02, thickness=0.01)
        x = x + part * 0.02 * v
        body.positions = x
        assert len(scene.detect().contacts) == 0
    assert scene.distance(ball, body).distance < 0.05
    with pytest.raises(supple.Error, match="writable"):
        supple.respond(scene, body, v.astype(np.float32), masses, 0.02)
