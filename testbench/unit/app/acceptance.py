"""The built command from outside: replies, times, exit statuses, messages.

usage: acceptance.py BRICK CASE; each CASE is one test.
"""

import collections
import json
import os
import pathlib
import pty
import re
import subprocess
import tempfile

import backup_file
import command
from command import BOARDS, brick, check, play

GOLDEN = ["VERSION", "CID", "I19", "I16", "I17", "I124", "I124=I124|$20000", "I124", "i20 i21 i22 i23",
          "M1->X:$078001,0,24,S", "M1->", "#1?", "&2DEFINE ROTARY 200", "&1DEFINE ROTARY 200", "&2DEFINE ROTARY 50"]
# the three DEFINEs: nothing, nothing, lower-numbered buffer exists
ANSWERS = ["1.947", "603382", "7007", "5", "10", "$1", "$20001", "$0", "$0", "$0", "$0", "X:$78001,24,S",
           "850000000000", "ERR003"]


# covers: CARD-3
def golden():
    r = play(GOLDEN)
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    check(r.stdout.split() == ANSWERS, f"{r.stdout.split()}, expected {ANSWERS}")


# covers: CARD-1 CARD-2
def same_everywhere():
    """Every reply and its simulated time, on all engines and batch sizes."""
    commands = [*GOLDEN, "&1B0", "OPEN ROT", "X1", "DWELL1", "R", "@wait 3ms", "PR", "@pic", "@dpram 0xC000 4"]
    lines = [line for command in commands for line in (command, "@time")]
    runs = [("systemc", "0"), ("rtl", "0"), ("lockstep", "0"), ("systemc", "1000"), ("systemc", "7"), ("rtl", "64")]
    first = None
    for engine, batch in runs:
        r = play(lines, "--engine", engine, "--batch", batch)
        check(r.returncode == 0, f"{engine} batch {batch}: exit {r.returncode}: {r.stderr}")
        check(r.stdout.count("time=") == len(lines) // 2, f"{engine}: {r.stdout}")
        first = first or r.stdout
        check(r.stdout == first, f"{engine} batch {batch} differs:\n{r.stdout}\nexpected as systemc:\n{first}")


def version():
    """What the command says is what the build has and what the newest entry of the change log is about."""
    tree = pathlib.Path(__file__).resolve().parents[3]
    said = brick("--version").stdout
    built = re.search(r"^project\(brick VERSION (\S+)", (tree / "CMakeLists.txt").read_text(), re.M)[1]
    newest = re.search(r"^## (\S+)", (tree / "CHANGELOG.md").read_text(), re.M)[1]
    check(said == f"brick {built}\n" and newest == built, f"{said!r}, CMakeLists.txt {built}, CHANGELOG.md {newest}")


def at_lines():
    r = play(["@pic", "@pic MSK=12 ELR=10", "@pic", "@dpram 0xC000 = 1234 ABCD", "@dpram 0xC000 2",
              "@signal clock.source", "@until clock.servo=0 1ms", "@until clock.servo=1 1ms", "@signal clock.servo",
              "I16", "@expect 5", "P1..3", "@expect 0|0|0", "UUU", "@expect ERR003", "@wait 1ms", "@time"])
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    out = r.stdout.split("\n")
    check(re.fullmatch(r"IST=00 SIG=[0-9A-F]{2} MSK=00 ELR=00", out[0]), out[0])
    check(re.fullmatch(r"IST=[0-9A-F]{2} SIG=[0-9A-F]{2} MSK=12 ELR=10", out[1]), out[1])
    check(out[2:5] == ["1234 ABCD", "clock.source=7007", "clock.servo=1"], str(out))
    check(re.fullmatch(r"time=\d+ ns", out[-2]), out[-2])


def motor_pins():
    """The hand at encoder 6 (servo IC 1, channel 2) counts, with x4 both ways; an input pin is a signal at once."""
    r = play(["@encoder 6 37 100000", "@signal servo_ic1.ch2.count", "@expect servo_ic1.ch2.count=37",
              "@encoder 6 -40 100000", "@signal servo_ic1.ch2.count", "@expect servo_ic1.ch2.count=-3",
              "@until servo_ic1.ch2.count=-3 1us", "@signal servo_ic0.ch1.count", "@expect servo_ic0.ch1.count=0",
              "@input servo_ic0.ch1.hmfl=1", "@signal servo_ic0.ch1.hmfl", "@expect servo_ic0.ch1.hmfl=1",
              "@until servo_ic0.ch1.adc_strobe=1 200us", "@until servo_ic0.ch1.adc_strobe=0 200us"])
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    r = play(["@input host.mi1=1", "@signal mi1", "@expect mi1=1"])
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    r = play(["@input servo_ic0.ch1.pwm_a_top=1"])
    check(r.returncode == 2 and "is no input pin" in r.stderr, r.stderr)
    r = play(["@encoder 9 1"])
    check(r.returncode == 2 and "expected 1 to 8" in r.stderr, r.stderr)


def restarts():
    r = play(["I16=7", "P1=3", "@reset", "I16", "@expect 5", "I16=8", "@power", "I16", "@expect 5", "I16=9", "$$$",
              "I16", "@expect 5", "VERSION"])
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    check(r.stdout.split() == ["5", "5", "5", "1.947"], r.stdout)
    r = play(["I16=7", "@power", "I16", "@dpram 0x40 = 1234", "@dpram 0x40 1", "@expect 1234"], "--board",
             "turbo-pmac2-pci")
    check(r.returncode == 0 and r.stdout.split()[:1] == ["5"], f"the bridge is set up again: {r.stdout}{r.stderr}")


def flash():
    with tempfile.TemporaryDirectory() as folder:
        file = f"{folder}/flash.bin"
        check(play(["I16=7", "SAVE"], "--flash", file).returncode == 0, "SAVE")
        check(play(["I16"], "--flash", file).stdout.split() == ["7"], "SAVEd value is back at the next start")
        check(play(["I16"], "--flash", file, "--jumper", "E3").stdout.split() == ["5"], "jumper E3 gives the default")
        check(play(["I16"]).stdout.split() == ["5"], "another controller has the default")


def raw():
    r = play(["I16", "P1=1", "UUU"], "--raw")
    check(r.stdout.split("\n")[:3] == ["5<0D><06>", "<06>", "<07>ERR003<0D>"], r.stdout)


def boards():
    r = brick("boards")
    rows = {line.split()[0]: line.split() for line in r.stdout.splitlines()}
    check(r.returncode == 0 and rows["geobrick-lv-4"][1:5] == ["4", "0", "-", "7007"], r.stdout + r.stderr)
    check(rows["umac-turbo"][1:6] == ["8", "2", "3", "0", "6807"] and "yes" in rows["turbo-pmac-pci"], r.stdout)
    found = {b["name"]: b["ics"] for b in json.loads(brick("boards", "--json").stdout)}
    check(found["geobrick-lv-4"] == ["servo IC 0"] and found["geobrick-lv-8"] == ["servo IC 0", "servo IC 1"],
          str(found))
    one = brick("boards", "turbo-pmac2-pci-lite").stdout
    check("IR5 EQU1, IR6 EQU2, IR7 WDO" in one and "I19=7007" in one and "control panel    none" in one, one)
    small = brick("boards", "turbo-pmac-pci").stdout
    check("JPAN, Y:$078800" in small and "$060000..$060FFF" in small and "0x3FFF" in small and "TYPE TURBO1" in small,
          small)
    file = json.loads(brick("boards", str(BOARDS / "geo-pmac.toml"), "--json").stdout)
    check((file["axes"], file["jpan"], file["feedback_option_2"], file["interrupts"][7]) == (2, False, True, "WDO"),
          str(file))
    keys = ("io_base", "io_decode", "dpram_window", "dpram_window_kib", "slot", "pic")
    card = json.loads(brick("boards", "umac-turbo", "--json").stdout)
    check([card[k] for k in keys] == [0x210, 16, 0xD4000, 16, 16, "pic"], str(card))
    check("io_base" not in file, "a host inside the product has no switches")
    with tempfile.TemporaryDirectory() as folder:
        other = pathlib.Path(folder) / "slot.toml"
        other.write_text((BOARDS / "pmac-pc.toml").read_text() +
                         "io_base = 0x330\nio_decode = 10\ndpram_window = 0xCC000\nslot = 8\n")
        shown = brick("boards", str(other)).stdout
        check(all(re.search(line, shown) for line in (
            r"host bus +isa, 8 bits\n", r"host I/O +0x330\.\.0x33F, 10 address bits\n",
            r"host memory +0xCC000\.\.0xCFFFF, 16 KiB a page\n")), shown)
        card = json.loads(brick("boards", str(other), "--json").stdout)
        check([card[k] for k in keys] == [0x330, 10, 0xCC000, 16, 8, "8259"], str(card))
        r = play(["VERSION", "@dpram 0x40 = 1234", "@dpram 0x40 1", "@expect 1234"], "--board", str(other))
        check(r.returncode == 0, r.stdout + r.stderr)
    check(play(["VERSION"], "--board", "geobrick-lv-4").stdout.split() == ["1.947"], "four axes")


def pic_8259():
    """The other interrupt controller as a user sees it."""
    r = play(["@pic", "@expect IRR=00 ISR=00 IMR=FF", "@input host.mi1=1", "@signal host.irq", "@expect host.irq=0"],
             "--board", "pmac-pc")
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    r = play(["@pic clear"], "--board", "pmac-pc")
    check(r.returncode == 2 and "the interrupt controller of this board is an 8259" in r.stderr, r.stderr)
    check("by an 8259" in brick("boards", "pmac-pc").stdout, "brick boards")


def dialogue():
    """I3, I4, I6 and restarts in the middle of a script do not lose the dialogue."""
    lines, expected = [], []
    for i3, i4, i6 in ((0, 0, 1), (1, 0, 0), (2, 1, 3), (3, 1, 1), (0, 1, 2), (1, 1, 3), (3, 0, 0), (2, 0, 1)):
        lines += [f"I16 I3={i3} I4={i4} I6={i6}", "I16 I17", "P1=1", "I16 UUU", "I17"]
        expected += ["5", "5", "10", "5", "ERR003" if i6 % 2 else "ERR", "10"]
    for line in ("$$$", "I16=7 $$$", "I3=0 $$$***", "I16=7 I4=1 $$$***", "I3=1 SAVE", "I3=0", "SAVE"):
        lines += [line, "I16 I17"]
        expected += ["5", "10"]
    r = play(lines)
    check(r.returncode == 0 and r.stdout.split() == expected, f"{r.stdout.split()}, expected {expected}: {r.stderr}")
    check(r.stderr.count("I16 UUU") == 8 and "stdin:4: `I16 UUU`: ERR003: unknown command" in r.stderr, r.stderr)
    r = play(["UUU", "@expect ERR003", "UUU $$$", "I16", "@expect 5"])
    check(r.returncode == 0 and r.stderr.count("\n") == 2 and "stdin:3: " in r.stderr, "expected errors are not told")


def command_files():
    """Comments, includes, macros and conditions as host programs read them; errors with file and line."""
    with tempfile.TemporaryDirectory() as folder:
        job = pathlib.Path(folder) / "job.pmc"
        (pathlib.Path(folder) / "names.pmc").write_text("#define HEIGHT Q7\n#define SCALE(m,n) #m->n##X\n\nFROB\n")
        job.write_text('''; a job
#include "names.pmc"  // names of variables
#define SUM(a, b) ((a)+(b))
#ifdef HEIGHT
HEIGHT = SUM(1, SUM(2,3))
#else
UUU
#endif
/* over
lines */ HEIGHT
@expect 6
#1->1000X
#1->
@expect 1000X
#1p ; a motor, no directive
I16
''')
        r = brick("exec", str(job), "--json", f"{folder}/x.json")
        check(r.returncode == 0 and r.stdout.split() == ["ERR003", "6", "1000X", "0", "5"], r.stdout + r.stderr)
        check(f"brick exec: {folder}/names.pmc:4: `FROB`: ERR003: unknown command" in r.stderr, r.stderr)
        check("1 of 9 lines refused: 1 x ERR003" in r.stderr, r.stderr)
        found = json.loads(pathlib.Path(f"{folder}/x.json").read_text())["exchanges"]
        check(found[-1] == {"place": f"{job}:16", "line": "I16", "reply": ["5"], "error": False}, str(found))
        for bad, what in (("#include \"none.pmc\"", f"{job}:1: `{folder}/none.pmc` cannot be read; expected"),
                          ("#define L " + "X" * 300 + "\nL", f"{job}:2: `L` expands to 300 characters; expected"),
                          ("#include \"job.pmc\"", "expected no file that includes itself"),
                          ("#ifdef A", f"{job}:1: a condition without its end; expected #endif"),
                          ("I16\n@frob", f"{job}:2: @frob: ")):
            job.write_text(bad + "\n")
            r = brick("exec", str(job))
            check(r.returncode == 2 and r.stdout == "" and r.stderr.count("\n") == 1 and what in r.stderr, r.stderr)


# What the image does not have yet. It must be exactly this: what is not refused any more is struck out here.
REFUSED_TODAY = {"PLC"}
MOST_REFUSED = 20  # of 30,000 lines, but for those


# covers: CARD-3
def backup():
    """The backup of a controller loads; what is refused is told with its place, and nothing is lost on the way."""
    with tempfile.TemporaryDirectory() as folder:
        places = backup_file.write(folder)
        job = pathlib.Path(folder) / "backup.pmc"
        values = backup_file.p_values()
        asked = range(2000, 8192, 43)  # lines of PLCs that cannot be opened assign lower ones
        job.write_text(job.read_text() + "FROB ; a fault\n" + "".join(f"P{n}\n" for n in asked) + "I3\nI5189\n")
        r = brick("exec", str(job), "--json", f"{folder}/x.json", timeout=550)
        check(r.returncode == 0, r.stderr)
        exchanges = json.loads(pathlib.Path(f"{folder}/x.json").read_text())["exchanges"]
    check(len(places) >= 30000, f"{len(places)} lines, expected 30,000")
    sent = [e["line"] for e in exchanges[:len(places)]]
    check(sent == [line for _, line in places.values()], "other lines were sent")
    refused = [e for e in exchanges if e["error"]]
    check(refused[-1]["line"] == "FROB" and refused[-1]["place"].startswith(str(job)), str(refused[-1]))
    kinds = collections.Counter(places[e["place"]][0] for e in refused[:-1])
    print(f"{len(places)} lines, {len(refused) - 1} refused: {dict(kinds)}")
    check(set(kinds) >= REFUSED_TODAY, f"not refused any more, strike it out: {REFUSED_TODAY - set(kinds)}")
    others = [e for e in refused[:-1] if places[e["place"]][0] not in REFUSED_TODAY]
    check(len(others) <= MOST_REFUSED, f"{len(others)} refused, expected at most {MOST_REFUSED}: {others[:5]}")
    told = [line for line in r.stderr.splitlines() if "`: ERR" in line]
    check(len(told) == min(len(refused), 50), f"{len(told)} refused lines told")
    for line, e in zip(told, refused, strict=False):
        check(line.startswith(f"brick exec: {e['place']}: `{e['line']}`: {e['reply'][-1]}: "), f"{line}: {e}")
    check(f"{len(refused)} of {len(exchanges)} lines refused" in r.stderr, r.stderr[-200:])
    answers = [float(e["reply"][0]) for e in exchanges[-len(asked) - 2:]]
    wrong = [(n, a) for n, a in zip(asked, answers, strict=False) if abs(a - values[n]) > 1e-9 * max(1, abs(values[n]))]
    check(not wrong, f"P variables hold other values than were sent: {wrong}")
    check(answers[-2:] == [2, 1000], str(answers[-2:]))


def progress():
    """A terminal on stderr sees one line that moves on and goes away; a file sees nothing."""
    script = "".join(f"P{n}={n}\n" for n in range(8000)) + "FROB\n"
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "long.pmc"
        file.write_text(script)
        check(brick("exec", str(file)).stderr.count("\n") == 2, "silent but for the refused line")
        mine, terminal = pty.openpty()
        with subprocess.Popen([command.BRICK, "exec", str(file)], stdout=subprocess.PIPE, stderr=terminal) as run:
            os.close(terminal)
            seen = b""
            while chunk := read_some(mine):
                seen += chunk
        check(run.returncode == 0, seen.decode())
    lines = [int(n) for n in re.findall(rb"\r\x1b\[Kexec: [^\r]*, line (\d+) of 8001, \d refused", seen)]
    check(len(lines) >= 2 and lines == sorted(lines) and lines[-1] > lines[0], str(lines))
    check(b"\r\x1b[Kbrick exec: " in seen and seen.endswith(b"1 x ERR003\r\n"), str(seen[-200:]))


def read_some(terminal):
    try:
        return os.read(terminal, 4096)
    except OSError:  # the other end is closed
        return b""


# covers: BREQ-6
def jpan():
    """The panel selects whose BREQ the host sees; the same times on all engines."""
    lines = ["&2DEFINE ROTARY 40", "OPEN ROTARY", "CLOSE", "&1", "I2=0", "@signal breq", "@expect breq=0",
             "@jpan FPD=2", "@until breq=1 3ms", "@time", "@jpan FPD3=0", "@until breq=0 3ms", "@jpan FPD=0 START=0",
             "@wait 3ms", "I59", "@expect 2", "@jpan START=1 FPD=2", "@until breq=1 3ms",
             "@signal brld_n", "@expect brld_n=0",
             "I2=1", "@signal breq", "@expect breq=0", "@signal host.jpan", "@expect host.jpan=$FDFF", "@time",
             "@jpan INIT=0", "@wait 300ns", "@jpan INIT=1", "I59", "@expect 2",  # a spike
             "@jpan INIT=0", "@wait 10us", "@jpan INIT=1", "I59", "@expect 0", "@time"]
    first = None
    for engine in ("systemc", "rtl", "lockstep"):
        r = play(lines, "--board", "turbo-pmac-pci", "--engine", engine)
        check(r.returncode == 0, f"{engine}: exit {r.returncode}: {r.stderr}")
        first = first or r.stdout
        check(r.stdout == first, f"{engine}: {r.stdout}, expected {first}")
    for line in ("VERSION", "@reset", "@power"):
        r = play(["@jpan INIT=0", "@wait 10us", line], "--board", "turbo-pmac-pci")
        check(r.returncode == 1 and "stdin:3: " in r.stderr and r.stderr.count("\n") == 1,
              f"{line} while INIT is low: exit {r.returncode}: {r.stderr}")
    r = play(["VERSION", "@jpan FPD=1"])
    check(r.returncode == 2 and r.stdout == "", f"exit {r.returncode}: {r.stdout}")
    check("stdin:2: @jpan: this board has no control panel port; expected" in r.stderr and r.stderr.count("\n") == 1,
          r.stderr)


# covers: CARD-6
def aperture():
    """Pins that move near an edge are taken early or late by the seed, alike on every engine and at every batch."""
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)

        def run(*options):
            r = brick("run", "smoke", "--wave", str(place / "x.vcd"), "--json", str(place / "x.json"), *options)
            check(r.returncode == 0, r.stdout + r.stderr)
            return (place / "x.vcd").read_text(), json.loads((place / "x.json").read_text())["aperture"]

        trace, moves = run("--engine", "systemc", "--aperture", "1")
        # A nanosecond on both sides of an edge of 8.48 ns is some 24 % of all moves.
        inside = moves["early"] + moves["late"] + moves["split"]
        check(moves["fs"] == 10**6 and moves["moves"] / 8 < inside < moves["moves"] / 3, str(moves))
        check(min(moves["early"], moves["late"], moves["split"]) > 200, str(moves))
        check(abs(moves["early"] - moves["late"]) < inside / 10, f"not as often early as late: {moves}")
        for options in (["--engine", "rtl"], ["--engine", "lockstep", "--batch", "1000"],
                        ["--engine", "systemc", "--batch", "7"], ["--engine", "systemc", "--batch", "64"]):
            other, counts = run("--aperture", "1", *options)
            check(counts == moves, f"{options}: {counts}, expected {moves}")
            check(other == trace, f"{options}: another waveform")
        none, counts = run("--engine", "systemc")
        check(counts == {"fs": 0, "moves": counts["moves"], "early": 0, "late": 0, "split": 0}, str(counts))
        check(none != trace, "the aperture moves nothing")
        check(run("--engine", "systemc", "--aperture", "1", "--seed", "2")[0] != trace, "the seed chooses nothing")
    # The checkers of the buses look at the pins, not at what the board takes of them.
    for bench, seed in (("bus-timing", "1"), ("bus-timing", "9"), ("bus-timing", "25"), ("isa-timing", "1")):
        r = brick("run", bench, "--engine", "systemc", "--aperture", "1", "--seed", seed)
        check(r.returncode == 0, r.stdout + r.stderr)


