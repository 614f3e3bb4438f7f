"""What the tests of recordings share."""

import importlib.util
import os
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
    h5py = numpy = None

from program import ROOT, ProgramTest

RECORD = os.environ.get("SUPPLE_RECORD_MOTION", str(ROOT / "build/release/bin/record_motion"))
with_h5py = unittest.skipUnless(h5py, "needs h5py")


def datasets(file):
    """The path and values of every dataset."""
    found = {}
    file.visititems(lambda path, item: found.update({path: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


def datasets_of(path):
    with h5py.File(path, "r") as file:
        return datasets(file)


def rows_in(path, values, frame_count):
    """The number of rows of a dataset for the first frames; None if it does not depend on frames."""
    if path == "scene_file" or path.endswith(("/rest_positions", "/triangles", "/edges", "/points")):
        return None
    if path == "objects/1/positions":  # static
        return min(frame_count, 1)
    group = path.rpartition("/")[0]
    if not path.endswith("/end") and f"{group}/end" in values:
        return int(values[f"{group}/end"][frame_count - 1]) if frame_count else 0
    return frame_count


class RecordingTest(ProgramTest):
    def record(self, name, *arguments, check=True, **options):
        done = subprocess.run([RECORD, name, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              **options)
        if check:
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done

    def recorded(self, file, frame, group, *columns):
        end = file[f"{group}/end"]
        rows = slice(end[frame - 1] if frame else 0, end[frame])
        return [tuple(row) for row in zip(*(file[f"{group}/{column}"][rows].tolist() for column in columns))]

    def assert_first_frames(self, path, whole, at_least):
        """Expects that the file opens and has the first frames of `whole`, the values of datasets."""
        values = datasets_of(path)
        frame_count = len(values["time"])
        self.assertGreaterEqual(frame_count, at_least)
        self.assertEqual(values.keys(), whole.keys())
        for name, expected in whole.items():
            if name.endswith("_seconds"):
                continue
            count = rows_in(name, whole, frame_count)
            if count is None:
                self.assertTrue(numpy.array_equal(values[name], expected), name)
            else:
                self.assertGreaterEqual(len(values[name]), count, name)
                self.assertTrue(numpy.array_equal(values[name][:count], expected[:count]), name)
        return frame_count


SOLIDS = """[scene]
time_step = 0.25
contacts = "penetration"
[[object]]
name = "box"
model = "box"
size = [2, 2, 2]
resolution = 3
solid = true
static = true
[[object]]
name = "ball"
model = "icosphere"
frequency = 4
translate = [-2.25, 0.875, 0.875]
solid = true
motion = { kind = "wave", velocity = [1, 0, 0], amplitude = 0.0625 }
[[object]]
name = "small"
model = "icosphere"
frequency = 2
scale = 0.25
translate = [1.5, -0.125, 0.0625]
solid = true
motion = { kind = "wave", velocity = [-2, 0, 0] }
[[object]]
name = "cloth"
model = "cloth"
columns = 4
rows = 4
translate = [0.9375, -0.75, 0.03125]
motion = { kind = "wave", amplitude = 0.03125 }
"""
