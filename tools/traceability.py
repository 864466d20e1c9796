#!/usr/bin/env python3
"""Traces requirements to their design files, tests and last results: docs/traceability.md.

A test names its requirements in one of these ways:
  GoogleTest   BRICK_COVERS("BREQ-1 BREQ-3");           first line of a TEST, TEST_F, TEST_P or TYPED_TEST
  bench        // covers: BREQ-1                         on the line above Bench breq_rotary_bench() {
  ctest        # covers: BREQ-1                          on the line above add_test(NAME ...)
  Python       # covers: BREQ-1                          on the line above def NAME(
  vector       # covers: BREQ-1                          on the line above title = in testbench/vectors/NAME.vec
docs/design-files.txt says of which files a requirement is made; docs/test-results.json holds what the last whole run
of the test suite showed of each of these tests, on each engine.

  (no option)  fails on an unknown ID, on a claimed ID (docs/claimed.txt) without a test, on a traced ID without design
               files for each of its engines, on a test that docs/verification-plan.md names and that does not exist,
               on a row of it without covers and reason, and when docs/traceability.md is not what --write would write.
               In each run of the suite
  --check      the same, and fails on the committed results as --results does. No run asks for that: its own results
               come behind it
  --write      writes docs/traceability.md
  --results F...
               takes the results of a run from `ctest --output-junit F`, and of what runs besides by night from
               `unit_system --gtest_output=xml:F`, into docs/test-results.json and writes the page; fails when a test
               that names an ID has no result, and when a claimed ID is not passed on one of its engines: one of the
               tests that name it has failed there or has no result, or none runs there
"""

import argparse
import collections
import datetime
import json
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree

import verification_plan
from common import ROOT, files, finish

PAGE = "docs/traceability.md"
RESULTS = "docs/test-results.json"
Test = collections.namedtuple("Test", "name file ids engines")

# The engine that the name of a run ends in. Else: what tests of these files run on, the first that matches; "" is none,
# such as a checker on lists made by hand.
RUN_ON = {"rtl": "R", "systemc": "S", "model": "S", "lockstep": "L", "both": "L"}
FILES_RUN_ON = (
    (r"unit/(firmware_\w+|cpu)/", "F"),
    (r"unit/app/|benches/", "S F"),
    (r"unit/host/", "R S L"),
    (r"lockstep_test|unit/cosim/motor_pins|unit/cosim/board", "L"),
    (r"unit/cosim/(quiet|run_length)|unit/machine/run_ahead", "R S L"),
    (r"unit/machine/(machine|port_a)", "S F"),
    (r"unit/board/(clock_follower|lazy_ics|motor_pins)", "S"),
)
NO_ENGINE = "passed"  # what the page shows of such a test
# The image runs there, on each engine.
WITH_FIRMWARE = re.compile(r"unit/system/(?!watchdog_scoreboard)|unit/app/|benches/")


def read_requirements(root):
    """{ID: (engines, text)} in the order of the file."""
    found = {}
    for line in (root / "docs/requirements.txt").read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            name, engines, text = (part.strip() for part in line.split("|", 2))
            found[name] = (engines, text)
    return found


def lines_of(path):
    lines = (line.split("#")[0].strip() for line in path.read_text().splitlines()) if path.exists() else []
    return [line for line in lines if line]


def read_design_files(root, problems):
    """{ID: [file]}, from docs/design-files.txt."""
    blocks, found = {}, {}
    for line in lines_of(root / "docs/design-files.txt"):
        name, _, patterns = line.partition(" = ")
        if patterns:
            blocks[name] = []
            for pattern in patterns.split():
                matches = sorted(str(path.relative_to(root)) for path in root.glob(pattern))
                blocks[name] += matches
                if not matches:
                    problems.append(f"docs/design-files.txt: {name}: no file {pattern}")
            continue
        ids, _, parts = line.partition(":")
        for part in parts.split():
            if part not in blocks:
                problems.append(f"docs/design-files.txt: no block {part}")
        for identifier in ids.split():
            found[identifier] = sorted({file for part in parts.split() for file in blocks.get(part, [])})
    return found


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def engines_of_file(file):
    return next((engines.split() for pattern, engines in FILES_RUN_ON if re.search(pattern, file)), [])


