"""Waveforms that the built command writes: names, data, windows and groups (docs/signals.md).

usage: wave_acceptance.py BRICK CASE; each CASE is one test.
"""

import pathlib
import re
import tempfile

import command
from command import brick, check, play


def wave_window():
    with tempfile.TemporaryDirectory() as folder:
        for ending in ("vcd", "fst"):
            r = play(["VERSION", "@wait 1ms"], "--wave", f"{folder}/new/x.{ending}", "--wave-from", "1ms", "--wave-to",
                     "14ms")
            check(r.returncode == 0, r.stderr)
            check(pathlib.Path(f"{folder}/new/x.{ending}").stat().st_size > 1000, ending)
        times = [int(t) for t in re.findall(r"^#(\d+)", pathlib.Path(f"{folder}/new/x.vcd").read_text(), re.M)]
        check(times[0] == 10**9 and times[-1] <= 14 * 10**9, f"{times[0]} to {times[-1]} ps")
        for arguments, said in ((["exec", "-"], ""), (["run", "smoke", "--engine", "systemc"], "x.vcd, empty\n")):
            late, on_time = (brick(*arguments, "--wave", f"{folder}/x.vcd", "--wave-from", t, script="") for t in
                             ("10s", "1ms"))
            check(late.returncode == 0 and late.stderr.count("\n") == 1 and said in late.stdout, f"late: {late}")
            check(re.search(r"x\.vcd: is empty, because the run has ended at [\d.]+ ms; expected --wave-from before, "
                            r"not 10000\.000 ms$", late.stderr), f"late: {late}")
            check(on_time.stderr == "" and ", empty" not in on_time.stdout, f"in time: {on_time}")


def names_in(text):
    """Full name -> identifier code of the variables of a VCD."""
    scope, codes = [], {}
    for line in text.split("$enddefinitions")[0].splitlines():
        word = line.split()
        if word[0] == "$scope":
            scope.append(word[2])
        elif word[0] == "$upscope":
            scope.pop()
        elif word[0] == "$var":
            codes[".".join([*scope, word[4]])] = word[3]
    return codes


# covers: CARD-4
def trace():
    """--trace chooses what goes into a waveform; without it everything does but the serial clocks."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(f"{folder}/x.vcd")

        def names(*options):
            r = play(["@wait 1ms"], "--wave", str(file), *options)
            check(r.returncode == 0, r.stderr)
            return set(names_in(file.read_text()))

        everything, default = names("--trace", "all"), names()
        serial = {n for n in everything if n.endswith((".dac_clk", ".adc_clk"))}
        check(len(serial) == 16 and default == everything - serial, f"left out: {sorted(everything - default)}")
        clocks = {n for n in everything if n.startswith("brick.clock.")}
        check(len(clocks) >= 4, str(clocks))
        for options in (["--trace", "clock.*,host.breq"], ["--trace", "clock.*", "--trace", "breq"]):
            check(names(*options) == clocks | {"brick.host.breq"}, str(options))
        name = "servo_ic1.ch2.dac_clk"  # the clock of the whole IC, under one of its names
        check(names("--trace", name) == {"brick." + name}, name)
        code = names_in(file.read_text())["brick." + name]
        check(len(re.findall(rf"^1{re.escape(code)}$", file.read_text(), re.M)) > 100, f"{name} does not move")


# covers: CARD-4
def wave():
    """A bench writes a VCD with the contract's names and data in them, the same on every engine."""
    names = """
        clock.phase clock.servo clock.source host.breq host.irq host.ipos host.eror host.f1er host.hreq host.wdo
        host.isa.sa host.isa.sd host.isa.ior_n host.isa.iow_n host.isa.memr_n host.isa.memw_n host.isa.iochrdy
        host.isa.aen host.pic.ist host.pic.sig host.pic.msk host.pic.elr dpram.busy_host dpram.busy_cpu
        bus.addr bus.data bus.aa bus.rd_n bus.wr_n bus.ta_n cpu.pc cpu.task cpu.symbol watchdog.tripped"""
    texts = []
    with tempfile.TemporaryDirectory() as folder:
        for engine in ("systemc", "rtl", "lockstep"):
            file = pathlib.Path(f"{folder}/{engine}.vcd")
            r = brick("run", "smoke", "--engine", engine, "--wave", str(file))
            check(r.returncode == 0, r.stdout + r.stderr)
            texts.append(file.read_text())
    check(texts[0] == texts[1] == texts[2], "the waveforms of the engines differ")
    codes = names_in(texts[0])
    for name in names.split():
        check("brick." + name in codes, f"no signal {name}")
    least_changes = {"clock.phase": 100, "clock.servo": 40, "host.isa.sa": 100, "host.isa.sd": 100, "host.pic.msk": 3,
                     "bus.addr": 20, "cpu.pc": 100, "cpu.symbol": 100, "cpu.task": 50, "host.isa.memw_n": 30}
    for name, least in least_changes.items():
        changes = len(re.findall(rf"^(?:[01]|b[01]+ |s\S+ ){re.escape(codes['brick.' + name])}$", texts[0], re.M))
        check(changes >= least, f"{name} changes {changes} times, expected {least} or more")


globals()[command.CASE]()
