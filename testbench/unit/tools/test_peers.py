#!/usr/bin/env python3
"""./dev peers on few ticks: our engines, the bare loop and Icarus agree; one that plays something else is found.

test_peers.py TREE: the built tree, with its program brick_peers.
"""

import pathlib
import subprocess
import sys
import unittest

TOOLS = pathlib.Path(__file__).resolve().parents[3] / "tools"
sys.path.insert(0, str(TOOLS))

import peers  # noqa: E402

TREE = sys.argv.pop(1)
FEW = ["--only", "bare", "rtl", "model", "icarus", "--steps", "100", "--runs", "1", "--tree", TREE]


def run(*more):
    done = subprocess.run([sys.executable, TOOLS / "peers.py", *FEW, *more], capture_output=True, text=True,
                          check=False)
    if done.returncode == 77:
        raise unittest.SkipTest(done.stdout)
    return done


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
    unittest.main()
