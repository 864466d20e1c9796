#!/usr/bin/env python3
"""Pictures of moves in the pages, from runs of the machine: draw_records.py [--check] [BRICK].

Plays each script below with --record and draws the record with `brick plot` into docs/images. In the picture stands
what it was made of, as a number: its records and what gnuplot is told. --check fails when these are others today.
"""

import argparse
import hashlib
import pathlib
import subprocess
import sys
import tempfile

from common import ROOT

IMAGES = ROOT / "docs/images"
DAC8 = ["--plant", "dac8", "--load", "dac8"]


def contour(*orders, ahead):
    """A corner, half a circle and a way back of two motors at 40 counts/ms, with Isx20."""
    return ["#1J/", "#2J/", "@wait 20ms", "&1 UNDEFINE ALL #1->100X #2->100Y", "I116=40 I117=1 I216=40 I217=1",
            f"I5190=1000 I5192=0 I5198=0 I5113=2 I5120={ahead}", "DELETE GATHER", "DEFINE LOOKAHEAD 120,0",
            "OPEN PROG 1 CLEAR", "NORMAL K-1 INC F400 TA10 TS0", "X16", "Y10", "CIRCLE2 X-12 I-6 J0", "LINEAR Y-8 X2",
            "CLOSE", "B1R", *orders]


# picture: scripts by the name of their record, the second beside the first; columns, options of brick plot
PICTURES = {
    "first-move": ({"first-move": (ROOT / "examples/scripts/first-move.txt").read_text().splitlines()},
                   "motor1.actual motor1.velocity plant.axis1.torque",
                   ["--from", "90ms", "--to", "320ms", "--title", "#1J:4000"]),
    "record": ({"record": ["#1J/", "@wait 30ms", "#1J:4000", "@wait 220ms"]}, "motor1.velocity motor1.acceleration",
               ["--from", "60ms", "--limit", "velocity=32", "--limit", "acceleration=1",
                "--title", "#1J:4000"]),
    "lookahead": ({"limited": contour("@wait 280ms", ahead=40), "unlimited": contour("@wait 280ms", ahead=0)},
                  "motor1.velocity motor1.acceleration",
                  ["--from", "60ms", "--to", "340ms", "--limit", "velocity=40", "--limit", "acceleration=1",
                   "--title", "limited by lookahead, and without it"]),
    "corner": ({"corner": contour("@wait 280ms", ahead=40)}, "motor1.commanded motor2.commanded",
               ["--xy", "motor1.commanded motor2.commanded", "--from", "60ms", "--to", "340ms",
                "--title", "speed along the path, counts/ms"]),
    "reversal": ({"reversal": contour("@wait 110ms", "<", "@wait 90ms", ">", "@wait 265ms", ahead=40)},
                 "motor1.commanded motor2.commanded feed=feed:1,2 motor1.acceleration",
                 ["--from", "60ms", "--limit", "acceleration=1", "--title", "back with <, forwards with >"]),
}


def run(*command, **options):
    """What it prints."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"draw_records: {done.stderr.strip()}")
    return done.stdout


def draw(brick, name, folder):
    """The picture as text, with the number of what it is made of."""
    scripts, columns, options = PICTURES[name]
    picture, records = f"{name}.svg", [f"{title}.csv" for title in scripts]  # in the folder: no path in what is told
    for record, script in zip(records, scripts.values(), strict=True):
        run(brick, "exec", *DAC8, "--record", record, "--record-of", columns, "-", input="\n".join(script) + "\n",
            cwd=folder)
    plot = [brick, "plot", records[0], *(["--beside", records[1]] if records[1:] else []), "-o", picture, *options]
    run(*plot, cwd=folder)
    told = run(*plot, "--script", cwd=folder).encode()
    number = hashlib.sha256(b"".join(pathlib.Path(folder, r).read_bytes() for r in records) + told).hexdigest()
    return pathlib.Path(folder, picture).read_text().replace("<svg", f"<!-- record {number} -->\n<svg", 1)


def number_of(text):
    return next((line for line in text.splitlines() if line.startswith("<!-- record ")), "")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing, fail when a picture is stale")
    parser.add_argument("brick", nargs="?", default=ROOT / "build/release/bin/brick")
    options = parser.parse_args()
    stale = []
    with tempfile.TemporaryDirectory() as folder:
        for name in PICTURES:
            page = IMAGES / f"{name}.svg"
            text = draw(pathlib.Path(options.brick).resolve(), name, folder)
            if not options.check:
                page.write_text(text)
            elif not page.exists() or number_of(page.read_text()) != number_of(text):
                stale.append(str(page.relative_to(ROOT)))
    if stale:
        sys.exit(f"draw_records: stale: {', '.join(stale)}; expected what tools/draw_records.py writes")


if __name__ == "__main__":
    main()
