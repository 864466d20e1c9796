#!/usr/bin/env python3
"""What a change of the RTL does to the speed of its simulation: rtl_speed.py TREE [TREE ...]

Verilates the board with two servo ICs from rtl/ of each tree, as systemc/cosim does, and runs tools/rtl_speed.cpp on
it, quiet and busy. For each tree, and against the first one:
  instructions a tick (valgrind --tool=callgrind, exact: the difference of a long and a short run), and
  million ticks a second (best of --runs, all trees in turn).
A note says where the pins differ from those of the first tree. docs/simulation-speed.md holds results.
"""
import argparse
import os
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
VERILATE = ["-O3", "-fno-table", "--x-assign", "fast", "--x-initial", "unique",
            "-Wno-fatal", "-Wno-lint", "-Wno-style"]


def build(tree, folder, mask):
    """The executable of one tree."""
    rtl = tree / "rtl"
    listed = (rtl / "board_sim.f").read_text().splitlines()
    sources = [rtl / "verilate.vlt", *(rtl / line for line in listed if not line.startswith("//"))]
    command = ["verilator", "--cc", "--exe", "--build", "-j", "1", "--prefix", "Vboard_s2", "--top-module", "board_sim",
               f"-GServoIcMask=18'h{mask:X}", "-Mdir", folder, *VERILATE,
               "-CFLAGS", f"-O3 -std=c++17 -I{tree.resolve()}", "-MAKEFLAGS", "OPT_FAST=-O3 OPT_GLOBAL=-O3",
               *sources, HERE / "rtl_speed.cpp", "-o", "rtl_speed"]
    done = subprocess.run(command, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          env={**os.environ, "OBJCACHE": "ccache"})
    if done.returncode != 0:
        sys.exit(f"{tree}: verilator failed\n{done.stdout[-2000:]}")
    return folder.resolve() / "rtl_speed"


def run(command):
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return done.stdout.split(), done.stderr


def instructions(program, load, extra, folder):
    """Instructions a tick."""
    short, long = 10_000, 10_000 + 4 * 13_057  # a period of SERVO
    counts = []
    for ticks in (short, long):
        log = run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/callgrind.out", program, load,
                   str(ticks), *extra])[1]
        counts.append(int(re.search(r"Collected : (\d+)", log)[1]))
    return (counts[1] - counts[0]) / (long - short)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trees", nargs="+", type=Path)
    parser.add_argument("--build", type=Path, default=Path("build/rtl_speed"), help="where to build")
    parser.add_argument("--mask", type=lambda text: int(text, 0), default=3, help="servo ICs that are built, bit mask")
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--ticks", type=int, default=1_000_000)
    parser.add_argument("--second-eval", action="store_true", help="also the first tree with two evaluations a tick")
    options = parser.parse_args()
    rows = []
    for number, tree in enumerate(options.trees):
        folder = options.build / f"{number}_{tree.resolve().name}"
        folder.mkdir(parents=True, exist_ok=True)
        rows.append((tree.resolve().name, build(tree, folder, options.mask), [], folder))
    if options.second_eval:
        rows.append(("second evaluation", rows[0][1], ["second-eval"], rows[0][3]))
    print(f"{'':<24}{'quiet':>22}{'busy':>36}")
    speed = {}
    for _ in range(options.runs):
        for name, program, extra, _folder in rows:
            for load in ("quiet", "busy"):
                ticks, pins = run([program, load, str(options.ticks), *extra])[0]
                best, _pins = speed.get((name, load), (0, ""))
                speed[name, load] = (max(best, float(ticks) / 1e6), pins)
    first = {}
    for name, program, extra, folder in rows:
        text = f"{name:<24}"
        for load in ("quiet", "busy"):
            count = instructions(program, load, extra, folder)
            rate, pins = speed[name, load]
            count_1, rate_1, pins_1 = first.setdefault(load, (count, rate, pins))
            text += (f"{count:8.1f} instr ({100 * (count / count_1 - 1):+5.1f} %) "
                     f"{rate:5.2f} M/s ({100 * (rate / rate_1 - 1):+5.1f} %)"
                     f"{'' if pins == pins_1 else ' OTHER PINS'} ")
        print(text, flush=True)


if __name__ == "__main__":
    main()
