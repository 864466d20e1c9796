"""Negative controls of the joints: assumptions without guarantee, guarantees that are none, circles."""

import json

from tree import Tree, run

NEIGHBOUR = "    // R1: It stays.\n    R1: assert (a);\n"
PROOF = """module dut_rules;
  (* anyconst *) logic [1:0] k;
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
            {"commit": "x", "covers": {"bus: a, I/O": {"systemc": 7, "lockstep": 0}}}))
        self.write("testbench/formal/neighbour.sv", NEIGHBOUR)
        self.write("rtl/host/neighbour.sv", "  always_ff @(posedge c) up_q <= d;\n  assign up_o = up_q;\n"
                                            "  assign now_o = up_q & a_i;\n")

    def judge(self, line):
        self.write("testbench/formal/dut.sv", PROOF.format(line))
        return self.run_tool("joints.py")

    def test_each_kind_of_guarantee_passes(self):
        for item in ("neighbour R1", "host-bus:2.5/6, `bus: a, *`", "neighbour R1; host-bus:2.5/6, `bus: a, *`"):
            self.expect(self.judge(f"// guarantee: {item}"), 0, "joints, 2 assumptions of 2 proofs: clean")
        line = "// guarantee: choice\n    assume (k != 2'd3);\n    // guarantee: neighbour R1"
        self.expect(self.judge(line), 0, "clean")

    def test_an_assumption_without_guarantee_fails(self):
        self.expect(self.judge("a_q <= b;"), 1, "dut.sv:7: no guarantee: assume (!rd_i || !wr_i);")
        self.expect(self.judge("// a bus has one cycle at a time"), 1, "dut.sv:7: no guarantee")

    def test_a_guarantee_that_leads_nowhere_fails(self):
        self.expect(self.judge("// guarantee: neighbour R2"), 1, "'neighbour R2': neighbour proves no R2")
        self.expect(self.judge("// guarantee: nobody R1"), 1, "nobody proves no R1")
        self.expect(self.judge("// guarantee: the board does so"), 1, "expected power-on, choice, PROOF R1")
        self.expect(self.judge("// guarantee: host-bus:2.5/6, `bus: b, *`"), 1, "bus: b, * has judged nothing")

    def test_a_checker_that_never_judged_fails(self):
        self.write("results/covers.json", json.dumps({"commit": "x", "covers": {"bus: a, I/O": {"systemc": 0}}}))
        self.expect(self.judge("// guarantee: host-bus:2.5/6, `bus: a, *`"), 1, "bus: a, I/O has judged nothing")

    def test_an_excuse_that_does_not_hold_fails(self):
        self.expect(self.judge("// guarantee: power-on"), 1, "it looks at no flag of age")
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
