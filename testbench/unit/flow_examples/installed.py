"""A folder that holds what `cmake --install` puts into share/brick, without anything built, for one test."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest


class Installed(unittest.TestCase):
    build = None  # the build folder, set by main()

    @classmethod
    def setUpClass(cls):
        cls.prefix = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.prefix)
        subprocess.run(["cmake", "--install", cls.build, "--prefix", cls.prefix, "--component", "brick_sources"],
                       check=True, stdout=subprocess.DEVNULL)
        cls.data = cls.prefix / "share/brick"

    def plant(self, path, old, new):
        file = self.data / path
        text = file.read_text()
        self.assertEqual(text.count(old), 1, old)
        file.write_text(text.replace(old, new))
        self.addCleanup(file.write_text, text)


def main(arguments):
    """Runs the tests of the calling script: SCRIPT BUILD [OPTIONS]."""
    Installed.build = arguments.pop(1)
    unittest.main(argv=arguments)
