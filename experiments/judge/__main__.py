"""The program supple-experiment-report: `make build` packs this folder into one file beside the program."""

import sys

try:
    import matplotlib  # noqa: F401
    import scipy  # noqa: F401
except ImportError:
    import os
    import pathlib

    # Another Python than Debian's, to which Debian's packages belong, can be the first in PATH.
    debian = pathlib.Path("/usr/bin/python3")
    if debian.exists() and debian.resolve() != pathlib.Path(sys.executable).resolve():
        os.execv(debian, [debian, *sys.argv])
    print("supple: the report needs matplotlib and scipy for python3; install them, on Debian by: apt-get install "
          "python3-matplotlib python3-scipy; the tables are written", file=sys.stderr)
    sys.exit(2)

from judge.report import main

sys.exit(main())
