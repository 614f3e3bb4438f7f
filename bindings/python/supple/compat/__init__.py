"""The same calls as other libraries: `compat.trimesh` and `compat.ipctk`."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import ipctk, trimesh
else:

    def __getattr__(name: str) -> Any:
        """Modules that are loaded when they are used."""
        if name in ("ipctk", "trimesh"):
            return importlib.import_module(f"supple.compat.{name}")
        raise AttributeError(f"module 'supple.compat' has no attribute {name!r}")


__all__ = ["ipctk", "trimesh"]
