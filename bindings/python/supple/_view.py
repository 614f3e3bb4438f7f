"""The viewer's page of a scene, a simulation or a recording: one file, which needs no server."""

from __future__ import annotations

import html
import os
import pathlib
import tempfile
import webbrowser

from . import _program
from ._recording import Recording, record
from ._scene import Scene
from ._simulation import Simulation


class Page:
    """A page of the viewer. Jupyter shows it inline; `open` shows it in the browser."""

    def __init__(self, path: pathlib.Path) -> None:
        self.path = path

    def open(self) -> None:
        """Opens the page in the browser."""
        webbrowser.open(self.path.resolve().as_uri())

    def _repr_html_(self) -> str:
        text = html.escape(self.path.read_text(encoding="utf-8"), quote=True)
        return f'<iframe srcdoc="{text}" width="100%" height="560" style="border:0"></iframe>'

    def __repr__(self) -> str:
        return f"<supple.Page {str(self.path)!r}: open it in a browser>"


def view(
    shown: Scene | Simulation | Recording | str | os.PathLike[str], page: str | os.PathLike[str] | None = None
) -> Page:
    """Makes the viewer's page: of the present state and the last result of a scene or a simulation, of all
    frames of a recording, or of what the program views (a mesh, a scene file, a recording).

    `page` is the path of the page; without it, the page is a temporary file. Needs the command line program.
    """
    folder = pathlib.Path(tempfile.mkdtemp(prefix="supple-"))
    target = pathlib.Path(page) if page is not None else folder / "page.html"
    if isinstance(shown, (Scene, Simulation)):
        source = folder / "state.h5"
        with record(source, shown) as recorder:
            recorder.add()
    else:
        source = pathlib.Path(shown.path if isinstance(shown, Recording) else shown)
    _program.run("view", str(source), "--export", str(target))
    return Page(target)
