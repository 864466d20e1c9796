"""The freshness check fails on a stale or missing header; the generated files are fresh; the pages are made."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
GENERATE = ROOT / "rtl/regs/generate.py"


def run(*arguments):
    return subprocess.run([sys.executable, GENERATE, *arguments], check=False, stdout=subprocess.PIPE, text=True)


WORDS = ("rtl/regs/brick_regs_pkg.sv", "rtl/regs/brick_regs.h", "rtl/regs/brick_regs.hpp", "docs/registers.md")
NAMES = (*WORDS, *(f"rtl/regs/{component}.xml" for component in ("servo_ic", "macro_ic", "board")))
RESET = dict.fromkeys(WORDS, ("3038D2", "3008D2"))  # of X:+4; in IP-XACT each field has its own


class StaleFiles(unittest.TestCase):
    def test_each_file_is_watched(self):
        with tempfile.TemporaryDirectory() as tree:
            self.assertEqual(run("--output", tree).returncode, 0)
            self.assertEqual(run("--check", "--output", tree).returncode, 0)
            for name in NAMES:
                file = Path(tree) / name
                old, new = RESET.get(name, ("<ipxact:bitOffset>3<", "<ipxact:bitOffset>4<"))
                self.assertIn(old, file.read_text())
                file.write_text(file.read_text().replace(old, new, 1))
            self.assert_stale(tree)
            for name in NAMES:
                (Path(tree) / name).unlink()
            self.assert_stale(tree)

    def assert_stale(self, tree):
        done = run("--check", "--output", tree)
        self.assertEqual(done.returncode, 1)
        for name in NAMES:
            self.assertIn(f"{name} is stale", done.stdout)


class Pages(unittest.TestCase):
    """--html: a page each block and register, and what finds them."""

    def test_pages_have_every_block(self):
        with tempfile.TemporaryDirectory() as tree:
            pages = Path(tree) / "pages"
            done = run("--check", "--html", pages)
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertEqual(done.stdout, f"{pages}/index.html\n")
            self.assertIn("<html", (pages / "index.html").read_text())
            self.assertGreater(len(list((pages / "content").glob("*.html"))), 100)  # 32 + 64 offsets, the board's
            data = (pages / "data/ral-data-0.json").read_text()
            for name in ("brick_cpu", "servo_channel_fine", "brick_host_io", "clock_control", "pwm_control"):
                self.assertIn(f'"{name}', data)


if __name__ == "__main__":
    try:
        import peakrdl_html  # noqa: F401
        import peakrdl_ipxact  # noqa: F401
    except ImportError as missing:
        print(f"skipped: {missing}")
        sys.exit(77)
    unittest.main()
