"""Negative controls of the checks of pages, citations and figures: each rule is broken in a small tree."""

import hashlib
import sys

from tree import TOOLS, Tree, run

sys.path.insert(0, str(TOOLS))
import check_citations


class Links(Tree):
    def setUp(self):
        super().setUp()
        self.write("README.md", "[plan](docs/plan.md) and `rtl/{a,b}.sv`, `waves/out/x.vcd`, `tools/*.py`\n"
                                "```\n`rtl/none.sv`\n```\n")
        self.write("docs/README.md", "[plan](plan.md)\n")
        for file in ["CONTRIBUTING.md", "docs/plan.md", "rtl/a.sv", "rtl/b.sv", "tools/x.py"]:
            self.write(file, "")

    def test_existing_files_pass(self):
        self.expect(self.run_tool("check_links.py"), 0, "clean")

    def test_a_missing_file_fails(self):
        (self.root / "rtl/b.sv").unlink()
        self.expect(self.run_tool("check_links.py"), 1, "README.md:1: 'rtl/b.sv' does not exist")

    def test_a_page_that_the_index_does_not_list_fails(self):
        self.write("docs/lost.md", "")
        self.expect(self.run_tool("check_links.py"), 1, "docs/lost.md: not listed")

    def test_a_broken_link_fails(self):
        self.write("docs/plan.md", "![machine](images/machine.svg)\n")
        self.expect(self.run_tool("check_links.py"), 1, "docs/plan.md:1: 'images/machine.svg' does not exist")


class Figures(Tree):
    def setUp(self):
        super().setUp()
        self.write("testbench/vectors/a.vec", "[wave]\n")
        self.write("docs/images/vectors/a.json", "{}\n")
        digest = hashlib.sha256(b"{}\n").hexdigest()
        self.write("docs/images/vectors/a.svg", f"<!-- drawn from sha256 {digest} by wavedrom 1 -->\n<svg/>\n")

    def test_a_figure_that_was_drawn_from_its_source_passes(self):
        self.expect(self.run_tool("draw_vectors.py", "--check"), 0, "clean")

    def test_a_figure_of_another_source_fails(self):
        self.write("docs/images/vectors/a.json", "{ }\n")
        self.expect(self.run_tool("draw_vectors.py", "--check"), 1, "a.svg: drawn from another a.json")

    def test_a_missing_figure_fails(self):
        self.write("testbench/vectors/b.vec", "[wave]\n")
        self.expect(self.run_tool("draw_vectors.py", "--check"), 1, "docs/images/vectors/b.json: missing")

    def test_a_figure_without_its_vector_fails(self):
        self.write("docs/images/vectors/c.svg", "")
        self.expect(self.run_tool("draw_vectors.py", "--check"), 1, "c.*: no vector with a [wave] has this name")


