#!/usr/bin/env python3
"""Area of the RTL as Yosys maps it: area.py [--write | --memory].

The board and a MACRO IC are mapped twice, module by module: to generic gates (two-input cells, inverters, multiplexers
and flip-flops, after abc; a memory stays one and its bits are counted) and to a Lattice ECP5 (LUT4, carry cells,
flip-flops, block RAM). A chip's figure is the sum over its instances. No placing and routing, so there is no frequency.
docs/area.md is the table that --write makes; without it it goes to the standard output.
A memory that does not fill block RAM is an error: written another way it becomes half a million flip-flops. --memory
looks at that alone, for the dual-ported RAM, in a second.
Exit status 0, 1: a memory is no block RAM, 77: Yosys is not installed.
"""

import argparse
import collections
import pathlib
import re
import shutil
import subprocess
import sys

from common import ROOT, as_of, skip
from lint_rtl import SIMULATION_ONLY, rtl_files

TOPS = {"board_top": {"ServoIcMask": "18'h00003", "MacroIcMask": "4'h0"}, "macro_ic": {}}
ROWS = {
    "board_top": "Geo Brick LV, eight axes: two servo ICs and all host blocks",
    "servo_ic": "servo IC: registers, clocks, four channels",
    "servo_channel": "one of its four channels",
    "clock_gen": "its clock chain, the same in a MACRO IC",
    "macro_ic": "MACRO IC, clock part",
    "host_port": "host port HI08",
    "interrupt_controller": "interrupt controller",
    "isa_slave": "ISA bus",
    "dpram": "dual-ported RAM",
    "bus_sync": "Port A",
    "clock_select": "whose PHASE and SERVO the board takes",
    "watchdog": "watchdog",
    "ssi": "serial encoder inputs",
}

PREPARE = "proc; opt; opt_clean; stat"
# A memory becomes a cell of an unknown type, so that no pass maps it to flip-flops and none removes it.
GATES = ("memory -nomap; chtype -set \\memory_kept t:$mem*; opt -full; "
         "techmap; opt -fast; abc -g AND,OR,XOR,NAND,NOR,XNOR,ANDNOT,ORNOT,MUX; opt_clean; stat")
# What is still a memory after map_ram would be mapped to flip-flops.
MAP_RAM = "opt -full; synth_ecp5 -noflatten -top {top} -run begin:map_ffram; stat; select -assert-none t:$mem*; "
ECP5 = MAP_RAM + (
    "synth_ecp5 -noflatten -run map_ffram:map_luts; "
    "opt_merge; opt_clean; "  # mapping the flip-flops gives each an inverter of its own for the reset
    "synth_ecp5 -noflatten -run map_luts:check; stat")
BLOCK_BITS = 16384  # of a DP16KD, in words of 1, 2, 4, 8 or 16 bits

FLIP_FLOP = re.compile(r"\$_.*(DFF|FF_).*|TRELLIS_FF")
GATE = re.compile(r"\$_(AND|OR|XOR|NAND|NOR|XNOR|ANDNOT|ORNOT|MUX|NOT)_")
# LUTs that a cell takes: a carry cell is two with their carry; the wide multiplexers join LUTs and take none.
LUTS = {"LUT4": 1, "CCU2C": 2, "PFUMX": 0, "L6MUX21": 0}

Figures = collections.namedtuple("Figures", "cells flip_flops memory_bits blocks", defaults=[0])


def plain(name):
    """Name of a module in the sources: $paramod\\dpram\\Words=... and $paramod$1234\\dpram are both dpram."""
    if not name.startswith("$paramod"):
        return name.lstrip("\\")
    return name.split("\\")[1]


def statistics(log):
    """Every `stat` of a log in turn: {module: ({cell type: number}, memory bits)}."""
    found = []
    for text in re.split(r"Printing statistics\.", log)[1:]:
        modules = {}
        for part in re.split(r"\n=== (?=\S+ ===\n)", text)[1:]:
            name = part.split(" ===", 1)[0]
            rows = re.search(r"Number of cells:\s+\d+\n((?:\s{5,}\S+\s+\d+\n)*)", part)
            cells = {row.split()[0]: int(row.split()[1]) for row in rows.group(1).splitlines()} if rows else {}
            bits = re.search(r"Number of memory bits:\s+(\d+)", part)
            modules[name] = (cells, int(bits.group(1)) if bits else 0)
        found.append(modules)
    return found


