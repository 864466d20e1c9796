#!/usr/bin/env python3
"""What a run of the tests reached: coverage.py BUILD [--tests TEXT] [--write], after a run of a coverage build.

C++ and C: lines run at least once, a row a folder, from gcov (BUILD/**/*.gcda). RTL: lines run at least once and bits
that rose and fell, a row a module, from the counters of the Verilated models (BUILD/rtl/*.dat, files of each life of
a model; a point counts as often as in the life that reached it most); beside them the lines of its SystemC model.
BUILD/missed.txt lists what was not reached. What tools/coverage.toml leaves out does not count
(coverage_exclusions.py); what of it was reached fails. The page goes to the standard output, with --write to
docs/coverage.md as well; TEXT says there which tests ran.

Every module, model and folder of the tree has a row, whether a test reached it or not. The row of a module holds a
hash of the source that was measured, without comments and blanks:
coverage.py --check   names rows that the page lacks or has too many, modules that were not measured, and those whose
                      source is another now; --release: they fail. An exclusion of what is not there always fails
coverage.py --rows    gives the page the rows that it lacks, as "not in this run", takes away those that are gone and
                      marks those whose source is another now
"""

import argparse
import collections
import concurrent.futures
import functools
import json
import os
import pathlib
import re
import subprocess
import sys
import textwrap
import xml.etree.ElementTree

import coverage_exclusions
from common import ROOT, as_of, files, finish, hash_of, without_comments

PAGE, PLAN = "docs/coverage.md", "docs/verification-plan.md"
OURS = re.compile(r"(app|systemc|firmware|testbench/(?:benches|checkers|host|plant))/")
MODELS = ("systemc/board", "systemc/host", "systemc/macro_ic", "systemc/servo_ic")
NOT_RUN, NO_COUNTER = "not in this run", "no test reached, or nothing to count"
STALE = ", stale"
HEADS = {"modules": "| module or model | lines of the RTL | bits | lines of the model | source of the RTL |\n"
                    "|---|---|---|---|---|\n",
         "folders": "| folder | lines |\n|---|---|\n"}
Reached = collections.namedtuple("Reached", "reached all")


def modules(root):
    """{folder/name: (file of the RTL or None, files of the model)} of every module and every model of the tree."""
    rtl = {path.stem: path for path in files(root, ["rtl"], {".sv"})
           if re.search(rf"^module {path.stem}\b", (root / path).read_text(), re.M)}
    models = collections.defaultdict(list)
    for path in files(root, ["systemc"], {".h", ".cpp"}):
        if path.parts[1] != "component" and (path.stem in rtl or str(path.parent) in MODELS):
            models[path.stem].append(str(path))
    found = {}
    for name in {*rtl, *models}:
        folder = rtl[name].parent.name if name in rtl else pathlib.Path(models[name][0]).parent.name
        found[f"{folder}/{name}"] = str(rtl[name]) if name in rtl else None, models[name]
    return dict(sorted(found.items()))


def folders(root):
    """Every folder with C or C++ of ours."""
    sources = files(root, ["app", "firmware", "systemc", "testbench"], {".c", ".h", ".cpp"})
    return sorted({str(path.parent) for path in sources if OURS.match(str(path))})


@functools.cache
def text_lines(path):
    return path.read_text().splitlines()


def is_cleanup(path, line):
    """A closing brace or the head of a class to which nothing but an exception leads: what the compiler puts there
    takes the objects of the scope away, and no statement of ours."""
    if line["count"] != 0 or line["unexecuted_block"]:
        return False
    texts = text_lines(path)
    text = texts[line["line_number"] - 1].strip() if line["line_number"] <= len(texts) else ""
    return text == "}" or text.startswith("class ")


