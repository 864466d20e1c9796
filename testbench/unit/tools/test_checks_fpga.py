"""Negative controls of tools/fpga.py and fpga_pads.py: what is judged how, delays from a file, one reset a design."""

import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from tree import TOOLS, run

sys.path.insert(0, str(TOOLS))
import fpga_pads

import fpga


def path(source, target, delay):
    ends = {"cell": "u_board.a_q_TRELLIS_FF_Q"}, {"cell": "u_board.b_q_TRELLIS_FF_Q"}
    step = {"type": "routing", "delay": delay, "from": ends[0], "to": ends[1]}
    return {"from": f"posedge $glbnet${source}", "to": f"posedge $glbnet${target}", "path": [step]}


class Judged(unittest.TestCase):
    def tables(self, *delays):
        paths = [path(*pair, delay) for pair, delay in zip(fpga.PAIRS, delays, strict=True)]
        report = {"utilization": {"TRELLIS_COMB": {"used": 5, "available": 9}}, "critical_paths": paths}
        return fpga.tables([("8", 3, report), ("6", 1, report)])

    def test_a_period_is_enough(self):
        lines, problems = self.tables(8.47, 8.47, 8.47, 21.2)
        self.assertEqual(problems, [])
        self.assertIn("| 8 | 3 | 118.1 | 118.1 | 118.1 | 47.2 |", lines)

    def test_a_crossing_is_judged_by_clk_pwm_and_accepted_from_114(self):
        lines, problems = self.tables(8.4, 8.7, 8.4, 20.0)
        self.assertEqual(problems, [])
        self.assertIn("| 3 | clk_pwm | clk_ref | 8.70 | 0.00 | `a_q` to `b_q` |", lines)
        self.assertIn("(accepted)", "".join(lines))
        _, problems = self.tables(8.4, 8.4, 8.8, 20.0)
        self.assertEqual(problems, ["seed 3: clk_ref to clk_pwm at 113.6 MHz, expected 114 or more"])

    def test_clk_ref_has_a_goal_of_its_own(self):
        _, problems = self.tables(8.4, 8.4, 8.4, 21.5)
        self.assertEqual(problems, ["seed 3: clk_ref to clk_ref at 46.5 MHz, expected 47 or more"])


# D in to a flip-flop by a LUT, the flip-flop to /TA, /RD to /TA without a clock, the reset, and what is cleared with a
# clock, by the same input of a flip-flop.
SDF = r"""
(CELL (CELLTYPE "top")
  (INTERCONNECT pa_d_io\[3\]\$tr_io/O lut/A (100:200:1000) (100:200:1000))
  (INTERCONNECT lut/F ff/M (100:200:2000) (100:200:2000))
  (INTERCONNECT ff/Q pa_ta_no\$tr_io/I (100:200:3000) (100:200:3000))
  (INTERCONNECT pa_rd_ni\$tr_io/O pa_ta_no\$tr_io/T (100:200:700) (100:200:700))
  (INTERCONNECT u_core.u_reset_sync.u_pwm.sync2_q_TRELLIS_FF_Q/Q far/LSR (100:200:4000) (100:200:4000))
  (INTERCONNECT ff/Q far/LSR (100:200:9000) (100:200:9000))
)
(CELL
  (CELLTYPE "TRELLIS_COMB")
  (INSTANCE lut)
  (IOPATH A F (100:200:240) (100:200:240))
)
(CELL
  (CELLTYPE "TRELLIS_FF")
  (INSTANCE ff)
  (IOPATH CLK Q (300:350:400) (300:350:400))
  (SETUPHOLD (posedge M) (posedge CLK) (0:0:50) (1:1:1))
)
(CELL
  (CELLTYPE "TRELLIS_FF")
  (INSTANCE u_core.u_reset_sync.u_pwm.sync2_q_TRELLIS_FF_Q)
  (IOPATH CLK Q (300:350:400) (300:350:400))
)
(CELL
  (CELLTYPE "TRELLIS_FF")
  (INSTANCE far)
  (SETUPHOLD (posedge LSR) (posedge CLK) (187:237:287) (0:0:0))
)
"""

