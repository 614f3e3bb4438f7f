#!/usr/bin/env python3
"""Runs the notebooks of the Python package from their first to their last cell; each must end without an
error.

usage: run_notebooks.py [--pictures] [NAME]...

--pictures writes the last picture of each notebook as docs/images/python_NAME.png. Needs nbclient and
ipykernel.
"""

import argparse
import base64
import pathlib
import sys

import nbclient
import nbformat

ROOT = pathlib.Path(__file__).parent.parent
NOTEBOOKS = ROOT / "bindings/python/notebooks"


def run(path):
    """The notebook with its outputs. Raises the error of a cell."""
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(NOTEBOOKS)}}).execute()
    return notebook


def last_picture(notebook):
    """The last PNG of the outputs."""
    pictures = [output["data"]["image/png"] for cell in notebook.cells if cell.cell_type == "code"
                for output in cell.outputs if "image/png" in output.get("data", {})]
    return base64.b64decode(pictures[-1])


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1].split("\n\n")[0])
    parser.add_argument("--pictures", action="store_true")
    parser.add_argument("names", nargs="*", default=sorted(path.stem for path in NOTEBOOKS.glob("*.ipynb")))
    arguments = parser.parse_args()
    for name in arguments.names:
        notebook = run(NOTEBOOKS / f"{name}.ipynb")
        print(f"{name}: {sum(cell.cell_type == 'code' for cell in notebook.cells)} cells")
        if arguments.pictures:
            (ROOT / f"docs/images/python_{name}.png").write_bytes(last_picture(notebook))
    return 0


if __name__ == "__main__":
    sys.exit(main())
