"""What tools/licences.py calls whose, and what belongs to nobody."""

import pathlib
import sys
import tomllib
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools"))
import licences  # noqa: E402

ROWS = tomllib.loads(licences.TABLE.read_text())["component"]


class Licences(unittest.TestCase):
    def test_the_longest_beginning_counts(self):
        owner = {name: licences.owner_of_file(name, ROWS)["name"] for name in (
            "/usr/include/fmt/core.h", "/usr/include/stdio.h", "/usr/include/x86_64-linux-gnu/bits/types.h",
            "/usr/include/x86_64-linux-gnu/c++/12/bits/os_defines.h", "/usr/include/asio.hpp",
            "/usr/include/asio/buffer.hpp", "/usr/share/verilator/include/gtkwave/lz4.c")}
        self.assertEqual(list(owner.values()), ["libfmt", "glibc", "glibc", "gcc-runtime", "asio", "asio", "lz4"])

    def test_what_belongs_to_nobody_is_said(self):
        files, libraries = ["/usr/include/eigen3/Eigen/Core", "/opt/x/x.h"], ["libcurl.so.4", "libm.so.6"]
        found, problems = licences.used(ROWS, files, libraries)
        self.assertEqual([problem.split(":")[0] for problem in problems], [*files, "libcurl.so.4"])
        self.assertIn("expected a row of tools/components.toml", problems[0])
        self.assertEqual(found["glibc"], "DYNAMIC_LINK")

    def test_a_library_that_is_loaded_is_linked_dynamically_a_header_alone_is_in_the_binary(self):
        found, _ = licences.used(ROWS, ["/usr/include/fmt/core.h", "/usr/include/CLI/CLI.hpp"], ["libfmt.so.9"])
        self.assertEqual((found["libfmt"], found["CLI11"]), ("DYNAMIC_LINK", "STATIC_LINK"))

    def test_each_row_has_what_the_list_needs(self):
        for row in ROWS:
            self.assertLessEqual({"name", "package", "licence"}, set(row))
            self.assertTrue(row.get("image") or row.get("headers") or row.get("libraries"), row["name"])


if __name__ == "__main__":
    unittest.main()
