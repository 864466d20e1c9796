#!/usr/bin/env python3
"""Every register, field and code of the generated maps is used by the RTL or by the model of its block.

A description that nobody reads is a second source that drifts. What counts, in the folders below: in SystemVerilog
brick_regs_pkg::ServoChannelStatusEquLsb, in C++ the name with its register (status::kEqu), through namespace aliases
and using-directives too. A register counts by its address or its name, a field that fills its register with it, and a
field that is stored only by the mask of written bits of its register.

    check_used.py [--root TREE]    exit 1 with one line for each that is not used
"""
import argparse
import re
import sys
from pathlib import Path

# Where the RTL and the model of a block stand.
FOLDERS = {
    "servo_ic": ("rtl/servo_ic", "systemc/servo_ic"),
    "servo_channel": ("rtl/servo_ic", "systemc/servo_ic"),
    "servo_channel_fine": ("rtl/servo_ic", "systemc/servo_ic"),
    "macro_ic": ("rtl/macro_ic", "systemc/macro_ic"),
    "board_latches": ("rtl/board", "rtl/host", "systemc/board", "systemc/host"),
    "jpan": ("rtl/board", "systemc/board"),
    "ssi_geo": ("rtl/ssi", "systemc/ssi"),
    "ssi_brick": ("rtl/ssi", "systemc/ssi"),
    "hi08": ("rtl/host", "systemc/host"),
    "host_io": ("rtl/host", "systemc/host"),
    "pic_8259": ("rtl/host", "systemc/host"),
    "cpu_bus": ("systemc/cpu",),
}
CODES = ("rtl", "systemc")
# The board passes the sixteen lines of JPAN as one word: what they mean is the firmware's affair.
FIELDS_UNKNOWN = {"jpan"}
SUFFIXES = {".sv", ".h", ".cpp"}


def camel(name):
    return "".join(part[:1].upper() + part[1:] for part in name.split("_"))


class Map:
    """Blocks with registers and fields, and code lists, as brick_regs.hpp has them."""

    def __init__(self, text):
        self.registers, self.fields, self.codes = [], [], []  # (block, register), (block, register, field, stored)
        block = register = None
        for line in text[text.index("kGateIcs"):].splitlines():
            if opened := re.match(r"namespace (\w+) \{", line):
                block, register = (opened[1], None) if block is None else (block, opened[1])
            elif re.match(r"\}  // namespace \w+", line):
                block, register = (block, None) if register else (None, None)
            elif found := re.match(r"constexpr Register k\w+\{.*\"(\w+)\"\}", line):
                self.registers.append((block, found[1]))
            elif found := re.match(r"constexpr Field k\w+\{.*\"(\w+)\"\};(  // stored only)?", line):
                self.fields.append((block, register, found[1], bool(found[2])))
            elif (found := re.match(r"  k(\w+) = \d+,", line)) and not re.match(r"(Servo|Macro)Ic\d", found[1]):
                self.codes.append((block, found[1]))  # not the ICs, which are numbers of clock sources


class Sources:
    """Names that the files below some folders use: of the SystemVerilog package, and C++ paths."""

    def __init__(self, root, folders):
        self.package, self.paths = set(), set()
        files = [f for folder in folders for f in sorted((root / folder).rglob("*")) if f.suffix in SUFFIXES]
        texts = {f: re.sub(r"//[^\n]*|/\*.*?\*/", "", f.read_text(), flags=re.DOTALL) for f in files}
        aliases_of = {f: dict(re.findall(r"namespace (\w+) = ([\w:]+);", text)) for f, text in texts.items()}
        shared = {name: path for aliases in aliases_of.values() for name, path in aliases.items()}
        for file, text in texts.items():
            aliases = {**shared, **aliases_of[file]}
            self.package.update(re.findall(r"brick_regs_pkg::(\w+)", text))
            opened = [self.resolve(name, aliases) for name in re.findall(r"using namespace ([\w:]+);", text)]
            for path in re.findall(r"\b(?:\w+::)*k[A-Z]\w*", text):
                whole = self.resolve(path, aliases)
                self.paths.update([whole] + [f"{name}::{whole}" for name in opened])

    @staticmethod
    def resolve(path, aliases):
        head, *rest = path.split("::")
        while head in aliases:
            head, *more = aliases[head].split("::")
            rest = more + rest
        return "::".join([head, *rest])

    def has(self, package_name, path):
        return package_name in self.package or any(("::" + used).endswith("::" + path) for used in self.paths)


def unused(root):
    generated = Map((root / "rtl/regs/brick_regs.hpp").read_text())
    sources = {block: Sources(root, folders) for block, folders in FOLDERS.items()}
    for block, register in generated.registers:
        full = camel(block) + camel(register)
        if block not in sources:
            yield f"{block}: no folders are named for this block"
        elif not sources[block].has(full + "Addr", f"{block}::k{camel(register)}"):
            yield f"{block}.{register}"
    for block, register, field, stored in generated.fields:
        if block in FIELDS_UNKNOWN:
            continue
        full = camel(block) + camel(register)
        found = sources[block].has(full + camel(field) + "Lsb", f"{block}::{register}::k{camel(field)}")
        if not found and not (stored and sources[block].has(full + "Written", f"{block}::k{camel(register)}")):
            yield f"{block}.{register}.{field}"
    code_sources = Sources(root, CODES)
    for codes, code in generated.codes:
        if not code_sources.has(camel(codes) + code, f"{codes}::k{code}"):
            yield f"code {codes}.{code}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=Path, default=Path(__file__).resolve().parent.parent.parent)
    problems = list(unused(parser.parse_args().root))
    for problem in problems:
        print(f"{problem} is used by neither RTL nor model")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
