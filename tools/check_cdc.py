#!/usr/bin/env python3
"""Checks that nothing asynchronous feeds logic: check_cdc.py [--root ROOT].

Walks from each input pin of board_top, and of the chips that a board can be made of (docs/chips.md), and from each
flip-flop that a strobe clocks, through the logic to the flip-flops of clk_pwm_i and clk_ref_i. What is allowed stands
pin by pin in rtl/pins/board.pins, for the motor side in servo_ic.pins, for what a chip has of its own in the tables of
its name, `sampled`:
  synchroniser: its first flip-flop; it and its only load, the second one, carry the attribute async_reg
    (rtl/common/sync2.sv); nothing but a wire in front of it, or multiplexers that straps alone select (selected);
  a register that takes it for a reason: what it takes stands still when it counts;
  a flip-flop that it clocks, or resets; an output whose row says that it follows it.
A row that says more than the RTL does is a problem too, so the rows say what is. Exit status 0, 1: problems, 77: no
Yosys.
"""

import argparse
import collections
import fnmatch
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

from common import ROOT, finish, skip
from lint_rtl import SIMULATION_ONLY, rtl_files

sys.path.append(str(ROOT / "rtl/pins"))
from rows import Table

TOPS = {"board_top": "-set ServoIcMask 18'h00001 -set MacroIcMask 4'h1", "board_chip": "-set MacroIcMask 4'h1",
        "servo_ic_chip": ""}
CLOCKS = {"clk_pwm_i", "clk_ref_i"}
FLIP_FLOPS = ("$dff", "$adff", "$dffe", "$adffe", "$sdff", "$sdffe", "$aldff", "$dffsr")


