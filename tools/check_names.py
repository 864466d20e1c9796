#!/usr/bin/env python3
"""A block is found whole under its module's one name: an RTL module with a core of its own has a model in the folder of
its RTL, a page of docs and tests of that name; a proof has the name of the module that it is about; a component has
that of its block."""

import argparse
import pathlib

from common import ROOT, finish

# Cores of several small modules, of generated packages, of what two boards are made of.
NO_BLOCK = {"common", "regs", "motor_pins", "port_a", "board_core"}
NO_MODEL = {"servo_ic_chip", "board_chip"}           # other packages of blocks that have one
PAGES = {"board_top": "architecture",                # the whole
         "host_interrupt": "interrupt_controller",   # its last flip-flops, the 8259's too
         "servo_ic_chip": "chips", "board_chip": "chips"}
TESTS = {"board_top": "board", "servo_ic_chip": "chips", "board_chip": "chips"}
COMPONENTS = {"board"}                               # a folder that is named after the chip, not after board_top


def check(root):
    problems = []
    modules = {path.stem: path.parent.name for path in (root / "rtl").glob("*/*.sv")}
    for block in sorted({path.stem for path in (root / "rtl").glob("*.core")} - NO_BLOCK):
        if block not in modules:
            problems.append(f"rtl/{block}.core: no module {block} in rtl/*/")
            continue
        folder, page, tests = modules[block], PAGES.get(block, block), TESTS.get(block, block)
        if block not in NO_MODEL and not (root / f"systemc/{folder}/{block}.h").exists():
            problems.append(f"{block}: its RTL is in rtl/{folder}; expected its model at systemc/{folder}/{block}.h")
        if not (root / f"docs/{page}.md").exists():
            problems.append(f"{block}: expected its page at docs/{page}.md")
        unit = root / "testbench/unit"
        if not (unit / tests).is_dir() and not list(unit.glob(f"*/{tests}*_test.cpp")):
            problems.append(f"{block}: expected tests at testbench/unit/{tests} or testbench/unit/*/{tests}*_test.cpp")
    for proof in sorted((root / "testbench/formal").glob("*.sv")):
        if proof.stem not in modules:
            problems.append(f"testbench/formal/{proof.name}: no module has this name")
    components = [path for path in (root / "systemc/component").glob("*") if path.is_dir() and path.name != "include"]
    for component in sorted(components):
        if component.name not in modules and component.name not in COMPONENTS:
            problems.append(f"systemc/component/{component.name}: no module has this name")
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    finish("names of blocks", check(parser.parse_args().root))


if __name__ == "__main__":
    main()
