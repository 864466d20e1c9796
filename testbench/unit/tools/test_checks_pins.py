#!/usr/bin/env python3
"""The rows of pins (rtl/pins): a table that says nothing sensible is refused, what is made of it is held to it, and a
pin more is a row more."""

import shutil

from tree import TOOLS, Tree, run

GENERATE = "../rtl/pins/generate.py"
BOARD = "rtl/pins/board.pins"
LEVEL = "pwr_good | in | 1 | ConnectorPins | 7.0 |"


class Pins(Tree):
    def setUp(self):
        super().setUp()
        for folder in ("rtl/pins", "rtl/board", "systemc/component", "fpga"):
            shutil.copytree(TOOLS.parent / folder, self.root / folder)
        for page in ("components", "signals", "pins", "chips"):
            self.write(f"docs/{page}.md", (TOOLS.parent / f"docs/{page}.md").read_text())

    def replace(self, path, old, new):
        text = (self.root / path).read_text()
        self.assertEqual(text.count(old), 1, old)
        self.write(path, text.replace(old, new))

    def check(self, status, text):
        self.expect(self.run_tool(GENERATE, "--check"), status, text)

    def add(self, row):
        self.write(BOARD, (self.root / BOARD).read_text() + row + "\n")

    def test_the_tree_is_fresh(self):
        self.check(0, "")

    def test_a_pad_of_no_pin_is_refused(self):
        top = "fpga/servo_ic_chip_ecp5.sv"
        self.replace(top, "logic        trip_i,", "logic        trap_i,")
        self.check(1, f"{top}: port trap_i has no row in rtl/pins")
        self.replace(top, "logic        trap_i,", "logic [1:0]  trip_i,")
        self.check(1, f"{top}: port trip_i has 2 bits; expected at most 1, of its row")

    def test_what_was_changed_by_hand_is_stale(self):
        for path, old in (("rtl/pins/board_pins.hpp", "pwr_good = true"),
                          ("rtl/pins/board_inputs.hpp", '"pwr_good", &ConnectorPins::pwr_good, 7, 0'),
                          ("rtl/pins/motor_pins.hpp", "kT = 11"),
                          ("rtl/board/board_sim.sv", "(inputs_i[7][0])"),
                          ("systemc/component/dpram/dpram_words.h", "kSmall{0, 1, 1}"),
                          ("systemc/component/watchdog/watchdog_table.cpp", '"pwr_good", PinDirection::kIn, 0, 2, 1'),
                          ("systemc/component/include/brick/pins/board.h", "In<> pwr_good"),
                          ("docs/components.md", "| `gate` | in |"),
                          ("docs/signals.md", "| `host.jpan` | 16 hex |"),
                          ("docs/pins.md", "| `pwr_good` | 1 |"),
                          ("docs/chips.md", "| `pwr_good_i` | 1 |")):
            with self.subTest(path):
                before = (self.root / path).read_text()
                self.replace(path, old, old + "2")
                self.check(1, f"{path} is stale: run rtl/pins/generate.py")
                self.write(path, before)

    def test_a_port_of_the_board_that_has_no_row_or_another_width_fails(self):
        self.replace("rtl/board/board_top.sv", "logic        pwr_good_i,", "logic [1:0]  pwr_good_i,")
        self.check(1, "board_top.sv: port pwr_good_i is an input of 2 bits; expected by rtl/pins/board.pins: input, 1")
        self.replace("rtl/board/board_top.sv", "logic [1:0]  pwr_good_i,", "logic        pwr_bad_i,")
        self.check(1, "board_top.sv: port pwr_bad_i has no row in rtl/pins/board.pins")
        self.check(1, "board_top.sv: no port pwr_good_i; expected by rtl/pins/board.pins: input, 1 bits")

    def test_a_row_that_cannot_be_is_refused(self):
        for new, text in (("pwr_good | in | 1 | ConnectorPins | 5.16 |",
                           "pwr_good and pic_8259 have bit 16 of word 5 both"),
                          ("pwr_good | in | 2 | ConnectorPins | 7.31 |", "2 bits from bit 31 on; expected 1 to 32"),
                          ("pwr_good | up | 1 | ConnectorPins | 7.0 |", "direction is 'up'; expected in, out or inner"),
                          ("Pwr_good | in | 1 | ConnectorPins | 7.0 |", "'Pwr_good' is no name of a pin"),
                          ("mi1 | in | 1 | ConnectorPins | 7.0 |", "mi1 has two rows of one direction"),
                          ("pwr_good | in | one | ConnectorPins | 7.0 |", "width is 'one'; expected 0 to 0x20"),
                          ("pwr_good | in | 1 | ConnectorPins | 7 |", "place is '7'; expected WORD.BIT"),
                          ("pwr_good | in | 1 | ConnectorPins | | 7.0 |", "14 cells; expected 13: name | direction")):
            with self.subTest(text):
                before = (self.root / BOARD).read_text()
                self.replace(BOARD, LEVEL, new)
                self.check(1, text)
                self.write(BOARD, before)

    def test_an_idle_level_a_way_or_a_sentence_that_means_nothing_is_refused(self):
        row = "probe | in | 1 | ConnectorPins | 7.1 | {} | {} | | | | {} | {} |"
        for cells, text in ((("2", "synchroniser", "servo-ic:10", "a pin"), "idle is '2'; expected 0 to 0x1"),
                            (("1", "sometimes", "servo-ic:10", "a pin"), "sampled 'sometimes'; expected a way"),
                            (("1", "synchroniser", "", "a pin"), "expected a rule of the data sheet and a sentence"),
                            (("1", "synchroniser", "servo-ic:10", ""), "expected a rule of the data sheet")):
            with self.subTest(text):
                before = (self.root / BOARD).read_text()
                self.add(row.format(*cells))
                self.check(1, text)
                self.write(BOARD, before)

    def test_a_pin_more_is_a_row_and_its_port(self):
        self.add("probe | in | 1 | ConnectorPins | 7.1 | 1 | synchroniser | | | host.probe | servo-ic:10 | a probe |")
        self.check(1, "board_top.sv: no port probe_i")
        self.replace("rtl/board/board_top.sv", "  input  wire logic        pwr_good_i,",
                     "  input  wire logic        probe_i,\n  input  wire logic        pwr_good_i,")
        self.expect(self.run_tool(GENERATE), 0, "")
        self.check(0, "")
        for path, text in (("rtl/pins/board_pins.hpp", "bool probe = true;  // a probe (servo-ic:10)"),
                           ("rtl/pins/board_inputs.hpp", 'InputField{"probe", &ConnectorPins::probe, 7, 1, 1}'),
                           ("rtl/pins/board_inputs.hpp", 'InputSignal{"host.probe", &ConnectorPins::probe, 1, false}'),
                           ("rtl/board/board_sim.sv", ".probe_i            (inputs_i[7][1]),"),
                           ("systemc/component/include/brick/pins/board.h", "In<> probe;  // a probe (servo-ic:10)"),
                           ("systemc/component/board/board_table.cpp", '{"probe", PinDirection::kIn, 7, 1, 1, 0x1'),
                           ("docs/components.md", "| `probe` | in, idle 1 | a probe | servo-ic:10 |"),
                           ("docs/signals.md", "| `host.probe` | 1 bin | a probe |"),
                           ("docs/pins.md", "| `probe` | 1 | `probe_i` | 7.1 | $1 | `ConnectorPins` | synchroniser |")):
            self.assertIn(text, (self.root / path).read_text(), path)


if __name__ == "__main__":
    run()
