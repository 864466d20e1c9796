#!/usr/bin/env python3
"""Yosys' gates of the servo IC or of the board of two: netlist.py TOP FOLDER [--planted].

Writes FOLDER/TOP.v, two-input gates and flip-flops module by module with the ports of the RTL, and for board_top
FOLDER/board_sim.sv, which has it in the place of the RTL. The memory of the dual-ported RAM stays a block. A build with
-DBRICK_NETLIST=ON (preset netlist) Verilates these, so every test and bench in lock-step compares gates with the
SystemC model: ./dev netlist. --planted maps RTL with a comparison turned round, which they must find.
Exit status 1: Yosys failed, or the text that is to be replaced is not there; 77: Yosys is not installed.
"""

import argparse
import pathlib
import shutil
import subprocess
import sys

from common import ROOT, skip
from lint_rtl import SIMULATION_ONLY, rtl_files

SERVO_ICS, CHANNELS = 2, 4
TOPS = {"servo_ic": "", "board_top": f"chparam -set ServoIcMask 18'd{(1 << SERVO_ICS) - 1} board_top;"}
BLOCK = "dpram_memory"
GATES = ("proc; opt; memory; opt -full; techmap; opt -fast; "
         "abc -g AND,OR,XOR,NAND,NOR,XNOR,ANDNOT,ORNOT,MUX; opt_clean; "
         "select -assert-none t:$mem* t:$dlatch t:$adlatch t:$_DLATCH*; write_verilog -noattr")
# Of the counter of an encoder: what it takes for down is up.
PLANTED = ("servo_ic/channel_counter.sv", "down_i ?", "!down_i ?")

# A net of a module inside has a name that board_sim's loop cannot make.
COUNTER = "u_board.gen_servo_ic[i].gen_built.u_servo_ic.u_channels.gen_channel[n].u_channel.counter_o"
INSTANCE = "board_top #(.ServoIcMask(ServoIcMask), .MacroIcMask(MacroIcMask)) u_board ("
END = "endmodule : board_sim"


def replaced(text, old, new, where):
    if old not in text:
        sys.exit(f"netlist: {where} has no '{old}'")
    return text.replace(old, new, 1)


def counter(ic, channel):
    return (f"  assign counter[{CHANNELS * ic + channel}] = u_board.\\gen_servo_ic[{ic}].gen_built.u_servo_ic "
            f".u_channels.\\gen_channel[{channel}].u_channel .counter_o;\n")


def board_sim(root):
    where = root / "rtl/board/board_sim.sv"
    text = replaced(where.read_text(), COUNTER, "counter[4*i+n]", where)
    text = replaced(text, INSTANCE, "board_top u_board (", where)
    counters = "".join(counter(ic, channel) for ic in range(SERVO_ICS) for channel in range(CHANNELS))
    return replaced(text, END, "  logic [23:0] counter[72];\n" + counters + END, where)


def sources(root, folder, planted):
    """Packages and modules, the planted one as a copy in `folder`."""
    packages, modules = rtl_files(root)
    for file in packages + modules:
        if file.stem in SIMULATION_ONLY:
            continue
        if not planted or file != pathlib.Path("rtl") / PLANTED[0]:
            yield str(file)
            continue
        changed = folder / file.name
        changed.write_text(replaced((root / file).read_text(), PLANTED[1], PLANTED[2], file))
        yield str(changed)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("top", choices=TOPS)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--planted", action="store_true", help="of RTL with a fault")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    if shutil.which("yosys") is None:
        skip("yosys is not installed")
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    script = (f"read_verilog -sv {' '.join(sources(options.root, folder, options.planted))}; {TOPS[options.top]} "
              f"hierarchy -check -top {options.top}; blackbox {BLOCK}; {GATES} {folder / options.top}.v")
    done = subprocess.run(["yosys", "-q", "-p", script], cwd=options.root, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"netlist: {done.stdout[-2000:]}")
    if options.top == "board_top":
        (folder / "board_sim.sv").write_text(board_sim(options.root))


if __name__ == "__main__":
    main()
