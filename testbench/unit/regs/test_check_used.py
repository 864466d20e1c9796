"""The check for unused registers must name what nobody uses: in the maps of the tree, made longer or less used."""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
HEADER = "rtl/regs/brick_regs.hpp"


class UnusedFields(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = Path(folder.name)
        for name in ("rtl", "systemc"):
            shutil.copytree(ROOT / name, self.tree / name)

    def replace(self, name, old, new):
        file = self.tree / name
        self.assertIn(old, file.read_text(), name)
        file.write_text(file.read_text().replace(old, new))

    def problems(self):
        done = subprocess.run([sys.executable, ROOT / "rtl/regs/check_used.py", "--root", self.tree],
                              check=False, stdout=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 1 if done.stdout else 0)
        return [line.split(" is used by")[0] for line in done.stdout.splitlines()]

    def test_the_tree_is_clean(self):
        self.assertEqual(self.problems(), [])

    def test_new_register_field_and_code_are_named(self):
        self.replace(HEADER, "constexpr Field kEqu{9, 1, \"equ\"};",
                     "constexpr Field kEqu{9, 1, \"equ\"};\nconstexpr Field kSpare{4, 3, \"spare\"};")
        self.replace(HEADER, "constexpr Register kAdcA{",
                     "constexpr Register kExtra{'X', 0x4, 0x0, 0x0, \"extra\"};\nconstexpr Register kAdcA{")
        self.replace(HEADER, "  kHallCcw = 15,", "  kHallCcw = 15,\n  kSine = 14,")
        self.assertEqual(self.problems(), ["servo_channel.extra", "servo_channel.status.spare", "code decode.Sine"])

    def test_a_field_that_rtl_and_model_write_as_a_number_is_named(self):
        self.replace("rtl/servo_ic/channel_regs.sv", "brick_regs_pkg::ServoChannelControlAenaLsb", "14")
        self.assertEqual(self.problems(), [], "the model uses it")
        self.replace("systemc/servo_ic/servo_channel.h", "channel_control::kAena", "kBit14")
        self.assertEqual(self.problems(), ["servo_channel.control.aena"])

    def test_a_comment_is_no_use(self):
        self.replace("rtl/host/interrupt_controller.sv", "= brick_regs_pkg::HostIoPicMaskAddr",
                     "= 2'd2; // brick_regs_pkg::HostIoPicMaskAddr")
        self.replace("systemc/host/interrupt_controller.h", "regs::host_io::kPicMask.address & 3",
                     "2 /* regs::host_io::kPicMask */")
        self.assertEqual(self.problems(), ["host_io.pic_mask"])


if __name__ == "__main__":
    unittest.main()
