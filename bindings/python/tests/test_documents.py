"""The examples of the documents and the notebooks run."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT
from frame_functions import moving_balls

import supple

pytestmark = pytest.mark.filterwarnings("default")


@pytest.mark.parametrize("name", ["README.md", "docs/python.md"])
def test_examples(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    supple.save_mesh(supple.make_icosphere(8), "ball.obj")
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / name).read_text(), re.DOTALL)
    assert blocks
    names = {}
    for block in blocks:
        exec(compile(block, name, "exec"), names)  # noqa: S102


FRAMES = [
    block
    for page in ("docs/distributed.md", "experiments/README.md")
    for block in re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), re.DOTALL)
]


@pytest.mark.parametrize("number", range(len(FRAMES)))
def test_programs_of_frames(number, program, tmp_path, monkeypatch):
    """Each example is a program of its own, because processes and ranks import it."""
    text = FRAMES[number]
    start = [sys.executable]
    for package in ("tqdm", "dask", "mpi4py"):
        if package in text or package == "tqdm" and "progress=True" in text:
            pytest.importorskip(package)
    if "mpi4py" in text:
        if not shutil.which("mpirun"):
            pytest.skip("mpirun is not installed")
        start = ["mpirun", "--oversubscribe", "-n", "3", sys.executable, "-m", "mpi4py.futures"]
    positions, faces = moving_balls(12)
    for i, each in enumerate(positions):
        supple.save_mesh(supple.Mesh(each, faces), tmp_path / f"balls_{i}.obj")
    (tmp_path / "program.py").write_text(text)
    done = subprocess.run(
        [*start, "program.py"],
        cwd=tmp_path,
        env={**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    monkeypatch.chdir(tmp_path)
    if "supple.check" in text:
        report = supple.check("balls_*.obj")
        assert not report.clean and done.stdout == f"{report}\n"
    elif "count_contacts" in text:
        counts = [each.contacts for each in supple.check("balls_*.obj").frames]
        assert any(counts) and done.stdout == f"{counts}\n"
    else:
        assert done.stdout.count("array([") == 2


NOTEBOOKS = sorted(path.stem for path in (ROOT / "bindings/python/notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_notebooks(name):
    pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    if name == "torch_loss":
        pytest.importorskip("torch")
    specification = importlib.util.spec_from_file_location("run_notebooks", ROOT / "tools/run_notebooks.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    notebook = module.run(module.NOTEBOOKS / f"{name}.ipynb")
    assert module.last_picture(notebook).startswith(b"\x89PNG")
    assert all(
        not cell.outputs
        for cell in module.nbformat.read(module.NOTEBOOKS / f"{name}.ipynb", 4).cells
        if cell.cell_type == "code"
    ), "the notebook is kept without outputs"
