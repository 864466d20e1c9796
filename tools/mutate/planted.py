"""./dev mutate planted: the bugs of tools/mutate/planted, those of one test program built together and chosen by
number. Number 0, the tree as it is, passes all their tests; then each is found by its own."""

import pathlib
import random
import shutil
import time

import again
import bugs
import enclosing
import native
import overlay
import records
import runner
import schemata
import workplace
from common import ROOT, hash_of
from mutant import Mutant
from runner import ALIVE, KILLED

BOARDS = {"unit_board", "unit_cosim"}  # programs on whole boards of RTL
COMPARE = {"rtl": "off", "systemc": "model"}  # by the folder that the bug stands in: what judges it, as for mutants
FLAGS = ["-w", "-O1", "-D_GLIBCXX_ASSERTIONS"]
LIMIT = 300  # s, of number 0; a bug's test may take twenty times what all of them take of it, and QUICK more
QUICK = 10


def compare_of(bug):
    return COMPARE.get(bug.file.split("/")[0], "on")


class Group:
    """The bugs that one program finds."""

    def __init__(self, name, found, tree, use):
        self.name, self.bugs, self.tree = name, found, tree
        self.out = workplace.folder_of(tree, use, name)
        self.program = overlay.Program(tree, name)
        self.build_seconds = 0.0

    def inputs(self):
        """A hash of all that decides but the bugs themselves."""
        tools = sorted(file for kind in ("*.py", "*.h", "*.cpp") for file in pathlib.Path(__file__).parent.glob(kind))
        files = sorted({bug.file for bug in bugs.read() if bug.tests.program == self.name})  # whichever are asked for
        return hash_of(self.tree / "bin" / self.name, *tools, *(ROOT / file for file in files))

    def files(self):
        return sorted({bug.file for bug in self.bugs})

    def spans(self, file):
        if file.endswith(".sv"):
            source = (ROOT / file).read_bytes()
            return source, enclosing.of_verilog(source)
        readers = self.program.readers({str(ROOT / file)})
        if not readers:
            raise runner.BadBuild(f"{self.name} is not made of {file}")
        return enclosing.of_c(ROOT / file, native.parser_options(self.program.compiles[readers[0]]))

    def write(self):
        """The files with all their bugs in them. {original: what is compiled instead}"""
        self.alone = workplace.claimed(self.out)
        replaced = {}
        for old in (self.out / "source").rglob("*.*"):
            old.unlink()
        for file in self.files():
            source, spans = self.spans(file)
            mutants = []
            for bug in (bug for bug in self.bugs if bug.file == file):
                start = source.index(bug.old.encode())
                try:
                    place = enclosing.place(source, spans, start, bug.old.encode(), bug.new.encode())
                except ValueError as bad:
                    raise runner.BadBuild(f"{bug}: {bad}") from bad
                mutants.append(Mutant(bug.number, file, 0, "", place))
            language = schemata.Verilog() if file.endswith(".sv") else schemata.C(ROOT / file)
            made = self.out / "source" / file
            made.parent.mkdir(parents=True, exist_ok=True)
            made.write_bytes(schemata.write(source, mutants, language))
            replaced[ROOT / file] = made
        return replaced

    def build(self):
        begin, tests = time.monotonic(), self.out / "tests"
        replaced = self.write()
        shutil.rmtree(tests, ignore_errors=True)  # what another choice of bugs was translated to
        tests.mkdir(parents=True)
        one = overlay.Overlay(self.tree, tests, replaced, FLAGS, self.out / "source", ROOT)
        recorder = native.recorder(self.program, max(bug.number for bug in self.bugs), self.out)
        self.binary = one.build(self.program, self.name in BOARDS, [recorder])
        self.build_seconds, self.zero_seconds = time.monotonic() - begin, 0.0
        for compare in {compare_of(bug) for bug in self.bugs}:
            chosen = ":".join(sorted({bug.tests.filter for bug in self.bugs if compare_of(bug) == compare}))
            verdict = runner.run(self.binary, runner.Tests(self.name, chosen), 0, LIMIT, compare, ROOT)
            if verdict.status != ALIVE:
                raise runner.BadBuild(f"number 0, the tree as it is, does not pass: {verdict.by}")
            self.zero_seconds += verdict.seconds

    def judge(self, bug):
        """(whether its test finds it, what came of it)"""
        limit = min(LIMIT, QUICK + 20 * self.zero_seconds)
        verdict = runner.run(self.binary, bug.tests, bug.number, limit, compare_of(bug), ROOT)
        return verdict.status == KILLED, verdict.by or "its test passes"


