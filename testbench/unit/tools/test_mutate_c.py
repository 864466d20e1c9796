#!/usr/bin/env python3
"""The mutation tool on a small C file: the places that its parser finds; the compiled text obeys the number."""

import pathlib
import random
import subprocess
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

import again  # noqa: E402
import c_source  # noqa: E402
import image  # noqa: E402
import mutant  # noqa: E402
import native  # noqa: E402
import runner  # noqa: E402
import schemata  # noqa: E402

FILE = b"""#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#define LIMIT 7u
#define TWICE(x) ((x) * 2)
enum kind { IDLE, BUSY, DONE };
static const int table[3] = {1, 2, 3}; /* \xc2\xb5s: places are bytes */
int32_t work(enum kind kind, uint32_t n, int32_t* out) {
  static int calls = 4;
  int32_t sum;
  sum = TWICE(5);
  if (out == NULL) return -1;
  for (uint32_t i = 0; i < n; i++) sum += table[i];
  while (n > LIMIT) n--;
  switch (kind) {
    case IDLE: sum = 1; break;
    case BUSY: return true ? 'a' : 0x1F;
    default: break;
  }
  *out = sum;
  return sum * (1.5 > calls);
}
"""


def found_in(folder):
    file = pathlib.Path(folder) / "work.c"
    file.write_bytes(FILE)
    return mutant.mutants_of("work.c", FILE, c_source.places(file, ["-std=c11"]))


class Kept(unittest.TestCase):
    def test_a_header_of_the_system_that_changes_is_parsed_anew(self):
        with tempfile.TemporaryDirectory() as folder:
            header = pathlib.Path(folder) / "outside.h"
            judge = native.Judge.__new__(native.Judge)
            judge.root, judge.commands = pathlib.Path(folder) / "tree", {"a.c": [["cc", "-c", "a.c", "-o", "a.o"]]}
            judge.programs = {"p": types.SimpleNamespace(read={"a.o": {str(header)}})}
            hashes = set()
            for text in ("int a;\n", "int b;\n"):
                header.write_text(text)
                hashes.add(judge.hash_of_read("a.c"))
        self.assertEqual(len(hashes), 2)


