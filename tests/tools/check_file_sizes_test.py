"""The check of file sizes fails for a large tracked file, unless it is an image of the documents."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

CHECK = pathlib.Path(__file__).resolve().parents[2] / "tools/check_file_sizes.sh"


@unittest.skipUnless(shutil.which("git"), "needs git")
class CheckFileSizes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        subprocess.run(["git", "init", "-q"], cwd=self.root, check=True)

    def write(self, name, size, add=True):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(bytes(size))
        if add:
            subprocess.run(["git", "add", "--force", name], cwd=self.root, check=True)

    def check(self):
        done = subprocess.run([CHECK], cwd=self.root, capture_output=True, text=True)
        return done.returncode, done.stderr

    def test_files_up_to_the_limit(self):
        self.write("data.csv", 300_000)
        self.assertEqual(self.check(), (0, ""))

    def test_each_larger_file_is_named(self):
        self.write("default.profraw", 300_001)
        self.write("with space/data.csv", 400_000)
        code, error = self.check()
        self.assertEqual(code, 1)
        self.assertEqual(len(error.splitlines()), 2, error)
        self.assertIn("default.profraw: 300001 bytes", error)
        self.assertIn("with space/data.csv: 400000 bytes", error)

    def test_images_of_documents_may_be_large(self):
        self.write("docs/images/demo.webp", 400_000)
        self.assertEqual(self.check(), (0, ""))
        self.write("docs/images/data.json", 400_000)
        self.write("viewer/demo.png", 400_000)
        self.assertEqual(len(self.check()[1].splitlines()), 2)

    def test_files_that_git_does_not_track(self):
        self.write("build.log", 400_000, add=False)
        self.assertEqual(self.check(), (0, ""))


if __name__ == "__main__":
    unittest.main()
