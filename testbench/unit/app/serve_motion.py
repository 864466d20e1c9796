"""Clients of the Ethernet port with motors: they jog, home, poll, run a coordinate system, stop all and kill all, each
with the lines that real ones send (firmware:11). `brick serve --plant dac8 --load dac8`.

usage: serve_motion.py BRICK CASE; each CASE is one test.
"""
import pathlib
import subprocess
import time

import command
from command import check
from served import PATIENCE, refused, served

# Bits of `#n?` and `&n??` (firmware:5.2 to firmware:5.5), counted from the lowest of the whole answer.
ENABLED, OPEN_LOOP, STANDS, ABORTS, SEARCHES = 24 + 19, 24 + 18, 24 + 13, 24 + 12, 24 + 10
IN_POSITION, HOME_COMPLETE, TRIGGER_MOVE = 0, 10, 7
RUNS, ALL_IN_POSITION = 48, 24 + 17


class Axes:
    def __init__(self, client):
        self.client = client

    def say(self, line, answer=""):
        said = self.client.command(line)
        check(said == answer, f"{line}: {said!r}, expected {answer!r}")

    def bits(self, query):
        return int(self.client.values(query)[0], 16)

    def bit(self, query, number):
        return self.bits(query) >> number & 1

    def place(self, motor):
        return float(self.client.values(f"#{motor}P")[0])

    def until(self, what, query, number, level=1):
        """Polls as an axis driver does, until the bit has the level."""
        last = time.monotonic() + PATIENCE
        while self.bit(query, number) != level:
            check(time.monotonic() < last, f"{what}: {query} is {self.bits(query):X}")

    def arrives(self, motor, place, within=10):
        """In position (Ixx28 of the set-up is 10 counts) where it was sent to."""
        self.until(f"motor {motor} in position", f"#{motor}?", IN_POSITION)
        check(abs(self.place(motor) - place) <= within, f"motor {motor} at {self.place(motor)}, expected {place}")

    def goes(self, motor):
        """A jog's calculation time has passed, it moves."""
        self.until(f"motor {motor} moves", f"#{motor}?", STANDS, 0)


def moving(*options):
    return served("--free", "--plant", "dac8", "--load", "dac8", *options)


def serve_jogs():
    """Every form of a jog that drivers use, each polled until it is done."""
    with moving() as server, server.client() as client:
        axes = Axes(client)
        axes.say("M140->Y:$0000C0,0,1 M240->Y:$000140,0,1")
        check(axes.bits("#1?") == 0x850000078000, f"set up, killed: {client.values('#1?')}")
        axes.say("#1J/")
        axes.arrives(1, 0)
        check(axes.bits("#1?") == 0x89200007C001, f"{client.values('#1?')}")
        axes.say("#1J^100")
        axes.goes(1)
        axes.arrives(1, 100, 12)
        axes.say("#1 J/ M140=1")
        axes.arrives(1, 100, 12)
        axes.say("M140", "1\r")
        axes.say("#1J=4000")
        axes.goes(1)
        axes.say("M140", "0\r")
        axes.arrives(1, 4000)
        axes.say("i122=50 i120=10 #1 J=-500")
        axes.goes(1)
        axes.arrives(1, -500)
        axes.say("#1J:250")
        axes.goes(1)
        axes.arrives(1, -250)
        axes.say("#2J+ #3J-")
        axes.goes(2)
        axes.goes(3)
        axes.say("#2J/ #3J/")
        for motor in (2, 3):
            axes.until("it stops", f"#{motor}?", IN_POSITION)
        check(axes.place(2) > 0 > axes.place(3), f"{axes.place(2)} {axes.place(3)}")
        before = axes.place(2)
        axes.say("i224=i224|$20000")
        axes.say("i224", "$820001\r")
        axes.say("#2J^-100")
        axes.goes(2)
        axes.arrives(2, before - 100, 22)
        axes.say("i224=i224&$FDFFFF")
        axes.say("i224", "$800001\r")
        errors = client.values("#1F#2F#3F")
        check(all(abs(float(e)) <= 10 for e in errors), str(errors))


def serve_homes():
    """HM to the index, as a driver follows it; where that was is 0 then."""
    with moving() as server, server.client() as client:
        axes = Axes(client)
        for motor in (1, 2):
            axes.say(f"#{motor}J/")
        axes.say("#1J=700 #2J=-300")
        axes.goes(2)
        axes.arrives(1, 700)
        axes.arrives(2, -300)
        # Motor 1 goes up to the index of the next revolution, motor 2 down to one.
        axes.say("I223=-10 #1HM #2HM")
        for motor in (1, 2):
            axes.until("it searches", f"#{motor}?", SEARCHES)
            check(not axes.bit(f"#{motor}?", HOME_COMPLETE), "not yet")
        for motor in (1, 2):
            axes.until("it has found home", f"#{motor}?", HOME_COMPLETE)
            check(not axes.bit(f"#{motor}?", SEARCHES), "the search is over")
            axes.arrives(motor, 0)
        # The counters stand where the indices are: count 2 of a revolution of 4000 (docs/plant.md).
        for motor, address, index in ((1, 0x78001, 4002), (2, 0x78009, -3998)):
            counts = int(client.values(f"RX${address:X}")[0])
            check(abs(counts - index) <= 10, f"motor {motor}: counter {counts}, its index is at {index}")
        axes.say("#1HMZ")
        axes.say("#3HMZ")
        check(axes.bit("#3?", HOME_COMPLETE), "HMZ of a killed motor")


