"""A program in Python that shows its scene: a page without a browser pauses it, takes steps and sets breaks."""

import base64
import json
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import threading
import urllib.parse
from typing import ClassVar

import numpy as np
import pytest
from conftest import ROOT

import supple

pytest.importorskip("supple._viewer", exc_type=ImportError)

SCENE, FRAME, ANSWER, FAILURE = 1, 2, 3, 4


class Page:
    """A page that draws nothing: a WebSocket (RFC 6455) and the messages of viewer/PROTOCOL.md."""

    opened: ClassVar[list["Page"]] = []

    def __init__(self, url):
        parts = urllib.parse.urlsplit(url)
        self.socket = socket.create_connection((parts.hostname, parts.port), timeout=600)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET /session?{parts.query} HTTP/1.1\r\nHost: {parts.netloc}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        self.stream = self.socket.makefile("rb")
        self.opened.append(self)
        assert b"101" in self.stream.readline()
        while self.stream.readline() != b"\r\n":
            pass

    def say(self, **command):
        data, mask = json.dumps(command).encode(), b"\0\0\0\0"
        size = bytes([0x80 | len(data)]) if len(data) < 126 else b"\xfe" + struct.pack(">H", len(data))
        self.socket.sendall(b"\x81" + size + mask + data)

    def ask(self, **command):
        """The answer to a command; requests no frame."""
        self.say(**command, id=1)
        while True:
            kind, text = self.read()
            if kind == ANSWER:
                return text

    def read(self):
        """The kind and the text of the next message; None when the program has closed."""
        first, size = self.stream.read(2)
        size = (
            struct.unpack({126: ">H", 127: ">Q"}[size], self.stream.read({126: 2, 127: 8}[size]))[0]
            if size > 125
            else size
        )
        data = self.stream.read(size)
        if first & 15 == 8:
            return None
        if first & 15 != 2:
            return self.read()
        kind, sections = struct.unpack_from("<H", data, 6)[0], struct.unpack_from("<I", data, 12)[0]
        place = 16
        for _ in range(sections):
            tag, _, _, length = struct.unpack_from("<IIII", data, place)
            if tag == 1:
                return kind, json.loads(data[place + 16 : place + 16 + length])
            place += 16 + (length + 15) // 16 * 16
        raise AssertionError("a message without a text")

    def until(self, holds):
        """The text of the first message that fulfils the condition; requests the frames before it."""
        while True:
            self.say(do="credit", frames=1)
            kind, text = self.read()
            if holds(kind, text):
                return text

    def close(self):
        self.stream.close()
        self.socket.close()


@pytest.fixture(autouse=True)
def pages_are_closed():
    yield
    while Page.opened:
        Page.opened.pop().close()


def falling_ball(**options):
    scene = supple.Scene(**options)
    scene.add(supple.make_box([4, 1, 4], 4), name="floor", static=True)
    ball = scene.add(supple.make_icosphere(3), name="ball")
    return scene, ball


def fall(scene, ball, steps):
    for step in range(steps):
        ball.set_transform(supple.rigid_transform(0, 0, 0, 1, [0, 3 - 0.1 * step, 0]))
        scene.detect()


@pytest.fixture
def attached():
    scene, ball = falling_ball()
    with supple.attach(scene, open=False, max_slowdown=100) as view:
        yield scene, ball, view


def in_thread(function, *arguments):
    thread = threading.Thread(target=function, args=arguments, daemon=True)
    thread.start()
    return thread


def test_page_pauses_steps_and_continues(attached):
    scene, ball, view = attached
    page = Page(view.url)
    assert page.until(lambda kind, _: kind == SCENE)["source"] == "program"
    page.ask(do="pause")
    program = in_thread(fall, scene, ball, 10)
    assert page.until(lambda kind, text: kind == FRAME and not text["playing"])["step"] == 0
    assert view.is_paused and view.steps == 1
    page.say(do="step", count=4)
    page.until(lambda kind, text: kind == FRAME and text["step"] == 4)
    page.say(do="play")
    program.join(60)
    assert not program.is_alive() and view.steps == 10 and view.frames >= 2


def test_break_says_the_pair(attached):
    scene, ball, view = attached
    view.set_breaks(contact_begin=True, objects=("ball", ""))
    page = Page(view.url)
    page.until(lambda kind, _: kind == SCENE)
    program = in_thread(fall, scene, ball, 30)
    found = page.until(lambda kind, text: kind == FRAME and text["break"])["break"]
    assert found["text"] == "floor begins to touch ball" and found["event"] == "contact_begin"
    page.close()
    program.join(60)
    assert not program.is_alive(), "without its page, the program goes on"


def test_pair_filter_of_python_is_asked_while_the_program_waits(attached):
    scene, ball, view = attached
    names = []

    def accepts(a, b):
        names.append((a.name, b.name))
        return False

    scene.set_pair_filter(accepts)
    page = Page(view.url)
    page.until(lambda kind, _: kind == SCENE)
    page.ask(do="pause")
    program = in_thread(fall, scene, ball, 1)
    page.until(lambda kind, text: kind == FRAME)
    assert page.ask(do="explain", a=[0, 0], b=[1, 0])["stage"] == "not_tested"
    assert ("floor", "ball") in names
    page.close()
    program.join(60)
    assert not program.is_alive()


