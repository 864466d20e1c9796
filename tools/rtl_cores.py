#!/usr/bin/env python3
"""File lists and FuseSoC cores of the RTL: rtl_cores.py --write | --check | --elaborate [NAME...].

--write      writes rtl/NAME.f and rtl/NAME.core for each block, from who instantiates whom below rtl/
--check      those in the tree are these; every file below rtl/ is in a list; the block's page names its list, core,
             clocks, reset and parameters as the RTL has them
--elaborate  each list alone is read and elaborated by Verilator, Yosys and Icarus, and has one top: its block
A list holds packages first, then each module after those it instantiates; paths are relative to rtl/.
docs/rtl-cores.md.
Exit status 0 clean, 1 problems, 77 a tool is not installed.
"""

import argparse
import collections
import pathlib
import re
import shutil

from common import ROOT, finish, skip, without_comments
from lint_rtl import SIMULATION_ONLY, rtl_files, run

Block = collections.namedtuple("Block", "title page", defaults=[None])
BLOCKS = {  # tops with a list; those with a page have a core too
    "servo_channel": Block("Channel of a servo IC", "docs/servo_channel.md"),
    "servo_ic": Block("Servo IC (DSPGATE1): clocks and four channels", "docs/servo_ic.md"),
    "macro_ic": Block("MACRO IC (DSPGATE2), clock part", "docs/macro_ic.md"),
    "clock_select": Block("Choice of the ICs that drive PHASE and SERVO", "docs/clock_select.md"),
    "watchdog": Block("Watchdog", "docs/watchdog.md"),
    "ssi": Block("Serial encoder inputs (SSI)", "docs/ssi.md"),
    "interrupt_controller": Block("Interrupt controller of the host", "docs/interrupt_controller.md"),
    "pic_8259": Block("Interrupt controller 8259", "docs/pic_8259.md"),
    "host_interrupt": Block("Interrupt line of the host bus", "docs/interrupt_controller.md"),
    "host_port": Block("Host port HI08", "docs/host_port.md"),
    "host_signals": Block("Latch of the host signals, BREQ among them", "docs/host_signals.md"),
    "isa_slave": Block("Slave on the ISA bus", "docs/isa_slave.md"),
    "dpram": Block("Dual-ported RAM", "docs/dpram.md"),
    "board_top": Block("Controller board: ICs, host blocks, Port A and ISA", "docs/architecture.md"),
    "servo_ic_chip": Block("A servo IC as a chip of its own", "docs/chips.md"),
    "board_chip": Block("The board without servo ICs as a chip of its own", "docs/chips.md"),
    "board_sim": Block("The board as the co-simulation drives it"),
}
# What several cores share is a core of its own, so that two of them in one design bring it once.
SHARED = {
    "regs": ("Register maps of all blocks, a package", ["brick_regs_pkg"]),
    "motor_pins": ("Places of a servo IC's pins in its vectors, a package", ["motor_pins_pkg"]),
    "common": ("Synchronisers", ["sync2", "reset_sync"]),
    "clock_gen": ("Clock chain of servo IC and MACRO IC", ["clock_gen"]),
    "port_a": ("Port A, as the board and the chip of a servo IC hear it",
               ["bus_strobes", "bus_sync", "address_decode", "bus_read"]),
    "board_core": ("Controller board but its servo ICs", ["board_core"]),
}
NOTICE = "Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit."
WRITE = "./dev cores writes it"
CLOCK, RESET = r"clk\w*_i", r"rst\w*_ni"


class Rtl:
    """The modules and packages below rtl/, and who needs whom."""

    def __init__(self, root):
        packages, modules = rtl_files(root)
        self.root, self.packages = root, [f.stem for f in packages]
        self.file = {f.stem: f.relative_to("rtl") for f in packages + modules}
        text = {f.stem: (root / f).read_text() for f in packages + modules}
        self.text = {name: without_comments(code) for name, code in text.items()}
        self.needs = {name: self._needs(name) for name in self.text}

    def _needs(self, name):
        """What a file names at the start of a statement or before ::, in the order of the file, once each."""
        found = re.findall(r"^\s*(\w+)\b|\b(\w+)::", self.text[name], re.M)
        return [n for n in dict.fromkeys(a or b for a, b in found) if n in self.file and n != name]

    def closure(self, top, stop=()):
        """`top` and all it needs, packages first, each after what it needs; what is in `stop` is left out."""
        order = []

        def visit(name):
            if name in order or name in stop:
                return
            for need in self.needs[name]:
                visit(need)
            order.append(name)

        visit(top)
        return [n for n in order if n in self.packages] + [n for n in order if n not in self.packages]

    def parameters(self, top):
        """{name: default} as the module's header declares them."""
        return dict(re.findall(r"^\s*parameter\s[^=]*?(\w+)\s*=\s*([^,\s]+)", self.text[top], re.M))

    def ports(self, top, pattern):
        return re.findall(rf"^\s*input\s+wire\s+logic\s+({pattern})\s*,?\s*$", self.text[top], re.M)


