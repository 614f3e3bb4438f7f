"""Recordings of several ranks: each rank writes its objects to a file of its own, and all are read as one."""

import importlib.util
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import unittest

if importlib.util.find_spec("h5py") is None and sys.executable != "/usr/bin/python3":
    found = subprocess.run(["/usr/bin/python3", "-c", "import h5py"], capture_output=True)
    if found.returncode == 0:  # Debian's h5py works only with Debian's Python
        os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])
try:
    import h5py
    import numpy
except ImportError:
    h5py = None

from ranks import MPIEXEC, PROGRAM, SCENES, RanksTest, eventually, launch, pid_of_rank

NINE = SCENES / "nine.toml"
PAGE = (pathlib.Path(__file__).resolve().parents[2] / "docs/recording.md").read_text()
with_h5py = unittest.skipUnless(h5py, "needs h5py")
# Builds with sanitizers have no viewer.
HAS_VIEWER = "without the viewer" not in subprocess.run([PROGRAM, "view", "a.obj"], capture_output=True, text=True).stderr


def values_of(path):
    """All attributes and datasets, through links, without statistics and what names the run."""
    values = {}

    def add(group, path):
        values.update({f"{path}@{name}": value for name, value in group.attrs.items() if name not in ("run", "ranks")})
        for name, item in group.items():
            if isinstance(item, h5py.Dataset):
                values[f"{path}/{name}"] = item[()]
            elif name != "statistics":
                add(item, f"{path}/{name}")

    with h5py.File(path) as file:
        add(file, "")
    return values


