"""tools/sweep.py with a command of a few lines in the place of `brick`: which runs it makes, what it says of those that
fail, when it ends."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SWEEP = pathlib.Path(__file__).resolve().parents[3] / "tools/sweep.py"

# Fails for bench `odd` with an odd seed; notes each run.
BRICK = """#!/usr/bin/env python3
import sys, time
if sys.argv[1:] == ["list"]:
    print("even           passes\\nodd            fails with odd seeds")
    sys.exit()
_, bench, _, engine, _, seed = sys.argv[1:]
open({log!r}, "a").write(f"{{bench}} {{engine}} {{seed}}\\n")
if seed == "99": time.sleep(30)
bad = bench == "odd" and int(seed) % 2 == 1
print(f"     1.000 ms  {{'FAIL' if bad else 'ok  '}}  a step: 3, expected 4")
sys.exit(1 if bad else 0)
"""


class Sweep(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.brick, self.log = (pathlib.Path(folder.name) / name for name in ("brick", "log"))
        self.brick.write_text(BRICK.format(log=str(self.log)))
        self.brick.chmod(0o755)

    def sweep(self, *options):
        return subprocess.run([sys.executable, SWEEP, self.brick, *options], capture_output=True, text=True)

    def runs(self):
        return sorted(line.split() for line in self.log.read_text().splitlines()) if self.log.exists() else []

    def test_every_bench_with_every_seed(self):
        r = self.sweep("--seeds", "3", "--from", "7", "--bench", "even", "--bench", "odd", "--engine", "rtl")
        seeds = {seed for _, _, seed in self.runs()}
        self.assertEqual(len(seeds), 3)
        self.assertEqual(self.runs(), sorted([b, "rtl", s] for b in ("even", "odd") for s in seeds))
        self.assertIn("6 runs, engine rtl, fresh seeds --from 7", r.stdout)

    def test_the_same_seeds_again_and_none_that_is_usual(self):
        for origin in ("7", "7", "8"):
            self.sweep("--seeds", "40", "--bench", "even", "--from", origin)
        seeds = [seed for _, _, seed in self.runs()]
        self.assertEqual((len(seeds), len(set(seeds))), (120, 80))
        self.assertTrue(all(int(seed) > 30 for seed in seeds))

    def test_a_failure_is_told_with_its_command(self):
        r = self.sweep("--seeds", "0", "--seed", "7", "--seed", "8")
        self.assertEqual(r.returncode, 1)
        self.assertIn(f"a step: 3, expected 4\n     {self.brick} run odd --engine systemc --seed 7\n", r.stdout)
        self.assertIn("4 runs, 1 failed\n", r.stdout)

    def test_all_passed(self):
        self.assertEqual(self.sweep("--seeds", "2", "--bench", "even").returncode, 0)

    def test_a_run_that_does_not_end_is_a_failure(self):
        r = self.sweep("--seeds", "0", "--seed", "99", "--bench", "even", "--limit", "0.5")
        self.assertEqual(r.returncode, 1)
        self.assertIn("no end after 0.5 s", r.stdout)

    def test_its_time_is_over(self):
        r = self.sweep("--seeds", "5", "--minutes", "0", "--bench", "even")
        self.assertEqual((r.returncode, self.runs()), (1, []))
        self.assertIn("0 runs, 0 failed, 5 not begun", r.stdout)

    def test_bad_use(self):
        self.assertIn("no bench evne; expected one of even odd", self.sweep("--bench", "evne").stderr)
        self.assertEqual(self.sweep("--seeds", "-1").returncode, 2)
        self.brick.unlink()
        self.assertIn("expected the built command", self.sweep().stderr)


if __name__ == "__main__":
    unittest.main()
