"""The built command from outside: replies, times, exit statuses, messages.

usage: acceptance.py BRICK CASE; each CASE is one test.
"""

import json
import os
import pathlib
import re
import signal
import subprocess
import tempfile

import command
import exchange_file
from command import BOARDS, REPOSITORY, brick, check, play

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


# covers: CARD-3 BIN-2 BREQ-3 BREQ-4 I18-3 I19-1
def exchanges():
    """The golden exchanges and every command of firmware:11, byte for byte. On the model: the image that answers is the
    same on each engine."""
    for name in ("golden.txt", "commands.txt"):
        exchanges_on("systemc", name)


def exchanges_lockstep():
    """The golden ones reach each part of the hardware."""
    exchanges_on("lockstep", "golden.txt")


def exchanges_on(engine, name):
    found, compared = exchange_file.differences(name, "--engine", engine)
    check(not found, f"{engine}: " + "\n".join(found))
    check(compared >= 100, f"{engine} {name}: {compared} compared, expected 100 or more")


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


def fnv1a(content):
    """FNV-1a of 64 bits."""
    value = 0xcbf29ce484222325
    for byte in content:
        value = (value ^ byte) * 0x100000001b3 % 2**64
    return f"{value:016x}"


def version():
    """What the command says is what the build has, what results say of it, and what the change log is newest about."""
    tree = pathlib.Path(__file__).resolve().parents[3]
    said = brick("--version").stdout
    built = re.search(r"^project\(brick VERSION (\S+)", (tree / "CMakeLists.txt").read_text(), re.M)[1]
    newest = re.search(r"^## (\S+)", (tree / "CHANGELOG.md").read_text(), re.M)[1]
    cited = re.search(r"^version: (\S+)", (tree / "CITATION.cff").read_text(), re.M)[1]
    check(said.startswith(f"brick {built}\n") and newest == cited == built,
          f"{said!r}, CMakeLists.txt {built}, CHANGELOG.md {newest}, CITATION.cff {cited}")
    words = dict(line.split(" ", 1) for line in said.splitlines())
    image = fnv1a(pathlib.Path(command.BRICK).with_name("turbo.elf").read_bytes())
    check(words.get("image") == image, f"{said!r}, image {image}")
    with tempfile.TemporaryDirectory() as folder:
        results = pathlib.Path(folder, "results.json")
        check(play(["@time"], "--json", str(results)).returncode == 0, "plays")
        made = json.loads(results.read_text())
    build = made["build"]
    check(made["image"]["hash"] == image and build["version"] == built and len(build["tools"]) == 4, str(made))
    check(all(words[tool] == version for tool, version in build["tools"].items()), f"{said!r}, {build}")
    check(words.get("commit", "").split(",")[0] == build["commit"], f"{said!r}, {build}")


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


def flash():
    with tempfile.TemporaryDirectory() as folder:
        file = f"{folder}/flash.bin"
        check(play(["I16=7", "SAVE"], "--flash", file).returncode == 0, "SAVE")
        check(play(["I16"], "--flash", file).stdout.split() == ["7"], "SAVEd value is back at the next start")
        check(play(["I16"], "--flash", file, "--jumper", "E3").stdout.split() == ["5"], "jumper E3 gives the default")
        check(play(["I16"]).stdout.split() == ["5"], "another controller has the default")