def gcov_lines(build):
    """{(file, line): times run} of our C and C++."""
    def read(data):  # names are relative to the folder of the compiler, where ccache made them so
        done = subprocess.run(["gcov", "--json-format", "--stdout", data],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        for part in (json.loads(text) for text in done.stdout.splitlines() if text):
            for file in part["files"]:
                path = os.path.normpath(os.path.join(part["current_working_directory"], file["file"]))
                name = os.path.relpath(path, ROOT)
                if OURS.match(name):
                    yield name, [line for line in file["lines"] if not is_cleanup(ROOT / name, line)]

    lines = collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for found in pool.map(lambda data: list(read(data)), sorted(build.rglob("*.gcda"))):
            for name, counted in found:
                for line in counted:
                    lines[name, line["line_number"]] += line["count"]
    return lines


def rtl_points(data_files):
    """{(kind, file, line, what): times} of our RTL; kind is line, branch or toggle, times the most of any instance in
    any life: the sum over lives would take a bit that rose in each and never fell for one that did both. Before the
    reset (files *_start.dat) bits have changed from random start values: lines alone count. Names of files may be
    relative to a folder of the build, as gcov's."""
    most = {}
    for data in data_files:
        for text in data.read_text().splitlines():
            if text.startswith("C '") and not (data.stem.endswith("_start") and "\x01page\x02v_toggle" in text):
                key, times = text.rsplit(" ", 1)
                most[key] = max(most.get(key, 0), int(times))
    points = {}
    for text, times in most.items():
        key = dict(part.split("\x02", 1) for part in text[3:-1].split("\x01") if part)
        file = os.path.relpath(key["f"], ROOT) if os.path.isabs(key["f"]) else re.sub(r"^(\.\./)+", "", key["f"])
        if file.startswith("rtl/"):
            kind = key["page"].split("/")[0].removeprefix("v_")
            point = kind, file, int(key["l"]), f"{key.get('n', '')} {key.get('o', '')}"
            points[point] = max(points.get(point, 0), times)
    return points


def enough(kind):
    """How often a point was reached that counts: a bit that changed twice rose and fell."""
    return 2 if kind == "toggle" else 1


def reached(times, least=1):
    """Reached of a list of times."""
    return Reached(sum(time >= least for time in times), len(times))


def total(cells):
    cells = [cell for cell in cells if cell]
    return Reached(sum(cell.reached for cell in cells), sum(cell.all for cell in cells))


def module_rows(root, lines, points):
    """{folder/name: (lines of the RTL, bits, lines of the model)}, None where there is no such file."""
    of_file, lines_of, bits_of = (collections.defaultdict(list) for _ in range(3))
    for (file, _), times in lines.items():
        of_file[file].append(times)
    for (kind, file, _, _), times in points.items():
        (bits_of if kind == "toggle" else lines_of)[file].append(times)
    return {label: (reached(lines_of[rtl]) if rtl else None, reached(bits_of[rtl], enough("toggle")) if rtl else None,
                    reached([times for file in model for times in of_file[file]]) if model else None)
            for label, (rtl, model) in modules(root).items()}


def folder_rows(root, lines):
    found = {folder: [] for folder in folders(root)}
    for (file, _), times in lines.items():
        found.setdefault(str(pathlib.Path(file).parent), []).append(times)
    return {folder: (reached(times),) for folder, times in sorted(found.items())}


def source_hash(text):
    """Of what of a module counts: its text without comments and blanks."""
    return hash_of(" ".join(without_comments(text).split()))


def with_sources(root, rows):
    """The rows of modules as texts, each with the hash of its source."""
    rtl = {label: file for label, (file, _) in modules(root).items() if file}
    return {label: [*cells, f"`{source_hash((root / rtl[label]).read_text())}`" if label in rtl else ""]
            for label, cells in rows.items()}


def shown(cell, kind):
    if cell is None:
        return ""
    if cell.all:
        return f"{cell.reached} of {cell.all} ({100 * cell.reached / cell.all:.1f} %)"
    return "" if kind == "bits" else NO_COUNTER


def texts(rows):
    """The rows with their cells as the page shows them, and their sum."""
    sums = tuple(total(column) for column in zip(*rows.values(), strict=True))
    kinds = ("lines", "bits", "lines")
    return {label: [shown(*cell) for cell in zip(cells, kinds, strict=False)]
            for label, cells in [*rows.items(), ("all", sums)]}


def table(name, rows):
    """The rows of texts as a table, the last one is the sum."""
    lines = [f"| {label if label == 'all' else f'`{label}`'} | {' | '.join(cells)} |" for label, cells in rows.items()]
    return HEADS[name] + "\n".join(lines) + "\n"


def left_out(exclusions):
    """The section of the page on {exclusion: how many}."""
    if not exclusions:
        return ""
    def cell(text):
        return " ".join(text.split()).replace("|", "\\|")

    rows = "".join(f"| `{e.file}` | {count} {e.what}: `{cell(e.pattern.pattern)}` | {cell(e.reason)} |\n"
                   for e, count in sorted(exclusions.items(), key=lambda left: str(left[0])))
    return f"""
## Left out

What no test can reach, not counted above (`{coverage_exclusions.FILE}`); a test that reaches it all the same makes
`./dev coverage` fail.

| file | what | why |
|---|---|---|
{rows}"""


def page(tests, of_modules, of_folders, exclusions=None):
    ran = textwrap.fill(f"What the tests reached, by `./dev coverage`, {as_of(ROOT)}: {tests}.", 120)
    return f"""<!-- Generated by tools/coverage.py (./dev coverage). Do not edit. -->
# Coverage

{ran}

`docs.coverage` names each module, model and folder that has no row; the plan `release` fails on one. The figures are
those of that commit. They say what no test runs. They do not say that what is run is checked: for that are the negative
controls and planted misreadings ([verification plan]({PLAN.removeprefix('docs/')})).

## RTL and models

Lines and branches of the RTL that ran at least once in any instance, of chips, of modules alone or, but for files of
these chips, of the board of two ICs; bits that rose and fell in one instance; lines of the SystemC model. A module of
wires alone has nothing to count. The last column is a hash of the source of the RTL that was measured, without comments
and blanks; `docs.coverage` names the rows whose source is another now, and the plan `release` fails with them. That a
model has changed it does not see.

{table("modules", of_modules)}
## C++ and C

Lines that ran at least once, of the files that these programs are made of: what only others use is not counted. The
firmware as compiled for the build machine.

{table("folders", of_folders)}{left_out(exclusions)}"""


def rows_of(text, name):
    """{label: cells} of a table of the page."""
    body = text.partition(HEADS[name])[2].partition("\n\n")[0]
    found = [[cell.strip() for cell in line.strip("|").split(" |")] for line in body.splitlines()]
    return {cells[0].strip(" `"): cells[1:] for cells in found}


def expected(root):
    return {"modules": modules(root), "folders": folders(root)}


def is_stale(root, file, cells):
    """Whether a module's row is of another source than that of the tree."""
    return f"`{source_hash((root / file).read_text())}`" != cells[-1].removesuffix(STALE)


def misshapen(text):
    """What is wrong with the tables, whatever the tree holds."""
    for name, head in HEADS.items():
        rows, columns = rows_of(text, name), head.partition("\n")[0].count("|") - 2
        if "all" not in rows:
            yield f"{PAGE}: no table of {name} with a row 'all'"
        for label, cells in rows.items():
            if len(cells) != columns:
                yield f"{PAGE}: {label}: {len(cells) + 1} cells; expected {columns + 1}"


def out_of_date(root, text):
    """What the page lacks, and has of what is no more."""
    for name, labels in expected(root).items():
        have = rows_of(text, name)
        yield from (f"{PAGE}: no row of {label}: ./dev coverage, or tools/coverage.py --rows, gives it one"
                    for label in labels if label not in have)
        yield from (f"{PAGE}: a row of {label}, which is not in the tree"
                    for label in sorted(have.keys() - {*labels, "all"}))
    have = rows_of(text, "modules")
    for label, (file, _) in modules(root).items():
        if file and label in have:
            if NOT_RUN in have[label][:2]:
                yield f"{PAGE}: {label} was not measured"
            elif is_stale(root, file, have[label]):
                yield f"{PAGE}: {label} is stale: {file} is not what was measured"


def check(root, release):
    text = (root / PAGE).read_text()
    problems = list(misshapen(text))
    notes = [] if problems else list(out_of_date(root, text))
    if notes and not release:
        print(*notes, f"{len(notes)} row(s) stale or absent, which only --release fails with", sep="\n")
    problems += coverage_exclusions.read(root)[1]
    finish(f"coverage, {len(modules(root))} modules and models", problems + (notes if release else []))


def align(root):
    """--rows: the page with the rows of the tree."""
    text = (root / PAGE).read_text()
    for name, labels in expected(root).items():
        have = rows_of(text, name)
        before = table(name, have)
        rows = {label: have.get(label) or [NOT_RUN] + [""] * (len(have["all"]) - 1) for label in [*labels, "all"]}
        for label, (file, _) in modules(root).items() if name == "modules" else ():
            cells = rows[label]
            if file and cells[-1]:
                cells[-1] = cells[-1].removesuffix(STALE) + STALE * is_stale(root, file, cells)
        text = text.replace(before, table(name, rows))
    (root / PAGE).write_text(text)


def passed(results):
    """How many tests passed, in words, from the results of ctest; nothing where there are none."""
    if not results.exists():
        return ""
    suite = xml.etree.ElementTree.parse(results).getroot()
    return f"{int(suite.get('tests')) - int(suite.get('failures'))} of {suite.get('tests')} tests passed"


def missed(lines, points):
    never = [f"{file}:{number}" for (file, number), times in sorted(lines.items()) if times == 0]
    never += [f"{file}:{line}: {kind} {what.strip()}" for (kind, file, line, what), times in sorted(points.items())
              if times < enough(kind)]
    return "\n".join(never) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, nargs="?")
    parser.add_argument("--tests", default="")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--release", action="store_true")
    parser.add_argument("--rows", action="store_true")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    if options.check:
        return check(options.root, options.release)
    if options.rows:
        return align(options.root)
    if options.build is None:
        parser.error("expected the folder of a coverage build, --check or --rows")
    data = sorted((options.build / "rtl").glob("*.dat"))
    if not data:
        sys.exit(f"coverage.py: {options.build}/rtl holds no .dat; expected the counters of a run (./dev coverage)")
    exclusions, mistakes = coverage_exclusions.read(ROOT)
    lines, points, left, more = coverage_exclusions.leave_out(ROOT, exclusions, gcov_lines(options.build),
                                                              rtl_points(data), enough)
    tests = ", ".join(filter(None, [passed(options.build / "tests.xml"), options.tests]))
    of_modules = with_sources(ROOT, texts(module_rows(ROOT, lines, points)))
    text = page(tests, of_modules, texts(folder_rows(ROOT, lines)), left)
    (options.build / "missed.txt").write_text(missed(lines, points))
    print(text)
    if options.write:
        (ROOT / PAGE).write_text(text)
    finish("coverage", mistakes + more)
    return None


if __name__ == "__main__":
    main()
