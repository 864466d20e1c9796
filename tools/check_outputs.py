#!/usr/bin/env python3
"""Checks that an output is free of glitches for whoever looks at it at any time: check_outputs.py [--root ROOT].

Walks from each output pin of board_top, and of the chips that a board can be made of (docs/chips.md), back through the
logic to all that it is made of: flip-flops and pins. It is one flip-flop, whose two levels are all that ever shows. Two
of them that change with one edge in opposite directions show a level between that no clock knows. Straps stand still
and do not count. An output that is made of more has all of it in its row of rtl/pins, `sampled`:
  REASON SOURCES     flip-flops and pins, for a reason of the table why what shows between edges harms nobody
  through SOURCES    pins and strobes that it follows without a clock (tools/check_cdc.py)
Flip-flops of the reason `off` are turned off by the trip of the watchdog with its very edge: on a board that has one
what goes into them is made of it, too.
Pins of the group `inner` are on no card. A row that says more than the RTL does is a problem too. Exit status 0, 1:
problems, 77: no Yosys.
"""

import argparse
import fnmatch
import pathlib
import shutil

from check_cdc import FLIP_FLOPS, TOPS, Rules, Walk, netlist
from common import ROOT, finish, skip
from rows import Table

TRIP = "u_watchdog.trip_q"
BITWISE = {"$and", "$or", "$xor", "$xnor", "$not", "$pos", "$mux"}  # bit i of the output is of bits i of the inputs


class Sources:
    """What each bit of a netlist is made of, as far as the next flip-flops and pins."""

    def __init__(self, module, walk, strap):
        self.pins = {bit: port for port, bits in walk.inputs.items() for bit in bits}
        self.names, self.strap = walk.names | self.pins, strap
        self.driver = {}  # bit -> (cell, place in its output)
        for cell in module["cells"].values():
            for pin, bits in cell["connections"].items():
                if cell["port_directions"][pin] == "output":
                    self.driver |= {bit: (cell, place) for place, bit in enumerate(bits)}

    def inputs(self, cell, place):
        for pin, bits in cell["connections"].items():
            if cell["port_directions"][pin] == "input":
                whole = cell["type"] not in BITWISE or pin == "S" or len(bits) != len(cell["connections"]["Y"])
                yield from bits if whole else [bits[place]]

    def of(self, bit):
        """Bits of flip-flops and pins, but straps'."""
        seen, todo, found = set(), [bit], set()
        while todo:
            at = todo.pop()
            if at in seen or isinstance(at, str):
                continue
            seen.add(at)
            cell, place = self.driver.get(at, (None, 0))
            if cell and cell["type"] not in FLIP_FLOPS and not cell["type"].startswith("$mem"):
                todo += self.inputs(cell, place)
            elif not self.strap(self.names[at]):
                found.add(at)
        return found


    def into(self, bit):
        """Names of what goes into a flip-flop with the next edge."""
        cell, place = self.driver[bit]
        return {self.names[one] for one in self.of(cell["connections"]["D"][place])}


class Rows:
    """Rows of the output pins of a top."""

    def __init__(self, root, top):
        folder = root / "rtl/pins"
        self.motor = {bit: pin for pin in Table("servo_ic", folder).outputs() if pin.group in ("channel", "serial")
                      for bit in pin.motor_bits()}
        self.pins = [*(Table(top, folder).outputs() if top != "board_top" else []), *Table("board", folder).outputs()]

    def of(self, port, place):
        """(name of the bit here, its rows)"""
        rows = [pin for pin in self.pins if pin.rtl == port and pin.rtl_bit in (None, place)]
        if port == "motor_o" and place in self.motor:
            pin = self.motor[place]
            return f"{port}.{pin.name}", [pin, *rows]
        return port, rows


def allowed(rows, source):
    """The rows and patterns that name a source: registers of a channel stand there without the way to it."""
    return {(pin.name, kind, pattern) for pin in rows for kind, patterns in pin.sampled for pattern in patterns
            if fnmatch.fnmatch(source, pattern) or fnmatch.fnmatch(source, f"*.{pattern}")}


def check(module, root, top, used):
    rules = Rules(root, top)
    walk, rows, number, problems = Walk(module, rules.strap), Rows(root, top), 0, set()
    sources = Sources(module, walk, rules.strap)
    for port, pins in module["ports"].items():
        if pins["direction"] != "output":
            continue
        for place, bit in enumerate(pins["bits"]):
            name, found = rows.of(port, place)
            made = sources.of(bit)
            if any(pin.group == "inner" for pin in found):
                continue
            number += 1
            if len(made) == 1 and not made & sources.pins.keys():
                continue
            needs = {sources.names[one]: allowed(found, sources.names[one]) for one in made}
            used.update(*needs.values())
            late = sorted(sources.names[one] for one in made - sources.pins.keys() if top == "board_top" and
                          any(kind == "off" for _, kind, _ in needs[sources.names[one]]) and
                          TRIP not in sources.into(one))
            problems |= {f"{name}: {source} may rise with the edge of a trip; expected that {TRIP} turns it off with it"
                         for source in late}
            unsaid = sorted(source for source, needed in needs.items() if not needed)
            if unsaid:
                problems.add(f"{name} is made of {len(made)} level(s), {', '.join(unsaid)} among them; expected one "
                             "flip-flop, or that its row in rtl/pins says why not")
    return number, sorted(problems)


def unused(root, used):
    """Rows that allow an output what it is not made of; `through` is check_cdc's."""
    for name in ("board", "servo_ic", *(top for top in TOPS if top != "board_top")):
        for pin in Table(name, root / "rtl/pins").outputs():
            for kind, patterns in pin.sampled:
                yield from (f"{pin.name} {kind} {pattern}: a row in rtl/pins allows it, nothing needs it"
                            for pattern in patterns if kind != "through" and (pin.name, kind, pattern) not in used)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    if shutil.which("yosys") is None:
        skip("yosys is not installed")
    total, problems, used = 0, [], set()
    for top in TOPS:
        number, found = check(netlist(options.root, top), options.root, top, used)
        total += number
        problems += found if top == "board_top" else [f"{top}: {problem}" for problem in found]
    finish(f"{total} output bits", problems + list(unused(options.root, used)))


if __name__ == "__main__":
    main()
