"""Tests exit statuses, one-line errors and the help with its examples, on which scripts rely."""

import json
import os
import re
import resource
import subprocess
import unittest

from program import CROSSED, FAR, FLOOR, PROGRAM, SPIKE, TRIANGLE, UPRIGHT, ProgramTest, Result, joined, moved, run


class Help(ProgramTest):
    def test_version(self):
        done = run("--version")
        self.assertEqual((done.status, done.error), (0, ""))
        self.assertRegex(done.out, r"^supple \d+\.\d+\.\d+\n$")

    def test_help_teaches_by_example(self):
        for command in ("detect", "simulate", "view", "info", "ccd-queries", "diff"):
            done = run(command, "--help")
            self.assertEqual((done.status, done.error), (0, ""))
            options, examples = done.out.split("Examples:")
            lines = re.findall(rf"^  supple {command} .*$", examples, re.M)
            self.assertGreaterEqual(len(lines), 3)
            for flag in re.findall(r"(?<= )--[a-z-]+", "\n".join(lines)):
                self.assertIn(flag, options, "an example uses an option that is not explained")

    def test_help_of_the_program_names_the_commands(self):
        done = run("--help")
        self.assertEqual(done.status, 0)
        for word in ("detect", "simulate", "view", "info", "ccd-queries", "diff", "experiment", "Examples:", "Exit status"):
            self.assertIn(word, done.out)


