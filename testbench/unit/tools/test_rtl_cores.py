"""Negative controls of tools/rtl_cores.py and of the FuseSoC cores: each is broken in a copy and must be found."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
FUSESOC = pathlib.Path(sys.executable).with_name("fusesoc")  # beside the interpreter that ./dev setup fills


class Tree(unittest.TestCase):
    """A copy of what the tool reads."""

    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        shutil.copytree(ROOT / "rtl", self.root / "rtl", ignore=shutil.ignore_patterns("__pycache__", "*.xml"))
        (self.root / "docs").mkdir()
        for page in (ROOT / "docs").glob("*.md"):
            shutil.copy(page, self.root / "docs")
        shutil.copy(ROOT / "CMakeLists.txt", self.root)

    def plant(self, path, old, new):
        file = self.root / path
        self.assertIn(old, file.read_text())
        file.write_text(file.read_text().replace(old, new, 1))

    def tool(self, *arguments):
        return subprocess.run([sys.executable, ROOT / "tools/rtl_cores.py", "--root", self.root, *arguments], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def expect(self, done, *texts):
        self.assertEqual(done.returncode, 1 if texts else 0, done.stdout)
        for text in texts:
            self.assertIn(text, done.stdout)


class Lists(Tree):
    def test_the_tree_is_clean(self):
        self.expect(self.tool("--check"))

    def test_a_new_module_is_missed_by_each_list_that_needs_it(self):
        (self.root / "rtl/servo_ic/spare.sv").write_text("module spare ();\nendmodule : spare\n")
        self.expect(self.tool("--check"), "rtl/servo_ic/spare.sv: in no list: nothing instantiates it")
        self.plant("rtl/servo_ic/channel_pfm.sv", "endmodule", "  spare u_spare ();\nendmodule")
        self.expect(self.tool("--check"), *(
            f"rtl/{top}.f: misses servo_ic/spare.sv, which servo_ic/channel_pfm.sv needs; ./dev cores writes it"
            for top in ("servo_channel", "servo_ic", "board_top", "board_sim")), "rtl/servo_channel.core: is not")
        self.tool("--write")
        self.expect(self.tool("--check"))

    def test_a_file_too_many_or_in_the_wrong_place_fails(self):
        self.plant("rtl/watchdog.f", "board/watchdog.sv", "host/host_interrupt.sv\nboard/watchdog.sv")
        self.plant("rtl/dpram.f", "host/dpram_memory.sv\nhost/dpram.sv", "host/dpram.sv\nhost/dpram_memory.sv")
        self.expect(self.tool("--check"), "rtl/watchdog.f: has host/host_interrupt.sv, which nothing in it needs",
                    "rtl/dpram.f: host/dpram.sv stands where host/dpram_memory.sv must")
        self.expect(self.tool("--elaborate", "watchdog"), "rtl/watchdog.f, verilator: %Warning-MULTITOP")

    def test_elaboration_finds_a_file_too_few_and_a_late_package(self):
        self.plant("rtl/dpram.f", "host/dpram_memory.sv\n", "")
        done = self.tool("--elaborate", "dpram")
        self.expect(done, *(f"rtl/dpram.f, {tool}: " for tool in ("verilator", "yosys", "icarus")), "dpram_memory")
        self.plant("rtl/host_signals.f", "regs/brick_regs_pkg.sv\nhost/host_signals.sv",
                   "host/host_signals.sv\nregs/brick_regs_pkg.sv")
        self.expect(self.tool("--elaborate", "host_signals"), "rtl/host_signals.f, ")

    def test_a_page_that_differs_from_the_rtl_fails(self):
        self.plant("rtl/board/board_top.sv", "ServoIcMask = 18'h00003", "ServoIcMask = 18'h0000F")
        self.plant("docs/watchdog.md", "`clk_ref_i` 39.3216 MHz", "`clk_pwm_i`")
        self.plant("rtl/host/pic_8259.sv", "module pic_8259 (", "module pic_8259 #(\n  parameter bit Old = 1'b0\n) (")
        self.expect(self.tool("--check"), "docs/watchdog.md: table `watchdog`, row 'clocks' has ['clk_pwm_i']",
                    "docs/architecture.md: table `board_top` has parameters [\"`ServoIcMask` = 18'h00003\"",
                    "docs/pic_8259.md: table `pic_8259` has parameters [], the RTL [\"`Old` = 1'b0\"]")


@unittest.skipUnless(FUSESOC.exists(), "fusesoc is not installed")
class Cores(Tree):
    """FuseSoC itself resolves the cores; the board needs all the others."""

    def lint(self, name, *parameters):
        command = [FUSESOC, "--cores-root", self.root / "rtl", "run", "--target=lint", "--work-root",
                   self.root / "work", f"brick:ip:{name}", *parameters]
        return subprocess.run(command, cwd=self.root, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def test_the_board_of_the_cores_is_that_of_its_list(self):
        done = self.lint("board_top")
        self.assertEqual(done.returncode, 0, done.stdout)
        files = re.findall(r"^\S*?src/brick_ip_[^/]*/(\S+\.sv)$", next((self.root / "work").glob("*.vc")).read_text(),
                           re.M)
        wanted = [line for line in (ROOT / "rtl/board_top.f").read_text().splitlines() if not line.startswith("//")]
        self.assertEqual(sorted(files), sorted(wanted))

    def test_the_board_takes_its_parameters(self):
        done = self.lint("board_top", "--ServoIcMask", "1", "--MacroIcMask", "3")
        self.assertEqual(done.returncode, 0, done.stdout)
        script = next((self.root / "work").glob("*.vc")).read_text()
        self.assertRegex(script, r"-GServoIcMask=1\b")
        self.assertRegex(script, r"-GMacroIcMask=3\b")
        self.plant("rtl/lint.vlt", "'*IcMask'", "'*NoMask'")
        self.assertIn("expects 18 bits", self.lint("board_top", "--ServoIcMask", "1").stdout)

    def test_a_core_that_lacks_one_fails(self):
        self.plant("rtl/macro_ic.core", "      - brick:ip:clock_gen:", "      - brick:ip:common:")
        done = self.lint("macro_ic")
        self.assertNotEqual(done.returncode, 0, done.stdout)
        self.assertIn("clock_gen", done.stdout)


if __name__ == "__main__":
    for program in ("verilator", "yosys", "iverilog"):
        if shutil.which(program) is None:
            print(f"skipped: {program} is not installed")
            sys.exit(77)
    run = unittest.main(exit=False).result
    sys.exit(1 if not run.wasSuccessful() else 77 if run.skipped else 0)
