"""The built command from outside: replies, times, exit statuses, messages. usage: acceptance.py BRICK CASE; each CASE is one test."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

BRICK, CASE = sys.argv[1], sys.argv[2]
GOLDEN = ["VERSION", "CID", "I19", "I16", "I17", "&2DEFINE ROTARY 200", "&1DEFINE ROTARY 200", "&2DEFINE ROTARY 50"]
ANSWERS = ["1.947", "603382", "7007", "5", "10", "ERR003"]  # the three DEFINEs: nothing, nothing, lower-numbered buffer exists


def brick(*arguments, script=None, timeout=240):
    return subprocess.run([BRICK, *arguments], input=script, capture_output=True, text=True, timeout=timeout)


def check(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def play(lines, *options):
    return brick("exec", *options, "-", script="\n".join(lines) + "\n")


# covers: CARD-3
def golden():
    r = play(GOLDEN)
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    check(r.stdout.split() == ANSWERS, f"{r.stdout.split()}, expected {ANSWERS}")


# covers: CARD-1 CARD-2
def same_everywhere():
    """Every reply and its simulated time, on all engines and batch sizes."""
    lines = [l for command in GOLDEN + ["&1B0", "OPEN ROT", "X1", "DWELL1", "R", "@wait 3ms", "PR", "@pic", "@dpram 0xC000 4"] for l in (command, "@time")]
    runs = [(e, b) for e in ("systemc", "rtl", "lockstep") for b in ("0",)] + [("systemc", "1000"), ("systemc", "7"), ("rtl", "64")]
    first = None
    for engine, batch in runs:
        r = play(lines, "--engine", engine, "--batch", batch)
        check(r.returncode == 0, f"{engine} batch {batch}: exit {r.returncode}: {r.stderr}")
        check(r.stdout.count("time=") == len(lines) // 2, f"{engine}: {r.stdout}")
        first = first or r.stdout
        check(r.stdout == first, f"{engine} batch {batch} differs:\n{r.stdout}\nexpected as systemc:\n{first}")


def at_lines():
    r = play(["@pic", "@pic MSK=12 ELR=10", "@pic", "@dpram 0xC000 = 1234 ABCD", "@dpram 0xC000 2", "@signal clock.source", "@until clock.servo=0 1ms",
              "@until clock.servo=1 1ms", "@signal clock.servo", "I16", "@expect 5", "P1..3", "@expect 0|0|0", "UUU", "@expect ERR003", "@wait 1ms", "@time"])
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    out = r.stdout.split("\n")
    check(re.fullmatch(r"IST=00 SIG=[0-9A-F]{2} MSK=00 ELR=00", out[0]), out[0])
    check(re.fullmatch(r"IST=[0-9A-F]{2} SIG=[0-9A-F]{2} MSK=12 ELR=10", out[1]), out[1])
    check(out[2:5] == ["1234 ABCD", "clock.source=7007", "clock.servo=1"], str(out))
    check(re.fullmatch(r"time=\d+ ns", out[-2]), out[-2])


def motor_pins():
    """The hand at the encoder of motor 6 (servo IC 1, channel 2) counts, with x4 both ways; an input pin is a signal at once."""
    r = play(["@encoder 6 37 100000", "@signal servo_ic1.ch2.count", "@expect servo_ic1.ch2.count=37", "@encoder 6 -40 100000",
              "@signal servo_ic1.ch2.count", "@expect servo_ic1.ch2.count=-3", "@signal servo_ic0.ch1.count", "@expect servo_ic0.ch1.count=0",
              "@input servo_ic0.ch1.hmfl=1", "@signal servo_ic0.ch1.hmfl", "@expect servo_ic0.ch1.hmfl=1",
              "@until servo_ic0.ch1.adc_strobe=1 200us", "@until servo_ic0.ch1.adc_strobe=0 200us"])
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    r = play(["@input servo_ic0.ch1.pwm_a_top=1"])
    check(r.returncode == 2 and "is no input pin" in r.stderr, r.stderr)
    r = play(["@encoder 9 1"])
    check(r.returncode == 2 and "expected 1 to 8" in r.stderr, r.stderr)


def restarts():
    r = play(["I16=7", "P1=3", "@reset", "I16", "@expect 5", "I16=8", "@power", "I16", "@expect 5", "I16=9", "$$$", "I16", "@expect 5", "VERSION"])
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    check(r.stdout.split() == ["5", "5", "5", "1.947"], r.stdout)


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
    check(r.returncode == 0 and "geobrick-lv-4" in r.stdout and "servo IC 1" in r.stdout, r.stdout + r.stderr)
    found = {b["name"]: b["ics"] for b in json.loads(brick("boards", "--json").stdout)}
    check(found["geobrick-lv-4"] == ["servo IC 0"] and found["geobrick-lv-8"] == ["servo IC 0", "servo IC 1"], str(found))
    check(play(["VERSION"], "--board", "geobrick-lv-4").stdout.split() == ["1.947"], "four axes")


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
    check("stdin:2" in r.stderr and "`5`" in r.stderr and "`6`" in r.stderr and r.stdout.split() == ["5"], r.stderr + r.stdout)


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
            (["exec", "-", "--engine", "verilog"], "", "verilog"),
            (["exec", "-", "--frob"], "", "--frob"),
            (["exec", "-", "--seed", "x"], "", "--seed"),
            (["exec", "-", "--batch", "-1"], "", "--batch"),
            (["exec", "-", "--jumper", "E4"], "", "E4"),
            (["exec", "-", "--board", "nothing"], "", "nothing"),
            (["exec", "-", "--board", f"{folder}/none.toml"], "", "none.toml"),
            (["exec", "-", "--board", f"{folder}/bad.toml"], "", "bad.toml:1"),
            (["exec", "-", "--firmware", f"{folder}/none.elf"], "", "none.elf"),
            (["exec", "-", "--firmware", f"{folder}/bad.elf"], "", "bad.elf"),
            (["exec", "-", "--flash", f"{folder}/none/flash"], "", "none/flash"),
            (["exec", "-", "--flash", f"{folder}/bad.flash"], "", "bad.flash"),
            (["exec", "-", "--json", f"{folder}/none/x.json"], "", "none/x.json"),
            (["exec", "-", "--wave", f"{folder}/x.txt"], "", "x.txt"),
            (["exec", "-", "--wave", "/proc/none/x.vcd"], "", "/proc/none"),
            (["exec", "-", "--wave", f"{folder}/x.vcd", "--wave-from", "10"], "", "--wave-from"),
            (["exec", "-", "--wave-to", "10ms"], "", "--wave-to"),
            (["exec", "-"], "VERSION\n@frob\n", "stdin:2: @frob"),
            (["exec", "-"], "VERSION\n@signal nothing.here\n", "stdin:2: @signal"),
            (["exec", "-"], "@until host.breq=2 1ms\n", "stdin:1: @until"),
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


def run_json(bench, *options):
    with tempfile.TemporaryDirectory() as folder:
        r = brick("run", bench, "--json", f"{folder}/r.json", *options, timeout=500)
        return r, json.loads(pathlib.Path(f"{folder}/r.json").read_text())


def bench_passes(name, engine, seed="1"):
    r, results = run_json(name, "--engine", engine, "--seed", seed)
    check(r.returncode == 0 and results["verdict"] == "PASS", r.stdout + r.stderr)
    check(f"PASS {name}" in r.stdout and "ticks/s" in r.stdout and "instructions/s" in r.stdout, r.stdout)
    check(len(results["steps"]) > 5 and results["ticks"] > 0 and results["instructions"] > 0, str(results))


def bench_fails_its_negative_control(name, engine):
    r, results = run_json(name, "--engine", engine, "--negative")
    check(r.returncode == 1 and results["verdict"] == "FAIL", r.stdout + r.stderr)
    return results


def smoke():
    for engine in ("systemc", "rtl", "lockstep"):
        bench_passes("smoke", engine)


def smoke_negative():
    bench_fails_its_negative_control("smoke", "systemc")
    results = bench_fails_its_negative_control("smoke", "lockstep")
    check("clock.servo" in results["steps"][-1]["detail"], str(results["steps"][-1]))


def breq_rotary():
    bench_passes("breq-rotary", "systemc", "1")
    bench_passes("breq-rotary", "systemc", "2")


def breq_rotary_lockstep():
    bench_passes("breq-rotary", "lockstep", "3")


def breq_rotary_negative():
    bench_fails_its_negative_control("breq-rotary", "systemc")


def installed():
    """`cmake --install` gives a command that finds its firmware and boards, wherever it stands."""
    global BRICK
    build = pathlib.Path(BRICK).resolve().parent.parent
    with tempfile.TemporaryDirectory() as folder:
        r = subprocess.run(["cmake", "--install", str(build), "--prefix", folder], capture_output=True, text=True)
        check(r.returncode == 0, r.stdout + r.stderr)
        BRICK = f"{folder}/bin/brick"
        golden()
        boards()


def wave_window():
    with tempfile.TemporaryDirectory() as folder:
        for ending in ("vcd", "fst"):
            r = play(["VERSION", "@wait 1ms"], "--wave", f"{folder}/new/x.{ending}", "--wave-from", "1ms", "--wave-to", "14ms")
            check(r.returncode == 0, r.stderr)
            check(pathlib.Path(f"{folder}/new/x.{ending}").stat().st_size > 1000, ending)
        times = [int(t) for t in re.findall(r"^#(\d+)", pathlib.Path(f"{folder}/new/x.vcd").read_text(), re.M)]
        check(times[0] == 10**9 and times[-1] <= 14 * 10**9, f"{times[0]} to {times[-1]} ps")


# covers: CARD-4
def wave():
    """A bench writes a VCD with the contract's names and data in them, the same on every engine."""
    names = """clock.phase clock.servo clock.source host.breq host.irq host.ipos host.eror host.f1er host.hreq host.wdo host.isa.sa host.isa.sd
        host.isa.ior_n host.isa.iow_n host.isa.memr_n host.isa.memw_n host.isa.iochrdy host.isa.aen host.pic.ist host.pic.sig host.pic.msk
        host.pic.elr dpram.busy_host dpram.busy_cpu bus.addr bus.data bus.aa bus.rd_n bus.wr_n bus.ta_n cpu.pc cpu.task cpu.symbol
        watchdog.tripped""".split()
    texts = []
    with tempfile.TemporaryDirectory() as folder:
        for engine in ("systemc", "rtl", "lockstep"):
            file = pathlib.Path(f"{folder}/{engine}.vcd")
            r = brick("run", "smoke", "--engine", engine, "--wave", str(file))
            check(r.returncode == 0, r.stdout + r.stderr)
            texts.append(file.read_text())
    check(texts[0] == texts[1] == texts[2], "the waveforms of the engines differ")
    scope, codes = [], {}
    for line in texts[0].split("$enddefinitions")[0].splitlines():
        word = line.split()
        if word[0] == "$scope":
            scope.append(word[2])
        elif word[0] == "$upscope":
            scope.pop()
        elif word[0] == "$var":
            codes[".".join(scope + [word[4]])] = word[3]
    for name in names:
        check("brick." + name in codes, f"no signal {name}")
    changes = lambda name: len(re.findall(rf"^(?:[01]|b[01]+ |s\S+ ){re.escape(codes['brick.' + name])}$", texts[0], re.M))
    for name, least in {"clock.phase": 100, "clock.servo": 40, "host.isa.sa": 100, "host.isa.sd": 100, "host.pic.msk": 3, "bus.addr": 20,
                        "cpu.pc": 100, "cpu.symbol": 100, "cpu.task": 50, "host.isa.memw_n": 30}.items():
        check(changes(name) >= least, f"{name} changes {changes(name)} times, expected {least} or more")


globals()[CASE]()
