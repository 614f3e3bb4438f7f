"""Tests `supple simulate`: steps and frames, reproducible bytes, recordings, and runs that end early."""

import json
import os
import pty
import re
import signal
import subprocess
import time
import unittest

from program import PROGRAM, ROOT, ProgramTest, run

SCENES = ROOT / "scenes"
SPRINGS = 'motion = { kind = "mass_spring", integrator = "verlet", stiffness = 50.0 }\n'
# Two wobbling balls that fly towards each other.
BALLS = """[scene]
time_step = 0.02
seed = 3
[[object]]
model = "icosphere"
frequency = 2
scale = 0.4
translate = [-1, 0, 0]
motion = { kind = "mass_spring", velocity = [1, 0, 0], random_force = 2, deform_seconds = 0.2, random_speed = 0.1 }
[[object]]
model = "icosphere"
frequency = 2
scale = 0.4
translate = [1, 0, 0]
motion = { kind = "mass_spring", velocity = [-1, 0, 0], random_force = 2, deform_seconds = 0.2, random_speed = 0.1 }
"""
# The first object is stable; the springs of the second are far too stiff for the step.
BLOWS_UP = """[scene]
time_step = 0.05
[[object]]
name = "calm"
model = "box"
motion = { kind = "mass_spring", velocity = [1, 0, 0] }
[[object]]
name = "stiff"
model = "icosphere"
translate = [9, 0, 0]
motion = { kind = "mass_spring", stiffness = 1e5, random_force = 1, deform_seconds = 1 }
"""


class SimulateTest(ProgramTest):
    def simulate(self, *arguments):
        """Returns the JSON of a run that must succeed."""
        done = self.run_here("simulate", *arguments, "--json", "-")
        self.assertEqual(done.status, 0, done.error)
        self.assertRegex(done.error, r"^(supple: warning: [^\n]*tested: [^\n]*\n)?$")
        return json.loads(done.out)

    def bytes_of(self, *arguments):
        done = self.run_here("simulate", *arguments, "--json", "-", "--no-stats")
        self.assertEqual((done.status, done.error), (0, ""))
        return done.out


