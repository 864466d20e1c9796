"""Records of the built command and their pictures: --record, brick plot (docs/record.md).

usage: record_acceptance.py BRICK CASE; each CASE is one test.
"""

import csv
import pathlib
import re
import resource
import subprocess
import tempfile

import command
from command import brick, check, play

MOVE = ["#1J/", "@wait 30ms", "#1J:2000", "@wait 200ms", "#1P"]
DAC8 = ("--plant", "dac8", "--load", "dac8")


def recorded(folder, script, *options, of=None, name="r.csv"):
    file = pathlib.Path(folder, name)
    r = play(script, "--record", str(file), *(("--record-of", of) if of else ()), *options)
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    with file.open(newline="") as lines:
        names, *rows = csv.reader(lines)
    return r, names, [[float(v) for v in row] for row in rows], file


def record_move():
    """A jog of 2000 counts at 32 counts/ms and 1 count/ms^2, as examples/setups/dac8.pmc has Ixx19 to Ixx22."""
    of = "motor1.* plant.axis1.position host.breq here=D:$8B/3072 X:$BF,8,16,S"
    with tempfile.TemporaryDirectory() as folder:
        _, names, rows, _ = recorded(folder, MOVE, *DAC8, of=of)
        check(names == ["time_ms", "motor1.commanded", "motor1.actual", "motor1.error", "motor1.velocity",
                        "motor1.acceleration", "motor1.output", "plant.axis1.position", "host.breq", "here",
                        "X:$BF,8,16,S"], names)
        at = {name: [row[i] for row in rows] for i, name in enumerate(names)}
        check(len(rows) > 500, f"{len(rows)} rows")
        steps = [b - a for a, b in zip(at["time_ms"], at["time_ms"][1:], strict=False)]
        steps = steps[len(steps) // 2:]  # the clocks are set at the start
        period = 4 * (2 * 6527 + 3) / 117964.8  # I7000 = 6527, I7001 = 0, I7002 = 3
        check(all(abs(s - period) < 1e-5 for s in steps), f"{min(steps)} to {max(steps)} ms, expected {period}")
        check(at["motor1.commanded"][-1] == 2000, at["motor1.commanded"][-1])
        check(abs(max(at["motor1.velocity"]) - 32) < 0.01, max(at["motor1.velocity"]))
        check(abs(max(at["motor1.acceleration"]) - 1) < 0.01, max(at["motor1.acceleration"]))
        check(abs(min(at["motor1.acceleration"]) + 1) < 0.01, min(at["motor1.acceleration"]))
        check(max(abs(a - b) for a, b in zip(at["here"], at["motor1.actual"], strict=True)) < 1e-6, "D:$8B")
        check(all(abs(c - a - e) < 1e-6 for c, a, e in
                  zip(at["motor1.commanded"], at["motor1.actual"], at["motor1.error"], strict=True)), "error")
        check(max(abs(a - p) for a, p in zip(at["motor1.actual"], at["plant.axis1.position"], strict=True)) < 16,
              "the plant stands elsewhere")  # 32 counts/ms, a servo period old
        check(all(abs(o - w) < 1 for o, w in
                  zip(at["motor1.output"], at["X:$BF,8,16,S"], strict=True)), "output")
        check(max(at["X:$BF,8,16,S"]) > 300 and min(at["X:$BF,8,16,S"]) < -300, "the output does nothing")


def record_changes_nothing():
    """Replies, their times and the waveform are those of a run without a record."""
    script = [*MOVE, "@time", "@signal plant.axis1.position"]
    with tempfile.TemporaryDirectory() as folder:
        waves = [pathlib.Path(folder, f"{i}.vcd") for i in range(2)]
        with_it, names, rows, _ = recorded(folder, script, *DAC8, "--wave", str(waves[0]), "--wave-from", "100ms",
                                           "--trace", "host.*,dac,plant.*")
        without = play(script, *DAC8, "--wave", str(waves[1]), "--wave-from", "100ms", "--trace", "host.*,dac,plant.*")
        check(with_it.stdout == without.stdout, with_it.stdout + without.stdout)
        bodies = [wave.read_text().split("$enddefinitions")[1] for wave in waves]
        check(len(bodies[0]) > 10000 and bodies[0] == bodies[1], "the waveforms differ")
        check(len(names) == 8 * 3 + 2 and len(rows) > 500, names)


def record_of_bench():
    """A bench takes the same options, passes as ever and leaves the same columns."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "r.csv")
        r = brick("run", "jog-home", "--engine", "systemc", "--seed", "5", "--record", str(file),
                  "--record-of", "motor1.commanded host.breq")
        check(r.returncode == 0, f"exit {r.returncode}: {r.stdout}{r.stderr}")
        with file.open(newline="") as lines:
            names, *rows = csv.reader(lines)
        check(names == ["time_ms", "motor1.commanded", "host.breq"] and len(rows) > 500, f"{names}, {len(rows)} rows")
        check(len({row[1] for row in rows}) > 100, "no motor has moved")


def record_of_console():
    """So does the console; what is sent to it moves the motor."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "r.csv")
        r = brick("console", *DAC8, "--record", str(file), "--record-of", "motor1.commanded",
                  script="\n".join(MOVE) + "\n")
        check(r.returncode == 0, f"exit {r.returncode}: {r.stdout}{r.stderr}")
        with file.open(newline="") as lines:
            names, *rows = csv.reader(lines)
        check(names == ["time_ms", "motor1.commanded"] and len(rows) > 500, f"{names}, {len(rows)} rows")
        check(float(rows[-1][1]) == 2000, rows[-1])


def record_fill_and_feed():
    """Four lines of two words wait for R, the first of them 50 units long at 0.5 a ms."""
    script = ["#1J/", "#2J/", "@wait 20ms", "&1 UNDEFINE ALL #1->100X #2->200Y", "I5190=1 I5198=0 I5187=10 I5188=0",
              "DELETE GATHER", "DEFINE ROT 20 B0", "OPEN ROT", "INC LINEAR F0.5", "X30Y40", "X-3Y-4", "X3Y4", "R",
              "@wait 400ms"]
    with tempfile.TemporaryDirectory() as folder:
        _, names, rows, _ = recorded(folder, script, *DAC8, of="cs1.* feed:1/100,2/200 x=feed:1")
        check(names == ["time_ms", "cs1.lines", "cs1.words", "feed:1/100,2/200", "x"], names)
        at = {name: [row[i] for row in rows] for i, name in enumerate(names)}
        check(max(at["cs1.lines"]) == 4 and at["cs1.lines"][-1] == 0, max(at["cs1.lines"]))
        check(max(at["cs1.words"]) == 9 and at["cs1.words"][-1] == 0, max(at["cs1.words"]))
        check(abs(max(at["feed:1/100,2/200"]) - 0.5) < 0.001, max(at["feed:1/100,2/200"]))
        check(abs(max(at["x"]) - 30) < 0.01, max(at["x"]))


def record_large_numbers():
    """Each bit of a word of 48, here of motor 32, which is not activated; four decimals of a quotient."""
    words = ["WX$1008,$123456", "WY$1008,$ABCDEF", "WX$100B,$FFEDCB", "WY$100B,$000001", "@wait 2ms"]
    with tempfile.TemporaryDirectory() as folder:
        _, _, rows, _ = recorded(folder, words, of="D:$1008 D:$100B far=D:$1008/3072")
        _, *last = rows[-1]
        check(last[:2] == [0x123456ABCDEF, 0xFFEDCB000001 - (1 << 48)], last)
        check(abs(last[2] - 0x123456ABCDEF / 3072) < 1e-4, last)


def record_mistakes():
    with tempfile.TemporaryDirectory() as folder:
        file = str(pathlib.Path(folder, "r.csv"))
        for options, text in (
                (("--record", "r.txt"), "--record r.txt: unknown kind of file; expected FILE.csv"),
                (("--record", "/no/such/r.csv"), "--record /no/such/r.csv: no such folder /no/such"),
                (("--record-of", "motor1.error"), "--record-of needs a file; expected --record FILE.csv"),
                (("--record", file, "--record-of", "motor33.error"), "no such signal or number; expected"),
                (("--record", file, "--record-of", "cs17.lines"), "no such signal or number; expected"),
                (("--record", file, "--record-of", "feed:1,33"), "33 is above 32"),
                (("--record", file, "--record-of", "feed:0"), "there is no motor 0"),
                (("--record", file, "--record-of", "feed:1/0"), "`0` is no divisor"),
                (("--record", file, "--record-of", "=feed:1"), "no name before `=`"),
                (("--record", file, "--record-of", "X:$40000"), "$40000 is above 262143"),
                (("--record", file, "--record-of", "X:$BF,20,8"), "bits 20 and 8 on"),
                (("--record", file, "--record-of", "X:$BF,0,8,T"), "`T` is neither S nor U"),
                (("--record", file, "--record-of", "D:$88/0"), "`0` is no divisor"),
                (("--record", file, "--record-of", "a=b"), "no word of the main memory behind `=`"),
                (("--record", file, "--record-of", " ; "), "nothing; expected")):
            r = play(["I10"], *options)
            check(r.returncode == 2 and text in r.stderr and r.stderr.count("\n") == 1, f"{options}: {r.stderr}")


def odd_pictures(folder, file):
    """No name is a program to gnuplot; an old picture stays when there is no new one."""
    place = pathlib.Path(folder, "odd")
    place.mkdir()
    rows = file.read_text().splitlines(keepends=True)

    def plotted(name, picture, lines=rows, **limits):
        (place / name).write_text("".join(lines))
        return subprocess.run([pathlib.Path(command.BRICK).resolve(), "plot", "-o", picture, "--", name], cwd=place,
                              capture_output=True, text=True, timeout=60, check=False, **limits)

    for name, picture in (("<id >WHO; cat #.csv", "|touch WHO #.svg"), ("-", "-.svg"), ("it's.csv", "a.svg")):
        r = plotted(name, picture)
        check(r.returncode == 0 and "</svg>" in (place / picture).read_text(), f"{name}: {r}")
    check(not (place / "WHO").exists(), "a name was run as a command")
    old = (place / "a.svg").read_bytes()
    for lines, text in ((rows[:9] + [rows[9][:-9]], "r.csv:10: "), ([*rows[:9], "1,x\n"], "r.csv:10: `1,x`"),
                        ([*rows[:9], rows[9].replace("\n", ",0\n")], "r.csv:10: "),
                        *(([*rows[:9], re.sub(r"[^,]*\n", f"{odd}\n", rows[9])], "r.csv:10: ")
                          for odd in ("nan", "inf", "0x10", "1e400"))):
        r = plotted("r.csv", "a.svg", lines)
        check(r.returncode == 2 and text in r.stderr and "as in its first line" in r.stderr, f"{text}: {r}")
    r = plotted("r.csv", "a.svg", restore_signals=False,  # SIGXFSZ stays ignored: the file takes no more
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (len(old) - 100, len(old) - 100)))
    check(r.returncode == 2 and r.stderr.count("\n") == 1, f"no room: {r}")
    check((place / "a.svg").read_bytes() == old and not list(place.glob("*.new.*")), "the old picture")


