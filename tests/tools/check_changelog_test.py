"""The changelog check fails for a visible change without an entry, and only then."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

CHECK = pathlib.Path(__file__).resolve().parents[2] / "tools/check_changelog.sh"


@unittest.skipUnless(shutil.which("git"), "needs git")
class CheckChangelog(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.git("init", "-q", "-b", "main")
        self.commit("CHANGELOG.md", "first")
        self.git("checkout", "-q", "-b", "feature")

    def git(self, *arguments):
        identity = {f"GIT_{who}_{what}": "test@example.org" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
        subprocess.run(["git", *arguments], cwd=self.root, check=True, env={**os.environ, **identity})

    def commit(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        self.git("add", "-A")
        self.git("commit", "-q", "-m", name)

    def check(self, *arguments):
        done = subprocess.run([CHECK, *arguments], cwd=self.root, capture_output=True, text=True)
        return done.returncode, done.stderr

    def test_visible_change_without_entry(self):
        self.commit("include/supple/new.hpp", "x")
        code, error = self.check()
        self.assertEqual(code, 1)
        self.assertEqual(len(error.splitlines()), 1)
        self.assertIn("include/supple/new.hpp", error)

    def test_visible_change_with_entry_in_another_commit(self):
        self.commit("src/a.cpp", "x")
        self.commit("CHANGELOG.md", "second")
        self.assertEqual(self.check(), (0, ""))

    def test_change_nobody_sees(self):
        self.commit("tests/a.cpp", "x")
        self.assertEqual(self.check(), (0, ""))

    def test_on_the_main_branch_since_the_release(self):
        self.git("checkout", "-q", "main")
        self.git("tag", "v0.1.0")
        self.commit("cli/main.cpp", "x")
        self.assertEqual(self.check()[0], 1)
        self.commit("CHANGELOG.md", "second")
        self.assertEqual(self.check(), (0, ""))

    def test_base_may_be_named(self):
        self.commit("src/a.cpp", "x")
        self.assertEqual(self.check("HEAD"), (0, ""))
        self.assertEqual(self.check("HEAD~1")[0], 1)


if __name__ == "__main__":
    unittest.main()
