"""Tests recordings as they are written: a killed process leaves a valid file, also while others read it, and h5py
reads the structure that docs/recording.md describes."""

import json
import os
import random
import re
import resource
import signal
import struct
import subprocess
import sys
import time
import unittest
import xml.etree.ElementTree

from program import PROGRAM, ROOT, ProgramTest
from recordings import RECORD, SOLIDS, RecordingTest, datasets, datasets_of, h5py, numpy, with_h5py

PAGE = (ROOT / "docs/recording.md").read_text()
takes_long = unittest.skipUnless(os.environ.get("SUPPLE_LONG_TESTS"), "takes long; the test cli.recording_stopped runs it")


class Killed(RecordingTest):
    """After a kill, h5py and this program read every frame of the last flush."""

    FLUSHES = ("--frames-between-flushes", 5)

    FRAMES = 600

    def setUp(self):
        super().setUp()
        self.record("whole.h5", self.FRAMES)
        if h5py:
            self.whole = datasets_of(self.folder / "whole.h5")

    def check(self, output):
        flushed = [int(line) for line in output.split("\n")[:-1] if line.isdigit()]
        path = self.folder / "killed.h5"
        if not path.exists():
            self.assertEqual(flushed, [])
            return
        if h5py:
            self.assert_first_frames(path, self.whole, max(flushed, default=0))
        done = self.run_here("diff", "whole.h5", "killed.h5", "--json", "-")
        self.assertEqual((done.status, done.error), (1, ""))
        result = json.loads(done.out)
        self.assertGreaterEqual(result["frames"][1], max(flushed, default=0))
        self.assertEqual(result["what"], "number of frames: {} and {}".format(self.FRAMES, result["frames"][1]))
        path.unlink()

    def test_at_random_moments(self):
        # Records fewer frames than the whole recording has: on a busy machine a pause can take long.
        frames = self.FRAMES - 1
        moments = random.Random(7)
        for _ in range(30):
            with subprocess.Popen([RECORD, "killed.h5", str(frames), *map(str, self.FLUSHES), "--pause", "200"],
                                  cwd=self.folder, stdout=subprocess.PIPE, text=True) as process:
                time.sleep(moments.uniform(0.005, 0.12))
                process.send_signal(signal.SIGKILL)
                output = process.stdout.read()
            self.check(output)

    def test_read_while_it_is_recorded(self):
        reads = 0
        with subprocess.Popen([RECORD, "growing.h5", "2000", "--frames-between-flushes", "1", "--pause", "100"],
                              cwd=self.folder, stdout=subprocess.PIPE, text=True) as process:
            process.stdout.readline()  # the first frames are there
            while process.poll() is None:
                done = self.run_here("diff", "whole.h5", "growing.h5", "--json", "-")
                self.assertEqual(done.error, "")
                self.assertRegex(json.loads(done.out)["what"] or "number of frames", "^number of frames")  # no values
                reads += 1
            process.stdout.read()
        self.assertGreater(reads, 0)

    def test_disk_full(self):
        for number in (0, 100, 400, 1000):
            path = self.folder / "killed.h5"
            path.unlink(missing_ok=True)
            done = self.record("killed.h5", 600, *self.FLUSHES, "--fail-at", number, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn("killed.h5: ", done.stderr)
            self.assertIn("No space left on device", done.stderr)
            self.assertFalse((self.folder / "killed.h5.part").exists())
            self.check(done.stdout)

    def test_file_size_limit(self):
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, 1 << 20))

        done = self.record("killed.h5", 600, *self.FLUSHES, check=False, preexec_fn=limit)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"^killed\.h5: writing failed: .* the recording ends after its first \d+ frames")
        self.check(done.stdout)


