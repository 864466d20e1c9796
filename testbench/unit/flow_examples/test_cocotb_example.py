"""examples/cocotb_servo_channel passes on the installed RTL and names its test where a bug is planted in it."""

import importlib.util
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

from installed import Installed, main


class Cocotb(Installed):
    def failed(self):
        """Names of the tests that failed, of the four."""
        example, work = self.data / "examples/cocotb_servo_channel", self.prefix / "sim"
        shutil.rmtree(work, ignore_errors=True)
        done = subprocess.run([sys.executable, example / "run.py", "--build", work], timeout=100, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        cases = ElementTree.parse(work / "results.xml").findall(".//testcase")
        self.assertEqual(len(cases), 4, done.stdout)
        failed = {case.get("name").split(".")[-1] for case in cases if case.find("failure") is not None}
        self.assertEqual(done.returncode, 1 if failed else 0, done.stdout)
        return failed

    def test_passes(self):
        self.assertEqual(self.failed(), set())

    def test_a_reversed_count_fails(self):
        self.plant("rtl/servo_ic/channel_decode.sv", "(step == 2'd3) ^ ccw", "(step == 2'd1) ^ ccw")
        self.assertLessEqual({"counts_every_edge", "each_decode_counts_its_share"}, self.failed())

    def test_a_capture_that_does_not_wait_for_its_read_fails(self):
        self.plant("rtl/servo_ic/channel_capture.sv", "armed_q       <= 1'b0;", "armed_q       <= 1'b1;")
        self.assertEqual(self.failed(), {"index_captures_its_position_once"})

    def test_an_error_that_no_write_clears_fails(self):
        self.plant("rtl/servo_ic/channel_regs.sv", "else if (we_status) ", "else if (1'b0)      ")
        self.assertEqual(self.failed(), {"both_lines_at_once_are_an_error"})


if __name__ == "__main__":
    if importlib.util.find_spec("cocotb") is None or shutil.which("iverilog") is None:
        print("skipped: cocotb or iverilog is not installed")
        sys.exit(77)
    main(sys.argv)