RAM_MEMORY = """
(CELL
  (CELLTYPE "DP16KD")
  (INSTANCE u_core.u_dpram.mem)
  (IOPATH CLKB DOB0 (1:2:4260) (1:2:4260))
)"""
LUT = """
(CELL
  (CELLTYPE "TRELLIS_COMB")
  (INSTANCE {})
  (IOPATH A F (1:2:240) (1:2:240))
  (IOPATH B F (1:2:240) (1:2:240))
  (IOPATH C F (1:2:240) (1:2:240))
)"""
FLIP_FLOP = """
(CELL
  (CELLTYPE "TRELLIS_FF")
  (INSTANCE {})
  (IOPATH CLK Q (1:2:400) (1:2:400))
  (SETUPHOLD (posedge LSR) (posedge CLK) (1:2:287) (0:0:0))
)"""
ENDS, AGAIN = "host-bus:2.6/5", "host-bus:2.2, row 113"  # rows of D
OF_REGISTERS, OF_RAM, OF_STROBE = "u_core.u_bus_read.oe", "u_core.u_dpram.drive", "u_core.u_bus_strobes.rd"


def of_data(gates=(0, 1), cleared=(OF_REGISTERS, OF_RAM)):
    """D of two pads: its level from the RAM, its enable by two flip-flops, those in `cleared` by /RD, and by one that a
    strobe clocks; beside the pads in `gates` a gate of /RD, 0.1 ns later at the second."""
    read, pad = r"pa_rd_ni\$tr_io/O", r"u_pa_data.gen_pad\[{}\].u_pad/{}".format
    wires = [("u_core.u_dpram.mem/DOB0", pad(0, "I"), 500), (f"{OF_REGISTERS}/Q", "on/A", 2000),
             (f"{OF_RAM}/Q", "on/B", 3000), (f"{OF_STROBE}/Q", "on/C", 5000)]
    wires += [(read, f"{cell}/LSR", 1000) for cell in cleared]
    for i in (0, 1):
        if i in gates:
            wires += [(read, f"gate{i}/A", 600 + 100 * i), ("on/F", f"gate{i}/B", 100),
                      (f"gate{i}/F", pad(i, "T"), 700)]
        else:
            wires.append(("on/F", pad(i, "T"), 700))
    text = "\n".join(f"(INTERCONNECT {a} {b} (1:2:{delay}) (1:2:{delay}))" for a, b, delay in wires) + RAM_MEMORY
    text += "".join(LUT.format(cell) for cell in ("on", "gate0", "gate1"))
    text += "".join(FLIP_FLOP.format(cell) for cell in (OF_REGISTERS, OF_RAM, OF_STROBE))
    return fpga_pads.delays(fpga_pads.read(text.splitlines()))[0]


def row_of(found, rule):
    """The row of D by that rule with the least to spare."""
    return next(row for row in fpga_pads.rows(found) if row.rule == rule)


