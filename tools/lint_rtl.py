#!/usr/bin/env python3
"""Lints the RTL: lint_rtl.py verilator|yosys|icarus.

verilator  --lint-only -Wall with every module as a top in turn, the board also with other ICs; warnings are errors.
           Waivers stand in rtl/lint.vlt only, each with its reason in a comment on the line above it.
yosys      elaborates every module and checks for latches, undriven and multiply driven nets.
icarus     elaborates every module.
Every Verilog file below rtl/ is read by all three: one of another kind than .sv is a problem.
Packages are read first. Exit status 0 clean, 1 problems, 77 the tool is not installed.
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys

from common import ROOT, files, finish, skip, without_comments

TOP = "board_top"
SIMULATION_ONLY = {"board_sim"}  # tops for simulation, never synthesized: read by Verilator only
# Boards with other ICs than the default parameters build: a MACRO IC alone, as on the Ultralite, and all.
VARIANTS = {"board_sim": (("-GServoIcMask=18'h00000", "-GMacroIcMask=4'h1"),
                          ("-GServoIcMask=18'h3FFFF", "-GMacroIcMask=4'hF"))}
VERILOG = {".v", ".vh", ".sv", ".svh", ".vl", ".verilog"}


def rtl_files(root):
    """Packages first (register maps before those that use them), then modules."""
    found = files(root, ["rtl"], {".sv"})
    packages = [f for f in found if f.stem.endswith("_pkg")]
    packages.sort(key=lambda f: (f.parts[1] != "regs", f))
    return packages, [f for f in found if f not in packages]


def run(command, root):
    done = subprocess.run(command, cwd=root, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True)
    return done.returncode, done.stdout


def unread_problems(root):
    """Verilog that rtl_files() does not hand to the tools."""
    return [f"{file}: no tool reads it; RTL stands in .sv files" for file in files(root, ["rtl"], VERILOG - {".sv"})]


def waiver_problems(root):
    """Each waiver in rtl/lint.vlt needs a comment above it; waivers inside the sources are not allowed."""
    problems = []
    waivers = root / "rtl/lint.vlt"
    previous_is_reason = False
    for number, line in enumerate(waivers.read_text().splitlines() if waivers.exists() else [], 1):
        text = line.strip()
        if text.startswith("lint_off") and not previous_is_reason:
            problems.append(f"rtl/lint.vlt:{number}: waiver without a reason above it: {text}")
        if text.startswith("//"):
            previous_is_reason = True
        elif not text.startswith("lint_off"):  # one reason may stand over several waivers
            previous_is_reason = False
    for file in files(root, ["rtl"], {".sv"}):
        for number, line in enumerate((root / file).read_text().splitlines(), 1):
            if re.search(r"verilator\s+lint_off", line):
                problems.append(f"{file}:{number}: waivers belong in rtl/lint.vlt")
    return problems


def written_twice(text):
    """Variables that two always_ff write: an error in IEEE 1800 (9.2.2.4), which the three tools here let pass."""
    blocks = re.findall(r"\balways_ff\b(.*?)(?=\b(?:always\w*|assign|endmodule|initial)\b)", text, flags=re.S)
    target = re.compile(r"(?:;|\bbegin|\belse|\)|:)\s*(\{[^{};]*\}|[A-Za-z_]\w*)(?:\s*\[[^\];]*\])*\s*<=")
    written = [{name for found in target.findall(block) for name in re.findall(r"[A-Za-z_]\w*", found)}
               for block in blocks]
    return sorted({name for i, one in enumerate(written) for other in written[:i] for name in one & other})


def chosen_targets(text):
    """Assignments in always_comb to a bit that a signal chooses: Yosys makes a carry chain of 32 bits of each, a fifth
    of the longest path of the 8259. A shifted 1 says the same in a few LUTs."""
    blocks = re.findall(r"\balways_comb\b(.*?)(?=\b(?:always\w*|assign|endmodule|initial)\b)", text, flags=re.S)
    loops = set(re.findall(r"\b(?:int|genvar)(?:\s+unsigned)?\s+(\w+)", text))
    target = re.compile(r"(?:;|\bbegin|\belse|\)|:)\s*([A-Za-z_]\w*\s*\[\s*([a-z_]\w*)\b(?!\s*::)[^\]]*\]*)\s*=[^=]")
    return sorted({whole for block in blocks for whole, index in target.findall(block) if index not in loops})


def module_problems(root, modules):
    """One module a file, named after it, `default_nettype none, no import, no latch, no initial block, one writer, no
    chosen target."""
    problems = []
    for file in modules:
        text = without_comments((root / file).read_text())
        names = re.findall(r"^\s*module\s+(\w+)", text, flags=re.M)
        if names != [file.stem]:
            problems.append(f"{file}: must hold the one module '{file.stem}', holds {names}")
        if "`default_nettype none" not in text:
            problems.append(f"{file}: `default_nettype none is missing")
        if re.search(r"\bimport\s+\w+::", text):
            problems.append(f"{file}: import: qualify the name instead, Yosys reads no import")
        if re.search(r"\b(always_latch|initial)\b", text) and file.stem not in SIMULATION_ONLY:
            problems.append(f"{file}: latch or initial block in synthesizable code")
        problems += [f"{file}: a signal chooses the bit {target} that is assigned; expected a shifted 1"
                     for target in chosen_targets(text)]
        problems += [f"{file}: two always_ff write {name}; expected one, or plain always blocks"
                     for name in written_twice(text)]
    return problems


