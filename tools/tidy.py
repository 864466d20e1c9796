#!/usr/bin/env python3
"""Runs clang-tidy 14 over our C and C++ by the rules of .clang-tidy: tidy.py BUILD [PATTERN ...] [--jobs N].

BUILD is a folder that CMake configured (which makes the Verilated headers too), as build/release. A PATTERN narrows
it to the sources whose path has it. Each source is judged by itself, with its first command and without the
precompiled headers, so a missing include shows here. Exit status 0 clean, 1 findings.
"""

import argparse
import concurrent.futures
import functools
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from common import ROOT, finish

MAJOR = 14  # Debian 12's; other versions have other checks
FOLDERS = ("app", "firmware", "systemc", "testbench")


@functools.cache
def compilers_own_headers():
    """Those of the sanitizers, which clang has in a package of their own."""
    asked = ["gcc", "-print-file-name=include"]
    return subprocess.run(asked, text=True, capture_output=True, check=True).stdout.strip()


def arguments_for_clang(command):
    """A command of g++ without its precompiled header, warnings and -fno- switches, which clang does not all know."""
    words, kept = shlex.split(command), []
    while words[0].endswith(("ccache", "cmake", "-E", "env")) or words[0].startswith("CCACHE"):
        words.pop(0)
    skip_next = False
    for word, after in zip(words, [*words[1:], ""], strict=True):
        if skip_next:
            skip_next = False
        elif word == "-include" and after.endswith("cmake_pch.hxx"):
            skip_next = True
        elif not word.startswith(("-W", "-fsanitize", "-fno-")):
            kept.append(word)
    return [*kept, "-idirafter", compilers_own_headers()]


def one_by_one(entry):
    """The entries of the sources that one of several includes (brick_together() in cmake/Headers.cmake)."""
    file = pathlib.Path(entry["file"])
    if file.parent.name != "Unity":
        return [entry]
    sources = re.findall(r'^#include "(.+)"$', file.read_text(), re.M)
    return [{**entry, "file": source, "command": entry["command"].replace(str(file), source)} for source in sources]


def our_commands(build):
    """[command] of our sources, as a compilation database has them; the first where a source is compiled twice."""
    found = {}
    database = json.loads((build / "compile_commands.json").read_text())
    for entry in [single for several in database for single in one_by_one(several)]:
        file = pathlib.Path(entry["file"])
        if file.is_relative_to(ROOT) and file.relative_to(ROOT).parts[0] in FOLDERS and entry["file"] not in found:
            found[entry["file"]] = {"directory": entry["directory"], "file": entry["file"],
                                    "arguments": arguments_for_clang(entry["command"])}
    return [found[file] for file in sorted(found)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("patterns", nargs="*")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    program = shutil.which(f"clang-tidy-{MAJOR}")
    if program is None:
        sys.exit(f"tidy.py: clang-tidy-{MAJOR} is not installed")
    commands = our_commands(options.build)
    database = options.build / "tidy"
    database.mkdir(exist_ok=True)
    (database / "compile_commands.json").write_text(json.dumps(commands, indent=1))
    wanted = [c["file"] for c in commands if not options.patterns or any(p in c["file"] for p in options.patterns)]
    if not wanted:
        sys.exit(f"tidy.py: no source of {options.build} has {' or '.join(options.patterns)} in its path")

    def judge(file):
        done = subprocess.run([program, "--quiet", "-p", database, file], text=True, capture_output=True)
        return file, (done.stdout or done.stderr or f"exit status {done.returncode}") if done.returncode else ""

    problems = set()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for number, (file, text) in enumerate(pool.map(judge, wanted), 1):
            print(f"[{number}/{len(wanted)}] {pathlib.Path(file).relative_to(ROOT)}", file=sys.stderr, flush=True)
            found = {line.replace(f"{ROOT}/", "") for line in text.splitlines() if " error: " in line}
            problems |= found if found or not text else {f"{file}: clang-tidy failed: {text.strip()[-300:]}"}
    finish(f"clang-tidy, {len(wanted)} sources", sorted(problems))


if __name__ == "__main__":
    main()
