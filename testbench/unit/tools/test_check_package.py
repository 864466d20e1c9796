"""tools/check_package.py on a small installed package: it passes, and each way to break it is named."""

import shutil
import subprocess
import sys
import unittest

from tree import TOOLS, Tree

sys.path.insert(0, str(TOOLS))
from check_package import other_pages, pins_of, waveform

MD = ".md"

LIST = """cmake_minimum_required(VERSION 3.25)
project({0}_example CXX)
find_package(brick REQUIRED)
add_executable({0} main.cpp)
target_link_libraries({0} brick::systemc)
enable_testing()
add_test(NAME {0} COMMAND {0})
set_tests_properties({0} PROPERTIES SKIP_RETURN_CODE 77)
"""
MAIN = "#include <brick/answer.h>\nint main() { return brick_answer() == 42 ? 0 : 1; }\n"
CONFIG = """set(brick_FOUND TRUE)
if(TARGET brick::systemc)
  return()
endif()
get_filename_component(prefix ${CMAKE_CURRENT_LIST_DIR}/../../.. ABSOLUTE)
add_library(brick::systemc STATIC IMPORTED)
set_target_properties(brick::systemc PROPERTIES IMPORTED_LOCATION ${prefix}/lib/libbrick_systemc.a
  INTERFACE_INCLUDE_DIRECTORIES ${prefix}/include)
"""
PC = """prefix=${{pcfiledir}}/../..
Name: {0}
Description: {0}
Version: 1
Cflags: -I${{prefix}}/include
Libs: -L${{prefix}}/lib -lbrick_systemc
"""


