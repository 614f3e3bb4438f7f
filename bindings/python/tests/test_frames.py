"""Frames on threads, processes, Dask and MPI: the same results as in one process, also when workers die."""

import concurrent.futures
import multiprocessing
import os
import pickle
import shutil
import signal
import subprocess
import sys
import threading

import frame_functions
import numpy as np
import pytest
from conftest import DATA
from frame_functions import Fails, Interrupts, Kills, OwnError, measure, moving_balls, process, square

import supple
from supple import _animation, _frames

FRAMES = 40


def processes(workers=2):
    """A pool of fresh processes: `fork` would copy the threads' locks of the tests."""
    return concurrent.futures.ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"))


@pytest.fixture(scope="module", params=["threads", "processes"])
def executor(request):
    with concurrent.futures.ThreadPoolExecutor(3) if request.param == "threads" else processes() as pool:
        yield pool


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    """The same kind of animation from each source: the arguments of `check` by name."""
    folder = tmp_path_factory.mktemp("frames")
    positions, faces = moving_balls(FRAMES)
    for i, each in enumerate(positions):
        supple.save_mesh(supple.Mesh(each, faces), folder / f"balls_{i}.obj")
    simulation = supple.Simulation(border=[[-1, -1, -1], [1, 1, 1]], seed=1)
    simulation.add(supple.make_model("rabbit"), springs={"random_speed": 0.4})
    simulation.add(supple.make_model("fish"), rigid={"velocity": (0.3, 0, 0)})
    with supple.record(folder / "run.h5", simulation) as recorder:
        for _ in simulation.run(FRAMES):
            recorder.add()
    found = {
        "files": (f"{folder}/balls_*.obj",),
        "list of files": ([folder / f"balls_{i}.obj" for i in range(FRAMES)],),
        "recording": (folder / "run.h5",),
        "open recording": (supple.open(folder / "run.h5"),),
        "array": (positions, faces),
        "meshes": ([supple.Mesh(each, faces) for each in positions],),
        "dict": ({"a": positions, "b": positions + [0, 1, 0]}, {"a": faces, "b": faces}),
    }
    if save_usd(folder / "balls.usda", positions, faces):
        found["usd"] = (folder / "balls.usda",)
    return found


def save_usd(path, positions, faces):
    try:
        from pxr import Usd, UsdGeom, Vt
    except ImportError:
        return False
    stage = Usd.Stage.CreateNew(str(path))
    mesh = UsdGeom.Mesh.Define(stage, "/balls")
    for code, each in enumerate(positions):
        mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(each.astype(np.float32)), code)
    mesh.CreateFaceVertexCountsAttr([3] * len(faces))
    mesh.CreateFaceVertexIndicesAttr(faces.ravel().tolist())
    stage.Save()
    return True


def in_full(report):
    """All of a report; `repr` of a float is exact."""
    return report.source, report.names, report.notes, repr(report.frames)


NAMES = ["files", "list of files", "recording", "open recording", "array", "meshes", "dict", "usd"]


@pytest.mark.parametrize("name", NAMES)
def test_check_is_the_same_as_in_one_process(name, sources, executor, monkeypatch):
    if name not in sources:
        pytest.skip("usd-core is not installed")
    monkeypatch.setattr(_frames, "TASK_SECONDS", np.inf)  # tasks grow, whatever the machine
    alone = supple.check(*sources[name])
    assert len(alone.frames) == FRAMES and not alone.clean
    assert len({repr(each[1:]) for each in alone.frames}) > FRAMES / 4, "the frames must differ"
    assert [each.frame for each in alone.frames] == list(range(FRAMES))
    assert in_full(supple.check(*sources[name], client=executor)) == in_full(alone)


def test_options_of_check_reach_the_workers(sources, executor):
    for options in ({"parts": True}, {"self_collision": False}, {"weld": True, "parts": True}):
        alone = supple.check(*sources["files"], **options)
        assert in_full(supple.check(*sources["files"], **options, client=executor)) == in_full(alone)
    assert alone.frames != supple.check(*sources["files"], self_collision=False).frames


@pytest.mark.parametrize("name", ["files", "recording", "open recording", "array", "usd"])
def test_map_frames_is_the_same_as_in_one_process(name, sources, executor):
    if name not in sources:
        pytest.skip("usd-core is not installed")
    frames = sources[name][0]
    alone = supple.map_frames(measure, frames)
    assert len(alone) == FRAMES and len({repr(each) for each in alone}) == FRAMES
    assert supple.map_frames(measure, frames, executor) == alone
    if not hasattr(frames, "__fspath__") and not isinstance(frames, str):
        assert alone == [measure(each) for each in frames]


