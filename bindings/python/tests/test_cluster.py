"""The examples for clusters: the Slurm script, the container and the program that both use."""

import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT
from frame_functions import moving_balls

import supple

CLUSTER = ROOT / "examples/cluster"
FRAMES = 24
#: Of `man sbatch`: those that a job of this kind may need.
SBATCH_OPTIONS = {
    *(
        "account",
        "array",
        "chdir",
        "constraint",
        "cpus-per-task",
        "dependency",
        "error",
        "exclusive",
        "export",
    ),
    *("job-name", "mail-type", "mail-user", "mem", "mem-per-cpu", "nodes", "ntasks", "ntasks-per-node"),
    *("open-mode", "output", "partition", "qos", "requeue", "reservation", "signal", "time", "tmp", "wrap"),
}
# The commands of packages are next to the interpreter.
PATH = os.pathsep.join([str(pathlib.Path(sys.executable).parent), os.environ["PATH"]])


def run(*command, path=PATH, **options):
    return subprocess.run(
        list(map(str, command)),
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
        **options,
    )


@pytest.fixture(scope="module")
def animation(tmp_path_factory):
    """A pattern of mesh files, and the rows that the program writes for it."""
    folder = tmp_path_factory.mktemp("animation")
    positions, faces = moving_balls(FRAMES)
    for i, each in enumerate(positions):
        supple.save_mesh(supple.Mesh(each, faces), folder / f"balls_{i}.obj")
    pattern = f"{folder}/balls_*.obj"
    rows = [[str(value) for value in each] for each in supple.check(pattern).frames]
    assert len(rows) == FRAMES and len({row[1] for row in rows}) > 5
    return pattern, [list(supple.FrameCheck._fields), *rows]


def read(path):
    with path.open(newline="") as file:
        return list(csv.reader(file))


@pytest.mark.parametrize("options", [[], ["--processes", "2"]])
def test_the_program_on_one_machine(options, animation, tmp_path):
    pattern, rows = animation
    done = run(sys.executable, CLUSTER / "check_frames.py", pattern, tmp_path / "frames.csv", *options)
    assert done.returncode == 1 and "frames have contacts" in done.stdout, done.stderr
    assert f"{FRAMES} of {FRAMES} frames" in done.stderr
    assert read(tmp_path / "frames.csv") == rows
    done = run(sys.executable, CLUSTER / "check_frames.py", tmp_path / "none_*.obj", tmp_path / "none.csv")
    assert (
        done.returncode == 1
        and done.stderr == f"check_frames: {tmp_path}/none_*.obj: no such file; quote the pattern\n"
    )


def test_the_slurm_script_runs(animation, tmp_path):
    """With a `srun` that starts two tasks on this machine."""
    if not shutil.which("dask", path=PATH):
        pytest.skip("dask is not installed")
    pattern, rows = animation
    srun = tmp_path / "bin/srun"
    srun.parent.mkdir()
    srun.write_text(
        "#!/usr/bin/env bash\n"
        "trap 'kill $(jobs -p)' TERM\n"
        'while [[ $1 == --* ]]; do echo "$1" >> options; shift; done\n'
        '"$@" & "$@" & wait\n'
    )
    srun.chmod(0o755)
    done = run(
        *("bash", CLUSTER / "check.sbatch", pattern, tmp_path / "frames.csv"),
        cwd=tmp_path,
        path=f"{srun.parent}{os.pathsep}{PATH}",
    )
    assert (
        done.returncode == 1 and f"frames have contacts; the deepest is frame {FRAMES - 1}" in done.stdout
    ), done.stderr
    assert read(tmp_path / "frames.csv") == rows
    assert (tmp_path / "options").read_text() == "--kill-on-bad-exit=0\n", "workers were started by srun"
    assert not list(tmp_path.glob("scheduler-*.json"))


def test_the_slurm_script_is_clean():
    script = CLUSTER / "check.sbatch"
    assert run("bash", "-n", script).returncode == 0
    usage = run("bash", script)
    assert usage.returncode == 1 and "usage: sbatch check.sbatch ANIMATION FRAMES.csv" in usage.stderr
    lines = script.read_text().splitlines()
    named = [
        re.fullmatch(r"#SBATCH --([a-z-]+)(=\S+)?", line) for line in lines if line.startswith("#SBATCH")
    ]
    assert len(named) >= 5 and all(named) and {each[1] for each in named} <= SBATCH_OPTIONS
    # Slurm reads options only before the first command.
    first = next(i for i, line in enumerate(lines) if line and not line.startswith("#"))
    assert not any(line.startswith("#SBATCH") for line in lines[first:])
    if not shutil.which("shellcheck", path=PATH):
        pytest.skip("shellcheck is not installed")
    done = run("shellcheck", script)
    assert done.returncode == 0, done.stdout


def test_the_container_is_clean():
    recipe = CLUSTER / "Containerfile"
    copied = [line.split() for line in recipe.read_text().splitlines() if line.startswith("COPY")]
    assert len(copied) == 3
    for _, *options, source, _target in copied:
        assert options or (ROOT / source).exists(), source
    if not shutil.which("hadolint", path=PATH):
        pytest.skip("hadolint is not installed")
    # Debian keeps the versions of its packages.
    done = run("hadolint", "--no-color", "--ignore", "DL3008", recipe)
    assert done.returncode == 0 and done.stdout == "", done.stdout
