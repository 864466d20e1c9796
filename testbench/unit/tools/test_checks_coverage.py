"""Negative controls of the rows of docs/coverage.md, and what its generator counts."""

import hashlib
import pathlib
import sys

from tree import TOOLS, Tree, run

sys.path.insert(0, str(TOOLS))
import coverage
import coverage_exclusions

PAGE = "docs/coverage.md"


class Rows(Tree):
    """A module with a model, one without, a package, and a folder of the firmware."""

    def setUp(self):
        super().setUp()
        for path, text in {"rtl/board/watchdog.sv": "module watchdog (\n", "rtl/host/dpram.sv": "module dpram (\n",
                           "rtl/regs/words_pkg.sv": "package words_pkg;\n", "systemc/board/watchdog.h": "",
                           "firmware/base/text.c": ""}.items():
            self.write(path, text)
        lines = {("systemc/board/watchdog.h", 7): 2, ("systemc/board/watchdog.h", 8): 0, ("firmware/base/text.c", 3): 1}
        points = {("line", "rtl/board/watchdog.sv", 4, ""): 1, ("toggle", "rtl/board/watchdog.sv", 5, "a"): 1,
                  ("toggle", "rtl/board/watchdog.sv", 5, "b"): 2}
        rows = coverage.module_rows(self.root, lines, points), coverage.folder_rows(self.root, lines)
        of_modules, of_folders = map(coverage.texts, rows)
        self.write(PAGE, coverage.page("2 of 2 tests passed", coverage.with_sources(self.root, of_modules), of_folders))

    def page(self):
        return pathlib.Path(self.root / PAGE).read_text()

    def clean(self):
        self.expect(self.run_tool("coverage.py", "--check", "--release"), 0, "2 modules and models: clean")

    def out_of_date(self, text):
        """Named each time; of a release alone it is a failure."""
        self.expect(self.run_tool("coverage.py", "--check"), 0, text)
        self.expect(self.run_tool("coverage.py", "--check", "--release"), 1, text)

    def source(self, path):
        """The hash of a page's cell: of the words of the text, whatever is between them."""
        return hashlib.sha256(hashlib.sha256(path.encode()).digest()).hexdigest()[:16]

    def test_what_a_run_reached(self):
        self.clean()
        self.assertIn("| `board/watchdog` | 1 of 1 (100.0 %) | 1 of 2 (50.0 %) | 1 of 2 (50.0 %) | "
                      f"`{self.source('module watchdog (')}` |\n", self.page())
        self.assertIn(f"| `host/dpram` | {coverage.NO_COUNTER} |  |  | `{self.source('module dpram (')}` |\n",
                      self.page())
        self.assertIn("| `firmware/base` | 1 of 1 (100.0 %) |\n", self.page())
        self.assertIn("| `systemc/board` | 1 of 2 (50.0 %) |\n| all | 2 of 3 (66.7 %) |\n", self.page())

    def test_a_module_without_a_row(self):
        self.write("rtl/host/host_port.sv", "module host_port (\n")
        self.out_of_date(f"{PAGE}: no row of host/host_port")

    def test_a_model_without_a_row(self):
        self.write("systemc/host/pci_bridge.cpp", "")
        self.out_of_date(f"{PAGE}: no row of host/pci_bridge")

    def test_a_folder_without_a_row(self):
        self.write("firmware/motion/move.c", "")
        self.out_of_date(f"{PAGE}: no row of firmware/motion")

    def test_a_row_of_what_is_gone(self):
        (self.root / "rtl/host/dpram.sv").unlink()
        self.out_of_date(f"{PAGE}: a row of host/dpram, which is not in the tree")

    def test_a_module_that_was_not_measured(self):
        self.write("rtl/host/host_port.sv", "module host_port (\n")
        self.run_tool("coverage.py", "--rows")
        self.out_of_date(f"{PAGE}: host/host_port was not measured")

    def test_comments_and_blanks_are_no_other_source(self):
        self.write("rtl/host/dpram.sv", "// Two sides.\n\nmodule dpram\n  /* ports\n   */ (\n")
        self.clean()

    def test_another_source_is_named_and_marked_as_long_as_it_is_another(self):
        self.write("rtl/host/dpram.sv", "module dpram (input\n")
        self.out_of_date(f"{PAGE}: host/dpram is stale: rtl/host/dpram.sv is not what was measured")
        marked = f"| `{self.source('module dpram (')}`, stale |\n"
        for _ in range(2):
            self.run_tool("coverage.py", "--rows")
            self.assertEqual((self.page().count(marked), self.page().count(", stale")), (1, 1))
        self.out_of_date("host/dpram is stale")
        self.write("rtl/host/dpram.sv", "module dpram (\n")
        self.clean()
        self.run_tool("coverage.py", "--rows")
        self.assertNotIn("stale |", self.page())

    def test_counters_name_their_source_from_the_tree_or_from_a_folder_of_the_build(self):
        """The point of the one name is that of the other; a source that is not of the RTL has none."""
        names = [f"{coverage.ROOT}/rtl/host/dpram.sv", "../../../rtl/host/dpram.sv", "../testbench/rig.sv"]
        for i, name in enumerate(names):
            key = {"f": name, "l": "7", "page": "v_line/dpram", "h": f"top.{i}"}
            text = "".join(f"\x01{field}\x02{value}" for field, value in key.items())
            self.write(f"{i}.dat", f"# SystemC::Coverage-3\nC '{text}' {3 + i}\n")
        points = coverage.rtl_points(sorted(pathlib.Path(self.root).glob("*.dat")))
        self.assertEqual(points, {("line", "rtl/host/dpram.sv", 7, " "): 4})

    def test_bits_that_change_before_the_reset_do_not_count(self):
        for name, times in (("1_1_start", 5), ("1_2", 1)):
            where = f"\x01f\x02{coverage.ROOT}/rtl/host/dpram.sv\x01l\x027\x01page\x02"
            self.write(f"{name}.dat", "".join(f"C '{where}{page}/dpram' {times}\n" for page in ("v_line", "v_toggle")))
        points = coverage.rtl_points(sorted(pathlib.Path(self.root).glob("*.dat")))
        self.assertEqual({key[0]: times for key, times in points.items()}, {"line": 5, "toggle": 1})

    def test_a_page_of_another_form_fails(self):
        self.write(PAGE, self.page().replace("| source of the RTL |", "|"))
        self.expect(self.run_tool("coverage.py", "--check"), 1, f"{PAGE}: no table of modules")

    def test_a_row_of_another_form_fails(self):
        self.write(PAGE, self.page().replace("| 1 of 2 (50.0 %) | 1 of 2 (50.0 %) |", "| 1 of 2 (50.0 %) |"))
        self.expect(self.run_tool("coverage.py", "--check"), 1, f"{PAGE}: board/watchdog: 4 cells; expected 5")

    def test_rows_come_and_go_without_a_run(self):
        self.write("rtl/host/host_port.sv", "module host_port (\n")
        self.write("firmware/motion/move.c", "")
        (self.root / "rtl/host/dpram.sv").unlink()
        self.assertEqual(self.run_tool("coverage.py", "--rows").returncode, 0)
        self.expect(self.run_tool("coverage.py", "--check"), 0, "1 row(s) stale or absent")
        self.assertIn(f"| `host/host_port` | {coverage.NOT_RUN} |  |  |  |\n", self.page())
        self.assertIn("| `board/watchdog` | 1 of 1 (100.0 %) | 1 of 2 (50.0 %) | 1 of 2 (50.0 %) |", self.page())


