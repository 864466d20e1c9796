#!/usr/bin/env python3
"""Checks that the C and C++ sources are formatted as .clang-format says (clang-format 14, Debian 12's). `./dev format` mends."""

import re
import shutil
import subprocess

from common import ROOT, files, finish, skip

MAJOR = 14  # other versions format a few things differently


def main():
    program = shutil.which(f"clang-format-{MAJOR}") or shutil.which("clang-format")
    if program is None:
        skip("clang-format is not installed")
    version = subprocess.run([program, "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout
    found = re.search(r"version (\d+)", version)
    if not found or int(found.group(1)) != MAJOR:
        skip(f"the sources are formatted by clang-format {MAJOR}, here is: {version.strip()}")
    sources = files(ROOT, ["app", "firmware", "systemc", "testbench"], {".cpp", ".h", ".c"})
    done = subprocess.run([program, "--dry-run", "-Werror", *map(str, sources)], cwd=ROOT, stdin=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True)
    bad = sorted({line.split(":")[0] for line in done.stderr.splitlines() if "[-Wclang-format-violations]" in line})
    problems = [f"{file}: not formatted, run ./dev format" for file in bad]
    if done.returncode != 0 and not problems:
        problems = [done.stderr.strip()]
    finish(f"format, {len(sources)} files", problems)


if __name__ == "__main__":
    main()
