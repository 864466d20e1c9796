"""What the tests of the scripts in tools/ share: a small tree to break a rule in, and the exit status of a run."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parents[3] / "tools"


class Tree(unittest.TestCase):
    """A temporary tree, and a way to run a tool on it."""

    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def run_tool(self, tool, *arguments):
        return subprocess.run([sys.executable, TOOLS / tool, "--root", self.root, *arguments], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def expect(self, done, status, text):
        self.assertEqual(done.returncode, status, done.stdout)
        self.assertIn(text, done.stdout)


def run():
    """All cases of the calling file. A case that lacks its program is skipped, and then so is this test in ctest's eyes
    (exit status 77)."""
    result = unittest.main(exit=False).result
    sys.exit(1 if not result.wasSuccessful() else 77 if result.skipped else 0)
