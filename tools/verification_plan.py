"""The rows of docs/verification-plan.md: scenario, the requirements it names, its tests, its covers.

A row's last cell says how often things have to happen for its pass to mean something, one of these ways:
  `bench: name` >= N   a cover of `brick run --json` (docs/covers.md), N in all runs together. {1..3; 7; none} stands
                       for each of its members, two of them for each pair: a cross. Each needs its N
  listed               the test goes through a list or a loop of its own and judges each case
  asserted             its stimulus is random; it fails, or goes on, when what it needs has not happened often enough
  proved               a proof has a cover for each rule, which must be reached
  static               no stimulus: files are compared
  none: REASON         nothing is counted, because of REASON
"""

import collections
import itertools
import json
import re

PLAN, COUNTED = "docs/verification-plan.md", "results/covers.json"
HEADS = ["scenario", "stimulus", "pass", "test", "covers"]
WORDS = {"asserted", "listed", "proved", "static"}
Row = collections.namedtuple("Row", "number scenario ids tests covers words reason")
Cover = collections.namedtuple("Cover", "names least")


def ids_of(text):
    """The requirements in the brackets of a scenario: (CLK-1 to CLK-6, I19-1)."""
    found = []
    for first, last in re.findall(r"\b([A-Z][A-Z0-9]*-\d+)(?: to ([A-Z][A-Z0-9]*-\d+))?", text):
        name, number = first.rsplit("-", 1)
        end = int(last.rsplit("-", 1)[1]) if last else int(number)
        found += [f"{name}-{n}" for n in range(int(number), end + 1)]
    return found


def cells_of(line):
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]


def covers_of(cell):
    """([Cover], words, reason) of a row's last cell; what is left over of it is no part of the form."""
    reason = re.search(r"\bnone: (.+)$", cell)
    rest = cell[:reason.start()] if reason else cell
    covers = [Cover(text, int(least.replace(",", ""))) for text, least in
              re.findall(r"`([^`]+)` >= ([\d,]*\d)", rest)]
    rest = re.sub(r"`[^`]+` >= [\d,]*\d", "", rest)
    words = re.findall(r"\w[\w ]*", rest)
    return covers, words, reason[1].strip() if reason else ""


def rows(root):
    """(rows, problems of their form)."""
    path, found, problems, table = root / PLAN, [], [], False
    for number, line in enumerate(path.read_text().splitlines() if path.exists() else [], 1):
        if not line.startswith("|"):
            table = False
            continue
        cells = cells_of(line)
        if cells[:4] == HEADS[:4]:
            table = True
            if cells != HEADS:
                problems.append(f"{PLAN}:{number}: the columns are {', '.join(cells)}; expected {', '.join(HEADS)}")
        elif table and not set(line) <= set("|-"):
            if len(cells) != len(HEADS):
                problems.append(f"{PLAN}:{number}: '{cells[0]}' has {len(cells)} cells; expected {len(HEADS)}")
                continue
            covers, words, reason = covers_of(cells[4])
            found.append(Row(number, cells[0], ids_of(cells[0]), cells[3], covers, words, reason))
    return found, problems


def problems_of(root):
    """Rows of the wrong form, and rows without covers and without a reason."""
    found, problems = rows(root)
    for row in found:
        where = f"{PLAN}:{row.number}: '{row.scenario}'"
        problems += [f"{where}: `{cover.names}` >= 0 asks for nothing" for cover in row.covers if cover.least == 0]
        problems += [f"{where}: '{word}' is no cover; expected {', '.join(sorted(WORDS))}, `NAME` >= N or none: REASON"
                     for word in row.words if word not in WORDS]
        if not row.covers and not row.words and not row.reason:
            problems.append(f"{where}: no cover and no reason")
    return problems


def counted(root):
    """(commit, {cover: count on all engines together}) of the last measurement."""
    path = root / COUNTED
    found = json.loads(path.read_text()) if path.exists() else {"commit": "none yet", "covers": {}}
    return found["commit"], {name: sum(engines.values()) for name, engines in found["covers"].items()}


def each(names):
    """The names that a text with {members; in; braces} stands for."""
    def members(text):
        for member in text.split(";"):
            ends = re.fullmatch(r"(\d+)\.\.(\d+)", member.strip())
            numbers = range(int(ends[1]), int(ends[2]) + 1) if ends else ()
            yield from map(str, numbers) if numbers else (member.strip(),)  # 3..1: a name that nothing counts

    parts = re.split(r"\{([^}]*)\}", names)  # a text, a list, a text and so on
    choices = [list(members(part)) if place % 2 else [part] for place, part in enumerate(parts)]
    return ["".join(chosen) for chosen in itertools.product(*choices)]


def counts_of(names, counted):
    """{name: count} of all that a text stands for; 0 of what was not counted."""
    return {name: counted.get(name, 0) for name in each(names)}


def unreached(root):
    """Covers of the plan that were not counted, or not often enough."""
    problems, counts = [], counted(root)[1]
    for row in rows(root)[0]:
        for cover in row.covers:
            problems += [f"{PLAN}:{row.number}: `{name}`: {count}; expected at least {cover.least}"
                         for name, count in counts_of(cover.names, counts).items() if count < cover.least]
    return problems
