#!/usr/bin/env python3
"""The mutation tool on small texts: which places its parser finds, what it writes, how it judges what programs say."""

import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from typing import ClassVar
from unittest import mock

TOOLS = pathlib.Path(__file__).resolve().parents[3] / "tools"
sys.path[:0] = [str(TOOLS / "mutate"), str(TOOLS)]
try:
    import clang  # noqa: F401
    import pyslang  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dev setup)")
    sys.exit(77)

import common  # noqa: E402
import cpp_source  # noqa: E402
import equal  # noqa: E402
import judges  # noqa: E402
import mutant  # noqa: E402
import native  # noqa: E402
import plan  # noqa: E402
import planted  # noqa: E402
import proofs  # noqa: E402
import records  # noqa: E402
import report  # noqa: E402
import runner  # noqa: E402
import schemata  # noqa: E402
import session  # noqa: E402
import verilog  # noqa: E402
import workplace  # noqa: E402

import rtl  # noqa: E402

MODULE = b"""// \xc2\xb5s in a comment: places are bytes
module m #(parameter int Width = 4) (input wire logic clk_i, rst_ni, input wire logic [3:0] a_i, output logic [3:0] q);
  localparam logic [3:0] Top = 4'd9;
  typedef enum logic {Idle, Busy} state_e;
  state_e state_d, state_q;
  logic [3:0] q_d, q_q;
  always_comb begin
    q_d = q_q;
    state_d = state_q;
    if (a_i[2] && q_q < Top) q_d = q_q + 4'd1;
    unique case (state_q)
      Idle: state_d = Busy;
      default: begin
        state_d = Idle;
        q_d = {2{a_i[1:0]}};
      end
    endcase
  end
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      q_q <= '0;
      state_q <= Idle;
    end else begin
      q_q <= q_d;
      state_q <= state_d;
    end
  end
  assign q = ~q_q;
  logic unused, unused_top;
  assign unused = &{1'b0, q_q[3]};
  assign unused_top = &{1'b0, Top};
endmodule
"""


def changes(operator):
    found = mutant.mutants_of("m.sv", MODULE, verilog.places(MODULE))
    return [(m.line, m.change) for m in found if m.place.operator == operator]


class Places(unittest.TestCase):
    def test_operators_and_comparisons(self):
        self.assertEqual(changes("operator"), [
            (10, "a_i[2] && q_q < Top => a_i[2] || (q_q < Top)"), (10, "q_q + 4'd1 => q_q - 4'd1"),
            (28, "~q_q => q_q")])
        self.assertEqual(changes("comparison"), [(10, "q_q < Top => q_q <= Top"), (10, "q_q < Top => q_q >= Top")])

    def test_constants_but_none_that_is_fixed_before_the_model_runs(self):
        self.assertEqual(changes("constant"), [
            (10, "2 => 3"), (10, "Top => Top ^ 1'b1"), (10, "4'd1 => 4'd2"), (12, "Busy => Idle"), (14, "Idle => Busy"),
            (21, "'0 => '1"), (22, "Idle => Busy")])

    def test_conditions_case_items_and_resets(self):
        self.assertEqual(changes("condition"), [(10, f"a_i[2] && q_q < Top => 1'b{bit}") for bit in (0, 1)])
        self.assertEqual(changes("case item"), [(12, "Idle => ~(state_q)")])
        self.assertEqual(changes("reset"), [(20, "!rst_ni => 1'b0"), (21, "without q_q <= '0;"),
                                            (22, "without state_q <= Idle;")])

    def test_what_is_left_out_leaves_no_latch_and_is_no_condition_again(self):
        self.assertEqual(changes("statement"), [
            (12, "without state_d = Busy;"), (14, "without state_d = Idle;"), (15, "without q_d = {2{a_i[1:0]}};"),
            (24, "without q_q <= q_d;"), (25, "without state_q <= state_d;")])

    def test_what_is_named_unused_is_no_place(self):
        found = mutant.mutants_of("m.sv", MODULE, verilog.places(MODULE))
        self.assertEqual([m.change for m in found if "unused" in m.text], [])

    def test_text_that_is_no_verilog_is_refused(self):
        with self.assertRaisesRegex(ValueError, "slang does not read it"):
            verilog.places(b"module m; always_comb begin endmodule")


