import json
import os
import pathlib
import subprocess

import numpy as np
import pytest

import supple

ROOT = pathlib.Path(__file__).parents[3]
DATA = pathlib.Path(os.environ.get("SUPPLE_DATA", ROOT.parent / "shared/data"))


@pytest.fixture(scope="session")
def program():
    """The command line program of this build."""
    path = pathlib.Path(os.environ.get("SUPPLE_PROGRAM", ROOT / "build/release/bin/supple"))
    if not path.exists():
        pytest.skip(f"{path} is not built")
    os.environ["SUPPLE_PROGRAM"] = str(path)

    def run(*arguments, check=True):
        done = subprocess.run([path, *map(str, arguments)], capture_output=True, text=True, check=False)
        assert not check or done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture
def detect_json(program):
    """The first frame that the program finds in meshes."""

    def detect(*arguments):
        return json.loads(program("detect", *arguments, "--json", "-", "--quiet"))["frames"][0]

    return detect


@pytest.fixture(scope="session")
def sphere():
    return supple.make_icosphere(6)


@pytest.fixture
def rng():
    return np.random.default_rng(20261127)


def two_spheres(sphere, apart=1.5, **options):
    """Two spheres that intersect, in a scene of all kinds of contacts but continuous ones."""
    scene = supple.Scene(contacts={"intersection", "proximity", "penetration"}, curves=True, **options)
    a = scene.add(sphere, name="a", margin=0.05, solid=True)
    b = scene.add(
        np.asarray(sphere.positions) + [apart, 0, 0], sphere.triangles, name="b", margin=0.05, solid=True
    )
    return scene, a, b


def equal(a, b):
    """Whether two tables have the same rows; bytes between their members do not count."""
    return len(a) == len(b) and all(np.array_equal(a[name], b[name]) for name in a.dtype.names)