def test_a_sequence_of_real_frames(executor):
    files = str(DATA / "kick/*.obj")
    if not list((DATA / "kick").glob("*.obj")):
        pytest.skip(f"{files} are not there")
    alone = supple.check(files)
    assert any(each.self_contacts for each in alone.frames)
    assert in_full(supple.check(files, client=executor, chunk=2)) == in_full(alone)


def test_processes_do_the_work():
    with processes() as pool:
        assert os.getpid() not in supple.map_frames(process, range(20), pool)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        assert set(supple.map_frames(process, range(20), pool)) == {os.getpid()}
    assert supple.map_frames(process, range(2)) == [os.getpid()] * 2


def test_tasks_have_names_of_files_and_no_meshes(sources):
    for name in ("files", "recording", "usd"):
        if name in sources:
            frames = _animation.frames_to_check(*sources[name], None)
            assert len(pickle.dumps(frames.part(3, 5))) < 1000, name
    # Arrays: frame 0 and those of the part.
    positions, faces = sources["array"]
    part = _animation.frames_to_check(positions, faces).part(3, 5)
    assert len(pickle.dumps(part)) < 4 * positions[0].nbytes + faces.nbytes


class Watched(concurrent.futures.ThreadPoolExecutor):
    """Counts the tasks, and those in flight at once."""

    def __init__(self, workers):
        super().__init__(workers)
        self.tasks, self.in_flight, self.most, self.lock = 0, 0, 0, threading.Lock()

    def submit(self, *call):
        with self.lock:
            self.tasks += 1
            self.in_flight += 1
            self.most = max(self.most, self.in_flight)
        future = super().submit(*call)
        future.add_done_callback(self._done)
        return future

    def _done(self, _):
        with self.lock:
            self.in_flight -= 1


def test_few_tasks_are_in_flight_and_they_grow(monkeypatch):
    wanted = [square(i) for i in range(2000)]
    for seconds, chunk, tasks in ((np.inf, None, range(11, 100)), (-1, None, [2000]), (1, 7, [286])):
        monkeypatch.setattr(_frames, "TASK_SECONDS", seconds)
        with Watched(3) as pool:
            assert supple.map_frames(square, range(2000), pool, chunk=chunk) == wanted
        assert pool.tasks in tasks and 1 < pool.most <= 6


def test_order_does_not_depend_on_the_order_of_ends():
    """Frame 0 ends after frame 1."""
    ended = threading.Event()

    def work(number):
        if number == 0:
            assert ended.wait(60)
        if number == 1:
            ended.set()
        return number

    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        assert supple.map_frames(work, range(10), pool, chunk=1) == list(range(10))


@pytest.mark.parametrize("error", [ValueError, OSError, SystemExit, supple.Error, OwnError])
def test_an_error_of_the_function_names_the_frame_and_is_not_tried_again(error, executor, tmp_path):
    wanted = r"^frame 17: .*broken"
    with pytest.raises(supple.Error, match=wanted) as raised:
        supple.map_frames(Fails(tmp_path, 17, error), range(40), executor, chunk=4)
    assert (tmp_path / "notes").read_text() == "failed\n"
    cause = raised.value.__cause__
    if isinstance(executor, concurrent.futures.ThreadPoolExecutor) or error is not OwnError:
        assert error is OwnError or type(cause) is error
    if isinstance(executor, concurrent.futures.ProcessPoolExecutor):
        assert "in __call__" in str(cause if error is OwnError else cause.__cause__)
    with pytest.raises(supple.Error, match=wanted):
        supple.map_frames(Fails(tmp_path, 17, error), range(40))
    assert supple.map_frames(square, range(4), executor) == [0, 1, 4, 9], "the executor still works"


def test_errors_of_files_name_the_frame(sources, executor, tmp_path):
    positions, faces = sources["array"]
    for i in range(6):
        mesh = supple.make_box() if i == 4 else supple.Mesh(positions[i], faces)
        supple.save_mesh(mesh, tmp_path / f"f_{i}.obj")
    for client in (None, executor):
        with pytest.raises(supple.Error, match=r"frame 4 \(.*f_4.obj\): .*f_4.obj has other triangles"):
            supple.check(tmp_path / "f_*.obj", client=client)


def test_a_killed_process_is_replaced(tmp_path):
    with processes() as pool:
        found = supple.map_frames(Kills(tmp_path, 11, 1), range(60), pool, chunk=3)
        assert found == [square(i) for i in range(60)]
        assert (tmp_path / "notes").read_text() == "killed\n" * 2
        # The executor itself is broken; another call replaces it again.
        assert supple.map_frames(square, range(5), pool) == [0, 1, 4, 9, 16]