class Steps(SimulateTest):
    def setUp(self):
        super().setUp()
        self.write("balls.toml", BALLS)

    def test_number_of_frames(self):
        frames = self.simulate("balls.toml", "--frames", "8")["frames"]
        self.assertEqual([f["frame"] for f in frames], list(range(8)))
        self.assertEqual(len(self.simulate("balls.toml", "--steps", "8")["frames"]), 8)
        for frame in frames:
            self.assertAlmostEqual(frame["time"], 0.02 * frame["frame"])
            self.assertIn("motion_seconds", frame["stats"])

    def test_seconds(self):
        for seconds, steps in (("0.1", 5), ("0.11", 6), ("0.001", 1), ("0.06", 3)):
            self.assertEqual(len(self.simulate("balls.toml", "--seconds", seconds)["frames"]), steps + 1)

    def test_time_step(self):
        frames = self.simulate("balls.toml", "--seconds", "0.1", "--time-step", "0.005")["frames"]
        self.assertEqual(len(frames), 21)
        self.assertAlmostEqual(frames[-1]["time"], 0.1)

    def test_default_is_301_frames(self):
        self.write("box.toml", f'[[object]]\nmodel = "box"\n{SPRINGS}')
        self.assertEqual(len(self.simulate("box.toml")["frames"]), 301)

    def test_frames_are_those_of_detect(self):
        detected = self.detect("balls.toml", "--frames", "60", "--contact-details")["frames"]
        simulated = self.simulate("balls.toml", "--frames", "60", "--contact-details")["frames"]
        self.assertTrue(any(f["contacts"] for f in detected))
        for a, b in zip(detected, simulated, strict=True):
            self.assertEqual((a["contacts"], a["events"]), (b["contacts"], b["events"]))

    def test_continuous_contacts_are_those_of_the_step_before(self):
        detected = self.detect("balls.toml", "--frames", "61", "--contacts", "continuous")["frames"]
        simulated = self.simulate("balls.toml", "--frames", "61", "--contacts", "continuous")["frames"]
        self.assertEqual(simulated[0]["continuous"], [])
        self.assertTrue(any(f["continuous"] for f in detected))
        for a, b in zip(detected, simulated[1:], strict=True):
            self.assertEqual(a["continuous"], b["continuous"])

    def test_tables(self):
        done = self.run_here("simulate", "balls.toml", "--frames", "51")
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertRegex(done.out, r"50 steps of 0.02 s: 1 s simulated in \S+ s, \S+ steps/s")
        self.assertRegex(done.out, r"collisions: [1-9]\d* times? .* volumes .*, [1-9]\d* times? .* touch")
        self.assertNotIn("leaves", done.out)
        done = self.run_here("simulate", "balls.toml", "--frames", "51", "--colliding-vertices")
        self.assertRegex(done.out, r"collisions: .* volumes .*, [1-9]\d* times? that leaves .*, [1-9]\d* times? .* touch")
        self.assertRegex(done.out, r"\nmotion +\S+ +\d+ %")
        self.assertNotIn("margins", done.out)
        rows = re.findall(r"^(0 icosphere|1 icosphere|all)((?: +\S+){7})$", done.out, re.M)
        self.assertEqual([name for name, _ in rows], ["0 icosphere", "1 icosphere", "all"])
        start, end, *parts = (float(x) for x in rows[2][1].split())
        self.assertAlmostEqual(end, sum(parts), delta=0.01 * end)
        self.assertEqual(start, 0)
        self.assertGreater(end, 20)  # 84 masses of 1 kg at 1 m/s, minus the loss by damping
        self.assertLess(end, 60)

    def test_counts_objects_that_come_near(self):
        done = self.run_here("simulate", str(SCENES / "cloth_over_ball.toml"), "--frames", "51")
        self.assertRegex(done.out, r"collisions: 1 time .* volumes .*, 1 time .* within their margins, 0 times .* touch")

    def test_quiet(self):
        done = self.run_here("simulate", "balls.toml", "--frames", "4", "--quiet")
        self.assertEqual((done.status, done.out, done.error), (0, "", ""))

    def test_fail_on_contact_and_verify(self):
        self.assertEqual(self.run_here("simulate", "balls.toml", "--frames", "61", "--quiet", "--fail-on-contact").status, 1)
        self.assertEqual(self.run_here("simulate", "balls.toml", "--frames", "4", "--quiet", "--fail-on-contact").status, 0)
        for contacts in ("intersection", "continuous"):
            frames = self.simulate("balls.toml", "--frames", "46", "--verify", "--contacts", contacts)["frames"]
            self.assertEqual([f["verify"]["differences"] for f in frames[1:]], [[]] * 45)

    def test_csv(self):
        done = self.run_here("simulate", "balls.toml", "--frames", "51", "--csv", "-")
        self.assertEqual((done.status, done.error), (0, ""))
        rows = done.out.splitlines()
        self.assertEqual(rows[0], "frame,a,b,triangle_a,triangle_b,kind")
        self.assertGreater(len(rows), 1)


class SameBytes(SimulateTest):
    def setUp(self):
        super().setUp()
        self.write("balls.toml", BALLS)
        self.expected = self.bytes_of("balls.toml", "--frames", "61", "--self", "--contact-details")
        self.assertIn('"segment"', self.expected)

    def test_again_and_on_any_number_of_threads(self):
        for arguments in ([], ["--threads", "1"], ["--threads", "2"], ["--threads", "5"], ["--seed", "3"]):
            self.assertEqual(self.bytes_of("balls.toml", "--frames", "61", "--self", "--contact-details", *arguments), self.expected)

    def test_another_seed_differs(self):
        self.assertNotEqual(self.bytes_of("balls.toml", "--frames", "61", "--self", "--seed", "4"), self.expected)


