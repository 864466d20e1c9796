#!/usr/bin/env python3
"""Proves the rules of testbench/formal/NAME.sv: prove.py [NAME...] [--out DIR] [--limit SECONDS].

A file holds the module NAME_rules: the design under test, assumptions, and numbered rules in English, each above its
assert, each with a cover of its premise. Its header says how, in comment lines:
  proof: pdr | induction N   property directed reachability (yosys-abc), or base case and step of N (z3)
  clocks: one | several      several: every clock is a signal that the file makes, time runs in steps of its own
  steps: N                   within which premises are reached and faults refuted
  fault RULE: what is wrong (FILE), then '  - old text' and '  + new text': with that edit this rule, judged
                             alone, must be refuted; the waveform is DIR/NAME.RULE.vcd
Every verdict needs the solver's words of success: no answer in time is a failure. docs/formal.md.
Exit status 0 proved, 1 not, 77 Yosys or z3 is not installed.
"""

import argparse
import collections
import os
import pathlib
import re
import shutil
import subprocess

from common import ROOT, finish, skip
from lint_rtl import SIMULATION_ONLY, rtl_files

FOLDER = "testbench/formal"
Fault = collections.namedtuple("Fault", "rule what file old new")

# Memories become flip-flops and asynchronous inputs synchronous ones, as the back ends want it.
PREPARE = {"one": "async2sync; dffunmap", "several": "clk2fflogic"}


class Failed(Exception):
    """What is wrong with a file of rules, or with what was to be proved."""


class Rules:
    """A file of rules, read and checked for its form."""

    def __init__(self, root, name):
        self.root, self.name, self.path = root, name, f"{FOLDER}/{name}.sv"
        if not (root / self.path).exists():
            raise Failed(f"{self.path}: no such file")
        self.text = (root / self.path).read_text()
        written = re.findall(r"^ +// ([A-Z]\d+): (.*(?:\n +// .*)*)", self.text, re.M)
        self.english = {label: re.sub(r"\s+// *", " ", english) for label, english in written}
        self.rules = [label for label in self.english if label.startswith("R")]
        self.proof = self.setting("proof", r"pdr|induction \d+")
        self.clocks = self.setting("clocks", "one|several")
        self.steps = int(self.setting("steps", r"\d+"))
        found = re.findall(r"^// fault (\w+): (.*) \((\S+)\)\n//   - (.*)\n//   \+ ?(.*)\n", self.text, re.M)
        self.faults = [Fault(*row) for row in found]
        self.check()

    def setting(self, key, form):
        found = re.search(rf"^// {key}: ({form})$", self.text, re.M)
        if not found:
            raise Failed(f"{self.path}: header has no '// {key}: {form}'")
        return found.group(1)

    def check(self):
        code = re.sub(r"//[^\n]*", "", self.text)
        asserts, covers = re.findall(r"(\w*):? *assert *\(", code), re.findall(r"(\w*):? *cover *\(", code)
        if asserts != list(self.english) or not self.rules:
            raise Failed(f"{self.path}: each assert needs its rule in English above it, has {asserts}")
        if sorted(covers) != sorted(f"C{label[1:]}" for label in self.rules):
            raise Failed(f"{self.path}: rules {self.rules} need one cover each, has {covers}")
        if not self.faults or len(self.faults) != len(re.findall(r"^// fault", self.text, re.M)):
            raise Failed(f"{self.path}: header needs a planted fault: RULE, what, file, old and new text")
        for fault in self.faults:
            if fault.rule not in self.rules:
                raise Failed(f"{self.path}: fault of {fault.rule}, which is no rule")


class Solvers:
    """The programs, run in the folder of models and traces."""

    def __init__(self, out, limit):
        self.out, self.limit = out, limit

    def run(self, *command):
        try:
            done = subprocess.run(command, cwd=self.out, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, timeout=self.limit)
        except subprocess.TimeoutExpired as late:
            raise Failed(f"{command[0]}: no answer within {self.limit} s") from late
        return done.stdout

    def trace(self, stem):
        return os.path.relpath(self.out / f"{stem}.vcd")

    def smtbmc(self, stem, *options):
        return self.run("yosys-smtbmc", "-s", "z3", "--unroll", "--noprogress", *options, f"{stem}.smt2")

    def refuted(self, stem, steps):
        """(rule, step) that a bounded search refutes first, waveform in stem.vcd; None when it says that none is."""
        said = self.smtbmc(stem, "-t", str(steps), "--dump-vcd", f"{stem}.vcd")
        found = re.search(r"Assert failed in \S+: (\w+)", said)
        if found and "Status: FAILED" in said:
            return found.group(1), int(re.findall(r"Checking assertions in step (\d+)", said)[-1])
        if "Status: PASSED" not in said:
            raise Failed(f"{stem}: bounded search gave no verdict\n{said[-2000:]}")
        return None