def lists():
    benches = json.loads(brick("list", "--json").stdout)
    check({"smoke", "breq-rotary"} <= {b["name"] for b in benches}, str(benches))
    text = brick("list").stdout
    check(all(b["name"] in text and b["description"] in text for b in benches), text)


def statuses():
    check(brick("--help").returncode == 0 and brick("exec", "--help").returncode == 0, "help")
    check(play(["@until host.breq=1 1ms"]).returncode == 1, "@until at its limit")
    check(play(["I16", "@expect 6"]).returncode == 1, "@expect")
    check(play(["UUU"]).returncode == 0, "an ERR reply is an answer")
    r = play(["I16", "@expect 6", "I17"])
    check("stdin:2" in r.stderr and "`5`" in r.stderr and "`6`" in r.stderr and r.stdout.split() == ["5"],
          r.stderr + r.stdout)


def contention():
    """Two sources of the clocks: the controller goes on, the run fails with one line that names them."""
    for engine in ("systemc", "lockstep"):
        r = play(["I7107=0", "@wait 1ms", "VERSION"], "--engine", engine)
        check(r.returncode == 1, f"exit {r.returncode}, expected 1: {r.stderr}")
        check(r.stdout.split() == ["1.947"], r.stdout)
        check(re.fullmatch(r"brick exec: clock contention from tick \d+ \(.*\): servo IC 0 \(I7007\) and "
                           r"servo IC 1 \(I7107\) drive .*; expected one source\n",
                           r.stderr), r.stderr)
    r = play(["I7107=0 I7007=3", "@wait 1ms", "I7007=0 I7107=3", "@wait 1ms"])
    check(r.returncode == 0 and r.stderr == "", f"moved there and back: exit {r.returncode}: {r.stderr}")


