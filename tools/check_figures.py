#!/usr/bin/env python3
"""Figures and claims that stand in two places say the same: how long a SAVE takes, how fast an idle machine is, how
many misreadings were planted, how many modules have proofs, what is claimed and what the plan calls open."""

import argparse
import pathlib
import re

from common import ROOT, finish

# (what, (page, pattern), ...): the first group of each, of the same text.
PAIRS = (
    ("a SAVE as it comes", ("docs/save.md", r"SAVE of a controller as it comes \| (\d+) ms"),
     ("docs/watchdog.md", r"\| SAVE \| one long pass \((\d+) ms\)"),
     ("docs/datasheet/firmware.md", r"(\d+) ms and more; a power cut"),
     ("docs/datasheet/firmware.md", r"acknowledged when it is done, (\d+) ms and more")),
    ("speed of an idle machine", ("docs/cosim.md", r"idle firmware (\d+) simulated s/s"),
     ("README.md", r"idle firmware: (\d+) simulated\s+seconds a second")),
    ("speed of a host that polls", ("docs/cosim.md", r"a host that polls ([\d.]+) simulated s/s"),
     ("docs/simulation-speed.md", r"a host reads its status without pause \| ([\d.]+) simulated s/s")),
    ("speed of the RTL", ("docs/cosim.md", r"\| 8 axes ([\d.]+ to [\d.]+ M ticks/s),"),
     ("README.md", r"the Verilated RTL \| ([\d.]+ to [\d.]+ M ticks/s),")),
)


def figure(root, page, pattern, problems):
    path = root / page
    found = re.findall(pattern, path.read_text() if path.exists() else "")
    if len(found) != 1:
        problems.append(f"{page}: {len(found)} places like /{pattern}/, expected one")
    return found[0] if len(found) == 1 else None


def ids_in_brackets(line):
    """`(SSI-1, SSI-2)` and `(LA-1 to LA-5)`: every one."""
    for text in re.findall(r"\(((?:[A-Z0-9]+-\d+|, | and | to )+)\)", line):
        for group, first, last in re.findall(r"([A-Z0-9]+)-(\d+)(?: to \1-(\d+))?", text):
            yield from (f"{group}-{number}" for number in range(int(first), int(last or first) + 1))


def check(root):
    problems = []
    for what, *places in PAIRS:
        shown = [(page, figure(root, page, pattern, problems)) for page, pattern in places]
        if len({value for _, value in shown}) > 1:
            problems.append(f"{what}: " + ", ".join(f"{page} says {value}" for page, value in shown))

    proofs = {path.stem for path in (root / "testbench/formal").glob("*.sv")}
    rows = set(re.findall(r"^\| `(\w+)` \| \d+ \|", (root / "docs/formal.md").read_text(), re.M))
    problems += [f"{name}: proved or in a row of docs/formal.md, but not both" for name in sorted(proofs ^ rows)]
    claimed = figure(root, "docs/verification-plan.md", r"than the (\d+) of \[proofs\]", problems)
    if claimed is not None and int(claimed) != len(proofs):
        problems.append(f"docs/verification-plan.md: {claimed} modules with proofs, but there are {len(proofs)}")

    ids = {line.strip() for line in (root / "docs/claimed.txt").read_text().splitlines()}
    for number, line in enumerate((root / "docs/verification-plan.md").read_text().splitlines(), 1):
        gap = line.startswith("- ") or "**open**" in line
        problems += [f"docs/verification-plan.md:{number}: {name} is a gap here, but docs/claimed.txt claims it"
                     for name in ids_in_brackets(line) if gap and name in ids]
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    finish("figures that stand twice", check(parser.parse_args().root))


if __name__ == "__main__":
    main()
