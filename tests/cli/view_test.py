"""Tests the viewer as scripts and browsers use it: printed text, access control, exported pages."""

import base64
import gzip
import json
import os
import pathlib
import re
import select
import signal
import socket
import struct
import subprocess
import unittest
import urllib.error
import urllib.parse
import urllib.request

from program import PROGRAM, TRIANGLE, UPRIGHT, ProgramTest, moved

MODULE = os.environ.get("SUPPLE_VIEWER_MODULE", "")
HAS_VIEWER = bool(MODULE)
needs_viewer = unittest.skipUnless(HAS_VIEWER, "built without the viewer")

BODY = """
[scene]
time_step = 0.01
[[object]]
model = "box"
motion = { kind = "mass_spring", random_speed = 0.5 }
"""


class WebSocket:
    """The client end of a connection: sends texts, receives messages."""

    def __init__(self, url, path="/session"):
        host, query = re.fullmatch(r"http://([^/]*)/\?(.*)", url).groups()
        name, port = host.rsplit(":", 1)
        self.socket = socket.create_connection((name, int(port)), timeout=600)
        request = f"GET {path}?{query} HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nUpgrade: websocket\r\n"
        request += "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
        self.socket.sendall(request.encode())
        self.file = self.socket.makefile("rb")
        self.status = int(self.file.readline().split()[1])
        while self.file.readline() not in (b"\r\n", b""):
            pass

    def close(self):
        self.file.close()
        self.socket.close()

    def send(self, **command):
        text = json.dumps(command).encode()
        assert len(text) < 126
        # A mask of zeros does not change the text.
        self.socket.sendall(bytes([0x81, 0x80 | len(text), 0, 0, 0, 0]) + text)

    def receive(self):
        """Returns the bytes of a message, or the code if the server closes."""
        first, length = self.file.read(2)
        if length == 126:
            (length,) = struct.unpack(">H", self.file.read(2))
        elif length == 127:
            (length,) = struct.unpack(">Q", self.file.read(8))
        data = self.file.read(length)
        return struct.unpack(">H", data[:2])[0] if first & 15 == 8 else data

    def receive_text(self, kind):
        """Returns the JSON of the next message of a kind."""
        while True:
            message = self.receive()
            assert not isinstance(message, int), f"closed with {message}"
            if struct.unpack_from("<H", message, 6)[0] != kind:
                continue
            place = 16
            while struct.unpack_from("<I", message, place)[0] != 1:
                place += 16 + (struct.unpack_from("<I", message, place + 12)[0] + 15) // 16 * 16
            length = struct.unpack_from("<I", message, place + 12)[0]
            return json.loads(message[place + 16 : place + 16 + length])


SCENE, FRAME, ANSWER, FAILURE, SERIES = range(1, 6)


class ViewTest(ProgramTest):
    def start(self, *arguments, **environment):
        """Starts a server; returns the process and its address."""
        clean = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
        process = subprocess.Popen(
            [PROGRAM, "view", *map(str, arguments)],
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**clean, **environment},
        )
        self.addCleanup(self.stop, process)
        ready, _, _ = select.select([process.stdout], [], [], 60)
        self.assertTrue(ready, "prints no address")
        line = process.stdout.readline()
        self.assertRegex(line, r"^Open http://[^ ]*:\d+/\?token=[0-9a-f]{32}\n$", process.stderr.read() if not line else "")
        return process, line.split()[1]

    def stop(self, process):
        process.kill()
        process.communicate()

    def connect(self, url):
        page = WebSocket(url)
        self.addCleanup(page.close)
        self.assertEqual(page.status, 101)
        return page

    def seek(self, page, frame):
        """Stops a recording at a frame for later commands and returns the JSON of that frame."""
        page.send(do="pause")
        page.send(do="seek", frame=frame)
        while True:
            page.send(do="credit", frames=1)
            told = page.receive_text(FRAME)
            if told["step"] == frame and not told["playing"]:
                return told


class WithoutViewer(ProgramTest):
    @unittest.skipIf(HAS_VIEWER, "built with the viewer")
    def test_it_says_how_to_get_it(self):
        self.write("a.obj", TRIANGLE)
        self.assert_one_line_error(self.run_here("view", "a.obj"), "without the viewer", "-DSUPPLE_BUILD_VIEWER=ON", "npm")


