"""The examples of the documents and the notebooks run."""

import importlib.util
import re

import pytest
from conftest import ROOT

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
