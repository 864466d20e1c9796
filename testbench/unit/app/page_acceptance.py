#!/usr/bin/env python3
"""Runs the commands of a page of docs in the tree: statuses as their comments say; each line that the page quotes is
printed, at whatever time. Left out: programs with a window.
usage: page_acceptance.py BRICK CASE"""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys

import command
from command import REPOSITORY, check

WINDOWS = "gtkwave", "xdg-open"


def without_time(line):
    return re.sub(r"^ *\d+\.\d+ ms", "", line)


def commands(block):
    """(text, exit status) of each, a here-document with the command it belongs to."""
    lines = block.splitlines()
    while lines:
        text = lines.pop(0)
        if here := re.search(r"<<'(\w+)'", text):
            while not text.endswith("\n" + here[1]):
                text += "\n" + lines.pop(0)
        status = re.search(r"# exit status (\d)$", text)
        yield text, int(status[1]) if status else 0


def play(page, least_commands, least_quotes, *programs):
    if missing := [program for program in programs if shutil.which(program) is None]:
        print(f"not installed: {', '.join(missing)}")
        sys.exit(77)
    places = [pathlib.Path(command.BRICK).resolve().parent, pathlib.Path(sys.executable).parent]
    os.environ["PATH"] = ":".join([*map(str, places), os.environ["PATH"]])
    printed, quoted, ran = "", 0, 0
    for kind, block in re.findall(r"^```(\w*)\n(.*?)^```$", (REPOSITORY / page).read_text(), re.M | re.S):
        if kind != "sh":
            for line in map(without_time, block.splitlines()):
                check(line in map(without_time, printed.splitlines()), f"the page quotes `{line}`; printed: {printed}")
                quoted += 1
            continue
        printed = ""
        for text, status in commands(block):
            if text.startswith((*WINDOWS, "export ")):
                continue
            r = subprocess.run(["bash", "-c", text], cwd=REPOSITORY, capture_output=True, text=True)
            check(r.returncode == status, f"{text}: exit {r.returncode}, expected {status}: {r.stdout}{r.stderr}")
            printed += r.stdout + r.stderr
            ran += 1
    check(ran >= least_commands and quoted >= least_quotes, f"{ran} commands, {quoted} lines quoted")


def make_by_ccache():
    if shutil.which("ccache"):
        os.environ["MAKEFLAGS"] = r"-- CC=ccache\ riscv64-unknown-elf-gcc"


def tour():
    make_by_ccache()
    play("docs/tour.md", 8, 6)
    made = REPOSITORY / "build/tour"
    check((made / "bug.fst").stat().st_size > 1000 and (made / "seeds/report.html").exists(), "waveform and page")


def faq():
    play("docs/faq.md", 4, 5)


def verification():
    play("docs/tutorials/verification.md", 7, 2)


def firmware():
    make_by_ccache()
    play("docs/tutorials/firmware.md", 9, 2, "callgrind_annotate")


def integration():
    if importlib.util.find_spec("pytest") is None:
        print("not installed: pytest, of tools/requirements.txt")
        sys.exit(77)
    os.environ["PYTHONPATH"] = str(REPOSITORY / "python")
    play("docs/tutorials/integration.md", 5, 2)


def fpga():
    play("docs/tutorials/fpga.md", 6, 2, "verilator", "iverilog", "yosys")


globals()[command.CASE]()