def tests_in_cpp(text, file):
    text = re.sub(r"^\s*//.*$", "", text, flags=re.M)  # a BRICK_COVERS that is commented out covers nothing
    heads = [(m.start(), f"{m[1]}.{m[2]}")
             for m in re.finditer(r"^(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)", text, re.M)]
    for m in re.finditer(r'BRICK_COVERS\(\s*((?:"[^"]*"\s*)+)\)', text):
        before = [name for start, name in heads if start < m.start()]
        ids = ids_in(" ".join(re.findall(r'"([^"]*)"', m[1])))
        yield Test(before[-1] if before else f"{file}:{line_of(text, m.start())}", file, ids, engines_of_file(file))


def tests_in_comments(text, file, head, comment="#"):
    """`# covers:` above the line that `head` matches, with nothing but comments and blank lines between."""
    pending = []
    for line in text.splitlines():
        covers = re.match(rf"\s*{comment}\s*covers:(.*)", line)
        name = re.search(head, line)
        if covers:
            pending += ids_in(covers[1])
        elif name and pending:
            yield Test(name[1], file, pending, engines_of_file(file))
            pending = []
        elif line.strip() and not line.strip().startswith(comment) and pending:
            yield Test(f"{file}: '# covers:' with no test below it", file, ["nothing"], [])
            pending = []


def python_engines(text, name):
    """The engines that a case of acceptance.py or bench_acceptance.py names; the command's own choice is SystemC."""
    body = re.search(rf"^def {name}\(.*?(?=^\S|\Z)", text, re.M | re.S)
    words = re.findall(r'"(systemc|rtl|lockstep)"', body[0] if body else "")
    return [*sorted({RUN_ON[word] for word in words} or {"S"}), "F"]


def ids_in(text):
    return re.findall(r"[^\s,]+", text)


def plan_problems(root):
    """The tests that docs/verification-plan.md names in backticks exist: `Suite.Name`, `Suite.*` or `brick.wave`."""
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
            listed = {"brick": rf"\b{case}\b", "tools": rf"foreach\(what [^)]*\b{case}\b"}.get(area)
            if f"{area}.{case}" not in prose and not (listed and re.search(listed, prose)):
                problems.append(f"docs/verification-plan.md:{number}: there is no test {area}.{case}")
    return problems


def find_tests(root):
    found = []
    folders = ["app", "firmware", "systemc", "testbench", "cmake"]
    for file in files(root, folders, {".cpp", ".py", ".txt", ".cmake", ".vec"}):
        text, name = (root / file).read_text(errors="replace"), str(file)
        if file.suffix == ".cpp":
            found += tests_in_cpp(text, name)
            found += [t._replace(name="bench " + t.name.replace("_", "-"))
                      for t in tests_in_comments(text, name, r"^Bench (\w+)_bench\(", "//")]
        elif file.suffix == ".py":
            found += [t._replace(engines=python_engines(text, t.name))
                      for t in tests_in_comments(text, name, r"^\s*def\s+(\w+)\(")]
        elif file.suffix == ".vec":
            found += [t._replace(name="vectors." + file.stem) for t in tests_in_comments(text, name, r"^(title) =")]
        elif file.name == "CMakeLists.txt" or file.suffix == ".cmake":
            found += tests_in_comments(text, name, r"NAME\s+([\w.\-]+)")
    return found


def problems_in(requirements, claimed, tests, design):
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
    problems += [f"docs/design-files.txt: '{name}' is no requirement" for name in design if name not in requirements]
    folder_of = {"R": "rtl", "S": "systemc", "L": "systemc", "F": ("firmware", "systemc/cpu")}
    for name in requirements:
        for engine in requirements[name][0].split() if name in covered else []:
            if not any(file.startswith(folder_of[engine]) for file in design.get(name, [])):
                problems.append(f"docs/design-files.txt: {name} applies to engine {engine}, but has no file of it")
    return problems


def read_results(root):
    path = root / RESULTS
    return json.loads(path.read_text()) if path.exists() else {"run": "none yet", "tests": {}}