@needs_viewer
class Serve(ViewTest):
    def test_page_session_and_end(self):
        self.write("a.obj", TRIANGLE)
        self.write("b.obj", UPRIGHT)
        process, url = self.start("a.obj", "b.obj", "--no-open")
        with urllib.request.urlopen(url) as answer:
            self.assertIn("<!doctype html>", answer.read().decode().lower())
        page = self.connect(url)
        scene = page.receive_text(SCENE)
        self.assertEqual(scene["source"], "simulation")
        self.assertEqual([o["name"] for o in scene["objects"]], ["a", "b"])
        page.send(do="credit", frames=1)
        self.assertEqual(page.receive_text(FRAME)["step"], 0)
        process.send_signal(signal.SIGINT)
        self.assertEqual(page.receive(), 4002)
        self.assertEqual((process.communicate(), process.returncode), (("", ""), 0))

    def test_warnings_are_those_of_simulate(self):
        self.write("stiff.toml", BODY.replace("random_speed", "stiffness = 1e7, random_speed"))
        _, url = self.start("stiff.toml", "--no-open")
        (warning,) = self.connect(url).receive_text(SCENE)["warnings"]
        done = self.run_here("simulate", "stiff.toml", "--steps", "1", "--quiet")
        self.assertEqual(done.error.splitlines()[0], f"supple: warning: stiff.toml: {warning}")

    def test_token(self):
        self.write("a.obj", TRIANGLE)
        _, url = self.start("a.obj")
        for other in (url[:-32], url[:-32] + "0" * 32, url[:-1]):
            with self.assertRaises(urllib.error.HTTPError) as refused:
                urllib.request.urlopen(other)
            self.assertEqual(refused.exception.code, 403)
            refused.exception.close()

    def test_sigterm_ends_it_too_and_a_port_can_be_chosen(self):
        self.write("a.obj", TRIANGLE)
        with socket.create_server(("127.0.0.1", 0)) as other:
            port = other.getsockname()[1]
            self.assert_one_line_error(self.run_here("view", "a.obj", "--port", port), str(port), "already in use", "choose another port")
        process, url = self.start("a.obj", "--port", port)
        self.assertTrue(url.startswith(f"http://127.0.0.1:{port}/"))
        process.send_signal(signal.SIGTERM)
        process.communicate()
        self.assertEqual(process.returncode, 0)

    def test_options_reach_the_session(self):
        self.write("scene.toml", BODY)
        _, url = self.start("scene.toml", "--seed", 2**64 - 1, "--time-step", 0.002, "--bounding-volume", "sphere", "--self", "--max-level", 5,
                            "--leaf-size", 9, "--broad-phase", "sweep", "--contacts", "continuous")
        scene = self.connect(url).receive_text(SCENE)
        for key, value in (("seed", str(2**64 - 1)), ("time_step", 0.002), ("bounding_volume", "sphere"), ("max_level", 5), ("leaf_size", 9),
                           ("broad_phase", "sweep"), ("contacts", "continuous"), ("title", "scene.toml")):
            self.assertEqual(scene[key], value, key)
        self.assertTrue(scene["objects"][0]["self_collision"])
        self.assertTrue(scene["objects"][0]["body"])

    def test_memory_of_commands_is_limited(self):
        self.write("scene.toml", BODY)
        for arguments, answer in ((("--max-memory", 0), FAILURE), ((), SCENE)):
            _, url = self.start("scene.toml", *arguments)
            page = self.connect(url)
            page.receive_text(SCENE)
            page.send(do="set", objects=50)
            told = page.receive_text(answer)
            if answer == FAILURE:
                self.assertIn("larger --max-memory", told["message"])
            else:
                self.assertEqual(len(told["objects"]), 50)
        self.assert_one_line_error(self.run_here("view", "scene.toml", "--max-memory", 5, "--export", "page.html"), "--max-memory")

    def test_recording(self):
        self.write("scene.toml", BODY + '[[object]]\nmodel = "box"\ntranslate = [0.9, 0, 0]\n')
        self.assertEqual(self.run_here("simulate", "scene.toml", "--frames", 6, "--record", "run.h5", "--quiet").status, 0)
        _, url = self.start("run.h5")
        page = self.connect(url)
        scene = page.receive_text(SCENE)
        self.assertEqual((scene["source"], scene["frames"], scene["series"][0]), ("recording", 6, "time"))
        series = page.receive()
        self.assertEqual(struct.unpack_from("<H", series, 6)[0], SERIES)
        tag, _, count = struct.unpack_from("<3I", series, 16)
        self.assertEqual((tag, count), (64, 6))
        rows = struct.unpack_from(f"<{6 * len(scene['series'])}d", series, 32)
        times = rows[:: len(scene["series"])]
        for i, time in enumerate(times):
            self.assertAlmostEqual(time, 0.01 * i)
        contacts = rows[scene["series"].index("contacts") :: len(scene["series"])]
        self.assertGreater(contacts[0], 0)
        self.assertEqual(self.seek(page, 4)["step"], 4)

    def test_two_recordings_are_compared(self):
        body = BODY + '[[object]]\nmodel = "box"\ntranslate = [0.9, 0, 0]\n'
        for name, seed in (("a.h5", 1), ("same.h5", 1), ("b.h5", 2)):
            self.write("scene.toml", body)
            self.assertEqual(self.run_here("simulate", "scene.toml", "--frames", 6, "--seed", seed, "--record", name, "--quiet").status, 0)
        _, url = self.start("a.h5", "--compare", "b.h5")
        page = self.connect(url)
        scene = page.receive_text(SCENE)
        told = scene["comparison"]
        self.assertEqual((told["names"], told["objects_of_a"]), (["a.h5", "b.h5"], 2))
        difference = json.loads(self.run_here("diff", "a.h5", "b.h5", "--json", "-").out)
        self.assertEqual((told["frame"], told["text"]), (difference["frame"], difference["what"]))
        self.assertEqual([o["name"][-3:] for o in scene["objects"]], ["(A)", "(A)", "(B)", "(B)"])
        self.assertIn("contacts_b", scene["series"])
        self.assertEqual(self.seek(page, 4)["step"], 4)
        _, url = self.start("a.h5", "--compare", "same.h5")
        told = self.connect(url).receive_text(SCENE)["comparison"]
        self.assertEqual((told["frame"], told["text"]), (None, ""))
        self.write("a.obj", TRIANGLE)
        self.assert_one_line_error(self.run_here("view", "a.obj", "--compare", "b.h5"), "a.obj is not a recording")
        self.assert_one_line_error(self.run_here("view", "a.h5", "--compare", "a.obj"), "a.obj is not a recording")
        self.assert_one_line_error(self.run_here("view", "a.h5", "--tolerance", 1), "--compare")
        self.assert_one_line_error(self.run_here("view", "a.h5", "--compare", "missing.h5"), "missing.h5")

    def test_a_recording_that_grows_is_followed(self):
        self.write("scene.toml", BODY)
        self.assertEqual(self.run_here("simulate", "scene.toml", "--frames", 3, "--record", "run.h5", "--quiet").status, 0)
        _, url = self.start("run.h5", "--follow")
        page = self.connect(url)
        self.assertEqual(page.receive_text(SCENE)["frames"], 3)
        page.send(do="credit", frames=1)
        told = page.receive_text(FRAME)
        self.assertEqual((told["range"], told["playing"]), ([0, 2], True))
        self.assertEqual(self.run_here("simulate", "scene.toml", "--frames", 7, "--record", "run.h5", "--quiet").status, 0)
        while told["range"] != [0, 6]:
            page.send(do="credit", frames=1)
            told = page.receive_text(FRAME)
        self.write("scene.toml", BODY + '[[object]]\nmodel = "box"\ntranslate = [0.9, 0, 0]\n')
        self.assertEqual(self.run_here("simulate", "scene.toml", "--frames", 9, "--record", "run.h5", "--quiet").status, 0)
        self.assertIn("recorded again", page.receive_text(FAILURE)["message"])
        self.write("a.obj", TRIANGLE)
        self.assert_one_line_error(self.run_here("view", "a.obj", "--follow"), "--follow", "not a recording")

    def test_sequence(self):
        for i in range(12):
            self.write(f"frame_{i}.obj", moved(TRIANGLE, 0.1 * i, 0, 0))
        _, url = self.start("--sequence", "frame_*.obj", "--time-step", "0.5")
        page = self.connect(url)
        scene = page.receive_text(SCENE)
        self.assertEqual((scene["frames"], scene["time_step"]), (12, 0.5))
        self.seek(page, 11)
        page.send(do="read", object=0, vertex=0, id=1)
        self.assertAlmostEqual(page.receive_text(ANSWER)["position"][0], 1.1)  # the last file, not frame_9

    def test_files_and_waves_of_one_scene(self):
        self.write("frame_0.obj", TRIANGLE)
        self.write("frame_1.obj", moved(TRIANGLE, 0, 0, 1))
        frames = '[[object]]\nmotion = { kind = "frames", files = "frame_*.obj" }\n'
        self.write("both.toml", frames + '[[object]]\nmodel = "box"\nmotion = { kind = "wave", amplitude = 0.1, velocity = [1, 0, 0] }\n')
        _, url = self.start("both.toml")
        page = self.connect(url)
        self.assertEqual(page.receive_text(SCENE)["frames"], 2)
        self.seek(page, 0)
        page.send(do="read", object=1, vertex=0, id=1)
        before = page.receive_text(ANSWER)["position"]
        self.seek(page, 1)
        page.send(do="read", object=1, vertex=0, id=2)
        self.assertNotEqual(page.receive_text(ANSWER)["position"], before)
        page.send(do="read", object=0, vertex=0, id=3)
        self.assertEqual(page.receive_text(ANSWER)["position"], [0, 0, 1])

        self.write("mixed.toml", BODY + frames)
        self.assert_one_line_error(self.run_here("view", "mixed.toml"), "mixed.toml", "record them first", "supple simulate mixed.toml --record run.h5")

    def test_other_interfaces_only_with_a_warning(self):
        self.write("a.obj", TRIANGLE)
        process, url = self.start("a.obj", "--host", "0.0.0.0")
        # The address of this machine in its network, which other machines reach; without a network, the loopback address.
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.connect(("192.0.2.1", 9))  # sends nothing
                expected = probe.getsockname()[0]
            except OSError:
                expected = "127.0.0.1"
        self.assertEqual(urllib.parse.urlsplit(url).hostname, expected)
        self.assertEqual(urllib.request.urlopen(url).status, 200)
        process.send_signal(signal.SIGINT)
        _, error = process.communicate()
        self.assertEqual(len(error.splitlines()), 1)
        for part in ("warning", "--host 0.0.0.0", "see and control"):
            self.assertIn(part, error)

    def visit(self, *arguments, opens=True, **environment):
        """Runs the viewer with a fake browser opener that logs its calls. Returns the address, the log (the
        arguments, and mode and text of the file that they name) and the standard error."""
        opener = self.write("bin/xdg-open", """#!/bin/sh
            printf '%s\\n' "$*" "$(stat -c %a "$1")" "$(cat "$1")" > opened.part
            mv opened.part opened
            echo noise
            """)
        opener.chmod(0o755)
        noted = self.folder / "opened"
        noted.unlink(missing_ok=True)
        process, url = self.start("a.obj", *arguments, PATH=f"{opener.parent}:{os.environ['PATH']}", **environment)
        for _ in range(600 if opens else 5):
            if noted.exists():
                break
            select.select([], [], [], 0.1)
        process.send_signal(signal.SIGINT)
        output, error = process.communicate()
        self.assertEqual((output, process.returncode), ("", 0))
        return url, noted.read_text().split("\n", 2) if noted.exists() else None, error

    def test_browser_is_led_by_a_file_that_others_cannot_read(self):
        self.write("a.obj", TRIANGLE)
        runtime, temporary = self.folder / "runtime", self.folder / "temporary"
        runtime.mkdir()
        temporary.mkdir()
        for folder, environment in (
            (runtime, {"DISPLAY": ":0", "XDG_RUNTIME_DIR": str(runtime)}),
            (runtime, {"WAYLAND_DISPLAY": "wayland-0", "DISPLAY": ":0", "XDG_RUNTIME_DIR": str(runtime)}),
            (temporary, {"DISPLAY": ":0", "XDG_RUNTIME_DIR": ""}),
            (temporary, {"DISPLAY": ":0", "XDG_RUNTIME_DIR": str(self.folder / "none")}),
        ):
            with self.subTest(environment=environment):
                url, (arguments, mode, page), error = self.visit(TMPDIR=str(temporary), **environment)
                self.assertEqual(error, "")
                self.assertRegex(arguments, "^" + re.escape(f"{folder}/supple-") + r"\w{6}\.html$")
                self.assertEqual(mode, "600")
                self.assertIn(f'<meta http-equiv="refresh" content="0; url={url}">', page)
                self.assertEqual(list(folder.iterdir()), [], "the file remains after the end")

    def test_no_browser(self):
        self.write("a.obj", TRIANGLE)
        temporary = self.folder / "temporary"
        temporary.mkdir()
        here = {"TMPDIR": str(temporary), "XDG_RUNTIME_DIR": ""}
        for arguments, environment in ((("--no-open",), {"DISPLAY": ":0"}), ((), {}), ((), {"DISPLAY": ""})):
            self.assertEqual(self.visit(*arguments, opens=False, **here, **environment)[1:], (None, ""))
            self.assertEqual(list(temporary.iterdir()), [])

    @unittest.skipUnless(os.path.isdir("/proc/self"), "needs a folder in which even root cannot write")
    def test_where_no_file_for_the_browser_can_be_written(self):
        self.write("a.obj", TRIANGLE)
        _, opened, error = self.visit(opens=False, DISPLAY=":0", TMPDIR="/proc/self", XDG_RUNTIME_DIR="")
        self.assertIsNone(opened)
        self.assertRegex(error, r"^supple: warning: /proc/self/supple-\w*\.html: cannot write .*; open it yourself\n$")