def flash_signals():
    """What was SAVEd is in the file, whichever signal ends the run, and in each command that runs a controller."""
    with tempfile.TemporaryDirectory() as folder:
        file, link = f"{folder}/flash.bin", f"{folder}/link.bin"
        os.symlink(file, link)
        for number, (name, status) in enumerate((("SIGINT", 1), ("SIGTERM", 1), ("SIGKILL", -9)), 20):
            with subprocess.Popen([command.BRICK, "exec", "-", "--flash", link], text=True, stdin=subprocess.PIPE,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE) as run:
                run.stdin.write(f"I16={number}\nSAVE\nVERSION\n@wait 1000s\n")
                run.stdin.close()
                check(run.stdout.readline() == "1.947\n", f"{name}: VERSION, when the SAVE is over")
                run.send_signal(getattr(signal, name))
                said, code = run.stderr.read(), run.wait(60)
            after = play(["I16"], "--flash", link).stdout.split()
            check(after == [str(number)], f"{name}: I16 {after}")
            check(code == status and (code < 0 or f"stopped by {name}" in said), f"{name}: status {code}, {said}")
            check(os.path.islink(link) and os.path.getsize(file) == 1 << 20, f"{name}: a link stays one")
            left = sorted(os.listdir(folder))
            check(left == ["flash.bin", "link.bin"], f"{name}: {left}")
        with subprocess.Popen([command.BRICK, "console", "--flash", link], text=True, stdin=subprocess.PIPE,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as run:
            run.stdin.write("I16=30\nSAVE\nVERSION\n")
            run.stdin.flush()
            while "1.947" not in run.stdout.readline():
                check(run.poll() is None, "console ends")
            run.kill()
        after = play(["I16"], "--flash", link).stdout.split()
        check(after == ["30"], f"console, SIGKILL: I16 {after}")
        untouched = pathlib.Path(file).read_bytes()
        with subprocess.Popen([command.BRICK, "run", "save-restore", "--flash", link], text=True,
                              stdout=subprocess.PIPE) as run:
            while pathlib.Path(file).read_bytes() == untouched:
                check(run.poll() is None, "save-restore ends before it has SAVEd")
            run.kill()
        check(os.path.getsize(file) == 1 << 20, "run, SIGKILL: the file is whole")


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


# covers: BREQ-6
def jpan():
    """The panel selects whose BREQ the host sees; the same times on the model and in lock-step."""
    lines = ["&2DEFINE ROTARY 40", "OPEN ROTARY", "CLOSE", "&1", "I2=0", "@signal breq", "@expect breq=0",
             "@jpan FPD=2", "@until breq=1 3ms", "@time", "@jpan FPD3=0", "@until breq=0 3ms", "@jpan FPD=0 START=0",
             "@wait 3ms", "I59", "@expect 2", "@jpan START=1 FPD=2", "@until breq=1 3ms",
             "@signal brld_n", "@expect brld_n=0",
             "I2=1", "@signal breq", "@expect breq=0", "@signal host.jpan", "@expect host.jpan=$FDFF", "@time",
             "@jpan INIT=0", "@wait 300ns", "@jpan INIT=1", "I59", "@expect 2",  # a spike
             "@jpan INIT=0", "@wait 10us", "@jpan INIT=1", "I59", "@expect 0", "@time"]
    first = None
    for engine in ("systemc", "lockstep"):
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
    """Pins that move near an edge are taken early or late by the seed, alike in lock-step and at other batches."""
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
        for options in (["--engine", "lockstep", "--batch", "1000"], ["--engine", "systemc", "--batch", "7"]):
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


def line_cover():
    """--cover: the lines of the firmware that a bench has executed, as lcov; the run is the same."""
    def run(folder, name, *options):
        results = folder / f"{name}.json"
        r = brick("run", "smoke", "--engine", "systemc", "--json", str(results), *options)
        check(r.returncode == 0, f"{options}: {r}")
        found = json.loads(results.read_text())
        return found["ticks"], found["instructions"]

    def lines_with(file, text):
        source = (REPOSITORY / "firmware" / file).read_text().splitlines()
        found = [n for n, line in enumerate(source, 1) if text in line]
        check(found, f"no `{text}` in {file}")
        return found

    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        info = folder / "cover.info"
        check(run(folder, "with", "--cover", str(info)) == run(folder, "without"), "--cover changes the run")
        hits, record = {}, {}
        for line in info.read_text().splitlines():
            key, _, value = line.partition(":")
            if key == "SF":
                record = hits.setdefault(value.split("/firmware/")[-1], {})
            elif key == "DA":
                number, hit = map(int, value.split(","))
                check(number not in record, f"{line} twice")
                record[number] = hit
            elif key in ("LF", "LH"):
                wanted = len(record) if key == "LF" else sum(record.values())
                check(int(value) == wanted, f"{line}, expected {wanted}")
        # The host asks for VERSION; no line is stored into a rotary buffer, and nothing traps.
        for file, text, hit in (("buffers/buffer_request.c", "void buffer_request_line_stored(uint32_t cs) {", 0),
                                ("image/main.c", "hal_idle(&background_work)", 1)):
            check(file in hits, f"{file}: not in {sorted(hits)}")
            seen = [hits[file][n] for n in lines_with(file, text) if n in hits[file]]
            check(seen and max(seen) == hit, f"{file}, {text}: {seen}, expected {hit}")
        check(len([f for f in hits if f.endswith(".c")]) > 100, f"files: {sorted(hits)}")
        r = brick("run", "smoke", "--cover", str(folder / "none/cover.info"))
        check(r.returncode == 2 and "--cover" in r.stderr and r.stderr.count("\n") == 1, f"{r}")


PROFILED = """OPEN PLC 3 CLEAR
P4=1
P1=SIN(P2)+COS(P2)+TAN(P2)+SIN(P2)+COS(P2)+TAN(P2)+SIN(P2)+COS(P2)+TAN(P2)
CLOSE
OPEN PROG 1 CLEAR
P3=1
P3=1
P3=SIN(P2)+COS(P2)+TAN(P2)+SIN(P2)+COS(P2)+TAN(P2)+SIN(P2)+COS(P2)+TAN(P2)
DWELL5
CLOSE
I5=2
^A
@wait 20ms
ENABLE PLC 3
&1B1R
@wait 60ms
"""  # each statement of an assignment of a constant is one word, as LIST with a start shows


def profile():
    """--profile: callgrind's format; sums of calls are sums of lines; the dear lines are named; the run is the same."""
    columns = ["Cycles", "Background", "RealTime", "HostPort", "Servo", "Phase"]

    def run(folder, *options):
        script, wave = folder / "profiled.txt", folder / "run.vcd"
        script.write_text(PROFILED)
        r = brick("exec", "--plant", "dac8", "--load", "dac8", "--wave", str(wave), "--trace", "bus.*", *options,
                  str(script))
        check(r.returncode == 0, f"{options}: {r}")
        return r.stderr, [line for line in wave.read_text().splitlines() if line[:1] != "$"]

    def read(lines):
        """Cycles of each function itself, of its calls, and of the calls of it, a list of columns each."""
        own, below, of = ({} for _ in range(3))
        function = callee = None
        for line in lines:
            key, _, value = line.partition("=")
            if key == "fn":
                function = value
            elif key == "cfn":
                callee = value
            elif line[:1].isdigit():
                counts = list(map(int, line.split()[1:]))
                check(len(counts) == len(columns) and counts[0] == sum(counts[1:]), line)
                for table, name in ((of, callee), (below, function)) if callee else ((own, function),):
                    table[name] = [a + b for a, b in zip(table.get(name, [0] * len(counts)), counts, strict=True)]
                callee = None
        return own, below, of

    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        file = folder / "profile.out"
        told, with_profile = run(folder, "--profile", str(file))
        check(run(folder)[1] == with_profile and len(with_profile) > 1000, "--profile changes the run")
        for task, line in (("background", "PLC 3, word 1"), ("real-time ", "PROG 1, word 2")):
            found = [row for row in told.splitlines() if row.startswith(task)]
            check(len(found) == 1 and found[0].endswith(line), f"{task}: {found}, expected {line}")
        lines = file.read_text().splitlines()
        check("events: " + " ".join(columns) in lines and "positions: line" in lines, lines[:12])
        own, below, of = read(lines)
        # All that an interrupt does stands below the vector; and who is only called is as dear as its calls.
        total = [sum(column) for column in zip(*own.values(), strict=True)]
        for task in ("RealTime", "HostPort", "Servo", "Phase"):
            i = columns.index(task)
            whole = own["trap_vector"][i] + below["trap_vector"][i]
            check(whole == total[i] > 10000, f"{task}: {whole} in and below trap_vector, expected {total[i]}")
        took = {f: [a + b for a, b in zip(own[f], below.get(f, [0] * 6), strict=True)] for f in of}
        unlike = {f for f in of if of[f] != took[f]} - {"exchange_stacks"}  # whose calls end on the other stack
        way = {"trap_real_time", "tasks_real_time_interrupt", "real_time", "slice_run"}  # to it, in one interrupt
        check(len(of) > 400 and unlike <= way, f"of {len(of)} functions, calls of these differ from them: {unlike}")
        check(all(took[f][0] - of[f][0] < 100 for f in unlike), f"{[(f, of[f], took[f]) for f in unlike]}")
        r = subprocess.run(["callgrind_annotate", str(file)], capture_output=True, text=True)
        check(r.returncode == 0 and f"{total[0]:,}" in r.stdout and "position_loop_servo" in r.stdout, f"{r}")
        # A reset ends what it interrupts: here PLC 0, whose scan has no end; what comes behind it is booked anew.
        lines = ["OPEN PLC 3 CLEAR", "P1=1", "CLOSE", "OPEN PLC 0 CLEAR", "P2=1", "WHILE(P2=1)", "P3=P3+1", "ENDWHILE",
                 "CLOSE", "I5=2", "ENABLE PLC 3", "I0..1023", "I5=3", "ENABLE PLC 0", "@wait 9ms", "@reset",
                 "@wait 200ms"]
        r = play(lines, "--profile", str(file))
        rows = {row.split("  ")[0].strip(): row for row in r.stderr.splitlines() if "runs" in row or "passes" in row}
        check(re.search(r"dearest \d+ cycles.* in PLC 0, word [1-9]$", rows["real-time"]), f"{rows}")
        check(int(re.search(r"dearest (\d+)", rows["real-time"])[1]) > 100000, f"{rows}")
        query = re.search(r"dearest (\d+) cycles.*?(, (\d+) of them in PLC 3, word 0)?$", rows["background"])
        check(int(query[1]) > 1000000 and int(query[3] or 0) < int(query[1]) // 50, f"the query is not PLC 3's: {rows}")
        own = read(file.read_text().splitlines())[0]
        check(own["start"][columns.index("RealTime")] == 0 < own["start"][columns.index("Background")], own["start"])
        r = brick("run", "smoke", "--profile", str(folder / "none/profile.out"))
        check(r.returncode == 2 and "--profile" in r.stderr and r.stderr.count("\n") == 1, f"{r}")


def bad_input():
    """One line on stderr that says what, where, and what was expected; exit status 2."""
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        (place / "bad.elf").write_text("no program")
        (place / "bad.toml").write_text("colour = 1\n")
        (place / "bad.flash").write_text("short")
        (place / "loop").symlink_to("loop")
        os.mkfifo(place / "pipe")
        long = "n" * 300
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
            (["exec", "-", "--seed", " -5"], "", "--seed  -5"),
            *((["exec", "-", option, ""], "", f"{option}: is empty") for option in
              ("--flash", "--json", "--wave", "--wave-from", "--record", "--record-of", "--profile", "--gdb", "--load",
               "--firmware", "--bcr", "--waive")),
            *((["regress", f"{folder}/none.toml", "--minutes", text], "", f"--minutes: {text} is not a number")
              for text in ("-1", "nan", "inf")),
            (["serve", "--end-with", "0"], "", "--end-with: 0 is not a number from 1 to"),
            (["serve", "--end-with", "1", "--listen", "127.0.0.1:0"], "", "--end-with 1: has not started this"),
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
            (["exec", "-", "--flash", f"{folder}/pipe"], "", f"{folder}/pipe: is not a file"),
            (["exec", "-", "--flash", f"{folder}/{long}"], "", "n...: File name too long"),
            (["exec", "-", "--firmware", f"{folder}/loop"], "", f"{folder}/loop: Too many levels of symbolic links"),
            (["exec", f"{folder}/two\nlines"], "", f"{folder}/two<0A>lines: cannot be read"),
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


def odd_files():
    """A pipe to which nobody writes, a device without an end: an error, whatever reads it. A shell's pipe is read."""
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        os.mkfifo(place / "pipe")
        for ending in ("toml", "pmc", "elf", "csv", "history"):
            (place / f"pipe.{ending}").symlink_to(place / "pipe")
            (place / f"zero.{ending}").symlink_to("/dev/zero")
        (place / "flash").write_bytes(b"\xFF" * (1 << 20))
        (place / "flash.address").symlink_to(place / "pipe")
        for kind in ("pipe", "zero"):
            for arguments, ending in ((["exec"], "pmc"), (["exec", "-", "--load"], "pmc"),
                                      (["exec", "-", "--board"], "toml"), (["exec", "-", "--plant"], "toml"),
                                      (["exec", "-", "--waive"], "toml"), (["exec", "-", "--firmware"], "elf"),
                                      (["boards"], "toml"), (["regress"], "toml"), (["cpu"], "elf"),
                                      (["plot"], "csv")):
                file = f"{folder}/{kind}.{ending}"
                r = brick(*arguments, file, script="", timeout=60)
                check(r.returncode == 2 and r.stdout == "" and r.stderr.count("\n") == 1, f"{arguments} {file}: {r}")
                check(file in r.stderr and "expected" in r.stderr, f"{arguments}: {r.stderr}")
        r = brick("serve", "--listen", "127.0.0.1:0", "--flash", f"{folder}/flash", timeout=60)
        check(r.returncode == 2 and "flash.address: is no regular file; expected four numbers" in r.stderr, r.stderr)
        r = brick("console", "--history", f"{folder}/pipe.history", script="", timeout=60)
        check(r.returncode == 2 and "expected" in r.stderr, r.stderr)
        r = brick("exec", "/dev/stdin", script="I16\n")
        check(r.returncode == 0 and r.stdout == "5\n", f"/dev/stdin: {r}")
        r = subprocess.run(["bash", "-c", f"{command.BRICK} exec <(echo I16) --load <(echo I16=7)"],
                           capture_output=True, text=True, timeout=60, check=False)
        check(r.returncode == 0 and r.stdout == "7\n", f"<(...): {r}")


# covers: WDT-1 WDT-2
def dead_flash():
    """A flash file with settings that stop the controller outlives the process; jumper E3 and SAVE repair it."""
    ask = ["VERSION", "I17", "I19"]
    with tempfile.TemporaryDirectory() as folder:
        file = f"{folder}/flash.bin"
        r = play(["I17=33 I8=0 I7100=20 I7101=0 I7102=0 I19=7107", "SAVE", "VERSION"], "--flash", file)
        check(r.returncode == 0 and r.stdout.split() == ["1.947"], r.stdout + r.stderr)
        for engine in ("systemc", "rtl", "lockstep"):
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


globals()[command.CASE]()
