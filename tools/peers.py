#!/usr/bin/env python3
"""How fast others simulate the same servo IC: peers.py [--only PEER...] [--steps N] [--runs N] [--write]

Each peer plays the same stimulus (testbench/benchmark/peers/peer.h) and says its checksums; those of all must agree. In
turn, the median of --runs; a rate is of processor time, without what a run of no steps takes. --write: docs/peers.md.
A peer whose simulator is not installed is left out, which a line says, and the exit status; the page is of all.
Exit status: 0 done, 1 a checksum differs, something cannot be built or does not end, or a page would lack a peer,
2 bad usage, 77 not all that was asked for is installed, or one played alone: nothing is compared.
"""

import argparse
import contextlib
import os
import pathlib
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import threading

from common import ROOT, as_of, skip

HERE = ROOT / "testbench/benchmark/peers"
PAGE = "docs/peers.md"
COCOTB = "cocotb==1.8.1"  # the last for Verilator 5.006
STATE_TICKS = 60
LIMIT = 600  # s of the wall: a run takes seconds, a build minutes of a machine that is shared
ENDS_WITH_US = ["setpriv", "--pdeathsig", "KILL"]
VERILATE = ["-O3", "-fno-table", "--x-assign", "fast", "--x-initial", "fast", "-Wno-fatal", "-Wno-lint", "-Wno-style"]


class Failed(Exception):
    """What cannot be built or run."""


class Missing(Exception):
    """Which simulator is not installed."""


def run(command, limit=LIMIT, **more):
    """(standard output, seconds of the processor, those of its children included). Whatever ends us ends it too."""
    with tempfile.TemporaryFile() as said, tempfile.TemporaryFile() as wrong:
        program = subprocess.Popen([*ENDS_WITH_US, *map(str, command)], stdin=subprocess.DEVNULL, stdout=said,
                                   stderr=wrong, start_new_session=True, **more)
        late = threading.Event()

        def kill():  # its children too
            with contextlib.suppress(ProcessLookupError):
                os.killpg(program.pid, signal.SIGKILL)

        def end():
            late.set()
            kill()

        watch = threading.Timer(limit, end)
        watch.daemon = True
        watch.start()
        try:
            _, status, used = os.wait4(program.pid, 0)
        finally:
            watch.cancel()
            kill()
        program.returncode = os.waitstatus_to_exitcode(status)
        if late.is_set():
            raise Failed(f"{command[0]}: no end within {limit:g} s")
        for stream in (said, wrong):
            stream.seek(0)
        out = said.read().decode(errors="replace")
        if program.returncode != 0:
            raise Failed(f"{command[0]}: status {program.returncode}\n{(out + wrong.read().decode())[-2000:]}")
    return out, used.ru_utime + used.ru_stime


def listed(rtl):
    return [rtl / line for line in (rtl / "servo_ic.f").read_text().splitlines() if not line.startswith("//")]


class Ours:
    """`brick_peers` of the built tree, by the name of the peer."""

    def __init__(self, name, tree):
        self.name, self.program = name, tree / "bin/brick_peers"

    def build(self, _folder):
        if not self.program.exists():
            raise Failed(f"{self.program} is not there; build it first")

    def play(self, steps, flip):
        return run([self.program, self.name, HERE / "writes.txt", steps, flip])


class SystemC:
    def build(self, folder):
        if shutil.which("verilator") is None:
            raise Missing("verilator is not installed")
        run(["verilator", "--sc", "--exe", "--build", "-j", "1", "--prefix", "Vservo_ic", "--top-module", "servo_ic",
             "-Mdir", folder, *VERILATE, "-CFLAGS", f"-O3 -std=c++17 -I{ROOT}", "-LDFLAGS", "-lsystemc",
             "-MAKEFLAGS", "OPT_FAST=-O3 OPT_GLOBAL=-O3", *listed(ROOT / "rtl"), HERE / "sc.cpp", "-o", "peer"],
            env={**os.environ, "OBJCACHE": "ccache"})
        self.program = folder / "peer"

    def play(self, steps, flip):
        return run([self.program, HERE / "writes.txt", steps, flip])


class Icarus:
    def build(self, folder):
        if shutil.which("iverilog") is None:
            raise Missing("iverilog is not installed")
        sources = []
        for file in listed(ROOT / "rtl"):  # Icarus 11 evaluates some `always_comb` without an end; `always @*` ends
            copy = folder / file.name
            copy.write_text(file.read_text().replace("always_comb", "always @*"))
            sources.append(copy)
        self.program = folder / "bench.vvp"
        run(["iverilog", "-g2012", "-o", self.program, "-s", "bench", *sources, HERE / "bench.sv"])

    def play(self, steps, flip):
        return run(["vvp", "-n", self.program, f"+writes={HERE / 'writes.txt'}", f"+steps={steps}", f"+flip={flip}"])


class Cocotb:
    """In an environment of its own: the release that the tests use wants a newer Verilator."""

    def build(self, folder):
        self.folder, self.python = folder, folder / "venv/bin/python"
        mark = folder / "venv" / COCOTB
        if not mark.exists():
            try:
                run([sys.executable, "-m", "venv", "--clear", folder / "venv"])
                run([self.python, "-m", "pip", "install", "--quiet", COCOTB])
            except Failed as failed:
                raise Missing(f"{COCOTB} cannot be installed: {str(failed).splitlines()[-1]}") from failed
            mark.touch()
        run([self.python, HERE / "cocotb_run.py", "build", folder, *listed(ROOT / "rtl")])

    def play(self, steps, flip):
        said = self.folder / "said.txt"
        said.unlink(missing_ok=True)
        _, seconds = run([self.python, HERE / "cocotb_run.py", "test", self.folder],
                         env={**os.environ, "WRITES": str(HERE / "writes.txt"), "STEPS": str(steps),
                              "FLIP": str(flip), "SAID": str(said)})
        if not said.exists():
            raise Failed("cocotb: its test has not ended")
        return said.read_text(), seconds


