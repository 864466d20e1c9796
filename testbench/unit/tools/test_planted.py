#!/usr/bin/env python3
"""Bugs planted in rules: what of a source is chosen by number, and that entries and counts that are wrong are found."""

import contextlib
import io
import pathlib
import sys
import tempfile
import types
import unittest
from unittest import mock

TOOLS = pathlib.Path(__file__).resolve().parents[3] / "tools"
sys.path[:0] = [str(TOOLS / "mutate"), str(TOOLS)]
try:
    import clang  # noqa: F401
    import pyslang  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dev setup)")
    sys.exit(77)

import bugs  # noqa: E402
import enclosing  # noqa: E402
import planted  # noqa: E402
import records  # noqa: E402
import schemata  # noqa: E402
from mutant import Mutant  # noqa: E402

MODULE = b"""module m (input wire logic clk, a, b, output logic q, r);
  assign r = a & b;
  always_ff @(posedge clk)
    if (a) q <= b;
endmodule
"""
C = b"""int f(int a, int b) {
  int sum = a + b;
  if (sum > 3) sum = 3;
  for (int i = 0; i < b; ++i) sum += i;
  switch (a) {
    case 1: return b;
    default: break;
  }
  return sum;
}
"""
PAGE = """0 of 9 misreadings are kept.
| rule | holds it | how |
|---|---|---|
| servo-ic:1 | `Suite.Finds*`, `edge.vec` | planted 2 |
| servo-ic:2 | `Suite.Other` | read |
| servo-ic:3 | `Suite.Other` | planted 3 |
"""
BUG = """[["servo-ic:1"]]
file = "a.sv"
old = "a & b"
new = "a | b"
test = "unit_a Suite.FindsIt"
"""


def span(source, spans, old, new):
    place = enclosing.place(source, spans, source.index(old), old, new)
    return place.old, place.new, place.statement


