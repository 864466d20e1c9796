#!/usr/bin/env python3
"""Joints of the proofs: each assumption of testbench/formal names what guarantees it.

A comment line stands directly above an assume, and holds for those that follow it without another line between:
  // guarantee: ITEM; ITEM
An ITEM is one of
  power-on                     a run begins in reset with nothing asked for: a flag of the run's age, started_q or
                               awake_q, or its last value, || what is assumed before it is set, so that nothing is
                               assumed later; or flag ? later : before, where another item guarantees what comes later
  one reset                    `rst_ni == started_q`: resets behind the first are not in the proof (docs/formal.md)
  choice                       the assume narrows what is `(* anyconst *)`
  PROOF R1, R2                 rules of another file of proofs, which are proved without a bound
  PROOF R1, a clock before: X  the same, where the neighbour's output X, a flip-flop, carries it: what is assumed at an
                               edge rests on edges before
  CITATION, `cover`            a rule of the data sheet that outside pins keep, and the cover of the checker that has
                               judged them: results/covers.json has it, and it is not 0; of a list in braces each
A guarantee above other lines than an assume is one of a model of the neighbour, and is checked alike.

Fails on an assume without a guarantee, on an item that is none, and on a circle: rules that rest on each other without
a clock between. Exit status 0 clean, 1 not.
"""

import argparse
import pathlib
import re

import verification_plan
from check_citations import CITATION
from common import ROOT, finish

FOLDER = "testbench/formal"
GUARANTEE = re.compile(r"\s*// guarantee: (.+)$")
MORE = re.compile(r"\s*//   (\S.*)$")  # a line of it that goes on
ASSUME = re.compile(r"\bassume *\(")
YOUNG = re.compile(r"\bassume *\((started_q|awake_q)(?: == (\d+)'d(\d+))? (\|\|[^?]*|\?.*)\);")
ONE_RESET = re.compile(r"\bassume *\(rst_ni == started_q\);")
RULES = re.compile(r"(\w+) ((?:R\d+)(?:, R\d+)*)(?:, a clock before: (\w+))?$")
JUDGED = re.compile(rf"({CITATION.pattern}(?:, {CITATION.pattern})*), `([^`]+)`$")


def assumptions(text):
    """[(line, text of the assume or "", guarantee or "")] of a file, in its order; those of models have no text."""
    found, guarantee, used, lines = [], "", True, text.splitlines()
    number = 0
    while number < len(lines):
        said, code = GUARANTEE.match(lines[number]), re.sub(r"//.*", "", lines[number])
        if said:
            guarantee, used = said[1], False
            while number + 1 < len(lines) and (more := MORE.match(lines[number + 1])):
                guarantee, number = f"{guarantee} {more[1]}", number + 1
        elif ASSUME.search(code):
            first = number
            while ";" not in code and number + 1 < len(lines):  # an assume of several lines
                number += 1
                code += " " + re.sub(r"//.*", "", lines[number]).strip()
            found.append((first + 1, " ".join(code.split()), guarantee))
            used = True
        elif guarantee:
            if not used:
                found.append((number + 1, "", guarantee))
            guarantee = ""
        number += 1
    return found


class Joints:
    """The proofs of a tree, and what their assumptions rest on."""

    def __init__(self, root):
        self.root = root
        self.texts = {path.stem: path.read_text() for path in sorted((root / FOLDER).glob("*.sv"))}
        self.rules = {name: set(re.findall(r"^\s*(R\d+): assert", text, re.M)) for name, text in self.texts.items()}
        self.covers = verification_plan.counted(root)[1]
        self.edges = {name: set() for name in self.texts}  # what a proof rests on at the same edge

    def is_register(self, module, output):
        """An output of the RTL is a flip-flop, and nothing else."""
        text = "".join(path.read_text() for path in self.root.glob(f"rtl/**/{module}.sv"))
        source = re.search(rf"\bassign {output} += (\w+_q);", text)
        return bool(source) and bool(re.search(rf"\b{source[1]} +<= ", text))

    def is_last(self, name, flag, width, value):
        """The value at which a counter of the run's age stays: all ones, of its own width. A flag has none."""
        if value is None:
            return True
        own = re.search(rf"\blogic +\[(\d+):0\] {flag}\b", self.texts[name])
        return int(width) == (int(own[1]) if own else 0) + 1 and int(value) == 2 ** int(width) - 1

    def item(self, name, assume, item, others):
        """What is wrong with an item of a guarantee, or None."""
        if item == "power-on":
            form = YOUNG.search(assume)
            if not form or "->" in assume or not self.is_last(name, *form.groups()[:3]):
                return "power-on, but not of the form 'started_q || what is assumed before'"
            return "power-on, but what is assumed later has no guarantee" if form[4][0] == "?" and not others else None
        if item == "one reset":
            return None if ONE_RESET.search(assume) else "one reset, but not of the form 'rst_ni == started_q'"
        if item == "choice":
            free = set(re.findall(r"\(\* anyconst \*\) logic (?:\[[^\]]*\] )?(\w+)", self.texts[name]))
            named = set(re.findall(r"(?<!')\b[a-z]\w*", ASSUME.sub("", assume)))
            return None if named and named <= free else f"choice, but {', '.join(sorted(named - free))} is no anyconst"
        rules, judged = RULES.match(item), JUDGED.match(item)
        if rules:
            proof, labels, register = rules.groups()
            missing = [label for label in labels.split(", ") if label not in self.rules.get(proof, ())]
            if missing:
                return f"{proof} proves no {', '.join(missing)}"
            if register and not self.is_register(proof, register):
                return f"{proof}.{register} is no flip-flop"
            if not register:
                self.edges[name].add(proof)
            return None
        if judged:
            found = verification_plan.counts_of(judged[judged.re.groups], self.covers)
            silent = [cover for cover, count in found.items() if count == 0]
            return f"{silent[0]} has judged nothing ({verification_plan.COUNTED})" if silent else None
        return "expected power-on, one reset, choice, PROOF R1, or CITATION, `cover`"

    def circle(self):
        """Names of proofs that rest on each other at one edge, [] when there is none."""
        done = set()

        def from_here(name, way):
            if name in way:
                return [*way[way.index(name):], name]
            if name in done:
                return []
            for other in sorted(self.edges[name]):
                found = from_here(other, [*way, name])
                if found:
                    return found
            done.add(name)
            return []

        return next(filter(None, (from_here(name, []) for name in self.edges)), [])

    def problems(self):
        found, self.count = [], 0
        for name, text in self.texts.items():
            for number, assume, guarantee in assumptions(text):
                self.count += 1
                where = f"{FOLDER}/{name}.sv:{number}"
                if not guarantee:
                    found.append(f"{where}: no guarantee: {assume}")
                items = re.findall(r"(?:`[^`]*`|[^;`])+", guarantee)  # a list in a cover has such signs too
                items = [item.strip() for item in items]
                if len(ASSUME.findall(assume)) > 1:
                    found.append(f"{where}: expected one assume a line: {assume}")
                for item in items:
                    wrong = self.item(name, assume, item, len(set(items)) > 1)
                    if wrong:
                        found.append(f"{where}: '{item}': {wrong}")
        circle = self.circle()
        if circle:
            found.append(f"{FOLDER}: a circle without a clock of delay: {' rests on '.join(circle)}")
        return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    joints = Joints(parser.parse_args().root)
    problems = joints.problems()
    finish(f"joints, {joints.count} assumptions of {len(joints.texts)} proofs", problems)


if __name__ == "__main__":
    main()
