"""The program supple-experiment-report: `make build` packs this folder into one file beside the program."""

import sys

from judge.pages import stop, try_debians_python

try:
    import matplotlib  # noqa: F401
    import scipy  # noqa: F401
except ImportError:
    try_debians_python()
    stop("supple: the report needs matplotlib and scipy for python3; install them, on Debian by: apt-get install "
         "python3-matplotlib python3-scipy; the tables are written")

from judge.report import main

sys.exit(main())
