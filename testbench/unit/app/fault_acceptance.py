"""The built command with a firmware that is wrong: it traps, hangs, or does not start.

usage: fault_acceptance.py BRICK CASE; each CASE is one test.
"""

import json
import pathlib
import re
import subprocess
import tempfile

import command
import faulty_image
from command import brick, check, play


def fault(kind, function, address):
    """The line that tells of an exception."""
    return (rf"exception of the CPU: {kind}, pc {address:#010x} \({function}\), at \d+\.\d{{6}} ms; "
            r"expected none, see docs/firmware.md, Traps")


def exceptions():
    """An exception of the CPU fails each command, with one line that says cause, address, pc, function and time. After
    more of them a second line counts them. On each engine: Machine.TellsExceptionsOfItsCpu."""
    store = fault("store access fault at 0x00000000", "card", faulty_image.address_of("card"))
    with tempfile.TemporaryDirectory() as folder:
        image = faulty_image.with_words(folder, "card", faulty_image.STORE)
        results = pathlib.Path(folder, "r.json")
        r = play(["CID", "@wait 50ms"], "--firmware", image, "--json", str(results))
        check(r.returncode == 1 and re.fullmatch(f"brick exec: {store}\n", r.stderr), f"{r}")
        made = json.loads(results.read_text())
        check(not made["passed"] and len(made["failures"]) == 1, f"{made}")
        check(re.fullmatch(store, made["failures"][0]) and made["failure"] == made["failures"][0], f"{made}")
        r = brick("console", "--firmware", image, script="CID\n")
        check(r.returncode == 1 and re.search(f"^brick console: {store}$", r.stderr, re.M), f"console: {r}")
        r = play(["CID", "@wait 50ms", "@reset", "CID", "@wait 50ms"], "--firmware", image)
        first, second = r.stderr.splitlines()
        check(re.fullmatch(f"brick exec: {store}", first), first)
        check(second.startswith("brick exec: exceptions of the CPU: 1 more, the last: store access fault at"), second)

        r = brick("run", "smoke", "--engine", "systemc", "--firmware", image, "--json", str(results))
        check(r.returncode == 1 and re.search(f"^brick run: {store}$", r.stderr, re.M), f"run: {r}")
        steps = json.loads(results.read_text())["steps"]
        check(any(step["name"] == "no error of the machine" and re.fullmatch(store, step["detail"]) and
                  not step["passed"] for step in steps), f"{steps}")

        illegal = faulty_image.with_words(folder, "card", faulty_image.ILLEGAL)
        r = play(["CID", "@wait 50ms"], "--firmware", illegal)
        told = fault("illegal instruction 0xffffffff", "card", faulty_image.address_of("card"))
        check(r.returncode == 1 and re.fullmatch(f"brick exec: {told}\n", r.stderr), f"{r}")
        served(faulty_image.with_words(folder, "start", faulty_image.STORE), results)
        for arguments in (["exec", "-"], ["console"], ["run", "smoke", "--engine", "systemc"]):
            r = brick(*arguments, script="CID\n")  # the same of the sound image
            check(r.returncode == 0 and r.stderr == "", f"{arguments}: {r}")


def served(image, results):
    r = brick("serve", "--listen", "127.0.0.1:0", "--firmware", image, "--json", str(results))
    check(r.returncode == 1 and "\nbrick serve: exception of the CPU: store access fault" in r.stderr, f"serve: {r}")
    check(len(json.loads(results.read_text())["failures"]) == 3, "does not answer, first exception, their number")


