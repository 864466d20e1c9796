#!/usr/bin/env python3
"""./dev peers on few ticks: our engines, the bare loop and Icarus agree; one that plays something else is found.

test_peers.py TREE: the built tree, with its program brick_peers.
"""

import contextlib
import io
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

import tree

TOOLS = pathlib.Path(__file__).resolve().parents[3] / "tools"
sys.path.insert(0, str(TOOLS))

import peers  # noqa: E402

TREE = sys.argv.pop(1)
FEW = ["--only", "bare", "rtl", "model", "icarus", "--steps", "100", "--runs", "1", "--tree", TREE]


def run(*more):
    done = subprocess.run([sys.executable, TOOLS / "peers.py", *FEW, *more], capture_output=True, text=True,
                          check=False)
    if "is left out: " in done.stdout:
        raise unittest.SkipTest(done.stdout)
    return done


class Fake:
    """A peer that plays in no time, or lacks its simulator."""

    def __init__(self, lacks=None):
        self.lacks = lacks

    def build(self, _folder):
        if self.lacks:
            raise peers.Missing(self.lacks)

    def play(self, steps, _flip):
        return f"{steps} sum\n", 1.0 + steps


class Installed(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "docs").mkdir()

    def peers(self, known, *arguments):
        """(status, what it says) with these peers."""
        found = {name: (f"engine {name}", 10, peer) for name, peer in known.items()}
        with mock.patch.multiple(peers, peers=lambda _: found, ROOT=self.root), \
             mock.patch.object(sys, "argv", ["peers.py", "--tree", str(self.root), "--runs", "1", *arguments]), \
             contextlib.redirect_stdout(io.StringIO()) as said, contextlib.redirect_stderr(said):
            try:
                peers.main()
                status = 0
            except SystemExit as end:
                status = end.code
        return status, said.getvalue()

    def test_what_is_not_installed_is_left_out(self):
        status, said = self.peers({"a": Fake(), "b": Fake("simulator b is not installed"), "c": Fake()})
        self.assertEqual(status, 77, said)  # what is passed is all of them
        self.assertIn("b is left out: simulator b is not installed\n", said)
        self.assertEqual([name in said for name in ("engine a", "engine b", "engine c")], [True, False, True])

    def test_skipped_is_what_is_not_compared(self):
        known = {"a": Fake(), "b": Fake("no b")}
        self.assertEqual(self.peers({"a": Fake(), "b": Fake()}, "--only", "a", "b")[0], 0)
        self.assertEqual(self.peers({"a": Fake(), "b": Fake()}, "--only", "a")[0], 77)
        self.assertEqual(self.peers({"b": Fake("no b")})[0], 77)
        self.assertEqual(self.peers(known, "--flip", "b")[0], 77)
        self.assertEqual(self.peers(known, "--only", "b")[0], 77)
        self.assertEqual(self.peers(known, "--flip", "b", "--only", "a")[0], 2)

    def test_a_page_is_of_all_that_there_are(self):
        status, said = self.peers({"a": Fake(), "b": Fake("no b")}, "--write")
        self.assertEqual(status, 1)
        self.assertIn("docs/peers.md is of all peers, and not written without b", said)
        self.assertFalse((self.root / peers.PAGE).exists())
        self.assertEqual(self.peers({"a": Fake(), "b": Fake()}, "--write")[0], 0)
        self.assertIn("engine b", (self.root / peers.PAGE).read_text())

    def test_one_that_does_not_end_is_ended_with_its_children(self):
        for command, limit in (("sleep 300", 0.5), (f"sleep 300 & echo $! >{self.root}/child; wait", 5)):
            with self.assertRaisesRegex(peers.Failed, f"^sh: no end within {limit} s$"):
                peers.run(["sh", "-c", command], limit=limit)
        self.ends((self.root / "child").read_text().strip())

    def test_what_ends_a_run_ends_its_children(self):
        """Also a signal that nobody can answer, as of a run of `brick regress` that is over its limit."""
        for ended_by in (signal.SIGKILL, signal.SIGINT):
            child = self.root / f"child{ended_by}"
            code = (f"import signal, sys; sys.path.insert(0, {str(TOOLS)!r}); import peers; "
                    "signal.signal(signal.SIGINT, signal.default_int_handler); "
                    f"peers.run(['sh', '-c', 'echo $$ >{child}.new; mv {child}.new {child}; exec sleep 300'])")
            with subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.DEVNULL) as outer:
                while not child.exists() and outer.poll() is None:
                    time.sleep(0.02)
                outer.send_signal(ended_by)
                outer.wait(60)
            self.ends(child.read_text().strip())

    def ends(self, number):
        for _ in range(100):
            with contextlib.suppress(FileNotFoundError, ProcessLookupError):
                if pathlib.Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0] != "Z":
                    time.sleep(0.1)
                    continue
            return
        self.fail(f"process {number} goes on")

    def test_whose_fault_it_is_is_said(self):
        class Endless(Fake):
            def play(self, steps, _flip):
                return peers.run(["sleep", "300"], limit=0.2)

        self.assertEqual(self.peers({"a": Fake(), "b": Endless()}), (1, "peers: b: sleep: no end within 0.2 s\n"))


class Peers(unittest.TestCase):
    def test_all_agree_and_have_a_rate(self):
        done = run()
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = [line for line in done.stdout.splitlines()[2:] if line.startswith("| ")]
        self.assertEqual(len(rows), 4)
        self.assertTrue(all(float(row.split("|")[3]) > 0 for row in rows), done.stdout)

    def test_another_stimulus_is_found_in_whoever_has_it(self):
        for peer in ("model", "rtl", "icarus"):
            done = run("--flip", peer)
            self.assertEqual(done.returncode, 1, peer)
            self.assertIn("the peers disagree at step 1: ", done.stderr)

    def test_what_has_played_less_is_compared_as_far_as_it_has(self):
        played = {"a": {1: "x", 10: "y", 100: "z"}, "b": {1: "x", 10: "y"}, "c": {1: "x", 7: "w"}}
        self.assertIsNone(peers.differing(played))
        played["b"][10] = "other"
        self.assertEqual(peers.differing(played), "step 10: a y, b other")

    def test_a_page_is_of_all_peers(self):
        done = run("--write")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--write: of all peers", done.stderr)


if __name__ == "__main__":
    tree.run()