def bad_input():
    """One line on stderr that says what, where, and what was expected; exit status 2."""
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        (place / "bad.elf").write_text("no program")
        (place / "bad.toml").write_text("colour = 1\n")
        (place / "bad.flash").write_text("short")
        for arguments, script, what in [
            ([], "", "brick"),
            (["frob"], "", "frob"),
            (["run"], "", "BENCH"),
            (["run", "nothing"], "", "nothing"),
            (["exec"], "", "FILE"),
            (["exec", f"{folder}/none.txt"], "", "none.txt"),
            (["exec", folder], "", folder),
            (["exec", "-", "--engine", "verilog"], "", "verilog"),
            (["exec", "-", "--frob"], "", "--frob"),
            (["exec", "-", "--seed", "x"], "", "--seed"),
            (["exec", "-", "--batch", "-1"], "", "--batch"),
            (["exec", "-", "--aperture", "1.1"], "", "--aperture 1.1"),
            (["run", "smoke", "--aperture", "-1"], "", "--aperture -1"),
            (["run", "smoke", "--aperture", "x"], "", "--aperture x"),
            (["exec", "-", "--jumper", "E4"], "", "E4"),
            (["exec", "-", "--board", "nothing"], "", "nothing"),
            (["exec", "-", "--board", f"{folder}/none.toml"], "", "none.toml"),
            (["exec", "-", "--board", f"{folder}/bad.toml"], "", "bad.toml:1"),
            (["boards", "nothing"], "", "board nothing"),
            (["boards", f"{folder}/bad.toml"], "", "bad.toml:1"),
            (["exec", "-", "--firmware", f"{folder}/none.elf"], "", "none.elf"),
            (["exec", "-", "--firmware", f"{folder}/bad.elf"], "", "bad.elf"),
            (["exec", "-", "--flash", f"{folder}/none/flash"], "", "none/flash"),
            (["exec", "-", "--flash", f"{folder}/bad.flash"], "", "bad.flash"),
            (["exec", "-", "--json", f"{folder}/none/x.json"], "", "none/x.json"),
            (["exec", "-", "--wave", f"{folder}/x.txt"], "", "x.txt"),
            (["exec", "-", "--wave", "/proc/none/x.vcd"], "", "/proc/none"),
            (["exec", "-", "--wave", f"{folder}/x.vcd", "--wave-from", "10"], "", "--wave-from"),
            (["exec", "-", "--wave-to", "10ms"], "", "--wave-to"),
            (["exec", "-", "--trace", "all"], "", "--trace"),
            (["exec", "-", "--wave", f"{folder}/x.vcd", "--trace", "clock.*,nothing.*"], "", "nothing.*"),
            (["exec", "-", "--wave", f"{folder}/x.vcd", "--trace", "servo_ic9.*"], "", "servo_ic9.*"),
            (["exec", "-", "--wave", f"{folder}/x.vcd", "--trace", "clock.*,,breq"], "", "clock.*,,breq"),
            (["exec", "-"], "VERSION\n@frob\n", "stdin:2: @frob"),
            (["exec", "-"], "VERSION\n@signal nothing.here\n", "stdin:2: @signal"),
            (["exec", "-"], "@until host.breq=2 1ms\n", "stdin:1: @until"),
            (["exec", "-", "--board", "turbo-pmac-pci"], "@jpan GO=0\n", "stdin:1: @jpan"),
            (["exec", "-", "--board", "turbo-pmac-pci"], "@jpan FPD=16\n", "`FPD=16`"),
            (["exec", "-"], "@input USER1=0\n", "no signal `USER1`"),
            (["cpu", f"{folder}/none.elf"], "", "none.elf"),
            (["cpu", f"{folder}/bad.elf"], "", "bad.elf"),
            (["cpu", f"{folder}/bad.elf", "--max-instructions", "x"], "", "--max-instructions"),
        ]:
            r = brick(*arguments, script=script)
            name = "brick " + " ".join(arguments)
            check(r.returncode == 2, f"{name}: exit {r.returncode}, expected 2: {r.stderr}")
            check(r.stdout == "", f"{name}: prints {r.stdout}")
            check(r.stderr.count("\n") == 1, f"{name}: not one line: {r.stderr}")
            check(what in r.stderr and "expected" in r.stderr, f"{name}: {r.stderr}")


