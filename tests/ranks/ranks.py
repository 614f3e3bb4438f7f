"""Runs the program on several ranks and compares what it writes with what one process writes."""

import os
import pathlib
import re
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from program import PROGRAM, ROOT, ProgramTest  # noqa: E402

MPIEXEC = os.environ.get("MPIEXEC", "mpiexec")
SCENES = ROOT / "scenes"
DATA = pathlib.Path(os.environ.get("SUPPLE_DATA", ROOT.parent / "shared/data"))
# The times and the work of the stages, and what says the number of ranks.
OF_RUN = re.compile(
    r"^(motion|refit|broad phase|rebuild|traversal|exact|penetration|sort, events|total) +\d.*$"
    r"|, \d+ ranks$|(?<=simulated in ).*$",
    re.M,
)
# Open MPI adds paragraphs about a process that fails.
OF_LAUNCHER = re.compile(r"^-{60,}\n.*?^-{60,}\n+", re.M | re.S)


def launch(ranks, *arguments, folder=None, **environment):
    """A job of so many ranks; 0 starts the program without a launcher."""
    launcher = [MPIEXEC, "-n", str(ranks)] if ranks else []
    return subprocess.run(
        [*launcher, PROGRAM, *map(str, arguments)],
        cwd=folder,
        capture_output=True,
        text=True,
        env={**os.environ, **environment},
    )


def pid_of_rank(rank, launcher):
    """The process of a rank of this launcher; None before it runs."""
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            parent = int((folder / "stat").read_text().rsplit(")", 1)[1].split()[1])
            name = (folder / "comm").read_text().strip()
            variables = (folder / "environ").read_bytes().split(b"\0")
        except OSError:
            continue
        if parent == launcher and name == "supple-mpi" and b"OMPI_COMM_WORLD_RANK=%d" % rank in variables:
            return int(folder.name)
    return None


def eventually(condition):
    """Waits until the condition is true, and returns its value."""
    end = time.monotonic() + 60
    while not (result := condition()):
        if time.monotonic() > end:
            raise AssertionError("it did not happen within a minute")
        time.sleep(0.01)
    return result


class RanksTest(ProgramTest):
    def written(self, ranks, command, arguments, files):
        """The status, both streams and the files that a run writes."""
        done = launch(ranks, command, *arguments, *files, folder=self.folder)
        paths = [self.folder / str(name) for name in files if "." in str(name)]
        texts = [path.read_text() for path in paths if path.suffix in (".json", ".csv")]
        error = OF_LAUNCHER.sub("", done.stderr).strip()
        return done.returncode, OF_RUN.sub("", done.stdout), error, texts

    def assert_same(self, *arguments, command="detect", csv=True, ranks=(1, 2, 3)):
        """Returns the standard output of one process."""
        files = ["--json", "out.json", "--no-stats", "--contact-details"] + (["--csv", "out.csv"] if csv else [])
        alone = self.written(0, command, arguments, files)
        self.assertEqual(alone[0], 0, alone[2])
        for count in ranks:
            shared = self.written(count, command, arguments, files)
            self.assertEqual(alone[:3], shared[:3], count)
            for one, other in zip(alone[3], shared[3]):  # too long for a list of differences
                at = next((i for i, (a, b) in enumerate(zip(one, other)) if a != b), min(len(one), len(other)))
                self.assertTrue(one == other, f"{count} ranks, at {at}: {one[at - 80:at + 80]} {other[at - 80:at + 80]}")
        return alone[1]