class SmallDisk(ProgramTest):
    """A limit of the file size stops a recording in the same way as a disk that is full."""

    def record(self, frames, limit):
        preexec = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        command = [PROGRAM, "simulate", ROOT / "scenes/nine.toml", "--frames", str(frames), "--record", "run.h5", "--quiet"]
        return subprocess.run(command, cwd=self.folder, preexec_fn=preexec, capture_output=True, text=True)

    def size_with(self, frames):
        self.assertEqual(self.record(frames, resource.RLIM_INFINITY).returncode, 0)
        return (self.folder / "run.h5").stat().st_size

    def test_frames_that_fit_are_kept(self):
        sizes = {fit: self.size_with(fit) for fit in (1, 9, 40)}
        for fit, size in sizes.items():
            done = self.record(100, size + (1 << 16))
            self.assertEqual(done.returncode, 2)
            kept = re.fullmatch(r"supple: run\.h5: writing failed: File too large; the recording ends after its first "
                                r"(\d+) frames, make room and record again\n", done.stderr)
            self.assertTrue(kept, done.stderr)
            self.assertGreaterEqual(int(kept[1]), fit * 8 // 9)
            read = self.run_here("detect", "run.h5", "--json", "-", "--no-stats")
            self.assertEqual((read.status, read.error), (0, ""))
            self.assertEqual(len(json.loads(read.out)["frames"]), int(kept[1]))


class Stopped(RecordingTest):
    """Repeats the recorder's file operations and checks the file after each write and within writes."""

    PAGE = 4096  # a kill interrupts a write only at the end of a memory page

    def log_of(self, *arguments):
        """The log of the file operations of a recording, as described in
        tests/recording/record_motion.cpp."""
        self.record("logged.h5", *arguments, "--log", "log")
        log = (self.folder / "log").read_bytes()
        place = 0
        while place < len(log):
            kind, first, second, size = struct.unpack_from("=4q", log, place)
            place += 32
            yield kind, first, second, log[place : place + size]
            place += size

    def ends_of(self, address, size):
        """The positions where a write may end: at its end and at some of the pages that it crosses."""
        crossed = range((address // self.PAGE + 1) * self.PAGE, address + size, self.PAGE)
        cuts = {crossed[0], crossed[len(crossed) // 2], crossed[-1]} if crossed else set()
        return [*sorted(cuts), address + size]

    def states(self, log):
        """Applies the logged operations one by one. Yields the number of flushed frames after each of them,
        or None while the recording has no name."""
        entries = list(log)
        recording = next(file for kind, file, _, data in entries if kind == 0 and data.startswith(b"\x89HDF"))
        flushed = None
        with open(self.folder / "stopped.h5", "w+b", buffering=0) as file:
            for kind, number, address, data in entries:
                if kind == 2:
                    flushed = number
                elif number == recording and kind == 1:
                    file.truncate(address)
                    yield flushed
                elif number == recording:
                    done = address
                    for end in self.ends_of(address, len(data)):
                        os.pwrite(file.fileno(), data[done - address : end - address], done)
                        done = end
                        yield flushed

    def check_each_state(self, frames, *arguments, from_frame=0, least):
        """Checks all states after `from_frame` flushed frames; there must be more than `least`."""
        self.record("whole.h5", frames, *arguments)
        whole = datasets_of(self.folder / "whole.h5")
        checked = 0
        for flushed in self.states(self.log_of(frames, *arguments, "--frames-between-flushes", 5)):
            if flushed is None or flushed < from_frame:
                continue
            with self.subTest(state=checked, flushed=flushed):
                self.assert_first_frames(self.folder / "stopped.h5", whole, flushed)
            checked += 1
        self.assertGreater(checked, least)
        self.assertEqual(self.assert_first_frames(self.folder / "stopped.h5", whole, frames), frames)

    @with_h5py
    @takes_long
    def test_at_each_write(self):
        self.check_each_state(3, least=300)

    @with_h5py
    def test_when_chunk_indexes_split(self):
        """A node of the chunk index has 64 entries, one per frame."""
        self.check_each_state(65, "--contacts", "none", from_frame=60, least=100)

    @with_h5py
    @takes_long
    def test_when_columns_get_another_chunk(self):
        """Chunks have 1024 frames."""
        self.check_each_state(1025, "--contacts", "none", from_frame=1020, least=100)


class Document(RecordingTest):
    """Compares docs/recording.md with a file, in both directions."""

    def setUp(self):
        super().setUp()
        self.record("run.h5", 30)
        self.record("moving.h5", 30, "--contacts", "continuous")

    @with_h5py
    def test_every_dataset(self):
        documented = {}
        for path, others, shape, kind in re.findall(r"^\| `([\w/]+)`((?:, `\w+`)*) \| \((.*?)\) \| (text|\w+\d+) \|", PAGE, re.M):
            group = path.rpartition("/")[0]
            for each in (path, *(f"{group}/{name}" for name in re.findall(r"\w+", others))):
                documented[each] = (shape, kind)
        for group, objects in re.findall(r"^\| `([\w/]+)/end`((?:, `object_[ab]`)*) \|", PAGE, re.M):
            documented[f"{group}/end"] = ("F", "uint64")
            documented.update({f"{group}/{name}": ("rows", "uint32") for name in re.findall(r"\w+", objects)})
        with h5py.File(self.folder / "run.h5", "r") as file:
            found = {re.sub(r"^objects/\d+", "objects/0", path) for path in datasets(file)}
            self.assertEqual(set(documented), found)
            frame_count, (n, _) = len(file["time"]), file["objects/0/rest_positions"].shape
            m = len(file["objects/0/triangles"])
            for path, (shape, kind) in documented.items():
                stored = file[path]
                if kind == "text":
                    self.assertEqual((stored.dtype.kind, stored.shape), ("S", ()), path)
                    continue
                self.assertEqual(stored.dtype, numpy.dtype(kind), path)
                symbols = {"F": frame_count, "n": n, "m": m, "k": stored.shape[0], "rows": stored.shape[0]}
                sizes = tuple(symbols[s] if s in symbols else int(s) for s in shape.split(", "))
                self.assertEqual(stored.shape, sizes, path)

    @with_h5py
    def test_every_attribute(self):
        file_part, object_part = PAGE.split("### Attributes of an object")
        kinds = {"text": "S", "uint8": "u1", "uint32": "u4", "float64": "f8"}
        with h5py.File(self.folder / "run.h5", "r") as file:
            for part, group in ((file_part, file), (object_part.split("### Datasets")[0], file["objects/2"])):
                documented = {}
                for names, kind in re.findall(r"^\| (`[\w`, ]+`) \| (\w+) \|", part, re.M):
                    documented.update(dict.fromkeys(re.findall(r"`(\w+)`", names), kind))
                documented.pop("ranks", None)  # only of recordings by several ranks
                self.assertEqual(set(documented), set(group.attrs))
                for name, kind in documented.items():
                    stored = group.attrs.get_id(name).dtype
                    self.assertEqual(stored.kind if kind == "text" else stored.str[1:], kinds[kind], name)
            self.assertEqual(file["objects/2"].attrs["name"].decode(), "cloth é")
            self.assertTrue(file.attrs["program_version"].decode().count(".") == 2)

    @with_h5py
    def test_example(self):
        example = re.search(r"```python\n(.*?)```", PAGE, re.S)[1]
        done = subprocess.run([sys.executable, "-c", example], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        lines = done.stdout.splitlines()
        self.assertEqual(lines[0], "supple recording 4 intersection")
        contacts = [len(f["contacts"]) for f in self.detect("run.h5", "--contact-details")["frames"]]
        told = [int(line.split(" s: ")[1].split(" contacts")[0]) for line in lines[1:]]
        self.assertEqual(told, [count for count in contacts if count > 0])
        self.assertGreater(sum(told), 0)

    @with_h5py
    def test_example_of_penetration(self):
        self.write("solids.toml", SOLIDS)
        done = self.run_here("simulate", "solids.toml", "--frames", 8, "--quiet", "--record", "run.h5", "--json", "run.json", "--contact-details")
        self.assertEqual((done.status, done.error), (0, ""))
        example = re.findall(r"```python\n(.*?)```", PAGE, re.S)[1]
        done = subprocess.run([sys.executable, "-c", example], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        expected = []
        for frame in json.loads((self.folder / "run.json").read_text())["frames"]:
            time = f"{frame['frame'] * 0.25:.3f} s: "
            for group in frame["penetration"]:
                if group["vertices"]:
                    expected.append(f"{time}{len(group['vertices'])} vertices of object {group['a']} inside object {group['b']}, "
                                    f"the deepest at {max(depth for _, _, depth in group['vertices']):g}")
            for curve in frame["curves"]:
                first = numpy.array(curve["pairs"][0], numpy.uint32)
                expected.append(f"{time}{curve['kind']} curve of {curve['segments']} pairs, {first} first")
        self.assertEqual(done.stdout.splitlines(), expected)
        self.assertGreater(len(expected), 16)

    def test_xdmf(self):
        for name in ("run", "moving"):
            root = xml.etree.ElementTree.parse(self.folder / f"{name}.xdmf").getroot()
            (series,) = root.find("Domain").findall("Grid")
            steps = series.findall("Grid")
            self.assertEqual([float(s.find("Time").get("Value")) for s in steps], [f / 128 for f in range(30)])
            for frame, step in enumerate(steps):
                grids = step.findall("Grid")
                self.assertEqual([g.get("Name") for g in grids], ["sphere", "box", "cloth é"])
                for place, grid in enumerate(grids):
                    slab = grid.find("Geometry/DataItem")
                    selection, source = slab.findall("DataItem")
                    self.assertEqual(source.text, f"{name}.h5:/objects/{place}/positions")
                    self.assertEqual(selection.text.split()[0], str(0 if place == 1 else frame))
                    self.assertEqual(grid.find("Topology/DataItem").text, f"{name}.h5:/objects/{place}/triangles")


if __name__ == "__main__":
    unittest.main()
