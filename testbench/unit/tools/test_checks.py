"""Negative controls of the scripts in tools/: each rule is broken in a small tree of its own; the check must fail."""

import hashlib
import importlib.util
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parents[3] / "tools"

sys.path.insert(0, str(TOOLS))
import area  # noqa: E402  (found beside the other tools)

TEST_FILE = 'TEST(Breq, FallsOnALine) {\n  BRICK_COVERS("BREQ-1");\n}\n'


class Tree(unittest.TestCase):
    """A temporary tree, and a way to run a tool on it."""

    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def run_tool(self, tool, *arguments):
        return subprocess.run([sys.executable, TOOLS / tool, "--root", self.root, *arguments], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def expect(self, done, status, text):
        self.assertEqual(done.returncode, status, done.stdout)
        self.assertIn(text, done.stdout)


class Traceability(Tree):
    def setUp(self):
        super().setUp()
        self.write("docs/requirements.txt",
                   "# comment\nBREQ-1 | R S | a line takes BREQ low\nBREQ-2 | R S | BREQ returns high\n")
        self.write("docs/claimed.txt", "BREQ-1\n")
        self.write("docs/design-files.txt", "breq = rtl/*/breq.sv systemc/breq.h\nBREQ-1 BREQ-2: breq\n")
        self.write("rtl/host/breq.sv", "")
        self.write("systemc/breq.h", "")
        self.write("testbench/unit/a_test.cpp", TEST_FILE)
        self.run_tool("traceability.py", "--write")

    def test_a_claim_with_a_test_passes(self):
        self.expect(self.run_tool("traceability.py", "--check"), 0, "clean")

    def test_a_claim_without_a_test_fails(self):
        self.write("docs/claimed.txt", "BREQ-1\nBREQ-2\n")
        self.run_tool("traceability.py", "--write")
        self.expect(self.run_tool("traceability.py", "--check"), 1, "BREQ-2 is claimed, but no test names it")

    def test_a_claim_whose_test_is_commented_out_fails(self):
        self.write("testbench/unit/a_test.cpp", TEST_FILE.replace("  BRICK_COVERS", "  // BRICK_COVERS"))
        self.expect(self.run_tool("traceability.py", "--check"), 1, "BREQ-1 is claimed, but no test names it")

    def test_an_unknown_id_fails(self):
        self.write("testbench/unit/b_test.cpp", TEST_FILE.replace("BREQ-1", "BREQ-99"))
        self.expect(self.run_tool("traceability.py", "--check"), 1, "BREQ-99")

    def test_a_claim_of_no_requirement_fails(self):
        self.write("docs/claimed.txt", "BREQ-1\nBREQ-77\n")
        self.expect(self.run_tool("traceability.py", "--check"), 1, "'BREQ-77' is no requirement")

    def test_a_stale_page_fails(self):
        self.write("testbench/unit/b_test.cpp", TEST_FILE.replace("FallsOnALine", "FallsAgain"))
        self.expect(self.run_tool("traceability.py", "--check"), 1, "stale")

    def test_a_plan_that_names_no_existing_test_fails(self):
        self.write("docs/verification-plan.md", "| a line | `Breq.FallsOnALine`, `Breq.*` |\n")
        self.expect(self.run_tool("traceability.py", "--check"), 0, "clean")
        self.write("docs/verification-plan.md", "| a line | `Breq.Falls`, `brick.wave` |\n")
        self.expect(self.run_tool("traceability.py", "--check"), 1, "there is no test Breq.Falls")
        self.expect(self.run_tool("traceability.py", "--check"), 1, "there is no test brick.wave")

    def test_benches_and_ctest_entries_count(self):
        self.write("testbench/benches/b.cpp", '// covers: BREQ-2\nBench breq_rotary_bench() {\n')
        self.write("testbench/CMakeLists.txt", "# covers: BREQ-2\nadd_test(NAME bench.breq COMMAND x)\n")
        self.run_tool("traceability.py", "--write")
        page = (self.root / "docs/traceability.md").read_text()
        self.assertIn("bench breq-rotary (no result)<br>bench.breq (no result)", page)

    def test_covers_above_no_test_fails(self):
        self.write("testbench/CMakeLists.txt", "# covers: BREQ-2\nset(x 1)\n")
        self.expect(self.run_tool("traceability.py", "--check"), 1, "no test below it")

    def results(self, *runs):
        cases = "".join(f'<testcase name="{name}" status="{status}"/>' for name, status in runs)
        self.write("r.xml", f"<testsuite>{cases}</testsuite>")
        done = self.run_tool("traceability.py", "--results", str(self.root / "r.xml"))
        return done, (self.root / "docs/traceability.md").read_text()

    def test_the_page_names_design_files_and_the_result_on_each_engine(self):
        done, page = self.results(("Breq.FallsOnALine/Rtl  # GetParam() = rtl", "run"),
                                  ("Breq.FallsOnALine/SystemC", "run"))
        self.expect(done, 0, "clean")
        self.assertIn("| claimed | R passed<br>S passed | `rtl/host/breq.sv`<br>`systemc/breq.h` | "
                      "Breq.FallsOnALine (R S) |", page)
        self.expect(self.run_tool("traceability.py", "--check"), 0, "clean")

    def test_a_claim_that_failed_or_was_not_tried_on_one_engine_fails(self):
        done, page = self.results(("Breq.FallsOnALine/Rtl", "run"))
        self.expect(done, 1, "BREQ-1 is claimed on S: no result")
        done, page = self.results(("Breq.FallsOnALine/Rtl", "run"), ("A/Breq.FallsOnALine/Model", "fail"))
        self.expect(done, 1, "BREQ-1 is claimed on S: failed")
        self.assertIn("R passed<br>S failed", page)
        self.assertIn("Breq.FallsOnALine (failed: S)", page)

    def test_a_requirement_without_a_design_file_of_its_engine_fails(self):
        self.write("docs/design-files.txt", "breq = rtl/*/breq.sv\nBREQ-1: breq\n")
        self.expect(self.run_tool("traceability.py", "--check"), 1, "BREQ-1 applies to engine S, but has no file of it")

    def test_a_design_file_that_is_gone_fails(self):
        (self.root / "rtl/host/breq.sv").unlink()
        self.expect(self.run_tool("traceability.py", "--check"), 1, "no file rtl/*/breq.sv")


class SkippedTests(Tree):
    RUN = '<testcase name="A.Runs" status="run"/><testcase name="A.Fails" status="fail"/>'

    def check(self, cases):
        self.write("tests.xml", f"<testsuite>{cases}</testsuite>")
        return subprocess.run([sys.executable, TOOLS / "check_skipped.py", self.root / "tests.xml"], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def test_a_run_without_a_skipped_test_passes(self):
        self.expect(self.check(self.RUN), 0, "clean")

    def test_a_skipped_test_fails(self):
        self.expect(self.check(self.RUN + '<testcase name="regs.fresh" status="notrun"/>'), 1, "regs.fresh was skipped")
        self.expect(self.check(self.RUN + '<testcase name="A.DISABLED_B" status="disabled"/>'), 1,
                    "A.DISABLED_B was skipped")

    def test_a_run_of_nothing_fails(self):
        self.expect(self.check(""), 1, "no test was run")


class Lines(Tree):
    LONG = "a" * 100 + " " + "b" * 20 + "\n"  # 121 characters

    def check(self):
        return self.run_tool("check_format.py", "lines")

    def test_a_long_line_fails_in_every_kind_of_source(self):
        for name in ["a.sv", "a.md", "a.py", "a.cmake", "CMakeLists.txt", "a.rdl", "a.vec", "a.S", "a.cpp"]:
            self.write(name, self.LONG[1:])
            self.expect(self.check(), 0, "clean")
            self.write(name, self.LONG)
            self.expect(self.check(), 1, f"{name}:1: 121 characters, expected 120 or fewer")
            (self.root / name).unlink()
        self.write("run", "#!/bin/sh\n" + self.LONG)
        self.expect(self.check(), 1, "run:2: 121 characters")

    def test_characters_are_counted_not_bytes(self):
        self.write("a.md", "─" * 120 + "\n")
        self.expect(self.check(), 0, "clean")

    def test_tables_blocks_and_addresses_are_not_judged(self):
        self.write("a.md", f"| {self.LONG}\n```\n{self.LONG}```\n[page](docs/{'a' * 120}.md)\n")
        self.expect(self.check(), 0, "clean")
        self.write("a.md", f"```\n{self.LONG}```\n{self.LONG}")
        self.expect(self.check(), 1, "a.md:4: 121")

    def test_a_generated_file_is_not_judged(self):
        self.write("a.h", "// Generated by tools/x.py. Do not edit.\n" + self.LONG)
        self.expect(self.check(), 0, "clean")

    def test_a_blank_at_the_end_fails(self):
        self.write("a.md", "a \n")
        self.expect(self.check(), 1, "a.md:1: ends in a blank")


@unittest.skipUnless(shutil.which("git"), "git is not installed")
class Commits(Tree):
    def commit(self, file, *message):
        self.write(file, str(message))
        self.git("add", "-A")
        self.git("commit", "-q", *(word for text in message for word in ("-m", text)))
        return self.run_tool("check_commits.py")

    def git(self, *arguments):
        identity = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
        subprocess.run(["git", *identity, *arguments], cwd=self.root, check=True, stdout=subprocess.DEVNULL)

    def test_a_commit_of_code_without_a_reason_fails_from_the_check_on(self):
        self.expect(self.run_tool("check_commits.py"), 0, "nothing to judge")
        self.git("init", "-q")
        self.expect(self.commit("a.cpp", "old commits are not judged"), 0, "nothing to judge")
        self.expect(self.commit("tools/check_commits.py", "tools: check of commits"), 0, "0 commits: clean")
        self.expect(self.commit("a.md", "docs: a page"), 0, "1 commits: clean")
        self.expect(self.commit("a.cpp", "core: a change", "Because."), 0, "2 commits: clean")
        self.expect(self.commit("b.cpp", "core: another"), 1, "core: another: changes code and does not say why")

    def test_a_summary_of_another_form_fails(self):
        self.git("init", "-q")
        self.commit("tools/check_commits.py", "tools: check of commits")
        self.expect(self.commit("a.md", "A page"), 1, "expected 'area: what it does'")
        self.expect(self.commit("b.md", "docs: " + "a" * 55), 1, "in 60 characters or fewer")


@unittest.skipUnless(importlib.util.find_spec("ruff"), "ruff is not installed")
class PythonLint(Tree):
    def test_an_unused_import_and_a_long_line_fail(self):
        self.write("tools/a.py", "print(1)\n")
        self.expect(self.run_tool("lint_python.py"), 0, "clean")
        self.write("tools/a.py", f"import os\nprint({'1, ' * 40})\n")
        self.expect(self.run_tool("lint_python.py"), 1, "F401")
        self.expect(self.run_tool("lint_python.py"), 1, "E501")


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


class Area(unittest.TestCase):
    """The reading of Yosys' statistics; the page itself is made by ./dev area, which takes minutes."""

    @staticmethod
    def stat(**modules):
        text = "8. Printing statistics.\n"
        for name, (bits, cells) in modules.items():
            text += f"\n=== {name.replace('__', chr(92))} ===\n\n   Number of wires:                 80\n"
            text += f"   Number of memory bits:       {bits}\n   Number of cells:                 61\n"
            text += "".join(f"     {cell:<30} {number}\n" for cell, number in cells.items())
        return text + "\n=== design hierarchy ===\n\n   top            1\n     part         2\n\n9. Next pass.\n"

    def test_a_chip_holds_each_instance_of_its_parts(self):
        before = self.stat(top=(0, {}), part=(4096, {}))
        log = before + self.stat(top=(0, {"$_AND_": 5, "part": 2}),
                                 part=(0, {"$_MUX_": 2, "$_DFFE_PN0P_": 7, "memory_kept": 1}))
        self.assertEqual(area.gates(log), {"top": area.Figures(9, 14, 8192), "part": area.Figures(2, 7, 4096)})

    def test_a_module_with_parameters_is_found_by_its_name(self):
        self.assertEqual(area.plain("$paramod\\dpram\\Words=s32'0"), "dpram")
        self.assertEqual(area.plain("$paramod$ab12\\board_top"), "board_top")

    def test_an_unmapped_cell_is_an_error(self):
        with self.assertRaisesRegex(ValueError, "add"):
            area.gates(self.stat(top=(0, {})) + self.stat(top=(0, {"$_AND_": 5, "$add": 1})))

    def test_a_carry_cell_counts_as_two_luts(self):
        log = self.stat(top=(0, {})) + self.stat(top=(0, {"LUT4": 10, "CCU2C": 3, "PFUMX": 9, "TRELLIS_FF": 4}))
        self.assertEqual(area.ecp5(log)["top"], area.Figures(16, 4, 0))

    def test_a_memory_fills_block_ram(self):
        before = self.stat(top=(0, {"ram": 2}), ram=(524288, {"$memrd": 2}))
        good = before + self.stat(top=(0, {"ram": 2}), ram=(0, {"DP16KD": 32}))
        self.assertEqual(list(area.memory_problems(good)), [])
        for cells in ({"$mem_v2": 1}, {"DP16KD": 64}, {"$_DFFE_PN0P_": 524288}, {"TRELLIS_DPR16X4": 8192}):
            problems = list(area.memory_problems(before + self.stat(top=(0, {"ram": 2}), ram=(0, cells))))
            self.assertEqual(len(problems), 1, cells)
            self.assertIn("ram: a memory of 524288 bits takes", problems[0])

    def test_the_page_has_every_row(self):
        page = (TOOLS.parent / "docs/area.md").read_text()
        for name, text in area.ROWS.items():
            self.assertRegex(page, rf"\| `{name}` \| {re.escape(text)} \| \d+ \| \d+ \| \d* \| \d+ \| \d+ \| \d* \|")


@unittest.skipUnless(shutil.which("yosys"), "yosys is not installed")
class BlockRam(Tree):
    """The memory of the dual-ported RAM, written in ways that no block RAM can follow."""

    def memory(self, old=None, new=None):
        """area.py --memory of the real one with `old` in its text replaced by `new`."""
        texts = {name: (TOOLS.parent / f"rtl/host/{name}.sv").read_text() for name in ("dpram", "dpram_memory")}
        if old is not None:
            self.assertEqual(len(re.findall(old, texts["dpram_memory"])), 1)
            texts["dpram_memory"] = re.sub(old, new, texts["dpram_memory"])
        for name, text in texts.items():
            self.write(f"rtl/host/{name}.sv", text)
        return self.run_tool("area.py", "--memory")

    def test_as_it_stands(self):
        self.expect(self.memory(), 0, "block RAM")

    def test_all_written_with_one_clock_and_read_without(self):
        self.expect(self.memory("(?s)always_ff.*end\n", """always_ff @(posedge a_clk_i) begin
            if (a_we_i) mem[a_addr_i] <= a_wdata_i;
            if (b_we_i[0]) mem[b_addr_i][7:0] <= b_wdata_i[7:0];
            if (b_we_i[1]) mem[b_addr_i][15:8] <= b_wdata_i[15:8];
          end
          assign a_rdata_o = mem[a_addr_i];
          assign b_rdata_o = mem[b_addr_i];
          """), 1, "dpram_memory: a memory of 524288 bits takes 0 DP16KD; expected 32 and nothing else")

    def test_read_without_a_register(self):
        self.expect(self.memory(r"else if \(a_re_i\) a_rdata_o <= (mem\[a_addr_i\]);\n  end",
                                r"end\n  assign a_rdata_o = \1;"), 1, "dpram_memory: its memory fits no block RAM")

    def test_written_by_the_other_side_too(self):
        self.expect(self.memory(r"if \(a_we_i\) ", "if (b_we_i[0]) mem[b_addr_i] <= b_wdata_i;\n    if (a_we_i) "), 1,
                    "dpram_memory: its memory fits no block RAM")


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


class Layers(Tree):
    """Both trees, small: an include upward, a circle, a declaration away from its definition."""

    def setUp(self):
        super().setUp()
        self.write("firmware/hal/hal.h", "uint32_t hal_cycles(void);\n")
        self.write("firmware/hal/hal.c", '#include "firmware/hal/hal.h"\n\nuint32_t hal_cycles(void) { return 0; }\n')
        self.write("firmware/kernel/tasks.h", "extern const struct task_hooks task_hooks;\n")
        self.write("firmware/kernel/tasks.c", '#include "firmware/hal/hal.h"\n#include "firmware/kernel/tasks.h"\n')
        self.write("firmware/image/tables.c",
                   '#include "firmware/kernel/tasks.h"\n\nconst struct task_hooks task_hooks = {0};\n')
        self.write("systemc/core/ticks.h", '#include "rtl/regs/brick_regs.h"\n')
        self.write("systemc/board/board_top.cpp", '#include "systemc/core/ticks.h"\n')
        self.write("testbench/unit/core/ticks_test.cpp", '#include "app/script.h"\n')

    def check(self, status, text):
        self.expect(self.run_tool("check_layers.py"), status, text)

    def test_includes_downward_pass(self):
        self.check(0, "layers: clean")

    def test_an_upward_include_in_the_firmware_fails(self):
        self.write("firmware/hal/hal.h", '#include "firmware/kernel/tasks.h"\nuint32_t hal_cycles(void);\n')
        self.check(1, "firmware/hal/hal.h: includes firmware/kernel/tasks.h, which is not below firmware/hal")

    def test_an_upward_include_in_angle_brackets_fails(self):
        self.write("firmware/hal/hal.c", "#include <stdint.h>\n#include <firmware/kernel/tasks.h>\n")
        self.check(1, "firmware/hal/hal.c: includes firmware/kernel/tasks.h, which is not below firmware/hal")

    def test_an_upward_include_in_the_model_fails(self):
        self.write("systemc/board/board_top.cpp", '#include "systemc/cosim/engines.h"\n')
        self.check(1, "systemc/board/board_top.cpp: includes systemc/cosim/engines.h, which is not below systemc/board")

    def test_blocks_of_one_layer_do_not_include_each_other(self):
        self.write("systemc/host/dpram.h", '#include "systemc/cpu/cpu.h"\n')
        self.check(1, "systemc/host/dpram.h: includes systemc/cpu/cpu.h")

    def test_a_folder_without_a_layer_fails(self):
        self.write("firmware/drivers/led.h", "")
        self.check(1, "folder firmware/drivers has no layer")

    def test_a_circle_of_units_in_the_firmware_fails(self):
        self.write("firmware/kernel/watchdog.c", '#include "firmware/kernel/tasks.h"\n')
        self.write("firmware/kernel/tasks.c", '#include "firmware/kernel/watchdog.h"\n')
        self.check(1, "circle: firmware/kernel/tasks -> firmware/kernel/watchdog -> firmware/kernel/tasks")

    def test_a_circle_of_headers_in_the_model_fails(self):
        self.write("systemc/core/ticks.h", '#include "systemc/core/trace.h"\n')
        self.write("systemc/core/trace.h", '#include "systemc/core/ticks.h"\n')
        self.check(1, "circle: systemc/core/ticks.h -> systemc/core/trace.h -> systemc/core/ticks.h")

    def test_a_function_declared_elsewhere_fails(self):
        self.write("firmware/kernel/tasks.h", "uint32_t hal_cycles(void);\n")
        self.check(1, "firmware/kernel/tasks.h: declares hal_cycles(), which firmware/kernel/tasks.c does not define")

    def test_a_foreign_function_in_a_source_fails(self):
        self.write("firmware/kernel/tasks.c", "uint32_t hal_cycles(void);\n")
        self.check(1, "firmware/kernel/tasks.c: declares hal_cycles()")

    def test_a_foreign_variable_fails(self):
        self.write("firmware/kernel/tasks.c", "extern volatile uint32_t work;\n")
        self.check(1, "firmware/kernel/tasks.c: extern work")
        self.write("firmware/kernel/tasks.c", "void f(void) {\n  extern uint32_t hal_cycles(void);\n}\n")
        self.check(1, "firmware/kernel/tasks.c: extern inside a function")
        self.write("firmware/kernel/tasks.c", "")
        self.write("firmware/kernel/tasks.h", "extern volatile uint32_t work;\n")
        self.check(1, "firmware/kernel/tasks.h: declares work, which firmware/kernel/tasks.c does not define")

    def test_a_table_that_the_image_lacks_fails(self):
        self.write("firmware/image/tables.c", "")
        self.check(1, "firmware/kernel/tasks.h: declares task_hooks")



@unittest.skipIf(shutil.which("yosys") is None, "yosys is not installed")
class ClockCrossings(Tree):
    def setUp(self):
        super().setUp()
        shutil.copytree(TOOLS.parent / "rtl", self.root / "rtl")

    def plant(self, path, old, new):
        text = (self.root / path).read_text()
        self.assertEqual(text.count(old), 1, old)
        self.write(path, text.replace(old, new))

    def test_a_pin_that_feeds_logic_fails(self):
        self.plant("rtl/board/clock_select.sv", ".d_i(ext_phase_i), .q_o(ext_phase)", ".d_i(1'b1), .q_o()")
        self.plant("rtl/board/clock_select.sv", "(drivers_q[44] & ext_phase)", "(drivers_q[44] & ext_phase_i)")
        self.expect(self.run_tool("check_cdc.py"), 1, "ext_phase_i reaches u_clock_select.phase_q (data)")

    def test_logic_that_looks_at_the_first_flip_flop_fails(self):
        self.plant("rtl/board/bus_sync.sv", "rd2_q ^ rd3_q", "rd1_q ^ rd3_q")
        self.expect(self.run_tool("check_cdc.py"), 1, "u_bus_strobes.rd_q reaches u_bus_sync.rd1_q (data)")


if __name__ == "__main__":
    run = unittest.main(exit=False).result
    # A case that lacks its program is skipped, and then so is this test in ctest's eyes (exit status 77).
    sys.exit(1 if not run.wasSuccessful() else 77 if run.skipped else 0)