class Places(unittest.TestCase):
    def test_of_verilog(self):
        spans = enclosing.of_verilog(MODULE)
        self.assertEqual(span(MODULE, spans, b"assign r = a & b", b"assign r = a | b"), ("a & b", "a | b", False))
        self.assertEqual(span(b"x = y & yz;", [(4, 10, False)], b"y & yz", b"yz")[1], "yz")
        self.assertEqual(span(MODULE, spans, b"q <= b;", b"q <= ~b;"), ("q <= b;", "q <= ~b;", True))
        self.assertEqual(span(MODULE, spans, b"if (a)", b"if (b)"), ("if (a) q <= b;", "if (b) q <= b;", True))

    def test_what_never_runs_is_refused(self):
        with self.assertRaisesRegex(ValueError, "no statement or expression"):
            span(MODULE, enclosing.of_verilog(MODULE), b"posedge", b"negedge")

    def test_of_c(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "f.c"
            file.write_bytes(C)
            source, spans = enclosing.of_c(file, [])
            header = file.with_suffix(".h")
            header.write_bytes(C)
            self.assertEqual(enclosing.of_c(header, ["-std=c11"]), (source, spans), "a header of C")
        self.assertEqual(span(source, spans, b"a + b", b"a - b"), ("a + b", "a - b", False))
        self.assertEqual(span(source, spans, b"sum > 3", b"sum > 4"), ("if (sum > 3) sum = 3;", "if (sum > 4) sum = 3;",
                                                                      True))
        self.assertEqual(span(source, spans, b"sum += i", b"sum -= i"), ("sum += i;", "sum -= i;", True))
        self.assertEqual(span(source, spans, b"return b", b"return a"), ("return b;", "return a;", True))
        self.assertEqual(span(source, spans, b"sum = 3;\n  for", b"for")[:2], ("sum = 3;", ""))
        self.assertEqual(span(source, spans, b"sum = 3;\n", b"\n")[:2], ("sum = 3;", ""))
        self.assertEqual(span(source, spans, b"i < b", b"i <= b")[2], True)

    def test_each_is_chosen_by_its_number(self):
        spans, source = enclosing.of_verilog(MODULE), MODULE
        found = [Mutant(n, "m.sv", 0, "", enclosing.place(source, spans, source.index(old), old, new))
                 for n, (old, new) in enumerate([(b"if (a)", b"if (b)"), (b"q <= b;", b"q <= a;")], 1)]
        text = schemata.write(source, found, schemata.Verilog()).decode()
        self.assertIn("begin if (mutant_pkg::number == 1) begin if (b) q <= b; end else if (a) begin if "
                      "(mutant_pkg::number == 2) begin q <= a; end else q <= b; end end", text)


class Entries(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "docs").mkdir()
        (self.root / "planted").mkdir()
        (self.root / "a.sv").write_text("assign r = a & b;\n")
        self.page(PAGE)
        self.entry(BUG)

    def page(self, text):
        (self.root / bugs.RULES).write_text(text)

    def entry(self, text):
        (self.root / "planted/one.toml").write_text(text)

    def problems(self):
        bugs.text_of.cache_clear()
        return "\n".join(bugs.problems(self.root, self.root / "planted"))

    def counts(self):
        self.page(bugs.counted((self.root / bugs.RULES).read_text(), bugs.read(self.root / "planted")))
        return (self.root / bugs.RULES).read_text()

    def test_the_page_counts_them_and_those_that_are_lost(self):
        self.assertIn("its counts are not those", self.problems())
        page = self.counts()
        self.assertIn("| servo-ic:1 | `Suite.Finds*`, `edge.vec` | planted 1 of 2 |", page)
        self.assertIn("| servo-ic:3 | `Suite.Other` | planted 0 of 3 |", page)
        self.assertIn("1 of 5 misreadings are kept", page)

    def test_one_more_than_there_were_is_their_count(self):
        self.entry("".join(BUG.replace('"a | b"', f'"{new}"') for new in ("a", "b", "1")))
        self.assertIn("| servo-ic:1 | `Suite.Finds*`, `edge.vec` | planted 3 |", self.counts())
        self.assertEqual(self.problems(), "")

    def test_a_row_that_was_only_read(self):
        self.entry(BUG.replace("servo-ic:1", "servo-ic:2").replace("Suite.FindsIt", "Suite.Other"))
        self.assertIn("| servo-ic:2 | `Suite.Other` | planted 1 |", self.counts())

    def tidy(self, release=False, **row):
        """(status, what it says) with a result that has `row`; without any where there is none."""
        bug = bugs.read(self.root / "planted")[0]
        results = self.root / "results"
        if row:
            records.write(results / "unit_a.jsonl", {"inputs": "x"}, [{"number": 1, "key": bug.key, **row}])
        bugs.text_of.cache_clear()
        self.counts()
        with contextlib.redirect_stdout(io.StringIO()) as said:
            status = bugs.tidy(self.root, False, release, self.root / "planted", results)
        return status, said.getvalue()

    def test_one_that_its_test_did_not_find_fails(self):
        status, said = self.tidy(found=False, by="its test passes")
        self.assertEqual(status, 1)
        self.assertIn("one.toml 1: servo-ic:1: a.sv: a & b => a | b: Suite.FindsIt did not find it: its test passes",
                      said)
        self.assertEqual(self.tidy(found=True, by="unit_a: Suite.FindsIt"), (0, "planted: 1 bugs, 0 problem(s)\n"))

    def test_one_that_was_never_run_fails_a_release(self):
        for row in ({}, {"found": True, "by": "", "key": "of an older text"}):
            self.assertEqual(self.tidy(**row), (0, "unit_a: 1 of its bugs have no result (./dev mutate planted "
                                                   "--resume); a release fails\n"
                                                   "planted: 1 bugs, 0 problem(s)\n"))
            status, said = self.tidy(release=True, **row)
            self.assertEqual(status, 1)
            self.assertIn("no result says that Suite.FindsIt finds it", said)

    def judged(self, inputs, *chosen, resume=False):
        """The numbers that ran, all are found."""
        ran = []
        group = types.SimpleNamespace(name="unit_a", bugs=list(chosen), inputs=lambda: inputs, build=lambda: None,
                                      build_seconds=0.0, judge=lambda bug: (ran.append(bug.number), (True, "x"))[1])
        planted.judged(group, types.SimpleNamespace(resume=resume, count=None))
        return ran

    def test_a_miss_is_kept_until_it_is_judged_anew(self):
        self.entry(BUG + BUG.replace('"a | b"', '"a"'))
        every, results = bugs.read(self.root / "planted"), self.root / "results"
        records.write(results / "unit_a.jsonl", {"inputs": "old"}, [
            {"number": 1, "key": every[0].key, "found": False, "by": "its test passes"},
            {"number": 7, "key": "of a bug that is gone", "found": False, "by": ""}])
        with mock.patch.object(bugs, "read", lambda: every), mock.patch.object(bugs, "RESULTS", results):
            self.assertEqual(self.judged("new", every[1]), [2])
            missed, never = bugs.outcomes(every, results)
            self.assertEqual((len(missed), never), (1, []))
            self.assertEqual(self.judged("new", *every, resume=True), [1])
            self.assertEqual(bugs.outcomes(every, results), ([], []))
            self.assertEqual(self.judged("new", *every, resume=True), [])
        self.assertEqual(len(records.read(results / "unit_a.jsonl")[1]), 2)

    def test_what_no_longer_applies_fails(self):
        for text in ("assign r = a ^ b;\n", "assign r = a & b | a & b;\n"):
            (self.root / "a.sv").write_text(text)
            self.assertRegex(self.problems(), r"its old text stands there (0|2) times")

    def test_a_test_that_the_row_does_not_name_fails(self):
        self.entry(BUG.replace("Suite.FindsIt", "Suite.Passes"))
        self.assertIn("does not name Suite.Passes", self.problems())

    def test_instances_and_vectors_are_named_by_their_test(self):
        for test in ("Engines/Suite.FindsIt/Rtl", "Suite/Rtl.FindsIt", "*Suite.FindsIt/*", "vectors.edge_rtl"):
            self.entry(BUG.replace("Suite.FindsIt", test))
            self.assertNotIn("does not name", self.problems(), test)

    def test_a_rule_without_a_row_fails(self):
        self.entry(BUG.replace("servo-ic:1", "servo-ic:9"))
        self.assertIn("docs/rules.md has no row 'servo-ic:9'", self.problems())

    def test_two_cuts_of_one_change_are_one_bug(self):
        self.entry(BUG + BUG.replace("a & b", "= a &").replace("a | b", "= a |"))
        self.assertIn("it stands there twice", self.problems())
        self.entry(BUG + BUG.replace("a | b", "a ^ b"))
        self.assertNotIn("twice", self.problems())

    def test_an_entry_without_a_field_is_refused(self):
        self.entry(BUG.replace('old = "a & b"\n', ""))
        with self.assertRaisesRegex(bugs.Bad, "expected file, old, new and test"):
            bugs.read(self.root / "planted")


if __name__ == "__main__":
    unittest.main()
