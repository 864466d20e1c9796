#!/usr/bin/env python3
"""A step and a parabolic jog of motor 1, gathered by the controller at each servo interrupt: tune.py [FOLDER].

Plays tuning.pmc with `brick exec` (BRICK in the environment, or on the PATH), writes step.csv and parabola.csv to
FOLDER (default: beside this file) and prints what they say about the loop. --check writes nothing; exit status 1 when
the moves in FOLDER's tables are not those that the controller gathers today, within one count commanded and three
actual: where friction lets go depends on the instant.
"""
import itertools
import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SERVO_MS = 3713991 / 8388608  # I10
UNITS = 32 * 96  # of a count in a position word: 32 x I108
HEADER = "ms,commanded,actual,output"


def signed(digits):
    """A long word (12 digits) or a word (6 digits), two's complement."""
    value, bits = int(digits, 16), 4 * len(digits)
    return value - (value >> bits - 1 << bits)


def samples(lines):
    """Commanded and actual position in counts, output in bits of 16: three long words each, the last one half used."""
    return [(n * SERVO_MS, signed(lines[3 * n]) / UNITS, signed(lines[3 * n + 1]) / UNITS,
             signed(lines[3 * n + 2][:6]) // 256) for n in range(len(lines) // 3)]


def gather():
    brick = os.environ.get("BRICK", "brick")
    if shutil.which(brick) is None:
        print(f"skipped: no {brick}")
        sys.exit(77)
    done = subprocess.run([brick, "exec", "--plant", "dac8", "--load", "dac8", HERE / "tuning.pmc"], text=True,
                          capture_output=True, check=False)
    if done.returncode != 0:
        sys.exit(f"tune.py: {done.stderr.strip()}")
    lines = done.stdout.split()
    between = next(n for n, line in enumerate(lines) if line.startswith("time="))
    return {"step": samples(lines[:between]), "parabola": samples(lines[between + 2:])}


def table(rows):
    return "\n".join([HEADER, *(f"{t:.4f},{c:.4f},{a:.4f},{o}" for t, c, a, o in rows)]) + "\n"


def read(file):
    lines = file.read_text(encoding="ascii").splitlines()
    return [tuple(float(value) for value in line.split(",")) for line in lines[1:]] if lines[0] == HEADER else []


def are_alike(first, second):
    """The moves: what stands before them is as long as the commands happened to take."""
    pairs = list(zip(from_step(first), from_step(second), strict=False))
    return len(pairs) > 150 and all(abs(a[1] - b[1]) <= 1 and abs(a[2] - b[2]) <= 3 for a, b in pairs)


def from_step(rows):
    """Rows from the interrupt on that shows another commanded position, and how far it is sent."""
    first = next(n for n, row in enumerate(rows) if row[1] != rows[0][1])
    start = rows[first - 1]
    return [(t - start[0], c - start[1], a - start[2], o) for t, c, a, o in rows[first - 1:]]


def of_step(rows):
    rows = from_step(rows)
    size = rows[-1][1]
    rise = [next(t for t, _, a, _ in rows if a >= part * size) for part in (0.1, 0.9)]
    overshoot = max(a for _, _, a, _ in rows) / size - 1
    settled = max((t for t, _, a, _ in rows if abs(a - size) > 0.02 * size), default=0.0)
    return {"size": size, "rise ms": rise[1] - rise[0], "overshoot %": max(0.0, 100 * overshoot),
            "settled ms": settled + SERVO_MS}


def of_parabola(rows):
    rows = from_step(rows)
    errors = [c - a for _, c, a, _ in rows]
    speeds = [(after[1] - before[1]) / SERVO_MS for before, after in itertools.pairwise(rows)]
    return {"size": rows[-1][1], "speed": max(speeds), "error": max(abs(e) for e in errors), "at rest": abs(errors[-1])}


def main():
    arguments = [a for a in sys.argv[1:] if a != "--check"]
    folder = pathlib.Path(arguments[0]) if arguments else HERE
    gathered = gather()
    for name, rows in gathered.items():
        file = folder / f"{name}.csv"
        if "--check" not in sys.argv[1:]:
            file.write_text(table(rows), encoding="ascii")
        elif not are_alike(read(file), rows):
            sys.exit(f"tune.py: {file} is not what is gathered today")
    step, parabola = of_step(gathered["step"]), of_parabola(gathered["parabola"])
    print("step of {size:.0f} counts: rise time {rise ms:.1f} ms, overshoot {overshoot %:.1f} %, "
          "settled to 2 % after {settled ms:.1f} ms".format(**step))
    print("parabolic jog of {size:.0f} counts: {speed:.1f} counts/ms, following error {error:.2f} counts at most, "
          "{at rest:.2f} at rest".format(**parabola))


if __name__ == "__main__":
    main()