def build(rules, solvers, fault=None):
    """Models of the design: .smt2 and .aig; with a fault its rule alone is judged."""
    packages, modules = rtl_files(rules.root)
    sources = [rules.root / f for f in packages + modules if f.stem not in SIMULATION_ONLY]
    stem = rules.name
    if fault:
        stem = f"{rules.name}.{fault.rule}"
        text = (rules.root / fault.file).read_text()
        count = text.count(fault.old)
        if count != 1:
            raise Failed(f"{rules.path}: '{fault.old}' occurs {count} times in {fault.file}, expected 1")
        planted = solvers.out / f"{stem}.sv"
        planted.write_text(text.replace(fault.old, fault.new))
        sources = [planted if f == rules.root / fault.file else f for f in sources]
    others = f"delete t:$assert */{fault.rule} %d; " if fault else ""
    script = (f"read_verilog -sv -formal -defer {' '.join(map(str, sources))}; "
              f"read_verilog -sv -formal {rules.root / rules.path}; hierarchy -check -top {rules.name}_rules; "
              f"proc -norom; flatten; setundef -undriven -anyseq; memory_map; opt -full; {PREPARE[rules.clocks]}; "
              f"{others}opt_clean; write_smt2 -wires {stem}.smt2; "
              f"chformal -cover -remove; techmap; abc -g AND -fast; opt_clean; write_aiger -zinit {stem}.aig")
    model = solvers.out / f"{stem}.smt2"
    model.unlink(missing_ok=True)
    said = solvers.run("yosys", "-q", "-p", script)
    asserted = re.findall(r"^; yosys-smt2-assert \d+ (\S+)", model.read_text() if model.exists() else "", re.M)
    if re.search(r"^ERROR", said, re.M) or sorted(asserted) != sorted([fault.rule] if fault else rules.english):
        raise Failed(f"{rules.path}: Yosys made no model of all rules, but of {asserted}\n{said[-2000:]}")
    return stem


def prove(rules, stem, solvers):
    """How it was proved; raises where it was not."""
    if rules.proof == "pdr":
        said = solvers.run("yosys-abc", "-c", f"read_aiger {stem}.aig; fold; strash; pdr")
        if "Property proved." in said:
            return "pdr, " + re.search(r"Invariant F\[(\d+)\]|$", said).expand(r"\1") + " frames"
        frame = re.search(r"was asserted in frame (\d+)", said)
        steps = int(frame.group(1)) + 2 if frame else rules.steps
    else:
        steps = int(rules.proof.split()[1])
        said = solvers.smtbmc(stem, "-i", "-t", str(steps), "--dump-vcd", f"{stem}.vcd")
    wrong = solvers.refuted(stem, steps)
    if wrong:
        raise Failed(f"{wrong[0]} refuted at step {wrong[1]}, see {solvers.trace(stem)}: {rules.english[wrong[0]]}")
    if rules.proof == "pdr" or "Status: PASSED" not in said:
        raise Failed(f"{rules.path}: holds for {steps} steps, but is not proved\n{said[-2000:]}")
    return f"induction, {steps} steps"


def judge(root, name, solvers):
    """Proves one file and prints its verdicts."""
    rules = Rules(root, name)
    stem = build(rules, solvers)
    how = prove(rules, stem, solvers)
    said = solvers.smtbmc(stem, "-c", "-t", str(rules.steps))
    steps = dict(re.findall(r"Reached cover statement at (\w+) in step (\d+)", said))
    for label, english in rules.english.items():
        premise = f"; premise at step {steps.get('C' + label[1:], 'none')}" if label in rules.rules else ""
        print(f"{name} {label} proved ({how}{premise}): {english}")
    if len(steps) != len(rules.rules):
        raise Failed(f"{rules.path}: premises not reached in {rules.steps} steps: rules may say nothing\n{said[-500:]}")
    for fault in rules.faults:
        stem = build(rules, solvers, fault)
        found = solvers.refuted(stem, rules.steps)
        if not found:
            raise Failed(f"{rules.path}: with '{fault.what}' {fault.rule} still holds for {rules.steps} steps")
        print(f"{name} {found[0]} refuted at step {found[1]} with '{fault.what}': {solvers.trace(stem)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="all when none is given")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/formal", help="folder of models and traces")
    parser.add_argument("--limit", type=float, default=300, help="seconds that a solver may take")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    for program in ("yosys", "yosys-abc", "yosys-smtbmc", "z3"):
        if shutil.which(program) is None:
            skip(f"{program} is not installed")
    out = options.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    solvers = Solvers(out, options.limit)
    problems = []
    for name in options.names or sorted(f.stem for f in (options.root / FOLDER).glob("*.sv")):
        try:
            judge(options.root.resolve(), name, solvers)
        except Failed as failed:
            problems.append(str(failed))
    finish("proofs", problems)


if __name__ == "__main__":
    main()