SOURCE = "module watchdog (\n  if (a) b <= 1;\n  else b <= 0;\n  logic [1:0] a_q;\n"
LINES = {("systemc/board/watchdog.h", 7): 0}
POINTS = {("line", "rtl/board/watchdog.sv", 2, "3 block"): 3,
          ("branch", "rtl/board/watchdog.sv", 3, "3 else"): 0,
          ("toggle", "rtl/board/watchdog.sv", 4, "15 a_q[0]"): 2,
          ("toggle", "rtl/board/watchdog.sv", 4, "15 a_q[1]"): 1}


class Cleanup(Tree):
    """What gcov says of code that only exceptions reach: no block that is not theirs, and none that ran."""

    def test_what_the_compiler_has_put_there_does_not_count(self):
        path = self.root / "a.cpp"
        self.write("a.cpp", "class A {\n  }\n} catch (const B& b) { b.what(); }\n  return a;\n")
        for number, cleanup in ((1, True), (2, True), (3, False), (4, False), (5, False)):
            for count, unexecuted in ((0, False), (0, True), (1, False), (1, True)):
                line = {"line_number": number, "count": count, "unexecuted_block": unexecuted}
                self.assertEqual(coverage.is_cleanup(path, line), cleanup and count == 0 and not unexecuted, line)


