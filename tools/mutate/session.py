"""One module or folder, judged: mutants are drawn, built together, run, filtered and written down."""

import collections
import concurrent.futures
import datetime
import itertools
import random
import subprocess
import time

import prove
import records
import runner
from common import GIT, ROOT
from mutant import draw, source_hash
from runner import EQUAL, KILLED

DEFAULT_COUNT = 150
SAVE_EVERY = 25


def tree():
    """Which commit is judged, and whether the tree differs from it in more than what is written here."""
    def git(*command):
        return subprocess.run([*GIT, "-C", str(ROOT), *command], capture_output=True, text=True, check=False).stdout

    differs = git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!results", ":!docs/mutation.md",
                  ":!tools/mutate/reasons.toml")
    return {"commit": git("rev-parse", "--short=10", "HEAD").strip(), "dirty": bool(differs.strip())}


class Session:
    def __init__(self, judge, options):
        self.judge, self.options = judge, options
        self.path = records.path_of(judge.module.kind, judge.module.name, options.part)
        self.inputs = judge.inputs()
        self.rows, self.faults, self.begin = {}, [], time.monotonic()
        self.known_names = {}  # {Tests: names}
        self.seed, self.count = options.seed, None if options.all else options.count or DEFAULT_COUNT
        self.once = self.read_once() if options.renew else {}
        self.known, self.whole = self.read_killed() if options.renew else self.read_known()
        self.tree, self.source = tree(), source_hash(ROOT, judge.module)

    def read_once(self):
        """{key: row} of the results, whatever their inputs; their seed and count."""
        if not self.path.exists():
            return {}
        head, rows = records.read(self.path)
        self.seed, self.count = head["seed"], head["count"]
        return {records.key(row): row for row in rows}

    def read_killed(self):
        """{key: row} of what tests that are still there have killed of the same sources."""
        if not self.once or records.read(self.path)[0]["source"] != source_hash(ROOT, self.judge.module):
            return {}, False
        return {key: row for key, row in self.once.items() if row["status"] == KILLED and self.holds(row)}, False

    def holds(self, row):
        """Whether the test or rule that killed it is there and judges the module. Lock-step is none that does: a test
        that came since may kill what it killed."""
        program, _, what = row["by"].partition(": ")
        module = self.judge.module
        if row["stage"] == "proof":
            return program == f"proof {module.proof}" and what in prove.Rules(ROOT, module.proof).english
        if row["stage"] == "unknowns":
            return True
        judging = {"tests": module.opinion, "board": module.board, "image": module.image}.get(row["stage"], ())
        return any(what in self.names(tests) for tests in judging if tests.program == program)

    def names(self, tests):
        if tests not in self.known_names:
            self.known_names[tests] = runner.names(self.judge.tree / "bin" / tests.program, tests)
        return self.known_names[tests]

    def read_known(self):
        """{key: row} of results that have the same inputs, and whether they are all that is asked for."""
        if not self.path.exists():
            return {}, False
        head, rows = records.read(self.path)
        if head["inputs"] != self.inputs:
            return {}, False
        whole = head.get("done", False) and (head["count"], head["seed"]) == (self.count, self.seed)
        return {records.key(row): row for row in rows}, whole

    def is_fresh(self):
        return self.whole

    def run(self):
        options = self.options
        first, rest = draw(self.judge.mutants, self.count, self.seed)
        old = [m for m in self.judge.mutants if m.key in self.once]
        if old:  # once more; what has gone is drawn anew
            count = len(first)
            drawn = [*old, *(m for m in rest + first if m.key not in self.once)]
            first, rest = drawn[:count], drawn[count:]
        rest = rest[:self.judge.spare]
        if options.part:
            k, n = options.part
            first, rest = first[k - 1::n], rest[k - 1::n]
        if options.resume:
            self.rows = {m.number: {**self.known[m.key], "number": m.number, "line": m.line}
                         for m in first + rest if m.key in self.known}
        known = set(self.rows)
        self.judge.write([m for m in first + rest if m.number not in known])
        order, taken = iter(first + rest), []
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            # One that is proved equal does not count: the next of the list comes in its place.
            while batch := list(itertools.islice(order, len(first) - self.counted(taken))):
                taken += batch
                missing = [m for m in batch if m.number not in self.rows]
                by = [self.once[m.key]["by"] if m.key in self.once else "" for m in missing]
                judged = pool.map(self.judge.judge, missing, by)
                for done, (mutant, (stage, verdict)) in enumerate(zip(missing, judged, strict=True), 1):
                    self.rows[mutant.number] = records.record(mutant, verdict, stage)
                    if done % SAVE_EVERY == 0:
                        self.save(taken)
            self.save(taken)
            self.control(pool, taken)
        self.save(taken, done=True)

    def counted(self, taken):
        return sum(self.rows[m.number]["status"] != EQUAL for m in taken)

    def control(self, pool, taken):
        """The filter must not prove equal what a test has killed: so many as are asked for, or as its judge needs."""
        killed = [m for m in taken
                  if self.rows[m.number]["status"] == KILLED and self.rows[m.number]["stage"] in ("tests", "board")]
        count = self.judge.controls if self.options.control is None else self.options.control
        chosen = random.Random(self.seed).sample(killed, min(count, len(killed)))
        for mutant, verdict in zip(chosen, pool.map(self.judge.by_filter, chosen), strict=True):
            if verdict.status == EQUAL:
                self.faults.append(mutant.number)

    def save(self, taken, done=False):
        head = {"module": self.judge.module.name, "file": self.judge.module.file, "inputs": self.inputs,
                "source": self.source,
                "seed": self.seed, "mutants": len(self.judge.mutants), "count": self.count,
                "done": done, **self.tree,
                "time": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
                "build_seconds": round(self.judge.build_seconds, 1),
                "seconds": round(time.monotonic() - self.begin, 1), "equal_yet_killed": self.faults}
        records.write(self.path, head, [self.rows[m.number] for m in taken if m.number in self.rows])

    def summary(self):
        """A line for the terminal, and one for each survivor."""
        rows = list(self.rows.values())
        count = collections.Counter(row["status"] for row in rows)
        lines = [f"{self.judge.module.name}: {len(rows)} of {len(self.judge.mutants)} mutants, "
                 + ", ".join(f"{n} {status}" for status, n in sorted(count.items()))
                 + f"; {time.monotonic() - self.begin:.0f} s, {self.judge.build_seconds:.0f} s of them building"]
        for row in sorted(rows, key=lambda r: r["number"]):
            if row["status"] not in (KILLED, EQUAL) or row["stage"] == "slip":
                what = f"{row['status']} ({row['stage']})" if row["stage"] else row["status"]
                lines.append(f"  {row['file']}:{row['line']}: {what}: {row['operator']}: {row['change']} {row['by']}")
        lines += [f"  {n}: proved equal, yet a test has killed it: a fault of the filter" for n in self.faults]
        return "\n".join(lines)
