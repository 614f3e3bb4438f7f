"""Calls from threads, their stop by Ctrl-C and from other threads, fork, and the end of the interpreter."""

import copy
import gc
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import weakref

import numpy as np
import pytest
from conftest import two_spheres

import supple


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


def test_ctrl_c_stops_a_search_for_a_step(on_interrupt):
    on_interrupt(signal.default_int_handler)
    scene = busy_scene()
    calls = []
    scene.set_pair_filter(lambda a, b: calls.append(1) or True)
    for search in scene.collision_free_step, scene.collision_free_steps, scene.max_step, scene.earliest_impact:
        calls.clear()
        thread = interrupt_after(lambda: calls)
        with pytest.raises(KeyboardInterrupt):
            search()
            time.sleep(60)  # the interrupt may come after the call
        thread.join()
    assert not scene.max_step().stopped


def test_searches_for_steps_end_earlier(sphere):
    scene, *_ = two_spheres(sphere)
    stop = supple.Stop()
    stop.request()
    for limits in {"stop": stop}, {"seconds": 0}:
        for step in (scene.max_step(**limits), scene.collision_free_step(**limits)):
            assert step.stopped and step.limit is None and 0 <= step.step <= 1
        assert all(each.stopped for each in scene.collision_free_steps(**limits))
    with pytest.raises(supple.Error, match="stopped"):
        scene.earliest_impact(stop=stop)
    with pytest.raises(supple.Error, match="seconds"):
        scene.max_step(seconds=-1)
    assert not scene.collision_free_step().stopped


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
        [sys.executable, "-W", "ignore", "-c", program], capture_output=True, timeout=600, check=False
    )
    assert done.returncode == 0, done.stderr


def test_scenes_are_freed(sphere):
    """Neither filters, results nor objects keep a scene."""

    scene, a, _ = two_spheres(sphere)
    scene.set_pair_filter(lambda p, q: p.index >= 0)
    contacts = scene.detect().contacts
    gone = weakref.ref(scene)
    del scene, a, _
    gc.collect()
    assert gone() is None and len(contacts) > 0


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
            [sys.executable, "-c", program], capture_output=True, text=True, timeout=600, check=False
        )
        assert done.returncode == 0 and "terminate" not in done.stderr, done.stderr


class Tracked(np.ndarray):
    """An array with attributes, as other packages have them."""


class Owner:
    """A program that its scene can reach: by its filter, by an array that the scene reads, or by a motion."""

    def __init__(self, way, sphere):
        self.big = np.zeros(1000)
        if way == "motion":
            self.scene = supple.Simulation()
            self.scene.add(sphere, motion=self.move)
            self.scene.add(supple.make_box(), motion=lambda seconds, x: self.move(seconds, x))
            self.scene.step()
            return
        self.scene = supple.Scene()
        ball = self.scene.add(sphere)
        self.scene.add(supple.make_box())
        if way == "filter":
            self.scene.set_pair_filter(self.accepts)
        elif way == "closure":
            self.scene.set_pair_filter(lambda a, b: a in self.scene and self.accepts(a, b))
        else:
            positions = np.array(sphere.positions).view(Tracked)
            positions.owner = self
            ball.share_positions(positions)
        self.result = self.scene.detect()
        self.pairs = self.result.object_pairs

    def accepts(self, a, b):
        return len(self.big) > 0

    def move(self, seconds, positions):
        positions += 0.001 * len(self.big)


@pytest.mark.parametrize("way", ["filter", "closure", "array", "motion"])
def test_what_a_scene_can_reach_is_freed_with_it(way, sphere):
    owners = [Owner(way, sphere) for _ in range(3)]
    gc.collect()
    for each in owners:  # while they are held, functions and arrays stay
        assert each.scene.detect() is not None
    alive = [weakref.ref(each) for each in owners] + [weakref.ref(each.scene) for each in owners]
    del owners, each
    gc.collect()
    assert not any(reference() is not None for reference in alive)


def test_a_filter_or_motion_that_was_replaced_is_freed(sphere):
    def filters():
        return lambda a, b: True

    scene, first = supple.Scene(), filters()
    scene.set_pair_filter(first)
    alive = weakref.ref(first)
    del first
    gc.collect()
    assert alive() is not None
    scene.set_pair_filter(None)
    assert alive() is None
    simulation, motion = supple.Simulation(), filters()
    body = simulation.add(sphere, motion=lambda seconds, x, kept=motion: None)
    alive = weakref.ref(motion)
    del motion
    gc.collect()
    assert alive() is not None
    simulation.remove(body)
    gc.collect()
    assert alive() is None


def test_callbacks_are_functions(sphere):
    scene, simulation = supple.Scene(), supple.Simulation()
    for call in (
        lambda: scene.set_pair_filter(3),
        lambda: scene.search(only="all"),
        lambda: simulation.add(sphere, motion=(1, 2, 3)),
    ):
        with pytest.raises(TypeError, match="it must be a function of .*, or None"):
            call()


def test_what_owns_memory_is_not_copied(sphere, tmp_path):
    scene, a, _ = two_spheres(sphere)
    owners = [
        scene,
        supple.Simulation(),
        supple.BroadPhase(),
        supple.MassSpringBody(sphere),
        supple.record(tmp_path / "run.h5", scene),
    ]
    for each in owners:
        for make in (copy.copy, copy.deepcopy, pickle.dumps):
            with pytest.raises(
                TypeError, match=f"a supple.{type(each).__name__} cannot be copied or pickled; make"
            ):
                make(each)
    with pytest.raises(TypeError, match="a supple.Scene cannot be copied"):
        copy.deepcopy(a)
    assert copy.copy(a) == a