class UsageErrors(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.obj", TRIANGLE)
        self.write("b.obj", UPRIGHT)
        self.write("scene.toml", '[[object]]\nmodel = "box"\n')

    def expect(self, *arguments, parts):
        with self.subTest(arguments=arguments):
            self.assert_one_line_error(self.run_here(*arguments), *parts)

    def test_command(self):
        self.expect(parts=["subcommand", "--help"])
        self.expect("explode", parts=["command explode is unknown; see"])
        for mistyped, meant in (("detct", "detect"), ("simualte", "simulate"), ("ccd-querys", "ccd-queries")):
            self.expect(mistyped, parts=[f"command {mistyped} is unknown; did you mean {meant}?"])
        for mistyped, meant in (("--slef", "--self"), ("--bounding-volum", "--bounding-volume"), ("--no-stat", "--no-stats"), ("--frame=3", "--frames")):
            self.expect("detect", "a.obj", mistyped, parts=[f"option {mistyped.split('=')[0]} is unknown; did you mean {meant}?"])
        self.expect("detect", "a.obj", "--wibble", parts=["option --wibble is unknown; see"])
        self.expect("detect", parts=["required"])
        self.expect("info", parts=["required"])
        self.expect("ccd-queries", parts=["required"])
        self.expect("diff", parts=["required"])

    def test_stages_that_do_not_exist_are_usage_errors(self):
        self.expect("detect", "a.obj", "--distance", "1", parts=["--distance"])
        self.expect("detect", "a.obj", "--bounding-volume", "cone", parts=["--bounding-volume", "aabb, sphere, obb"])
        self.expect("detect", "a.obj", "--bounding-volume", "kdop", parts=["--bounding-volume", "aabb, sphere"])
        self.expect("detect", "a.obj", "--contacts", "nearness", parts=["--contacts", "none, or one or more of intersection, continuous"])

    def test_values(self):
        self.expect("detect", "a.obj", "--threads", "-1", parts=["--threads", "'-1'", "0 to 1024"])
        self.expect("detect", "a.obj", "--threads", "two", parts=["--threads", "'two'"])
        self.expect("detect", "a.obj", "--threads", "1.5", parts=["--threads", "'1.5'"])
        self.expect("detect", "a.obj", "--max-level", "33", parts=["--max-level", "'33'", "0 to 32"])
        self.expect("detect", "a.obj", "--leaf-size", "0", parts=["--leaf-size", "'0'"])
        self.expect("detect", "scene.toml", "--frames", "0", parts=["--frames", "'0'"])
        for value in ("-1", "inf", "nan", "1e999", "1 ", "x", ""):
            self.expect("detect", "a.obj", "--contacts", "continuous", "--min-separation", value, parts=["--min-separation", f"'{value}'", "from 0 up"])
        self.expect("detect", "a.obj", "--contacts", "continuous", "--undecided", "yes", parts=["--undecided", "report, exact"])
        self.expect("detect", "a.obj", "--broad-phase", "", parts=["--broad-phase", "automatic, octree, grid, sweep, brute, sweep3"])
        self.expect("detect", "a.obj", "--json", parts=["--json"])

    def test_options_that_would_have_no_effect(self):
        self.expect("detect", "a.obj", "--sphere-fit", "box", parts=["--sphere-fit", "--bounding-volume sphere"])
        self.expect("detect", "a.obj", "--region-test", "arvo", parts=["--region-test", "--bounding-volume sphere"])
        self.expect("detect", "a.obj", "--no-stats", parts=["--no-stats", "--json"])
        self.expect("detect", "a.obj", "--frames", "3", parts=["--frames", "a.obj has 1 frame"])
        for flag in ("--verify", "--fail-on-contact"):
            self.expect("detect", "a.obj", "--contacts", "none", flag, parts=[flag, "--contacts intersection"])
        self.expect("detect", "a.obj", "--contacts", "none", "--contact-details", "--json", "x", parts=["--contact-details", "contacts"])
        self.expect("detect", "a.obj", "--colliding-vertices", parts=["--colliding-vertices", "--json"])
        for flag in (("--min-separation", "0"), ("--undecided", "report")):
            self.expect("detect", "a.obj", *flag, parts=[flag[0], "--contacts continuous"])
            self.expect("detect", "a.obj", "--contacts", "none", *flag, parts=[flag[0], "--contacts continuous"])
        self.expect("detect", "a.obj", "--contacts", "continuous", "--contact-details", parts=["--contact-details", "--json"])
        self.expect("detect", "a.obj", "--contacts", "continuous", "--no-contact-points", parts=["--no-contact-points", "--contacts intersection"])
        self.expect("detect", "a.obj", "--json", "-", "--csv", "-", parts=["--csv", "--json"])

    def test_inputs(self):
        self.expect("detect", "nothing.obj", parts=["nothing.obj", "no such file"])
        self.expect("detect", "frame_*.ply", parts=["frame_*.ply", "no file matches"])
        self.expect("detect", "scene.toml", "a.obj", parts=["scene.toml", "only input"])
        self.expect("detect", "--sequence", "scene.toml", parts=["scene.toml", "--sequence"])
        self.expect("detect", "--sequence", "a.obj", "none.obj", parts=["none.obj", "no such file"])
        self.expect("detect", ".", parts=["."])
        self.expect("info", "nothing.obj", parts=["nothing.obj", "no such file"])

    def test_continuous_contacts_of_one_frame(self):
        self.write("frame_1.obj", TRIANGLE)
        self.expect("detect", "--contacts", "continuous", "--sequence", "frame_*.obj", parts=["frame_1.obj", "two frames"])

    def test_broken_mesh_names_file_and_line(self):
        self.write("bad.obj", "v 0 0 0\nv 1 0 0\nf 1 2 99\n")
        self.expect("detect", "bad.obj", parts=["bad.obj", "3", "99"])
        self.expect("info", "bad.obj", parts=["bad.obj", "3", "99"])

    def test_unknown_format_says_which_are_known(self):
        self.write("a.nothing", "0 0 0\n")
        self.expect("detect", "a.nothing", parts=["a.nothing", "obj", "ply"])

    def test_outputs(self):
        self.expect("detect", "a.obj", "--json", "no/such/folder.json", parts=["no/such/folder.json", "cannot write"])
        self.expect("detect", "a.obj", "--csv", "no/such/folder.csv", parts=["no/such/folder.csv", "cannot write"])

    def test_file_names_with_line_breaks_still_give_one_line(self):
        self.expect("detect", "no\nsuch.obj", parts=["no such.obj"])

    def test_outputs_never_replace_inputs_or_each_other(self):
        self.write("meshed.toml", '[[object]]\nmesh = "b.obj"\n')
        self.assertEqual(self.run_here("simulate", "scene.toml", "--frames", "2", "--record", "run.h5", "--quiet").status, 0)
        (self.folder / "link.obj").symlink_to("a.obj")
        self.write("points.txt", "0 0 0\n")
        before = {path.name: path.read_bytes() for path in self.folder.iterdir()}
        for option, name, arguments in (
            ("--json", "a.obj", ["detect", "a.obj", "b.obj", "--json"]),
            ("--csv", "./a.obj", ["detect", "a.obj", "b.obj", "--csv"]),
            ("--json", "link.obj", ["detect", "a.obj", "b.obj", "--json"]),
            ("--json", "b.obj", ["detect", "?.obj", "--json"]),
            ("--json", "b.obj", ["detect", "a.obj", "b.obj", "--sequence", "--json"]),
            ("--json", "meshed.toml", ["detect", "meshed.toml", "--json"]),
            ("--csv", "b.obj", ["detect", "meshed.toml", "--csv"]),
            ("--json", "run.h5", ["detect", "run.h5", "--json"]),
            ("--record", "meshed.toml", ["simulate", "meshed.toml", "--record"]),
            ("--json", "a.obj", ["info", "a.obj", "--json"]),
            ("--json", "a.obj", ["query", "closest", "points.txt", "a.obj", "--json"]),
            ("--json", "points.txt", ["query", "closest", "points.txt", "a.obj", "--json"]),
            ("--json", "run.h5", ["diff", "run.h5", "run.h5", "--json"]),
        ):
            self.expect(*arguments, name, parts=[f"{option}: {name} is an input"])
        page = self.run_here("view", "a.obj", "--export", "a.obj")
        self.assertEqual(page.status, 2)
        self.assertRegex(page.error, "--export: a.obj is an input|built without the viewer")
        for arguments in (
            ["detect", "a.obj", "b.obj", "--json", "x", "--csv", "./x"],
            ["simulate", "scene.toml", "--json", "x.h5", "--record", "x.h5"],
            ["simulate", "scene.toml", "--csv", "x.xdmf", "--record", "x.h5"],
        ):
            self.expect(*arguments, parts=["already writes"])
        self.assertEqual({path.name: path.read_bytes() for path in self.folder.iterdir()}, before)
        done = self.run_here("detect", "a.obj", "b.obj", "--json", "/dev/null", "--csv", "/dev/null", "--quiet")
        self.assertEqual((done.status, done.error), (0, ""))

    def test_closed_streams_are_not_taken_by_files(self):
        for closed in ([1], [2], [0, 1, 2]):
            with self.subTest(closed=closed):

                def status_of(*arguments, closed=closed):
                    close = lambda: [os.close(stream) for stream in closed]
                    return subprocess.run([PROGRAM, *arguments, "--quiet"], cwd=self.folder, preexec_fn=close).returncode

                self.assertEqual(status_of("detect", "a.obj", "b.obj", "--json", "x.json", "--csv", "x.csv"), 0)
                self.assertEqual(len(json.loads((self.folder / "x.json").read_text())["objects"]), 2)
                self.assertTrue((self.folder / "x.csv").read_text().startswith("frame,"))
                self.assertEqual(status_of("simulate", "scene.toml", "--frames", "3", "--record", "x.h5"), 0)
                self.assertEqual(self.run_here("detect", "x.h5", "--quiet").status, 0)

    def test_limit_of_the_file_size(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64))
        command = [PROGRAM, "detect", "a.obj", "b.obj", "--quiet", "--json", "x.json"]
        done = subprocess.run(command, cwd=self.folder, preexec_fn=limit, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (2, "supple: x.json: writing failed; is the disk full?\n"))

    def test_folders_are_no_files(self):
        (self.folder / "folder.toml").mkdir()
        self.write("vf.csv", "")
        self.expect("detect", "folder.toml", parts=["folder.toml: is not a regular file but a folder"])
        self.expect("query", "closest", "folder.toml", "a.obj", parts=["folder.toml"])
        self.expect("ccd-queries", "vf.csv", "--answers", "folder.toml", parts=["folder.toml"])

    def test_named_pipes_and_devices_are_no_files(self):
        """A named pipe without a writer would block the program, and /dev/zero has no end."""
        self.write("vf.csv", "0,1,0,1,0,1\n" * 8)
        self.write("pipe_scene.toml", '[[object]]\nmesh = "pipe.obj"\n')
        self.write("frames.toml", '[[object]]\nmodel = "box"\nmotion = { kind = "frames", files = "pipe.obj" }\n')
        for name in ("pipe.obj", "pipe.glb", "pipe.toml", "pipe.h5", "pipe.txt", "pipe_vf.csv"):
            os.mkfifo(self.folder / name)
            (self.folder / name.replace("pipe", "device")).symlink_to("/dev/zero")
        for arguments in (
            ["info", "pipe.obj"],
            ["info", "pipe.glb"],
            ["detect", "--sequence", "pipe.obj"],
            ["detect", "pipe_scene.toml"],
            ["simulate", "frames.toml"],
            ["detect", "pipe.toml"],
            ["info", "pipe.h5"],
            ["simulate", "scene.toml", "--record", "pipe.h5"],
            ["query", "closest", "pipe.txt", "a.obj"],
            ["query", "rays", "pipe.txt", "a.obj"],
            ["ccd-queries", "pipe_vf.csv"],
            ["ccd-queries", "vf.csv", "--answers", "pipe.txt"],
        ):
            for kind in ("pipe", "device"):
                if kind == "device" and ("pipe_scene.toml" in arguments or "frames.toml" in arguments):
                    continue  # these name the pipe
                given = [word.replace("pipe", kind) for word in arguments]
                done = Result(subprocess.run([PROGRAM, *given], cwd=self.folder, capture_output=True, text=True, timeout=600))
                self.assert_one_line_error(done, kind)
                self.assertRegex(done.error, "regular file|a pipe or a device", given)

    def test_pipes_of_the_shell_are_read(self):
        for given in ("<(echo 0.1 0.1 0)", "/dev/stdin"):
            command = f'echo 0.1 0.1 0 | "{PROGRAM}" query closest {given} a.obj --json -'
            done = subprocess.run(["bash", "-c", command], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertEqual(len(json.loads(done.stdout)["results"]), 1)

    def test_names_that_the_system_refuses(self):
        long = "x" * 300
        (self.folder / "loop.obj").symlink_to("loop.obj")
        for arguments in (["info", f"{long}.obj"], ["detect", f"{long}.toml"], ["query", "closest", long, "a.obj"],
                          ["info", "loop.obj"], ["ccd-queries", f"{long}_vf.csv"], ["detect", "a.obj", "--json", long]):
            self.expect(*arguments, parts=["; c"])
        self.write("zero.toml", '[[object]]\nmesh = "a.obj\\u0000.obj"\n')
        self.expect("info", "zero.toml", parts=["zero.toml:2: [[object]] 0: mesh: has a character of code 0"])

    def test_files_that_fail_while_read(self):
        """The first bytes of /proc/self/mem cannot be read."""
        self.write("vf.csv", "0,1,0,1,0,1\n" * 8)
        for name in ("bad.obj", "bad.toml", "bad.txt", "bad_vf.csv"):
            (self.folder / name).symlink_to("/proc/self/mem")
        for arguments in (["info", "bad.obj"], ["detect", "bad.toml"], ["query", "closest", "bad.txt", "a.obj"],
                          ["ccd-queries", "bad_vf.csv"], ["ccd-queries", "vf.csv", "--answers", "bad.txt"]):
            self.expect(*arguments, parts=[arguments[-1] if arguments[0] != "query" else "bad.txt", "read"])

    @unittest.skipIf("SUPPLE_SANITIZED" in os.environ, "a sanitizer needs more addresses")
    def test_memory(self):
        self.write("large.toml", '[[object]]\nmodel = "icosphere"\nfrequency = 4000\n')
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))
        command = [PROGRAM, "detect", "large.toml", "--threads", "1"]
        done = subprocess.run(command, cwd=self.folder, preexec_fn=limit, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertRegex(done.stderr, "^supple: the memory is used up; [^\n]*\n$")

    def test_full_disk(self):
        for flag in ("--json", "--csv"):
            self.expect("detect", "a.obj", "--quiet", flag, "/dev/full", parts=["/dev/full", "disk full"])
        for command in ("detect", "info"):
            with open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run([PROGRAM, command, self.folder / "a.obj"], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(done.stderr, "supple: standard output: writing failed; is the disk full?\n")


class ExitStatus(ProgramTest):
    def setUp(self):
        super().setUp()
        for name, mesh in (("a", TRIANGLE), ("b", UPRIGHT), ("far", FAR), ("crossed", CROSSED)):
            self.write(f"{name}.obj", mesh)

    def status(self, *arguments):
        done = self.run_here("detect", "--quiet", *arguments)
        self.assertEqual((done.out, done.error), ("", ""))
        return done.status

    def test_contact_is_no_failure_unless_asked(self):
        self.assertEqual(self.status("a.obj", "b.obj"), 0)

    def test_fail_on_contact(self):
        self.assertEqual(self.status("a.obj", "b.obj", "--fail-on-contact"), 1)
        self.assertEqual(self.status("a.obj", "far.obj", "--fail-on-contact"), 0)

    def test_fail_on_contact_with_itself(self):
        done = self.run_here("detect", "--quiet", "crossed.obj", "--fail-on-contact")
        self.assertEqual(done.status, 2)
        self.assertIn("--self", done.error)
        self.assertEqual(self.status("crossed.obj", "--fail-on-contact", "--self"), 1)

    def test_fail_on_contact_in_any_frame(self):
        self.write("frame_1.obj", CROSSED)
        apart = (CROSSED[0][:3] + [(x + 9, y, z) for x, y, z in CROSSED[0][3:]], CROSSED[1])
        self.write("frame_2.obj", apart)
        self.assertEqual(self.status("--sequence", "frame_*.obj", "--self", "--fail-on-contact"), 1)

    def test_fail_on_contact_within_any_step(self):
        for number, height in enumerate((4, 1, -1, -20)):
            self.write(f"fall_{number}.obj", joined(FLOOR, moved(SPIKE, 0, 0, height)))
        falls = ("--contacts", "continuous", "--self", "--fail-on-contact", "--sequence")
        self.assertEqual(self.status(*falls, "fall_?.obj"), 1)
        self.assertEqual(self.status(*falls, "fall_0.obj", "fall_1.obj"), 0)

    def test_verify_agrees(self):
        self.assertEqual(self.status("a.obj", "b.obj", "--verify"), 0)

    def test_verify_differs(self):
        # The paper's spheres do not enclose the corners of boxes and miss this contact of two tips.
        low = ([(0.0, 0.0, 0.0), (1.0, 0.0, 1.0), (1.0, 1.0, 1.0)], [(0, 1, 2)])
        high = ([(1.0, 1.0, 1.0), (2.0, 1.0, 2.0), (2.0, 2.0, 2.0)], [(0, 1, 2)])
        self.write("low.obj", low)
        self.write("high.obj", high)
        spheres = ("low.obj", "high.obj", "--verify", "--bounding-volume", "sphere")
        self.assertEqual(self.status(*spheres), 0)
        done = self.run_here("detect", *spheres, "--sphere-fit", "box", "--fail-on-contact", "--json", "result.json")
        self.assertEqual(done.status, 3)
        self.assertEqual(len(done.error.splitlines()), 1)
        self.assertIn("not reported", done.error)
        self.assertIn('"differences":[{"a":0,"b":1,"triangle_a":0,"triangle_b":0,"missed":true}]', (self.folder / "result.json").read_text())


if __name__ == "__main__":
    unittest.main()