def version(root):
    return re.search(r"project\(brick VERSION (\S+)", (root / "CMakeLists.txt").read_text()).group(1)


def core_of():
    """{module: core that holds it as its top, or shares it}."""
    shared = {module: name for name, (_, modules) in SHARED.items() for module in modules}
    return shared | {name: name for name, block in BLOCKS.items() if block.page}


def file_list(rtl, top):
    return [f"// {BLOCKS[top].title}: what {top} is made of, in compile order.", f"// {NOTICE}",
            *(str(rtl.file[name]) for name in rtl.closure(top))]


def core(rtl, name, title, tops):
    """The core file: files of its own, and the cores that hold the rest."""
    owners = core_of()
    others = [module for module, owner in owners.items() if owner != name]
    own = list(dict.fromkeys(n for top in tops for n in rtl.closure(top, stop=others)))
    needed = sorted({owners[need] for n in own for need in rtl.needs[n] if need in others})
    release = version(rtl.root)
    out = ["CAPI=2:", f"# {NOTICE}", f"name: brick:ip:{name}:{release}", f"description: \"{title}\"", "",
           "filesets:", "  rtl:", "    files:", *(f"      - {rtl.file[n]}" for n in own),
           "    file_type: systemVerilogSource"]
    if needed:
        out += ["    depend:", *(f"      - brick:ip:{other}:{release}" for other in needed)]
    if name not in BLOCKS:
        return [*out, "", "targets:", "  default:", "    filesets: [rtl]"]
    parameters = rtl.parameters(name)
    listed = [f"    parameters: [{', '.join(parameters)}]"] if parameters else []
    out += ["  waivers:", "    files: [lint.vlt]", "    file_type: vlt", "", "targets:",
            "  default:", "    filesets: [rtl]", f"    toplevel: {name}", *listed,
            "  lint:", "    description: Verilator with all warnings", "    filesets: [waivers, rtl]",
            f"    toplevel: {name}", *listed, "    flow: lint",
            "    flow_options: {tool: verilator, verilator_options: [-Wall]}",
            "  sim:", "    description: Icarus, without a test bench of its own", "    filesets: [rtl]",
            f"    toplevel: {name}", *listed, "    flow: sim",
            "    flow_options: {tool: icarus, iverilog_options: [-g2012]}"]
    if parameters:  # with no default here the RTL's own holds
        out += ["", "parameters:", *(f"  {n}: {{datatype: int, paramtype: vlogparam}}  # {value}"
                                     for n, value in parameters.items())]
    return out


def written(rtl):
    """{path below the root: text} of all lists and cores."""
    texts = {f"rtl/{top}.f": file_list(rtl, top) for top in BLOCKS}
    for name, (title, tops) in SHARED.items():
        texts[f"rtl/{name}.core"] = core(rtl, name, title, tops)
    for name, block in BLOCKS.items():
        if block.page:
            texts[f"rtl/{name}.core"] = core(rtl, name, block.title, [name])
    return {path: "\n".join([*lines, ""]) for path, lines in texts.items()}


def list_problems(rtl, path, text, wanted):
    """What a list lacks, has too much or has in the wrong place, each by its name."""
    have = [line for line in text.splitlines() if line and not line.startswith("//")]
    want = [line for line in wanted.splitlines() if not line.startswith("//")]
    users = {str(rtl.file[need]): rtl.file[name] for name, needs in rtl.needs.items() for need in needs
             if str(rtl.file[name]) in want}
    yield from (f"{path}: misses {f}, which {users.get(f, 'it')} needs; {WRITE}" for f in want if f not in have)
    yield from (f"{path}: has {f}, which nothing in it needs; {WRITE}" for f in have if f not in want)
    if sorted(have) == sorted(want) and have != want:
        early, late = next((a, b) for a, b in zip(have, want, strict=True) if a != b)
        yield f"{path}: {early} stands where {late} must; {WRITE}"
    elif have == want:
        yield f"{path}: its heading is not what would be written; {WRITE}"


