"""Negative controls of traceability and of the count of skipped tests: each rule is broken in a small tree."""

import subprocess
import sys

from tree import TOOLS, Tree, run

TEST_FILE = 'TEST(Breq, FallsOnALine) {\n  BRICK_COVERS("BREQ-1");\n}\n'


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
        self.expect(self.run_tool("traceability.py"), 0, "clean")

    def test_a_claim_without_a_test_fails(self):
        self.write("docs/claimed.txt", "BREQ-1\nBREQ-2\n")
        self.run_tool("traceability.py", "--write")
        self.expect(self.run_tool("traceability.py"), 1, "BREQ-2 is claimed, but no test names it")

    def test_a_claim_whose_test_is_commented_out_fails(self):
        self.write("testbench/unit/a_test.cpp", TEST_FILE.replace("  BRICK_COVERS", "  // BRICK_COVERS"))
        self.expect(self.run_tool("traceability.py"), 1, "BREQ-1 is claimed, but no test names it")

    def test_an_unknown_id_fails(self):
        self.write("testbench/unit/b_test.cpp", TEST_FILE.replace("BREQ-1", "BREQ-99"))
        self.expect(self.run_tool("traceability.py"), 1, "BREQ-99")

    def test_a_claim_of_no_requirement_fails(self):
        self.write("docs/claimed.txt", "BREQ-1\nBREQ-77\n")
        self.expect(self.run_tool("traceability.py"), 1, "'BREQ-77' is no requirement")

    def test_a_stale_page_fails(self):
        self.write("testbench/unit/b_test.cpp", TEST_FILE.replace("FallsOnALine", "FallsAgain"))
        self.expect(self.run_tool("traceability.py"), 1, "stale")

    def test_a_plan_that_names_no_existing_test_fails(self):
        self.write("docs/verification-plan.md", "| a line | `Breq.FallsOnALine`, `Breq.*` |\n")
        self.expect(self.run_tool("traceability.py"), 0, "clean")
        self.write("docs/verification-plan.md", "| a line | `Breq.Falls`, `brick.wave` |\n")
        self.expect(self.run_tool("traceability.py"), 1, "there is no test Breq.Falls")
        self.expect(self.run_tool("traceability.py"), 1, "there is no test brick.wave")

    def test_benches_and_ctest_entries_count(self):
        self.write("testbench/benches/b.cpp", '// covers: BREQ-2\nBench breq_rotary_bench() {\n')
        self.write("testbench/CMakeLists.txt", "# covers: BREQ-2\nadd_test(NAME bench.breq COMMAND x)\n")
        self.run_tool("traceability.py", "--write")
        page = (self.root / "docs/traceability.md").read_text()
        self.assertIn("bench breq-rotary (no result)<br>bench.breq (no result)", page)

    def test_covers_above_no_test_fails(self):
        self.write("testbench/CMakeLists.txt", "# covers: BREQ-2\nset(x 1)\n")
        self.expect(self.run_tool("traceability.py"), 1, "no test below it")

    def results(self, *runs):
        cases = "".join(f'<testcase name="{name}" status="{status}"/>' for name, status in runs)
        self.write("r.xml", f"<testsuite>{cases}</testsuite>")
        done = self.run_tool("traceability.py", "--results", str(self.root / "r.xml"))
        return done, (self.root / "docs/traceability.md").read_text()

    def test_the_page_names_design_files_and_the_result_on_each_engine(self):
        done, page = self.results(("Breq.FallsOnALine/Rtl  # GetParam() = rtl", "run"),
                                  ("Breq.FallsOnALine/SystemC", "run"))
        self.expect(done, 0, "clean")
        self.expect(self.run_tool("traceability.py", "--check"), 0, "clean")
        self.assertIn("| claimed | R passed<br>S passed | `rtl/host/breq.sv`<br>`systemc/breq.h` | "
                      "Breq.FallsOnALine (R S) |", page)
        self.expect(self.run_tool("traceability.py"), 0, "clean")

    def test_a_claim_that_failed_or_was_not_tried_on_one_engine_fails(self):
        done, page = self.results(("Breq.FallsOnALine/Rtl", "run"))
        self.expect(done, 1, "BREQ-1 is claimed on S: no result")
        done, page = self.results(("Breq.FallsOnALine/Rtl", "run"), ("A/Breq.FallsOnALine/Model", "fail"))
        self.expect(done, 1, "BREQ-1 is claimed on S: failed")
        self.assertIn("R passed<br>S failed", page)
        self.assertIn("Breq.FallsOnALine (failed: S)", page)

    def test_a_report_of_googletest_adds_what_ctest_has_not_run(self):
        self.results(("Breq.FallsOnALine/SystemC", "run"))
        rtl = '<testcase name="FallsOnALine/Rtl" classname="Breq" status="run" result="{}">{}</testcase>'
        for result, inside, status, says in (("completed", "", 0, "clean"),
                                             ("completed", "<failure/>", 1, "BREQ-1 is claimed on R: failed"),
                                             ("skipped", "", 1, "BREQ-1 is claimed on R: failed")):
            self.write("g.xml", f"<testsuites><testsuite>{rtl.format(result, inside)}</testsuite></testsuites>")
            self.expect(self.run_tool("traceability.py", "--results", self.root / "r.xml", self.root / "g.xml"), status,
                        says)

    def test_a_test_without_a_result_fails_beside_one_that_passed(self):
        self.write("testbench/unit/b_test.cpp", TEST_FILE.replace("FallsOnALine", "IsGone"))
        done, page = self.results(("Breq.FallsOnALine/Rtl", "run"), ("Breq.FallsOnALine/Model", "run"))
        self.expect(done, 1, "testbench/unit/b_test.cpp: Breq.IsGone names BREQ-1: no result")
        self.expect(done, 1, "BREQ-1 is claimed on R: no result")
        self.assertIn("R no result<br>S no result", page)

    def test_a_committed_page_without_a_result_fails_when_it_is_asked_for(self):
        self.expect(self.run_tool("traceability.py"), 0, "clean")
        done = self.run_tool("traceability.py", "--check")
        self.expect(done, 1, "testbench/unit/a_test.cpp: Breq.FallsOnALine names BREQ-1: no result")
        self.expect(done, 1, "BREQ-1 is claimed on R: no result")
        self.results(("Breq.FallsOnALine/Rtl", "run"), ("Breq.FallsOnALine/Model", "fail"))
        self.expect(self.run_tool("traceability.py"), 0, "clean")
        self.expect(self.run_tool("traceability.py", "--check"), 1, "BREQ-1 is claimed on S: failed")

    def test_a_failed_checker_without_an_engine_fails_every_engine(self):
        self.write("testbench/unit/b_test.cpp", TEST_FILE.replace("FallsOnALine", "Checker"))
        done, _ = self.results(("Breq.FallsOnALine/Rtl", "run"), ("Breq.FallsOnALine/Model", "run"),
                               ("Breq.Checker", "run"))
        self.expect(done, 0, "clean")
        done, _ = self.results(("Breq.FallsOnALine/Rtl", "run"), ("Breq.FallsOnALine/Model", "run"),
                               ("Breq.Checker", "fail"))
        self.expect(done, 1, "BREQ-1 is claimed on R: failed")

    def test_names_of_ctest_are_found(self):
        """Cases of a folder's own name, cases that end in an engine, suites that one entry runs."""
        self.write("testbench/unit/app/CMakeLists.txt", "foreach(case a)\nadd_test(NAME brick.${case} COMMAND x)\n"
                   "foreach(page tour)\nadd_test(NAME docs.${page} COMMAND x)\n")
        self.write("testbench/unit/app/bench_acceptance.py", "# covers: BREQ-1\ndef a_lockstep():\n    pass\n")
        self.write("testbench/unit/timing/CMakeLists.txt", "add_test(NAME timing.${case} COMMAND x)\n")
        self.write("testbench/unit/timing/timing_acceptance.py", "# covers: BREQ-1\ndef bad_access():\n    pass\n")
        self.write("testbench/unit/firmware_program/CMakeLists.txt",
                   "add_test(NAME interrupts.planted COMMAND unit_p --gtest_filter=Stream.*\n")
        self.write("testbench/unit/firmware_program/s_test.cpp", TEST_FILE.replace("Breq, Falls", "Stream, Falls"))
        both = (("Breq.FallsOnALine/Rtl", "run"), ("Breq.FallsOnALine/Model", "run"))
        done, page = self.results(*both, ("brick.a_lockstep", "run"), ("timing.bad_access", "run"),
                                  ("interrupts.planted", "run"))
        self.expect(done, 0, "clean")
        for cell in ("a_lockstep (L F)", "bad_access (S F)", "Stream.FallsOnALine (F)"):
            self.assertIn(cell, page)
        done, _ = self.results(*both, ("brick.a_lockstep", "fail"), ("brick.bad_access", "run"))
        for missing in ("bad_access", "Stream.FallsOnALine"):
            self.expect(done, 1, f"{missing} names BREQ-1: no result")

    def test_a_requirement_without_a_design_file_of_its_engine_fails(self):
        self.write("docs/design-files.txt", "breq = rtl/*/breq.sv\nBREQ-1: breq\n")
        self.expect(self.run_tool("traceability.py"), 1, "BREQ-1 applies to engine S, but has no file of it")

    def test_a_design_file_that_is_gone_fails(self):
        (self.root / "rtl/host/breq.sv").unlink()
        self.expect(self.run_tool("traceability.py"), 1, "no file rtl/*/breq.sv")


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


if __name__ == "__main__":
    run()
