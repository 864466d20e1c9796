#!/usr/bin/env python3
"""Checks that all servo ICs of a Verilated board share one set of functions.

check_shared.py FOLDER, the generated Vboard_NAME.dir. Verilator makes one set for each instance as soon as the
instances differ, such as by the name of a temporary of a function call or by an output that only some of them use; 18
sets do not fit the processor's cache (docs/cosim.md). Exit status 0 or 1.
"""

import argparse
import pathlib
import re

from common import finish


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    prefix = folder.name[: -len(".dir")]
    if not (folder / f"{prefix}.cmake").is_file():
        finish("shared functions",
               [f"{folder}/{prefix}.cmake: no such file; expected a folder that the build has generated"])
    listed = (folder / f"{prefix}.cmake").read_text()  # older files may lie beside the ones that are built
    instances = {}
    for file in sorted(folder.glob(f"{prefix}_servo_ic__DepSet_*.cpp")):
        if file.name not in listed or file.stem.endswith("__Slow"):
            continue
        for name, ic in re.findall(rf"^\w+ void ({prefix}_servo_ic___\w*gen_servo_ic__BRA__(\d+)__KET__\w*)\(.*\{{$",
                                   file.read_text(), re.M):
            instances.setdefault(int(ic), []).append(name)
    problems = [] if instances else [f"{folder}: no functions of servo_ic found; expected those of instance 0"]
    problems += [f"servo IC {ic} has {len(names)} functions of its own, as {names[0]}; expected those of instance 0"
                 for ic, names in instances.items() if ic != 0]
    finish("shared functions", problems)


main()