class Recordings(RanksTest):
    def record(self, ranks, name="run.h5", frames=6, scene=NINE, **more):
        done = launch(ranks, "simulate", scene, "--frames", frames, "--record", name, "--quiet", folder=self.folder, **more)
        self.assertEqual((done.returncode, done.stdout), (0, ""), done.stderr)

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())

    def detected(self, recording="run.h5"):
        done = self.run_here("detect", recording, "--json", "-", "--no-stats", "--contact-details")
        self.assertEqual(done.status, 0, done.error)
        return done.out

    def assert_equal_values(self, a, b):
        self.assertEqual(a.keys(), b.keys())
        for name, value in a.items():
            self.assertEqual(numpy.asarray(value).tobytes(), numpy.asarray(b[name]).tobytes(), name)

    def test_they_are_read_as_one(self):
        self.record(0, "alone.h5")
        files = ["alone.h5", "alone.xdmf"]
        for ranks in (1, 2, 3):
            self.record(ranks)
            of_ranks = [f"run.rank{rank}.h5" for rank in range(1, ranks)]
            self.assertEqual(self.files(), [*files, "run.h5", *of_ranks, "run.xdmf"])
            self.assertEqual(self.detected(), self.detected("alone.h5"))
            self.assertEqual(self.run_here("info", "run.h5").out, self.run_here("info", "alone.h5").out)
            differ = self.run_here("diff", "run.h5", "alone.h5")
            self.assertEqual((differ.status, differ.out), (0, "run.h5 and alone.h5 are equal: 6 frames\n"))
            if HAS_VIEWER:
                page = self.run_here("view", "run.h5", "--export", "run.html")
                self.assertEqual(page.status, 0, page.error)
                (self.folder / "run.html").unlink()
            if h5py:
                self.assert_equal_values(values_of(self.folder / "run.h5"), values_of(self.folder / "alone.h5"))
            sources = re.findall(r">([^<]*\.h5):(/objects/\d+)/", (self.folder / "run.xdmf").read_text())
            self.assertEqual({file for file, _ in sources}, {"run.h5", *of_ranks})
            if h5py:
                for file, item in set(sources):
                    with h5py.File(self.folder / file) as opened:
                        self.assertEqual(opened.get(f"{item}/positions").shape[0], 6)

    def test_moved_missing_cut_and_swapped_files(self):
        self.record(3)
        (self.folder / "other").mkdir()
        for path in self.folder.glob("run.*"):
            path.rename(self.folder / "other" / path.name)
        whole = self.detected("other/run.h5")
        self.record(3)
        self.assertEqual(self.detected(), whole)
        swapped = self.folder / "run.rank2.h5"
        shutil.copy(swapped, self.folder / "kept")

        def assert_refused(*parts):
            readers = [["detect", "run.h5"], ["diff", "run.h5", "run.h5"], ["info", "run.h5"]]
            if HAS_VIEWER:
                readers.append(["view", "run.h5", "--export", "run.html"])
            for arguments in readers:
                with self.subTest(arguments=arguments, parts=parts):
                    self.assert_one_line_error(self.run_here(*arguments), "run.rank2.h5: ", *parts)

        shutil.copy(self.folder / "other/run.rank2.h5", swapped)
        assert_refused("does not belong to run.h5, but to another run")
        swapped.unlink()
        assert_refused("is missing", "put all files of the recording into one folder")
        swapped.write_bytes((self.folder / "kept").read_bytes()[:-1000])
        assert_refused("cut short")
        shutil.copy(self.folder / "kept", swapped)
        self.assertEqual(self.detected(), whole)
        self.assert_one_line_error(self.run_here("info", "run.rank1.h5"), "has only the objects of one rank")

    def test_no_file_of_an_earlier_run_stays(self):
        self.record(3)
        self.record(2)
        self.assertEqual(self.files(), ["run.h5", "run.rank1.h5", "run.xdmf"])
        self.detected()
        self.record(0)
        self.assertEqual(self.files(), ["run.h5", "run.xdmf"])
        self.detected()

    def test_bodies_that_respond_are_in_one_file(self):
        """Each rank moves all of them."""
        scene = SCENES / "rabbit_pile.toml"
        self.record(0, "alone.h5", 4, scene)
        self.record(2, "run.h5", 4, scene)
        self.assertEqual(self.files(), ["alone.h5", "alone.xdmf", "run.h5", "run.xdmf"])
        self.assertEqual(self.detected(), self.detected("alone.h5"))

    def test_a_rank_without_objects_writes_no_file(self):
        self.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        scene = self.write("scene.toml", """
            [[object]]
            mesh = "a.obj"
            motion = { kind = "wave", velocity = [1, 0, 0] }
            """)
        self.record(3, scene=scene)
        self.assertIn(self.files(), [["a.obj", "run.h5", *rank, "run.xdmf", "scene.toml"]
                                     for rank in ([], ["run.rank1.h5"], ["run.rank2.h5"])])
        self.assertEqual(self.run_here("info", "run.h5").status, 0)

    def test_a_full_disk_of_one_rank(self):
        """A limit of the file size stops a rank in the same way."""
        limited = 'if [ $OMPI_COMM_WORLD_RANK = 1 ]; then ulimit -f 400; trap "" XFSZ; fi; exec "$@"'
        done = subprocess.run(
            [MPIEXEC, "-n", "2", "bash", "-c", limited, "bash", PROGRAM, "simulate", NINE, "--frames", "100000",
             "--record", "run.h5", "--quiet"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        errors = [line for line in done.stderr.splitlines() if line.startswith("supple: ")]
        self.assertEqual(len(errors), 1, done.stderr)
        self.assertRegex(errors[0], r"^supple: rank 1: run\.rank1\.h5: writing failed: .*; the recording ends after "
                                    r"its first \d+ frames, make room")
        frames = int(re.search(r"first (\d+) frames", errors[0])[1])
        self.assertEqual(self.detected().count('"frame":'), frames)

    def test_killed_jobs(self):
        """They leave the frames that all ranks have written."""
        for victims in ((1,), (0,), (0, 1)):
            for path in self.folder.iterdir():
                path.unlink()
            job = subprocess.Popen([MPIEXEC, "-n", "2", PROGRAM, "simulate", NINE, "--frames", "1000000", "--quiet",
                                    "--record", "run.h5"], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
            pids = [eventually(lambda rank=rank: pid_of_rank(rank, job.pid)) for rank in victims]
            eventually(lambda: "frame" in self.run_here("diff", "run.h5", "run.h5").out)
            for pid in pids:
                os.kill(pid, signal.SIGKILL)
            job.communicate(timeout=600)
            self.assertNotEqual(job.returncode, 0)
            done = self.run_here("diff", "run.h5", "run.h5")
            self.assertEqual((done.status, done.error), (0, ""))
            if h5py:
                with h5py.File(self.folder / "run.h5") as file:
                    frames = len(file["time"])
                    for place in file["objects"]:
                        self.assertGreaterEqual(len(file[f"objects/{place}/positions"]), frames)

    @with_h5py
    def test_the_example_that_makes_one_file(self):
        self.record(3)
        example = re.search(r"```python\n([^`]*expand_external[^`]*)```", PAGE)[1]
        done = subprocess.run([sys.executable, "-c", example], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for path in self.folder.glob("run.*"):
            path.rename(path.with_name(f"moved_{path.name}"))
        self.assertEqual(self.run_here("info", "one.h5").status, 0)
        self.detected("one.h5")


if __name__ == "__main__":
    unittest.main()
