#!/usr/bin/env python3
"""Traces requirements to the tests that cover them: docs/requirements.txt -> tests -> docs/traceability.md.

A test names its requirements in one of these ways:
  GoogleTest   BRICK_COVERS("BREQ-1 BREQ-3");           first line of a TEST, TEST_F, TEST_P or TYPED_TEST
  bench        // covers: BREQ-1                         on the line above Bench breq_rotary_bench() {
  ctest        # covers: BREQ-1                          on the line above add_test(NAME ...)
  Python       # covers: BREQ-1                          on the line above def NAME(
  vector       # covers: BREQ-1                          on the line above title = in testbench/vectors/NAME.vec

  --check      (default) fails on an unknown ID, on a claimed ID (docs/claimed.txt) without a test, on a test that
               docs/verification-plan.md names and that does not exist, and when docs/traceability.md is not what --write
               would write
  --write      writes docs/traceability.md
  --results F  prints the table with the last result of each test, from `ctest --output-junit F`
"""

import argparse
import collections
import pathlib
import re
import sys
import xml.etree.ElementTree

from common import ROOT, files, finish

PAGE = "docs/traceability.md"
Test = collections.namedtuple("Test", "name file ids")


def read_requirements(root):
    """{ID: (engines, text)} in the order of the file."""
    found = {}
    for line in (root / "docs/requirements.txt").read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            name, engines, text = (part.strip() for part in line.split("|", 2))
            found[name] = (engines, text)
    return found


def read_claimed(root):
    lines = (line.split("#")[0].strip() for line in (root / "docs/claimed.txt").read_text().splitlines())
    return [line for line in lines if line]


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def tests_in_cpp(text, file):
    text = re.sub(r"^\s*//.*$", "", text, flags=re.M)  # a BRICK_COVERS that is commented out covers nothing
    heads = [(m.start(), f"{m[1]}.{m[2]}") for m in re.finditer(r"^(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)",
                                                                text, re.M)]
    for m in re.finditer(r'BRICK_COVERS\(\s*((?:"[^"]*"\s*)+)\)', text):
        before = [name for start, name in heads if start < m.start()]
        yield Test(before[-1] if before else f"{file}:{line_of(text, m.start())}", file,
                   ids_in(" ".join(re.findall(r'"([^"]*)"', m[1]))))


def tests_in_comments(text, file, head, comment="#"):
    """`# covers:` above the line that `head` matches, with nothing but comments and blank lines between."""
    pending = []
    for line in text.splitlines():
        covers = re.match(rf"\s*{comment}\s*covers:(.*)", line)
        name = re.search(head, line)
        if covers:
            pending += ids_in(covers[1])
        elif name and pending:
            yield Test(name[1], file, pending)
            pending = []
        elif line.strip() and not line.strip().startswith(comment) and pending:
            yield Test(f"{file}: '# covers:' with no test below it", file, ["nothing"])
            pending = []


def ids_in(text):
    return re.findall(r"[^\s,]+", text)


def plan_problems(root):
    """The tests that docs/verification-plan.md names in backticks must exist: `Suite.Name`, `Suite.*`, or a ctest name as brick.wave."""
    plan = root / "docs/verification-plan.md"
    if not plan.exists():
        return []
    known, prose = set(), ""
    for file in files(root, ["testbench", "rtl", "cmake"], {".cpp", ".h", ".txt", ".cmake"}):
        text = (root / file).read_text(errors="replace")
        if file.suffix in {".cpp", ".h"}:
            found = re.findall(r"TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)", text)
            known |= {f"{suite}.{name}" for suite, name in found} | {f"{suite}.*" for suite, _ in found}
        else:
            prose += text
    problems = []
    for number, line in enumerate(plan.read_text().splitlines(), 1):
        for name in re.findall(r"`([A-Z]\w+\.(?:\w+|\*))`", line):
            if name not in known:
                problems.append(f"docs/verification-plan.md:{number}: there is no test {name}")
        for area, case in re.findall(r"`(brick|lint|format|docs|trace|regs|tools)\.(\w+)`", line):
            if f"{area}.{case}" not in prose and not (area == "brick" and re.search(rf"\b{case}\b", prose)):
                problems.append(f"docs/verification-plan.md:{number}: there is no test {area}.{case}")
    return problems


def find_tests(root):
    found = []
    for file in files(root, ["app", "firmware", "systemc", "testbench", "cmake"],
                      {".cpp", ".py", ".txt", ".cmake", ".vec"}):
        text, name = (root / file).read_text(errors="replace"), str(file)
        if file.suffix == ".cpp":
            found += tests_in_cpp(text, name)
            found += [Test("bench " + t.name.replace("_", "-"), t.file, t.ids)
                      for t in tests_in_comments(text, name, r"^Bench (\w+)_bench\(", "//")]
        elif file.suffix == ".py":
            found += tests_in_comments(text, name, r"^\s*def\s+(\w+)\(")
        elif file.suffix == ".vec":
            found += [Test("vectors." + file.stem, t.file, t.ids) for t in tests_in_comments(text, name, r"^(title) =")]
        elif file.name == "CMakeLists.txt" or file.suffix == ".cmake":
            found += tests_in_comments(text, name, r"NAME\s+([\w.\-]+)")
    return found


