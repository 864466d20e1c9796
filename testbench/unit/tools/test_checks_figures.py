"""Negative controls of the figures that stand twice: each is changed in one of its places."""

from tree import Tree, run

PAGES = {
    "docs/save.md": "| SAVE of a controller as it comes | 37 ms |\n",
    "docs/watchdog.md": "| SAVE | one long pass (37 ms); more |\n",
    "docs/datasheet/firmware.md": "37 ms and more; a power cut\nacknowledged when it is done, 37 ms and more\n",
    "docs/cosim.md": "| 8 axes 3 to 4.5 M ticks/s, more |\nidle firmware 110 simulated s/s\n"
                     "a host that polls 1.2 simulated s/s\n",
    "docs/simulation-speed.md": "| a host reads its status without pause | 1.2 simulated s/s | 2 |\n",
    "README.md": "the Verilated RTL | 3 to 4.5 M ticks/s, less |\nidle firmware: 110 simulated seconds a second\n",
    "docs/verification-plan.md": "| fixed (I18-2) | x |\nmore than the 2 of [proofs]\n",
    "docs/formal.md": "| `dpram` | 9 | pdr |\n| `watchdog` | 5 | induction |\n",
    "testbench/formal/dpram.sv": "rules\n",
    "testbench/formal/watchdog.sv": "rules\n",
    "docs/claimed.txt": "I18-2\nSSI-2\nLA-3\n",
}


class Figures(Tree):
    def setUp(self):
        super().setUp()
        for path, text in PAGES.items():
            self.write(path, text)

    def broken(self, path, old, new, says):
        self.assertIn(old, PAGES[path])
        self.write(path, PAGES[path].replace(old, new))
        self.expect(self.run_tool("check_figures.py"), 1, says)

    def test_figures_that_agree_pass(self):
        self.expect(self.run_tool("check_figures.py"), 0, "clean")

    def test_a_save_of_two_lengths_fails(self):
        self.broken("docs/watchdog.md", "37", "26", "docs/save.md says 37, docs/watchdog.md says 26")

    def test_a_save_of_another_length_in_the_data_sheet_fails(self):
        for old in ("37 ms and more; a", "done, 37 ms"):
            new = old.replace("37", "26")
            self.broken("docs/datasheet/firmware.md", old, new, "docs/datasheet/firmware.md says 26")

    def test_two_idle_speeds_fail(self):
        self.broken("README.md", "110", "60", "docs/cosim.md says 110, README.md says 60")

    def test_two_speeds_of_a_host_that_polls_fail(self):
        self.broken("docs/simulation-speed.md", "1.2", "1.1",
                    "docs/cosim.md says 1.2, docs/simulation-speed.md says 1.1")

    def test_two_speeds_of_the_rtl_fail(self):
        self.broken("docs/cosim.md", "4.5", "5", "docs/cosim.md says 3 to 5 M ticks/s, README.md says 3 to 4.5")

    def test_a_figure_that_is_gone_fails(self):
        self.broken("README.md", "idle firmware", "idle", "README.md: 0 places like")

    def test_another_number_of_proofs_fails(self):
        self.broken("docs/verification-plan.md", "the 2 of", "the 9 of", "9 modules with proofs, but there are 2")

    def test_a_proof_without_a_row_fails(self):
        self.broken("docs/formal.md", "`watchdog`", "`clock_gen`", "watchdog: proved or in a row")

    def test_an_open_row_of_a_claim_fails(self):
        self.broken("docs/verification-plan.md", "| x |", "| **open** |", "I18-2 is a gap here")

    def test_each_id_of_an_open_row_counts(self):
        for ids, name in (("SSI-1, SSI-2", "SSI-2"), ("LA-1 to LA-5", "LA-3"), ("LA-3 and LA-7", "LA-3")):
            self.broken("docs/verification-plan.md", "| fixed (I18-2) | x |", f"| fixed ({ids}) | **open** |",
                        f"{name} is a gap here")

    def test_claims_beside_the_ids_of_an_open_row_are_none(self):
        self.write("docs/verification-plan.md", PAGES["docs/verification-plan.md"] +
                   "| fixed (SSI-1, SSI-3) LA-3 | **open** |\n- gaps (LA-4 to LA-6)\n")
        self.expect(self.run_tool("check_figures.py"), 0, "clean")


if __name__ == "__main__":
    run()
