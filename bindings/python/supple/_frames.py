"""Frames on many threads, processes and machines."""

from __future__ import annotations

import collections
import concurrent.futures
import contextlib
import dataclasses
import math
import os
import pickle
import time
import traceback
from typing import Any, Callable, Iterator, Protocol, TypeVar, Union

from ._animation import Frames, frames_to_map
from ._core import Error, Stop

R = TypeVar("R")
Work = Callable[[Frames], Iterator[R]]


class Client(Protocol):
    """A client of a cluster, such as dask.distributed.Client."""

    def get_executor(self, **options: Any) -> concurrent.futures.Executor:
        """An executor that runs on the cluster."""


AnyExecutor = Union[concurrent.futures.Executor, Client]
Progress = Union[bool, Callable[[int, int], object]]

#: Tasks grow until one takes this long.
TASK_SECONDS = 1.0
#: Tasks in flight for each worker: one that runs and one that waits.
TASKS_PER_WORKER = 2
#: The time from one question to a cluster for its workers to the next.
ASK_SECONDS = 1.0
#: The time in which a request of a `Stop` is seen.
STOP_SECONDS = 0.05


def map_frames(
    function: Callable[[Any], R],
    frames: Any,
    executor: AnyExecutor | None = None,
    *,
    progress: Progress = False,
    stop: Stop | None = None,
    retries: int = 2,
    chunk: int | None = None,
) -> list[R]:
    """Calls a function with each frame, on the threads, processes or machines of an executor, and returns the
    results in the order of the frames: the same as `[function(frame) for frame in frames]`.

    `frames` is
    - a recording or its path (.h5): the function gets a `Frame`,
    - a pattern of mesh files: it gets a `Mesh` of each, in the order of the numbers in their names,
    - the path of a USD file: it gets a dict of a `Mesh` by name for each time code,
    - a list, a range, an array (frames, n, 3), or another sequence: it gets the items.

    `executor` is any `concurrent.futures.Executor`, for instance a ThreadPoolExecutor, a ProcessPoolExecutor,
    a mpi4py.futures.MPIPoolExecutor, or a dask.distributed.Client; None calls the function here. Processes
    open files themselves, by their absolute path, so all machines need the same folders. Items of sequences,
    the function and its results are pickled: define the function in a module. Give scenes in the function
    `threads=1`, because the workers share the cores.

    `progress` is True for a bar, which needs tqdm, or a function that gets the numbers of finished and of all
    frames. Ctrl-C, and `stop` within 0.05 s, cancel the frames that have not begun and do not wait for those
    that run; after `stop`, the call raises `Error`.

    Frames whose worker dies, for instance because it has no memory left, run again at most `retries` times, 0
    or more, the last time alone. A broken ProcessPoolExecutor is replaced for this purpose by one of the same
    size; the executor itself stays broken. After that, `Error` names the frame. What the function raises is
    not tried again: it ends the call, and is the cause (`__cause__`) of an `Error` that names the frame.

    A task has several frames, as many as take a second together; `chunk` is another number of frames, 1 or
    more. Each worker has at most two tasks, so memory does not grow with the number of frames, but all
    results are kept: a function with large results writes them to files. A task costs 0.1 to 6 ms in addition
    to its frames (docs/distributed.md).
    """
    return run(
        "map_frames",
        _Each(function),
        frames_to_map(frames),
        executor,
        progress=progress,
        stop=stop,
        retries=retries,
        chunk=chunk,
    )


@dataclasses.dataclass(frozen=True)
class _Each:
    """Calls a function with each frame."""

    function: Callable[[Any], Any]

    def __call__(self, frames: Frames) -> Iterator[Any]:
        return map(self.function, frames)


class _WorkerTraceback(Exception):
    """The traceback in the worker, as a text."""

    def __str__(self) -> str:
        return str(self.args[0])