def test_page_shows_fields_of_the_program(attached):
    scene, ball, view = attached
    numbers = np.arange(ball.vertex_count) / 3
    view.set_field(ball, "heat", numbers)
    view.set_field(ball, "stress", np.arange(ball.triangle_count, dtype=np.float32))
    view.set_field(ball, "wind", numbers[:, None] * [0, 1, -2])
    page = Page(view.url)
    fields = {each["label"]: each for each in page.until(lambda kind, _: kind == SCENE)["fields"]}
    assert {name: (fields[name]["element"], fields[name]["vector"]) for name in ("heat", "stress", "wind")} == {
        "heat": ("vertex", False),
        "stress": ("face", False),
        "wind": ("vertex", True),
    }
    page.ask(do="pause")
    program = in_thread(fall, scene, ball, 1)
    page.until(lambda kind, _: kind == FRAME)

    def read(name, **element):
        page.ask(do="layers", field=fields[name]["key"])
        return page.ask(do="read", object=1, **element)["field"][name]

    assert read("heat", vertex=4) == 4 / 3
    assert read("stress", triangle=7) == 7
    assert read("wind", vertex=3) == [0, 1, -2]
    page.close()
    program.join(60)


def test_fields_that_do_not_fit_are_refused(attached):
    _, ball, view = attached
    counts = f"{ball.vertex_count} vertices and {ball.triangle_count} triangles"
    with pytest.raises(supple.Error, match=f"heat of ball has 5 values, but the object has {counts}"):
        view.set_field(ball, "heat", np.zeros(5))
    with pytest.raises(supple.Error, match=f"has {ball.vertex_count} values, but the object has"):
        view.set_field(ball, "heat", np.zeros(ball.vertex_count), of="face")
    with pytest.raises(supple.Error, match="of is edge; it must be one of vertex, face"):
        view.set_field(ball, "heat", np.zeros(ball.vertex_count), of="edge")
    with pytest.raises(supple.Error, match=r"the values of heat have the shape \(7, 2\); it must be \(n, 3\)"):
        view.set_field(ball, "heat", np.zeros((7, 2)))
    with pytest.raises(supple.Error, match="is not an object of the scene"):
        view.set_field(falling_ball()[1], "heat", np.zeros(5))


def test_simulation():
    simulation = supple.Simulation(time_step=0.25)
    simulation.add(supple.make_icosphere(2), name="ball", rigid={"velocity": [1, 0, 0]})
    with supple.attach(simulation, open=False, max_slowdown=100) as view:
        page = Page(view.url)
        assert page.until(lambda kind, _: kind == SCENE)["time_step"] == 0.25
        page.ask(do="pause")
        program = in_thread(lambda: [simulation.step() for _ in range(3)])
        assert page.until(lambda kind, text: kind == FRAME)["step"] == 0
        page.say(do="play")
        program.join(60)
        assert view.steps == 3


def test_spectators_see_the_program_and_control_nothing(attached):
    assert attached[2].watching_url == ""
    scene, ball = falling_ball()
    with supple.attach(scene, open=False, max_slowdown=100, spectators=True) as view:
        assert view.watching_url.startswith("http://") and view.watching_url != view.url
        page, spectator = Page(view.url), Page(view.watching_url)
        page.ask(do="pause")
        thread = in_thread(fall, scene, ball, 3)
        page.until(lambda kind, text: kind == FRAME and text["step"] == 0)
        spectator.say(do="play")
        assert spectator.read()[0] == SCENE
        assert spectator.read()[1]["step"] == 0
        page.say(do="step")
        page.until(lambda kind, text: kind == FRAME and text["step"] == 1)
        assert view.steps == 2, "the spectator has continued nothing"
        page.say(do="play")
        thread.join(60)
        assert not thread.is_alive()


def test_close_frees_the_port_and_later_steps_are_not_shown(attached):
    scene, ball, view = attached
    assert view.url in repr(view) and view.url.split("?")[0] in view._repr_html_()
    fall(scene, ball, 2)
    view.close()
    fall(scene, ball, 2)
    assert view.steps == 2
    with pytest.raises(ConnectionRefusedError):
        Page(view.url)
    view.close()


def test_refuses_wrong_options():
    scene, _ = falling_ball()
    with pytest.raises(supple.Error, match="max_slowdown"):
        supple.attach(scene, open=False, max_slowdown=-1)
    with pytest.raises(supple.Error, match="neither a Scene nor a Simulation"):
        supple.attach("run.h5", open=False)
    with pytest.raises(TypeError):
        supple.attach(scene, open=False, speed=3)


def test_examples_of_the_document(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs/viewer.md").read_text(), re.DOTALL)
    assert blocks
    for block in blocks:
        names = {}
        exec(compile(block, "docs/viewer.md", "exec"), names)  # noqa: S102
        assert names["view"].steps == 300


PAUSED = """
import signal, supple
signal.signal(signal.SIGINT, signal.default_int_handler)  # a job in the background ignores it
scene = supple.Scene()
scene.add(supple.make_icosphere(2))
view = supple.attach(scene, open=False, wait_for_page=True)
print(view.url, flush=True)
try:
    while True:
        scene.detect()
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


def paused_program():
    program = subprocess.Popen([sys.executable, "-c", PAUSED], stdout=subprocess.PIPE, text=True)
    return program, Page(program.stdout.readline().strip())


def test_ctrl_c_ends_a_pause():
    program, page = paused_program()
    page.until(lambda kind, _: kind == SCENE)
    page.ask(do="pause")
    page.until(lambda kind, text: kind == FRAME and not text["playing"])
    program.send_signal(signal.SIGINT)
    assert program.communicate()[0] == "interrupted\n"
    assert program.returncode == 0


def test_killed_program_closes_the_connection():
    program, page = paused_program()
    page.until(lambda kind, _: kind == SCENE)
    program.kill()
    program.communicate()
    with pytest.raises((ValueError, ConnectionError)):
        while page.read():
            pass


def test_program_ends_without_closing_the_view():
    script = PAUSED.replace("wait_for_page=True", "wait_for_page=False").replace("while True", "if True")
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=600, check=False
    )
    assert done.returncode == 0 and done.stderr == ""
