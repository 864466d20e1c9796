"""`brick console` through a pipe and at a terminal (docs/console.md).

usage: console_acceptance.py BRICK CASE; each CASE is one test.
"""

import fcntl
import json
import os
import pathlib
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time

import command
from command import brick, check

COMMAND = sys.argv[1]
LONGEST = 120  # seconds to wait for an answer
ROWS, COLUMNS = 24, 80
STATUS = re.compile(r"\0337\033\[24;1H\033\[7m(.*?)\033\[0m\0338")
LEFT, UP, LEAVE = "\033[D", "\033[A", "\x1d"


class Terminal:
    """A session at a terminal of 24 rows."""

    def __init__(self, *arguments, stdout=None):
        self.seen, self.looked, self.status = "", 0, ""
        self.child, self.fd = pty.fork()
        if self.child == 0:
            os.environ["TERM"] = "xterm"
            fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            if stdout is not None:
                os.dup2(stdout, 1)
            os.execv(COMMAND, [COMMAND, "console", *arguments])

    def read(self, seconds):
        if not select.select([self.fd], [], [], seconds)[0]:
            return False
        try:
            data = os.read(self.fd, 65536)
        except OSError:  # the other end is closed
            data = b""
        self.seen += data.decode()
        self.status = (STATUS.findall(self.seen) or [self.status])[-1]
        self.seen = self.seen[:self.looked] + STATUS.sub("", self.seen[self.looked:])
        return bool(data)

    def expect_status(self, pattern):
        end = time.monotonic() + LONGEST
        while not re.search(pattern, self.status):
            check(time.monotonic() < end, f"no {pattern!r} in the status {self.status!r}")
            self.read(1)

    def expect(self, pattern):
        """Waits for it behind what was expected before; what stands between is returned."""
        end = time.monotonic() + LONGEST
        while not (found := re.compile(pattern).search(self.seen, self.looked)):
            check(time.monotonic() < end, f"no {pattern!r} in {self.seen[self.looked:][-500:]!r}")
            self.read(1)
        between = self.seen[self.looked:found.start()]
        self.looked = found.end()
        return between

    def type(self, text):
        os.write(self.fd, text.encode())

    def end(self):
        end = time.monotonic() + LONGEST
        while time.monotonic() < end:
            self.read(0.1)
            done, status = os.waitpid(self.child, os.WNOHANG)
            if done:
                return os.waitstatus_to_exitcode(status)
        os.kill(self.child, signal.SIGKILL)
        sys.exit("FAILED: the session does not end")


def piped():
    with tempfile.TemporaryDirectory() as folder:
        results = pathlib.Path(folder) / "results.json"
        lines = ["I16", "P1..2", "UUU", "^P", "@signal clock.source", "@signal nothing", "@wait 1us", "@expect 5",
                 "I17", "@quit", "I18"]
        r = brick("console", "--json", str(results), script="\n".join(lines) + "\n")
        check(r.returncode == 1, f"exit {r.returncode}: {r.stderr}")
        check(r.stdout.split("\n") == ["5", "0", "0", "ERR003", " ".join("0" * 8), "clock.source=7007", "10", ""],
              r.stdout)
        told = r.stderr.splitlines()
        check(len(told) == 4 and told[0].startswith("  UUU: unknown command"), r.stderr)
        check(told[1].startswith("console:1: @signal: no signal `nothing`") and "expected `5`" in told[2], r.stderr)
        check(told[3].startswith("brick console: 2 of the lines failed, the first: console:1: @signal"), told[3])
        made = json.loads(results.read_text())
        check(not made["passed"] and "2 of the lines failed" in made["failure"], str(made))
        exchanges = made["exchanges"]
        check([e["line"] for e in exchanges] == ["I16", "P1..2", "UUU", "^P", "@signal clock.source", "I17"],
              str(exchanges))
    r = brick("console", script="I16\r\nUUU\r\n@expect ERR003\r\n@quit \r\nI17\r\n")
    check(r.returncode == 0 and r.stdout.split() == ["5", "ERR003"], f"CR LF; an error is an answer: {r}")
    r = brick("console", "--board", "nothing", script="")
    check(r.returncode == 2 and r.stderr.count("\n") == 1, r.stderr)
    r = brick("console", "--history", "/nowhere/at/all", script="")
    check(r.returncode == 2 and "--history" in r.stderr, r.stderr)