def netlist(root, top):
    packages, modules = rtl_files(root)
    sources = " ".join(str(f) for f in packages + modules if f.stem not in SIMULATION_ONLY)
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "netlist.json"
        script = (f"read_verilog -sv {sources}; {f'chparam {TOPS[top]} {top};' if TOPS[top] else ''} "
                  f"hierarchy -check -top {top}; "
                  f"proc; setattr -mod -unset keep_hierarchy; flatten; opt_clean; write_json {out}")
        done = subprocess.run(["yosys", "-q", "-p", script], cwd=root, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            sys.exit(done.stdout[-2000:])
        return next(m for m in json.loads(out.read_text())["modules"].values() if "top" in m["attributes"])


class Rules:
    """What the rows allow, by port of a top."""

    def __init__(self, root, top):
        self.sampled, self.clocks, self.through = [], [], []
        self.synchronised, self.selected, self.resets = set(), set(), set()
        self.straps = set()
        self.motor = {}  # bit of motor_i: its name here
        self.borrowed = set()  # ports whose rows are those of another top: what they allow need not be needed
        servo = Table("servo_ic", root / "rtl/pins")
        for pin in servo.pins:
            if pin.is_input and pin.motor and top != "board_chip":
                self.motor |= dict.fromkeys(pin.motor_bits(), f"motor_i.{pin.name}")
                self.take(f"motor_i.{pin.name}", pin, servo.settings, "*.")
        board = Table("board", root / "rtl/pins")
        for pin in board.pins:
            if top == "servo_ic_chip":
                self.borrowed.add(pin.rtl)
            if top != "servo_ic_chip" or pin.name.startswith("pa_"):
                self.take(pin.rtl, pin, board.settings)
        if top != "board_top":
            own = Table(top, root / "rtl/pins")
            for pin in own.pins:
                self.take(pin.rtl, pin, own.settings)

    def take(self, name, pin, settings, inside=""):
        sets = {"synchroniser": self.synchronised, "selected": self.selected, "resets": self.resets}
        for kind, registers in pin.sampled:
            if kind in sets:
                sets[kind].add(name)
            elif kind == "clocks":
                self.clocks += [(name, pattern) for pattern in registers]
            elif kind == "through":
                self.through += [(name, pattern) for pattern in registers]
            elif pin.is_input:  # what an output is made of is check_outputs.py's
                self.sampled += [(name, inside + pattern, settings[f"reason {kind}"]) for pattern in registers]
                if kind == "strap":
                    self.straps.update(registers)

    def strap(self, register):
        """Stands still: a strap's register."""
        return any(fnmatch.fnmatch(register, pattern) for pattern in self.straps)

    def name(self, port, place):
        """Of a bit of a port: the motor side has a row for each pin."""
        return self.motor.get(place, port) if port == "motor_i" else port

    def row(self, rows, name, end):
        """The rows that allow this end of this port, or of an output this source."""
        return [row for row in rows if row[0] == name and fnmatch.fnmatch(end, row[1])]

    def all(self):
        """Each as check() notes what was needed."""
        for kind, names in (("synchroniser", self.synchronised), ("selected", self.selected),
                            ("resets", self.resets)):
            yield from ((kind, name) for name in names)
        yield from [*self.sampled, *self.clocks, *self.through]


class Walk:
    def __init__(self, module, strap=lambda name: False):
        self.names, self.marked = {}, set()
        for name, net in sorted(module["netnames"].items(), key=lambda n: (n[0].endswith("_q"), -len(n[0]), n[0])):
            for bit in net["bits"]:
                self.names[bit] = name.removeprefix("u_core.")  # a register's name wins, then the shortest
                if "async_reg" in net["attributes"]:
                    self.marked.add(bit)
        self.inputs = {n: p["bits"] for n, p in module["ports"].items() if p["direction"] == "input"}
        self.outputs = {bit: n for n, p in module["ports"].items() if p["direction"] == "output" for bit in p["bits"]}
        self.clocks = {bit for n in CLOCKS for bit in self.inputs[n]}
        self.loads = collections.defaultdict(list)  # bit -> (kind, cell, output bits)
        self.foreign = {}                           # outputs of flip-flops that no clock of ours works
        self.inverse = collections.defaultdict(list)
        self.data_of = collections.defaultdict(list)  # bit -> outputs of multiplexers that straps select
        for cell in module["cells"].values():
            pins = cell["connections"]
            if cell["type"] in FLIP_FLOPS:
                ours = pins["CLK"][0] in self.clocks
                for d, q in zip(pins["D"], pins["Q"], strict=True):
                    self.loads[d].append(("data" if ours else "strobed", q, pins["CLK"][0]))
                    if not ours:
                        self.foreign[q] = pins["CLK"][0]
                for pin in ("CLK", "ARST", "ALOAD"):
                    for bit in pins.get(pin, []):
                        self.loads[bit] += [(pin, q, None) for q in pins["Q"]]
                for pin in ("EN", "SRST", "AD"):
                    for bit in pins.get(pin, []):
                        self.loads[bit] += [("data", q, pins["CLK"][0]) for q in pins["Q"]]
            elif cell["type"].startswith("$mem"):
                for pin, bits in pins.items():
                    if not pin.endswith(("CLK", "RD_DATA")):
                        for bit in bits:
                            self.loads[bit].append(("memory", "memory", None))
            elif cell["type"] == "$not" and len(pins["A"]) == len(pins["Y"]):
                for a, y in zip(pins["A"], pins["Y"], strict=True):
                    self.inverse[a].append(y)
                    self.loads[a].append(("logic", [y], None))
            else:
                out = [b for pin, bits in pins.items() if cell["port_directions"][pin] == "output" for b in bits]
                select = {"$mux": "S", "$pmux": "S", "$shiftx": "B"}.get(cell["type"])
                if select and all(isinstance(b, str) or strap(self.names[b]) for b in pins[select]):
                    for bit in (b for pin in "AB" if pin != select for b in pins[pin]):
                        self.data_of[bit] += out
                for pin, bits in pins.items():
                    if cell["port_directions"][pin] == "input":
                        for bit in bits:
                            self.loads[bit].append(("logic", out, None))

    def ends(self, bit):
        """(kind, output bit of the flip-flop or port, clock) of everything that the bit reaches without a clock."""
        seen, todo, found = {bit}, [bit], set()
        while todo:
            at = todo.pop()
            if at in self.outputs:
                found.add(("output", self.outputs[at], None))
            for kind, target, clock in self.loads[at]:
                if kind == "logic":
                    fresh = [b for b in target if isinstance(b, int) and b not in seen]
                    seen.update(fresh)
                    todo += fresh
                else:
                    found.add((kind, target, clock))
        return found

    def selected(self, bit):
        """All that the bit reaches through multiplexers which straps select, if no other logic looks at any of it."""
        seen, todo = {bit}, [bit]
        while todo:
            at = todo.pop()
            passed = set(self.data_of[at])
            if any(not passed.issuperset(target) for kind, target, _ in self.loads[at] if kind == "logic"):
                return set()
            todo += passed - seen
            seen |= passed
        return seen

    def synchroniser(self, bit, selected, q, clock):
        """The bit, or its inverse, goes into a marked flip-flop whose only load is another of the same clock."""
        near = self.selected(bit) if selected else [bit, *self.inverse[bit]]
        straight = any(("data", q, clock) in self.loads[b] for b in near)
        second = self.loads[q]
        return (straight and q in self.marked and q not in self.outputs and len(second) == 1 and
                second[0][0] == "data" and second[0][2] == clock and second[0][1] in self.marked)


def check(module, rules):
    walk, used, problems = Walk(module, rules.strap), set(), set()
    sources = [(rules.name(name, place), bit) for name, bits in walk.inputs.items() if name not in CLOCKS
               for place, bit in enumerate(bits)]
    sources += [(walk.names[q], q) for q in walk.foreign]
    for name, bit in sources:
        strobed = bit in walk.foreign
        for kind, target, clock in walk.ends(bit):
            end = target if isinstance(target, str) else walk.names[target]
            selected = name in rules.selected
            if kind == "output":
                needs = rules.row(rules.through, end, name)
            elif kind == "strobed" and strobed:
                continue  # a toggle turns itself over
            elif kind == "CLK":
                needs = rules.row(rules.clocks, name, end)
            elif kind in ("ARST", "ALOAD"):
                needs = [("resets", name)] if name in rules.resets else []
            elif kind == "data" and walk.synchroniser(bit, selected, target, clock):
                if strobed:
                    continue
                needs = [("selected", name)] if selected else \
                    [("synchroniser", name)] if name in rules.synchronised else []
            else:
                needs = rules.row(rules.sampled, name, end)
            used.update(needs)
            if not needs:
                problems.add(f"{name} reaches {end} ({kind.lower()}); expected a synchroniser, rtl/common/sync2.sv, or "
                             "what its row in rtl/pins says of it")
    problems |= {f"{' '.join(row[:2])}: a row in rtl/pins allows it, nothing needs it"
                 for row in rules.all() if row not in used and rules.borrowed.isdisjoint(row[:2])}
    return len(sources), sorted(problems)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    if shutil.which("yosys") is None:
        skip("yosys is not installed")
    total, problems = 0, []
    for top in TOPS:
        number, found = check(netlist(options.root, top), Rules(options.root, top))
        total += number
        problems += found if top == "board_top" else [f"{top}: {problem}" for problem in found]
    finish(f"{total} asynchronous bits", problems)


if __name__ == "__main__":
    main()
