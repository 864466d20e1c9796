"""Host scripts and command files through the built command (docs/scripts.md): replies, messages, exit statuses.

usage: script_acceptance.py BRICK CASE; each CASE is one test.
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
from command import brick, check, play

MOST_REFUSED = 20  # of 30,000 lines


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
    for lines, text in ((["P1", "@expect 0 "], "got `0`, expected `0 `"),
                        (["@wait 1us", "@expect"], "nothing has been answered yet")):
        r = play(lines)
        check(r.returncode == 1 and text in r.stderr, f"{lines}: {r.stderr}")
    check(play(["P1=1", "@expect", 'P1=2SENDP"A "', "@wait 1ms", "@signal clock.source"]).returncode == 0, "nothing")


def restarts():
    r = play(["I16=7", "P1=3", "@reset", "I16", "@expect 5", "I16=8", "@power", "I16", "@expect 5", "I16=9", "$$$",
              "I16", "@expect 5", "VERSION"])
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    check(r.stdout.split() == ["5", "5", "5", "1.947"], r.stdout)
    r = play(["I16=7", "@power", "I16", "@dpram 0x40 = 1234", "@dpram 0x40 1", "@expect 1234"], "--board",
             "turbo-pmac2-pci")
    check(r.returncode == 0 and r.stdout.split()[:1] == ["5"], f"the bridge is set up again: {r.stdout}{r.stderr}")


def raw():
    r = play(["I16", "P1=1", "UUU"], "--raw")
    check(r.stdout.split("\n")[:3] == ["5<0D><06>", "<06>", "<07>ERR003<0D>"], r.stdout)


def dialogue():
    """I3, I4, I6 and restarts in the middle of a script do not lose the dialogue."""
    lines, expected = [], []
    for i3, i4, i6 in ((0, 0, 1), (1, 0, 0), (2, 1, 3), (3, 1, 1), (0, 1, 2), (1, 1, 3), (3, 0, 0), (2, 0, 1)):
        lines += [f"I16 I3={i3} I4={i4} I6={i6}", "I16 I17", "P1=1", "I16 UUU", "I17"]
        expected += ["5", "5", "10", "5", "ERR003" if i6 % 2 else "ERR", "10"]
    slow = "P0..8191=SIN(1)"  # some 50 ms
    lines += ["I3=0", f"{slow} I16 UUU", "I17", "I3=2", f"{slow} I16 UUU $$$", "I17"]
    expected += ["5", "ERR003", "10"] * 2
    lines += ["I16\x07", "@expect 000000000800|5", "I17"]
    expected += ["000000000800", "5", "10"]
    # Status digits, and then a pause: no end of the reply.
    motors = ["850000000000", *["050000000000"] * 7]
    cs = "A80020020000000000"  # &1 of a controller that has just started
    lines += ["I3=0", f"??{slow}??", "I16", f"??{slow}I3=2???", "I17", f"{slow}I16\x02", "I16\x07"]
    expected += [cs, cs, "5", cs, "000000000800", "10", *motors, "5", "000000000800", "5"]
    # Answers to control characters have checksums: ^B and ^G one like a tag and BELL. A backspace changes the line's.
    lines += ["I4=1", "I16\x02", "I16\x07", "I17Z\x08", f"{slow * 3}I4=1", "I4=0", "I6=0", "UUU\x07", "I6=1", "I17"]
    expected += [*motors, "5", "000000000800", "5", "10", "000000000800", "ERR", "10"]
    # A program sets I4, and sets it back.
    lines += ["CLOSE DELETE ALL &1DEFINE ROT 100 B0 OPEN ROT", "I4=1", "CLOSE R", "@wait 20ms", "I16 I17",
              "P1=22221 P1 P1", "UUU", "OPEN ROT", "I4=0", "CLOSE R", "@wait 20ms", "P1=2", "P1", "I16"]
    expected += ["5", "10", "22221", "22221", "ERR003", "2", "5"]
    for line in ("$$$", "I16=7 $$$", "I3=0 $$$***", "I16=7 I4=1 $$$***", "I3=1 SAVE", "I3=0", "SAVE"):
        lines += [line, "I16 I17"]
        expected += ["5", "10"]
    r = play(lines)
    check(r.returncode == 0 and r.stdout.split() == expected, f"{r.stdout.split()}, expected {expected}: {r.stderr}")
    check(r.stderr.count("I16 UUU") == 10 and "stdin:4: `I16 UUU`: ERR003: unknown command" in r.stderr, r.stderr)
    # What is no command restarts nothing: I6 and I16 stay as they were set.
    for line in ("PASSWORD=x$$$", 'PASSWORD="$$$***', "P1=1 ; $$$", 'OPEN PLC5 CLEAR SEND"$$$" CLOSE'):
        r = play(["I16=7 I6=0", line, "UUU", "@expect ERR", "I16", "@expect 7"])
        check(r.returncode == 0 and r.stdout.split() == ["ERR", "7"], f"{line}: {r.stdout}{r.stderr}")
    r = play(["UUU", "@expect ERR003", "UUU $$$", "I16", "@expect 5"])
    check(r.returncode == 0 and r.stderr.count("\n") == 2 and "stdin:3: " in r.stderr, "expected errors are not told")


def busy_programs():
    """PLCs that take longer than the pause that ends a reply, and commands of programs that are refused."""
    # ^A closes loops that are open unless I36 is 1.
    scan = ["I5=2", "OPEN PLC1 CLEAR", *["P1=" + "+".join(["SIN(P1)"] * 30)] * 8, "CLOSE ENABLE PLC1"]
    lines, expected = ["I36=1", *scan, "@wait 50ms", "@time", "I3=2", "@time"], []
    for i3 in range(4):
        lines += [f"I3={i3}", "^G", "I16", "^A^B", "I17 UUU", "^Y"]
        expected += ["000000000800", "5", " ".join(["850000000000"] + ["050000000000"] * 7), "10", "ERR003", "I17 UUU"]
    r = play(lines)
    out = r.stdout.splitlines()
    check(r.returncode == 0 and out[2:] == expected, f"{out}, expected {expected}: {r.stderr}")
    before, after = (int(re.fullmatch(r"time=(\d+) ns", line)[1]) for line in out[:2])
    check(after - before > 5_000_000, "the PLC is over too soon")
    # Texts and errors with tags (I64), errors without a checksum.
    lines, expected = ["I64=1 I5=2", 'OPEN PLC1 CLEAR SEND"AB" CMD"UUU" CLOSE', "ENABLE PLC1"], []
    for i3, i4, i6 in ((0, 1, 1), (1, 1, 0), (2, 1, 3), (3, 1, 1), (1, 1, 2)):
        lines += [f"I16 I3={i3} I4={i4} I6={i6}", "I16 I17", "P1=1", "I16 UUU", "^N", "I17"]
        expected += [["5"], ["5", "10"], [], ["5", "ERR003" if i6 % 2 else "ERR"], None, ["10"]]
    with tempfile.TemporaryDirectory() as folder:
        results = pathlib.Path(folder) / "results.json"
        r = play(lines, "--json", results)
        check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
        replies = [e["reply"] for e in json.loads(results.read_text())["exchanges"]][3:]
    wrong = [pair for pair in zip(lines[3:], replies, expected, strict=True) if pair[2] not in (pair[1], None)]
    check(not wrong, f"{wrong}")


TEXT = "A text of a program"


def sending(text, *before):
    return ["I5=2", "OPEN PLC3 CLEAR", *before, f'SENDP"{text}"', "CLOSE", "ENA PLC3", "@wait 5ms"]


def sends_for_ever():
    """A PLC that SENDs in every scan: no reply is lost, no text torn, in each setting of I3, I4 and I6."""
    def judge(lines, expected, text=TEXT):
        r = play(lines)
        data = [line for line in r.stdout.splitlines() if line != text]
        check(r.returncode == 0 and data == expected, f"{data}, expected {expected}: {r.stderr}")
        check(r.stdout.count(text) > 30, "the PLC sends nothing")

    lines, expected = sending(TEXT), []
    for i3, i4, i6 in ((0, 0, 1), (1, 0, 0), (2, 1, 3), (3, 1, 1), (0, 1, 2)):  # each change: SendingTest
        lines += [f"I16 I3={i3} I4={i4} I6={i6}", "I16 I17", "P1=1", "I16 UUU", "I17"]
        expected += ["5", "5", "10", "5", "ERR003" if i6 % 2 else "ERR", "10"]
    judge(lines + ["^A", "^G", "I16\x07"], [*expected, "000000000800", "000000000800", "5"])
    # The program changes I3; it is there at once behind each start.
    judge([*sending(TEXT, "I3=0", "I3=2"), *["I16", "I17"] * 10], ["5", "10"] * 10)
    judge([*sending(TEXT), "SAVE", "I16", "$$$", "I16", "@reset", "I17", "@power", "I16", "I16=7 $$$***", "I16"],
          ["5", "5", "10", "5", "5"])
    judge([*sending(TEXT), "I3=0", "I4=1", "I4=0", "I16", "I3=1", "I17"], ["5", "10"])
    # Texts in the form of the answer: an acknowledge and a tag tell them from it, else nothing does.
    digits = " ".join(["12345678ABCD"] * 8)
    judge([*sending(digits), "I16 I3=3", "I16", "I64=1", "I16 I3=1", "I16 I3=0", "I17"], ["5", "5", "5", "5", "10"],
          digits)
    r = play([*sending(digits), "I16 I3=0", "I17"])
    check(r.returncode == 1 and r.stdout.splitlines().count("5") == 1, f"exit {r.returncode}: {r.stderr}")
    check("stdin:7: `I16 I3=0`: I3 and I4 cannot be told: a program sends lines of eight words" in r.stderr, r.stderr)


def bytes_of_all_kinds():
    """What is no text harms neither the terminal nor the JSON; a failure is told in one line."""
    with tempfile.TemporaryDirectory() as folder:
        job, results = pathlib.Path(folder) / "job.pmc", pathlib.Path(folder) / "x.json"
        job.write_bytes(b'P1=\xFF\x1B[2J\nSEND"\xC3\xBC"\rI16\n@expect 6\x1B\n')
        r = brick("exec", str(job), "--json", str(results))
        check(r.returncode == 1 and r.stdout.split()[-1] == "5", r.stdout + r.stderr)
        check(f"{job}:1: `P1=<FF><1B>[2J`: ERR" in r.stderr and "got `5`, expected `6<1B>`" in r.stderr
              and f"{job}:4: `@expect 6<1B>`: got" in r.stderr and "\x1B" not in r.stderr, r.stderr)
        found = json.loads(results.read_text())
        check([e["line"] for e in found["exchanges"]] == ["P1=<FF>\x1B[2J", 'SEND"\u00fc"', "I16"], str(found))
        check(found["failure"].startswith(f"{job}:4: "), found["failure"])
        odd = pathlib.Path(os.fsdecode(folder.encode() + b"/\xFF.pmc"))
        odd.write_text("I16\n")
        r = brick("exec", str(odd), "--json", str(results))
        check(r.returncode == 0 and "<FF>.pmc:1" in json.loads(results.read_text())["exchanges"][0]["place"], r.stderr)
        (pathlib.Path(folder) / "sub.pmc").write_text("I16\n@signal nothing.here\n")
        job.write_text('#include "sub.pmc"\n')
        r = brick("exec", str(job))
        check(r.returncode == 2 and "sub.pmc:2: @signal: no signal" in r.stderr
              and r.stderr.endswith(f" (included at {job}:1)\n"), r.stderr)
        with open("/dev/full", "w", encoding="ascii") as full:
            r = subprocess.run([command.BRICK, "exec", "-"], input="I16\n", stdout=full, stderr=subprocess.PIPE,
                               text=True, timeout=240)
        check(r.returncode == 1 and "cannot be written to stdout; expected" in r.stderr, r.stderr)


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
        (pathlib.Path(folder) / "many.pmc").write_text("I16\n" * 2000)
        for bad, what in (("#include \"many.pmc\"\n" * 501, f"{folder}/many.pmc:1: `I16` is one line too many"),
                          ("#include \"none.pmc\"", f"{job}:1: `{folder}/none.pmc` cannot be read; expected"),
                          ("#define L " + "X" * 300 + "\nL", f"{job}:2: `L` expands to 300 characters; expected"),
                          ("#include \"job.pmc\"", "expected no file that includes itself"),
                          ("#ifdef A", f"{job}:1: a condition without its end; expected #endif"),
                          ("I16\n@frob", f"{job}:2: @frob: ")):
            job.write_text(bad + "\n")
            r = brick("exec", str(job))
            check(r.returncode == 2 and r.stdout == "" and r.stderr.count("\n") == 1 and what in r.stderr, r.stderr)


# covers: CARD-3
def backup():
    load_backup(3)


def backup_whole():
    load_backup(1)


def load_backup(each):
    """The backup of a controller, or a third of its lines, loads; what is refused is told with its place, and nothing
    is lost on the way."""
    with tempfile.TemporaryDirectory() as folder:
        places = backup_file.write(folder, each)
        job = pathlib.Path(folder) / "backup.pmc"
        values = backup_file.p_values(each)
        asked = [n for n in range(1000 + backup_file.PLC_LINES, 8192, 43) if n in values]  # PLCs assign lower ones
        job.write_text(job.read_text() + "FROB ; a fault\n" + "".join(f"P{n}\n" for n in asked) + "I3\nI5188\n")
        r = brick("exec", str(job), "--json", f"{folder}/x.json", timeout=550)
        check(r.returncode == 0, r.stderr)
        exchanges = json.loads(pathlib.Path(f"{folder}/x.json").read_text())["exchanges"]
    check(len(places) >= 30000 / each, f"{len(places)} lines, expected {30000 / each:.0f}")
    sent = [e["line"] for e in exchanges[:len(places)]]
    check(sent == [line for _, line in places.values()], "other lines were sent")
    refused = [e for e in exchanges if e["error"]]
    check(refused[-1]["line"] == "FROB" and refused[-1]["place"].startswith(str(job)), str(refused[-1]))
    kinds = collections.Counter(places[e["place"]][0] for e in refused[:-1])
    print(f"{len(places)} lines, {len(refused) - 1} refused: {dict(kinds)}")
    check(len(refused) - 1 <= MOST_REFUSED, f"expected at most {MOST_REFUSED}: {refused[:MOST_REFUSED]}")
    told = [line for line in r.stderr.splitlines() if "`: ERR" in line]
    check(len(told) == min(len(refused), 50), f"{len(told)} refused lines told")
    for line, e in zip(told, refused, strict=False):
        check(line.startswith(f"brick exec: {e['place']}: `{e['line']}`: {e['reply'][-1]}: "), f"{line}: {e}")
    check(f"{len(refused)} of {len(exchanges)} lines refused" in r.stderr, r.stderr[-200:])
    answers = [float(e["reply"][0]) for e in exchanges[-len(asked) - 2:]]
    wrong = [(n, a) for n, a in zip(asked, answers, strict=False) if abs(a - values[n]) > 1e-9 * max(1, abs(values[n]))]
    check(not wrong, f"P variables hold other values than were sent: {wrong}")
    check(answers[-2:] == [2, 50], str(answers[-2:]))


def progress():
    """A terminal on stderr sees one line that moves on and goes away, and replies beside it; a file sees nothing."""
    script = "".join(f"P{n}={n}\n" + (f"P{n}\n" if n % 500 == 499 else "") for n in range(8000)) + "FROB\n"
    answers = [str(n) for n in range(499, 8000, 500)] + ["ERR003"]
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "long.pmc"
        file.write_text(script)
        check(brick("exec", str(file)).stderr.count("\n") == 2, "silent but for the refused line")
        seen = on_terminal(file, stdout=subprocess.PIPE)
        both = on_terminal(file)
    lines = [int(n) for n in re.findall(rb"\r\x1b\[Kexec: [^\r]*, line (\d+) of 8017, \d refused", seen)]
    check(len(lines) >= 2 and lines == sorted(lines) and lines[-1] > lines[0], str(lines))
    check(b"\r\x1b[Kbrick exec: " in seen and seen.endswith(b"1 x ERR003\r\n"), str(seen[-200:]))
    # What is left when each line that goes away has gone; none of them ends in a line of its own.
    left = re.sub(r"\x1b\[Kexec: [^\r\n]*\r(?=\x1b\[K)", "", both.decode())
    left = left.replace("\r\x1b[K", "").replace("\x1b[K", "")
    check(both.count(b"exec: ") > 3 and left.replace("\r", "").split("\n")[:len(answers)] == answers, repr(left))


def on_terminal(file, **stdout):
    mine, terminal = pty.openpty()
    with subprocess.Popen([command.BRICK, "exec", str(file)], stderr=terminal,
                          **(stdout or {"stdout": terminal})) as run:
        os.close(terminal)
        seen = b""
        while chunk := read_some(mine):
            seen += chunk
    check(run.returncode == 0, seen.decode())
    return seen


def read_some(terminal):
    try:
        return os.read(terminal, 4096)
    except OSError:  # the other end is closed
        return b""


globals()[command.CASE]()