def lint_verilator(root, packages, modules):
    problems = unread_problems(root) + waiver_problems(root) + module_problems(root, modules)
    folders = sorted({str(f.parent) for f in modules})
    waivers = ["rtl/lint.vlt"] if (root / "rtl/lint.vlt").exists() else []
    for module in modules:
        command = ["verilator", "--lint-only", "-Wall", *(a for folder in folders for a in ("-y", folder)), *waivers,
                   *map(str, packages), str(module), "--top-module", module.stem]
        for parameters in [(), *VARIANTS.get(module.stem, ())]:
            status, output = run([*command, *parameters], root)
            if status != 0 or "%Warning" in output or "%Error" in output:
                problems.append(f"{module} {' '.join(parameters)}\n{output.strip()}")
    return problems


def lint_yosys(root, packages, modules):
    sources = [str(f) for f in packages + modules if f.stem not in SIMULATION_ONLY]
    # A latch that "always @*" makes is only a remark in the log, so look for the cells.
    no_latch = "select -assert-none t:$dlatch t:$adlatch t:$sr"
    # Without a top every module is elaborated, also those that board_top's default parameters leave out.
    script = f"read_verilog -sv {' '.join(sources)}; hierarchy -check; proc; {no_latch}; check -assert"
    status, output = run(["yosys", "-q", "-p", script], root)
    return [output.strip()[-3000:] or "yosys failed"] if status != 0 else []


def lint_icarus(root, packages, modules):
    sources = [str(f) for f in packages + modules if f.stem not in SIMULATION_ONLY]
    tops = [argument for f in modules if f.stem not in SIMULATION_ONLY for argument in ("-s", f.stem)]
    status, output = run(["iverilog", "-g2012", "-t", "null", *tops, *sources], root)
    # Icarus 11 says "sorry" where it only simulates more slowly; what it cannot read is an error and a non-zero status.
    return [output.strip()[-3000:] or "iverilog failed"] if status != 0 else []


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool", choices=["verilator", "yosys", "icarus"])
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    program = {"icarus": "iverilog"}.get(options.tool, options.tool)
    if shutil.which(program) is None:
        skip(f"{program} is not installed")
    packages, modules = rtl_files(options.root)
    if not any(f.stem == TOP for f in modules):
        sys.exit(f"{TOP}.sv was not found below rtl/")
    lint = {"verilator": lint_verilator, "yosys": lint_yosys, "icarus": lint_icarus}[options.tool]
    finish(f"{options.tool}, {len(packages)} packages, {len(modules)} modules", lint(options.root, packages, modules))


if __name__ == "__main__":
    main()
