"""Negative controls of the checks of the RTL: lint, shared functions, clock crossings, outputs."""

import shutil
import subprocess
import sys
import unittest
from unittest import mock

from tree import TOOLS, Tree, run


@unittest.skipUnless(shutil.which("verilator"), "verilator is not installed")
class Lint(Tree):
    GOOD = ("`default_nettype none\nmodule board_top (input wire a_i, output wire b_o);\n  assign b_o = a_i;\n"
            "endmodule : board_top\n")

    def test_clean_rtl_passes(self):
        self.write("rtl/board/board_top.sv", self.GOOD)
        self.expect(self.run_tool("lint_rtl.py", "verilator"), 0, "clean")

    def test_an_unused_input_fails(self):
        self.write("rtl/board/board_top.sv", self.GOOD.replace("= a_i", "= 1'b0"))
        self.expect(self.run_tool("lint_rtl.py", "verilator"), 1, "UNUSED")

    def test_a_waiver_without_a_reason_fails(self):
        self.write("rtl/board/board_top.sv", self.GOOD)
        self.write("rtl/lint.vlt", "`verilator_config\nlint_off -rule WIDTH -file \"*\"\n")
        self.expect(self.run_tool("lint_rtl.py", "verilator"), 1, "waiver without a reason")

    def test_a_latch_fails(self):
        latch = self.GOOD.replace("assign b_o = a_i;", "always_latch if (a_i) b_o = 1'b1;")
        self.write("rtl/board/board_top.sv", latch.replace("output wire", "output logic"))
        self.expect(self.run_tool("lint_rtl.py", "verilator"), 1, "latch or initial block")

    def test_a_variable_of_two_always_ff_fails(self):
        """Verilator warns where their clocks differ, for which rtl/lint.vlt has a waiver."""
        both = ("`default_nettype none\nmodule board_top (input wire a_i, b_i, output logic [1:0] q_o);\n"
                "  always_ff @(posedge a_i) if (b_i) q_o[0] <= ~q_o[0];\n  always_ff @(posedge b_i) begin\n"
                "    if (a_i) {q_o[1]} <= 1'b0;\n  end\nendmodule : board_top\n")
        self.write("rtl/lint.vlt", "`verilator_config\n// a memory\nlint_off -rule MULTIDRIVEN -file \"*\"\n")
        self.write("rtl/board/board_top.sv", both)
        self.expect(self.run_tool("lint_rtl.py", "verilator"), 1, "board_top.sv: two always_ff write q_o")
        self.write("rtl/board/board_top.sv", both.replace("always_ff", "always"))
        self.expect(self.run_tool("lint_rtl.py", "verilator"), 0, "clean")

    def test_a_bit_that_a_signal_chooses_fails(self):
        chosen = ("`default_nettype none\nmodule board_top (input wire [1:0] a_i, output logic [3:0] q_o);\n"
                  "  always_comb begin\n    q_o = 4'd0;\n    if (a_i != 2'd3) q_o[a_i] = 1'b1;\n  end\n"
                  "endmodule : board_top\n")
        self.write("rtl/board/board_top.sv", chosen)
        self.expect(self.run_tool("lint_rtl.py", "verilator"), 1, "a signal chooses the bit q_o[a_i] that is assigned")
        self.write("rtl/board/board_top.sv", chosen.replace("q_o[a_i] = 1'b1", "q_o = 4'd1 << a_i"))
        self.expect(self.run_tool("lint_rtl.py", "verilator"), 0, "clean")

    @unittest.skipUnless(shutil.which("yosys"), "yosys is not installed")
    def test_yosys_fails_on_an_undriven_net(self):
        self.write("rtl/board/board_top.sv", self.GOOD.replace("= a_i;", "= a_i ^ c;\n  wire c;"))
        self.expect(self.run_tool("lint_rtl.py", "yosys"), 1, "has no driver")

    @unittest.skipUnless(shutil.which("yosys"), "yosys is not installed")
    def test_yosys_fails_on_a_latch_that_always_star_makes(self):
        latch = self.GOOD.replace("assign b_o = a_i;", "always @* if (a_i) b_o = 1'b1;")
        self.write("rtl/board/board_top.sv", latch.replace("output wire", "output reg"))
        self.expect(self.run_tool("lint_rtl.py", "yosys"), 1, "dlatch")

    def test_a_file_that_no_tool_reads_fails(self):
        self.write("rtl/board/board_top.sv", self.GOOD)
        self.write("rtl/servo_ic/channel_extra.v", "module channel_extra;\nendmodule\n")
        self.expect(self.run_tool("lint_rtl.py", "verilator"), 1, "channel_extra.v: no tool reads it")

    def test_every_tool_finds_the_fault_of_a_module_that_the_board_does_not_use(self):
        spare = self.GOOD.replace("board_top", "spare")
        self.write("rtl/board/board_top.sv", self.GOOD)
        self.write("rtl/servo_ic/spare.sv", spare.replace("  assign", "  nothing u_nothing ();\n  assign"))
        for tool, program in (("verilator", "verilator"), ("yosys", "yosys"), ("icarus", "iverilog")):
            if shutil.which(program) is not None:
                self.expect(self.run_tool("lint_rtl.py", tool), 1, "nothing")
        self.write("rtl/servo_ic/spare.sv", spare.replace("= a_i", "= a_i ^ c;\n  wire c"))
        for tool, text in (("verilator", "UNDRIVEN"), ("yosys", "has no driver")):
            if shutil.which(tool) is not None:
                self.expect(self.run_tool("lint_rtl.py", tool), 1, text)

    @unittest.skipUnless(shutil.which("iverilog"), "iverilog is not installed")
    def test_icarus_fails_on_an_unknown_module(self):
        self.write("rtl/board/board_top.sv", self.GOOD.replace("  assign", "  nothing u_nothing ();\n  assign"))
        self.expect(self.run_tool("lint_rtl.py", "icarus"), 1, "nothing")