CPP = """#pragma once
#include <algorithm>
#include <string>
struct Field { unsigned get(unsigned w) const { return w; } bool operator<(const Field&) const { return true; } };
constexpr unsigned kTop = 9, kShort = kTop - 1;
constexpr Field kField{};
enum class State { kIdle, kBusy };
class Counter {
 public:
  Counter() : last_(kTop + 1) {}
  constexpr static unsigned fixed(unsigned n) { return n + 1; }
  template <class T>
  bool less(T n) const {
    if (const auto* p = this; p != nullptr) return n < last_;
    return kField < kField;
  }
  unsigned next(Field* field) {
    const unsigned size = 2;
    unsigned table[size] = {0, 1};
    auto twice = [](unsigned n) { return n * 2; };
    if (!field) return table[0];
    switch (state_) {
      case State::kIdle:
        break;
      default:
        count_ = twice(count_);
    }
    return kField.get(count_);
  }
  std::string name(const std::string& host) {
    constexpr unsigned kOne = 1, kTwo = 2;
    static constexpr unsigned short kPort = 7;
    std::fill(ports_, ports_ + 2, std::max(kPort, ports_[0]));
    std::replace(text_.begin(), text_.end(), ' ', '_');
    return '[' + host + ']' + std::to_string(kOne + count_);
  }

 private:
  State state_ = State::kIdle;
  std::string text_;
  unsigned short ports_[2];
  unsigned count_ = 0, last_;
};
"""


