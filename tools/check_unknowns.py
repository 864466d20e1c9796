#!/usr/bin/env python3
"""No unknown level after reset: Icarus, which knows four states, runs blocks of the RTL with random pins.

check_unknowns.py [TOP...] [--seed N] [--clocks N]. Each top of TOPS is built from its list rtl/TOP.f; flip-flops begin
unknown, its inputs are random from the start, a reset ends, and every pin moves at random from then on. From the end of
the reset an output (a port NAME_o) of any module in it that is x or z is a fault, named with its time. Memories have no
reset: those of MEMORIES, named with the registers of what they read, begin with random words instead.
Straps, KEPT and clocks do not move at random. Too few outputs that have moved (LEAST) are a fault: nothing was tried.
Exit status 0 clean, 1 not, 77 Icarus is not installed.
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from common import ROOT, finish, skip

# Top: its parameters, and the inputs that stand while it runs (straps).
TOPS = {
    "servo_ic": ({}, ()),
    "board_top": ({"ServoIcMask": "18'h00001", "MacroIcMask": "4'h1"},
                  ("macro_gate_i", "dpram_small_i", "jpan_fitted_i", "line_select_i", "pic_8259_i", "ssi_kind_i",
                   "io_base_i", "io_decode16_i", "window_i", "window_flat_i", "slot8_i", "ext_clock_i")),
}
# Top: the share of its outputs that has to move. The serial parts of the board need longer; a still Port A leaves 0.31.
LEAST = {"servo_ic": 0.75, "board_top": 0.4}
# Top: memory in it, words, and the registers of what it read last.
MEMORIES = {"board_top": [("u_core.u_dpram.u_memory", 32768, ("a_rdata_o", "b_rdata_o"))]}
RESETS = {"rst_ni": 0, "rst_pin_ni": 0, "isa_resetdrv_i": 1}  # the level that resets
# A trip would hold everything still.
KEPT = {"trip_i": "0", "trip_d_i": "0", "pwr_good_i": "1", "fitted_i": "22'h3FFFFF"}
# Top: who drives its buses, cycle by cycle, so that something is written and read: the gate ICs, the latches, the
# CPU's page, the dual-ported RAM, anything; the host's I/O block and memory.
MASTERS = {"board_top": """
  initial forever begin
    {pa_int_i, pa_aa_i, pa_addr_i} = {$random(seed), $random(seed)};
    case ($random(seed) & 7)
      0, 1, 2: {pa_int_i, pa_aa_i, pa_addr_i} = {1'b0, 4'h2, 19'h78000 | 19'($random(seed) & 19'h1F)};
      3: {pa_int_i, pa_aa_i, pa_addr_i} = {1'b0, 4'h0, 19'h70010 | 19'($random(seed) & 19'h3)};
      4: {pa_int_i, pa_aa_i, pa_addr_i} = {1'b1, 4'h0, 19'($random(seed) & 19'h7F)};
      5: {pa_int_i, pa_aa_i, pa_addr_i} = {1'b0, 4'h4, 19'($random(seed) & 19'h3F)};
      6: {pa_int_i, pa_aa_i, pa_addr_i} = {1'b0, 4'h2, 19'h78400 | 19'($random(seed) & 19'h3F)};
      default: ;
    endcase
    pa_x_i = $random(seed); pa_wdata_i = $random(seed);
    #24 {pa_rd_ni, pa_wr_ni} = $random(seed) & 1 ? 2'b01 : 2'b10;
    #120 {pa_rd_ni, pa_wr_ni} = 2'b11;
    #48;
  end
  initial forever begin
    {isa_aen_i, isa_sbhe_ni, isa_la_i, isa_sa_i, isa_sd_i} = {$random(seed), $random(seed)};
    if ($random(seed) & 1) {isa_aen_i, isa_sa_i} = {1'b0, 8'h0, io_base_i, 4'h0} | ($random(seed) & 20'hF);
    else {isa_la_i, isa_sa_i[16:14]} = window_i;
    #120 {isa_ior_ni, isa_iow_ni, isa_memr_ni, isa_memw_ni} = ~(4'h1 << ($random(seed) & 3));
    #480 {isa_ior_ni, isa_iow_ni, isa_memr_ni, isa_memw_ni} = 4'hF;
    #96;
  end
"""}
PORT = re.compile(r"^  (input|output) +(?:wire )?logic +(\[[^\n]*\])? *(\w+_n?[io])\b,?", re.M)


def bench(top, text, seed, clocks):
    """A test bench of the top: clocks, a reset, random pins, a dump from the end of the reset on."""
    parameters, straps = TOPS[top]
    inputs = [(width, name) for way, width, name in PORT.findall(text) if way == "input"]
    resets = {name: RESETS[name] for _, name in inputs if name in RESETS}
    moving = [name for _, name in inputs if not name.startswith("clk_") and name not in (*straps, *resets, *KEPT)
              and not re.search(rf"\b{name}\b", MASTERS.get(top, ""))]
    passed = ", ".join(f".{name}({name})" for name in parameters)
    fill = [f"    for (i = 0; i < {words}; i = i + 1) dut.{memory}.mem[i] = $random(seed);\n"
            + "".join(f"    dut.{memory}.{register} = $random(seed);\n" for register in registers)
            for memory, words, registers in MEMORIES.get(top, [])]
    random = {name: f"{name} = " + "{" + ", ".join(["$random(seed)"] * wide(width)) + "};"
              for width, name in inputs}
    lines = [
        "module tb;",
        *(f"  parameter {name} = {value};" for name, value in parameters.items()),
        *(f"  logic {width} {name} = 0;" for width, name in inputs),
        *(f"  wire {width} {name};" for way, width, name in PORT.findall(text) if way == "output"),
        f"  {top} {f'#({passed}) ' if passed else ''}dut (.*);",
        "  integer seed, i;",
        "  always #4 clk_pwm_i = ~clk_pwm_i;",
        "  always #12 clk_ref_i = ~clk_ref_i;",
        "  initial begin",
        f"    seed = {seed};",
        *fill,
        *(f"    {name} = {level};" for name, level in KEPT.items() if name in {n for _, n in inputs}),
        *(f"    {random[name]}" for _, name in inputs if name in straps or name in moving),
        *(f"    {name} = -1;" for _, name in inputs if re.search("_n?[rw][dr]?_ni$|_io[rw]_ni$|_mem[rw]_ni$", name)),
        *(f"    {name} = {level};" for name, level in resets.items()),
        "    #100;",
        *(f"    {name} = {1 - level};" for name, level in resets.items()),
        "    #1 $dumpfile(\"unknowns.vcd\");",
        "    $dumpvars(0, dut);",
        f"    for (i = 0; i < {clocks}; i = i + 1) begin",
        "      #3;",  # no pin moves with a clock for good
        *(f"      if (($random(seed) & 7) == 0) begin {random[name]} end" for name in moving),
        "      #9;",
        "    end",
        "    $finish;",
        "  end",
        MASTERS.get(top, ""),
        "endmodule"]
    return "\n".join(lines) + "\n"


def wide(width):
    """How many words of 32 bits fill a port."""
    found = re.fullmatch(r"\[(\d+):0\]", width.strip())
    return (int(found[1]) // 32 + 1) if found else 8 if width else 1


def read_dump(vcd):
    """{output: time of its first x or z} of a dump, and how many outputs there are and have moved."""
    scopes, names, found, seen, moved, time = [], {}, {}, {}, set(), 0
    for line in vcd:
        if line.startswith("$scope"):
            scopes.append(line.split()[2])
        elif line.startswith("$upscope"):
            scopes.pop()
        elif line.startswith("$var"):
            word = line.split()
            if word[4].endswith(("_o", "_no")):
                names.setdefault(word[3], []).append(".".join([*scopes[2:], word[4]]))
        elif line.startswith("#"):
            time = int(line[1:])
        else:
            text = line.rstrip("\n")
            value, _, code = text.rpartition(" ") if text[:1] == "b" else (text[:1], "", text[1:])
            if code in names and ("x" in value or "z" in value):
                for name in names[code]:
                    found.setdefault(name, time)
            elif code in names and seen.setdefault(code, value) != value:
                moved.add(code)
    return found, sum(map(len, names.values())), sum(len(names[code]) for code in moved)


class Failed(Exception):
    """Icarus does not run a top."""


def look(root, top, seed, clocks, replaced=None):
    """{output that is unknown after the reset: since when}, how many outputs were looked at, how many have moved.
    `replaced`: {a file of rtl: its text instead}."""
    listed = (root / f"rtl/{top}.f").read_text().splitlines()
    with tempfile.TemporaryDirectory() as name:
        work, sources = pathlib.Path(name), []
        for line in listed:
            if not line.startswith("//"):  # Icarus 11 evaluates some always_comb without an end, no always @*
                text = (replaced or {}).get(f"rtl/{line}") or (root / "rtl" / line).read_text()
                sources.append(work / pathlib.Path(line).name)
                sources[-1].write_text(text.replace("always_comb", "always @*"))
        (work / "tb.sv").write_text(bench(top, (work / f"{top}.sv").read_text(), seed, clocks))
        for command in (["iverilog", "-g2012", "-o", "tb.vvp", "-s", "tb", *sources, "tb.sv"], ["vvp", "-n", "tb.vvp"]):
            try:
                done = subprocess.run(command, cwd=work, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                      stderr=subprocess.STDOUT, timeout=300)
            except (OSError, subprocess.TimeoutExpired) as none:
                raise Failed(f"{top}: {command[0]}: {none}") from none
            if done.returncode != 0:
                raise Failed(f"{top}: {command[0]} ended with {done.returncode}: {done.stdout[-1500:]}")
        with (work / "unknowns.vcd").open() as vcd:
            return read_dump(vcd)


def judge(root, top, seed, clocks):
    """Outputs of a top that are unknown after its reset; says how many were looked at."""
    try:
        found, outputs, moved = look(root, top, seed, clocks)
    except Failed as failed:
        return [str(failed)]
    print(f"{top}: {outputs} outputs of its modules, {moved} moved")
    still = [f"{top}: {moved} of {outputs} outputs have moved; expected {LEAST[top]:.0%} at least"
             ] if moved < LEAST.get(top, 0) * outputs else []
    return [f"{top}: {name} is unknown at {time}, seed {seed}" for name, time in found.items()] + still


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tops", nargs="*", metavar="TOP", help=f"of {', '.join(TOPS)}; all when none is given")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--clocks", type=int, default=8000, help="steps of random pins, two each clk_ref")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    if shutil.which("iverilog") is None:
        skip("iverilog is not installed")
    unknown = [top for top in options.tops if top not in TOPS]
    if unknown:
        print(f"check_unknowns.py: no top {', '.join(unknown)}; there is: {', '.join(TOPS)}", file=sys.stderr)
        sys.exit(2)
    problems = [problem for top in options.tops or TOPS
                for problem in judge(options.root, top, options.seed, options.clocks)]
    finish("unknown levels", problems)


if __name__ == "__main__":
    main()