@needs_viewer
class Export(ViewTest):
    def cargo(self, path, name):
        page = path.read_text(encoding="utf-8")
        (text,) = re.findall(f'<script type="application/octet-stream;base64" id="{name}">([^<]*)</script>', page)
        return gzip.decompress(base64.b64decode(text, validate=True))

    def export(self, *arguments):
        done = self.run_here("view", *arguments, "--export", "page.html")
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertRegex(done.out, r"^page\.html: \d+\.\d\d MB, ")
        self.assertEqual([p.name for p in self.folder.glob("page.html*")], ["page.html"])
        return self.folder / "page.html"

    def test_module_is_the_one_that_was_built(self):
        self.write("a.obj", TRIANGLE)
        page = self.export("a.obj")
        module = self.cargo(page, "supple-wasm")
        self.assertEqual(module, pathlib.Path(MODULE).read_bytes())
        self.assertEqual(module[:4], b"\0asm")
        self.assertNotIn("<!--supple-cargo--></body>", page.read_text(encoding="utf-8"))

    def test_show_holds_scene_or_frames(self):
        self.write("scene.toml", BODY)
        scene = self.cargo(self.export("scene.toml"), "supple-scene")
        self.assertEqual(scene, self.cargo(self.export("scene.toml"), "supple-scene"), "second export differs")
        self.assertNotEqual(scene, self.cargo(self.export("scene.toml", "--seed", 5), "supple-scene"))
        for i in range(3):
            self.write(f"frame_{i}.obj", moved(TRIANGLE, 0.125 * i, 0, 0))
        frames = self.cargo(self.export("--sequence", "frame_*.obj"), "supple-scene")
        # The first vertex of the last frame as floats, relative to the centre of (0, 0, 0) and (1, 1, 0).
        self.assertIn(struct.pack("<3f", 0.25 - 0.5, -0.5, 0), frames)

    def test_pages_too_large_are_refused(self):
        cloth = self.folder / "cloth.off"
        rows = 400
        vertices = "\n".join(f"{i} {j} 0" for i in range(rows) for j in range(rows))
        triangles = "\n".join(f"3 {i * rows + j} {i * rows + j + 1} {(i + 1) * rows + j}" for i in range(rows - 1) for j in range(rows - 1))
        cloth.write_text(f"OFF\n{rows * rows} {(rows - 1) ** 2} 0\n{vertices}\n{triangles}\n")
        done = self.run_here("view", "--sequence", *["cloth.off"] * 1100, "--export", "page.html")
        self.assert_one_line_error(done, "page.html", "MB", "200 MB", "fewer frames")
        self.assertFalse((self.folder / "page.html").exists())

    def test_where_it_cannot_be_written(self):
        self.write("a.obj", TRIANGLE)
        for name in ("no/such/page.html", "/dev/full", "."):
            self.assert_one_line_error(self.run_here("view", "a.obj", "--export", name), name, "cannot write")