def tree_problems(rtl):
    texts = written(rtl)
    for path, wanted in texts.items():
        file = rtl.root / path
        text = file.read_text() if file.exists() else ""
        if not text:
            yield f"{path}: is missing; {WRITE}"
        elif text != wanted:
            differs = [f"{path}: is not what would be written; {WRITE}"]
            yield from list_problems(rtl, path, text, wanted) if path.endswith(".f") else differs
    for file in sorted((rtl.root / "rtl").glob("*.*")):
        if file.suffix in {".f", ".core"} and f"rtl/{file.name}" not in texts:
            yield f"rtl/{file.name}: no block of tools/rtl_cores.py"
    listed = {name for top in BLOCKS for name in rtl.closure(top)}
    yield from (f"rtl/{file}: in no list: nothing instantiates it" for n, file in rtl.file.items() if n not in listed)


def page_problems(rtl):
    """The table `NAME` under 'RTL core' on the block's page against the RTL."""
    for name, block in BLOCKS.items():
        if not block.page:
            continue
        page = (rtl.root / block.page).read_text()
        found = re.search(rf"^\| `{name}` \|.*\n\|[-|]+\n((?:\|.*\n)*)", page, re.M)
        rows = [row.strip("|").split("|", 1) for row in found.group(1).splitlines()] if found else []
        table = {key.strip(): value for key, value in rows}
        names = {key: re.findall(rf"`({pattern})`", table.get(key, "")) for key, pattern in
                 (("list, core", r"[\w/:.]+"), ("clocks", CLOCK), ("reset", RESET))}
        expected = {"list, core": [f"rtl/{name}.f", f"brick:ip:{name}"],
                    "clocks": rtl.ports(name, CLOCK), "reset": rtl.ports(name, RESET)}
        for key, want in expected.items():
            if names[key] != want:
                yield f"{block.page}: table `{name}`, row '{key}' has {names[key]}, expected {want} in this order"
        wanted = [f"`{n}` = {value}" for n, value in rtl.parameters(name).items()]
        stated = [key for key in table if "=" in key]
        if stated != wanted or ("none" in table.get("parameters", "")) != (not wanted):
            yield f"{block.page}: table `{name}` has parameters {stated}, the RTL {wanted or 'none'}"


def elaborate(root, top):
    """The list alone, from the folder it stands in, as each tool takes it."""
    folder = root / "rtl"
    read = [line for line in (folder / f"{top}.f").read_text().splitlines() if not line.startswith("//")]
    tools = {"verilator": (["verilator", "--lint-only", "-Wall", "rtl/lint.vlt", "-F", f"rtl/{top}.f"], root),
             "icarus": (["iverilog", "-g2012", "-t", "null", "-s", top, "-c", f"{top}.f"], folder),
             "yosys": (["yosys", "-q", "-p", f"read_verilog -sv {' '.join(read)}; hierarchy -check -top {top}"],
                       folder)}
    for tool, (command, place) in tools.items():
        if top in SIMULATION_ONLY and tool != "verilator":
            continue
        status, output = run(command, place)  # without --top-module Verilator warns of a second top
        if status != 0 or "%Warning" in output:
            yield f"rtl/{top}.f, {tool}: {output.strip()[-2000:] or 'failed'}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group(required=True)
    for option in ("--write", "--check", "--elaborate"):
        what.add_argument(option, action="store_true")
    parser.add_argument("names", nargs="*", metavar="NAME", help="lists to elaborate; all when none is given")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    rtl = Rtl(options.root)
    if options.write:
        for path, text in written(rtl).items():
            (options.root / path).write_text(text)
        return
    if options.check:
        finish(f"{len(BLOCKS)} file lists", [*tree_problems(rtl), *page_problems(rtl)])
        return
    for program in ("verilator", "yosys", "iverilog"):
        if shutil.which(program) is None:
            skip(f"{program} is not installed")
    finish("file lists alone", [problem for top in options.names or BLOCKS for problem in elaborate(options.root, top)])


if __name__ == "__main__":
    main()
