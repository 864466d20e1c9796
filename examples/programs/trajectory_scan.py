#!/usr/bin/env python3
"""The host of trajectory-scan.pmc: it starts a controller (`brick serve`, BRICK in the environment or on the PATH), and
over its Ethernet port fills one buffer of points while the program moves through the other: a circle of 10 mm, 120
points of 16 ms. What the motors were commanded is recorded, and the circle in it is judged."""
import contextlib
import csv
import math
import os
import pathlib
import re
import shutil
import socket
import struct
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
RADIUS, POINTS, MS, IN_BUFFER = 10.0, 120, 16, 40
COUNTS = 1000  # a millimetre
ADDRESS = (0x10400, 0x10500)


class Port:
    """The Ethernet port: a header of eight bytes, a command line, its answer."""

    def __init__(self, place):
        self.socket = socket.create_connection(place, 60)

    def command(self, line):
        data = line.encode("ascii")
        self.socket.sendall(struct.pack(">BBHHH", 0x40, 0xBF, 0, 0, len(data)) + data)
        reply = b""
        while not reply or reply[-1:] not in b"\x06\r":
            reply += self.socket.recv(2048)
        if b"\x07" in reply:
            raise OSError(f"{line}: {reply!r}")
        return reply[:-1].decode("ascii").split()


def point(n):
    """Position in mm and velocity in mm/s at point n: once around, from rest to rest."""
    t, whole = n / POINTS, POINTS * MS / 1000
    angle = 2 * math.pi * t**3 * (10 - 15 * t + 6 * t * t)
    rate = 2 * math.pi * 30 * t * t * (1 - t) ** 2 / whole
    return (RADIUS * (1 - math.cos(angle)), RADIUS * math.sin(angle) * rate,
            RADIUS * math.sin(angle), RADIUS * math.cos(angle) * rate)


def fill(port, buffer, first):
    """Points from `first` on, as many as the buffer takes; the last thing is their number, from which on they count."""
    count = min(IN_BUFFER, POINTS - first + 1)
    for n in range(count):
        words = ",".join(f"{v:.6f}" for v in (MS, *point(first + n)))
        port.command(f"WL:${ADDRESS[buffer] + 5 * n:X},{words}")
    port.command(f"P{4102 + buffer}={count}")
    return first + count


def scan(port):
    """Buffers that were filled while the program ran."""
    following, filled, buffer = fill(port, 1, fill(port, 0, 1)), 0, 0
    port.command("&1B13R")
    while following <= POINTS:
        if float(port.command(f"P{4102 + buffer}")[0]) == 0:
            following, filled, buffer = fill(port, buffer, following), filled + 1, 1 - buffer
    while float(port.command("P4100")[0]) != 2:
        pass
    while int(port.command("M140")[0]) == 0 or int(port.command("M240")[0]) == 0:
        pass
    return filled, float(port.command("P4104")[0]), [float(v) for v in port.command("#1P#2P")]


def judge(rows):
    """Radius and duration of the circle that was commanded: counts and ms."""
    moving = [n for n in range(1, len(rows)) if rows[n][1:] != rows[n - 1][1:]]
    radii = [math.hypot(x - RADIUS * COUNTS, y) for _, x, y in rows]
    return min(radii), max(radii), rows[moving[-1]][0] - rows[moving[0]][0], max(y for _, _, y in rows)


def main():
    brick = os.environ.get("BRICK", "brick")
    if shutil.which(brick) is None:
        print(f"skipped: no {brick}")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        record = pathlib.Path(folder) / "scan.csv"
        served = stack.enter_context(subprocess.Popen(
            [brick, "serve", "--listen", "127.0.0.1:0", "--free", "--plant", HERE / "stage.toml", "--load",
             HERE / "trajectory-scan.pmc", "--record", record, "--record-of", "motor1.commanded motor2.commanded"],
            stdout=subprocess.PIPE, text=True))
        stack.callback(served.terminate)
        line = served.stdout.readline()
        place = re.search(r"(127\.0\.0\.1):(\d+)", line)
        if place is None:
            sys.exit(f"trajectory_scan.py: no controller: {line.strip()}")
        filled, done, position = scan(Port((place[1], int(place[2]))))
        served.terminate()
        served.wait(60)
        with record.open(encoding="ascii") as file:
            rows = [[float(v) for v in row] for row in list(csv.reader(file))[1:]]
    least, most, lasted, top = judge(rows)
    print(f"{done:.0f} points, {filled} buffers filled under way, radius {least:.1f} to {most:.1f} counts, "
          f"{lasted:.0f} ms, at the end {position[0]:.0f} {position[1]:.0f}")
    if not (done == POINTS and filled >= 1 and max(abs(p) for p in position) <= 10):
        sys.exit("trajectory_scan.py: the scan did not come to its end")
    if max(RADIUS * COUNTS - least, most - RADIUS * COUNTS) > 1 or top < 0.99 * RADIUS * COUNTS:
        sys.exit("trajectory_scan.py: what was commanded is not the circle")


if __name__ == "__main__":
    main()