class PlacesOfCpp(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            cls.file = pathlib.Path(folder) / "counter.h"
            cls.file.write_text(CPP)
            cls.mutants = cpp_source.mutants(cls.file, "counter.h", ["-std=c++17"], 1)

    def found(self, line):
        return [m.change for m in self.mutants if CPP.splitlines()[m.line - 1].strip().startswith(line)]

    def test_in_headers_constructors_templates_and_lambdas(self):
        self.assertEqual(self.found("Counter()"), ["kTop => (kTop + 1)", "kTop + 1 => kTop - 1", "1 => 2"])
        self.assertEqual(self.found("if (const auto"), ["p != nullptr => p == (nullptr)", "n < last_ => n <= last_",
                                                        "n < last_ => n >= last_"])
        self.assertIn("n * 2 => n / 2", self.found("auto twice"))
        self.assertEqual(self.found("unsigned count_"), ["0 => 1"])

    def test_selectors_of_enumerations_never_take_a_case(self):
        self.assertEqual(self.found("switch"), ["state_ => brick_without(State::kIdle, state_)"])

    def test_nothing_that_is_fixed_or_does_not_compile(self):
        self.assertEqual(self.found("constexpr"), [])
        self.assertEqual(self.found("return kField < kField"), [])  # it has no `<=`
        self.assertEqual(self.found("const unsigned size"), [])  # of an array

    def test_what_clang_underlines_goes_and_nothing_before_it(self):
        self.assertEqual(self.found("constexpr unsigned kOne"), [])
        self.assertEqual(self.found("return '['"), ["'[' => char('[' + 1)", "']' => char(']' + 1)",
                                                    "kOne => (kOne + 1)", "kOne + count_ => kOne - count_"])
        self.assertIn("0 => 1", self.found("if (!field) return table[0];"))

    def test_text_with_all_of_them_is_cpp(self):
        text = schemata.write(CPP.encode(), self.mutants, schemata.C(self.file))
        with tempfile.TemporaryDirectory() as folder:
            one = pathlib.Path(folder) / "all.cpp"
            one.write_bytes(text)
            subprocess.run(["c++", "-std=c++17", "-fsyntax-only", "-w", str(one)], check=True)

    def test_a_narrow_constant_keeps_its_type_for_a_template(self):
        alone = [m for m in self.mutants if m.place.old in ("' '", "'_'", "kPort")]
        self.assertEqual(len(alone), 3)
        with tempfile.TemporaryDirectory() as folder:
            for m in alone:  # without the others, which could lend it theirs
                one = pathlib.Path(folder) / "one.cpp"
                one.write_bytes(schemata.write(CPP.encode(), [m], schemata.C(self.file)))
                subprocess.run(["c++", "-std=c++17", "-fsyntax-only", "-w", str(one)], check=True)


class Alone(unittest.TestCase):
    TEXT = b"""int of(int n) {
  switch (n) {
    case 1: return 7;
    case 2: return 7;
    default: return 0;
  }
}
int same(int n) {
  switch (n) {
    case 1: return 5;
    default: return 5;
  }
}
"""

    def test_a_case_is_equal_where_it_makes_the_same_code(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            file = root / "a.cpp"
            file.write_bytes(self.TEXT)
            judge = native.Judge.__new__(native.Judge)
            judge.root = judge.tree = root
            judge.out, judge.objects, judge.sources = root / "out", {}, {"a.cpp": self.TEXT}
            judge.commands = {"a.cpp": [["c++", "-c", str(file), "-o", "a.o"]]}
            cases = [m for m in cpp_source.mutants(file, "a.cpp", ["-std=c++17"], 1) if m.place.operator == "case"]
            self.assertEqual([(m.line, judge.by_filter(m).status) for m in cases],
                             [(2, runner.ALIVE), (2, runner.ALIVE), (9, runner.EQUAL)])


class Texts(unittest.TestCase):
    def setUp(self):
        self.mutants = mutant.mutants_of("m.sv", MODULE, verilog.places(MODULE))

    def test_all_in_one_is_read_again_and_chooses_by_number(self):
        text = schemata.write(MODULE, self.mutants, schemata.Verilog())
        verilog.places(text)  # slang reads it
        for m in self.mutants:
            self.assertEqual(len(re.findall(rf"mutant_pkg::number == {m.number}\b", text.decode())), 1, m.change)

    def test_one_alone_differs_in_its_line_only(self):
        for m in self.mutants:
            text = schemata.single(MODULE, m).decode().splitlines()
            differ = [i for i, (a, b) in enumerate(zip(text, MODULE.decode().splitlines(), strict=True), 1)
                      if a != b]
            self.assertEqual(differ, [m.line], m.change)

    def test_drawn_evenly_by_seed_and_the_rest_comes_after(self):
        first, rest = mutant.draw(self.mutants, 6, 3)
        self.assertEqual(sorted(m.number for m in first + rest), [m.number for m in self.mutants])
        for i, m in enumerate(first):  # one of each sixth
            self.assertIn(m.number - 1, range(i * len(self.mutants) // 6, (i + 1) * len(self.mutants) // 6))
        self.assertEqual((first, rest), mutant.draw(self.mutants, 6, 3))
        self.assertNotEqual(first, mutant.draw(self.mutants, 6, 4)[0])

    def test_keys_outlive_lines_that_come_above(self):
        moved = mutant.mutants_of("m.sv", b"\n" + MODULE, verilog.places(b"\n" + MODULE))
        self.assertEqual([m.key for m in moved], [m.key for m in self.mutants])
        self.assertEqual(len({m.key for m in self.mutants}), len(self.mutants))


class Verdicts(unittest.TestCase):
    TESTS = runner.Tests("unit_m", "*")

    def judge(self, status, said):
        verdict = runner.judge(status, said, self.TESTS, 1.0)
        return verdict.status, verdict.by

    def test_a_failed_expectation_kills(self):
        self.assertEqual(self.judge(1, "a.cpp:3: Failure\n[  FAILED  ] A.B/2, where GetParam() = 5 (3 ms)\n"),
                         ("killed", "unit_m: A.B/2"))

    def test_a_report_with_its_place_kills(self):
        self.assertEqual(self.judge(134, "x/a.c:7:3: runtime error: index 4 out of bounds\n")[0], "killed")
        self.assertEqual(self.judge(134, "%Error: a.sv:31: Assertion failed in TOP.m\n")[0], "killed")

    def test_a_crash_without_one_is_outside(self):
        self.assertEqual(self.judge(-11, ""), ("outside", "unit_m: ends with status -11"))

    def test_its_limit_is_time_of_the_processor(self):
        with tempfile.TemporaryDirectory() as folder:
            for script, status, by in (("while true; do :; done", "outside", "unit_m: no end within 1 s"),
                                       ("sleep 2; echo '[==========] 1 test from'", "alive", "")):
                program = pathlib.Path(folder) / "program"
                program.write_text(f"#!/bin/sh\n{script}\n")
                program.chmod(0o755)
                verdict = runner.run(program, self.TESTS, 0, 1, "on", folder)
                self.assertEqual((verdict.status, verdict.by), (status, by))

    def test_no_test_at_all_is_outside(self):
        self.assertEqual(self.judge(0, "[==========] 0 tests from 0 test suites ran.\n")[0], "outside")
        self.assertEqual(self.judge(0, "[==========] 3 tests from 1 test suite ran.\n"), ("alive", ""))


class Equal(unittest.TestCase):
    COUNTER = (b"module c (input wire logic clk_ref_i, rst_ni, en_i, output logic [1:0] q_o, output logic top_o);\n"
               b"  logic [1:0] q_q;\n  always_ff @(posedge clk_ref_i or negedge rst_ni) begin\n"
               b"    if (!rst_ni) q_q <= 2'd0;\n    else if (en_i) q_q <= (q_q == 2'd2) ? 2'd0 : q_q + 2'd1;\n  end\n"
               b"  assign q_o = q_q;\n  assign top_o = q_q >= 2'd2;\nendmodule\n")

    @unittest.skipUnless(shutil.which("yosys-abc"), "Yosys is not installed")
    def test_what_no_input_can_tell_apart_is_proved_and_nothing_else(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "rtl").mkdir()
            (root / "rtl/c.sv").write_bytes(self.COUNTER)
            judge = equal.Filter(root, "c", "rtl/c.sv", root / "out", 30)
            wanted = {"q_q == 2'd2 => q_q != 2'd2": False, "q_q >= 2'd2 => q_q > 2'd2": False,
                      "without q_q <= 2'd0;": False, "2'd2 => 2'd3": False}
            for m in mutant.mutants_of("rtl/c.sv", self.COUNTER, verilog.places(self.COUNTER)):
                if m.change in wanted:
                    (root / "mutant.sv").write_bytes(schemata.single(self.COUNTER, m))
                    self.assertEqual(judge.equal(root / "mutant.sv", root / str(m.number)), wanted[m.change], m.change)
            # The count never is 3, so from 2 on is 2: equal, by what a reset makes of it.
            (root / "mutant.sv").write_bytes(self.COUNTER.replace(b"q_q >= 2'd2", b"q_q == 2'd2"))
            self.assertTrue(judge.equal(root / "mutant.sv", root / "same"))

    @unittest.skipUnless(shutil.which("yosys-abc"), "Yosys is not installed")
    def test_a_flip_flop_without_a_reset_starts_alike_in_both_and_one_that_lost_it_as_anything(self):
        source = b"""module c (input wire logic clk_i, input wire logic rst_ni, input wire logic [3:0] size_i,
                  output logic [3:0] size_o, output logic q_o);
          always_ff @(posedge clk_i) if (!q_o) size_o <= size_i > 4'd9 ? 4'd9 : size_i;
          always_ff @(posedge clk_i or negedge rst_ni) if (!rst_ni) q_o <= 1'b0; else q_o <= q_o;
        endmodule"""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "rtl").mkdir()
            (root / "rtl/c.sv").write_bytes(source)
            judge = equal.Filter(root, "c", "rtl/c.sv", root / "out", 30)
            for number, (old, new, equals) in enumerate([(b"> 4'd9", b">= 4'd9", True), (b"9 :", b"8 :", False),
                                                         (b"q_o <= 1'b0", b"", False)]):
                (root / "mutant.sv").write_bytes(source.replace(old, new))
                self.assertEqual(judge.equal(root / "mutant.sv", root / str(number)), equals, new)

    def test_only_the_two_clocks_are_made_by_the_bench(self):
        port = {"direction": "input", "bits": [1]}
        judge = equal.Filter(pathlib.Path(), "c", "c.sv", pathlib.Path(tempfile.gettempdir()), 30)
        judge.ports = {"clk_ref_i": port, "clk_ce_i": port, "clk_o": {**port, "direction": "output"}}
        text, prepare = judge.bench()
        self.assertIn("input wire [0:0] clk_ref_i, input wire [0:0] clk_ce_i", text)
        self.assertEqual(prepare, equal.ONE)


class Proofs(unittest.TestCase):
    def test_a_rule_without_an_answer_hides_no_other(self):
        answers = {"R1": proofs.prove.Failed("no answer"), "R2": None, "R3": 7}
        solvers, rules = mock.Mock(), mock.Mock(english=list(answers), edits=[])
        solvers.search.side_effect = list(answers.values())
        with mock.patch.multiple(proofs.prove, Rules=lambda *_: rules, Solvers=lambda *_: solvers,
                                 build=lambda *_: "stem"):
            self.assertEqual(proofs.refuted(None, "m", "m.sv", "a", "b", pathlib.Path(tempfile.gettempdir()), 1), "R3")


class Fresh(unittest.TestCase):
    def fresh(self, head, **options):
        judge = mock.Mock(module=mock.Mock(), **{"inputs.return_value": "x"})
        judge.module.kind, judge.module.name, judge.module.file = "rtl", "m", "rtl/host/pic_8259.sv"
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(records, "FOLDER", pathlib.Path(folder)):
            records.write(records.path_of("rtl", "m", None), head, [Reports.ROW])
            return session.Session(judge, mock.Mock(**{"part": None, "all": False, "count": None, "seed": 1,
                                                       "renew": False, **options})).is_fresh()

    def test_results_are_fresh_when_they_are_whole_and_of_the_same_drawing(self):
        head = {"inputs": "x", "done": True, "count": session.DEFAULT_COUNT, "seed": 1}
        self.assertTrue(self.fresh(head))
        for other in ({"done": False}, {"count": 20}, {"count": None}, {"seed": 2}, {"inputs": "y"}):
            self.assertFalse(self.fresh({**head, **other}), other)
        self.assertTrue(self.fresh({**head, "count": None}, all=True))

    RENEWED = (  # status, stage, what killed it, whether that is there now and judges
        ("killed", "tests", "unit_a: Of.Work", True), ("killed", "tests", "unit_a: All/Of.Each/1", True),
        ("killed", "board", "unit_a: Of.Work", True), ("killed", "proof", "proof pic_8259: R1", True),
        ("killed", "unknowns", "unknowns: board_top: wdo_o is unknown at 101", True),
        ("killed", "tests", "unit_a: Of.Gone", False), ("killed", "tests", "unit_b: Of.Work", False),
        ("killed", "image", "unit_a: Of.Work", False), ("killed", "slip", "unit_a: Of.Work", False),
        ("killed", "proof", "proof pic_8259: R999", False), ("killed", "proof", "proof dpram: R1", False),
        ("killed", "tests", "unit_a: /m.c:3:4: runtime error: index 5", False),
        ("alive", "", "", False), ("equal", "filter", "proved equal", False))

    def test_renewed_what_tests_kill_that_are_there_stays_while_the_sources_do(self):
        """Of other inputs; seed and count are those of the results. By what it is: another finder, other numbers."""
        rows = [{**Reports.ROW, "number": n, "line": n, "text": str(n), "status": status, "stage": stage, "by": by}
                for n, (status, stage, by, _) in enumerate(self.RENEWED)]
        judge = mock.Mock(**{"inputs.return_value": "y"})
        judge.module = dataclasses.replace(plan.choose("rtl", ["pic_8259"])[0], name="m", proof="pic_8259", image=(),
                                           opinion=(runner.Tests("unit_a", "*"),), board=(runner.Tests("unit_a", "*"),),
                                           slip=(runner.Tests("unit_a", "*"),))
        options = mock.Mock(part=None, all=False, count=None, seed=1, renew=True)
        head = {"inputs": "x", "source": "s", "seed": 5, "count": 3}
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(records, "FOLDER", pathlib.Path(folder)):
            judge.tree = pathlib.Path(folder)
            (judge.tree / "bin").mkdir()
            listed = "Of.\\n  Work\\nAll/Of.\\n  Each/0  # GetParam() = 0\\n  Each/1  # GetParam() = 1\\n"
            (judge.tree / "bin/unit_a").write_text(f"#!/bin/sh\nprintf '{listed}'\n")
            (judge.tree / "bin/unit_a").chmod(0o755)
            records.write(records.path_of("rtl", "m", None), head, rows)
            there = {records.key(row) for row, (*_, there) in zip(rows, self.RENEWED, strict=True) if there}
            for source, kept in (("s", there), ("other", set())):
                with mock.patch.object(session, "source_hash", lambda *_, now=source: now):
                    one = session.Session(judge, options)
                self.assertEqual((set(one.known), one.seed, one.count, len(one.once)), (kept, 5, 3, len(rows)))

    def test_what_judges_is_an_input(self):
        module = plan.choose("rtl", ["ssi_edges"])[0]
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "bin").mkdir()
            judge = rtl.Judge(TOOLS.parent, pathlib.Path(folder), module, "judged")
            for tests in {t.program for stage in judge.stages for t in stage.tests}:
                (judge.tree / "bin" / tests).write_text("")
            with mock.patch.object(rtl, "hash_of", lambda *parts: parts):
                parts = judge.inputs()
        for name in ("mutate/runner.py", "mutate/verilog.py", "mutate/schemata.py", "prove.py"):
            self.assertIn(TOOLS / name, parts)


class Workplaces(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree = pathlib.Path(folder.name)

    def test_the_second_waits_for_the_first(self):
        folder = workplace.folder_of(self.tree, "again", "rtl_m")
        first, begin = workplace.claimed(folder), time.monotonic()
        threading.Timer(1, first.close).start()
        workplace.claimed(folder, 60).close()
        self.assertGreaterEqual(time.monotonic() - begin, 1)

    def test_it_does_not_wait_without_an_end(self):
        said = f"{self.tree}: process {os.getpid()}, another .* for 0.1 s; wait for its end, or end it"
        with workplace.claimed(self.tree), self.assertRaisesRegex(runner.BadBuild, said):
            workplace.claimed(self.tree, 0.1)

    def test_a_session_is_not_in_the_way_of_a_test(self):
        """Each below its build tree; what both could build is in two folders."""
        module, other = plan.choose("rtl", ["ssi_edges"])[0], self.tree / "other"
        with mock.patch.object(workplace, "claimed"), mock.patch.object(planted.overlay, "Program"):
            found = [judges.of(module, tree, use).out for tree in (self.tree, other) for use in ("judged", "again")]
            found += [planted.Group("unit_ssi", [], tree, use).out for tree in (self.tree, other)
                      for use in ("planted", "planted_drawn")]
        self.assertEqual([self.tree in path.parents for path in found], [True] * 8)
        self.assertEqual([other in path.parents for path in found], [False, False, True, True] * 2)
        self.assertEqual(len(set(found)), 8)


class Reports(unittest.TestCase):
    ROW: ClassVar = {"number": 1, "file": "rtl/m.sv", "line": 4, "text": "a & b", "operator": "operator",
                     "change": "a & b => a | b", "repeat": 0, "status": "alive", "stage": "", "by": "", "seconds": 2.0}
    HEAD: ClassVar = {"file": "rtl/ssi/ssi_edges.sv", "source": "?", "mutants": 9, "seed": 1, "commit": "c",
                      "dirty": False, "build_seconds": 1.0, "equal_yet_killed": []}

    def problems(self, row, given, head=None):
        return report.problems_of({("rtl", "m"): ([{**self.HEAD, **(head or {})}], [{**self.ROW, **row}])}, given)

    def open(self, row, given):
        return report.open_of({("rtl", "m"): ([self.HEAD], [{**self.ROW, **row}])}, given)

    def test_a_survivor_without_its_reason_is_open(self):
        key = records.key(self.ROW)
        self.assertIn("survivor without a reason", self.open({}, {})[0])
        self.assertEqual(self.open({}, {key: "it is so"}), [])
        self.assertEqual(self.problems({}, {key: "it is so"}), [])

    def test_what_lock_step_alone_kills_is_a_survivor_too(self):
        self.assertIn("survivor without a reason", self.open({"status": "killed", "stage": "slip"}, {})[0])

    def test_more_than_a_twentieth_outside_is_open(self):
        self.assertIn("outside the score", self.open({"status": "outside", "stage": "tests"}, {})[0])

    def test_a_reason_for_a_dead_mutant_is_a_problem(self):
        key = records.key(self.ROW)
        self.assertIn("that is killed", self.problems({"status": "killed", "stage": "tests"}, {key: "it is so"})[0])
        self.assertIn("no result has this mutant", self.problems({"status": "killed", "stage": "tests"},
                                                                 {("rtl/x.sv", *key[1:]): "it is so"})[0])

    def test_equal_yet_killed_is_a_fault(self):
        self.assertIn("a test kills it", self.problems({"status": "killed", "stage": "tests"}, {},
                                                       {"equal_yet_killed": [1]})[0])

    def test_the_lower_bound_is_wilsons(self):
        # 140 of 150, z 1.6449: (0.93333 + 0.00902 - 1.6449 * sqrt(0.06222 + 0.00451) / sqrt(150)) / 1.01804
        self.assertAlmostEqual(report.wilson(140, 150), 0.8916, places=4)
        self.assertEqual(report.wilson(0, 0), 0.0)

    def test_of_a_file_that_has_changed_since_results_are_stale(self):
        row = {**self.ROW, "status": "killed", "stage": "tests"}
        modules = {"rtl": dict.fromkeys(("now", "before"), plan.choose("rtl", ["ssi_edges"])[0])}
        results = {("rtl", name): ([{**self.HEAD, "source": source}], [row]) for name, source in (
            ("now", common.hash_of(TOOLS.parent / self.HEAD["file"])), ("before", "0123456789abcdef"))}
        text = report.page(results, {}, modules)
        self.assertRegex(text, r"`now` .* 3 \| 1 \| c \|")
        self.assertRegex(text, r"`before` .* 3 \| 1 \| c, stale \|")
        self.assertEqual(report.unmarked(text).count("3 | 1 | c |"), 2)
        self.assertRegex(text, r"together .* 6 \|  \|  \|")  # with the second that each was building

    def test_score_leaves_equal_and_outside_out(self):
        rows = [{**self.ROW, "status": s, "stage": t} for s, t in (
            ("killed", "tests"), ("killed", "proof"), ("killed", "slip"), ("alive", ""), ("equal", "filter"),
            ("outside", "tests"))]
        self.assertEqual(report.Score(rows).cells(True), ["50.0 %", "50.0 %", "75.0 %"])


class Names(unittest.TestCase):
    def test_unknown_names_say_what_there_is(self):
        with self.assertRaisesRegex(plan.Unknown, "no 'verilog' is mutated; there is: .*rtl"):
            plan.choose("verilog", [])
        with self.assertRaisesRegex(plan.Unknown, "no module pic_8260; there is: .*pic_8259"):
            plan.choose("rtl", ["pic_8259", "pic_8260"])

    def test_a_name_of_two_kinds_is_both_or_says_which(self):
        self.assertEqual({m.kind for m in plan.choose("again", ["host"])}, {"firmware", "model"})
        self.assertEqual([m.kind for m in plan.choose("again", ["model.host"])], ["model"])

    def test_every_module_of_the_plan_has_its_file(self):
        for module in plan.choose("again", []):
            self.assertTrue(mutant.sources_of(TOOLS.parent, module), module.file)
            self.assertTrue(module.opinion or module.board, module.name)
            if module.proof:
                self.assertTrue((TOOLS.parent / f"testbench/formal/{module.proof}.sv").exists(), module.proof)

    def test_parts_are_kept_apart_and_read_together(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(records, "FOLDER", pathlib.Path(folder)):
            head = {"inputs": "x", "time": "2026-01-01", "source": "s"}
            for k in (1, 2):
                records.write(records.path_of("rtl", "m", (k, 2)), head, [{"number": k}])
            records.write(records.path_of("rtl", "m", None), {**head, "inputs": "old", "time": "2025"}, [{"number": 9}])
            self.assertEqual(sorted(row["number"] for row in records.of_module("rtl", "m")[1]), [1, 2])


if __name__ == "__main__":
    unittest.main()
