"""Runs the program while the system fails under it, and checks that no fault goes unnoticed or does harm.

After each run:
- the exit status is a documented one, never a signal except the one that the fault sends;
- a failure is one line on standard error that starts with the name of the program;
- with status 0, all outputs are those of a run without faults;
- a recording opens with whole frames, once its first frame was written;
- inputs are the same bytes as before.

usage: faults_test.py [--runs N | --all] [--only WORD] [--table FILE] [GROUP...]

The groups are streams, writes, memory, limits and clocks; default: all.

--runs is the number of runs for each fault and command (default 5; SUPPLE_FAULTS=many: 200, all: all). --table writes the
outcomes to a file. The module of faults is SUPPLE_FAULTS_MODULE. Needs Linux.
"""

import argparse
import collections
import concurrent.futures
import hashlib
import itertools
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile

from commands import COMMANDS, FRAMES, PROGRAM, contents, frames_of, write_inputs

MODULE = os.environ.get("SUPPLE_FAULTS_MODULE", "")
DOCUMENTED = {0, 1, 2, 3}
SKIPPED = 77
USERS = itertools.count(60000)
IS_ROOT = os.geteuid() == 0


def limit(which, value):
    return lambda: resource.setrlimit(which, (value, value))


def limit_processes(value):
    """The limit does not hold for root, and counts all processes of a user, so each run has another user."""
    user = next(USERS)

    def prepare():
        if IS_ROOT:
            os.setgid(user)
            os.setuid(user)
        resource.setrlimit(resource.RLIMIT_NPROC, (value, value))

    return prepare


def close_streams(mask):
    def prepare():
        for stream in range(3):
            if mask >> stream & 1:
                os.close(stream)

    return prepare


class Fault:
    """A fault with a parameter: `variables` and `prepare` take it, `values` lists all its values."""

    def __init__(self, name, values, variables=None, prepare=None, kills=False, threads="1", wrap=None, probes=False):
        self.name, self.values, self.kills, self.threads, self.wrap, self.probes = name, values, kills, threads, wrap, probes
        self.variables = variables or (lambda n: {})
        self.prepare = prepare or (lambda n: None)

    def environment(self, n):
        chosen = self.variables(n)
        return {**os.environ, **({"LD_PRELOAD": MODULE, **chosen} if chosen else {})}


def preloaded(variable):
    return lambda n: {variable: str(n)}


def read_only(line):
    """The command in a folder that nobody can write to."""
    if not IS_ROOT:
        return ["sh", "-c", 'chmod 555 . && "$@"; status=$?; chmod 755 .; exit $status', "sh", *line]
    mounts = 'mount --bind "$PWD" "$PWD" && mount -o remount,bind,ro "$PWD" && cd "$PWD" && exec "$@"'
    return ["unshare", "-m", "sh", "-c", mounts, "sh", *line]


MEGABYTE = 1 << 20
# HDF5 1.10 crashes or exits when it gets no memory.
HDF5_CRASHED = 90
HDF5_CRASHES = {"FAULT_HDF5_CRASH": str(HDF5_CRASHED)}
STREAMS = [
    Fault("closed streams", lambda c: range(8), prepare=close_streams),
    Fault("read-only folder", lambda c: [0], wrap=read_only),
]
WRITES = [
    Fault("disk of N bytes", lambda c: range(c.bytes + 1), preloaded("FAULT_DISK_BYTES")),
    Fault("EIO from write N", lambda c: range(1, c.writes + 1), preloaded("FAULT_ERROR_AT_WRITE")),
    Fault("killed at write N", lambda c: range(1, c.writes + 1), preloaded("FAULT_KILL_AT_WRITE"), kills=True),
    Fault("killed in write N", lambda c: range(1, c.writes + 1), preloaded("FAULT_TEAR_AT_WRITE"), kills=True),
    Fault("ulimit -f", lambda c: range(c.bytes + 1), prepare=lambda n: limit(resource.RLIMIT_FSIZE, n)),
]
MEMORY = [
    Fault("allocation N fails", lambda c: range(1, c.allocations + 1), preloaded("FAULT_ALLOCATION")),
    Fault("allocations from N fail", lambda c: range(1, c.allocations + 1), preloaded("FAULT_ALLOCATIONS_FROM")),
    Fault("... and HDF5 gets none", lambda c: range(1, c.allocations + 1), lambda n: {"FAULT_ALLOCATIONS_FROM": str(n), "FAULT_HDF5": "1", **HDF5_CRASHES}),
    Fault("ulimit -v", lambda c: range(8, 400, 2), lambda n: HDF5_CRASHES, lambda n: limit(resource.RLIMIT_AS, n * MEGABYTE), probes=True),
    Fault("ulimit -v, 8 threads", lambda c: range(8, 2600, 8), lambda n: HDF5_CRASHES, lambda n: limit(resource.RLIMIT_AS, n * MEGABYTE), threads="8", probes=True),
]
LIMITS = [
    Fault("ulimit -n", lambda c: range(3, 13), prepare=lambda n: limit(resource.RLIMIT_NOFILE, n), probes=True),
    Fault("ulimit -u", lambda c: [1, 2, 3], prepare=limit_processes),
    Fault("ulimit -u, 8 threads", lambda c: range(1, 20), prepare=limit_processes, threads="8"),
]
CLOCKS = [
    Fault("clock forward", lambda c: [0], lambda n: {"FAULT_CLOCK": "forward"}),
    Fault("clock backward", lambda c: [0], lambda n: {"FAULT_CLOCK": "backward"}),
    Fault("clock jumps", lambda c: [0], lambda n: {"FAULT_CLOCK": "jump"}),
    Fault("clock stopped", lambda c: [0], lambda n: {"FAULT_CLOCK": "stop"}),
]
GROUPS = {"streams": STREAMS, "writes": WRITES, "memory": MEMORY, "limits": LIMITS, "clocks": CLOCKS}


