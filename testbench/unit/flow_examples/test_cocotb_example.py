"""examples/cocotb_servo_channel passes on the installed RTL and names its test where a bug is planted in it."""

import importlib.util
import json
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

from installed import Installed, main

RANDOM = "random_traffic_agrees_with_the_scoreboard"


class Cocotb(Installed):
    def failed(self, *options):
        """Names of the tests that failed, of the five."""
        example, work = self.data / "examples/cocotb_servo_channel", self.prefix / "sim"
        shutil.rmtree(work, ignore_errors=True)
        done = subprocess.run([sys.executable, example / "run.py", "--build", work, *options], timeout=100, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        cases = ElementTree.parse(work / "results.xml").findall(".//testcase")
        self.assertEqual(len(cases), 5, done.stdout)
        failed = {case.get("name").split(".")[-1] for case in cases if case.find("failure") is not None}
        self.assertEqual(done.returncode, 1 if failed else 0, done.stdout)
        return failed

    def result(self, *options):
        """Tests that failed, and what --json says."""
        file = self.prefix / "run.json"
        return self.failed("--json", file, *options), json.loads(file.read_text())

    def test_passes_with_its_covers_and_a_waveform(self):
        failed, said = self.result("--seed", "7", "--wave")
        self.assertEqual((failed, said["verdict"], said["seed"]), (set(), "PASS", 7))
        self.assertGreater(len(said["steps"]), 50)
        self.assertEqual(len(said["covers"]), 16)
        for name, cover in said["covers"].items():
            self.assertGreaterEqual(cover["count"], cover["least"], name)
        self.assertGreater((self.prefix / "sim/servo_channel.fst").stat().st_size, 10_000)

    def test_a_wrong_rule_of_the_scoreboard_fails(self):
        failed, said = self.result("--negative")
        self.assertEqual((failed, said["verdict"]), ({RANDOM}, "FAIL"))
        first = next(step for step in said["steps"] if not step["passed"])
        self.assertRegex(f"{first['name']}: {first['detail']}", r"position .*: -?\d+, expected -?\d+")

    def test_a_capture_that_does_not_wait_for_its_read_fails(self):
        self.plant("rtl/servo_ic/channel_capture.sv", "ready_i & ~captured_q & (", "ready_i & (")
        self.assertEqual(self.failed(), {"index_captures_its_position_once", RANDOM})


if __name__ == "__main__":
    if importlib.util.find_spec("cocotb") is None or shutil.which("iverilog") is None:
        print("skipped: cocotb or iverilog is not installed")
        sys.exit(77)
    main(sys.argv)
