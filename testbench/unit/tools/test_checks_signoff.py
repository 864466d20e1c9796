"""Negative controls of the sign-off page and of the plan's covers: each rule is broken in a small tree."""

import json
import sys

from tree import TOOLS, Tree, run

sys.path.insert(0, str(TOOLS))
import verification_plan

PLAN = """| scenario | stimulus | pass | test | covers |
|---|---|---|---|---|
| a line (BREQ-1 to BREQ-2) | lines | low | `Breq.FallsOnALine` | {} |
"""
MUTATION = """## RTL
| module | mutants | judged | equal | outside | alive | score | at least | slip | s | seed | commit |
|---|---|---|---|---|---|---|---|---|---|---|---|
| `breq` | 10 | 10 | 0 | 0 | 1 | 90.0 % | 90.0 % | 90.0 % | 1 | 1 | 1234567890 |
"""


class SignOff(Tree):
    def setUp(self):
        super().setUp()
        self.write("docs/requirements.txt", "BREQ-1 | R | a line takes BREQ low\nBREQ-2 | R | BREQ returns high\n")
        self.write("docs/requirement-rules.txt", "BREQ-1: host-bus:5.3\nBREQ-2: none, it is a tool's\n")
        self.write("docs/rules.md", "| host-bus:5.2/1 to host-bus:5.4/2 | `Breq.FallsOnALine` | planted 7 of 9 |\n"
                                    "| host-bus:5.3/1 | `Breq.FallsOnALine` | read |\n"
                                    "| host-bus:5.6/1 | - | planted 3 |\n")
        self.write("docs/claimed.txt", "BREQ-1\n")
        self.write("docs/design-files.txt", "breq = rtl/*/breq.sv\nother = rtl/*/other.sv\n"
                                            "BREQ-1: breq\nBREQ-2: breq other\n")
        self.write("docs/mutation.md", MUTATION)
        self.write("docs/test-results.json", json.dumps({"run": "the test suite at commit abcdef0123, 2026-01-01",
                                                         "tests": {"Breq.FallsOnALine": {"R": "passed"}}}))
        self.write("rtl/host/breq.sv", "")
        self.write("rtl/host/other.sv", "")
        self.write("testbench/formal/breq.sv", "    R1: assert (a);\n    R2: assert (b);\n    I1: assert (c);\n")
        self.write("testbench/unit/a_test.cpp", 'TEST(Breq, FallsOnALine) {\n  BRICK_COVERS("BREQ-1");\n}\n')
        self.count("breq: lines, I17=5", 4)
        self.plan("`breq: lines, I17={5}` >= 4")

    def count(self, name, count):
        report = {"build": {"commit": "fedcba98765432"},
                  "covers": [{"name": name, "counts": {"systemc": count - 1, "rtl": 1}}]}
        self.write("report.json", json.dumps(report))

    def plan(self, covers):
        self.write("docs/verification-plan.md", PLAN.format(covers))
        return self.run_tool("signoff.py", "--covers", str(self.root / "report.json"))

    def page(self):
        return (self.root / "docs/signoff.md").read_text()

    def test_a_row_brings_together_what_stands_behind_a_requirement(self):
        self.expect(self.run_tool("signoff.py"), 0, "clean")
        self.assertIn("| BREQ-1 | yes | host-bus:5.3 (planted 7, lost 2, read 1) | 1 tests<br>1 of 1 passed | "
                      "`breq: lines, I17={5}`: 4 of 4 | `breq` 2 | `breq` 90.0 % | tests abcdef0123<br>"
                      "covers fedcba9876<br>scores 1234567890 |", self.page())
        self.assertIn("| BREQ-2 | no | none, it is a tool's | none | `breq: lines, I17={5}`: 4 of 4 | `breq` 2 | "
                      "`breq` 90.0 %<br>no figure: `other` |", self.page())

    def test_a_stale_page_fails(self):
        self.write("docs/claimed.txt", "BREQ-1\nBREQ-2\n")
        self.expect(self.run_tool("signoff.py"), 1, "docs/signoff.md is stale: run ./dev signoff")
        self.expect(self.run_tool("signoff.py", "--write"), 0, "clean")
        self.write("docs/mutation.md", MUTATION.replace("90.0 % | 90.0 % | 90", "80.0 % | 80.0 % | 80"))
        self.expect(self.run_tool("signoff.py"), 1, "stale")

    def test_a_score_whose_file_changed_is_marked_and_does_not_make_the_page_stale(self):
        self.write("docs/mutation.md", MUTATION.replace("1234567890 |", "1234567890, stale |"))
        self.expect(self.run_tool("signoff.py"), 0, "clean")
        self.run_tool("signoff.py", "--write")
        self.assertIn("`breq` 90.0 %, stale |", self.page())

    def test_a_name_of_two_kinds_has_the_score_of_its_own_kind(self):
        other = MUTATION.replace("90.0 % | 90.0 % | 90", "10.0 % | 10.0 % | 10")
        self.write("docs/design-files.txt", "breq = rtl/*/breq.sv\nfirmware = firmware/breq/*.c\n"
                                            "BREQ-1: breq\nBREQ-2: firmware\n")
        self.write("firmware/breq/fill.c", "")
        for text, firmware in ((MUTATION + other.replace("RTL", "Firmware"), "`breq` 10.0 %"),
                               (other.replace("RTL", "Firmware") + MUTATION, "`breq` 10.0 %"),
                               (MUTATION + other.replace("RTL", "Model"), "no figure: `breq`")):
            self.write("docs/mutation.md", text)
            self.run_tool("signoff.py", "--write")
            self.assertIn("| `breq` 2 | `breq` 90.0 % |", self.page())
            self.assertIn(f"| none | {firmware} |", self.page())

    def test_a_test_that_failed_is_no_pass(self):
        results = (self.root / "docs/test-results.json").read_text()
        self.write("docs/test-results.json", results.replace('"passed"', '"failed"'))
        self.run_tool("signoff.py", "--write")
        self.assertIn("0 of 1 passed", self.page())

    def test_a_requirement_without_rules_fails(self):
        self.write("docs/requirement-rules.txt", "BREQ-1: host-bus:5.3\nBREQ-9: host-bus:5.3\n")
        done = self.run_tool("signoff.py", "--write")
        self.expect(done, 1, "BREQ-2 has no rules")
        self.expect(done, 1, "'BREQ-9' is no requirement")
        self.write("docs/requirement-rules.txt", "BREQ-1: host-bus:5.3\nBREQ-2: the manual\n")
        self.expect(self.run_tool("signoff.py", "--write"), 1, "expected ID: citations")

    def test_a_claim_that_no_row_of_the_plan_names_fails(self):
        self.write("docs/verification-plan.md", PLAN.format("listed").replace("BREQ-1 to ", ""))
        self.expect(self.run_tool("signoff.py", "--write"), 1, "BREQ-1 is claimed, but no row of")

    def test_a_cover_that_was_not_counted_fails(self):
        self.expect(self.plan("`breq: pulses` >= 1"), 1, "`breq: pulses`: 0; expected at least 1")

    def test_a_cover_below_its_count_fails(self):
        self.count("breq: lines, I17=6", 3)
        self.expect(self.plan("`breq: lines, I17={6}` >= 4"), 1, "breq: lines, I17=6`: 3; expected at least 4")

    def test_each_of_a_list_is_asked_for(self):
        self.expect(self.plan("`breq: lines, I17={4; 5}` >= 4"), 1, "breq: lines, I17=4`: 0; expected at least 4")
        self.expect(self.plan("`breq: {lines; pulses}, I17={5..6}` >= 1"), 1, "3 problem(s)")
        self.expect(self.plan("`breq: lines, I17=*` >= 4"), 1, "breq: lines, I17=*`: 0; expected at least 4")

    def test_lists_in_braces_are_a_cross(self):
        self.assertEqual(verification_plan.each("a"), ["a"])
        self.assertEqual(verification_plan.each("t{8..1}"), ["t8..1"])  # counted never, so that it fails
        self.assertEqual(verification_plan.each("t{1..3; 5off}, {I/O; b = 2, c}!"),
                         [f"t{n}, {what}!" for n in ("1", "2", "3", "5off") for what in ("I/O", "b = 2, c")])

    def trace(self, covers):
        self.plan(covers)
        return self.run_tool("traceability.py", "--write")

    def test_a_row_of_the_plan_without_covers_and_reason_fails(self):
        for covers in ("listed", "`breq: lines, {I/O}` >= 1,000", "proved, asserted", "none: the pins are not there"):
            self.expect(self.trace(covers), 0, "clean")
        self.expect(self.trace(""), 1, "'a line (BREQ-1 to BREQ-2)': no cover and no reason")
        self.expect(self.trace("-"), 1, "no cover and no reason")
        self.expect(self.trace("none:"), 1, "'none' is no cover")
        self.expect(self.trace("often"), 1, "'often' is no cover")
        self.expect(self.trace("`breq: lines` >= 0"), 1, "asks for nothing")

    def test_a_table_of_the_plan_without_the_column_fails(self):
        self.write("docs/verification-plan.md", "| scenario | stimulus | pass | test |\n|---|---|---|---|\n"
                                                "| a | b | c | d |\n")
        self.expect(self.run_tool("traceability.py", "--write"), 1, "the columns are scenario, stimulus, pass, test;")


if __name__ == "__main__":
    run()