def result_on(engine, test, results):
    """What a test showed on an engine, None where it does not run. A test without any result counts on every engine
    that it may run on; one without an engine is no proof of any, but its failure is one against all."""
    shown = results.get(test.name)
    if shown is None:
        return "no result" if not test.engines or engine in test.engines else None
    return "failed" if shown.get(NO_ENGINE) == "failed" else shown.get(engine)


def row_results(engines, tests, results):
    """What the tests of a row showed on each of its engines: passed where each that runs there has."""
    for engine in engines.split():
        shown = {result_on(engine, test, results) for test in tests}
        worst = next((each for each in ("failed", "no result", "passed") if each in shown), "no result")
        yield engine, worst


def test_cell(test, results):
    shown = results.get(test.name, {})
    failed = [engine for engine in shown if shown[engine] == "failed"]
    on = f"failed: {' '.join(failed)}" if failed else " ".join(shown) if shown else "no result"
    return f"{test.name} ({on})"


def page(requirements, claimed, tests, design, results):
    by_id = collections.defaultdict(list)
    for test in tests:
        for name in test.ids:
            by_id[name].append(test)
    lines = [
        "<!-- Generated by tools/traceability.py (./dev trace); the test trace.requirements fails when stale. -->",
        "# Traceability", "",
        "From requirement to design files, tests and last result. Engines: R Verilated RTL, S SystemC model,",
        "L lock-step, F firmware on the CPU model.",
        "*Claimed* means: the project says that it meets the requirement on all its engines, and the test suite fails",
        "if no test names it. *Partly* means: tests name it, but it is not met in full yet.",
        "Behind a test stand the engines that it passed on; a checker that works on lists made by hand has none. A",
        "requirement has passed on an engine when every test that names it and runs there has.",
        "`docs/design-files.txt` says which files a requirement is made of.", "",
        f"Results: {results['run']}.",
        f"{len(claimed)} of {len(requirements)} claimed, {len(by_id)} named by at least one test.", "",
        "| ID | Requirement | On | Status | Last result | Design files | Tests | Test files |",
        "|---|---|---|---|---|---|---|---|"]
    for name, (engines, text) in requirements.items():
        found = sorted(by_id[name])
        status = "claimed" if name in claimed else "partly" if found else "not claimed"
        last = [" ".join(shown) for shown in row_results(engines, found, results["tests"])] if found else []
        cells = [name, text, engines, status, "<br>".join(last), "<br>".join(f"`{f}`" for f in design.get(name, [])),
                 "<br>".join(dict.fromkeys(test_cell(t, results["tests"]) for t in found)),
                 "<br>".join(sorted({f"`{t.file}`" for t in found}))]
        lines.append("| " + " | ".join(cells) + " |")
    open_ids = [name for name in requirements if name not in claimed]
    lines += ["", "## Not claimed yet", "", ", ".join(open_ids) + "." if open_ids else "None.", ""]
    return "\n".join(lines)


def plain_name(name):
    """(name in the sources, engine or None) of a run: Prefix/Suite.Name/Rtl, Suite.Name<Suite/Model.>, brick.a_rtl."""
    name = name.split("  #")[0]
    found = re.match(r"(?:\w+/)?([A-Z]\w*)\.(\w+)(?:[/<](.*))?$", name)
    if found:
        value = re.search(r"(\w+)\W*$", found[3] or "")
        return f"{found[1]}.{found[2]}", RUN_ON.get(value[1].lower()) if value else None
    name = name.replace("-", "_")
    found = re.match(r"(.*?)(?:_board)?_(rtl|systemc|both|lockstep)$", name)
    return (found[1], RUN_ON[found[2]]) if found else (name, None)


def cmake_names(root):
    """({folder: what names of its Python cases may begin with}, {suite: entry that runs all of it}), from add_test."""
    prefixes, suites = {}, {}
    for file in files(root, ["testbench"], {".txt"}):
        text = (root / file).read_text()
        prefixes[str(file.parent)] = re.findall(r"add_test\(NAME (\w+)\.\$\{\w+\}", text)
        whole = re.finditer(r"add_test\(NAME (\S+) COMMAND \S+ --gtest_filter=(\w+)\.\*", text)
        suites.update({m[2]: m[1] for m in whole})
    return prefixes, suites