def peers(tree):
    """{name: (what it is, states that it plays, peer)}: fewer for slow ones."""
    return {"bare": ("bare Verilator: `--cc` in the loop of its examples", 60_000, Ours("bare", tree)),
            "rtl": ("`brick`, RTL: Verilated, clocks lowered without an evaluation", 60_000, Ours("rtl", tree)),
            "model": ("`brick`, SystemC model", 200_000, Ours("model", tree)),
            "sc": ("Verilator `--sc`: sc_clock, sc_signal", 20_000, SystemC()),
            "icarus": ("Icarus Verilog", 300, Icarus()),
            "cocotb": (f"{COCOTB.replace('==', ' ')} on Verilator", 400, Cocotb())}


def sums_of(text):
    """{step: checksum}"""
    return {int(words[0]): words[1] for words in map(str.split, text.splitlines())
            if len(words) == 2 and words[0].isdigit()}


def differing(sums):
    """The first step at which two peers have played alike and disagree."""
    for step in sorted({step for found in sums.values() for step in found}):
        said = {name: found[step] for name, found in sums.items() if step in found}
        if len(set(said.values())) > 1:
            return f"step {step}: " + ", ".join(f"{name} {value}" for name, value in said.items())
    return None


def measure(chosen, options):
    """{name: ticks a second}"""
    seconds, sums = {name: [] for name in chosen}, {}
    for _ in range(options.runs):
        for name, (_, own, peer) in chosen.items():
            flip, steps = int(name == options.flip), options.steps or own
            try:
                (_, idle), (said, busy) = peer.play(0, flip), peer.play(steps, flip)
            except Failed as failed:
                raise Failed(f"{name}: {failed}") from failed
            sums[name] = sums_of(said)
            if steps not in sums[name]:
                raise Failed(f"{name}: no checksum of step {steps}; it said {said[-300:]!r}")
            seconds[name].append(max(busy - idle, 1e-3) / steps)
        if wrong := differing(sums):
            raise Failed(f"the peers disagree at {wrong}")
    return {name: STATE_TICKS / statistics.median(found) for name, found in seconds.items()}


def build(chosen, tree):
    """Those that are installed."""
    there = {}
    for name, (what, own, peer) in chosen.items():
        folder = (tree / "peers" / name).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        try:
            peer.build(folder)
        except Missing as missing:
            print(f"{name} is left out: {missing}", flush=True)
            continue
        except Failed as failed:
            raise Failed(f"{name}: {failed}") from failed
        there[name] = what, own, peer
    return there


def row(what, rate, bare):
    return f"| {what} | {rate / 1e3:,.0f} | {f'{rate / bare:.3g}' if bare else '-'} |"


def table(chosen, rates):
    return "\n".join(["| engine | 1000 ticks/s | of the bare loop |", "|---|---|---|",
                      *(row(chosen[name][0], rate, rates.get("bare")) for name, rate in rates.items())])


def page(chosen, rates):
    return f"""<!-- Written by ./dev peers. Do not edit. -->
# Peers

One `servo_ic` in other simulators and in ours, {as_of(ROOT)}: the same stimulus, the
same checksum. Four encoders turn, a state in {STATE_TICKS} ticks, PWM and serial clocks run, and each state a register
is read and all output pins go into the checksum (`testbench/benchmark/peers/peer.h`); `./dev peers` fails when two
differ. In turn, median of five, ticks of 117.9648 MHz in a second of processor time, without start and build. The model
is looked at each {STATE_TICKS} ticks here; where nobody looks it sleeps until something happens.

{table(chosen, rates)}
"""


def main():
    known = list(peers(ROOT))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=known, default=known, metavar="PEER", help=", ".join(known))
    parser.add_argument("--steps", type=int, help="states of each peer, instead of its own number")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--tree", type=pathlib.Path, default=ROOT / "build/release", help="the built tree")
    parser.add_argument("--flip", choices=known, help="a peer that plays something else: its checksum must be found")
    parser.add_argument("--write", action="store_true", help=f"{PAGE}, of all peers")
    options = parser.parse_args()
    if options.runs < 1 or (options.steps is not None and options.steps < 1):
        parser.error("--runs and --steps: a number from 1 on")
    if options.flip and options.flip not in options.only:
        parser.error(f"--flip: {options.flip} does not play")
    if options.write and (options.only != known or options.steps or options.flip):
        parser.error("--write: of all peers, as they are")
    chosen = {name: entry for name, entry in peers(options.tree.resolve()).items() if name in options.only}
    try:
        there = build(chosen, options.tree)
        if not there or (options.flip and options.flip not in there):
            skip("nothing of what was asked for is installed")
        if options.write and len(there) < len(chosen):
            raise Failed(f"{PAGE} is of all peers, and not written without {', '.join(sorted({*chosen} - {*there}))}")
        rates = measure(there, options)
    except Failed as failed:
        print(f"peers: {failed}", file=sys.stderr)
        sys.exit(1)
    print(table(there, rates))
    if options.write:
        (ROOT / PAGE).write_text(page(there, rates))
    if len(there) < len(chosen):
        skip(f"without {', '.join(sorted({*chosen} - {*there}))}")
    if len(there) < 2:
        skip("one peer alone: no checksum is compared")


if __name__ == "__main__":
    main()