@dataclasses.dataclass(frozen=True)
class _Outcome:
    """What a task sends back: the results of its frames up to the first that failed."""

    results: list[Any]
    seconds: float
    failure: str = ""
    traceback: str = ""
    error: BaseException | None = None


class _Ended:
    """Tells tasks in threads of this process that nobody waits for them any more; a copy in another process
    stays as it is."""

    def __init__(self) -> None:
        self.ended = False

    def __reduce__(self) -> Any:
        return _Ended, ()


def _run_task(work: Work[Any], frames: Frames, ended: _Ended) -> _Outcome:
    begin = time.perf_counter()
    results: list[Any] = []
    try:
        for result in work(frames):
            results.append(result)
            if ended.ended:
                break
    except (Exception, SystemExit) as error:
        sent: BaseException | None = error
        try:  # not every error survives
            pickle.loads(pickle.dumps(error))
        except Exception:  # noqa: BLE001
            sent = None
        return _Outcome(results, 0, _summary(error), traceback.format_exc(), sent)
    return _Outcome(results, time.perf_counter() - begin)


def _summary(error: BaseException) -> str:
    text = str(error)
    if isinstance(error, Error):
        return text
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


@dataclasses.dataclass(frozen=True)
class _Task:
    """Frames from `start` to before `stop`, and how often a worker died with them."""

    start: int
    stop: int
    failures: int = 0


class _Pool:
    """An executor, which is replaced when its processes died, as far as that is possible."""

    def __init__(self, executor: AnyExecutor) -> None:
        if not isinstance(executor, concurrent.futures.Executor) and not hasattr(executor, "get_executor"):
            raise Error(
                f"{type(executor).__name__} is not an executor; give a concurrent.futures.Executor or a "
                "dask.distributed.Client"
            )
        self._is_own = not isinstance(executor, concurrent.futures.Executor)
        self._executor: Any = executor.get_executor() if self._is_own else executor  # type: ignore[union-attr]
        client = getattr(self._executor, "_client", None)
        self._client = client if hasattr(client, "nthreads") else None
        self._workers, self._asked = 0, -math.inf
        # Dask would take equal calls for one, and their failures, too.
        self._options = {} if self._client is None else {"pure": False}

    def workers(self) -> int:
        """How many tasks run at once; a cluster can grow and shrink."""
        if self._client is not None:
            if time.monotonic() - self._asked > ASK_SECONDS:
                self._workers, self._asked = sum(self._client.nthreads().values()), time.monotonic()
            return max(1, self._workers)
        return int(getattr(self._executor, "_max_workers", None) or os.cpu_count() or 1)

    def submit(self, *call: Any) -> concurrent.futures.Future[_Outcome]:
        made: concurrent.futures.Future[_Outcome] = self._executor.submit(*call, **self._options)
        return made

    def replace(self) -> bool:
        if type(self._executor) is not concurrent.futures.ProcessPoolExecutor:
            return False
        self.close()
        old: Any = self._executor
        options = {"max_tasks_per_child": getattr(old, "_max_tasks_per_child", None)}
        self._executor = concurrent.futures.ProcessPoolExecutor(
            old._max_workers,
            old._mp_context,
            old._initializer,
            old._initargs,
            **{name: value for name, value in options.items() if value is not None},
        )
        self._is_own = True
        return True

    def close(self) -> None:
        if self._is_own:
            self._executor.shutdown(wait=False)

    def __str__(self) -> str:
        return type(self._executor).__name__


def _worker_died(error: BaseException) -> bool:
    """Whether an error of a future is one of its worker or of the connection to it."""
    return isinstance(
        error, (concurrent.futures.BrokenExecutor, concurrent.futures.CancelledError, OSError)
    ) or (type(error).__module__.startswith("distributed."))