class Pads(unittest.TestCase):
    def setUp(self):
        self.found, self.reset = fpga_pads.delays(fpga_pads.read(SDF.splitlines()))

    def test_pads_of_two_ways_have_their_names(self):
        for cell, name in (("u_phase.gen_pad[0].u_pad", "phase_io"), ("u_memcs16.gen_pad[0].u_pad", "isa_memcs16_n_io"),
                           ("gen_isa_sd[1].u_isa_sd.gen_pad[3].u_pad", "isa_sd_io"), ("trip_i$tr_io", "trip_i"),
                           ("u_chip.u_phase_pin.pad_q_TRELLIS_FF_Q", None)):
            self.assertEqual(fpga_pads.pad(cell), name)

    def test_a_chip_has_rows_of_its_pads_alone(self):
        found = {"phase_io": {"in": 2.0, "out": 3.0}, "pa_x_i": {"in": 1.0}}
        self.assertEqual([row.rule for row in fpga_pads.rows(found)],
                         ["servo-ic:5.1/11", "host-bus:2.6", "servo-ic:5.1/8"])

    def test_ways_are_the_longest(self):
        self.assertAlmostEqual(self.found["pa_d_io"]["in"], 1.0 + 0.24 + 2.0 + 0.05)
        self.assertAlmostEqual(self.found["pa_ta_no"]["out"], 0.4 + 3.0)
        self.assertAlmostEqual(self.found["pa_ta_no"]["through"], 0.7)
        self.assertAlmostEqual(self.reset, 0.4 + 4.0 + 0.287)

    def test_what_turns_a_pad_on_and_what_leaves_the_ram_are_told_apart_from_what_a_strobe_clocks(self):
        ways = of_data(gates=())["pa_data_io"]
        self.assertAlmostEqual(ways["enable"], 0.4 + 2.0 + 0.24 + 0.7)
        self.assertAlmostEqual(ways["ram"], 4.26 + 0.5)
        self.assertNotIn("out", ways)

    def test_the_end_of_a_read_goes_by_what_it_clears(self):
        row = row_of(of_data(gates=()), ENDS)
        self.assertAlmostEqual(row.has, 1.0 + 0.4 + 3.0 + 0.24 + 0.7 + 0.7 + 3.5)

    def test_a_gate_of_rd_ends_it_sooner(self):
        self.assertAlmostEqual(row_of(of_data(), ENDS).has, 0.7 + 0.24 + 0.7 + 0.7 + 3.5)

    def test_one_pad_without_its_gate_is_the_late_one(self):
        for gates in ((0,), (1,)):
            row = row_of(of_data(gates), ENDS)
            self.assertAlmostEqual(row.has, 1.0 + 0.4 + 3.0 + 0.24 + 0.7 + 0.7 + 3.5)
            self.assertLess(row.limit, row.has)

    def test_behind_its_gate_d_is_disabled_before_rd_falls_again(self):
        found = of_data() | {"pa_ta_n_o": {}}
        of_ram, of_registers = (row for row in fpga_pads.rows(found) if row.rule == AGAIN)
        to_pad = 0.24 + 0.1 + 0.24 + 0.7
        self.assertAlmostEqual(of_registers.has, 1.0 + 0.4 + 2.0 + to_pad)
        self.assertAlmostEqual(of_registers.limit, 2.75 * 1000 / 9.8304 / 22 - 4)  # I52 = 21
        self.assertAlmostEqual(of_ram.has, 1.0 + 0.4 + 3.0 + to_pad)
        self.assertAlmostEqual(of_ram.limit, 1.75 * 1000 / 9.8304 / 14 - 4)  # I52 = 13

    def test_what_rd_does_not_clear_opens_the_gate_again(self):
        for cleared in ((OF_REGISTERS,), (OF_RAM,)):
            found = of_data(cleared=cleared) | {"pa_ta_n_o": {}}
            self.assertEqual(row_of(found, AGAIN).has, math.inf)
            self.assertLess(row_of(found, ENDS).has, 8.0)
            self.assertEqual(row_of(of_data((0,), cleared), ENDS).has, math.inf)
            self.assertIn("| inf |", "".join(fpga_pads.page([(found, None)])))

    def test_the_flip_flop_that_releases_the_reset_is_known_in_each_chip(self):
        for cell in ("u_chip.u_core.u_reset_sync.u_pwm.sync2_q", "u_chip.rst_q"):
            sdf = SDF.replace("u_core.u_reset_sync.u_pwm.sync2_q", cell)
            self.assertAlmostEqual(fpga_pads.delays(fpga_pads.read(sdf.splitlines()))[1], 0.4 + 4.0 + 0.287)
        nobody = fpga_pads.delays(fpga_pads.read(SDF.replace("u_reset_sync", "u_other").splitlines()))
        self.assertIn("**missed**", list(fpga_pads.page([nobody]))[-1])

    def test_of_several_placements_each_line_is_that_of_the_worst(self):
        late = {"pa_ta_no": {"out": 6.2}, "pa_a_i": {"in": 2.0}}
        soon = {"pa_ta_no": {"out": 3.0}, "pa_a_i": {"in": 7.0}}
        for placed in ([(late, 8.0), (soon, 5.0)], [(soon, 5.0), (late, 8.0)]):
            text = "\n".join(fpga_pads.page(placed))
            self.assertIn("clock to /TA | 10.1 | 10.0 | -0.1 **missed** |", text)
            self.assertIn("pads of Port A to a flip-flop | 8.1 | 8.5 | 0.4 |", text)
            self.assertIn("| `pa_a_i` | 7.00 |", text)
            self.assertIn("8.00 ns after its clock", text)
        self.assertIn("no flip-flop that is known **missed**", "\n".join(fpga_pads.page([(late, 8.0), (soon, None)])))

    def test_the_ram_may_be_a_tick_less_1_41_ns_behind_its_ta(self):
        found = {"pa_data_io": {"ram": 10.0}, "pa_ta_n_o": {"ram": 3.0, "out": 1.0}}
        row = next(row for row in fpga_pads.rows(found) if row.rule == "host-bus:6.9/8")
        self.assertAlmostEqual(row.has, 7.0)
        self.assertAlmostEqual(row.limit, 7.067, 3)  # 8.477 + 6.358 / 4 - 3

    def test_the_enable_of_a_net_has_a_clk_ref_and_its_level_a_tick(self):
        found = {"servo_io": {"in": 1.0, "out": 2.0, "enable": 9.0}}
        self.assertEqual([(row.rule, f"{row.has:.2f}", f"{row.limit:.2f}") for row in fpga_pads.rows(found)],
                         [("servo-ic:5.1/11", "7.62", "8.48"), ("servo-ic:5.1/8", "12.92", "25.43")])

    def test_the_reset_of_the_servo_ics_has_a_tick_in_two_parts(self):
        rows = [*fpga_pads.rows({"rst_ref_no": {"out": 1.5}}), *fpga_pads.rows({"rst_ref_ni": {"in": 1.25}})]
        self.assertEqual([(f"{row.has:.2f}", f"{row.limit:.2f}") for row in rows], [("5.42", "6.20"), ("1.95", "2.28")])
        self.assertEqual(fpga_pads.rows({"rst_ref_ni": {}})[0].has, math.inf)  # it only clears flip-flops

    def test_a_pad_that_is_late_is_the_first_row_and_missed(self):
        found = {"pa_ta_no": {"out": 6.2}, "pa_a_i": {"in": 2.0}}
        text = list(fpga_pads.page([(found, 9.0)]))
        self.assertIn("clock to /TA | 10.1 | 10.0 | -0.1 **missed** |", text[2])
        self.assertIn("9.00 ns after its clock, of 8.48 **missed**", text[-1])

    def test_wait_states_are_those_of_row_105(self):
        # 76.3 ns and an aperture of 1, pads 2.0 + 1.12, D 3.0 + 3.92: 87.3 ns. Row 105 has 87.2 with 7, 99.9 with 8.
        found = {"pa_rd_ni": {"in": 2.0}, "pa_d_io": {"out": 3.0}}
        self.assertEqual(fpga_pads.wait_states(found, 7), 8)
        self.assertIsNone(fpga_pads.wait_states({"pa_d_io": {"out": 20.0}}, 31))


