#!/usr/bin/env python3
"""What a task of `supple.map_frames` costs on threads, on processes and on Dask, without its frames.

usage: frames.py [--workers N] [--tasks N] [--rounds N]

Each task is one call of an empty function; no task has more than one frame. Prints JSON: tasks per second and
milliseconds per task of each executor, medians of five rounds that take all executors in turn, those of Dask's
scheduler alone (`Client.submit` of all tasks at once), and how much longer a task of Dask takes than one of the
process pool. Run it with PYTHONPATH=build/release/python. Needs dask[distributed].
"""

import argparse
import concurrent.futures
import importlib.metadata
import json
import multiprocessing
import os
import statistics
import time

import supple
from contest import processor


def nothing(frame):
    return None


def seconds(work):
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--tasks", type=int, default=500)
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    from dask.distributed import Client, LocalCluster

    spawn = multiprocessing.get_context("spawn")
    with (
        concurrent.futures.ThreadPoolExecutor(arguments.workers) as threads,
        concurrent.futures.ProcessPoolExecutor(arguments.workers, spawn) as processes,
        LocalCluster(n_workers=arguments.workers, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        frames = range(arguments.tasks)
        contestants = {
            "threads": lambda: supple.map_frames(nothing, frames, threads, chunk=1),
            "processes": lambda: supple.map_frames(nothing, frames, processes, chunk=1),
            "dask": lambda: supple.map_frames(nothing, frames, client, chunk=1),
            "dask scheduler": lambda: client.gather([client.submit(nothing, i, pure=False) for i in frames]),
        }
        times = {name: [] for name in contestants}
        for turn in range(arguments.rounds + 1):
            for name, work in contestants.items():
                found = seconds(work)
                if turn:  # the first round starts the workers
                    times[name].append(found)
    each = {name: statistics.median(found) / arguments.tasks for name, found in times.items()}
    result = {
        "processor": processor(),
        "load": os.getloadavg()[0],
        "dask": importlib.metadata.version("distributed"),
        "workers": arguments.workers,
        "tasks": arguments.tasks,
        "tasks_per_second": {name: round(1 / value) for name, value in each.items()},
        "milliseconds_per_task": {name: round(1e3 * value, 3) for name, value in each.items()},
        "milliseconds_of_dask_above_processes": round(1e3 * (each["dask"] - each["processes"]), 3),
    }
    print(json.dumps(result, indent=2))


if __name__ == "__main__":
    main()
