#!/usr/bin/env python3
"""Checks how the sources are laid out.

check_format.py clang   C and C++ are formatted as .clang-format says (clang-format 14, Debian 12's); ./dev format mends
check_format.py lines   no line of any source is longer than 120 characters, and none ends in a blank

Not judged by their length: generated files, tables, code blocks and the addresses of links in Markdown, drawings.
"""

import argparse
import pathlib
import re
import shutil
import subprocess

from common import ROOT, finish, skip, tracked

MAJOR = 14  # other versions format a few things differently
LONGEST = 120
FORMATTED = {".cpp", ".h", ".c"}
TEXTS = FORMATTED | {".sv", ".vlt", ".rdl", ".vec", ".py", ".cmake", ".md", ".txt", ".S", ".ld", ".def", ".hpp"}
GENERATED = re.compile(r"(?:Generated|Made) by")  # in one of the first lines
TABLES = {".def", "docs/requirements.txt", "docs/design-files.txt"}  # one row a line


def is_script(root, file):
    return not file.suffix and (root / file).read_bytes().startswith(b"#!")


def is_generated(file, text):
    head = "\n".join(text.splitlines()[:4])
    return bool(GENERATED.search(head)) and file.suffix != ".py"


def measured(file, lines):
    """(number, what counts of the line) of the lines that are judged by their length."""
    in_block = False
    for number, line in enumerate(lines, 1):
        if file.suffix == ".md":
            if line.lstrip().startswith("```"):
                in_block = not in_block
            if in_block or line.lstrip().startswith("|"):
                continue
        yield number, re.sub(r"\]\([^)]*\)", "]()", line) if file.suffix == ".md" else line


def line_problems(root, files):
    for file in files:
        text = (root / file).read_text()
        if is_generated(file, text):
            continue
        lines = text.splitlines()
        yield from (f"{file}:{n}: ends in a blank" for n, line in enumerate(lines, 1) if line != line.rstrip())
        if file.suffix in TABLES or str(file) in TABLES:
            continue
        for number, line in measured(file, lines):
            if len(line) > LONGEST:
                yield f"{file}:{number}: {len(line)} characters, expected {LONGEST} or fewer"


def check_lines(root):
    files = [file for file in tracked(root) if file.suffix in TEXTS or is_script(root, file)]
    finish(f"lines, {len(files)} files", [*line_problems(root, files)])


def check_clang(root):
    program = shutil.which(f"clang-format-{MAJOR}") or shutil.which("clang-format")
    if program is None:
        skip("clang-format is not installed")
    version = subprocess.run([program, "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout
    found = re.search(r"version (\d+)", version)
    if not found or int(found.group(1)) != MAJOR:
        skip(f"the sources are formatted by clang-format {MAJOR}, here is: {version.strip()}")
    files = [file for file in tracked(root) if file.suffix in FORMATTED]
    done = subprocess.run([program, "--dry-run", "-Werror", *map(str, files)], cwd=root, stdin=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True)
    bad = sorted({line.split(":")[0] for line in done.stderr.splitlines() if "[-Wclang-format-violations]" in line})
    problems = [f"{file}: not formatted, run ./dev format" for file in bad]
    if done.returncode != 0 and not problems:
        problems = [done.stderr.strip()]
    finish(f"format, {len(files)} files", problems)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["clang", "lines"])
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    {"clang": check_clang, "lines": check_lines}[options.what](options.root)


if __name__ == "__main__":
    main()