# A, B, C, FAULT, HMFL, PLIM, MLIM, USER, W, V, U, T
FOUR_CHANNELS = ["DOWN", "UP", "DOWN", "UP", *["DOWN"] * 3, *["UP"] * 5] * 4


def pulls(lpf):
    """Pulls of the motor inputs by a pad file, in order of their bits."""
    found = re.findall(r'^IOBUF PORT "motor_i\[(\d+)\]" IO_TYPE=LVCMOS33 PULLMODE=(\w+);$', lpf, re.MULTILINE)
    return [pull for _, pull in sorted((int(bit), pull) for bit, pull in found)]


class Pulls(unittest.TestCase):
    """servo-ic:5.15/6: T, U, V, W, USER, B and FAULT of each channel read 1 when open, its other flags 0."""

    def test_each_chip_with_a_motor_side_has_them(self):
        for top in ("brick_ecp5", "servo_ic_chip_ecp5"):
            with self.subTest(top):
                self.assertEqual(pulls((TOOLS.parent / "fpga" / f"{top}.lpf").read_text()), FOUR_CHANNELS)

    def test_one_that_is_missing_or_the_other_way_is_found(self):
        lpf = (TOOLS.parent / "fpga/brick_ecp5.lpf").read_text()
        line = 'IOBUF PORT "motor_i[25]" IO_TYPE=LVCMOS33 PULLMODE=UP;'
        self.assertIn(line, lpf)
        self.assertNotEqual(pulls(lpf.replace(line, "")), FOUR_CHANNELS)
        self.assertNotEqual(pulls(lpf.replace(line, line.replace("UP", "DOWN"))), FOUR_CHANNELS)


