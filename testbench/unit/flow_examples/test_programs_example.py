"""examples/programs, from an installed tree: each plays itself to its end, and says where when its rule is broken."""

import os
import pathlib
import subprocess
import sys

from installed import Installed, main

FOLDER = "examples/programs"


class Programs(Installed):
    def run_program(self, name, plant="stage"):
        folder, brick = self.data / FOLDER, pathlib.Path(self.build, "bin/brick")
        there = [plant, "--load", plant]
        if plant != "dac8":
            there = [folder / f"{plant}.toml", "--load", folder / "stage.pmc"]
        command = ([sys.executable, folder / name] if name.endswith(".py") else
                   [brick, "exec", "--plant", *there, folder / name])
        return subprocess.run(command, text=True, timeout=120, capture_output=True, check=False,
                              env={**os.environ, "BRICK": str(brick)})

    def bites(self, name, old, new, message, plant="stage", file=None):
        """It passes; with `old` in `file` made `new` it ends with the message."""
        done = self.run_program(name, plant)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.plant(f"{FOLDER}/{file or name}", old, new)
        done = self.run_program(name, plant)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn(message, done.stderr)

    def test_homing(self):
        self.bites("homing-plc.pmc", '"#1HM#2HM"', '"#1HMZ#2HM"', "`@expect 1`: got `0`, expected `1`")

    def test_brake(self):
        """The amplifier off before the brake grips: the axis has fallen."""
        self.bites("brake-plc.pmc", "Brake_Waits=30*", "Brake_Waits=1*", "`@expect 0`: got")

    def test_encoder_loss(self):
        """The wrong motor is switched off: Y's loop goes on without its encoder."""
        self.bites("encoder-loss-plc.pmc", "ADDRESS#P400&P401", "ADDRESS#1&P401", "`@expect 1`: got `0`",
                   "encoder-loss")

    def test_scara(self):
        """The elbow's share of the shoulder on the wrong side: the pen is nowhere near the slot."""
        self.bites("scara.pmc", "P1=(Q22-Q23)*Gear", "P1=(Q22-0.9*Q23)*Gear", "`@expect 0`: got", "dac8")

    def test_trajectory_scan(self):
        self.bites("trajectory_scan.py", "M4022=M4020+2", "M4022=M4020+4", "what was commanded is not the circle",
                   file="trajectory-scan.pmc")


if __name__ == "__main__":
    if not pathlib.Path(sys.argv[1], "bin/brick").exists():
        print("skipped: brick is not built")
        sys.exit(77)
    main(sys.argv)