# covers: WDT-1 WDT-2
def dead_flash():
    """A flash file with settings that stop the controller outlives the process; jumper E3 and SAVE repair it."""
    ask = ["VERSION", "I17", "I19"]
    with tempfile.TemporaryDirectory() as folder:
        file = f"{folder}/flash.bin"
        r = play(["I17=33 I8=0 I7100=20 I7101=0 I7102=0 I19=7107", "SAVE", "VERSION"], "--flash", file)
        check(r.returncode == 0 and r.stdout.split() == ["1.947"], r.stdout + r.stderr)
        for engine in ("systemc", "rtl"):
            r = play(ask, "--flash", file, "--engine", engine)
            check(r.returncode == 1 and r.stdout == "" and "does not answer" in r.stderr and "--jumper E3" in r.stderr,
                  r.stdout + r.stderr)
        r = play(ask, "--flash", file, "--jumper", "E3")
        check(r.returncode == 0 and r.stdout.split() == ["1.947", "10", "7007"], r.stdout + r.stderr)
        check(play(ask, "--flash", file).returncode == 1, "the jumper does not change what is SAVEd")
        check(play(["SAVE"], "--flash", file, "--jumper", "E3").returncode == 0, "SAVE")
        r = play(ask, "--flash", file)
        check(r.returncode == 0 and r.stdout.split() == ["1.947", "10", "7007"], r.stdout + r.stderr)
        r = play(["I19=7957", "SAVE", "@reset", "@wait 40ms", "@signal watchdog.tripped", "@jumper E3 on", "@power",
                  "I19", "@jumper E3 off"])
        check(r.stdout.split() == ["watchdog.tripped=1", "7007"], r.stdout + r.stderr)


def installed():
    """`cmake --install` gives a command that finds its firmware and boards, wherever it stands."""
    build = pathlib.Path(command.BRICK).resolve().parent.parent
    with tempfile.TemporaryDirectory() as folder:
        r = subprocess.run(["cmake", "--install", str(build), "--prefix", folder], capture_output=True, text=True)
        check(r.returncode == 0, r.stdout + r.stderr)
        command.BRICK = f"{folder}/bin/brick"
        golden()
        boards()


def wave_window():
    with tempfile.TemporaryDirectory() as folder:
        for ending in ("vcd", "fst"):
            r = play(["VERSION", "@wait 1ms"], "--wave", f"{folder}/new/x.{ending}", "--wave-from", "1ms", "--wave-to",
                     "14ms")
            check(r.returncode == 0, r.stderr)
            check(pathlib.Path(f"{folder}/new/x.{ending}").stat().st_size > 1000, ending)
        times = [int(t) for t in re.findall(r"^#(\d+)", pathlib.Path(f"{folder}/new/x.vcd").read_text(), re.M)]
        check(times[0] == 10**9 and times[-1] <= 14 * 10**9, f"{times[0]} to {times[-1]} ps")


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
