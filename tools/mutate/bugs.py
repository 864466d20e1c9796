"""Bugs planted in rules: the files of tools/mutate/planted, and the counts that docs/rules.md has of them.

A file has a table `[["CELL"]]` for each bug; CELL is the first cell of its row in docs/rules.md:

  file   the source that it is planted in, from the root of the tree
  old    a piece of it that stands there exactly once
  new    what stands there instead
  test   'PROGRAM FILTER': the test that finds it, one that the row names

A row says 'planted 3': it has three. 'planted 3 of 7': seven were planted by hand once, four of them were not kept.
results/mutation/planted has what came of each: one that was not found fails the check, one without a result a release.
"""

import collections
import dataclasses
import fnmatch
import functools
import pathlib
import re
import tomllib

import records
from common import hash_of
from runner import Tests

FOLDER = pathlib.Path(__file__).parent / "planted"
RESULTS = records.FOLDER / "planted"
RULES = "docs/rules.md"
FIELDS = {"file", "old", "new", "test"}
COUNT = re.compile(r"\bplanted (\d+)(?: of (\d+))?\b")


@dataclasses.dataclass(frozen=True)
class Bug:
    number: int  # from 1 on
    where: str  # the file of its table
    rule: str
    file: str
    old: str
    new: str
    test: str

    @property
    def tests(self):
        return Tests(*self.test.split(" ", 1))

    @property
    def key(self):
        return hash_of(self.rule, self.file, self.old, self.new, self.test)

    def __str__(self):
        return f"{self.where} {self.number}: {self.rule}: {self.file}: {line_of(self.old)} => {line_of(self.new)}"


def line_of(text):
    return " ".join(text.split())


class Bad(Exception):
    """What is wrong with a file of bugs."""


def read(folder=FOLDER):
    found = []
    for path in sorted(folder.glob("*.toml")):
        try:
            table = tomllib.loads(path.read_text())
        except tomllib.TOMLDecodeError as bad:
            raise Bad(f"{path.name}: {bad}") from bad
        for rule, rows in table.items():
            for row in rows:
                if set(row) != FIELDS or " " not in row["test"]:
                    raise Bad(f"{path.name}: {rule}: expected file, old, new and test = 'PROGRAM FILTER'")
                found.append(Bug(len(found) + 1, path.name, rule, **row))
    return found


def rows_of(text):
    """{first cell: (names of tests, how)} of the rows of docs/rules.md."""
    cells = [[c.strip() for c in line.strip("|").split(" | ")] for line in text.splitlines() if line.startswith("| ")]
    return {row[0]: (row[1], row[2].strip(" |")) for row in cells if len(row) == 3}


def names_test(cell, pattern):
    """Whether a cell of a row names the test that a filter chooses; `x.vec` is the test vectors.x of both engines."""
    head, _, rest = pattern.partition(".")
    test = rest.split("/")[0].rstrip("*")
    suites = [suite.strip("*") for suite in head.split("/")]  # one of them is; the others are names of instances
    for name in re.findall(r"`([^`]+)`", cell):
        if name.endswith(".vec"):
            if "vectors" in suites and test.startswith(f"{name[:-4]}_"):
                return True
        elif any(fnmatch.fnmatch(f"{suite}.{test}", name) for suite in suites):
            return True
    return False


@functools.cache
def text_of(path):
    return path.read_text()


def misplaced(bug, root):
    """Why it does not apply; None where it does."""
    path = root / bug.file
    count = text_of(path).count(bug.old) if path.is_file() else -1
    if bug.old == bug.new:
        return "its new text is the old"
    return None if count == 1 else "there is no such file" if count < 0 else f"its old text stands there {count} times"


def made_of(bug, root):
    """What the source is with it, blanks apart: two cuts of one change are one bug."""
    path = root / bug.file
    return bug.file, hash_of("".join(text_of(path).replace(bug.old, bug.new).split())) if path.is_file() else ""


def counted(text, bugs):
    """docs/rules.md with the counts of `bugs`."""
    have, lines = {}, []
    for bug in bugs:
        have[bug.rule] = have.get(bug.rule, 0) + 1
    kept = once = 0
    for line in text.splitlines():
        head, bar, how = line.rpartition(" | ") if not line.endswith(" |") else line[:-2].rpartition(" | ")
        cell, match = line[2:].split(" | ")[0], COUNT.search(how)
        if not line.startswith("| ") or (cell not in have and not match):
            lines.append(line)
            continue
        now, before = have.get(cell, 0), int(match[2] or match[1]) if match else 0
        count = f"planted {now}" if now >= before else f"planted {now} of {before}"
        how = how.replace(match[0], count) if match else count if how == "read" else f"{count}, {how}"
        kept, once = kept + now, once + max(now, before)
        lines.append(f"{head}{bar}{how} |")
    text = "\n".join(lines) + "\n"
    return re.sub(r"\d+ of \d+ misreadings", f"{kept} of {once} misreadings", text)


def problems(root, folder=FOLDER):
    """What is wrong with the entries and with the counts of docs/rules.md; by texts alone, nothing is built."""
    bugs, text, found, seen = read(folder), (root / RULES).read_text(), [], set()
    rows = rows_of(text)
    for bug in bugs:
        why = misplaced(bug, root)
        if bug.rule not in rows:
            why = f"{RULES} has no row '{bug.rule}'"
        elif not names_test(rows[bug.rule][0], bug.tests.filter):
            why = f"the row of {RULES} does not name {bug.tests.filter}"
        elif made_of(bug, root) in seen:
            why = "it stands there twice"
        seen.add(made_of(bug, root))
        if why:
            found.append(f"{bug}: {why}")
    if counted(text, bugs) != text:
        found.append(f"{RULES}: its counts are not those of tools/mutate/planted: ./dev mutate planted --write")
    return found


def outcomes(bugs, folder=RESULTS):
    """(a line for each that its test did not find when it ran last, those that no result knows)"""
    rows = {row["key"]: row for path in folder.glob("*.jsonl") for row in records.read(path)[1]}
    missed = [f"{bug}: {bug.tests.filter} did not find it: {rows[bug.key]['by']}"
              for bug in bugs if bug.key in rows and not rows[bug.key]["found"]]
    return missed, [bug for bug in bugs if bug.key not in rows]


def tidy(root, write, release, folder=FOLDER, results=RESULTS):
    """The check, and with `write` first the counts into the page. An exit status."""
    page, bugs = root / RULES, read(folder)
    if write:
        page.write_text(counted(page.read_text(), bugs))
    missed, never = outcomes(bugs, results)
    found = problems(root, folder) + missed
    if release:
        found += [f"{bug}: no result says that {bug.tests.filter} finds it" for bug in never]
    for line in found:
        print(line)
    for program, count in sorted(collections.Counter(bug.tests.program for bug in never).items()):
        print(f"{program}: {count} of its bugs have no result (./dev mutate planted --resume); a release fails")
    print(f"planted: {len(bugs)} bugs, {len(found)} problem(s)")
    return int(bool(found))