def find_mentions(root, requirements):
    """{ID: [file]} of design sources whose comments name the requirement."""
    found = collections.defaultdict(list)
    for file in files(root, ["rtl", "systemc", "firmware", "app"], {".sv", ".cpp", ".h", ".c", ".S"}):
        for name in sorted(set(re.findall(r"\b[A-Z0-9]+-\d+\b", (root / file).read_text(errors="replace")))):
            if name in requirements:
                found[name].append(str(file))
    return found


def problems_in(root, requirements, claimed, tests):
    problems = []
    for test in tests:
        problems += [f"{test.file}: {test.name} names '{name}', which docs/requirements.txt does not know"
                     for name in test.ids if name not in requirements]
        if not test.ids:
            problems.append(f"{test.file}: {test.name} covers nothing: the list of IDs is empty")
    covered = {name for test in tests for name in test.ids}
    for name in claimed:
        if name not in requirements:
            problems.append(f"docs/claimed.txt: '{name}' is no requirement")
        elif name not in covered:
            problems.append(f"docs/claimed.txt: {name} is claimed, but no test names it")
    return problems


def page(root, requirements, claimed, tests):
    mentions = find_mentions(root, requirements)
    by_id = collections.defaultdict(list)
    for test in tests:
        for name in test.ids:
            by_id[name].append(test)
    lines = ["# Traceability", "",
             "Generated by `tools/traceability.py --write` from the IDs found in the tests; the test `trace.requirements` fails when it is stale.",
             "Engines: R Verilated RTL, S SystemC model, L lock-step, F firmware on the CPU model. *Claimed* means: the project says that it",
             "meets the requirement, and the test suite fails if no test names it. *Partly* means: tests name it, but it is not met in full yet.", "",
             f"{len(claimed)} of {len(requirements)} claimed, {len(by_id)} named by at least one test.", "",
             "| ID | Requirement | On | Status | Tests | Test files | Design files that name it |",
             "|---|---|---|---|---|---|---|"]
    for name, (engines, text) in requirements.items():
        found = sorted(by_id[name])
        status = "claimed" if name in claimed else "partly" if found else "not claimed"
        cells = [name, text, engines, status, "<br>".join(dict.fromkeys(t.name for t in found)),
                 "<br>".join(sorted({f"`{t.file}`" for t in found})),
                 "<br>".join(f"`{f}`" for f in mentions[name])]
        lines.append("| " + " | ".join(cells) + " |")
    open_ids = [name for name in requirements if name not in claimed]
    lines += ["", "## Not claimed yet", "", ", ".join(open_ids) + "." if open_ids else "None.", ""]
    return "\n".join(lines)


def plain_name(name):
    """Prefix/Suite.Name/Value or Suite.Name<Suite/Type...>, as ctest shows parameterised tests -> Suite.Name; others with - as _."""
    found = re.match(r"(?:\w+/)?([A-Z]\w*)\.(\w+)(?:[/<].*)?$", name)
    return f"{found[1]}.{found[2]}" if found else name.replace("-", "_")


def print_results(requirements, tests, junit):
    results = collections.defaultdict(set)
    for case in xml.etree.ElementTree.parse(junit).getroot().iter("testcase"):
        name = plain_name(case.get("name"))
        results[name].add(case.get("status"))
        results[name.split(".")[-1]].add(case.get("status"))
        results[re.sub(r"^(vectors\.\w+?)_(?:board_)?(?:rtl|systemc|both)$", r"\1", name)].add(case.get("status"))
    for name in requirements:
        for test in sorted(t for t in tests if name in t.ids):
            plain = plain_name(test.name.replace("bench ", ""))
            status = results.get(plain) or ((not plain[0].isupper()) and results.get(plain.split(".")[-1])) or set()
            verdict = "failed" if "fail" in status else "passed" if status == {"run"} else "not run"
            print(f"{name:8} {verdict:8} {test.name}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    root = options.root
    requirements, claimed, tests = read_requirements(root), read_claimed(root), find_tests(root)
    if options.results:
        print_results(requirements, tests, options.results)
        return
    problems = problems_in(root, requirements, claimed, tests) + plan_problems(root)
    text = page(root, requirements, claimed, tests)
    if options.write:
        (root / PAGE).write_text(text)
    elif not (root / PAGE).exists() or (root / PAGE).read_text() != text:
        problems.append(f"{PAGE} is stale: run ./dev trace")
    finish(f"traceability, {len(tests)} covering tests, {len(claimed)} of {len(requirements)} claimed", problems)


if __name__ == "__main__":
    sys.exit(main())