class Reference:
    """A command without faults: its outputs, and how often it writes and allocates."""

    def __init__(self, command, inputs):
        self.command = command
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name) / "run"
            shutil.copytree(inputs, folder)
            counts = pathlib.Path(name) / "counts"
            with open(folder / "stdout.txt", "wb") as out:
                variables = {"LD_PRELOAD": MODULE, "FAULT_COUNTS": str(counts)}
                done = subprocess.run(command.line(), cwd=folder, env={**os.environ, **variables}, stdout=out, stderr=subprocess.PIPE)
            if done.returncode == SKIPPED:
                raise OSError("the kernel allows no seccomp filter")
            self.status, self.contents = done.returncode, contents(command, folder)
            assert self.status in (0, 1) and not done.stderr, (command.name, done)
            self.writes, self.allocations = map(int, counts.read_text().split())
            self.bytes = sum((folder / output).stat().st_size for output in (*command.outputs, "stdout.txt"))


def digest_of(folder, names):
    return {name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in names}


class Run:
    """One run with a fault. `problems` says what is wrong with its outcome."""

    def __init__(self, reference, fault, n, inputs):
        self.reference, self.command, self.fault, self.n = reference, reference.command, fault, n
        self.problems = []
        with tempfile.TemporaryDirectory() as name:
            self.folder = pathlib.Path(name) / "run"
            shutil.copytree(inputs, self.folder)
            os.chmod(name, 0o755)
            os.chmod(self.folder, 0o777)
            names = sorted(path.name for path in inputs.iterdir())
            before = digest_of(self.folder, names)
            self.run()
            if digest_of(self.folder, names) != before:
                self.problems.append("an input has changed")
            self.frames = None
            if self.starts:
                self.check()

    def start(self, line):
        return subprocess.Popen(
            line, cwd=self.folder, env=self.fault.environment(self.n), stdin=subprocess.DEVNULL,
            stdout=open(self.folder / "stdout.txt", "wb"), stderr=subprocess.PIPE, preexec_fn=self.fault.prepare(self.n),
        )

    def run(self):
        # With tight limits, no program starts.
        self.starts = not self.fault.probes or self.finish(self.start([PROGRAM, "--version"]))[0] == 0
        line = self.command.line(self.fault.threads)
        if self.starts:
            self.status, self.error = self.finish(self.start(self.fault.wrap(line) if self.fault.wrap else line))

    def finish(self, process):
        try:
            error = process.communicate(timeout=600)[1]
        except subprocess.TimeoutExpired:
            process.kill()
            error = process.communicate()[1] + b"it hangs"
        return process.returncode, error.decode(errors="replace")

    def check(self):
        if "out.h5" in self.command.outputs and (self.folder / "out.h5").exists():
            self.frames = frames_of(self.folder / "out.h5")
        if self.fault.kills and self.status == -signal.SIGKILL:
            return
        if self.status == HDF5_CRASHED:
            return
        if self.status not in DOCUMENTED:
            self.problems.append(f"its status is {self.status}")
        elif self.status == self.reference.status:
            self.check_success()
        else:
            self.check_failure()

    def check_success(self):
        if self.messages():
            self.problems.append("it succeeds with a message")
        warnings = self.error.count("supple: warning: the system has too few processes")
        if self.fault.name == "ulimit -u, 8 threads" and self.n <= 8 and warnings != self.command.has_threads:
            self.problems.append(f"it warns {warnings} times of missing threads")
        expected = dict(self.reference.contents)
        if self.fault.name == "closed streams" and self.n & 2:
            expected["stdout.txt"] = []
        try:
            found = contents(self.command, self.folder)
        except ValueError as problem:
            self.problems.append(f"an output is damaged: {problem}")
            return
        text = (self.folder / "stdout.txt").read_text()
        prints_times = self.fault.name.startswith("clock") and self.command.name != "info"
        if prints_times and re.search(r"\b(nan|inf)\b|(?<!\S)-\d", text):
            self.problems.append(f"a time is negative or no number:\n{text}")
        for name in expected.keys() | found.keys():
            if expected.get(name) != found.get(name):
                self.problems.append(f"it succeeds with another {name}")

    def check_failure(self):
        if self.fault.name == "closed streams" and self.n & 4:
            return
        lines = self.messages()
        if len(lines) != 1 or not lines[0].startswith("supple") or not self.error.endswith("\n"):
            self.problems.append("its message is not one line that starts with supple")

    def messages(self):
        """The lines on standard error, without the warnings."""
        return [line for line in self.error.splitlines() if not line.startswith("supple: warning: ")]

    def outcome(self):
        if not self.starts:
            return "not started"
        if self.status == HDF5_CRASHED:
            return "HDF5 crashed"
        return signal.Signals(-self.status).name if self.status < 0 else str(self.status)

    def report(self):
        text = "".join(f"\n    {line}" for line in self.error.splitlines()[:5]) if self.starts else ""
        return f"{self.fault.name}, N = {self.n}: {self.command.name}: {'; '.join(self.problems)}{text}"