@pytest.mark.parametrize("retries", [0, 1, 2])
def test_a_frame_that_always_kills_is_named(retries, tmp_path):
    with processes() as pool, pytest.raises(supple.Error, match=f"died {retries + 1} times") as raised:
        supple.map_frames(Kills(tmp_path, 11, 9), range(60), pool, chunk=3, retries=retries)
    assert (tmp_path / "notes").read_text() == "killed\n" * (retries + 1)
    # The last of several tries is alone, so that the message names no other frame.
    assert ("frame 11: " if retries else "frame 9 and the 2 after it") in str(raised.value)


def test_an_executor_that_cannot_be_replaced(tmp_path):
    class Own(concurrent.futures.ProcessPoolExecutor):
        pass

    with Own(1, multiprocessing.get_context("spawn")) as pool:
        with pytest.raises(supple.Error, match="Own cannot be started again") as raised:
            supple.map_frames(Kills(tmp_path, 2, 1), range(9), pool, chunk=1)
    assert "frame 2" in str(raised.value)


def test_what_cannot_be_pickled(tmp_path):
    with processes(1) as pool:
        with pytest.raises(supple.Error, match="frame 0: a task cannot be sent.*defined in a module"):
            supple.map_frames(lambda number: number, range(3), pool)
        assert supple.map_frames(square, range(3), pool) == [0, 1, 4]


def test_wrong_arguments():
    for call, message in (
        (lambda: supple.map_frames(square, range(3), "pool"), "str is not an executor"),
        (lambda: supple.map_frames(square, {"a": 1}), "dict has no numbered frames"),
        (lambda: supple.map_frames(square, iter([1])), "has no numbered frames"),
        (lambda: supple.map_frames(square, range(3), retries=-1), "retries is -1"),
        (lambda: supple.map_frames(square, range(3), chunk=0), "chunk is 0"),
    ):
        with pytest.raises(supple.Error, match=message):
            call()
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        assert supple.map_frames(square, [], pool) == supple.map_frames(square, []) == []


def test_progress(executor):
    for pool in (None, executor):
        seen = []
        supple.map_frames(square, range(30), pool, progress=lambda *counts, seen=seen: seen.append(counts))
        assert seen[-1] == (30, 30) and seen == sorted(set(seen)) and len(seen) > 1
        assert supple.map_frames(square, range(3), pool, progress=True) == [0, 1, 4]


def test_ctrl_c_cancels_what_has_not_begun():
    calls, released = [], threading.Event()

    def work(number):
        calls.append(number)
        os.kill(os.getpid(), signal.SIGINT)
        assert released.wait(60)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            with pytest.raises(KeyboardInterrupt):
                supple.map_frames(work, range(1000), pool, chunk=5)
            released.set()
        assert calls == [0], "neither the rest of the task nor the next task runs"
    finally:
        released.set()
        signal.signal(signal.SIGINT, before)