class Readers(unittest.TestCase):
    def test_a_library_beside_the_tests_reads_a_header_too(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            unity = root / "build/testbench/unit/a/CMakeFiles"
            texts = {"app/a.h": "", "app/alone.cpp": "", "app/of_library.cpp": "", "testbench/unit/a/a_test.cpp": ""}
            for number, joined in enumerate(("app/of_library.cpp", "testbench/unit/a/a_test.cpp")):
                texts[f"build/testbench/unit/a/CMakeFiles/{number}/Unity/u.cxx"] = f'\n#include "{root / joined}"\n'
            for name, text in texts.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            sources = [str(root / "app/alone.cpp"), *(str(unity / f"{n}/Unity/u.cxx") for n in range(2))]
            commands = {f"{n}.o": ["c++", "-c", source, "-o", f"{n}.o"] for n, source in enumerate(sources)}
            judge = native.Judge.__new__(native.Judge)
            judge.root, judge.tree, judge.module = root, root / "build", None
            judge.programs = {"p": types.SimpleNamespace(readers=lambda _: list(commands), compiles=commands,
                                                         read={target: {str(root / "app/a.h")} for target in commands})}
            with mock.patch.object(native, "sources_of", return_value=[root / "app/a.h"]):
                read_by = [c[2] for c in judge.compilations()["app/a.h"]]
        self.assertEqual(read_by, sources[:2])


class Places(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            cls.mutants = found_in(folder)

    def changes(self, operator):
        return [(m.line, m.change) for m in self.mutants if m.place.operator == operator]

    def test_operators_and_comparisons(self):
        self.assertEqual(self.changes("operator"), [
            (12, "-1 => 1"), (13, "sum += table[i] => sum -= table[i]"), (14, "n-- => n++"),
            (21, "sum * (1.5 > calls) => sum / (1.5 > calls)")])
        self.assertEqual(self.changes("comparison"), [
            (12, "out == NULL => out != NULL"), (13, "i < n => i <= n"), (13, "i < n => i >= n"),
            (14, "n > LIMIT => n <= LIMIT"), (14, "n > LIMIT => n >= LIMIT"),
            (21, "1.5 > calls => 1.5 <= calls"), (21, "1.5 > calls => 1.5 >= calls")])

    def test_constants_but_none_that_is_fixed_before_it_runs(self):
        self.assertEqual(self.changes("constant"), [
            (12, "1 => 2"), (13, "0 => 1"), (14, "LIMIT => (LIMIT + 1)"), (16, "1 => 2"), (17, "true => false"),
            (17, "'a' => ('a' + 1)"), (17, "0x1F => 0x20"), (21, "1.5 => (2.0 * 1.5)")])

    def test_conditions_and_cases(self):
        self.assertEqual(self.changes("condition"), [
            (12, "out == NULL => 0"), (12, "out == NULL => 1"), (13, "i < n => 0"), (14, "n > LIMIT => 0"),
            (17, "true => 0"), (17, "true => 1")])
        self.assertEqual(self.changes("case"), [
            (15, "kind => kind == BUSY ? ~kind : kind"), (15, "kind => kind == IDLE ? ~kind : kind")])

    def test_statements_but_none_that_gives_a_variable_its_first_value(self):
        self.assertEqual(self.changes("statement"), [
            (13, "without sum += table[i];"), (14, "without n--;"), (16, "without break;"), (18, "without break;"),
            (20, "without *out = sum;")])

    def test_text_that_is_no_c_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "bad.c"
            file.write_text("int f(void) { return }")
            with self.assertRaisesRegex(ValueError, "Clang does not read it"):
                c_source.places(file, [])


class Texts(unittest.TestCase):
    MAIN = """#include <stdio.h>
#include <stdint.h>
#include <stdlib.h>
unsigned brick_mutant_number;
unsigned char brick_mutant_reached[999];
int32_t work(int kind, uint32_t n, int32_t* out);
int main(int argc, char** argv) {
  brick_mutant_number = (unsigned)atoi(argv[1]);
  int32_t out = 0;
  printf("%d", work(2, 2, &out));
  printf(" %d", out);
  for (unsigned i = 0; i < 999; i++)
    if (brick_mutant_reached[i] != 0) printf(" %u", i);
}
"""

    def test_the_number_chooses_and_what_is_reached_is_told(self):
        with tempfile.TemporaryDirectory() as folder:
            mutants, path = found_in(folder), pathlib.Path(folder)
            (path / "all.c").write_bytes(schemata.write(FILE, mutants, schemata.C("work.c")))
            (path / "main.c").write_text(self.MAIN)
            subprocess.run(["cc", "-w", "-o", "all", "all.c", "main.c"], cwd=folder, check=True)

            def said(number):
                return subprocess.run(["./all", str(number)], cwd=folder, capture_output=True, text=True,
                                      check=True).stdout.split()

            def number(change):
                return next(m.number for m in mutants if m.change == change)

            # kind DONE, n = 2: 10 + 1 + 2; 1.5 is not above 4.
            self.assertEqual(said(0)[:2], ["0", "13"])
            self.assertEqual(said(number("sum += table[i] => sum -= table[i]"))[:2], ["0", "7"])
            self.assertEqual(said(number("i < n => i <= n"))[:2], ["0", "16"])
            self.assertEqual(said(number("1.5 > calls => 1.5 <= calls"))[:2], ["13", "13"])
            self.assertEqual(said(number("without *out = sum;"))[:2], ["0", "0"])
            self.assertEqual(said(number("out == NULL => 1")), ["-1", "0", *said(number("out == NULL => 1"))[2:]])
            self.assertIn(str(number("i < n => i <= n")), said(0)[2:])
            self.assertNotIn(str(number("without n--;")), said(0)[2:])


class Together(unittest.TestCase):
    """Tests in one process: A leaves its mark, at which a mutant makes those behind it fail."""

    PROGRAM = """#include <gtest/gtest.h>
#include <cstdlib>
static int mutant() { return std::atoi(std::getenv("BRICK_MUTANT")); }
static bool left;
TEST(Control, Fails) { FAIL(); }
TEST(Of, A) { left = true; }
TEST(Of, B) {
  EXPECT_FALSE(left && mutant() >= 7 && mutant() <= 9);
  if (left && mutant() == 10) std::abort();
}
TEST(Of, C) { EXPECT_FALSE(left && mutant() == 7); }
TEST(Of, D) {
  EXPECT_NE(mutant(), 8);
  EXPECT_NE(mutant(), 10);
}
TEST(Of, E) { EXPECT_NE(mutant(), 9); }
"""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        path = pathlib.Path(cls.folder.name)
        (path / "of.cpp").write_text(cls.PROGRAM)
        subprocess.run(["c++", "-o", "of", "of.cpp", "-lgtest_main", "-lgtest", "-lpthread"], cwd=path, check=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def verdict(self, number, which):
        self.runs = []

        def run(tests):
            self.runs.append(tests.filter)
            return runner.run(pathlib.Path(self.folder.name) / "of", tests, number, 10, "on", self.folder.name)

        verdict = runner.confirmed(run, runner.Tests("of", which))
        return verdict.status, verdict.by

    def by_any(self, number, which):
        def run(tests, number):
            return runner.run(pathlib.Path(self.folder.name) / "of", tests, number, 10, "on", self.folder.name)

        verdict = runner.by_any(run, runner.Tests("of", which), number)
        return verdict.status, verdict.by

    def test_what_number_0_fails_or_what_passes_alone_is_passed_by(self):
        self.assertEqual(self.by_any(8, "*"), ("killed", "of: Of.D"))
        self.assertEqual(self.by_any(10, "*"), ("killed", "of: Of.D"))
        self.assertEqual(self.by_any(7, "*"), ("alive", ""))
        self.assertEqual(self.by_any(9, "Control.*:Of.B"), ("alive", ""))

    def test_what_fails_behind_others_only_kills_nothing(self):
        self.assertEqual(self.verdict(7, "Of.*"), ("alive", ""))
        self.assertEqual(self.runs, ["Of.*", "Of.B", "Of.*-Of.A:Of.B"])
        self.assertEqual(self.verdict(7, "Of.A:Of.B"), ("alive", ""))
        self.assertEqual(self.verdict(0, "Of.*"), ("alive", ""))

    def test_those_behind_it_may_still_kill(self):
        self.assertEqual(self.verdict(8, "Of.*"), ("killed", "of: Of.D"))
        self.assertEqual(self.verdict(9, "Of.*-Of.C"), ("killed", "of: Of.E"))
        self.assertEqual(self.verdict(10, "Of.*"), ("killed", "of: Of.D"))

    def test_the_first_of_a_process_is_alone(self):
        self.assertEqual(self.verdict(8, "Of.D:Of.E"), ("killed", "of: Of.D"))
        self.assertEqual(self.runs, ["Of.D:Of.E"])


class Images(unittest.TestCase):
    TESTS = runner.Tests("unit_image", "*")

    def setUp(self):
        self.place = mutant.Place(10, 30, "operator", "", "")
        self.judge = image.Image(pathlib.Path("/r"), pathlib.Path("/r/build"), pathlib.Path("/out"), (self.TESTS,))
        self.judge.lines.update({("/r/a.c", 2): {0x10, 0x14}, ("/r/a.c", 3): {0x18}, ("/r/a.c", 9): {0x20},
                                 ("/r/b.c", 2): {0x30}})
        self.judge.executed = {(self.TESTS, "A.two"): {0x14, 0x30}, (self.TESTS, "A.three"): {0x18, 0x30},
                               (self.TESTS, "A.nine"): {0x20}, (self.TESTS, "A.other"): {0x30}}

    def reached(self, line, source):
        found = self.judge.reached(mutant.Mutant(1, "a.c", line, "", self.place), source)
        return sorted(found[self.TESTS])

    def test_a_mutant_is_reached_by_tests_that_execute_its_lines(self):
        self.assertEqual(self.reached(2, b"1\n" + b"2" * 40), ["A.two"])
        self.assertEqual(self.reached(2, b"1\n" + b"2" * 20 + b"\n" + b"3" * 40), ["A.three", "A.two"])

    def test_one_without_instructions_is_reached_by_all_of_its_file(self):
        self.assertEqual(self.reached(1, b"1" * 40), ["A.nine", "A.three", "A.two"])

    def test_lines_of_the_listing_are_those_of_the_instructions_below(self):
        listing = ("/r/c.c:7 (discriminator 2)\n10000000:\tlui\n10000004:\taddi\n/r/c.c:8\n10000008:\tret\n"
                   "10000010 <main>:\n")
        with mock.patch.object(image.overlay, "run", lambda *_: listing):
            self.judge.read_lines()
        self.assertEqual([self.judge.lines["/r/c.c", n] for n in (7, 8)], [{0x10000000, 0x10000004}, {0x10000008}])

    def test_the_image_judges_what_native_tests_and_the_compiler_leave(self):
        for by_image, wanted in ((runner.KILLED, "image"), (runner.ALIVE, "")):
            alive = runner.Verdict(runner.ALIVE, "", 1.0)
            judge = mock.Mock(sources={"a.c": b""}, module=mock.Mock(slip=()))
            judge.by_tests.return_value = judge.by_filter.return_value = alive
            judge.image.judge.return_value = runner.Verdict(by_image, "unit_image: A.two", 2.0)
            stage, verdict = native.Judge.judge(judge, mock.Mock(file="a.c"))
            self.assertEqual((stage, verdict.status, verdict.seconds), (wanted, by_image, 4.0))


class ImagesMade(unittest.TestCase):
    """Of two files, by the compiler of this machine; the test of the image runs it."""

    SOURCE = b"int work(int n) {\n  return n + 1;\n}\n"
    MAIN = "int work(int n);\nint main(void) { return work(2) == 3 ? 0 : 1; }\n"
    PROGRAM = """#!/bin/sh
[ -z "$BRICK_EXECUTED" ] || echo Of.Work 16 > "$BRICK_EXECUTED"
echo "[ RUN      ] Of.Work"
if "$BRICK_IMAGE"; then echo "[==========] 1 test from 1 test suite ran."; else echo "[  FAILED  ] Of.Work"; exit 1; fi
"""
    TESTS = runner.Tests("unit_image", "*")

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "bin").mkdir()
        (self.root / "a.c").write_bytes(self.SOURCE)
        (self.root / "main.c").write_text(self.MAIN)
        (self.root / "bin/unit_image").write_text(self.PROGRAM)
        (self.root / "bin/unit_image").chmod(0o755)
        self.judge = image.Image(self.root, self.root, self.root / "out", (self.TESTS,))
        self.judge.compiles = {str(self.root / file): ["cc", "-O1", "-Werror", "-MD", "-MF", f"{file}.d", "-c",
                                                       str(self.root / file), "-o", f"{file}.o"]
                               for file in ("a.c", "main.c")}
        self.judge.link = ["cc", "a.c.o", "main.c.o", "-Wl,--build-id=none", "-o", image.IMAGE]
        for command in (*self.judge.compiles.values(), self.judge.link):
            subprocess.run(command, cwd=self.root, check=True)
        self.judge.lines["none", 1] = {16}
        self.judge.lines[str(self.root / "a.c"), 2] = {16}
        for what in (mock.patch.object(image, "COPY", "objcopy"), mock.patch.object(self.judge, "read_lines")):
            what.start()
            self.addCleanup(what.stop)

    def mutant(self, new, file="a.c"):
        at = self.SOURCE.index(b"n + 1")
        return mutant.Mutant(7, file, 2, "", mutant.Place(at, at + 5, "operator", "n + 1", new))

    def verdict(self, new):
        verdict = self.judge.judge(self.mutant(new), self.SOURCE)
        return verdict.status, verdict.by.split("\n")[0]

    def test_a_mutant_is_run_in_its_image_which_goes_then(self):
        self.assertEqual(self.verdict("n + 2"), ("killed", "unit_image: Of.Work"))
        self.assertEqual(self.verdict("1 + n"), ("alive", ""))
        self.assertEqual(self.judge.again(self.mutant("n - 1"), self.SOURCE, self.TESTS).status, "killed")
        self.assertEqual(self.judge.again(self.mutant("1 + n"), self.SOURCE, self.TESTS).status, "alive")
        self.assertEqual([path.name for path in (self.root / "out").iterdir() if path.is_dir()], [])

    def test_one_that_cannot_be_built_is_outside(self):
        status, by = self.verdict("n + undeclared")
        self.assertEqual(status, "outside")
        self.assertIn("no image: cc ", by)
        self.assertFalse((self.root / "out/7").exists())

    def test_number_0_is_linked_as_mutants_are(self):
        """Linked in this way the image of any mutant would fail."""
        self.judge.link.insert(1, "-Wl,--defsym=work=main")
        for judge in (lambda: self.verdict("n + 2"),
                      lambda: self.judge.again(self.mutant("n + 2"), self.SOURCE, self.TESTS)):
            with self.assertRaisesRegex(runner.BadBuild, "number 0, the image as it is, is another when a.c is made"):
                judge()

    def test_of_a_file_that_has_gone_from_the_image_nothing_is_said(self):
        gone = self.mutant("n + 2", "gone.c")
        self.assertIsNone(self.judge.again(gone, self.SOURCE, self.TESTS))
        judge = mock.Mock(image=self.judge, sources={"gone.c": self.SOURCE}, programs={})
        judge.module.image = (self.TESTS,)
        self.assertIsNone(native.Judge.again(judge, gone, "unit_image: Of.Work"))


class Judges(unittest.TestCase):
    def test_quick_tests_come_first_and_those_only_that_come_to_it(self):
        judge = mock.Mock(reached={
            ("tests", 5): [(900, "a", "A.slow"), (3, "b", "B.quick"), (1, "a", "A.quick"), (1, "a", "A.first")],
            ("tests", 6): [], ("slip", 5): [(1, "c", "C.other")]})
        self.assertEqual([(t.program, t.filter, ms) for t, ms in native.Judge.calls(judge, "tests", 5)],
                         [("a", "A.first:A.quick", 2), ("b", "B.quick", 3), ("a", "A.slow", 900)])
        self.assertEqual(list(native.Judge.calls(judge, "tests", 6)), [])
        first = [t.filter for t, _ in native.Judge.calls(judge, "tests", 5, "a: A.slow")]
        self.assertEqual(first, ["A.slow", "A.first:A.quick", "B.quick"])

    def test_the_command_of_another_file_takes_no_notes(self):
        words = native.plain(["cc", "-MD", "-MT", "x.o", "-MF", "x.d", "-O1", "-o", "x.o", "-c", "x.c"], "y.c", "y.o")
        self.assertEqual(words, ["cc", "-O1", "-o", "y.o", "-c", "y.c"])

    def test_again_is_by_tests_that_have_a_name(self):
        self.assertTrue(again.NAMED.match("unit_firmware_servo: Limits.Upper/3"))
        self.assertFalse(again.NAMED.match("unit_firmware_servo: heap-buffer-overflow"))
        self.assertFalse(again.NAMED.match("unit_firmware_servo: /work/a.c:3:4: runtime error: index 5"))

    def test_again_draws_from_kinds_that_are_built_in_seconds(self):
        """Two that would be drawn are not, though they alone have changed; one has nothing killed."""
        modules = [mock.Mock(kind=kind) for kind in ("model", "rtl", "host", "firmware", "rtl")]
        changed = {"model", "host"}
        with mock.patch.object(again, "killed_rows", lambda m: {} if m is modules[4] else {1: {}}), \
             mock.patch.object(again.records, "source_of", lambda kind, _: kind in changed), \
             mock.patch.object(again, "source_hash", lambda _, m: False):
            drawn = {m.kind for seed in range(50) for m in again.choose(modules, random.Random(seed))}
            changed.add("firmware")
            later = {m.kind for seed in range(50) for m in again.choose(modules, random.Random(seed))}
        self.assertEqual((drawn, later), ({"rtl", "firmware"}, {"firmware"}))


if __name__ == "__main__":
    unittest.main()
