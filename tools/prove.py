#!/usr/bin/env python3
"""Proves the rules of testbench/formal/NAME.sv: prove.py [NAME...] [--out DIR] [--limit SECONDS] [--quick]
[--only rules|faults].

A file holds the module NAME_rules: the design under test, assumptions, and numbered rules in English, each above its
assert, each with a cover of its premise. Its header says how, in comment lines:
  proof: pdr | induction N   property directed reachability (yosys-abc), or base case and step of N (z3)
  clocks: one | several      several: every clock is a signal that the file makes, time runs in steps of its own
  steps: N                   within which premises are reached and faults refuted
  edit: what and why (FILE)  an edit of the RTL for the proof, such as a shallower memory; its text as of a fault
  free: MODULE, MODULE       taken out of the design: whatever these might do, the rules hold
  fault RULE: what is wrong (FILE), then '  - old text' and '  + new text': with that edit this rule, judged
                             alone, must be refuted; the waveform is DIR/NAME.fault.RULE.vcd
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
COMMON = f"{FOLDER}/common"  # modules that several files of rules have: clocks, lines
Edit = collections.namedtuple("Edit", "rule what file old new")

# Memories become flip-flops and asynchronous inputs synchronous ones, as the back ends want it.
PREPARE = {"one": "memory_map; opt -full; async2sync; dffunmap",
           "several": "memory_collect; opt -full; clk2fflogic; memory_map -formal; opt -full"}
# The clocks of a file with several repeat after six steps (common/proof_clocks.sv). Six steps made one, each with the
# rule at its end, have no clock left in them, and pdr is ten times as fast.
AT_ONCE = {"one": 1, "several": 6}
REDUCE = {"one": "scleanup; scorr; dc2; scleanup",
          "several": f"scleanup; scorr; dc2; phase -F {AT_ONCE['several']}; scorr; dc2; scleanup"}
# A cover as an assert that it is not reached, so that one search does for both.
COVER = """(* techmap_celltype = "$cover" *) module cover_as_assert (input A, input EN);
  \\$assert _TECHMAP_REPLACE_ (.A(~A), .EN(EN));
