"""The types of the package: mypy and pyright check it and a program that uses it."""

import pathlib
import subprocess
import sys

import pytest
import typed_example

import supple

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parents[2]


def check(*command):
    done = subprocess.run(
        [sys.executable, "-m", *command], capture_output=True, text=True, cwd=ROOT, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_mypy():
    pytest.importorskip("mypy")
    check("mypy", "--no-incremental", "bindings/python/supple", HERE / "typed_example.py")


def test_pyright():
    pytest.importorskip("pyright")
    # Its first run loads the checker from the npm registry.
    if subprocess.run(
        [sys.executable, "-m", "pyright", "--version"], capture_output=True, check=False
    ).returncode:
        pytest.skip("pyright cannot be loaded here")
    check("pyright", HERE / "typed_example.py")


def test_the_program_runs():
    assert typed_example.fall(15)[-1] > 0


def test_all_names_are_exported():
    modules = "_core", "_contracts"
    names = {
        name
        for name, value in vars(supple).items()
        if not name.startswith("_")
        and getattr(value, "__module__", "").startswith("supple")
        and not isinstance(value, type(sys))
        and name not in modules
    }
    assert names - {"ENUMERATIONS", "CONTRACTS"} == set(supple.__all__) - {"dtypes"}
    assert all(getattr(supple, name).__doc__ for name in supple.__all__)
