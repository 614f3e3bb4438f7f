"""Functions for frames, in a module that processes and machines import."""

import os
import pathlib
import signal

import numpy as np

import supple


def moving_balls(frames):
    """Two balls in one mesh, of which one moves into the other: (frames, n, 3) and faces (m, 3)."""
    ball = supple.make_icosphere(4)
    x, faces = np.asarray(ball.positions), np.asarray(ball.triangles)
    bent = [np.concatenate([x, (x + [2.4 - 0.06 * i, 0.1, 0]) * [1, 1 + 0.02 * i, 1]]) for i in range(frames)]
    return np.stack(bent), np.concatenate([faces, faces + len(x)])


def square(number):
    return number * number


def process(_):
    return os.getpid()


def measure(frame):
    """Bytes that depend on the whole frame."""
    if isinstance(frame, dict):
        return [measure(each) for each in frame.values()]
    if isinstance(frame, supple.Mesh):
        return np.asarray(frame.positions).tobytes()
    if isinstance(frame, supple.Frame):
        return frame.time, frame.contacts.tobytes(), [each.tobytes() for each in frame.positions]
    return np.asarray(frame).tobytes()


def note(folder, text):
    """Adds a line to a file of the folder, also when several processes do; returns the number of lines."""
    path = pathlib.Path(folder) / "notes"
    with path.open("a") as file:
        file.write(f"{text}\n")
    return path.read_text().splitlines().count(text)


class OwnError(Exception):
    """An error that cannot be pickled back."""

    def __init__(self, frame, reason):
        super().__init__(f"{reason} in {frame}")


class Fails:
    """Squares numbers, but raises an error for one of them."""

    def __init__(self, folder, chosen, error):
        self.folder, self.chosen, self.error = folder, chosen, error

    def __call__(self, number):
        if number == self.chosen:
            note(self.folder, "failed")
            if self.error is OwnError:
                raise OwnError(number, "broken")
            raise self.error("broken")
        return square(number)


class Kills:
    """Squares numbers, but kills its process with one of them, the first `times` times."""

    def __init__(self, folder, chosen, times):
        self.folder, self.chosen, self.times = folder, chosen, times

    def __call__(self, number):
        if number == self.chosen and note(self.folder, "killed") <= self.times:
            os.kill(os.getpid(), signal.SIGKILL)
        return square(number)


class Interrupts:
    """Presses Ctrl-C in the process `pid` with frame 0."""

    def __init__(self, pid):
        self.pid = pid

    def __call__(self, number):
        if number == 0:
            os.kill(self.pid, signal.SIGINT)
        return number