endmodule
"""


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
        self.covers = [f"C{label[1:]}" for label in self.rules]
        self.proof = self.setting("proof", r"pdr|induction \d+")
        self.clocks = self.setting("clocks", "one|several")
        self.steps = int(self.setting("steps", r"\d+"))
        found = re.findall(r"^// (?:fault )?(edit|R\d+): (.*) \((\S+)\)\n//   - (.*)\n//   \+ ?(.*)\n", self.text, re.M)
        self.faults = [Edit(*row) for row in found if row[0] != "edit"]
        self.edits = [Edit(*row) for row in found if row[0] == "edit"]
        self.free = re.findall(r"\w+", " ".join(re.findall(r"^// free: (.*)$", self.text, re.M)))
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
        if sorted(covers) != sorted(self.covers):
            raise Failed(f"{self.path}: rules {self.rules} need one cover each, has {covers}")
        if not self.faults or len(self.faults) != len(re.findall(r"^// fault ", self.text, re.M)):
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
            raise Failed(f"{command[0]}: no answer within {self.limit:g} s") from late
        return done.stdout

    def abc(self, stem, label, commands):
        """What yosys-abc says of one rule or cover, and the step at which it is refuted or reached, None: it is not."""
        name = f"{stem}.{label}"
        said = self.run("yosys-abc", "-c", f"read_aiger {name}.aig; fold; strash; {commands}; write_cex -a {name}.aiw")
        found = re.search(r"was asserted in frame (\d+)", said)
        return said, int(found.group(1)) if found else None

    def search(self, stem, label, steps):
        said, step = self.abc(stem, label, f"bmc3 -F {steps}")
        if step is None and "No output asserted" not in said:
            raise Failed(f"{stem}: search for {label} gave no verdict\n{said[-2000:]}")
        return step

    def smtbmc(self, stem, *options):
        return self.run("yosys-smtbmc", "-s", "z3", "--unroll", "--noprogress", *options, f"{stem}.smt2")

    def trace(self, stem, label):
        """Waveform of what abc() found last, replayed on the whole model."""
        name = f"{stem}.{label}"
        said = self.smtbmc(stem, "--aig", f"{name}.aim:{name}.aiw", "--aig-noheader", "--dump-vcd", f"{name}.vcd")
        if not re.search(rf"Assert failed in \S+: {label}$", said, re.M):
            raise Failed(f"{name}: the trace does not show the fault\n{said[-2000:]}")
        return os.path.relpath(self.out / f"{name}.vcd")


def build(rules, solvers, fault=None):
    """Models of the design: .smt2 with all rules, an .aig of each rule and cover; with a fault both are of its rule and
    what that one looks at, alone."""
    packages, modules = rtl_files(rules.root)
    sources = {str(f): rules.root / f for f in packages + modules if f.stem not in SIMULATION_ONLY}
    stem = f"{rules.name}.fault" if fault else rules.name
    for edit in rules.edits + ([fault] if fault else []):
        text = sources[edit.file].read_text() if edit.file in sources else ""
        if text.count(edit.old) != 1:
            raise Failed(f"{rules.path}: '{edit.old}' occurs {text.count(edit.old)} times in {edit.file}, not once")
        sources[edit.file] = solvers.out / f"{stem}.{pathlib.Path(edit.file).name}"
        sources[edit.file].write_text(text.replace(edit.old, edit.new))
    labels = [fault.rule] if fault else [*rules.english, *rules.covers]
    alone = f"delete t:$assert t:$cover %u */{fault.rule} %d;" if fault else ""
    (solvers.out / f"{stem}.cover.v").write_text(COVER)  # other proofs are made beside this one
    expose = "setundef -undriven -expose;" if rules.free else ""  # what is free has a name in traces
    script = [f"read_verilog -sv -formal -defer {' '.join(map(str, sources.values()))}",
              *(f"read_verilog -sv -formal -defer {path}" for path in sorted((rules.root / COMMON).glob("*.sv"))),
              f"read_verilog -sv -formal {rules.root / rules.path}; hierarchy -check -top {rules.name}_rules",
              *(f"select -assert-min 1 t:{module}; delete t:{module}" for module in rules.free),
              f"proc -norom; setattr -mod -unset keep_hierarchy; flatten; {alone} opt_clean",
              f"{expose} setundef -undriven -anyseq; {PREPARE[rules.clocks]}; opt_clean",
              f"write_smt2 -wires {stem}.smt2",
              f"techmap -map {stem}.cover.v; techmap; abc -g AND -fast; opt_clean; design -save m"]
    for label in labels:
        script.append(f"design -load m; delete t:$assert */{label} %d; opt_clean; "
                      f"write_aiger -zinit -no-startoffset -map {stem}.{label}.aim {stem}.{label}.aig")
    model = solvers.out / f"{stem}.smt2"
    model.unlink(missing_ok=True)
    said = solvers.run("yosys", "-q", "-p", "; ".join(script))
    asserted = re.findall(r"^; yosys-smt2-assert \d+ (\S+)", model.read_text() if model.exists() else "", re.M)
    if re.search(r"^ERROR", said, re.M) or sorted(asserted) != sorted([fault.rule] if fault else rules.english):
        raise Failed(f"{rules.path}: Yosys made no model of all rules, but of {asserted}\n{said[-2000:]}")
    return stem


def reached(rules, solvers):
    """{cover: step}; raises where one is out of reach."""
    steps = {label: solvers.search(rules.name, label, rules.steps) for label in rules.covers}
    out_of_reach = [label for label, step in steps.items() if step is None]
    if out_of_reach:
        raise Failed(f"{rules.path}: premises {out_of_reach} not reached in {rules.steps} steps: rules may say nothing")
    return steps


def refuted(rules, solvers, label, steps):
    """Where a rule is that pdr refutes within `steps`: found once more, in steps of one, for the waveform. That takes
    longer, and its end does not undo the verdict."""
    try:
        step = solvers.search(rules.name, label, steps)
        if step is None:
            raise Failed("bmc3 finds it nowhere")
        return f"at step {step}, see {solvers.trace(rules.name, label)}"
    except Failed as failed:
        return f"within {steps} steps, without a waveform ({str(failed).splitlines()[0]})"


def prove(rules, solvers):
    """{rule: how it was proved}; raises where one was not."""
    how = {}
    for label in rules.english if rules.proof == "pdr" else ():
        said, step = solvers.abc(rules.name, label, f"{REDUCE[rules.clocks]}; pdr")
        if step is not None:
            where = refuted(rules, solvers, label, (step + 1) * AT_ONCE[rules.clocks])
            raise Failed(f"{rules.path}: {label} refuted {where}: {rules.english[label]}")
        if "Property proved." not in said:
            raise Failed(f"{rules.path}: {label} is not proved\n{said[-2000:]}")
        frames = re.search(r"Invariant F\[(\d+)\]", said)
        how[label] = f"pdr, {frames.group(1)} frames" if frames else "pdr"
    if rules.proof != "pdr":
        steps = rules.proof.split()[1]
        for name, options in (("base", ()), ("step", ("-i",))):
            vcd = f"{rules.name}.{name}.vcd"
            said = solvers.smtbmc(rules.name, "-t", steps, *options, "--dump-vcd", vcd)
            if "Status: PASSED" not in said:
                failed = re.findall(r"Assert failed in \S+: (\w+)", said)
                raise Failed(f"{rules.path}: induction of {steps} steps fails in its {name} at {failed}, "
                             f"see {os.path.relpath(solvers.out / vcd)}\n{said[-500:]}")
        how = dict.fromkeys(rules.english, f"induction, {steps} steps")
    return how


def judge_rules(rules, solvers):
    """Proves them, reaches their premises, and prints the verdicts."""
    build(rules, solvers)
    how = prove(rules, solvers)
    steps = reached(rules, solvers)
    for label, english in rules.english.items():
        premise = f"; premise at step {steps['C' + label[1:]]}" if label in rules.rules else ""
        print(f"{rules.name} {label} proved ({how[label]}{premise}): {english}")


def judge_faults(rules, solvers, quick):
    """Each is refuted; prints where, and with which waveform."""
    for fault in rules.faults:
        stem = build(rules, solvers, fault)
        step = solvers.search(stem, fault.rule, rules.steps)
        if step is None:
            raise Failed(f"{rules.path}: with '{fault.what}' {fault.rule} still holds for {rules.steps} steps")
        shown = "" if quick else f": {solvers.trace(stem, fault.rule)}"
        print(f"{rules.name} {fault.rule} refuted at step {step} with '{fault.what}'{shown}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="all when none is given")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/formal", help="folder of models and traces")
    parser.add_argument("--limit", type=float, default=300, help="seconds that a solver may take")
    parser.add_argument("--quick", action="store_true", help="no waveforms of planted faults")
    parser.add_argument("--only", choices=("rules", "faults"), help="rules and premises, or planted faults")
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
            rules = Rules(options.root.resolve(), name)
            if options.only != "faults":
                judge_rules(rules, solvers)
            if options.only != "rules":
                judge_faults(rules, solvers, options.quick)
        except Failed as failed:
            problems.append(str(failed))
    finish("proofs", problems)


if __name__ == "__main__":
    main()