@unittest.skipIf(shutil.which("pkg-config") is None, "pkg-config is not installed")
class Package(Tree):
    def setUp(self):
        super().setUp()
        self.write("include/brick/answer.h", "int brick_answer();\n")
        self.write("answer.cpp", "#include <brick/answer.h>\nint brick_answer() { return 42; }\n")
        self.archive()
        self.write("lib/cmake/brick/brickConfig.cmake", CONFIG)
        for package in ("brick", "brick-rtl"):
            self.write(f"lib/pkgconfig/{package}.pc", PC.format(package))
        for name in ("servo_ic", "board"):
            self.write(f"share/brick/examples/{name}/CMakeLists.txt", LIST.format(name))
            self.write(f"share/brick/examples/{name}/main.cpp", MAIN)
        shutil.copy(TOOLS.parent / "examples/CMakeLists.txt", self.root / "share/brick/examples")

    def archive(self):
        (self.root / "lib").mkdir(exist_ok=True)
        subprocess.run(["c++", "-Iinclude", "-c", "answer.cpp"], cwd=self.root, check=True)
        subprocess.run(["ar", "rc", "lib/libbrick_systemc.a", "answer.o"], cwd=self.root, check=True)
        (self.root / "answer.o").unlink()

    def check(self, status, *texts, options=()):
        done = subprocess.run([sys.executable, TOOLS / "check_package.py", "--prefix", self.root, *options], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        for text in texts:
            self.expect(done, status, text)

    def replace(self, path, old, new):
        text = (self.root / path).read_text()
        self.assertIn(old, text)
        self.write(path, text.replace(old, new))

    def test_a_whole_one_passes(self):
        self.check(0, "package: clean")

    def test_a_library_that_names_the_tree_fails(self):
        self.write("answer.cpp", f'#include <brick/answer.h>\nconst char* from() {{ return "{TOOLS.parent}/a.cpp"; }}\n'
                                 "int brick_answer() { return 42; }\n")
        self.archive()
        (self.root / "answer.cpp").unlink()
        self.check(1, f"lib/libbrick_systemc.a names {TOOLS.parent}", "package: 1 problem(s)")

    def test_a_missing_header_fails(self):
        (self.root / "include/brick/answer.h").unlink()
        self.check(1, "brick/answer.h: No such file", "package: 3 problem(s)")
        self.check(1, "brick/answer.h: No such file", "package: 2 problem(s)", options=["--programs"])

    def test_a_missing_function_fails(self):
        self.write("answer.cpp", "")
        self.archive()
        self.check(1, "undefined reference to `brick_answer", "package: 3 problem(s)")

    def test_an_example_that_fails_fails(self):
        self.replace("share/brick/examples/board/main.cpp", "== 42", "== 43")
        self.check(1, "50% tests passed, 1 tests failed", "brick-rtl.pc: ", "package: 2 problem(s)")

    def test_a_skipped_test_fails(self):
        self.write("share/brick/examples/board/main.cpp", "int main(int argc, char**) { return argc > 1 ? 0 : 77; }\n")
        self.check(1, "share/brick/examples: skipped: board", "package: 1 problem(s)")

    def test_a_test_that_is_left_out_fails(self):
        self.replace("share/brick/examples/board/CMakeLists.txt", "add_test(", "if(no)\nendif()\n#add_test(")
        self.replace("share/brick/examples/board/CMakeLists.txt", "set_tests_properties", "#")
        self.check(1, "1 tests ran; expected: the 2 of 2", "package: 1 problem(s)")

    def test_an_example_that_is_not_installed_fails(self):
        for name in ("servo_ic", "cocotb_servo_channel", "firmware"):
            self.write(f"wanted/{name}/CMakeLists.txt", "")
        self.check(1, "share/brick/examples: not installed: cocotb_servo_channel, firmware",
                   "servo_ic.vcd was not written", options=["--examples", self.root / "wanted"])

    def test_an_example_without_the_package_is_left_out_by_name(self):
        shutil.rmtree(self.root / "lib/cmake")
        done = subprocess.run(["cmake", "-S", self.root / "share/brick/examples", "-B", self.root / "work"], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.expect(done, 0, "left out, the package brick is not installed: board")

    def test_a_link_that_leads_to_nothing_fails(self):
        self.write(f"share/doc/brick/one{MD}", f"[a](docs/two{MD}#b) [c](docs/three{MD}) [w](https://example.org/)\n")
        self.write(f"share/doc/brick/docs/two{MD}", f"[up](../one{MD})\n")
        self.check(1, f"share/doc/brick/one{MD}: docs/three{MD} is not installed", "package: 1 problem(s)")

    def test_a_broken_pkg_config_file_fails_by_name(self):
        self.replace("lib/pkgconfig/brick-rtl.pc", "-lbrick_systemc", "")
        self.check(1, "brick-rtl.pc: ", "undefined reference", "package: 1 problem(s)")
        (self.root / "lib/pkgconfig/brick.pc").unlink()
        self.check(1, "brick.pc is not installed", "package: 2 problem(s)")


class Waveform(Tree):
    """Of examples/servo_ic, in units of 1 ps."""

    def dump(self, period=110_685_000, quarters=40, unit="ps", without=""):
        codes = {"ch1_enc_a": "aaaaa", "ch1_enc_b": "aaaab", "phase_o": "aaaac"}
        pins = [pin for pin in pins_of("servo_ic") if pin != without]
        lines = [f"$timescale\n     1 {unit}\n$end", "$scope module ic $end",
                 *(f"$var wire    1  {codes.get(pin, pin)}  {pin} $end" for pin in pins), "0aaaaa", "0aaaab", "1aaaac"]
        for n in range(quarters):
            lines += [f"#{n * 1_000_000}", f"{int(n % 4 < 2)}{'aaaab' if n % 2 else 'aaaaa'}"]
        for n in range(5):
            lines += [f"#{50_000_000 + n * period // 2}", f"{n % 2}aaaac"]
        return self.write("servo_ic.vcd", "\n".join([*lines, ""]))

    def wrong(self, **options):
        self.dump(**options)
        return waveform(self.root / "servo_ic.vcd")

    def test_a_whole_one_passes(self):
        self.assertEqual(self.wrong(), "")

    def test_a_pin_that_is_not_traced_fails_by_name(self):
        self.assertIn("missing ['ch3_pwm_b_bot'], expected []", self.wrong(without="ch3_pwm_b_bot"))

    def test_a_period_that_is_late_by_a_tick_fails(self):
        self.assertIn("ticks of PHASE [13058], expected [13057]", self.wrong(period=110_693_000))

    def test_an_encoder_that_lacks_a_change_and_another_unit_fail(self):
        self.assertIn("quarters [20, 19], expected [20, 20]", self.wrong(quarters=39))
        self.assertIn("unit ns, expected ps", self.wrong(unit="ns"))


class Pages(Tree):
    def install(self, name):
        self.write(f"share/doc/brick/{name}", (TOOLS.parent / name).read_text())

    def test_pages_of_the_tree_are_taken(self):
        self.install("README.md")
        self.install("docs/packages.md")
        for made in ("licences/brick.spdx.json", "copyright", "changelog.gz"):
            self.write(f"share/doc/brick/{made}", "made")
        self.assertEqual([*other_pages(self.root)], [])

    def test_others_are_named(self):
        self.install("README.md")
        self.write("share/doc/brick/LICENSE", "other")
        self.write("share/doc/brick/registers/index.html", "made before")
        self.assertEqual([problem.split(":")[0] for problem in other_pages(self.root)],
                         ["share/doc/brick/LICENSE", "share/doc/brick/registers/index.html"])


if __name__ == "__main__":
    unittest.main()
