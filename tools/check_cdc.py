#!/usr/bin/env python3
"""Checks that nothing asynchronous feeds logic: check_cdc.py [--root ROOT].

Walks from each input pin of board_top, and from each flip-flop that a strobe clocks, through the logic to the
flip-flops of clk_pwm_i and clk_ref_i. Allowed ends are:
  the first flip-flop of a synchroniser: it and its only load, the second one, carry the attribute async_reg
    (rtl/common/sync2.sv); nothing but a wire in front of it, or what a jumper selects (SELECTED);
  a register in SAMPLED: what it takes stands still when it counts, each with its reason;
  a flip-flop that an input of STROBES clocks, or that an input of RESETS resets; an output in THROUGH.
An entry that nothing needs is a problem too, so the tables say what is. Exit status 0, 1: problems, 77: no Yosys.
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

TOP = "board_top"
CLOCKS = {"clk_pwm_i", "clk_ref_i"}
BUS = "stands from before the fall of the strobe to its end; it counts when that has come through two flip-flops"
ISA = "stands around the command strobe, which has come through two flip-flops when it counts"
STRAP = "a jumper or a kind of board: it does not move while power is on"
# input, registers that sample it, reason
SAMPLED = [
    ("pa_addr_i", "u_bus_sync.where_q", BUS),
    ("pa_x_i", "u_bus_sync.where_q", BUS),
    ("pa_aa_i", "u_bus_sync.where_q", BUS),
    ("pa_int_i", "u_bus_sync.where_q", BUS),
    ("pa_wdata_i", "u_bus_sync.wdata_q", BUS),
    ("pa_aa_i", "u_bus_strobes.*", "stands before the strobe falls, which clocks it"),
    ("pa_int_i", "u_bus_strobes.*", "stands before the strobe falls, which clocks it"),
    ("pa_addr_i", "u_dpram.pins_q", BUS),
    ("pa_x_i", "u_dpram.pins_q", BUS),
    ("pa_aa_i", "u_dpram.sel_q", BUS),
    ("pa_int_i", "u_dpram.sel_q", BUS),
    ("pa_wdata_i", "u_dpram.wdata_q", BUS),
    ("isa_sa_i", "u_isa_slave.sa_q", ISA),
    ("isa_aen_i", "u_isa_slave.aen_q", ISA),
    ("isa_sbhe_ni", "u_isa_slave.sbhe_nq", ISA),
    ("io_base_i", "u_isa_slave.io_base_q", STRAP),
    ("io_decode16_i", "u_isa_slave.io_decode16_q", STRAP),
    ("window_i", "u_isa_slave.window_q", STRAP),
    ("window_flat_i", "u_isa_slave.window_flat_q", STRAP),
    ("slot8_i", "u_isa_slave.slot8_q", STRAP),
    ("fitted_i", "fitted_q", STRAP),
    ("dpram_small_i", "dpram_small_q", STRAP),
    ("jpan_fitted_i", "jpan_fitted_q", STRAP),
    ("ext_clock_i", "ext_clock_q", STRAP),
    ("line_select_i", "line_select_q", STRAP),
    ("pic_8259_i", "pic_8259_q", STRAP),
    ("motor_i", "*.u_adc_[ab].*", "changes with the fall of ADC_CLK, is taken at its rise"),
]
# Inputs that reach their synchroniser through a multiplexer that only a jumper moves.
SELECTED = {"mi1_i", "mi2_i", "axexp0_i", "axexp1_i", "isa_la_i", "isa_sa_i"}
# Strobes clock and hold flip-flops; they and the reset act without a clock.
STROBES = {"pa_rd_ni": "u_*_strobes.rd_q", "pa_wr_ni": "u_*_strobes.wr_q"}
RESETS = {"rst_pin_ni", "pa_rd_ni"}
# Outputs that follow a strobe or an address without a clock.
THROUGH = {"pa_ta_n_o", "pa_data_o", "pa_data_oe_o", "isa_sd_oe_o"}

FLIP_FLOPS = ("$dff", "$adff", "$dffe", "$adffe", "$sdff", "$sdffe", "$aldff", "$dffsr")


def netlist(root):
    packages, modules = rtl_files(root)
    sources = " ".join(str(f) for f in packages + modules if f.stem not in SIMULATION_ONLY)
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "netlist.json"
        script = (f"read_verilog -sv {sources}; chparam -set ServoIcMask 18'h00001 {TOP}; hierarchy -check -top {TOP}; "
                  f"proc; flatten; opt_clean; write_json {out}")
        done = subprocess.run(["yosys", "-q", "-p", script], cwd=root, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            sys.exit(done.stdout[-2000:])
        return next(m for m in json.loads(out.read_text())["modules"].values() if "top" in m["attributes"])


class Walk:
    def __init__(self, module):
        self.names, self.marked = {}, set()
        for name, net in sorted(module["netnames"].items(), key=lambda n: (n[0].endswith("_q"), -len(n[0]), n[0])):
            for bit in net["bits"]:
                self.names[bit] = name  # the name of a register wins, then the shortest
                if "async_reg" in net["attributes"]:
                    self.marked.add(bit)
        self.inputs = {n: p["bits"] for n, p in module["ports"].items() if p["direction"] == "input"}
        self.outputs = {bit: n for n, p in module["ports"].items() if p["direction"] == "output" for bit in p["bits"]}
        self.clocks = {bit for n in CLOCKS for bit in self.inputs[n]}
        self.loads = collections.defaultdict(list)  # bit -> (kind, cell, output bits)
        self.foreign = {}                           # outputs of flip-flops that no clock of ours works
        self.inverse = collections.defaultdict(list)
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

    def synchroniser(self, bit, selected, q, clock):
        """The bit, or its inverse, goes into a marked flip-flop whose only load is another of the same clock."""
        straight = selected or any(("data", q, clock) in self.loads[b] for b in [bit, *self.inverse[bit]])
        second = self.loads[q]
        return (straight and q in self.marked and q not in self.outputs and len(second) == 1 and
                second[0][0] == "data" and second[0][2] == clock and second[0][1] in self.marked)


def check(module):
    walk, used, problems = Walk(module), set(), set()
    sources = [(name, bit) for name, bits in walk.inputs.items() if name not in CLOCKS for bit in bits]
    sources += [(walk.names[q], q) for q in walk.foreign]
    for name, bit in sources:
        strobed = bit in walk.foreign
        for kind, target, clock in walk.ends(bit):
            end = target if isinstance(target, str) else walk.names[target]
            if kind == "output":
                allowed = end in THROUGH
                used.add(end)
            elif kind == "strobed" and strobed:
                allowed = True  # a toggle turns itself over
            elif kind == "CLK":
                allowed = fnmatch.fnmatch(end, STROBES.get(name, ""))
                used.add(name)
            elif kind in ("ARST", "ALOAD"):
                allowed = name in RESETS
                used.add(name)
            elif kind == "data" and walk.synchroniser(bit, name in SELECTED, target, clock):
                allowed = True
                used.update({"synchroniser", name})
            else:
                rows = [row for row in SAMPLED if fnmatch.fnmatch(name, row[0]) and fnmatch.fnmatch(end, row[1])]
                allowed = bool(rows)
                used.update(rows)
            if not allowed:
                problems.add(f"{name} reaches {end} ({kind.lower()}); expected a synchroniser, rtl/common/sync2.sv")
    wanted = [*SAMPLED, *SELECTED, *STROBES, *RESETS, *THROUGH, "synchroniser"]
    problems |= {f"{row}: tools/check_cdc.py allows it, nothing needs it" for row in wanted if row not in used}
    return len(sources), sorted(problems)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    if shutil.which("yosys") is None:
        skip("yosys is not installed")
    number, problems = check(netlist(options.root))
    finish(f"{number} asynchronous bits", problems)


if __name__ == "__main__":
    main()