class Exclusions(Tree):
    """Two lines and two signals of a module, one of each never reached."""

    def setUp(self):
        super().setUp()
        self.write("rtl/board/watchdog.sv", SOURCE)

    def judged(self, *rows):
        """(points that count, how many each exclusion leaves out, mistakes)"""
        text = "".join(f"[[exclusion]]\nfile = 'rtl/board/watchdog.sv'\n{row}\nreason = 'because'\n" for row in rows)
        self.write(coverage_exclusions.FILE, text)
        exclusions, mistakes = coverage_exclusions.read(self.root)
        lines, points, left, more = coverage_exclusions.leave_out(self.root, exclusions, LINES, POINTS,
                                                                  coverage.enough)
        self.assertEqual(lines, LINES)
        return set(POINTS) - set(points), list(left.values()), mistakes + more

    def test_what_no_test_can_reach_does_not_count(self):
        keys = list(POINTS)
        self.assertEqual(self.judged("lines = '^  else'", "bits = 'a_q.1.'"), ({keys[1], keys[3]}, [1, 1], []))

    def test_one_that_is_hit_fails(self):
        for row, where in (("lines = 'if .a.'", "2 block"), ("bits = 'a_q.*'", "4 a_q[0]")):
            found = self.judged(row)[2]
            self.assertEqual(len(found), 1)
            self.assertTrue(found[0].endswith(f"a test reached rtl/board/watchdog.sv:{where}"), found)

    def test_one_of_nothing_fails(self):
        for row, wanted in (("bits = 'a_q'", "nothing of it was counted"), ("lines = 'logic'", "nothing of it was"),
                            ("lines = 'none'", "no line has it"), ("lines = '('", "missing )"),
                            ("bit = 'a'", "exclusion 1 has bit, file, reason; expected file"),
                            ("lines = 'if'\nbits = 'a'", "exclusion 1 has"), ("lines = 7", "exclusion 1 has")):
            found = self.judged(row)[2]
            self.assertTrue(len(found) == 1 and wanted in found[0], f"{row}: {found}")

    def test_a_wrong_one_fails_without_a_run(self):
        self.write(coverage_exclusions.FILE, "[[exclusion]]\nfile = 'rtl/none.sv'\nlines = 'a'\nreason = 'b'\n")
        self.assertIn("no such file", coverage_exclusions.read(self.root)[1][0])
        self.write(coverage_exclusions.FILE, "[[exclusion]\n")
        self.assertEqual(len(coverage_exclusions.read(self.root)[1]), 1)

    def test_the_page_names_each_with_its_reason(self):
        self.judged("bits = 'a_q.(1|3).'")
        exclusion = coverage_exclusions.read(self.root)[0][0]
        self.assertIn("| `rtl/board/watchdog.sv` | 2 bits: `a_q.(1\\|3).` | because |\n",
                      coverage.left_out({exclusion: 2}))
        self.assertEqual(coverage.left_out({}), "")


if __name__ == "__main__":
    run()
