"""The types of the package: mypy and pyright check it and a program that uses it."""

import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest
import typed_example

import supple
import supple.typing
from supple import _result, _tables

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parents[2]
WRONG = HERE / "typed_wrong.py"
MYPY = "mypy", "--no-incremental"
PYRIGHT = "pyright", "--pythonpath", sys.executable


def check(*command):
    done = subprocess.run(
        [sys.executable, "-m", *command], capture_output=True, text=True, cwd=ROOT, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


def has_pyright():
    # Its first run loads the checker from the npm registry.
    done = subprocess.run([sys.executable, "-m", "pyright", "--version"], capture_output=True, check=False)
    return done.returncode == 0


def test_mypy():
    pytest.importorskip("mypy")
    check(*MYPY, "bindings/python/supple", HERE / "typed_example.py")


def test_pyright():
    pytest.importorskip("pyright")
    if not has_pyright():
        pytest.skip("pyright cannot be loaded here")
    check(*PYRIGHT, HERE / "typed_example.py")


def wrong_lines(*command):
    """The lines of typed_wrong.py that a checker reports."""
    done = subprocess.run(
        [sys.executable, "-m", *command, WRONG], capture_output=True, text=True, cwd=ROOT, check=False
    )
    reported = re.findall(r"typed_wrong\.py:(\d+)(?::\d+)*:? (?:- )?error", done.stdout)
    assert reported, done.stdout + done.stderr
    return {int(line) for line in reported}


@pytest.mark.parametrize("checker", ["mypy", "pyright"])
def test_checkers_find_the_mistakes(checker):
    pytest.importorskip(checker)
    if checker == "pyright" and not has_pyright():
        pytest.skip("pyright cannot be loaded here")
    lines = WRONG.read_text().splitlines()
    marked = {number: line for number, line in enumerate(lines, 1) if "# wrong" in line}
    wrong = {number for number, line in marked.items() if checker == "mypy" or "for mypy" not in line}
    assert len(wrong) > 30
    assert wrong_lines(*(MYPY if checker == "mypy" else PYRIGHT)) == wrong


def test_types_have_the_members_of_records():
    for name, dtype in supple.dtypes.items():
        empty = np.empty(0, dtype).view(supple.Table)
        empty.record = name
        members = supple.typing.__dict__[name].__annotations__
        assert members.keys() == set(empty.columns), name
        for column, words in _tables._words[name].items():
            assert members[column] == f"Literal{list(words)!r}", (name, column)
    lists = {name for name, value in vars(supple.typing.ResultLists).items() if isinstance(value, property)}
    names = {name for name in supple.Scene().result._names() if "/" not in name} - {"untested"}
    assert lists == names | _result.SHORT.keys()
    assert supple.typing.StepStats.__annotations__.keys() == supple.Scene().result.stats.keys()


@pytest.mark.parametrize(
    "structure",
    sorted(name for name in vars(supple.typing) if name.endswith(("Options", "Motion", "Response"))),
)
def test_types_have_the_keywords_of_options(structure):
    keywords = supple.typing.__dict__[structure].__annotations__
    try:
        known = {each.name for each in supple.options(structure)}
    except supple.Error:  # a part of other options, or of another module
        assert structure in {
            "ObjectOctreeOptions",
            "SceneOctreeOptions",
            "ComparisonOptions",
            "AttachOptions",
            "BreakOptions",
        }
        return
    own_arguments = {"fixed", "fixed_vertices", "pull", "handles", "kind_pairs"}
    assert known - own_arguments <= keywords.keys()


def test_keywords_are_accepted():
    """Each keyword of the types is one of the calls: another value is an error that names it."""

    class Nothing:
        pass

    box = supple.make_box()
    for structure, call in (
        ("SceneOptions", supple.Scene),
        ("ObjectOptions", lambda **options: supple.Scene().add(box, **options)),
        ("DetectRequest", lambda **options: supple.Scene().detect(**options)),
        ("SimulationOptions", supple.Simulation),
        ("MassSpringMotion", lambda **options: supple.Simulation().add(box, springs=options)),
        ("RigidMotion", lambda **options: supple.Simulation().add(box, rigid=options)),
        ("MassSpringOptions", lambda **options: supple.MassSpringBody(box, **options)),
        ("BroadPhaseOptions", supple.BroadPhase),
    ):
        for keyword in supple.typing.__dict__[structure].__annotations__:
            if keyword in ("kind_pairs", "border"):
                continue
            nested = (
                structure != "MassSpringMotion"
                and keyword in ("octree", "impact", "comparison", "scene_octree", "scene")
                or keyword == "springs"
            )
            value, error = ({"none": 1}, TypeError) if nested else (Nothing(), supple.Error)
            with pytest.raises(
                error, match="no option 'none'" if nested else "; it must be|must be an array"
            ):
                call(**{keyword: value})


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
