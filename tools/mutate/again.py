"""Mutants that the results have as killed by tests: some of them are built and run again, and each must die again."""

import random

import records
from common import ROOT
from mutant import hash_of
from runner import KILLED

from rtl import Judge

COUNT, MODULES = 20, 1


def killed_rows(module):
    _, rows = records.of_module("rtl", module.name)
    return {records.key(row): row for row in rows if row["status"] == KILLED and row["stage"] == "tests"}


def choose(modules, picks):
    """Modules with results; of those whose file has changed since, or of all, as many as are built in a few seconds."""
    known = [m for m in modules if killed_rows(m)]
    changed = [m for m in known if records.source_of("rtl", m.name) != hash_of(ROOT / m.file)]
    return picks.sample(changed or known, min(MODULES, len(known)))


def main(modules, options):
    picks = random.Random(options.seed)
    lives, count = [], 0
    for module in modules if options.names else choose(modules, picks):
        judge, rows = Judge(ROOT, options.build, module), killed_rows(module)
        there = [m for m in judge.mutants if m.key in rows]
        chosen = picks.sample(there, min(options.count or COUNT, len(there)))
        judge.write(chosen)
        for mutant in chosen:
            verdict = judge.by_tests(judge.stages[0], mutant)
            count += 1
            if verdict.status != KILLED:
                lives.append(f"{mutant.file}:{mutant.line}: {mutant.place.operator}: {mutant.change}: was killed by "
                             f"{rows[mutant.key]['by']}, now it is {verdict.status} {verdict.by}")
    for line in lives:
        print(line)
    print(f"mutants again: {count - len(lives)} of {count} killed")
    return 1 if lives or count == 0 else 0
