"""Negative controls of the joints: assumptions without guarantee, guarantees that are none, circles."""

import json

from tree import Tree, run

NEIGHBOUR = "    // R1: It stays.\n    R1: assert (a);\n"
PROOF = """module dut_rules;
  (* anyconst *) logic [1:0] k; logic [3:0] awake_q;
  always @(posedge clk_i) begin
    // guarantee: power-on
    assume (started_q || !rst_ni);
    {}
    assume (!rd_i ||
            !wr_i);
    // R1: It is so.
    R1: assert (b);
  end
"""


class Joints(Tree):
    def setUp(self):
        super().setUp()
        self.write("results/covers.json", json.dumps(
            {"commit": "x", "covers": {"bus: a, I/O": {"systemc": 7, "lockstep": 0}, "bus: a, memory": {"rtl": 1}}}))
        self.write("testbench/formal/neighbour.sv", NEIGHBOUR)
        self.write("rtl/host/neighbour.sv", "  always_ff @(posedge c) up_q <= d;\n  assign up_o = up_q;\n"
                                            "  assign now_o = up_q & a_i;\n")

    def judge(self, line):
        self.write("testbench/formal/dut.sv", PROOF.format(line))
        return self.run_tool("joints.py")

    def test_each_kind_of_guarantee_passes(self):
        for item in ("neighbour R1", "host-bus:2.5/6, `bus: a, I/O`", "neighbour R1; host-bus:2.5/6, `bus: a, I/O`",
                     "host-bus:2.5/6, `bus: a, {I/O; memory}`; neighbour R1",
                     "host-bus:2.5/6,\n    //   `bus: a, {I/O; memory}`"):
            self.expect(self.judge(f"// guarantee: {item}"), 0, "joints, 2 assumptions of 2 proofs: clean")
        line = "// guarantee: choice\n    assume (k != 2'd3);\n    // guarantee: neighbour R1"
        self.expect(self.judge(line), 0, "clean")

    def test_an_assumption_without_guarantee_fails(self):
        self.expect(self.judge("a_q <= b;"), 1, "dut.sv:7: no guarantee: assume (!rd_i || !wr_i);")
        self.expect(self.judge("// a bus has one cycle at a time"), 1, "dut.sv:7: no guarantee")

    def test_a_guarantee_that_leads_nowhere_fails(self):
        self.expect(self.judge("// guarantee: neighbour R2"), 1, "'neighbour R2': neighbour proves no R2")
        self.expect(self.judge("// guarantee: nobody R1"), 1, "nobody proves no R1")
        self.expect(self.judge("// guarantee: the board does so"), 1, "expected power-on, one reset, choice, PROOF R1")
        self.expect(self.judge("// guarantee: host-bus:2.5/6, `bus: b, I/O`"), 1, "bus: b, I/O has judged nothing")

    def test_a_checker_that_never_judged_fails(self):
        self.write("results/covers.json", json.dumps({"commit": "x", "covers": {"bus: a, I/O": {"systemc": 0}}}))
        self.expect(self.judge("// guarantee: host-bus:2.5/6, `bus: a, I/O`"), 1, "bus: a, I/O has judged nothing")

    def test_each_of_a_list_has_judged(self):
        self.expect(self.judge("// guarantee: host-bus:2.5/6, `bus: a, {I/O; memory; RAM}`"), 1,
                    "bus: a, RAM has judged nothing")

    def test_power_on_says_nothing_of_later(self):
        other = "\n    // guarantee: neighbour R1"
        for assume, wrong in (("started_q || !a_i", ""), ("awake_q == 4'd15 || (a_i && !b_i)", ""),
                              ("a_i || started_q && b_i", "not of the form"), ("started_q && a_i", "not of the form"),
                              ("rst_ni == started_q", "not of the form"), ("started_q != a_i", "not of the form"),
                              ("started_q || a_i ? b_i : c_i", "not of the form"),
                              ("started_q == 1'd0 || !a_i", "not of the form"),
                              ("awake_q == 4'd3 || !a_i", "not of the form"),
                              ("awake_q == 2'd3 || !a_i", "not of the form"),
                              ("started_q || a_i -> b_i", "not of the form"),
                              ("started_q || a_i); assume (b_i", "expected one assume a line"),
                              ("started_q ? a_i : !a_i", "what is assumed later has no guarantee")):
            self.expect(self.judge(f"// guarantee: power-on\n    assume ({assume});{other}"), int(bool(wrong)),
                        wrong or "clean")
        for items, wrong in (("neighbour R1", ""), ("power-on", "what is assumed later has no guarantee")):
            self.expect(self.judge(f"// guarantee: power-on; {items}\n    assume (started_q ? a_i : !a_i);{other}"),
                        int(bool(wrong)), wrong or "clean")

    def test_one_reset_is_said_to_be_assumed(self):
        other = "\n    // guarantee: neighbour R1"
        self.expect(self.judge(f"// guarantee: one reset\n    assume (rst_ni == started_q);{other}"), 0, "clean")
        self.expect(self.judge(f"// guarantee: one reset\n    assume (rst_ni == started_q && a_i);{other}"), 1,
                    "not of the form 'rst_ni == started_q'")

    def test_an_excuse_that_does_not_hold_fails(self):
        self.expect(self.judge("// guarantee: power-on"), 1, "power-on, but not of the form")
        self.expect(self.judge("// guarantee: choice"), 1, "rd_i, wr_i is no anyconst")

    def test_a_circle_needs_a_clock(self):
        self.write("testbench/formal/neighbour.sv", NEIGHBOUR + "    // guarantee: dut R1\n    assume (c);\n")
        self.expect(self.judge("// guarantee: neighbour R1"), 1,
                    "a circle without a clock of delay: dut rests on neighbour rests on dut")
        self.expect(self.judge("// guarantee: neighbour R1, a clock before: up_o"), 0, "clean")
        self.expect(self.judge("// guarantee: neighbour R1, a clock before: now_o"), 1, "now_o is no flip-flop")

    def test_the_model_of_a_neighbour_is_a_joint_too(self):
        self.expect(self.judge("// guarantee: neighbour R2\n    up_q <= up_d;\n    // guarantee: neighbour R1"), 1,
                    "dut.sv:7: 'neighbour R2': neighbour proves no R2")


if __name__ == "__main__":
    run()
