#!/usr/bin/env python3
"""Checks that results have the same bits on several machines, with several compilers.

For each row of the table below, compiles the library and runs it on the scenes, models and bodies of
tests/support/golden_*.hpp. All rows must give the same hash. The script skips a row, with a message, when this
machine lacks the compiler or the emulator; tools/install_dependencies.sh --determinism installs all of them on
Debian 12.
"""
import argparse
import os
import pathlib
import platform
import re
import resource
import shutil
import subprocess
import sys
import time

# One row has every instruction set of x86-64; each other row needs only one.
TABLE = """
machine  compiler               library    level  instruction sets
x86_64   g++-12                 libstdc++  O0     avx2
x86_64   g++-12                 libstdc++  O1     scalar sse4 avx2 avx512
x86_64   g++-12                 libstdc++  O2     avx2
x86_64   g++-12                 libstdc++  O3     avx2
x86_64   clang++-14             libstdc++  O2     avx2
x86_64   clang++-19             libstdc++  O2     avx2
x86_64   clang++-19             libc++     O2     avx2
aarch64  aarch64-linux-gnu-g++  libstdc++  O1     neon
riscv64  riscv64-linux-gnu-g++  libstdc++  O1     scalar
wasm32   clang++-19             libc++     O1     scalar
"""
# How to run the programs of a machine, and options of CMake for it.
RUNNERS = {"x86_64": [],
           "aarch64": ["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"],
           "riscv64": ["qemu-riscv64", "-L", "/usr/riscv64-linux-gnu"],
           "wasm32": ["node", "--no-warnings", "tests/determinism/run_wasm.mjs"]}
CROSS = {"x86_64": [], "aarch64": ["-DCMAKE_SYSTEM_NAME=Linux"], "riscv64": ["-DCMAKE_SYSTEM_NAME=Linux"],
         "wasm32": ["-DCMAKE_SYSTEM_NAME=Generic", "-DCMAKE_CXX_COMPILER_TARGET=wasm32-wasi",
                    "-DCMAKE_EXE_LINKER_FLAGS=-Wl,-z,stack-size=8388608"]}
FLAGS = {("x86_64", "libc++"): ["-stdlib=libc++"], ("wasm32", "libc++"): ["-fignore-exceptions"]}

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCUMENT = ROOT / "tests" / "determinism" / "README.md"
NOT_SUPPORTED = 77  # the exit status of a program whose instruction set this machine does not have


def rows():
    for line in TABLE.strip().splitlines()[1:]:
        machine, compiler, library, level, *sets = line.split()
        yield machine, compiler, library, level, sets


def version_of(program):
    text = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    return re.search(r"\d+\.\d+\.\d+", text)[0]


def reason_to_skip(machine, compiler, flags):
    runner = RUNNERS[machine]
    if not runner and platform.machine() != machine:
        return f"this machine is not {machine}"
    for tool in [compiler, *runner[:1]]:
        if not shutil.which(tool):
            return f"there is no {tool}"
    target = ["--target=wasm32-wasi"] if machine == "wasm32" else []
    trial = subprocess.run([compiler, *target, *flags, "-x", "c++", "-std=c++20", "-E", "-"], input="#include <vector>", text=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return "its standard library is not installed" if trial.returncode != 0 else None


def build(folder, machine, compiler, flags, level, sets):
    """Returns the output of the build that failed, or nothing."""
    configure = ["cmake", "-G", "Ninja", "-S", "tests/determinism", "-B", folder, "-DCMAKE_BUILD_TYPE=Release",
                 f"-DCMAKE_CXX_FLAGS_RELEASE=-{level}", f"-DCMAKE_CXX_FLAGS={' '.join(flags)}", f"-DCMAKE_CXX_COMPILER={compiler}",
                 f"-DCMAKE_SYSTEM_PROCESSOR={machine}", *CROSS[machine]]
    for command in configure, ["cmake", "--build", folder, "-j", os.environ.get("JOBS", str(os.cpu_count())), "--target", *sets]:
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            return done.stdout
    return None


def check(machine, compiler, library, level, sets):
    """Returns a result for each instruction set: its hash, or what happened instead."""
    flags = FLAGS.get((machine, library), [])
    reason = reason_to_skip(machine, compiler, flags)
    if reason:
        return {name: f"skipped: {reason}" for name in sets}
    folder = ROOT / "build" / "determinism" / f"{machine}_{compiler}_{library}_{level}"
    output = build(folder, machine, compiler, flags, level, sets)
    if output:
        print(output)
        return {name: "DOES NOT COMPILE" for name in sets}
    results = {}
    for name in sets:
        done = subprocess.run([*RUNNERS[machine], folder / name], cwd=ROOT, stdout=subprocess.PIPE, text=True)
        if done.returncode == NOT_SUPPORTED:
            results[name] = f"skipped: the processor does not have {name}"
        else:
            results[name] = done.stdout.strip() + ("" if done.returncode == 0 else " DIFFERENT")
    return results


def processor_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def line_of(machine, compiler, library, level, name, result):
    runner = RUNNERS[machine]
    place = f"{runner[0]} {version_of(runner[0])}" if runner else "the processor"
    return f"| {machine} | {compiler} {version_of(compiler)} | {library} | `-{level}` | {name} | {place} | {result} |"


def write_table(lines):
    begin, end = "<!-- begin-results -->\n", "<!-- end-results -->\n"
    before, rest = DOCUMENT.read_text().split(begin)
    header = "| Machine | Compiler | Standard library | Level | Instruction set | Run by | Hash |\n|---|---|---|---|---|---|---|\n"
    DOCUMENT.write_text(before + begin + header + "".join(line + "\n" for line in lines) + end + rest.split(end)[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", help="check only rows with all of these words, such as riscv64, or clang++-19 libc++")
    parser.add_argument("--table", action="store_true", help="write the results into tests/determinism/README.md, when all compilers and emulators are there")
    arguments = parser.parse_args()
    lines, results = [], []
    for *row, sets in rows():
        if not set(arguments.words) <= {*row, *sets}:
            continue
        begin, processor_begin = time.monotonic(), processor_seconds()
        for name, result in check(*row, sets).items():
            print(*row, name, result, flush=True)
            results.append(result)
            if not result.startswith("skipped") or result.endswith(f"does not have {name}"):
                lines.append(line_of(*row, name, result))
        print(f"  {time.monotonic() - begin:.0f} s, {processor_seconds() - processor_begin:.0f} s of processor time", flush=True)
    hashes = {result for result in results if not result.startswith("skipped")}
    if len(hashes) != 1 or not re.fullmatch("[0-9a-f]{16}", hashes.pop()):
        sys.exit("check_determinism.py: results differ, or nothing was checked")
    if arguments.table:
        if len(lines) < sum(len(sets) for *_, sets in rows()):
            sys.exit("check_determinism.py: not every row was checked, so the table in tests/determinism/README.md stays as it is")
        write_table(lines)


if __name__ == "__main__":
    main()