def cases_of(reports):
    """(name as ctest has it, status) of each case in reports of ctest and of GoogleTest; there "run" says nothing."""
    for report in reports:
        for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase"):
            name, status = case.get("name"), case.get("status")
            if "result" in case.attrib:
                name = f"{case.get('classname')}.{name}"
                if case.get("result") != "completed" or case.find("failure") is not None:
                    status = "fail"
            yield name, status


def results_of(root, tests, reports):
    """{test: {engine: passed or failed}}, an engine counts as passed when every run of the test on it passed."""
    runs, entries = collections.defaultdict(list), {}
    for entry, status in cases_of(reports):
        name, engine = plain_name(entry)
        runs[name].append((engine, status))
        entries[entry] = (engine, status)
    prefixes, suites = cmake_names(root)
    acceptance = root / "testbench/unit/app/bench_acceptance.py"
    cases = acceptance.read_text() if acceptance.exists() else ""
    found = {}
    for test in tests:
        bench = test.name.startswith("bench ")
        name = test.name.removeprefix("bench ").replace("-", "_")
        if bench or test.file.endswith(".py"):
            starts = [] if bench else prefixes.get(str(pathlib.Path(test.file).parent), [])
            names = [f"{start}.{name}" for start in starts or ["brick"]]
            name = next((each for each in names if each in runs), names[0])
        runs_of = [entries[name]] if name in entries and name not in runs else runs[name]
        if not runs_of and name.split(".")[0] in suites:
            runs_of = [run for entry, run in entries.items() if entry == suites[name.split(".")[0]]]
        default = python_engines(cases, name.removeprefix("brick.")) if bench else test.engines
        shown = collections.defaultdict(set)
        for engine, status in runs_of:
            engines = {engine} if engine else set(default)
            if WITH_FIRMWARE.search(test.file):
                engines.add("F")
            for each in engines or {NO_ENGINE}:
                shown[each].add(status)
        if shown:
            found[test.name] = {engine: "passed" if shown[engine] == {"run"} else "failed"
                                for engine in ("R", "S", "L", "F", NO_ENGINE) if engine in shown}
    return dict(sorted(found.items()))


def result_problems(requirements, claimed, tests, results):
    """A test without a result, and a claim that is not passed on one of its engines."""
    problems = [f"{test.file}: {test.name} names {' '.join(test.ids)}: no result" for test in tests
                if test.name not in results]
    for name in claimed:
        found = [test for test in tests if name in test.ids]
        problems += [f"{name} is claimed on {engine}: {result}"
                     for engine, result in row_results(requirements[name][0], found, results) if result != "passed"]
    return problems


def named_run(root):
    done = subprocess.run(["git", "rev-parse", "--short=10", "HEAD"], cwd=root, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL)
    return f"the test suite at commit {done.stdout.strip() or 'unknown'}, {datetime.date.today().isoformat()}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--results", type=pathlib.Path, nargs="+")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    root, problems = options.root, []
    requirements, claimed, tests = read_requirements(root), lines_of(root / "docs/claimed.txt"), find_tests(root)
    design = read_design_files(root, problems)
    if options.results:
        taken = {"run": named_run(root), "tests": results_of(root, tests, options.results)}
        (root / RESULTS).write_text(json.dumps(taken, indent=1) + "\n")
        problems += result_problems(requirements, claimed, tests, taken["tests"])
    else:
        problems += problems_in(requirements, claimed, tests, design) + plan_problems(root)
        problems += verification_plan.problems_of(root)
    if options.check and not problems:  # a claim of no requirement has no engines
        problems += result_problems(requirements, claimed, tests, read_results(root)["tests"])
    text = page(requirements, claimed, tests, design, read_results(root))
    if options.write or options.results:
        (root / PAGE).write_text(text)
    elif not (root / PAGE).exists() or (root / PAGE).read_text() != text:
        problems.append(f"{PAGE} is stale: run ./dev trace")
    finish(f"traceability, {len(tests)} covering tests, {len(claimed)} of {len(requirements)} claimed", problems)


if __name__ == "__main__":
    sys.exit(main())