@needs_viewer
class Errors(ProgramTest):
    def test_inputs_and_options(self):
        self.write("a.obj", TRIANGLE)
        self.write("scene.toml", BODY)
        for arguments, parts in (
            ((), ["required"]),
            (("nothing.obj",), ["nothing.obj", "no such file"]),
            (("scene.toml", "a.obj"), ["scene.toml", "only input"]),
            (("none.h5",), ["none.h5"]),
            (("a.obj", "--host", "somewhere"), ["somewhere", "not an IP address"]),
            (("a.obj", "--host", "203.0.113.1"), ["203.0.113.1", "cannot listen"]),
            (("a.obj", "--port", "70000"), ["--port", "'70000'", "65535"]),
            (("a.obj", "--seed", "1"), ["--seed", "scene file"]),
            (("a.obj", "--time-step", "1"), ["--time-step", "scene file"]),
            (("a.obj", "--export", "page.html", "--port", "1"), ["--port", "--export"]),
            (("a.obj", "--export", "page.html", "--no-open"), ["--no-open", "--export"]),
            (("a.obj", "--min-separation", "1"), ["--min-separation", "--contacts continuous"]),
            (("a.obj", "--verify"), ["--verify"]),
        ):
            with self.subTest(arguments=arguments):
                self.assert_one_line_error(self.run_here("view", *arguments), *parts)


if __name__ == "__main__":
    unittest.main()