class _Run:
    """One call of `run` on an executor."""

    def __init__(self, caller: str, work: Work[Any], frames: Frames, pool: _Pool, retries: int) -> None:
        self.caller, self.work, self.frames, self.pool, self.retries = caller, work, frames, pool, retries
        self.total = len(frames)
        self.results: list[Any] = [None] * self.total
        self.done = 0
        self.next = 0  # the first frame that was in no task yet
        self.again: collections.deque[_Task] = collections.deque()
        self.pending: dict[concurrent.futures.Future[_Outcome], _Task] = {}
        self.ended = _Ended()

    def is_last_try(self, task: _Task) -> bool:
        return 0 < task.failures == self.retries

    def submit_next(self, size: int) -> bool:
        """Submits the next task unless it has to run alone."""
        if any(self.is_last_try(task) for task in self.pending.values()):
            return False
        if self.again:
            task = self.again.popleft()
            if self.is_last_try(task):
                if self.pending:
                    self.again.appendleft(task)
                    return False
                if task.stop > task.start + 1:
                    self.again.appendleft(dataclasses.replace(task, start=task.start + 1))
                    task = dataclasses.replace(task, stop=task.start + 1)
        elif self.next < self.total:
            task = _Task(self.next, min(self.next + size, self.total))
            self.next = task.stop
        else:
            return False
        try:
            future = self.pool.submit(
                _run_task, self.work, self.frames.part(task.start, task.stop), self.ended
            )
        except concurrent.futures.BrokenExecutor as error:
            self.again.appendleft(task)
            self.recover({}, error)
            return True
        except (pickle.PicklingError, TypeError, AttributeError) as error:
            raise self.not_sent(task, error) from error
        self.pending[future] = task
        return True

    def not_sent(self, task: _Task, error: BaseException) -> Error:
        return Error(
            f"{self.caller}: {self.labels([task])}: a task cannot be sent to a worker or back "
            f"({_summary(error)}); the function must be defined in a module, and it, its frames and its results "
            "must be picklable"
        )

    def recover(self, died: dict[_Task, BaseException], error: BaseException) -> None:
        """Puts the frames of dead workers back."""
        if isinstance(error, concurrent.futures.BrokenExecutor):
            # A broken executor loses all of its tasks; some may have ended before.
            concurrent.futures.wait(self.pending)
            for future, task in list(self.pending.items()):
                failed = future.exception() if not future.cancelled() else error
                if failed is not None:
                    died[task] = failed
                    del self.pending[future]
        hopeless = [task for task in died if task.failures >= self.retries]
        if hopeless:
            raise Error(
                f"{self.caller}: {self.labels(hopeless)}: the worker died {self.retries + 1} times "
                f"({_summary(error)}); often it has no memory left: use fewer workers, or call {self.caller} "
                "with these frames alone and without an executor"
            ) from error
        if isinstance(error, concurrent.futures.BrokenExecutor) and not self.pool.replace():
            raise Error(
                f"{self.caller}: {self.labels(list(died))}: a worker died ({_summary(error)}), and {self.pool} "
                "cannot be started again from here; make a new one and call again"
            ) from error
        self.again.extend(
            sorted(
                (dataclasses.replace(task, failures=task.failures + 1) for task in died),
                key=lambda task: (task.failures == self.retries, task.start),
            )
        )

    def labels(self, tasks: list[_Task]) -> str:
        named = [self.frames.label(each.start) for each in tasks[:3]]
        for i, each in enumerate(tasks[:3]):
            if each.stop > each.start + 1:
                named[i] += f" and the {each.stop - each.start - 1} after it"
        return ", ".join(named) + (f", and {len(tasks) - 3} more tasks" if len(tasks) > 3 else "")

    def collect(self, finished: set[concurrent.futures.Future[_Outcome]]) -> tuple[int, float]:
        """Keeps the results of futures; returns the size and the seconds of the largest task."""
        died: dict[_Task, BaseException] = {}
        largest = (0, 0.0)
        for future in sorted(finished, key=lambda each: self.pending[each].start):
            task = self.pending.pop(future)
            try:
                outcome = future.result()
            except (Exception, concurrent.futures.CancelledError) as error:
                if not _worker_died(error):
                    raise self.not_sent(task, error) from error
                died[task] = error
                continue
            if outcome.failure:
                raise_failure(self.frames.label(task.start + len(outcome.results)), outcome)
            self.results[task.start : task.stop] = outcome.results
            self.done += task.stop - task.start
            largest = max(largest, (task.stop - task.start, outcome.seconds))
        if died:
            self.recover(died, next(iter(died.values())))
        return largest