def serve_runs():
    """A program of a coordinate system is downloaded, started, polled, aborted, and started again."""
    lines = ["OPEN PROG 5 CLEAR", "LINEAR ABS TA50 TS20 TM400", "X4 Y-2", "DWELL20", "RAPID X1 Y1", "LINEAR TM4000",
             "X100 Y50", "CLOSE"]
    with moving() as server, server.client() as client:
        axes = Axes(client)
        check(client.write_lines(lines) is None, "download")
        check(refused(client, "&1B5R") == "ERR012", "killed motors")
        axes.say("&1A")  # closes them
        axes.until("they are on", "&1??", ALL_IN_POSITION)
        axes.say("Q70=1 &1B5R")
        check(axes.bit("&1??", RUNS), "runs")
        check(refused(client, "#1J=5") == "ERR001" and refused(client, "#1K") == "ERR001", "what the program moves")
        last = time.monotonic() + PATIENCE
        while axes.place(1) < 5000:  # the last move
            check(time.monotonic() < last, "it does not come there")
        x, y = (float(v) for v in client.values("#1P#2P"))
        check(abs((x - 1000) / (y - 1000) - 99 / 49) < 0.02 or x < 5000, f"on the line: {x}, {y}")
        axes.say("&1%50")
        while not client.values("&1%")[0].startswith("50"):  # it goes there at Isx94
            check(time.monotonic() < last, "it does not come to 50 %")
        axes.say("&1A")
        check(not axes.bit("&1??", RUNS), "aborted")
        axes.until("all stand", "&1??", ALL_IN_POSITION)
        check(axes.place(1) < 100000, "not at the end")
        check(all(axes.bit(f"#{m}?", ENABLED) for m in range(1, 9)), "A leaves them on")
        axes.say("&1%100")
        check(client.write_lines(["OPEN PROG 6 CLEAR", "LINEAR ABS TA50 TS20 TM200", "X2 Y3", "CLOSE"]) is None, "6")
        axes.say("&1B6R")
        axes.until("it has ended", "&1??", RUNS, 0)
        axes.until("and is there", "&1??", ALL_IN_POSITION)
        axes.arrives(1, 2000)
        axes.arrives(2, 3000)


def serve_stops():
    """Stop all, by the two bytes 01 0A and by ^A; kill all, by ^K: every motor, jogged and of a program."""
    with moving() as server, server.client() as client:
        axes = Axes(client)
        for motor in range(1, 9):
            axes.say(f"#{motor}J/")
        check(client.write_lines(["OPEN PROG 5 CLEAR", "LINEAR INC TA50 TS20 TM4000", "A100 B100", "CLOSE"]) is None,
              "download")
        stops = (lambda: client.request(0x40, 0xBF, data=b"\x01\x0a"), lambda: client.request(0x40, 0xB6, value=1))
        for stop in stops:
            axes.say("I5187=50 #1J+ #2J- #3J=400000")
            for motor in (1, 2, 3):
                axes.goes(motor)
            stop()
            for motor in (1, 2, 3):
                axes.until("it stands", f"#{motor}?", IN_POSITION)
                check(axes.bit(f"#{motor}?", ENABLED) and not axes.bit(f"#{motor}?", OPEN_LOOP), "on and closed")
            axes.say("&1B5R")
            axes.goes(4)
            axes.goes(5)
            stop()
            axes.until("the program has ended", "&1??", RUNS, 0)
            for motor in range(1, 9):
                axes.until("it stands", f"#{motor}?", IN_POSITION)
        axes.say("#1J+ #2J-")
        axes.goes(1)
        client.request(0x40, 0xB6, value=0x0B)
        for motor in range(1, 9):
            axes.until("it is off", f"#{motor}?", ENABLED, 0)
            check(axes.bit(f"#{motor}?", OPEN_LOOP), "open")
        enables = client.values("".join(f"RX${0x78005 + 0x100 * (m // 4) + 8 * (m % 4):X} " for m in range(8)))
        check(not any(int(word) >> 14 & 1 for word in enables), f"AENA: {enables}")


def serve_polls():
    """The driver in C polls eight axes while they go, from one connection, and sends them from another."""
    driver = pathlib.Path(command.BRICK).with_name("poll_driver")
    states = "".join(f"#{motor}?" for motor in range(1, 9))
    go = "".join(f"#{motor}J={1000 * motor}" for motor in range(1, 9))
    with moving() as server:
        r = subprocess.run([driver, str(server.port), "400", "&1E", states, go], text=True, capture_output=True,
                           timeout=PATIENCE, check=False)
        check(r.returncode == 0, r.stderr)
        with server.client() as client:
            axes = Axes(client)
            for motor in range(1, 9):
                axes.arrives(motor, 1000 * motor)
    polls = [line.split("|")[:-1] for line in r.stdout.splitlines() if line.count("|") == 32]
    check(len(polls) == 400, f"{len(polls)} polls")
    enabled = [line.split("|")[:-1] for line in r.stdout.splitlines() if line.count("|") == 8]
    check(len(enabled) == 1 and all(int(word, 16) >> ENABLED & 1 for word in enabled[0]), f"behind &1E: {enabled}")
    for motor in range(8):
        places = [float(poll[4 * motor + 1]) for poll in polls]
        speeds = [float(poll[4 * motor + 2]) for poll in polls]
        check(min(places) >= -1 and max(places) <= 1000 * (motor + 1) + 20, f"motor {motor + 1}: {max(places)}")
        # 32 counts/ms are 14.17 a servo cycle.
        check(max(speeds) < 16, f"motor {motor + 1}: {max(speeds)} counts a servo cycle")
        check(all(abs(float(poll[4 * motor + 3])) <= 20 for poll in polls), f"following error of motor {motor + 1}")


globals()[command.CASE]()