def check_recordings(runs):
    """Recordings must open from the first one that does on: files are never broken again, and frames stay."""
    opened = 0
    for run in sorted(runs, key=lambda run: run.n):
        if run.starts and run.status < 0 and run.fault.kills and "out.h5" in run.command.outputs:
            if run.frames is None and opened:
                run.problems.append(f"its recording does not open, though one write less leaves {opened - 1} frames")
            if run.frames is not None:
                if run.frames + 1 < opened or run.frames > FRAMES:
                    run.problems.append(f"its recording has {run.frames} frames")
                opened = run.frames + 1


def spread(values, count):
    """At most `count` of the values, the first and the last among them."""
    values = list(values)
    if count is None or len(values) <= count:
        return values
    return sorted({values[round(i * (len(values) - 1) / (count - 1))] for i in range(count)})


def write_table(rows, path):
    names = [command.name for command in COMMANDS]
    lines = ["# Faults", "",
             "`tests/faults/faults_test.py --table` writes this page. Each cell has the exit statuses of the runs",
             "with this fault, and how many runs had each of them. N goes through its values, evenly spread.", "",
             "| Fault | " + " | ".join(names) + " |", "|---" * (len(names) + 1) + "|"]
    for fault, cells in rows.items():
        texts = [", ".join(f"{outcome}: {count}" for outcome, count in sorted(cells[name].items())) for name in names]
        lines.append(f"| {fault} | " + " | ".join(texts) + " |")
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("groups", nargs="*", metavar="GROUP", choices=[[], *GROUPS])
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--all", action="store_true", default=os.environ.get("SUPPLE_FAULTS") == "all")
    parser.add_argument("--only", default="", help="only faults and commands whose names contain this word")
    parser.add_argument("--table", type=pathlib.Path)
    options = parser.parse_args()
    if os.environ.get("SUPPLE_FAULTS") == "many":
        options.runs = max(options.runs, 200)
    if not MODULE:
        print("skipped: SUPPLE_FAULTS_MODULE is not set")
        return SKIPPED
    faults = [fault for group in options.groups or GROUPS for fault in GROUPS[group]]
    if IS_ROOT and subprocess.run(["unshare", "-m", "true"], capture_output=True).returncode != 0:
        print("skipped: read-only folders, because root cannot mount here")
        faults = [fault for fault in faults if fault.wrap is not read_only]
    commands = COMMANDS
    if b"without the viewer" in subprocess.run([PROGRAM, "view", "a.obj"], capture_output=True).stderr:
        print("skipped: view, because this program was built without the viewer")
        commands = [command for command in COMMANDS if command.name != "view"]
    base = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    tempfile.tempdir = base
    rows, problems, total = {fault.name: {} for fault in faults}, [], 0
    with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        inputs = pathlib.Path(name) / "inputs"
        inputs.mkdir()
        write_inputs(inputs)
        try:
            references = [Reference(command, inputs) for command in commands]
        except OSError as problem:
            print(f"skipped: {problem}")
            return SKIPPED
        for fault in faults:
            for reference in references:
                if options.only not in f"{fault.name} {reference.command.name}":
                    rows[fault.name][reference.command.name] = {}
                    continue
                chosen = spread(fault.values(reference), None if options.all else options.runs)
                runs = list(pool.map(lambda n: Run(reference, fault, n, inputs), chosen))
                check_recordings(runs)
                rows[fault.name][reference.command.name] = collections.Counter(run.outcome() for run in runs)
                problems += [run for run in runs if run.problems]
                total += len(runs)
    for run in problems[:30]:
        print(run.report())
    print(f"{total} runs, {len(problems)} with problems")
    if options.table:
        write_table(rows, options.table)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
