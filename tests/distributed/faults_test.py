#!/usr/bin/env python3
"""Late messages change no result, and a rank that dies ends the job with a message that says which.

usage: faults_test.py MPIEXEC TESTS
"""
import os
import subprocess
import sys
import unittest

mpiexec, tests = sys.argv[1:3]
LIVES = "DistributedScene.AllKindsEqualOneScene:DistributedScene.SafeStepsEqualOneScene"


def run(test, **faults):
    return subprocess.run([mpiexec, "-n", "3", tests, "--gtest_filter=" + test], capture_output=True, text=True,
                          timeout=500, env=os.environ | faults)


class Faults(unittest.TestCase):
    def test_late_messages(self):
        for test in (LIVES, "DistributedScene.ClosestPoints*:DistributedScene.ACheckpoint*:DistributedErrors.*"):
            job = run(test, SUPPLE_DELAY="20", SUPPLE_LIVES="1")
            self.assertEqual(job.returncode, 0, job.stdout + job.stderr)
            self.assertIn("PASSED", job.stdout)

    def test_a_rank_dies(self):
        # From the first calls of a scene to those in the middle of a life.
        for call in (1, 5, 20, 60, 150, 400):
            with self.subTest(call=call):
                job = run(LIVES, SUPPLE_KILL=f"1:{call}", OMPI_MCA_odls_base_sigkill_timeout="0")
                self.assertNotEqual(job.returncode, 0)
                self.assertNotIn("PASSED", job.stdout)
                self.assertRegex(job.stdout + job.stderr, r"rank 1 .*(signal 9|Killed)")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