def terminal():
    with tempfile.TemporaryDirectory() as folder:
        history = str(pathlib.Path(folder) / "history")
        t = Terminal("--history", history)
        t.expect(r"\^\] or @quit ends")
        t.expect("> ")
        t.expect_status(r"\d s \| I7007: PHASE 9\.0\d\d kHz, SERVO 2\.2\d\d kHz \| BREQ 0")
        t.type("P1=15\rP1\r")
        t.expect(r"> P1\r+\n15\r")
        t.type("P2=1" + LEFT + "3\rP2\r")  # edited: 31
        t.expect(r"> P2\r+\n31\r")
        t.type(f"{UP}{UP}{UP}\r")  # P1
        t.expect(r"\n15\r")
        t.type("P3=77")
        t.expect("P3=77")
        t.type("\x10")  # ^P goes to the controller; the line stays
        t.expect(r"0 0 0 0 0 0 0 0 *\r\n")
        t.expect(r"> P3=77")
        t.type("\rP3\r")
        t.expect(r"> P3\r+\n77\r")
        t.type("UUU\r")
        t.expect("ERR003")
        t.expect("unknown command")
        for line in ("I5=2", "OPEN PLC3 CLEAR", "I5111=1000*8388608/I10", "WHILE(I5111>0)", "ENDWHILE",
                     'SENDP"A TEXT"', "DISABLE PLC3", "CLOSE", "ENABLE PLC3"):
            t.type(line + "\r")
            t.expect(re.escape(line) + r"\r+\n")
        t.type("P1..3")  # a second passes while this line stands
        t.expect(r"A TEXT\r\n")
        t.expect(r"> P1\.\.3")
        t.type("\r")
        t.expect(r"15\r+\n31\r+\n77\r")
        t.type("@wait 9000s\r")
        t.expect(r"9000s\r+\n")
        t.expect_status(r"[1-9]\d+\.\d s")
        t.type("\x03")
        t.expect("stopped by SIGINT")
        t.type("P1\r")
        t.expect(r"> P1\r+\n(?:P1\r+\n)?15\r")  # twice where it comes before the editor has the terminal
        t.type("\u00e4P2\r")  # no ASCII: a bell
        t.expect("\a")
        t.expect(r"P2\r+\n31\r")
        t.type(LEAVE)
        check(t.end() == 0, f"exit status: {t.seen[t.looked:]!r}")
        check("\033[r" in t.seen[t.looked:], "all rows scroll again")
        t = Terminal("--history", history)
        t.expect("> ")
        t.type(UP + UP + "\r")  # of the session before; P2 is the last line, P1 the one before
        t.expect(r"P1\r+\n0\r")
        t.type("@quit\r")
        check(t.end() == 0, "@quit ends")


def simulated(terminal):
    return float(re.search(r"([\d.]+) s \|", terminal.status)[1])


def stopped_again():
    """Who holds Ctrl-C down stops what takes long, and no session: some of them come when it has been stopped. What is
    told meanwhile may be lost: with each of them a terminal forgets what it has not shown."""
    t = Terminal()
    t.expect("> ")
    t.expect_status(r"\d s")
    t.type("P1=15\r")
    for _ in range(4):
        begin = simulated(t)
        t.type("@wait 9000s\r")
        end = time.monotonic() + LONGEST
        while simulated(t) < begin + 10:  # before that the key may be one of the editor
            check(time.monotonic() < end, "no time passes")
            t.read(1)
        for pause in range(40):
            t.type("\x03")
            time.sleep(pause * 2e-5)
        time.sleep(0.5)
        check(os.waitpid(t.child, os.WNOHANG)[0] == 0, "the session has ended")
        t.type("\rP1\r")
        t.expect(r"\n15\r")
    t.type(LEAVE)
    check(t.end() == 0, f"exit status: {t.seen[t.looked:]!r}")


def ended_by_signal():
    """The flash file is whole, the terminal as it was, the lines are kept; so when the terminal is gone."""
    with tempfile.TemporaryDirectory() as folder:
        flash, history = pathlib.Path(folder) / "flash", pathlib.Path(folder) / "history"
        for value, end in enumerate((signal.SIGTERM, signal.SIGHUP), 7):
            t = Terminal("--flash", str(flash), "--history", str(history))
            t.expect("> ")
            t.type(f"I16={value} SAVE\r")
            t.expect(r"SAVE\r+\n")
            t.expect("> ")
            os.kill(t.child, end)
            t.expect(f"brick console: stopped by {end.name}")
            check(t.end() == 1, "exit status")
            check("\033[r" in t.seen, "all rows scroll again")
            r = brick("exec", "--flash", str(flash), "-", script=f"I16\n@expect {value}\n")
            check(r.returncode == 0, r.stderr)
            check(history.read_text().count("SAVE") == value - 6, history.read_text())
        t = Terminal("--flash", str(flash))
        t.expect("> ")
        t.type("I16=9 SAVE\r")
        t.expect(r"SAVE\r+\n")
        t.expect("> ")
        os.close(t.fd)
        os.waitpid(t.child, 0)
        r = brick("exec", "--flash", str(flash), "-", script="I16\n@expect 9\n")
        check(r.returncode == 0, r.stderr)
    with subprocess.Popen([COMMAND, "console"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True) as p:
        p.stdin.write("I16\n")
        p.stdin.flush()
        p.stdout.readline()
        p.terminate()  # while it waits for the next line
        try:
            status = p.wait(LONGEST)
        finally:
            p.kill()
        check(status == 1 and "stopped by SIGTERM" in p.stderr.read(), f"exit {status}")


def odd_terminals():
    """A window that becomes too low for the status line; a history that is somebody else's file; replies to a file."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "notes"
        file.write_text("my notes\n", encoding="ascii")
        r = brick("console", "--history", str(file), script="")
        check(r.returncode == 2 and "is no history; expected" in r.stderr, r.stderr)
        check(file.read_text(encoding="ascii") == "my notes\n", "it is as it was")
        t = Terminal()
        t.expect("> ")
        t.expect_status("BREQ 0")
        fcntl.ioctl(t.fd, termios.TIOCSWINSZ, struct.pack("HHHH", 1, COLUMNS, 0, 0))
        t.expect(r"\033\[r")
        t.type("P1\r")
        t.expect(r"P1\r+\n0\r")
        t.type(LEAVE)
        check(t.end() == 0, "exit status")
        replies = pathlib.Path(folder) / "replies"
        with replies.open("wb") as out:
            t = Terminal(stdout=out.fileno())
            t.type("I16\n\x04")  # ^D of the terminal: the end of a file
            check(t.end() == 0, "exit status")
        check(replies.read_text(encoding="ascii") == "5\n", replies.read_text(encoding="ascii"))


globals()[command.CASE]()