def chosen(options):
    """The bugs that are asked for: all, those with the numbers, or --count of one program's, both drawn by --seed."""
    found = bugs.read()
    unknown = [name for name in options.names if not (name.isdigit() and 1 <= int(name) <= len(found))]
    if unknown:
        raise bugs.Bad(f"no bug {', '.join(unknown)}; they are numbered 1 to {len(found)}")
    if options.names:
        found = [bug for bug in found if str(bug.number) in options.names]
    if options.count:
        picks = random.Random(options.seed if options.seed is not None else again.commit())
        program = picks.choice(sorted({bug.tests.program for bug in found}))
        found = [bug for bug in found if bug.tests.program == program]
        found = picks.sample(found, min(options.count, len(found)))
    return sorted(found, key=lambda bug: bug.number)


def known_of(path, inputs):
    """{key: row} of the results. A row of other inputs names them."""
    head, rows = records.read(path) if path.exists() else ({}, [])
    known = {}
    for row in rows:
        of = row.pop("inputs", head["inputs"])
        known[row["key"]] = row if of == inputs else {**row, "inputs": of}
    return known


def judged(group, options):
    """The rows of its bugs. Those that are not judged anew stay as they are: a miss is not forgotten."""
    path = bugs.RESULTS / f"{group.name}.jsonl"
    inputs = group.inputs()
    keys = {bug.key for bug in bugs.read()}
    rows = {key: row for key, row in known_of(path, inputs).items() if key in keys}
    done = {key for key, row in rows.items() if options.resume and "inputs" not in row}
    todo = [bug for bug in group.bugs if bug.key not in done]
    if todo:
        group.bugs = todo
        group.build()
    for bug in todo:
        found, by = group.judge(bug)
        rows[bug.key] = {"number": bug.number, "rule": bug.rule, "file": bug.file, "found": found, "by": by,
                         "key": bug.key}
        if not options.count:  # a draw leaves the results of all as they are
            records.write(path, {"program": group.name, "inputs": inputs}, list(rows.values()))  # for --resume
    return rows, len(todo), group.build_seconds


def main(options):
    every = chosen(options)
    lost = [f"{bug}: {why}" for bug in every if (why := bugs.misplaced(bug, ROOT))]
    every = [bug for bug in every if not bugs.misplaced(bug, ROOT)]
    groups = {}
    for bug in every:
        groups.setdefault(bug.tests.program, []).append(bug)
    alive, use = [], "planted_drawn" if options.count else "planted"
    for name, found in sorted(groups.items()):
        begin = time.monotonic()
        try:
            rows, ran, building = judged(Group(name, list(found), options.build, use), options)
        except (runner.BadBuild, overlay.NoBuild, ValueError) as bad:
            lost += [f"{name}: {len(found)} bugs are not judged: {bad}"]
            alive += found
            continue
        missed = [bug for bug in found if not rows[bug.key]["found"]]
        alive += missed
        lost += [f"{bug}: {bug.tests.filter} does not find it: {rows[bug.key]['by']}" for bug in missed]
        print(f"{name}: {len(found) - len(missed)} of {len(found)} found; {ran} ran, "
              f"{time.monotonic() - begin:.0f} s, {building:.0f} s of them building", flush=True)
    for line in lost:
        print(line)
    print(f"planted: {len(every) - len(alive)} of {len(every)} found")
    return int(bool(lost) or not every)