def pulled_up(lpf):
    return set(re.findall(r'^IOBUF PORT "(?!motor_i|phase_io|servo_io)([^"]+)" IO_TYPE=LVCMOS33 PULLMODE=UP;$', lpf,
                          re.MULTILINE))


def idle_high():
    """Pads whose rows say 1 for what nobody drives. A supply that nobody reports is not good; SSI has no pads."""
    pads = set()
    for row in (TOOLS.parent / "rtl/pins/board.pins").read_text().splitlines():
        cells = [cell.strip() for cell in row.split("|")]
        if len(cells) > 5 and cells[3] in ("PortAPins", "IsaLines", "ConnectorPins") and int(cells[5] or "0", 0):
            name, width = f"{cells[0]}i" if cells[0].endswith("_n") else f"{cells[0]}_i", int(cells[2])
            pads |= {name} if width == 1 else {f"{name}[{bit}]" for bit in range(width)}
    return {name for name in pads if not name.startswith(("pwr_good", "ssi_data"))}


class Idle(unittest.TestCase):
    def test_what_nobody_drives_is_at_its_rows_level(self):
        self.assertIn("jpan_i[15]", idle_high())
        for top in ("brick_ecp5", "board_chip_ecp5"):
            with self.subTest(top):
                self.assertEqual(pulled_up((TOOLS.parent / "fpga" / f"{top}.lpf").read_text()), idle_high())

    def test_a_servo_ic_without_its_trip_is_off(self):
        lpf = (TOOLS.parent / "fpga/servo_ic_chip_ecp5.lpf").read_text()
        self.assertEqual(pulled_up(lpf), {"pa_rd_ni", "pa_wr_ni", "trip_i"})


@unittest.skipUnless(shutil.which("yosys"), "yosys is not installed")
class Resets(unittest.TestCase):
    def test_flip_flops_share_one_inverter(self):
        with tempfile.TemporaryDirectory() as folder:
            netlist = pathlib.Path(folder) / "k.json"
            (netlist.parent / "k.sv").write_text(
                "module k (input clk_i, input rst_ni, input [7:0] d_i, output reg [7:0] q_o);\n"
                "  always @(posedge clk_i or negedge rst_ni) if (!rst_ni) q_o <= 8'h0; else q_o <= d_i;\n"
                "endmodule\n")
            script = f"read_verilog -sv {netlist.parent}/k.sv; {fpga.MAP.format(top='k', netlist=netlist)}"
            subprocess.run(["yosys", "-q", "-p", script], check=True)
            cells = json.loads(netlist.read_text())["modules"]["k"]["cells"].values()
            self.assertEqual([c["type"] for c in cells].count("LUT4"), 1)


if __name__ == "__main__":
    run()
