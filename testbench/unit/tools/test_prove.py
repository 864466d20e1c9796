"""Negative controls of tools/prove.py: a counter of four bits that stops at nine, and rules that must not pass."""

import shutil
import sys
import unittest
from unittest import mock

from tree import TOOLS, Tree, run

sys.path.insert(0, str(TOOLS))
import prove

COUNTER = """
module counter (input wire logic clk_i, input wire logic rst_ni, input wire logic up_i, output logic [3:0] count_o);
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) count_o <= 4'd0;
    else if (up_i && count_o < 4'd9) count_o <= count_o + 4'd1;
  end
endmodule : counter
"""
RULES = """// proof: pdr
// clocks: one
// steps: 14
// fault R1: it goes on (rtl/counter.sv)
//   - count_o < 4'd9
//   + count_o < 4'd10
module counter_rules (input wire logic clk_i, input wire logic rst_ni, input wire logic up_i);
  logic [3:0] count;
  counter dut (.clk_i, .rst_ni, .up_i, .count_o(count));
  logic started_q = 1'b0;
  always @(posedge clk_i) begin
    started_q <= 1'b1;
    assume (started_q || !rst_ni);
    // R1: The count
    //     stops at nine.
    R1: assert (count <= 4'd9);
    C1: cover (count == 4'd9);
  end
endmodule : counter_rules
"""


class Refuted(unittest.TestCase):
    """What pdr says in frame 2, and what the search for the waveform makes of it."""

    def said(self, clocks, search):
        rules = mock.Mock(proof="pdr", clocks=clocks, path="m.sv", english={"R1": "It holds."})
        solvers = mock.Mock()
        rules.name, solvers.abc.return_value = "m", ("", 2)
        solvers.trace.return_value = "m.vcd"
        solvers.search.side_effect = search
        with self.assertRaises(prove.Failed) as failed:
            prove.prove(rules, solvers)
        return str(failed.exception), solvers.search.call_args.args

    def test_no_deeper_than_pdr_was(self):
        for clocks, steps in (("one", 3), ("several", 18)):
            said, asked = self.said(clocks, [1])
            self.assertEqual((said, asked), ("m.sv: R1 refuted at step 1, see m.vcd: It holds.", ("m", "R1", steps)))

    def test_a_waveform_that_is_not_found_in_time_leaves_it_refuted(self):
        for search, why in (([prove.Failed("yosys-abc: no answer within 9 s")], "yosys-abc: no answer within 9 s"),
                            ([None], "bmc3 finds it nowhere")):
            self.assertEqual(self.said("several", search)[0],
                             f"m.sv: R1 refuted within 18 steps, without a waveform ({why}): It holds.")


@unittest.skipUnless(shutil.which("yosys") and shutil.which("z3"), "yosys or z3 is not installed")
class Proofs(Tree):
    def prove(self, status, said, *changes, limit="300"):
        rules = RULES
        for old, new in changes:
            self.assertIn(old, rules)
            rules = rules.replace(old, new)
        self.write("rtl/counter.sv", COUNTER)
        self.write("testbench/formal/counter.sv", rules)
        done = self.run_tool("prove.py", "counter", "--out", self.root / "out", "--limit", limit)
        self.expect(done, status, said)
        return done.stdout

    def test_a_rule_that_holds_is_proved_reached_and_refuted_by_its_fault(self):
        said = self.prove(0, "R1 proved (pdr")
        self.assertIn("premise at step 11): The count stops at nine.", said)
        self.assertIn("R1 refuted at step 12 with 'it goes on'", said)
        self.assertTrue((self.root / "out/counter.fault.R1.vcd").exists())

    def test_induction_proves_too(self):
        self.prove(0, "R1 proved (induction, 2 steps", ("pdr", "induction 2"))

    def test_a_rule_that_does_not_hold_fails_by_either_engine(self):
        self.prove(1, "R1 refuted at step 11", ("count <= 4'd9", "count <= 4'd8"))
        self.prove(1, "induction of 5 steps fails in its base at ['R1']", ("pdr", "induction 5"),
                   ("count <= 4'd9", "count == 4'd0"))

    def test_a_rule_that_breaks_at_any_step_of_several_clocks_fails(self):
        """Six steps are proved as one: the rule is looked at in each of them."""
        for age in range(5, 11):
            self.prove(1, f"R1 refuted at step {age + 1}", ("clocks: one", "clocks: several"),
                       ("input wire logic clk_i, ", ""), ("counter dut", "logic clk_i = 1'b0; counter dut"),
                       ("@(posedge clk_i)", "@($global_clock)"), ("started_q <= 1'b1;", "clk_i <= ~clk_i;"),
                       ("logic started_q = 1'b0;", "logic started_q = 1'b0; logic [4:0] age_q = 5'd0;"),
                       ("assume (started_q || !rst_ni);", "age_q <= age_q + 5'd1;"),
                       ("assert (count <= 4'd9)", f"assert (age_q != 5'd{age})"))

    def test_no_answer_in_time_fails(self):
        self.prove(1, "yosys: no answer within 0.001 s", limit="0.001")

    def test_a_rule_that_holds_but_is_not_inductive_fails(self):
        self.prove(1, "induction of 1 steps fails in its step at ['R1']", ("pdr", "induction 1"),
                   ("count <= 4'd9", "count != 4'd12"))

    def test_a_premise_out_of_reach_fails(self):
        self.prove(1, "premises ['C1'] not reached in 14 steps", ("count == 4'd9", "count == 4'd10"))

    def test_assumptions_that_contradict_each_other_fail(self):
        self.prove(1, "premises ['C1'] not reached", ("assume (", "assume (rst_ni); assume ("))

    def test_a_fault_that_the_rule_does_not_see_fails(self):
        self.prove(1, "with 'it goes on' R1 still holds for 14 steps", ("+ count_o < 4'd10", "+ count_o <= 4'd8"))

    def test_a_fault_whose_text_is_not_there_fails(self):
        self.prove(1, "'count_o < 4'd7' occurs 0 times", ("- count_o < 4'd9", "- count_o < 4'd7"))

    def test_a_file_without_english_cover_or_fault_fails(self):
        self.prove(1, "each assert needs its rule in English", ("// R1: The count", "// The count"))
        self.prove(1, "need one cover each", ("C1: cover", "C2: cover"))
        self.prove(1, "needs a planted fault", ("// fault R1", "// wrong R1"))

    def test_rtl_that_does_not_elaborate_fails(self):
        self.prove(1, "Yosys made no model", ("counter dut", "nothing dut"))


if __name__ == "__main__":
    run()
