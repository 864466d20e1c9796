"""Runs a test program on one mutant and says what came of it: the first failure stops.

Killed: a failed expectation (a bench's limit in simulated time is one), or a report of an assertion or sanitizer that
names its place. Wall-time limits and other crashes are neither killed nor alive, but 'outside' the score. Tests share a
process here, with CTest each has its own: what a mutant leaves behind may fail a test that has nothing to do with it.
So a failure behind others counts only when that test fails alone too.
"""

import dataclasses
import math
import os
import re
import signal
import subprocess
import tempfile
import threading

ALIVE, KILLED, EQUAL, OUTSIDE = "alive", "killed", "equal", "outside"
ASLEEP, CROWDED = 60, 20  # s, times: a program that uses no processor, or shares it, ends too
REPORTS = re.compile(r"^(\S+:\d+(?::\d+)?: runtime error: .*|.*ERROR: AddressSanitizer: .*|\S+: Assertion `.*"
                     r"|\S+:\d+: .*Assertion.*failed.*|%Error: \S+:\d+: Assertion failed.*)$", re.M)


class BadBuild(Exception):
    """Number 0 does not pass, or nothing can be built."""


@dataclasses.dataclass(frozen=True)
class Verdict:
    status: str
    by: str  # the test that failed first, or why it is outside
    seconds: float  # of the processor
    begun: tuple = ()  # tests, in their order


@dataclasses.dataclass(frozen=True)
class Tests:
    """A program and which of its tests."""

    program: str
    filter: str

    def without(self, names):
        sign = "" if not names else ":" if "-" in self.filter else "-"
        return dataclasses.replace(self, filter=self.filter + sign + ":".join(names))


def confirmed(run, tests):
    """What `run` says of `tests`; where that is of one behind others, what it says of that one alone. Does it pass
    then, those that have not begun are run: in another process."""
    seconds, done = 0.0, ()
    while True:
        verdict = run(tests.without(done))
        seconds += verdict.seconds
        if done and not verdict.begun:
            verdict = Verdict(ALIVE, "", 0.0)
        if len(verdict.begun) > 1 and verdict.status != ALIVE:
            done += verdict.begun
            verdict = run(dataclasses.replace(tests, filter=done[-1]))
            seconds += verdict.seconds
            if verdict.status == ALIVE:
                continue
        return dataclasses.replace(verdict, seconds=seconds)


def again(run, tests, number):
    """What `tests`, which number 0 passes, say of mutant `number`, by `run`(tests, number); None: there are no such
    tests now."""
    zero = run(tests, 0)
    if zero.by.endswith(no_test(tests)):
        return None
    if zero.status != ALIVE:
        raise BadBuild(f"number 0, the source as it is, does not pass: {zero.by}")
    return run(tests, number)


def by_any(run, tests, number):
    """What `run`(tests, number) says of mutant `number`, by the first of `tests` that it fails alone, and number 0 does
    not."""
    passed_by = ()
    while True:
        verdict = run(tests.without(passed_by), number)
        if verdict.status == ALIVE or not verdict.begun:  # none is left, or none fails
            return Verdict(ALIVE, "", 0.0)
        one = dataclasses.replace(tests, filter=verdict.begun[-1])
        alone = run(one, number)
        if alone.status != ALIVE and run(one, 0).status == ALIVE:
            return alone
        passed_by += (one.filter,)


def run(binary, tests, number, limit, compare, folder, **more):
    """`compare`: what rigs with both engines do, see testbench/unit/rtl/comparison.h. `more`: of the environment.
    `limit`: seconds of the processor, so that what else runs on the machine decides nothing."""
    environment = {**os.environ, **more, "BRICK_MUTANT": str(number), "BRICK_COMPARE": compare}
    environment.pop("GTEST_TOTAL_SHARDS", None)
    command = ["prlimit", f"--cpu={math.ceil(limit)}", str(binary), f"--gtest_filter={tests.filter}",
               "--gtest_fail_fast"]
    status, text, seconds = ended(command, folder, ASLEEP + CROWDED * limit, environment)
    begun = tuple(re.findall(r"\[ RUN      \] (\S+)", text.partition("[  FAILED  ]")[0]))  # it skips the rest
    if status in (-signal.SIGXCPU, -signal.SIGKILL):
        return Verdict(OUTSIDE, f"{tests.program}: no end within {limit:.0f} s", seconds, begun)
    return dataclasses.replace(judge(status, text, tests, seconds), begun=begun)


def ended(command, folder, limit, environment=None):
    """(status, what it said, seconds of the processor) of a program that is killed after `limit` seconds."""
    with tempfile.TemporaryFile() as said:
        program = subprocess.Popen(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=said,
                                   stderr=subprocess.STDOUT)
        watch = threading.Timer(limit, program.kill)
        watch.start()
        _, status, used = os.wait4(program.pid, 0)
        watch.cancel()
        program.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        return program.returncode, said.read().decode(errors="replace"), used.ru_utime + used.ru_stime


def failures(binary, tests, limit, folder):
    """The tests that fail on number 0 when nothing compares RTL and model: controls of that comparison."""
    environment = {**os.environ, "BRICK_MUTANT": "0", "BRICK_COMPARE": "off"}
    done = subprocess.run([str(binary), f"--gtest_filter={tests.filter}", "--gtest_brief=1"], cwd=folder,
                          env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          timeout=limit, text=True, errors="replace")
    return sorted({name.rstrip(",") for name in re.findall(r"^\[  FAILED  \] ([^\s,]+[./][^\s,]+)", done.stdout, re.M)})


def names(binary, tests):
    """Of the tests of a program that are called so."""
    said = subprocess.run([str(binary), "--gtest_list_tests", f"--gtest_filter={tests.filter}"], check=False,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True).stdout
    found, suite = set(), None
    for line in said.splitlines():
        name = line.partition("  #")[0].strip()
        if line.startswith("  "):
            found.add(f"{suite}{name}")
        elif name.endswith("."):
            suite = name
    return found


def no_test(tests):
    return f"no test is called {tests.filter}"


def judge(status, said, tests, seconds):
    if status == 0:
        ran = re.search(r"^\[==========\] (\d+) tests? from", said, re.M)
        if ran is None or ran.group(1) == "0":
            return Verdict(OUTSIDE, f"{tests.program}: {no_test(tests)}", seconds)
        return Verdict(ALIVE, "", seconds)
    failed = re.search(r"^\[  FAILED  \] (\S+)", said, re.M)
    if failed:
        return Verdict(KILLED, f"{tests.program}: {failed.group(1).rstrip(',')}", seconds)
    report = REPORTS.search(said)
    if report:
        what = re.sub(r"^==\d+==ERROR: | on (unknown )?address.*", "", report.group(1))
        return Verdict(KILLED, f"{tests.program}: {what[:200]}", seconds)
    return Verdict(OUTSIDE, f"{tests.program}: ends with status {status}", seconds)
