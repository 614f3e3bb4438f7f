"""Tests `supple render`: pictures of scenes, recordings and meshes without a window."""

import json
import os
import pathlib
import re
import signal
import struct
import subprocess
import time
import unittest
import xml.etree.ElementTree
import zlib

from program import CAN_RENDER, HAS_VIEWER, PROGRAM, TRIANGLE, UPRIGHT, ProgramTest

BODY = """
[scene]
time_step = 0.01
[[object]]
model = "box"
motion = { kind = "mass_spring", random_speed = 5 }
"""


def chunks(png):
    """The chunks of a PNG file by name; those of the same name joined."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n", png[:8]
    found, at = {}, 8
    while at < len(png):
        length, name = struct.unpack_from(">I4s", png, at)
        data = png[at + 8 : at + 8 + length]
        assert zlib.crc32(name + data) == struct.unpack_from(">I", png, at + 8 + length)[0], name
        found[name.decode()] = found.get(name.decode(), b"") + data
        at += 12 + length
    return found


def pixels(png):
    """The rows of a PNG of 8 bits per channel, as lists of RGBA or RGB tuples."""
    parts = chunks(png)
    width, height, depth, colour = struct.unpack_from(">IIBB", parts["IHDR"])
    assert depth == 8 and colour in (2, 6), (depth, colour)
    channels = 4 if colour == 6 else 3
    data = zlib.decompress(parts["IDAT"])
    rows, above, length = [], bytes(channels * width), channels * width
    for y in range(height):
        kind, row = data[y * (length + 1)], bytearray(data[y * (length + 1) + 1 : (y + 1) * (length + 1)])
        for i in range(length):
            left = row[i - channels] if i >= channels else 0
            up = above[i]
            corner = above[i - channels] if i >= channels else 0
            guess = left + up - corner
            paeth = min((left, up, corner), key=lambda x: abs(guess - x))
            row[i] = (row[i] + (0, left, up, (left + up) // 2, paeth)[kind]) & 255
        rows.append([tuple(row[i : i + channels]) for i in range(0, length, channels)])
        above = row
    return rows


@unittest.skipUnless(HAS_VIEWER, "built without the viewer")
class RenderErrors(ProgramTest):
    """What is refused before a browser starts."""

    def setUp(self):
        super().setUp()
        self.mesh = self.write("a.obj", TRIANGLE)

    def refuse(self, *arguments, error, **environment):
        output = () if "-o" in arguments or "--output" in arguments else ("-o", "a.png")
        done = self.run_here("render", self.mesh, *arguments, *output, **environment)
        self.assert_one_line_error(done, *([error] if isinstance(error, str) else error))

    def test_no_browser(self):
        parts = ("there is no Chromium", "chromium-headless-shell", "--browser", "SUPPLE_CHROMIUM")
        self.refuse(error=parts, PATH="/nonexistent", SUPPLE_CHROMIUM="")
        self.refuse("--browser", "/nonexistent", error="--browser: /nonexistent: it is not a program")
        self.refuse(error="SUPPLE_CHROMIUM: /nonexistent: it is not a program", SUPPLE_CHROMIUM="/nonexistent")

    def test_a_program_that_is_no_browser(self):
        program = self.write("browser", "#!/bin/sh\necho this is no browser >&2\n")
        program.chmod(0o755)
        self.refuse("--browser", program, error=("the browser has ended", "this is no browser"))
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["a.obj", "browser"])

    def test_values(self):
        browser = {"SUPPLE_CHROMIUM": "/bin/true"}
        refused = (
            (("--frames", "3-1"), "'3-1' is not A, A-B or A-B:STEP"),
            (("--frames", "0-9:0"), "'0-9:0' is not"),
            (("--size", "0x10"), "'0x10' is not WIDTHxHEIGHT"),
            (("--size", "10x10.5"), "'10x10.5' is not WIDTHxHEIGHT"),
            (("--size", "20000x10"), "--size: the pictures would have 20000 x 10 pixels"),
            (("--size", "900x1mm", "--dpi", "600"), "--size: the pictures would have 21260 x 24 pixels"),
            (("--dpi", "5"), "--dpi"),
            (("--background", "black"), "'black' is not one of white, transparent, theme"),
            (("--theme", "dark"), "--theme: has no effect without --background theme"),
            (("-o", "a.jpg"), "a.jpg ends neither in .png nor in .svg"),
            (("-o", "a%s.png"), "write the place of the number once, as %d"),
            (("-o", "a.png", "--frames", "0-1"), "the pictures of several frames need different names"),
            (("-o", "a.svg", "--gpu"), "--gpu: has no effect without PNG files"),
            (("--view", "none.json"), "none.json: cannot be read"),
            (("--plot", "gap"), "'gap' is not one of pairs, contacts, times, pin-contacts, pin-gap"),
            (("--plot", "pairs"), "--plot: a simulation has no end; choose its steps, such as --frames 0-100"),
            (("--plot", "pairs", "--legend"), "--legend: has no effect without a picture of the scene"),
            (("--plot", "pairs", "--frames", "0-3", "-o", "a%d.svg"), "a plot is one picture"),
        )
        for arguments, error in refused:
            with self.subTest(arguments):
                self.refuse(*arguments, error=error, **browser)
        done = self.run_here("render", self.mesh, **browser)
        self.assert_one_line_error(done, "--output is required")

    def test_malformed_view(self):
        self.write("bad.json", '{"version": 1, "camera": {"zoom": -1}}')
        error = "bad.json: camera.zoom is not a finite number above 0"
        self.refuse("--view", "bad.json", error=error, SUPPLE_CHROMIUM="/bin/true")
        done = self.run_here("view", self.mesh, "--export", "page.html", "--view", "bad.json")
        self.assert_one_line_error(done, error)

    def test_an_input_is_not_overwritten(self):
        self.write("view.json", '{"version": 1}').rename(self.folder / "view.png")
        self.refuse(
            "--view", "view.png", "-o", "view.png", error="--view: --output already writes", SUPPLE_CHROMIUM="/bin/true"
        )


@unittest.skipUnless(CAN_RENDER, "there is no viewer or no Chromium")
class Render(ProgramTest):
    def setUp(self):
        super().setUp()
        self.temporary = self.folder / "temporary"
        self.temporary.mkdir()

    def environment(self):
        return {**os.environ, "TMPDIR": str(self.temporary)}

    def render(self, *arguments):
        done = self.run_here("render", *arguments, TMPDIR=str(self.temporary))
        self.assertEqual((done.status, done.error), (0, ""))
        self.assert_nothing_is_left()
        return done.out

    def assert_nothing_is_left(self):
        self.assertEqual(self.browsers(), [])
        self.assertEqual(list(self.temporary.iterdir()), [])

    def browsers(self):
        """The processes that have the profile of a browser of this test."""
        found = []
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if str(self.temporary).encode() in (process / "cmdline").read_bytes():
                    found.append(process.name)
            except OSError:  # it has ended
                pass
        return found

    def eventually(self, condition):
        end = time.monotonic() + 60
        while not condition():
            self.assertLess(time.monotonic(), end, "it takes too long")
            time.sleep(0.02)

    def picture(self, name):
        return (self.folder / name).read_bytes()

    def test_meshes(self):
        meshes = self.write("a.obj", TRIANGLE), self.write("b.obj", UPRIGHT)
        out = self.render(*meshes, "--size", "50.8x25.4mm", "--dpi", "100", "-o", "a.png")
        self.assertEqual(out, "a.png: 1 picture, 200 x 100 pixels\n")
        parts = chunks(self.picture("a.png"))
        self.assertEqual(struct.unpack_from(">II", parts["IHDR"]), (200, 100))
        self.assertEqual(struct.unpack(">IIB", parts["pHYs"]), (3937, 3937, 1))
        rows = pixels(self.picture("a.png"))
        self.assertEqual(rows[0][0][:3], (255, 255, 255))
        self.assertGreater(sum(pixel[:3] != (255, 255, 255) for row in rows for pixel in row), 200)

        self.render(*meshes, "--size", "200x100", "--background", "transparent", "-o", "clear.png", "--quiet")
        rows = pixels(self.picture("clear.png"))
        self.assertEqual(rows[0][0], (0, 0, 0, 0))
        self.assertGreater(sum(pixel[3] == 255 for row in rows for pixel in row), 200)

        self.render(*meshes, "--size", "200x100", "--legend", "--scale-bar", "-o", "drawn.png")
        drawn = pixels(self.picture("drawn.png"))
        self.assertNotEqual(drawn[35][35][:3], (255, 255, 255), "there is no legend")

    def test_simulation_each_step_in_the_same_bytes(self):
        scene = self.write("scene.toml", BODY)
        arguments = (scene, "--size", "160x120", "--frames", "2-6:2")
        self.assertIn("3 pictures", self.render(*arguments, "-o", "a_%03d.png"))
        self.render(*arguments, "--quiet", "-o", "b_%03d.png")
        files = sorted(path.name for path in self.folder.glob("*.png"))
        self.assertEqual(files, [f"{name}_{step:03}.png" for name in "ab" for step in (2, 4, 6)])
        for step in (2, 4, 6):
            self.assertEqual(self.picture(f"a_{step:03}.png"), self.picture(f"b_{step:03}.png"))
        self.assertEqual(len({self.picture(f"a_{step:03}.png") for step in (2, 4, 6)}), 3)

    def test_recording(self):
        scene = self.write("scene.toml", BODY)
        self.run_here("simulate", scene, "--frames", "11", "--record", "run.h5", "--quiet")
        self.write("view.json", json.dumps({"version": 1, "step": 7, "layers": {"wireframe": True}}))
        size = ("--size", "160x120")
        self.render("run.h5", *size, "--frames", "6-8", "-o", "%d.png", "--view", "view.json")
        self.render("run.h5", *size, "-o", "seventh.png", "--view", "view.json")
        self.assertEqual(self.picture("7.png"), self.picture("seventh.png"))
        self.assertNotEqual(self.picture("6.png"), self.picture("7.png"))
        done = self.run_here("render", "run.h5", "--frames", "5-11", "-o", "%d.png")
        self.assert_one_line_error(done, "--frames: 11 is no frame of run.h5, which has the frames 0 to 10")

    def test_svg(self):
        meshes = self.write("a.obj", TRIANGLE), self.write("b<.obj", UPRIGHT)
        self.render(*meshes, "--size", "100x50mm", "--legend", "-o", "a.svg")
        root = xml.etree.ElementTree.parse(self.folder / "a.svg").getroot()
        space = "{http://www.w3.org/2000/svg}"
        self.assertEqual((root.tag, root.get("height")), (space + "svg", "50.04mm"))
        self.assertEqual([text.text for text in root.iter(space + "text")], ["a", "b<"])
        self.assertEqual(len(list(root.iter(space + "path"))), 3, "two outlines and a contact segment")
        self.write("view.json", '{"version": 1, "marks": {"slice": "x"}}')
        done = self.run_here("render", *meshes, "--view", "view.json", "-o", "a.svg")
        self.assert_one_line_error(done, "An SVG cannot show a slice. Choose PNG, or no slice")

    def test_a_legend_has_no_object_that_a_field_covers(self):
        scene = self.write("scene.toml", BODY)
        self.write("view.json", '{"version": 1, "field": {"key": "speed"}}')
        arguments = ("--view", "view.json", "--size", "200x100", "--frames", "0-1", "--legend", "-o", "%d.png")
        self.render(scene, *arguments)
        swatches = [pixels(self.picture(f"{frame}.png"))[35][35][:3] for frame in (0, 1)]
        self.assertNotEqual(swatches[0], (255, 255, 255), "there are no speeds in the first frame")
        self.assertEqual(swatches[1], (255, 255, 255))

    def labels(self, name):
        """The texts of a plot and its lines, each with the number of its points."""
        space = "{http://www.w3.org/2000/svg}"
        root = xml.etree.ElementTree.parse(self.folder / name).getroot()
        lines = [path.get("d") for path in root.iter(space + "path") if path.get("stroke-width")]
        return [text.text for text in root.iter(space + "text")], [len(re.findall("[ML]", line)) for line in lines]

    def test_plots_of_a_simulation(self):
        scene = self.write("scene.toml", BODY)
        out = self.render(scene, "--frames", "2-12:5", "--plot", "contacts", "--size", "80x40mm", "-o", "a.svg")
        self.assertIn("a.svg: 1 picture", out)
        labels, points = self.labels("a.svg")
        self.assertEqual((labels[0], points), ("Contacts and candidates", [3, 3]))
        self.assertLessEqual({"step", "contacts", "candidate pairs", "4", "12"}, set(labels))
        self.render(scene, "--frames", "0-3", "--plot", "times", "--size", "300x150", "--dpi", "100", "-o", "a.png")
        parts = chunks(self.picture("a.png"))
        self.assertEqual(struct.unpack_from(">II", parts["IHDR"]), (300, 150))
        self.assertEqual(struct.unpack(">IIB", parts["pHYs"]), (3937, 3937, 1))

    def test_plots_of_a_recording(self):
        scene = self.write("scene.toml", BODY)
        self.run_here("simulate", scene, "--frames", "11", "--record", "run.h5", "--quiet")
        self.render("run.h5", "--plot", "pairs", "-o", "pairs.svg")
        labels, points = self.labels("pairs.svg")
        self.assertEqual(points, [11])
        self.assertLessEqual({"frame", "object pairs", "10"}, set(labels))
        self.write("view.json", '{"version": 1, "pins": {"1": {"a": "box"}}}')
        self.render("run.h5", "--plot", "pin-displacement", "--frames", "2-6", "--view", "view.json", "-o", "pin.svg")
        labels, points = self.labels("pin.svg")
        self.assertEqual(points, [5])
        self.assertIn("box", labels)
        done = self.run_here("render", "run.h5", "--plot", "pin-gap", "-o", "none.svg")
        self.assert_one_line_error(done, "The view file has no pin of an object of this scene")
        self.assertFalse((self.folder / "none.svg").exists())

    def test_where_it_cannot_be_written(self):
        mesh = self.write("a.obj", TRIANGLE)
        for name, *plot in (("none/a.png",), ("temporary.png",), ("none/a.svg", "--plot", "pairs", "--frames", "0-1")):
            (self.folder / "temporary.png").mkdir(exist_ok=True)
            done = self.run_here("render", mesh, *plot, "-o", name, TMPDIR=str(self.temporary))
            self.assert_one_line_error(done, f"{name}: cannot write", "choose a writable folder")
            self.assert_nothing_is_left()

    def test_a_motion_that_blows_up_keeps_its_pictures(self):
        scene = self.write(
            "scene.toml",
            BODY.replace("random_speed = 5", 'integrator = "verlet", stiffness = 1e9, random_speed = 5'),
        )
        done = self.run_here("render", scene, "--size", "80x60", "--frames", "0-5000", "-o", "%d.png")
        self.assert_one_line_error(done, "The session has failed", "of 5,001 pictures are saved")
        self.assertTrue((self.folder / "0.png").exists())
        done = self.run_here("render", scene, "--frames", "0-5000", "--plot", "pairs", "-o", "pairs.svg")
        self.assert_one_line_error(done, "The session has failed", "; the plot ends at step ")
        last = int(done.error.split()[-1])
        self.assertEqual(self.labels("pairs.svg")[1], [last + 1])

    def start(self):
        scene = self.write("scene.toml", BODY)
        arguments = [PROGRAM, "render", scene, "--size", "160x120", "--frames", "0-100000", "-o", "a_%06d.png"]
        process = subprocess.Popen(
            arguments, cwd=self.folder, env=self.environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        self.eventually(lambda: list(self.folder.glob("a_*.png")) or process.poll() is not None)
        return process

    def test_interrupted(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            process = self.start()
            process.send_signal(number)
            out, error = process.communicate(timeout=600)
            self.assertEqual((process.returncode, out), (128 + number, ""))
            self.assertRegex(error, r"^supple: interrupted after \d+ of 100,001 pictures\n$")
            self.assert_nothing_is_left()
            for path in self.folder.glob("a_*"):
                self.assertRegex(path.name, r"^a_\d{6}\.png$")
                chunks(path.read_bytes())
                path.unlink()

    def test_no_browser_is_left_when_the_program_is_killed(self):
        process = self.start()
        self.assertNotEqual(self.browsers(), [])
        process.kill()
        process.communicate()
        self.eventually(lambda: self.browsers() == [])

    def test_a_browser_that_is_killed(self):
        process = self.start()
        for number in self.browsers():
            try:
                os.kill(int(number), signal.SIGKILL)
            except ProcessLookupError:
                pass
        _, error = process.communicate(timeout=600)
        self.assertEqual(process.returncode, 2)
        self.assertRegex(error, r"^supple: .*(the browser has ended|the page has ended).*are saved\n$")
        self.assert_nothing_is_left()


if __name__ == "__main__":
    unittest.main()
