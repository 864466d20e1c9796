"""docs/mutation.md, made of the results in results/mutation and of the reasons in reasons.toml.

A reason whose mutant is dead, or of which no result knows, is a problem. A survivor without a reason is open: it is
counted, and is a problem of a release.
"""

import collections
import math
import pathlib
import textwrap
import tomllib

import plan
import records
from common import ROOT
from mutant import source_hash
from runner import ALIVE, EQUAL, KILLED, OUTSIDE

PAGE = ROOT / "docs/mutation.md"
REASONS = pathlib.Path(__file__).parent / "reasons.toml"
Z = 1.6449  # a normal variable is below it 95 times in a hundred
COLUMNS = ("module", "mutants", "judged", "equal", "outside", "alive", "score", "at least", "slip", "s", "seed",
           "commit")
STALE = ", stale"
WITH_SLIP = ("rtl", "model")  # these have another engine beside them
MOST_OUTSIDE = 0.05  # of a module, without being listed
HEAD = """# Mutants

<!-- Written by `./dev mutate report` from results/mutation and tools/mutate/reasons.toml. Do not edit. -->
What would the tests notice? A mutant is the source with one place changed: an operator, a comparison, a constant, a
case item, an enable, a reset, a condition, a statement left out. `./dev mutate rtl NAME` finds the places with slang's
parser, puts many mutants into one Verilated model, of which a number chooses one, and runs the module's tests on each;
`./dev mutate firmware FOLDER` does so with Clang's parser, the native build of the firmware and the tests that come to
the place, then, of what they leave, with the image that is linked with the mutant and its tests on the CPU model;
`./dev mutate model FOLDER` with the SystemC model, `./dev mutate host NAME` with the host library, the Ethernet server,
the models of its buses and what reads a client's lines. Number 0 is the source as it is and passes. The first failure
stops; behind other tests in one process it counts when that test fails alone, too (seen of all rows but the model's).

- **score**: killed of killed and alive. A mutant of RTL or of the model stands in that engine alone and every
  comparison of the two is off: the tests have values of their own, the proof has its rules, Icarus shows what is
  unknown behind the reset (`lint.unknowns`), and a model that sleeps until its next event shows what it shows when it
  is kept awake. This holds when both sides misread a rule alike.
- **slip**: with lock-step and component tests on what was left: a mistake in one engine alone.
- **equal**: proved, without a bound, to be the module it was made from, or with it the one around; of C and C++, the
  same object code at -O2; out of the count, another takes its place.
- **outside**: ended by its limit of processor time, a crash without a report that names its place, or no image can be
  built of it; out of the count too.
- **at least**: the lower end of what the score of all mutants of the module may be, at 95 % (Wilson's interval, one
  side), from those drawn; the score itself where all were judged. It holds of mutants that no test was written for:
  where tests followed on survivors of the draw (firmware, all folders; model `host`) the score is of the draw, and a
  seed that is new says less. *Together* each module weighs by its mutants; *the rest* are folders of the firmware
  beside the five with a sum of their own.
- **stale**, at the commit: the file has changed since it was judged.

Not mutated: what is fixed before it runs (widths, parameters, generate blocks, sensitivity lists; initial values of
static variables, labels, macros with arguments, what is `constexpr`); what is assigned to a net called `unused`, for
the linters; `board_sim` and the test bench; of the firmware what has no native build. Which tests judge a module says
`tools/mutate/modules.toml`. `./dev mutate --help` has the options.

`./dev mutate again` builds twenty killed mutants once more, and each must die again: of one module, which is drawn from
RTL and firmware, or of each that is named, of any kind. The test `mutation.killed_again` draws ten.
"""


def wilson(hits, tries):
    """The lower end of the interval for the share of hits."""
    if tries == 0:
        return 0.0
    share, square = hits / tries, Z * Z
    centre, spread = share + square / (2 * tries), Z * math.sqrt((share * (1 - share) + square / (4 * tries)) / tries)
    return max(0.0, (centre - spread) / (1 + square / tries))


class Score:
    """Of the rows of a module, or of several."""

    def __init__(self, rows):
        count = collections.Counter(row["status"] for row in rows)
        self.slip_only = sum(row["status"] == KILLED and row["stage"] == "slip" for row in rows)
        self.killed, self.equal, self.outside = count[KILLED] - self.slip_only, count[EQUAL], count[OUTSIDE]
        self.alive = count[ALIVE] + self.slip_only
        self.seconds = sum(row["seconds"] for row in rows)

    def counted(self):
        return self.killed + self.alive

    def cells(self, complete, has_slip=True):
        counted = self.counted()
        if counted == 0:
            return ["-", "-", "-"]
        low = self.killed / counted if complete else wilson(self.killed, counted)
        slip = (self.killed + self.slip_only) / counted
        return [percent(self.killed / counted), percent(low), percent(slip) if has_slip else "-"]


def together(modules, kind):
    """Cells of several, each by the number of its mutants, however many are judged. `modules`: [(heads, rows)]"""
    scored = [(heads[0]["mutants"], Score(rows)) for heads, rows in modules if Score(rows).counted()]
    every = sum(mutants for mutants, _ in scored)
    if every == 0:
        return ["-", "-", "-"]
    killed = sum(mutants * score.killed / score.counted() for mutants, score in scored) / every
    slip = sum(mutants * (score.killed + score.slip_only) / score.counted() for mutants, score in scored) / every
    return [percent(killed), "-", percent(slip) if kind in WITH_SLIP else "-"]


def percent(share):
    return f"{math.floor(share * 1000) / 10:.1f} %"


