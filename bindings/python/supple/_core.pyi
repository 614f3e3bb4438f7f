"""The compiled module. Only `Error`, `MotionError` and `Stop` are public; `supple` documents them."""

from typing import Any

version: str

class Error(ValueError):
    """Unusable input: an option out of range, an unknown object, a file that cannot be read.

    The message says what is wrong, where, and how to mend it."""

class MotionError(Error):
    """A step of a body failed: a number was no longer finite, or a vertex moved too far."""

class Stop:
    """Stops calls from another thread: give it to a call as `stop`, and call `request` when it shall end."""

    def __init__(self) -> None: ...
    def request(self) -> None: ...
    @property
    def requested(self) -> bool: ...

def __getattr__(name: str) -> Any: ...
