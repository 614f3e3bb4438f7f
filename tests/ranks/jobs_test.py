"""Jobs of several ranks: how they start, and how they end early."""

import json
import os
import shutil
import signal
import subprocess
import unittest

from ranks import MPIEXEC, PROGRAM, SCENES, RanksTest, eventually, launch, pid_of_rank


class Jobs(RanksTest):
    def start_long_run(self):
        """Returns the job when it has written frames."""
        job = subprocess.Popen(
            [MPIEXEC, "-n", "2", PROGRAM, "simulate", SCENES / "nine.toml", "--frames", "1000000", "--json", "out.json"],
            cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        out = self.folder / "out.json"
        eventually(lambda: out.exists() and '"frame":1' in out.read_text().replace(" ", ""))
        return job

    def test_a_killed_rank_ends_the_job(self):
        job = self.start_long_run()
        os.kill(eventually(lambda: pid_of_rank(1, job.pid)), signal.SIGKILL)
        _, error = job.communicate(timeout=600)
        self.assertNotEqual(job.returncode, 0)
        self.assertRegex(error, r"process rank 1 .*exited on signal 9")

    def test_a_signal_at_one_rank_ends_all_with_whole_files(self):
        job = self.start_long_run()
        os.kill(eventually(lambda: pid_of_rank(1, job.pid)), signal.SIGTERM)
        _, error = job.communicate(timeout=600)
        self.assertEqual(job.returncode, 128 + signal.SIGTERM)
        self.assertEqual(error.count("supple: interrupted after"), 1, error)
        report = json.loads((self.folder / "out.json").read_text())
        self.assertTrue(report["truncated"])
        self.assertGreater(len(report["frames"]), 1)

    def test_a_time_limit_ends_between_frames(self):
        done = launch(2, "simulate", SCENES / "nine.toml", "--frames", 1000000, "--time-limit", 0.3, "--json", "out.json",
                      folder=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("supple: the time limit of 0.3 s ended the run after", done.stderr)
        self.assertTrue(json.loads((self.folder / "out.json").read_text())["truncated"])

    def test_help_once_and_other_commands(self):
        for arguments in (["--version"], ["detect", "--help"]):
            self.assertEqual(launch(2, *arguments).stdout, launch(0, *arguments).stdout)
        status, out, error, _ = self.written(2, "info", [SCENES / "nine.toml"], [])
        self.assertEqual((status, out), (2, ""))
        self.assertEqual(error, "supple: only detect and simulate run on several ranks; start one process, "
                                "without the launcher")

    def test_commands_that_ranks_of_python_start(self):
        """Each is a process of its own."""
        of_a_rank = {"OMPI_COMM_WORLD_RANK": "1", "OMPI_COMM_WORLD_SIZE": "2"}
        for arguments in (["experiment", "--help"], ["view", "--help"]):
            alone = launch(0, *arguments)
            self.assertIn("Usage", alone.stdout)
            self.assertEqual(launch(0, *arguments, **of_a_rank).stdout, alone.stdout)

    def test_a_program_without_mpi_refuses(self):
        shutil.copy(PROGRAM, self.folder / "supple")
        done = subprocess.run([MPIEXEC, "-n", "2", self.folder / "supple", "detect", "a.obj"], capture_output=True,
                              text=True, env={**os.environ, "PATH": "/usr/bin:/bin"})
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr.count("supple: "), 1, done.stderr)
        self.assertRegex(done.stderr, r"was started as 2 processes, but the program supple-mpi is neither beside this "
                                      r"program nor in PATH; build it with MPI and Zoltan, or start one process")

    def test_a_launcher_of_another_mpi(self):
        """MPI finds no other process then, and each rank would do the whole work."""
        done = launch(0, "detect", "a.obj", PMI_RANK="0", PMI_SIZE="2")
        self.assertEqual(done.returncode, 2)
        self.assertIn("the launcher started 2 processes, but MPI has 1", done.stderr)


if __name__ == "__main__":
    unittest.main()
