#!/usr/bin/env python3
"""Holds the layers of the firmware and of the C++ tree, as docs/architecture.md lists them.

A file includes only its own folder and folders below it, and includes make no circle; in the firmware a header and
its source count as one for that. There a function is declared in the header of the file that defines it, and so is a
variable; a const table that joins layers may stand in firmware/image instead. Blocks of components do not include each
other. testbench/unit, testbench/fuzz and app/main.cpp, which hands the benches to the commands, may include anything.
"""

import argparse
import collections
import pathlib
import re

from common import ROOT, files, finish

FIRMWARE = [{f"firmware/{name}"} for name in (
    "hal", "base", "kernel", "variables", "language", "buffers", "motion", "run", "command", "host", "image")]
CPP = [{"testbench/clients"}, {"systemc/core"}, {"systemc/cpu", "systemc/servo_ic", "systemc/host", "systemc/ssi"},
       {"systemc/macro_ic"}, {"systemc/board"}, {"systemc/cosim"}, {"systemc/component"}, {"systemc/machine"},
       {"testbench/host", "testbench/plant"}, {"testbench/checkers"}, {"app"},
       {"testbench/benches"}, {"testbench/benchmark"}]
FREE = ("testbench/unit", "testbench/fuzz", "app/main.cpp")  # may include anything
# A component's block is a folder of its own; who may look into which others.
BLOCKS = "systemc/component/"
INTO = {"board": {"servo_ic"}, "model_engine.cpp": {"board"}, "rtl_engine.cpp": {"board"}}
# Of what stands in <> only our own folders.
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"|<(?=(?:firmware|systemc|testbench|app)/))([^">]+)[">]', re.M)
# Firmware sources are written by clang-format: what stands in column 0 is a declaration or a definition.
FUNCTION = re.compile(r"^(?!static|typedef|return|else|#)\w[\w \t*]*?[ *](\w+)\([^;{}]*\)\s*([;{])", re.M)
VARIABLE = re.compile(r"^extern\s+([^;]*?)(\w+)(?:\[\w*\])?(?:, (\w+))*\s*(?:\)\([^;]*\))?;", re.M)


def without_comments(text):
    return re.sub(r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"(?=[^\n]*\\?\n)", keep_includes, text, flags=re.S)


def keep_includes(match):
    return match.group() if match.group().startswith('"') else ""


def folder(path):
    """The folder that has a layer: two levels, `app` one."""
    parts = pathlib.PurePosixPath(path).parts
    return parts[0] if parts[0] == "app" else "/".join(parts[:2])


def rank(layers, name):
    return next((i for i, layer in enumerate(layers) if name in layer), None)


def read(root):
    """Path -> text without comments of every source that has a layer."""
    found = files(root, ("firmware", "systemc", "testbench", "app"), {".c", ".h", ".cpp", ".def"})
    return {p.as_posix(): without_comments((root / p).read_text()) for p in found if not p.as_posix().startswith(FREE)}


def upward(layers, sources):
    problems = []
    for path, text in sources.items():
        own = folder(path)
        if not any(own.split("/")[0] == name.split("/")[0] for layer in layers for name in layer):
            continue
        if rank(layers, own) is None:
            problems.append(f"{path}: folder {own} has no layer")
            continue
        for name in INCLUDE.findall(text):
            other = folder(name)
            if other == own or "/" not in name or name.startswith(("rtl/regs/", "rtl/pins/")):
                continue
            if rank(layers, other) is None or rank(layers, other) >= rank(layers, own):
                problems.append(f"{path}: includes {name}, which is not below {own}")
    return problems


def block(path):
    """Of a file of the components: its block, or its own name if it is shared."""
    return path.removeprefix(BLOCKS).split("/")[0]


def sideways(sources):
    """Blocks of components that include each other, or are included by what they share."""
    blocks = {block(path) for path in sources if path.startswith(BLOCKS) and path.count("/") > BLOCKS.count("/")}
    blocks.discard("include")
    for path, text in sources.items():
        for name in INCLUDE.findall(text) if path.startswith(BLOCKS) else []:
            other = block(name) if name.startswith(BLOCKS) else ""
            if other in blocks and other != block(path) and other not in INTO.get(block(path), ()):
                yield f"{path}: includes {name}, another component's block"


def unit_of(path):
    return re.sub(r"\.[ch]$", "", path) if path.startswith("firmware/") else path


def circles(sources):
    """Files, in the firmware pairs of header and source, that reach themselves."""
    uses = collections.defaultdict(set)
    for path, text in sources.items():
        uses[unit_of(path)] |= {unit_of(name) for name in INCLUDE.findall(text)} - {unit_of(path)}
    problems, done = [], set()

    def visit(unit, trail):
        if unit in trail:
            circle = trail[trail.index(unit):] + [unit]
            problems.append("circle: " + " -> ".join(circle))
        elif unit not in done and unit in uses:
            for other in sorted(uses[unit]):
                visit(other, trail + [unit])
            done.add(unit)

    for unit in sorted(uses):
        visit(unit, [])
    return problems


def declarations(sources):
    """Functions and variables of the firmware that are declared away from where they are defined."""
    target = re.compile(r"^#ifdef BRICK_NATIVE\n.*?^#else\n", re.M | re.S)  # a test's replacement of a header's inlines
    firmware = {path: target.sub("", text) for path, text in sources.items() if path.startswith("firmware/")}
    problems = []
    for path, text in firmware.items():
        unit, ending = path.rsplit(".", 1)
        source = text if ending == "c" else firmware.get(f"{unit}.c", "")
        defined = {name for name, end in FUNCTION.findall(source) if end == "{"}
        for name in {name for name, end in FUNCTION.findall(text) if end == ";"} - defined:
            problems.append(f"{path}: declares {name}(), which {unit}.c does not define")
        if ending == "c":
            problems += [f"{path}: extern inside a function: include the header of the file that defines it"
                         for _ in re.finditer(r"^[ \t]+extern\b", text, re.M)]
        for match in VARIABLE.finditer(text):
            name = match.group(2)
            if ending == "c":
                problems.append(f"{path}: extern {name}: include the header of the file that defines it")
                continue
            definition = re.compile(rf"^(?!extern|static)\w[^;{{}}()]*(?:\(\*const )?\b{name}\b[^;(]*[;=)]", re.M)
            places = [source]
            if "const" in match.group(0):
                places += [other for place, other in firmware.items() if place.startswith("firmware/image/")]
            if not any(definition.search(place) for place in places):
                problems.append(f"{path}: declares {name}, which {unit}.c does not define")
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    sources = read(parser.parse_args().root)
    finish("layers", upward(FIRMWARE, sources) + upward(CPP, sources) + [*sideways(sources)] + circles(sources) +
           declarations(sources))


main()
