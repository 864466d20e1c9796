"""Negative controls of the rows of docs/coverage.md, and what its generator counts."""

import pathlib
import sys

from tree import TOOLS, Tree, run

sys.path.insert(0, str(TOOLS))
import coverage

PAGE = "docs/coverage.md"


class Rows(Tree):
    """A module with a model, one without, a package, and a folder of the firmware."""

    def setUp(self):
        super().setUp()
        for path, text in {"rtl/board/watchdog.sv": "module watchdog (\n", "rtl/host/dpram.sv": "module dpram (\n",
                           "rtl/regs/words_pkg.sv": "package words_pkg;\n", "systemc/board/watchdog.h": "",
                           "firmware/base/text.c": ""}.items():
            self.write(path, text)
        lines = {("systemc/board/watchdog.h", 7): 2, ("systemc/board/watchdog.h", 8): 0, ("firmware/base/text.c", 3): 1}
        points = {("line", "rtl/board/watchdog.sv", 4, ""): 1, ("toggle", "rtl/board/watchdog.sv", 5, "a"): 1,
                  ("toggle", "rtl/board/watchdog.sv", 5, "b"): 2}
        rows = coverage.module_rows(self.root, lines, points), coverage.folder_rows(self.root, lines)
        self.write(PAGE, coverage.page("2 of 2 tests passed", *map(coverage.texts, rows)))

    def page(self):
        return pathlib.Path(self.root / PAGE).read_text()

    def check(self, status, text):
        self.expect(self.run_tool("coverage.py", "--check"), status, text)

    def test_what_a_run_reached(self):
        self.check(0, "2 modules and models: clean")
        self.assertIn("| `board/watchdog` | 1 of 1 (100.0 %) | 1 of 2 (50.0 %) | 1 of 2 (50.0 %) |\n", self.page())
        self.assertIn(f"| `host/dpram` | {coverage.NO_COUNTER} |  |  |\n", self.page())
        self.assertIn("| `firmware/base` | 1 of 1 (100.0 %) |\n", self.page())
        self.assertIn("| `systemc/board` | 1 of 2 (50.0 %) |\n| all | 2 of 3 (66.7 %) |\n", self.page())

    def test_a_module_without_a_row_fails(self):
        self.write("rtl/host/host_port.sv", "module host_port (\n")
        self.check(1, f"{PAGE}: no row of host/host_port")

    def test_a_model_without_a_row_fails(self):
        self.write("systemc/host/pci_bridge.cpp", "")
        self.check(1, f"{PAGE}: no row of host/pci_bridge")

    def test_a_folder_without_a_row_fails(self):
        self.write("firmware/motion/move.c", "")
        self.check(1, f"{PAGE}: no row of firmware/motion")

    def test_a_row_of_what_is_gone_fails(self):
        (self.root / "rtl/host/dpram.sv").unlink()
        self.check(1, f"{PAGE}: a row of host/dpram, which is not in the tree")

    def test_rows_come_and_go_without_a_run(self):
        self.write("rtl/host/host_port.sv", "module host_port (\n")
        self.write("firmware/motion/move.c", "")
        (self.root / "rtl/host/dpram.sv").unlink()
        self.assertEqual(self.run_tool("coverage.py", "--rows").returncode, 0)
        self.check(0, "clean")
        self.assertIn(f"| `host/host_port` | {coverage.NOT_RUN} |  |  |\n", self.page())
        self.assertIn("| `board/watchdog` | 1 of 1 (100.0 %) | 1 of 2 (50.0 %) | 1 of 2 (50.0 %) |\n", self.page())


if __name__ == "__main__":
    run()
