"""Mutants that the results have as killed by tests: some of them are built and run again, and each must die again."""

import random
import re
import subprocess

import judges
import records
from common import GIT, ROOT
from mutant import source_hash
from runner import KILLED

COUNT = 20  # of one module
DRAWN = ("rtl", "firmware")  # the programs of a model's or of a host's mutants take minutes to build
NAMED = re.compile(r"\S+: [^\s.]+\.\S+$")  # by a test that has a name, not a sanitizer's report


def killed_rows(module):
    _, rows = records.of_module(module.kind, module.name)
    return {records.key(row): row for row in rows
            if row["status"] == KILLED and row["stage"] in ("tests", "image") and NAMED.match(row["by"])}


def choose(modules, picks):
    """One of those whose file has changed since their results, or of all, of kinds that are built in seconds."""
    known = [m for m in modules if m.kind in DRAWN and killed_rows(m)]
    changed = [m for m in known if records.source_of(m.kind, m.name) != source_hash(ROOT, m)]
    return [picks.choice(changed or known)] if known else []


def draw(mutants, picks, count):
    """Of no more files than are needed: each is compiled."""
    files, there = sorted({m.file for m in mutants}), []
    picks.shuffle(files)
    while files and len(there) < count:
        file = files.pop()
        there += [m for m in mutants if m.file == file]
    return picks.sample(there, min(count, len(there)))


def commit():
    return subprocess.run([*GIT, "-C", str(ROOT), "rev-parse", "HEAD"], capture_output=True, text=True,
                          check=False).stdout.strip()


def main(modules, options):
    picks = random.Random(options.seed if options.seed is not None else commit())  # another commit, other mutants
    lives, count = [], 0
    for module in modules if options.names else choose(modules, picks):
        judge, rows = judges.of(module, options.build, "again"), killed_rows(module)
        chosen = draw([m for m in judge.mutants if m.key in rows], picks, options.count or COUNT)
        judge.write(chosen)
        for mutant in chosen:
            by = rows[mutant.key]["by"]
            verdict = judge.again(mutant, by)
            if verdict is None:
                print(f"{mutant.file}:{mutant.line}: was killed by {by}, which does not judge it now")
                continue
            count += 1
            if verdict.status != KILLED:
                lives.append(f"{mutant.file}:{mutant.line}: {mutant.place.operator}: {mutant.change}: was killed by "
                             f"{by}, now it is {verdict.status} {verdict.by}")
        print(f"{module.kind} {module.name}: {len(chosen)} mutants")
    for line in lives:
        print(line)
    print(f"mutants again: {count - len(lives)} of {count} killed")
    return 1 if lives or count == 0 else 0