def figures(log, weight):
    """{module in the sources: Figures of it with all that it holds}; `weight` counts a cell, None: it knows none."""
    before, *_, after = statistics(log)
    known = {}

    def total(module):
        if module not in known:
            cells, flip_flops, bits, blocks = 0, 0, before[module][1], 0
            for kind, number in after[module][0].items():
                if kind in after:
                    inner = total(kind)
                    so_far = (cells, flip_flops, bits, blocks)
                    cells, flip_flops, bits, blocks = (a + number * b for a, b in zip(so_far, inner, strict=True))
                elif kind == "DP16KD":
                    blocks += number
                elif FLIP_FLOP.fullmatch(kind):
                    flip_flops += number
                elif weight(kind) is not None:
                    cells += number * weight(kind)
                elif kind != "memory_kept":
                    raise ValueError(f"{plain(module)}: {kind} is neither logic nor a flip-flop")
            known[module] = Figures(cells, flip_flops, bits, blocks)
        return known[module]

    return {plain(module): total(module) for module in after if module in before}


def gates(log):
    return figures(log, lambda kind: 1 if GATE.fullmatch(kind) else None)


def ecp5(log):
    return figures(log, LUTS.get)


def memory_problems(log):
    """Modules whose memory fills no block RAM, from the statistics before and after map_ram."""
    for name in re.findall(r"ERROR: no valid mapping found for memory (\w+)", log):
        yield f"{name}: its memory fits no block RAM"
    if len(statistics(log)) < 2:
        return
    before, mapped = statistics(log)[:2]
    for module, (cells, bits) in before.items():
        after = mapped.get(module, (cells, bits))[0]
        blocks, least = after.get("DP16KD", 0), -(-bits // BLOCK_BITS)
        if any(kind.startswith("$mem") for kind in after) or blocks != least:
            yield f"{plain(module)}: a memory of {bits} bits takes {blocks} DP16KD; expected {least} and nothing else"


def yosys(root, top, mapping):
    packages, modules = rtl_files(root)
    sources = " ".join(str(f) for f in packages + modules if f.stem not in SIMULATION_ONLY)
    parameters = "".join(f"chparam -set {name} {value} {top}; " for name, value in TOPS.get(top, {}).items())
    script = (f"read_verilog -sv {sources}; {parameters}hierarchy -check -top {top}; {PREPARE}; " +
              mapping.format(top=top))
    print(f"{top} ...", file=sys.stderr, flush=True)
    done = subprocess.run(["yosys", "-p", script], cwd=root, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    if mapping != GATES:
        problems = list(memory_problems(done.stdout))
        if problems:
            sys.exit("\n".join(problems))
    if done.returncode != 0:
        sys.exit(f"{top}: {done.stdout[-2000:]}")
    return done.stdout


def page(generic, fpga, version):
    lines = [
        "<!-- Made by ./dev area (tools/area.py). Do not edit. -->",
        "# Area",
        "",
        f"What the RTL takes, by {version}, module by module and added up; a row holds all that is inside it.",
        "Gates: two-input gates, inverters and multiplexers. LUT: LUT4 of a Lattice ECP5, a carry cell counts as two.",
        "Block RAM: DP16KD of an ECP5, 16 kbit each; an ECP5-85 has 208.",
        "The same sources give the same figures; a change anywhere can move the LUTs of other modules by some percent.",
        f"Synthesis only, no placing and routing. Measured {as_of(ROOT)}.",
        "",
        "| module | | gates | flip-flops | memory bits | ECP5 LUT | ECP5 flip-flops | block RAM |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for name, text in ROWS.items():
        g, f = generic[name], fpga[name]
        numbers = (g.cells, g.flip_flops, g.memory_bits or "", f.cells, f.flip_flops, f.blocks or "")
        lines.append(f"| `{name}` | {text} | " + " | ".join(map(str, numbers)) + " |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--write", action="store_true", help="write docs/area.md")
    what.add_argument("--memory", action="store_true", help="see that the dual-ported RAM is block RAM, no more")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    if shutil.which("yosys") is None:
        skip("yosys is not installed")
    if options.memory:
        yosys(options.root, "dpram", MAP_RAM)
        print("dpram: block RAM")
        return
    version = subprocess.run(["yosys", "-V"], stdout=subprocess.PIPE, text=True).stdout.split(" (")[0].strip()
    generic, fpga = {}, {}
    for top in TOPS:
        generic = {**gates(yosys(options.root, top, GATES)), **generic}
        fpga = {**ecp5(yosys(options.root, top, ECP5)), **fpga}
    text = page(generic, fpga, version)
    if options.write:
        (options.root / "docs/area.md").write_text(text)
    else:
        print(text, end="")


if __name__ == "__main__":
    main()