class Recorded(SimulateTest):
    def setUp(self):
        super().setUp()
        self.write("balls.toml", BALLS)

    def frame_count(self, name="run.h5"):
        """The number of frames that can be read from the recording."""
        done = self.run_here("detect", name, "--json", "-", "--contacts", "none")
        self.assertEqual((done.status, done.error), (0, ""))
        return len(json.loads(done.out)["frames"])

    def start(self, *arguments):
        process = subprocess.Popen([PROGRAM, "simulate", *map(str, arguments)], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def wait_for_frames(self):
        """Waits until the growing file can be read; it is flushed once per second."""
        deadline = time.monotonic() + 120
        while time.monotonic() < deadline:
            time.sleep(0.1)
            done = self.run_here("detect", "run.h5", "--contacts", "none")
            if done.status == 0:
                return
        self.fail(done.error)

    def test_frames(self):
        done = self.run_here("simulate", "balls.toml", "--frames", "13", "--record", "run.h5", "--quiet")
        self.assertEqual((done.status, done.out, done.error), (0, "", ""))
        self.assertEqual(self.frame_count(), 13)
        self.assertTrue((self.folder / "run.xdmf").exists())

    def test_redetecting_gives_the_same_contacts(self):
        simulated = self.simulate("balls.toml", "--frames", "51", "--record", "run.h5", "--contact-details")["frames"]
        detected = self.detect("run.h5", "--contact-details")["frames"]
        self.assertTrue(any(f["contacts"] for f in simulated))
        self.assertEqual([f["contacts"] for f in detected], [f["contacts"] for f in simulated])

    def test_the_scene_file_is_in_it(self):
        self.run_here("simulate", "balls.toml", "--frames", "2", "--record", "run.h5", "--quiet")
        self.assertIn(BALLS.encode(), (self.folder / "run.h5").read_bytes())

    def test_blow_up_keeps_the_last_good_state(self):
        self.write("stiff.toml", BLOWS_UP)
        done = self.run_here("simulate", "stiff.toml", "--frames", "1001", "--record", "run.h5", "--quiet")
        self.assertEqual(done.status, 2)
        warning, error = done.error.splitlines()
        self.assertRegex(warning, r"^supple: warning: stiff\.toml: time_step 0\.05 .*stiff.*substeps = \d+.*backward_euler")
        step = int(re.search(r"stiff in step (\d+)", error)[1])
        self.assertEqual(self.frame_count(), step)  # the start and all previous steps
        self.assertTrue(all(not f["non_finite"] for f in self.detect("run.h5")["frames"]))

    def test_interrupted(self):
        for number, status in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            process = self.start("balls.toml", "--frames", "1000000000", "--record", "run.h5", "--json", "run.json")
            self.wait_for_frames()
            process.send_signal(number)
            out, error = process.communicate()
            self.assertEqual(process.returncode, status, error)
            step, frames = re.search(r"^supple: interrupted after ([\d,]+) of 999,999,999 steps, .* run\.h5 has ([\d,]+) frames\n$", error).groups()
            step = step.replace(",", "")
            self.assertEqual(int(frames.replace(",", "")), int(step) + 1)
            self.assertEqual(self.frame_count(), int(step) + 1)
            self.assertEqual(len(json.loads((self.folder / "run.json").read_text())["frames"]), int(step) + 1)
            self.assertIn("steps/s", out)
            (self.folder / "run.h5").unlink()

    def test_killed(self):
        process = self.start("balls.toml", "--frames", "1000000000", "--record", "run.h5", "--quiet")
        self.wait_for_frames()
        process.kill()
        process.communicate()
        self.assertGreater(self.frame_count(), 1)

    def test_cannot_write(self):
        self.assert_one_line_error(self.run_here("simulate", "balls.toml", "--record", "no/such/run.h5"), "run.h5")


class Ends(SimulateTest):
    def test_blow_up(self):
        self.write("stiff.toml", BLOWS_UP)
        done = self.run_here("simulate", "stiff.toml", "--frames", "1001", "--json", "run.json")
        self.assertEqual(done.status, 2)
        self.assertIn("stiff in step", done.error)
        frames = json.loads((self.folder / "run.json").read_text())["frames"]
        self.assertEqual(len(frames), int(re.search(r"in step (\d+)", done.error)[1]))

    def test_no_warning_where_steps_are_short_enough(self):
        self.write("stiff.toml", BLOWS_UP)
        done = self.run_here("simulate", "stiff.toml", "--seconds", "0.02", "--time-step", "0.001", "--quiet")
        self.assertEqual((done.status, done.error), (0, ""))

    def test_implicit_needs_no_warning(self):
        self.write("stiff.toml", BLOWS_UP.replace("stiffness = 1e5", 'stiffness = 1e5, integrator = "backward_euler"'))
        done = self.run_here("simulate", "stiff.toml", "--frames", "21", "--quiet")
        self.assertEqual((done.status, done.error), (0, ""))

    def test_progress_on_a_terminal(self):
        try:
            terminal, its_side = pty.openpty()
        except OSError as error:
            self.skipTest(f"no terminal available: {error}")
        self.addCleanup(os.close, terminal)
        self.write("balls.toml", BALLS)
        process = subprocess.Popen([PROGRAM, "simulate", self.folder / "balls.toml", "--frames", "1000000000"],
                                   stdout=subprocess.DEVNULL, stderr=its_side)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        os.close(its_side)
        self.assertRegex(os.read(terminal, 200).decode(),
                         r"^\r\[[#.]+\] step \d+ of 999999999, [\d.]+ steps/s, (\d+:\d\d(:\d\d)?|\d+ days) left")

    def test_usage(self):
        self.write("box.toml", '[[object]]\nmodel = "box"\n')
        self.write("a.obj", "v 0 0 0\n")
        for arguments, parts in (
            ([], ["required"]),
            (["a.obj"], ["a.obj", "scene file"]),
            (["none.toml"], ["none.toml", "there is no such file"]),
            (["box.toml", "--frames", "0"], ["--frames", "'0'"]),
            (["box.toml", "--seconds", "0"], ["--seconds", "'0'", "above 0"]),
            (["box.toml", "--seconds", "1e30"], ["--seconds", "allowed"]),
            (["box.toml", "--time-step", "-1"], ["--time-step", "'-1'", "above 0"]),
            (["box.toml", "--frames", "3", "--seconds", "2"], ["--seconds", "--frames"]),
            (["box.toml", "--seed", "-1"], ["--seed", "'-1'"]),
            (["box.toml", "--json", "-", "--csv", "-"], ["--csv", "--json"]),
            (["box.toml", "--no-stats"], ["--no-stats", "--json"]),
        ):
            with self.subTest(arguments=arguments):
                self.assert_one_line_error(self.run_here("simulate", *arguments), *parts)


class Scenes(SimulateTest):
    """Each scene that Supple includes runs, has a description and is documented."""

    def test_each(self):
        files = sorted(SCENES.glob("*.toml"))
        self.assertGreaterEqual(len(files), 10)
        page = (ROOT / "docs/scene_file.md").read_text()
        for file in files:
            with self.subTest(scene=file.name):
                self.assertRegex(file.read_text(), r"\A# \S")
                self.assertIn(f"scenes/{file.name}", page)
                done = run("simulate", file, "--frames", "3", "--contacts", "none", "--json", "-", "--no-stats")
                self.assertEqual((done.status, done.error), (0, ""))
                self.assertEqual(len(json.loads(done.out)["frames"]), 3)

    def test_those_of_the_paper_do_not_touch_while_they_are_deformed(self):
        for name in ("table1_3", "table1_6", "table1_9"):
            frames = self.simulate(SCENES / f"{name}.toml", "--seconds", "1", "--contacts", "none")["frames"]
            self.assertTrue(all(not f["object_pairs"] for f in frames), name)


if __name__ == "__main__":
    unittest.main()
