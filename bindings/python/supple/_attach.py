"""A page that shows a scene while the program runs. Its compiled module is loaded when a scene is attached."""

from __future__ import annotations

import atexit
import functools
import html
import importlib
import os
import sys
import weakref
from types import TracebackType
from typing import TYPE_CHECKING, Any

from . import _arrays
from ._core import Error, Stop
from ._object import Object
from ._scene import Scene
from ._simulation import SimulatedObject, Simulation

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .typing import AttachOptions, BreakOptions


class View(_arrays.NotCopied):
    """The connection of a program to a page. `supple.attach` makes it; a `with` statement closes it."""

    def __init__(self, core: Any, shown: Scene | Simulation) -> None:
        self._core = core
        self._shown = shown

    @property
    def url(self) -> str:
        """The address of the page, with a secret token."""
        return str(self._core.url())

    @property
    def watching_url(self) -> str:
        """The address for those who may only watch, with another secret token; empty without `spectators`."""
        return str(self._core.watching_url())

    @property
    def steps(self) -> int:
        """Steps since `attach`: calls of `detect` and `step`."""
        return int(self._core.step_count())

    @property
    def frames(self) -> int:
        """Steps that the page was given."""
        return int(self._core.frame_count())

    @property
    def seconds_in_steps(self) -> float:
        """The time that frames have taken, without pauses."""
        return float(self._core.seconds_in_steps())

    @property
    def is_paused(self) -> bool:
        """Whether the program waits, or will in its next step."""
        return bool(self._core.is_paused())

    def set_breaks(self, *, objects: tuple[str, str] = ("", ""), **breaks: Unpack[BreakOptions]) -> None:
        """Sets the events that pause the program, instead of the present ones: `contact_begin`,
        `intersection`, `contacts_above`, `depth_above`, `not_finite`. `objects` are the names of those whose
        contacts begin; an empty name stands for any object."""
        self._core.set_breaks(breaks, objects)

    def set_field(
        self, shown: Object | SimulatedObject, name: str, values: Any, *, of: str | None = None
    ) -> None:
        """Shows your own numbers as the field `name`, which the page can choose: an array (n,) with one for
        each vertex of the object, (m,) with one for each triangle, or (n, 3) or (m, 3) with vectors, which
        the page draws as arrows. Frames from the next `detect` on have them, until they are set again. NaN is
        no value, and an empty array ends the field of the object. `of` is "vertex" or "face"; without it, the
        length decides, and a length that fits both is that of vertices."""
        owner = getattr(shown, "_scene", None) or getattr(shown, "_simulation", None)
        if owner is not self._shown:
            raise Error(f"set_field: {shown!r} is not an object of the scene that the page shows")
        array = _arrays.as_numpy(values, name)
        is_vector = array.ndim == 2
        array = _arrays.doubles(array, f"the values of {name}", *((-1, 3) if is_vector else (-1,)))
        (self._core.set_field_vectors if is_vector else self._core.set_field)(shown._id, name, array, of)

    def wait(self, *, stop: Stop | None = None) -> None:
        """Shows the last step until the page continues the program or the view is closed. Ctrl-C ends it."""
        self._core.wait(stop)

    def close(self) -> None:
        """Ends a pause, tells the page that the program has ended, and frees the port. Later steps are not
        shown."""
        self._core.close()

    def __enter__(self) -> View:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<supple.View: {self.steps} steps, {self.frames} frames; {self.url}>"

    def _repr_html_(self) -> str:
        return f'<a href="{html.escape(self.url)}" target="_blank">The page of the running program</a>'


def attach(
    shown: Scene | Simulation,
    *,
    open: bool = True,
    objects: tuple[str, str] = ("", ""),
    **options: Unpack[AttachOptions],
) -> View:
    """Shows a scene or a simulation in a page while the program runs: from now on, each `detect` or `step`
    shows its result. The page can pause the program, take single steps, and set the events that pause it.

        view = supple.attach(scene, contact_begin=True)
        while True:
            cloth.positions = solver.step()
            scene.detect()

    `open` opens the page in the browser, if there is a screen. Options: `max_slowdown`, the share of the
    program's time that frames may take (0.03), `time_step`, `title`, `address`, `port`, `token_file`,
    `wait_for_page`, `history_bytes`, `spectators`, which makes `View.watching_url` for those who may only watch,
    and the events of `View.set_breaks` with their `objects`. `view` makes a page of the
    present state instead, which needs no running program.
    """
    title = os.path.basename(sys.argv[0]) or "Python"
    keywords = {"title": title, "open_browser": bool(open), **options}
    compiled = _compiled()
    if isinstance(shown, Scene):
        core = compiled.attach_scene(shown._core, keywords, objects)
    elif isinstance(shown, Simulation):
        core = compiled.attach_simulation(shown._core, keywords, objects)
    else:
        raise Error(f"attach: {shown!r} is neither a Scene nor a Simulation")
    view = View(core, shown)
    _views.add(view)
    return view


_views: weakref.WeakSet[View] = weakref.WeakSet()


@functools.cache
def _compiled() -> Any:
    try:
        compiled = importlib.import_module("supple._viewer")
    except ModuleNotFoundError:
        raise Error(
            "attach: this package was built without the viewer; build it from its sources: pip install ."
        ) from None

    def end() -> None:
        for view in _views:
            view.close()
        compiled.end_calls()

    atexit.register(end)
    os.register_at_fork(after_in_child=compiled.forget_calls)
    os.register_at_fork(after_in_child=_views.clear)
    return compiled