class Citations(Tree):
    """Each citation that leads nowhere, and each other way of pointing at a document, is found with file and line."""

    SHEET = ("# Servo IC\n## 5. Behaviour\n### 5.1 Clocks\n1. turns\n2. rises\n\n"
             "### 5.11 PWM\n| # | rule |\n|---|---|\n| 3 | off |\n")

    def setUp(self):
        super().setUp()
        self.write("docs/datasheet/servo-ic.md", self.SHEET)
        self.write("docs/clock.md", "[rules](datasheet/servo-ic.md), servo-ic:5.1/2, a wait of 1.5 periods (2.5 us)\n")
        self.write("testbench/vectors/a.vec", 'title = "a"\nsection = "servo-ic:5.1, servo-ic:5.11"\n')

    def code(self, text, status, message):
        self.write("rtl/a.sv", f"module a;\n// {text}\nendmodule\n")
        self.expect(self.run_tool("check_citations.py"), status, message)

    def fails(self, text, message):
        self.code(text, 1, f"rtl/a.sv:2: {message}")

    def test_citations_that_lead_somewhere_pass(self):
        self.code("docs/clock.md; servo-ic:5, servo-ic:5.11/3, servo-ic:5.1/1 to servo-ic:5.1/2.", 0, "7 citations")

    def test_a_section_that_is_not_there_fails(self):
        self.fails("servo-ic:5.2", "'servo-ic:5.2': docs/datasheet/servo-ic.md has no section 5.2")
        self.fails("(servo-ic:5.1; servo-ic:51)", "'servo-ic:51': docs/datasheet/servo-ic.md has no section 51")

    def test_a_rule_that_is_not_there_fails(self):
        self.fails("servo-ic:5.1/3", "'servo-ic:5.1/3': rule 3 is not in section 5.1")
        self.fails("servo-ic:5.11/2", "'servo-ic:5.11/2': rule 2 is not in section 5.11")

    def test_a_rule_that_is_there_twice_fails(self):
        self.write("docs/datasheet/servo-ic.md", self.SHEET.replace("2. rises", "1. rises"))
        self.fails("servo-ic:5.1/1", "'servo-ic:5.1/1': rule 1 is twice in section 5.1")

    def test_a_sheet_that_is_not_there_fails(self):
        self.fails("host-bus:5.1", "'host-bus:5.1': there is no docs/datasheet/host-bus.md")

    def test_a_range_that_runs_backwards_fails(self):
        self.fails("servo-ic:5.11 to servo-ic:5.1", "'servo-ic:5.11 to servo-ic:5.1' is no range of one sheet")

    def test_a_page_that_is_not_there_fails(self):
        self.fails("docs/gone.md", "'docs/gone.md' does not exist")
        self.fails("docs/gone.txt", "'docs/gone.txt' does not exist")
        self.fails("servo-ic.md", "'servo-ic.md' does not exist")

    def test_other_ways_of_pointing_fail(self):
        self.fails("servo-ic:5.1-5.11", "'servo-ic:' is no citation")
        self.fails("servo-ic:5.1, 5.11", "'5.11' names no sheet")
        self.fails("servo-ic: 5.1", "'servo-ic: 5.1' is no citation")
        self.fails("Servo_ic 5.1", "'Servo_ic 5.1' is no citation")
        self.fails("servo-ic:5.1/1 and /2", "'servo-ic:5.1/1 and /2' names a rule without its section")
        self.fails("servo-ic:5.1 rule 2", "'servo-ic:5.1 rule 2' names a rule without its section")
        self.fails("docs/datasheet/servo-ic.md 5.1", "'docs/datasheet/servo-ic.md 5.1' points into a page by number")
        self.fails("design.md section 7", "'design.md section 7' points into a page by number")
        self.fails("see section 7", "'section 7' names no sheet")
        self.fails("as the data sheet 5.1 says", "'data sheet 5.1' names no sheet")
        self.fails("bits as in 5.11", "'as in 5.11' names no sheet")
        self.fails("§ 5", "'§ 5' names no sheet")
        self.fails("off (5.11)", "'(5.11)' names no sheet")
        self.fails("5.1 item 2", "'5.1 item' names no sheet")
        self.fails("../shared/spec", "'../shared/spec' lies outside the tree")

    def test_no_line_that_a_pattern_matches_is_passed_over(self):
        """HINT: a line of each alternative, with nothing else in it."""
        patterns = [pattern for pattern, _ in check_citations.LEFTOVERS]
        lines = ("servo-ic:5-6", "Firmware 5.1", "HOST_BUS:5.1", "motion:5 rule 2", "motion:5, /2",
                 "a/shared", "a.md 5", "see sections 7", "Section 7", "§5", "data sheets, 5", "Data sheet 5", "Spec 5",
                 "spec 5", "as in 5.1", "5.1 rule", "of (5.1, 5.2)")
        masked = [check_citations.CITATION.sub(lambda match: "x" * len(match[0]), line) for line in lines]
        for line, rest in zip(lines, masked, strict=True):
            self.assertTrue(any(pattern.search(rest) for pattern in patterns), line)
            self.assertRegex(line, check_citations.HINT)
        for pattern in patterns:
            self.assertTrue(any(pattern.search(rest) for rest in masked), pattern.pattern)
        for line in ("a.md", "docs/a.txt", "docs/a.json", "docs/a.svg", "docs/a.png"):
            self.assertRegex(line, check_citations.PAGE_NAME)
            self.assertRegex(line, check_citations.HINT)

    def test_a_vector_without_citations_fails(self):
        self.write("testbench/vectors/a.vec", 'section = "5.1"\n')
        self.expect(self.run_tool("check_citations.py"), 1, "testbench/vectors/a.vec:1: '5.1' is no list of citations")

    def test_a_number_that_two_sections_have_fails(self):
        self.write("docs/datasheet/servo-ic.md", self.SHEET + "### 5.1 Again\n")
        self.expect(self.run_tool("check_citations.py"), 1,
                    "docs/datasheet/servo-ic.md:11: section 5.1 is there already, in line 3")

    def test_text_in_fences_is_no_rule(self):
        self.write("docs/datasheet/servo-ic.md", self.SHEET.replace("2. rises", "```\n2. rises\n```"))
        self.expect(self.run_tool("check_citations.py"), 1,
                    "docs/clock.md:1: 'servo-ic:5.1/2': rule 2 is not in section 5.1")


if __name__ == "__main__":
    run()