def test_ctrl_c_ends_processes():
    program = """
import concurrent.futures, multiprocessing, os, supple
from frame_functions import Interrupts
if __name__ == "__main__":
    done = []
    try:
        with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as pool:
            supple.map_frames(Interrupts(os.getpid()), range(10**6), pool, chunk=1,
                              progress=lambda n, _: done.append(n))
    except KeyboardInterrupt:
        print("interrupted", max(done, default=0) < 10**6)
"""
    path = os.pathsep.join([os.path.dirname(frame_functions.__file__), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
        # A process in the background ignores Ctrl-C unless its handler is set.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    assert done.returncode == 0 and done.stdout == "interrupted True\n", done.stderr
    assert Interrupts


def test_a_stop_ends_the_call():
    for workers in (0, 1):
        calls, released, stop = [], threading.Event(), supple.Stop()

        def work(number, calls=calls, released=released, stop=stop, waits=bool(workers)):
            calls.append(number)
            if number == 3:
                stop.request()
                assert not waits or released.wait(60)

        if not workers:
            with pytest.raises(supple.Error, match="stopped after 4 of 1000 frames"):
                supple.map_frames(work, range(1000), stop=stop)
        else:
            with concurrent.futures.ThreadPoolExecutor(workers) as pool:
                with pytest.raises(supple.Error, match="stopped after [0-3] of 1000 frames"):
                    supple.map_frames(work, range(1000), pool, stop=stop)
                released.set()
        assert calls == [0, 1, 2, 3]
    for client in (None, concurrent.futures.ThreadPoolExecutor(1)):
        with pytest.raises(supple.Error, match="check: stopped after 0 of 2 frames"):
            supple.check([supple.make_box()] * 2, stop=stop, client=client)
        supple.check([supple.make_box()] * 2, stop=supple.Stop(), client=client)


@pytest.fixture
def dask(request):
    distributed = pytest.importorskip("distributed")
    import dask

    options = {
        "distributed.scheduler.allowed-failures": request.param,
        "distributed.comm.timeouts.connect": "5s",  # how long a dead worker is called
    }
    with dask.config.set(options):
        with distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster:
            with distributed.Client(cluster) as client:
                yield client


@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("dask", [0, 3], indirect=True, ids=["lost tasks", "tasks of the scheduler"])
def test_dask_with_a_killed_worker(dask, sources, tmp_path):
    """With `allowed-failures` 0, Dask gives up tasks of a dead worker, and `map_frames` repeats them; with 3,
    its default, the scheduler does."""
    before = set(dask.nthreads())
    found = supple.map_frames(Kills(tmp_path, 7, 1), range(40), dask, chunk=2)
    assert found == [square(i) for i in range(40)]
    assert (tmp_path / "notes").read_text() == "killed\n" * 2, "a worker was killed, and the frame ran again"
    dask.wait_for_workers(2)
    assert set(dask.nthreads()) != before, "another worker is there"
    workers = set(supple.map_frames(process, range(40), dask.get_executor(), chunk=1))
    assert workers and os.getpid() not in workers
    for name in ("files", "recording"):
        assert in_full(supple.check(*sources[name], client=dask)) == in_full(supple.check(*sources[name]))
    with pytest.raises(supple.Error, match="frame 17: .*broken"):
        supple.map_frames(Fails(tmp_path, 17, ValueError), range(40), dask)


@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("dask", [0], indirect=True)
def test_dask_names_the_frame_that_always_kills(dask, tmp_path):
    with pytest.raises(supple.Error, match="frame 7: the worker died 2 times.*KilledWorker"):
        supple.map_frames(Kills(tmp_path, 7, 9), range(40), dask, chunk=2, retries=1)
    assert (tmp_path / "notes").read_text() == "killed\n" * 2


MPI = """
import sys
from mpi4py import MPI
from mpi4py.futures import MPIPoolExecutor
import supple
from frame_functions import Fails, process, square

if __name__ == "__main__":
    with MPIPoolExecutor() as pool:
        assert supple.map_frames(square, range(100), pool) == [square(i) for i in range(100)]
        workers = set(supple.map_frames(process, range(100), pool, chunk=1))
        report = supple.check(sys.argv[1], client=pool)
        alone = supple.check(sys.argv[1])
        assert repr(report.frames) == repr(alone.frames) and report.notes == alone.notes
        try:
            supple.map_frames(Fails(sys.argv[2], 17, ValueError), range(40), pool)
        except supple.Error as error:
            assert str(error) == "frame 17: ValueError: broken"
            print(MPI.COMM_WORLD.size, pool.num_workers, len(workers) > 0, len(report.frames))
"""


def test_mpi(sources, tmp_path):
    pytest.importorskip("mpi4py")
    if not shutil.which("mpirun"):
        pytest.skip("mpirun is not installed")
    (tmp_path / "frames.py").write_text(MPI)
    path = os.pathsep.join([os.path.dirname(frame_functions.__file__), os.environ.get("PYTHONPATH", "")])
    options = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "PYTHONPATH": path}
    done = subprocess.run(
        ["mpirun", "--oversubscribe", "-n", "3", sys.executable, "-m", "mpi4py.futures", "frames.py"]
        + [*sources["files"], str(tmp_path)],
        env={**os.environ, **options},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0 and done.stdout == f"3 2 True {FRAMES}\n", done.stdout + done.stderr


def test_experiments(program, tmp_path):
    options = {"quick": True, "objects": 3, "runs": 1, "seconds": 1}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        found = supple.experiments("table1", [{"seed": 1}, {"seed": 2}], pool, tmp_path / "sweep", **options)
        with pytest.raises(supple.Error, match="parameter set 0: .*--seed"):
            supple.experiments("table1", [{"seed": -1}], pool)
    assert [each.folder for each in found] == [tmp_path / "sweep/0", tmp_path / "sweep/1"]
    alone = supple.experiment("table1", seed=2, **options).tables["table1_runs"]
    runs = [each.tables["table1_runs"] for each in found]
    assert list(runs[1]["seed"]) == [2, 2] and list(runs[0]["mean_strain"]) != list(alone["mean_strain"])
    for name, column in alone.items():
        if not name.endswith("_seconds"):  # measured times
            np.testing.assert_array_equal(runs[1][name], column)
