"""examples/tuning, from an installed tree: its tables are what the controller gathers, and what the formulas ask for."""

import importlib.util
import math
import os
import pathlib
import subprocess
import sys

from installed import Installed, main


class Tuning(Installed):
    def run_example(self, *arguments):
        return subprocess.run([sys.executable, self.data / "examples/tuning/tune.py", *arguments], text=True, timeout=120,
                              env={**os.environ, "BRICK": f"{self.build}/bin/brick"}, capture_output=True)

    def table(self, name):
        lines = (self.data / "examples/tuning" / name).read_text().splitlines()
        self.assertEqual(lines[0], "ms,commanded,actual,output")
        return [tuple(float(v) for v in line.split(",")) for line in lines[1:]]

    def moving(self, name):
        spec = importlib.util.spec_from_file_location("tune", self.data / "examples/tuning/tune.py")
        tune = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(tune)
        return tune.from_step(self.table(name))

    def test_tables_are_what_is_gathered_and_gains_show_in_them(self):
        done = self.run_example("--check")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        page = (self.data / "examples/tuning/README.md").read_text()
        for line in done.stdout.splitlines():
            self.assertIn(line, page)
        self.plant("examples/tuning/tuning.pmc", "I132=0 I133=0 I135=0", "I131=1450 I132=0 I133=0 I135=0")
        done = self.run_example("--check")
        self.assertIn("step.csv is not what is gathered today", done.stderr)
        # Half of the damping: exp(-pi d / sqrt(1 - d^2)) with d = 0.5 is 16 %.
        done = self.run_example(str(self.prefix))
        overshoot = float(done.stdout.split("overshoot ")[1].split(" %")[0])
        self.assertAlmostEqual(overshoot, 16.3, delta=5)

    def test_the_step_is_that_of_a_critically_damped_loop(self):
        rows = self.moving("step.csv")
        self.assertGreater(len(rows), 190)
        for t, commanded, actual, _ in rows[1:]:
            self.assertEqual(commanded, 50)
            # Two servo interrupts from the step to the first torque that acts, and Coulomb friction: 0.8 counts.
            ideal = [50 * (1 - (1 + 0.2 * max(0.0, t - late)) * math.exp(-0.2 * max(0.0, t - late))) for late in (0, 2)]
            self.assertGreater(actual, min(ideal) - 2.5, t)
            self.assertLess(actual, max(ideal) + 2.5, t)

    def test_the_jog_is_two_parabolas_of_speed(self):
        rows = self.moving("parabola.csv")
        def place(t):
            """Acceleration rises for 100 ms, falls for 100 ms: 20 counts/ms."""
            jerk = 20 / 100**2
            if t <= 100:
                return jerk * t**3 / 6
            if t <= 200:
                return 2000 - 20 * (200 - t) + jerk * (200 - t)**3 / 6
            return 4000 - place(max(0, 400 - t)) if t < 400 else 4000
        # It begins so slowly that the first row which has moved may be 2 ms behind the beginning.
        fits = [max(abs(c - place(t + late)) for t, c, _, _ in rows) for late in (n * 0.005 for n in range(400))]
        self.assertLess(min(fits), 1 / 8)
        self.assertEqual(rows[-1][1], 4000)
        self.assertLess(max(abs(c - a) for _, c, a, _ in rows), 5)


if __name__ == "__main__":
    if not pathlib.Path(sys.argv[1], "bin/brick").exists():
        print("skipped: brick is not built")
        sys.exit(77)
    main(sys.argv)
