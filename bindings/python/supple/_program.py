"""The command line program, which the viewer's pages need."""

from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
import sys

from ._core import Error


def find() -> str:
    """The path of the program: that of the package, that of SUPPLE_PROGRAM, or that on the PATH."""
    own = pathlib.Path(__file__).parent / "bin" / "supple"
    named = os.environ.get("SUPPLE_PROGRAM", "")
    for candidate in (str(own), named):
        if candidate and os.access(candidate, os.X_OK):
            return candidate
    # The script of the package is on the PATH, too; it would run itself.
    script = pathlib.Path(sys.argv[0]).resolve() if sys.argv and sys.argv[0] else None
    for folder in os.environ.get("PATH", "").split(os.pathsep):
        found = shutil.which("supple", path=folder)
        if found and pathlib.Path(found).resolve() != script and not _is_script(found):
            return found
    raise Error(
        "this package was built without the program; build it (make program) and set SUPPLE_PROGRAM to its path, "
        "or put it on the PATH"
    )


def _is_script(path: str) -> bool:
    with pathlib.Path(path).open("rb") as file:
        return file.read(2) == b"#!"


def run(*arguments: str) -> None:
    """Runs the program; its error becomes an `Error`."""
    done = subprocess.run([find(), *arguments], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        raise Error(done.stderr.strip() or f"the program ended with status {done.returncode}")


def main() -> None:
    """The command `supple` and `python -m supple`."""
    try:
        program = find()
    except Error as error:
        sys.exit(f"supple: {error}")
    os.execv(program, [program, *sys.argv[1:]])