def reasons():
    """{key: reason}"""
    table = tomllib.loads(REASONS.read_text()) if REASONS.exists() else {}
    return {(r["file"], r["line"], r["operator"], r["change"], r.get("repeat", 0)): r["reason"]
            for r in table.get("survivor", [])}


def survivors(rows):
    """What a module's own tests and proofs leave alive, in the order of the file."""
    return [row for row in sorted(rows, key=lambda r: r["number"])
            if row["status"] == ALIVE or (row["status"] == KILLED and row["stage"] == "slip")]


def gather(kinds):
    """{(kind, module name): (heads, rows)} of those that have results."""
    found = {(kind, name): records.of_module(kind, name) for kind, modules in kinds.items() for name in modules}
    return {key: value for key, value in found.items() if value[1]}


def open_of(results, given):
    """Survivors without a reason, and what stands outside the score where that is too much of a module."""
    found = []
    for (kind, name), (_, rows) in results.items():
        where = f"results/mutation/{kind}/{name}"
        outside = [row for row in rows if row["status"] == OUTSIDE]
        many = outside if len(outside) > MOST_OUTSIDE * len(rows) else []
        found += [f"{where}: {row['file']}:{row['line']}: survivor without a reason in tools/mutate/reasons.toml: "
                  f"{row['operator']}: {row['change']}" for row in survivors(rows) if records.key(row) not in given]
        found += [f"{where}: outside the score, and more than {MOST_OUTSIDE:.0%} of the module: "
                  f"{row['file']}:{row['line']}: {row['change']}: {row['by']}"
                  for row in many if records.key(row) not in given]
    return found


def problems_of(results, given):
    problems, seen = [], set()
    for (kind, name), (heads, rows) in results.items():
        where = f"results/mutation/{kind}/{name}"
        seen |= {records.key(row) for row in rows if row in survivors(rows) or row["status"] == OUTSIDE}
        for row in rows:
            key = records.key(row)
            if key in given and key not in seen:
                seen.add(key)
                problems.append(f"tools/mutate/reasons.toml: a reason for a mutant that is {row['status']} "
                                f"({row['by']}): {row['file']}: {row['change']}")
        for head in heads:
            problems += [f"{where}: mutant {n} is proved equal, yet a test kills it" for n in head["equal_yet_killed"]]
    problems += [f"tools/mutate/reasons.toml: no result has this mutant: {key[0]}: {key[1]}: {key[3]}"
                 for key in given if key not in seen]
    return problems


def seconds_of(heads, rows):
    return Score(rows).seconds + sum(head["build_seconds"] for head in heads)


def line(name, mutants, rows, cells, seconds, seed, tree):
    """Of the table."""
    score = Score(rows)
    return "| " + " | ".join(map(str, [name, mutants, len(rows), score.equal, score.outside, score.alive, *cells,
                                       f"{seconds:.0f}", seed, tree])) + " |"


def page(results, given, modules):
    """`modules`: {kind: {name: Module}}"""
    lines = [HEAD]
    for kind in sorted({kind for kind, _ in results}):
        title = {"rtl": "RTL"}.get(kind, kind.capitalize())
        lines += [f"## {title}", "| " + " | ".join(COLUMNS) + " |", "|---" * len(COLUMNS) + "|"]
        of_kind = {name: result for (of, name), result in results.items() if of == kind}
        for name, (heads, rows) in of_kind.items():
            score, head = Score(rows), heads[0]
            complete = score.counted() + score.equal + score.outside == head["mutants"]
            tree = head["commit"] + (" and changes" if head["dirty"] else "")
            if any(h["source"] != source_hash(ROOT, modules[kind][name]) for h in heads):
                tree += STALE
            lines.append(line(f"`{name}`", head["mutants"], rows, score.cells(complete, kind in WITH_SLIP),
                              seconds_of(heads, rows), head["seed"], tree))
        for what in ("together", "the rest together"):
            some = [result for name, result in of_kind.items() if modules[kind][name].rest == (what != "together")]
            if some:
                rows = [row for _, of_module in some for row in of_module]
                lines.append(line(what, sum(heads[0]["mutants"] for heads, _ in some), rows, together(some, kind),
                                  sum(seconds_of(*result) for result in some), "", ""))
        score = Score([row for _, rows in of_kind.values() for row in rows])
        lines += ["", "### Survivors", ""]
        if score.alive == 0:
            lines.append("None.")
        for (of, _), (_, rows) in results.items():
            for row in survivors(rows) if of == kind else []:
                where = f"`{row['file']}`, `{row['text']}`"
                slip = " (lock-step sees it)" if row["status"] == KILLED else ""
                reason = " ".join(given.get(records.key(row), "Open.").split())
                lines.append(textwrap.fill(f"- {where}: {row['operator']}, `{row['change']}`{slip}. {reason}", 120,
                                           subsequent_indent="  ", break_long_words=False, break_on_hyphens=False))
        lines.append("")
    return "\n".join(lines).rstrip() + "\n"


def unmarked(text):
    """Whoever changes a file need not write the page anew: what it says is of the commit that it names."""
    return text.replace(STALE, "")


def main(check, release):
    kinds, given = plan.read(), reasons()
    results = gather(kinds)
    text, problems, still_open = page(results, given, kinds), problems_of(results, given), open_of(results, given)
    if release:
        problems += still_open
    if check and (not PAGE.exists() or unmarked(PAGE.read_text()) != unmarked(text)):
        problems.append("docs/mutation.md is stale: ./dev mutate report")
    if not check:
        PAGE.write_text(text)
    for problem in problems:
        print(problem)
    print(f"mutation: {len(still_open)} open; " + (f"{len(problems)} problem(s)" if problems else "clean"))
    return 1 if problems else 0
