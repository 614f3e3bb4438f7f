#!/usr/bin/env python3
"""Checks the frames of an animation on one machine or on a cluster, and writes a row for each frame.

usage: check_frames.py ANIMATION FRAMES.csv [--processes N | --scheduler-file FILE | --mpi] [--self-collision]

ANIMATION is what `supple.check` reads: a recording (.h5), a USD file, or a quoted pattern of mesh files.
Without an option, the frames run in this process. --processes uses processes of this machine,
--scheduler-file the workers of a Dask cluster (check.sbatch starts one), and --mpi the ranks of
`mpirun -n 9 python -m mpi4py.futures check_frames.py ... --mpi`. The rows are the same for all.
Ends with status 1 when a frame has contacts.
"""

import argparse
import concurrent.futures
import contextlib
import csv
import multiprocessing
import sys

import supple


@contextlib.contextmanager
def executor(arguments):
    """The executor that the options choose; None is this process."""
    if arguments.scheduler_file:
        from dask.distributed import Client

        with Client(scheduler_file=arguments.scheduler_file) as client:
            client.wait_for_workers(1)
            yield client
    elif arguments.mpi:
        from mpi4py.futures import MPIPoolExecutor

        with MPIPoolExecutor() as pool:
            yield pool
    elif arguments.processes:
        spawn = multiprocessing.get_context("spawn")
        with concurrent.futures.ProcessPoolExecutor(arguments.processes, spawn) as pool:
            yield pool
    else:
        yield None


def show(done, total):
    """A line for each tenth of the frames, for the log of a job."""
    tenth = max(1, total // 10)
    if done == total or done // tenth > show.shown // tenth:
        show.shown = done
        print(f"{done} of {total} frames", file=sys.stderr, flush=True)


show.shown = 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("animation")
    parser.add_argument("frames", help="the CSV file that is written")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--processes", type=int, metavar="N")
    where.add_argument("--scheduler-file", metavar="FILE")
    where.add_argument("--mpi", action="store_true")
    parser.add_argument("--self-collision", action=argparse.BooleanOptionalAction, default=True)
    arguments = parser.parse_args()

    with executor(arguments) as client:
        report = supple.check(
            arguments.animation, self_collision=arguments.self_collision, client=client, progress=show
        )
    with open(arguments.frames, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(supple.FrameCheck._fields)
        writer.writerows(report.frames)
    print(report)
    return 0 if report.clean else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except supple.Error as error:
        sys.exit(f"check_frames: {error}")