def plot():
    """The pictures hold what was asked for, where it belongs."""
    with tempfile.TemporaryDirectory() as folder:
        _, _, _, file = recorded(folder, MOVE, *DAC8, of="motor1.* motor2.commanded host.breq X:$BF,8,16,S")
        slow = recorded(folder, ["I122=16", *MOVE], *DAC8, of="motor1.*", name="slow.csv")[3]
        r = brick("plot", str(file), "--limit", "velocity=32")
        svg = file.with_suffix(".svg")
        check(r.returncode == 0 and r.stdout == f"{svg}\n", r.stdout + r.stderr)
        text = svg.read_text()
        for wanted in ("position, counts", "velocity, counts/ms", "motor2.commanded", "X:$BF,8,16,S", ">breq<", ">ms<"):
            check(wanted in text, f"no `{wanted}` in the picture")
        r = brick("plot", str(file), "--of", "motor1.velocity", "--beside", str(slow), "-o", str(svg))
        text = svg.read_text()
        check(r.returncode == 0 and "slow motor1.velocity" in text and "r motor1.velocity" in text, r.stderr)
        check("position, counts" not in text, "more than was asked for")
        again = svg.read_bytes()
        brick("plot", str(file), "--of", "motor1.velocity", "--beside", str(slow), "-o", str(svg))
        check(svg.read_bytes() == again, "the same picture twice differs")
        told = brick("plot", str(file), "--of", "motor1.velocity", "-o", "none.svg", "--script")
        check(told.returncode == 0 and "set output 'none.svg'" in told.stdout and str(file) in told.stdout and
              not pathlib.Path("none.svg").exists(), told.stdout + told.stderr)
        png = pathlib.Path(folder, "path.png")
        r = brick("plot", str(file), "--xy", "motor1.commanded motor1.error", "-o", str(png), "--from", "50ms")
        check(r.returncode == 0 and png.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n", r.stderr)
        odd_pictures(folder, file)
        for options, wanted in (((str(file), "-o", "a.pdf"), "unknown kind of picture"),
                                ((str(file), "--from", "10s"), "has 0 rows to draw"),
                                ((str(file), "--from", "20ms", "--to", "10ms"), "expected the earlier time first"),
                                ((str(file), "--limit", "velocity=nan"), "is no limit"),
                                ((str(file), "--limit", "velocity=0x10"), "is no limit"),
                                ((str(file), "--title", "a\n!touch b"), "has an end of a line"),
                                ((str(file), "--of", "motor3.error"), "no column `motor3.error`"),
                                ((str(file), "--limit", "speed=3"), "nothing of that kind is drawn"),
                                ((str(file), "--limit", "velocity"), "is no limit"),
                                ((str(file), "--xy", "motor1.*"), "are 6 columns; expected two"),
                                ((str(file), "--from", "now"), "--from"),
                                ((folder,), "cannot be read"),
                                ((__file__,), "expected a record, whose first line begins with time_ms"),
                                (("none.csv",), "cannot be read; expected a record")):
            r = brick("plot", *options)
            check(r.returncode == 2 and wanted in r.stderr, f"{options}: {r.returncode} {r.stderr}")


globals()[command.CASE]()
