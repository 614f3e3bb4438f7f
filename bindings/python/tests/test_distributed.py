"""One scene over ranks of MPI. The checks are in program_on_ranks.py, which mpirun runs."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT

import supple
from supple import _distributed_scene

HERE = pathlib.Path(__file__).parent
HAS_MODULE = any(pathlib.Path(supple.__file__).parent.glob("_distributed.*.so"))
EXAMPLE = ROOT / "examples/distributed/many_ranks.py"
RANKS = pytest.mark.parametrize("ranks", [1, 2, 3])


def run_on_ranks(ranks, program):
    if not HAS_MODULE:
        pytest.skip("the package was built without MPI")
    pytest.importorskip("mpi4py")
    if not shutil.which("mpirun"):
        pytest.skip("mpirun is not installed")
    done = subprocess.run(
        ["mpirun", "--oversubscribe", "-n", str(ranks), sys.executable, "-m", "mpi4py", program],
        env={
            **os.environ,
            "OMPI_ALLOW_RUN_AS_ROOT": "1",
            "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_mpi_yield_when_idle": "1",
        },
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@RANKS
def test_ranks(ranks):
    checks = run_on_ranks(ranks, HERE / "program_on_ranks.py").split()
    assert checks[0] == "random_scenes" and len(checks) == 9


@RANKS
def test_the_example_prints_the_output_of_the_document(ranks):
    text = (ROOT / "docs/distributed.md").read_text()
    assert run_on_ranks(ranks, EXAMPLE) == re.search(r"^```text\n(.*?)^```$", text, re.M | re.S)[1]


def test_a_package_without_mpi(monkeypatch):
    monkeypatch.setitem(sys.modules, "supple._distributed", None)
    _distributed_scene._compiled.cache_clear()
    with pytest.raises(
        supple.Error, match=r"built without MPI.*libtrilinos-zoltan-dev.*SUPPLE_BUILD_DISTRIBUTED=ON"
    ):
        supple.DistributedScene(None)


def test_the_import_needs_no_mpi():
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            "import sys, supple; print('mpi4py' in sys.modules, 'libmpi' in open('/proc/self/maps').read())",
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout == "False False\n", done.stderr