def raise_failure(label: str, outcome: _Outcome) -> None:
    cause = outcome.error or _WorkerTraceback(outcome.traceback)
    if cause.__traceback__ is None and outcome.error:  # it comes from another process
        cause.__cause__ = _WorkerTraceback(outcome.traceback)
    raise Error(f"{label}: {outcome.failure}") from cause


def run(
    caller: str,
    work: Work[R],
    frames: Frames,
    executor: AnyExecutor | None,
    *,
    progress: Progress = False,
    stop: Stop | None = None,
    retries: int = 2,
    chunk: int | None = None,
) -> list[R]:
    """The results of `work` for all frames; see `map_frames`."""
    if retries < 0 or (chunk is not None and chunk < 1):
        raise Error(
            f"{caller}: retries is {retries} and chunk is {chunk}; they must be at least 0 and at least 1"
        )
    with _reporter(progress, len(frames)) as report:
        if executor is None:
            return _run_here(caller, work, frames, report, stop)
        return _run_on(_Run(caller, work, frames, _Pool(executor), retries), chunk, report, stop)


def _run_here(
    caller: str, work: Work[R], frames: Frames, report: Callable[[int], object], stop: Stop | None
) -> list[R]:
    results: list[R] = []
    found: Iterator[R] | None = None
    while len(results) < len(frames):
        _check_stop(caller, stop, len(results), len(frames))
        try:
            found = found or iter(work(frames))
            results.append(next(found))
        except (Exception, SystemExit) as error:
            raise Error(f"{frames.label(len(results))}: {_summary(error)}") from error
        report(len(results))
    return results


def _run_on(state: _Run, chunk: int | None, report: Callable[[int], object], stop: Stop | None) -> list[Any]:
    size = chunk or 1
    try:
        while state.done < state.total:
            _check_stop(state.caller, stop, state.done, state.total)
            workers = state.pool.workers()
            even = -(
                -(state.total - state.next) // (TASKS_PER_WORKER * workers)
            )  # the last tasks end together
            while len(state.pending) < TASKS_PER_WORKER * workers:
                if not state.submit_next(chunk or max(1, min(size, even))):
                    break
            finished, _ = concurrent.futures.wait(
                state.pending,
                None if stop is None else STOP_SECONDS,
                concurrent.futures.FIRST_COMPLETED,
            )
            frames, seconds = state.collect(finished)
            if frames >= size:
                size = (
                    size * 2
                    if seconds < TASK_SECONDS
                    else size
                    if seconds < 4 * TASK_SECONDS
                    else -(-size // 2)
                )
            if frames:
                report(state.done)
    finally:
        state.ended.ended = True
        for future in state.pending:
            future.cancel()
        state.pool.close()
    return state.results


def _check_stop(caller: str, stop: Stop | None, done: int, total: int) -> None:
    if stop is not None and stop.requested:
        raise Error(f"{caller}: stopped after {done} of {total} frames, so there is no answer")


@contextlib.contextmanager
def _reporter(progress: Progress, total: int) -> Iterator[Callable[[int], object]]:
    """A function that gets the number of finished frames."""
    if callable(progress):
        function = progress
        yield lambda done: function(done, total)
    elif progress:
        from tqdm.auto import tqdm

        with tqdm(total=total, unit="frame") as bar:
            yield lambda done: bar.update(done - bar.n)
    else:
        yield lambda done: None


__all__ = ["map_frames"]