class SharedFunctions(Tree):
    """Generated code as Verilator writes it; only what the .cmake file lists is built."""

    def generated(self, *ics, listed=True):
        name = "Vboard_x_servo_ic__DepSet_h1__0.cpp"
        self.write("Vboard_x.dir/Vboard_x.cmake", f'set(Vboard_x_CLASSES_FAST "/build/{name}")\n' if listed else "")
        function = "Vboard_x_servo_ic___nba_sequent__TOP__gen_servo_ic__BRA__{}__KET____0(Vboard_x_servo_ic* vlSelf)"
        self.write(f"Vboard_x.dir/{name}",
                   "".join(f"VL_INLINE_OPT void {function.format(ic)} {{\n}}\n" for ic in ics))
        return self.check()

    def check(self):
        return subprocess.run([sys.executable, TOOLS / "check_shared.py", self.root / "Vboard_x.dir"], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def test_one_set_passes(self):
        self.expect(self.generated(0), 0, "clean")

    def test_a_second_set_fails(self):
        self.expect(self.generated(0, 7), 1, "servo IC 7 has 1 functions of its own")

    def test_nothing_to_check_fails(self):
        self.expect(self.generated(0, listed=False), 1, "no functions of servo_ic found")
        (self.root / "Vboard_x.dir/Vboard_x.cmake").unlink()
        self.expect(self.check(), 1, "no such file; expected a folder that the build has generated")


class Planted(Tree):
    """A copy of the RTL to plant faults in."""

    def setUp(self):
        super().setUp()
        shutil.copytree(TOOLS.parent / "rtl", self.root / "rtl")

    def plant(self, path, old, new):
        text = (self.root / path).read_text()
        self.assertEqual(text.count(old), 1, old)
        self.write(path, text.replace(old, new))


@unittest.skipIf(shutil.which("yosys") is None, "yosys is not installed")
class ClockCrossings(Planted):
    def test_each_way_past_a_synchroniser_is_named(self):
        """All at once: a look at the whole netlist is dear, and none hides another."""
        choice = "line_source[line_select_q[7:4]]"
        select, core = "rtl/board/clock_select.sv", "rtl/board/board_core.sv"
        for path, old, new in (
                (select, ".d_i(ext_phase_i), .q_o(ext_phase)", ".d_i(1'b1), .q_o()"),
                (select, "(drivers_q[44] & ext_phase)", "(drivers_q[44] & ext_phase_i)"),
                (core, choice, choice.replace("[7:4]", "[7:4] ^ equ[3:0]")),
                ("rtl/servo_ic/servo_channels.sv", ".pins_i(pins[12*n +: 12])", ".pins_i(pins_i[12*n +: 12])"),
                ("rtl/chips/servo_ic_chip.sv", "18'h1 << number_q", "18'h1 << number_i"),
                (core, "bus_rdata_oe | dpram_drive;", "bus_rdata_oe | dpram_drive | isa_aen_i;")):
            self.plant(path, old, new)
        done = self.run_tool("check_cdc.py")
        for named in ("ext_phase_i reaches u_clock_select.phase_q (data)",
                      "mi1_i reaches u_interrupt_controller.u_line_sync.sync1_q (data)",  # logic selects, no strap
                      "motor_i.enc_a reaches gen_servo_ic[0].gen_built.u_servo_ic",
                      "servo_ic_chip: number_i reaches u_bus_read.data_q (data)",
                      "isa_aen_i reaches pa_data_oe_o (output)"):  # no row allows it
            self.expect(done, 1, named)
        *listed, count = done.stdout.splitlines()
        self.assertEqual(count.split(": ")[1], f"{len(listed)} problem(s)")

    def test_the_first_flip_flop_and_a_row_of_a_pin_that_the_rtl_does_not_follow_fail(self):
        self.plant("rtl/common/sync2.sv", "q_o = sync2_q", "q_o = sync1_q")
        self.plant("rtl/pins/board.pins", "| strap fitted_q |", "| strap fitted_d |")
        self.plant("rtl/pins/board.pins", "| 4.29 | 1 | synchroniser |", "| 4.29 | 1 | |")
        done = self.run_tool("check_cdc.py")
        self.expect(done, 1, "u_bus_strobes.rd_q reaches u_bus_sync.rd2_q (data)")  # the first flip-flop
        self.expect(done, 1, "fitted_i reaches fitted_q (data)")
        self.expect(done, 1, "fitted_i fitted_d: a row in rtl/pins allows it, nothing needs it")
        self.expect(done, 1, "ext_phase_i reaches u_clock_select.u_phase_sync.sync1_q (data)")


@unittest.skipIf(shutil.which("yosys") is None, "yosys is not installed")
class Outputs(Planted):
    def test_each_output_of_more_than_a_flip_flop_is_named(self):
        """All at once, as above."""
        slave, port, core = "rtl/host/isa_slave.sv", "rtl/host/host_port.sv", "rtl/board/board_core.sv"
        channel = "rtl/servo_ic/servo_channel.sv"
        for path, old, new in (
                # IOCHRDY of two: at one edge the request goes and BUSY comes.
                (slave, "logic        drive_q, iochrdy_q;", "logic        drive_q, iochrdy_q, busy_q;"),
                (slave, "iochrdy_q <= ~(((cycle_d == Start) & decoded[Memory]) | mem_busy_d_i);",
                 "{busy_q, iochrdy_q} <= {mem_busy_d_i, ~((cycle_d == Start) & decoded[Memory])};"),
                (slave, "assign isa_iochrdy_o  = iochrdy_q;", "assign isa_iochrdy_o  = iochrdy_q & ~busy_q;"),
                (port, "assign hreq_o = hreq_q;", "assign hreq_o = (icr_q[0] & rxdf_q) | (icr_q[1] & txde_q);"),
                ("rtl/board/clock_select.sv", "phase_o        = phase_q;", "phase_o        = phase_q | ~phase_oe_q;"),
                (core, "wd_led_o = wd_tripped_o;", "wd_led_o = pwr_good_i;"),
                (channel, "aena_o  = aena & ~trip_i;", "aena_o  = aena & ~trip_i & ~ab_inv;"),
                (channel, "(pwm & pwm_on) ^ pwm_inv;", "(pwm & pwm_on & {6{~hold}}) ^ pwm_inv;"),
                (channel, "equ_o = equ & ~trip_i;", "equ_o = equ & ~trip_i & ready;")):
            self.plant(path, old, new)
        done = self.run_tool("check_outputs.py")
        board = ("isa_iochrdy_o is made of 2 level(s), u_isa_slave.busy_q, u_isa_slave.iochrdy_q among them",
                 "hreq_o is made of 4 level(s), u_host_port.icr_q, u_host_port.rxdf_q, u_host_port.txde_q among them",
                 "wd_led_o is made of 1 level(s), pwr_good_i among them",  # the pin itself
                 "phase_o is made of 2 level(s), u_clock_select.phase_oe_q, u_clock_select.phase_q among them")
        for named in (*board, *(f"board_chip: {text}" for text in board),
                      *(f"motor_o.{pin} is made of 3 level(s), gen_servo_ic[0].gen_built.u_servo_ic.u_channels."
                        for pin in ("aena", "equ")),
                      *(f"servo_ic_chip: motor_o.{pin} is made of 3 level(s), u_servo_ic.u_channels."
                        for pin in ("aena", "equ"))):
            self.expect(done, 1, named)
        self.assertNotIn("motor_o.pwm", done.stdout)  # its row allows the control word
        *listed, count = done.stdout.splitlines()
        self.assertEqual(count.split(": ")[1], f"{len(listed)} problem(s)")
        self.assertEqual(len(listed), 2 * len(board) + 2 * 2 * 4)

    def test_what_may_rise_with_the_edge_of_a_trip_is_named(self):
        self.plant("rtl/board/board_top.sv", ".trip_d_i    (trip_d)", ".trip_d_i    (1'b0)")
        done = self.run_tool("check_outputs.py")
        channel = "gen_servo_ic[0].gen_built.u_servo_ic.u_channels.gen_channel[0].u_channel"
        for pin, source in (("aena", "u_regs.aena_q"), ("equ", "u_compare.equ_q")):
            self.expect(done, 1, f"motor_o.{pin}: {channel}.{source} may rise with the edge of a trip")

    def test_a_row_that_says_more_than_the_rtl_does_fails(self):
        self.plant("rtl/pins/board.pins", "cycle u_dpram.rd_ack_q u_dpram.wr_done_q", "cycle u_dpram.rd_ack_q")
        self.plant("rtl/pins/board.pins", "flag u_clock_select.conflict_q", "flag u_dpram.* u_clock_select.conflict_q")
        done = self.run_tool("check_outputs.py")
        self.expect(done, 1, "pa_ta_n_o is made of 10 level(s), u_dpram.wr_done_q among them")
        self.expect(done, 1, "source_conflict flag u_dpram.*: a row in rtl/pins allows it, nothing needs it")


@unittest.skipUnless(shutil.which("iverilog"), "iverilog is not installed")
class Unknowns(Planted):
    """A few hundred clocks each."""

    def judge(self, top, path, old, new, clocks="600"):
        self.plant(f"rtl/{path}", old, new)
        return self.run_tool("check_unknowns.py", top, "--clocks", clocks)

    def test_a_register_without_reset_fails(self):
        done = self.judge("servo_ic", "servo_ic/channel_regs.sv",
                          "      out_a_q   <= brick_regs_pkg::ServoChannelOutAReset;\n", "")
        self.expect(done, 1, "servo_ic: u_channels.gen_channel[0].u_channel.u_regs.out_a_o is unknown at 101,")

    def test_a_level_that_becomes_unknown_later_fails(self):
        """With the first count: nothing shows at the end of the reset."""
        done = self.judge("servo_ic", "servo_ic/channel_counter.sv", "counter_q - 24'd1", "counter_q - 24'bx")
        self.assertRegex(done.stdout, r"counter_o is unknown at (?!101,)\d+, seed 1")

    def test_a_reset_that_does_not_end_fails(self):
        """Nothing is unknown then, and nothing moves."""
        done = self.judge("servo_ic", "servo_ic/servo_ic.sv",
                          "endmodule : servo_ic", "  initial force rst_ni = 1'b0;\nendmodule : servo_ic")
        self.expect(done, 1, "outputs have moved; expected 75% at least")

    def test_a_latch_of_the_board_without_reset_fails(self):
        done = self.judge("board_top", "host/host_signals.sv",
                          "if (!rst_ni)   latch_q <= brick_regs_pkg::BoardLatchesHostSignalsReset[3:0];\n    else ", "")
        self.expect(done, 1, "board_top: u_core.u_host_signals.rdata_o is unknown at 101, seed 1")

    def test_of_a_mutant_the_first_is_named_and_no_answer_is_none(self):
        """For `./dev mutate`, in the smallest design that has the file."""
        sys.path[:0] = [str(TOOLS / "mutate"), str(TOOLS)]
        import unknowns

        file = "rtl/servo_ic/channel_regs.sv"
        text = (self.root / file).read_text()
        line = "      out_a_q   <= brick_regs_pkg::ServoChannelOutAReset;\n"
        with mock.patch.object(unknowns, "CLOCKS", 600):
            self.assertRegex(unknowns.found(self.root, file, text.replace(line, "")),
                             r"^servo_ic: u_channels\.\S+\.u_regs\.out_a_o is unknown at 101$")
            for other, mutated in ((file, text), (file, "no Verilog"), ("rtl/board/board_sim.sv", "")):
                self.assertIsNone(unknowns.found(self.root, other, mutated), other)


if __name__ == "__main__":
    run()