def starts():
    """A firmware that does not start: how long was waited, watchdog, where the CPU stands, the last exception."""
    with tempfile.TemporaryDirectory() as folder:
        start = faulty_image.address_of("_start")
        image = faulty_image.with_words(folder, "_start", faulty_image.LOOP)
        place = (r"nothing in 25\.\d{3} ms, the watchdog has tripped, the CPU stands at "
                 rf"{start:#010x} \((?:_start|__code_start)\)")
        r = brick("run", "smoke", "--engine", "systemc", "--firmware", image)
        step = rf"FAIL  controller answers: {place}, expected an acknowledge within 500 ms of power-on\n"
        check(r.returncode == 1 and re.search(step, r.stdout), f"{r}")
        r = play(["CID"], "--firmware", image)
        check(r.returncode == 1 and re.fullmatch(f"brick exec: the controller does not answer after power-on: {place}; "
                                                 "expected an acknowledge within 500 ms, see --jumper E3\n", r.stderr),
              f"{r}")
        image = faulty_image.with_words(folder, "start", faulty_image.ILLEGAL)
        r = play(["CID"], "--firmware", image)
        pc = faulty_image.address_of("start")
        check(r.returncode == 1 and re.search(
            rf"\(trap_exception\), its last exception: illegal instruction 0xffffffff, pc {pc:#010x} \(start\), at ",
            r.stderr.splitlines()[0]), f"{r}")


def hangs():
    """The same of one that hangs later: in a bench, in a script."""
    with tempfile.TemporaryDirectory() as folder:
        card = rf"{faulty_image.address_of('card') + 4:#010x} \(card\)"
        image = faulty_image.with_words(folder, "card", faulty_image.INTERRUPTS_OFF, faulty_image.LOOP)
        r = play(["CID"], "--firmware", image)
        check(r.returncode == 1 and re.search(rf"watchdog has tripped \(WDO\), the CPU stands at {card};", r.stderr),
              f"{r}")
        r = play(["CID"], "--firmware", faulty_image.with_words(folder, "cpu", faulty_image.LOOP))
        check(r.returncode == 0, f"another command: {r}")
        r = play(["CPU"], "--firmware", faulty_image.with_words(folder, "cpu", faulty_image.LOOP))
        check(r.returncode == 1 and re.search(r"no reply, the CPU stands at 0x[0-9a-f]{8} \(\w+\); expected", r.stderr),
              f"{r}")
        r = brick("run", "smoke", "--engine", "systemc", "--firmware", image)
        check(r.returncode == 1 and re.search(
            rf"FAIL  watchdog at the end: has tripped, the CPU stands at {card}\n", r.stdout), f"{r}")


def entry_points():
    """What is no place to begin at is bad input, of each command."""
    with tempfile.TemporaryDirectory() as folder:
        odd = faulty_image.address_of("_start") + 1
        for address, what in ((0, "lies outside memory; expected it in a loaded segment"),
                              (odd, "is odd; expected the address of an instruction")):
            image = faulty_image.with_entry(folder, address)
            for arguments in (["run", "smoke", "--engine", "systemc", "--firmware"], ["exec", "-", "--firmware"]):
                r = brick(*arguments, image, script="CID\n")
                check(r.returncode == 2 and r.stdout == "" and r.stderr.count("\n") == 1, f"{arguments}: {r}")
                check(f"{image}: entry point {address:#x} {what}" in r.stderr, f"{r}")


def covers_of_odd_images():
    """--cover without a line that it could be about: bad input, before anything runs."""
    with tempfile.TemporaryDirectory() as folder:
        info = pathlib.Path(folder, "c.info")
        stripped, moved = pathlib.Path(folder, "stripped.elf"), pathlib.Path(folder, "moved.elf")
        subprocess.run(["riscv64-unknown-elf-strip", "-g", "-o", stripped, faulty_image.image()], check=True)
        tree = str(command.REPOSITORY).encode()
        moved.write_bytes(faulty_image.image().read_bytes().replace(tree, b"/" + b"x" * (len(tree) - 1)))
        sound = faulty_image.image()
        for bench, image, what in (("smoke", stripped, "stripped.elf has no line table; expected an image with"),
                                   ("smoke", moved, "crt0.S for example; expected them where they were"),
                                   ("port-a-phase", sound, "no firmware runs in port-a-phase; expected no")):
            r = brick("run", bench, "--engine", "systemc", "--firmware", str(image), "--cover", str(info))
            check(r.returncode == 2 and r.stdout == "" and r.stderr.count("\n") == 1, f"{image}: {r}")
            check(f"--cover {info}: " in r.stderr and what in r.stderr and not info.exists(), f"{image}: {r}")


globals()[command.CASE]()
