"""Tests runs that a limit, a signal or a broken name could spoil: their files are whole and say so."""

import json
import os
import signal
import subprocess
import time
import unittest

from program import CROSSED, FAR, PROGRAM, TRIANGLE, UPRIGHT, ProgramTest, joined, moved

WAVE = '[[object]]\nmodel = "box"\nmotion = { kind = "rigid", velocity = [0.001, 0, 0] }\n[[object]]\nmodel = "box"\ntranslate = [0.1, 0.1, 0.1]\n'


class Limits(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.obj", joined(TRIANGLE, moved(TRIANGLE, 0, 0, 0.5)))
        self.write("b.obj", UPRIGHT)
        self.write("far.obj", FAR)
        self.write("wave.toml", WAVE)

    def read(self, name):
        return json.loads((self.folder / name).read_text())

    def test_max_contacts(self):
        done = self.run_here("detect", "a.obj", "b.obj", "--max-contacts", "1", "--json", "x.json", "--csv", "x.csv")
        self.assertEqual(done.status, 0)
        self.assertRegex(done.error, "^supple: a frame has more contacts than --max-contacts 1; [^\n]*\n$")
        result = self.read("x.json")
        self.assertEqual((result["truncated"], result["frames"][0]["truncated"]), (True, True))
        self.assertEqual(result["frames"][0]["triangle_pairs"], [{"a": 0, "b": 1, "pairs": [[0, 0]]}])
        self.assertEqual((self.folder / "x.csv").read_text(), "frame,a,b,triangle_a,triangle_b,kind\n0,0,1,0,0,segment\ntruncated,,,,,\n")
        result = self.detect("a.obj", "b.obj", "--max-contacts", "2")
        self.assertEqual((result["truncated"], result["frames"][0]["truncated"]), (False, False))
        for arguments in (["--verify"], ["--contacts", "penetration"], ["--contacts", "none"]):
            self.assert_one_line_error(self.run_here("detect", "a.obj", "b.obj", "--max-contacts", "1", *arguments), "--max-contacts")
        self.assert_one_line_error(self.run_here("detect", "a.obj", "b.obj", "--max-contacts", "0"), "--max-contacts")

    def test_time_limit(self):
        """A time that has passed before the first frame: the files are whole and empty."""
        self.write("wave.toml", WAVE.replace("0.1, 0.1, 0.1", "9, 0, 0"))
        for command, extra in (("detect", ()), ("simulate", ("--record", "x.h5"))):
            done = self.run_here(command, "wave.toml", "--frames", "1000000000", "--time-limit", "1e-9", "--json", "x.json", "--csv", "x.csv", *extra, "--fail-on-contact")
            self.assertEqual(done.status, 2, done.error)
            self.assertRegex(done.error, "supple: the time limit of 1e-09 s ended the run after 0 of [0-9,]+ (frames|steps)")
            result = self.read("x.json")
            self.assertEqual((result["truncated"], result["frames"][1:]), (True, []))
            self.assertTrue((self.folder / "x.csv").read_text().endswith("\ntruncated,,,,,\n"))
            self.assertNotIn("Nothing touches", done.out)
        done = self.run_here("detect", "a.obj", "b.obj", "--time-limit", "1e9", "--fail-on-contact", "--quiet")
        self.assertEqual((done.status, done.error), (1, ""))

    def test_limits_of_queries(self):
        self.write("p.txt", "0 0 1\n0 0 2\n0 0 3\n")
        done = self.run_here("query", "closest", "p.txt", "a.obj", "--max-contacts", "2", "--json", "x.json", "--quiet")
        self.assertEqual(done.status, 0)
        self.assertIn("--max-contacts 2", done.error)
        result = self.read("x.json")
        self.assertEqual((len(result["results"]), result["truncated"]), (2, True))
        done = self.run_here("query", "distance", "a.obj", "b.obj", "far.obj", "--max-contacts", "1", "--json", "x.json", "--quiet")
        self.assertEqual((done.status, len(self.read("x.json")["results"]), self.read("x.json")["truncated"]), (0, 1, True))
        done = self.run_here("query", "closest", "p.txt", "a.obj", "--json", "-")
        self.assertEqual((done.error, json.loads(done.out)["truncated"]), ("", False))
        done = self.run_here("query", "closest", "p.txt", "a.obj", "--time-limit", "1e-9", "--json", "x.json")
        self.assertEqual(done.status, 0)
        self.assertIn("time limit", done.error)
        self.assertEqual((self.read("x.json")["results"], self.read("x.json")["truncated"]), ([], True))

    def wait_for(self, name, text):
        path = self.folder / name
        while not path.exists() or text not in path.read_text():
            time.sleep(0.01)

    def test_signals(self):
        for number, status in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            for contacts in ("intersection", "continuous"):
                (self.folder / "x.json").unlink(missing_ok=True)
                process = subprocess.Popen([PROGRAM, "detect", "wave.toml", "--frames", "1000000000", "--contacts", contacts, "--json", "x.json", "--csv", "x.csv"],
                                           cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                self.wait_for("x.json", '"frame":1')
                process.send_signal(number)
                out, error = process.communicate()
                self.assertEqual(process.returncode, status, error)
                self.assertRegex(error, "^supple: interrupted after [0-9,]+ of (1,000,000,000 frames|999,999,999 steps)\n$")
                result = self.read("x.json")
                self.assertEqual(result["truncated"], True)
                self.assertGreaterEqual(len(result["frames"]), 1)
                self.assertTrue((self.folder / "x.csv").read_text().endswith(",\n"))
                self.assertIn("ms per", out)

    def test_signals_while_the_input_is_read(self):
        """The program has written nothing then."""
        process = subprocess.Popen([PROGRAM, "query", "closest", "/dev/stdin", "a.obj", "--json", "x.json"], cwd=self.folder,
                                   stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        process.stdin.write("0 0 1\n" * 100000)  # more than the pipe holds, so the program reads
        process.stdin.flush()
        process.send_signal(signal.SIGINT)
        process.communicate()
        self.assertEqual(process.returncode, 130)


class Names(ProgramTest):
    """Names may be any bytes, but the program writes valid UTF-8."""

    BAD = b"n\xffm\xc3"

    def bytes_of(self, *arguments):
        done = subprocess.run([os.fsencode(PROGRAM), *arguments], cwd=self.folder, capture_output=True)
        for text in (done.stdout, done.stderr):
            text.decode("utf-8")  # throws when it is not valid
        return done

    def test_names(self):
        bad = self.BAD + b".obj"
        path = os.path.join(os.fsencode(self.folder), bad)
        with open(path, "wb") as file:
            file.write(b"o " + self.BAD + b"\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.2 0.2 1\nv 0.3 0.2 1\nf 1 2 3\nf 4 5 6\n")
        with open(os.path.join(os.fsencode(self.folder), b"scene.toml"), "wb") as file:
            file.write(b'[[object]]\nmodel = "box"\nname = "n\xffm"\n')
        with open(os.path.join(os.fsencode(self.folder), b"p.txt"), "wb") as file:
            file.write(b"0 0 \xff\xfe\n")
        self.write("a.obj", TRIANGLE)
        shown = "n\ufffdm\ufffd"
        self.assertIn(shown, self.bytes_of(b"detect", bad, b"--self").stdout.decode())
        self.assertIn(shown, self.bytes_of(b"detect", bad, b"--self", b"--json", b"-").stdout.decode())
        self.assertIn(shown, self.bytes_of(b"info", bad).stdout.decode())
        for arguments in (
            [b"detect", b"no" + bad], [b"detect", bad, b"--self", b"--csv", b"no/" + bad], [b"detect", b"a.obj", b"--s\xfflf"], [b"d\xfftect"],
            [b"detect", b"a.obj", b"--contacts", b"\xff"], [b"query", b"closest", b"p.txt", b"a.obj"], [b"query", b"inside", b"/dev/null", bad],
            [b"info", b"scene.toml"], [b"info", bad + b".x\xff"], [b"detect", b"*" + bad + b"?.ply"], [b"simulate", bad], [b"ccd-queries", bad],
            [b"diff", bad, bad], [b"detect", bad, bad, b"--json", bad], [b"detect", bad, b"--threads", b"\xe2\x82"],
        ):
            done = self.bytes_of(*arguments)
            self.assertEqual((done.returncode, done.stdout), (2, b""), arguments)
            self.assertEqual(len(done.stderr.decode().splitlines()), 1, done.stderr)


if __name__ == "__main__":
    unittest.main()
