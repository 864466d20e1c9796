#!/usr/bin/env python3
"""Pictures of moves in the pages, from runs of the machine: draw_records.py [--check] [BRICK].

Plays each script below with --record and draws the record with `brick plot` into docs/images. In the picture stands
what it was made of, as a number; --check fails when a picture is not what its script gives today.
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
# picture: script, columns, options of brick plot
PICTURES = {
    "record": (["#1J/", "@wait 30ms", "#1J:4000", "@wait 220ms"], "motor1.velocity motor1.acceleration",
               ["--from", "60ms", "--limit", "velocity=32", "--limit", "acceleration=1",
                "--title", "#1J:4000"]),
}


def run(*command, **options):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"draw_records: {done.stderr.strip()}")


def draw(brick, name, folder):
    """The picture as text, with the number of what it is made of."""
    script, columns, options = PICTURES[name]
    record, picture = pathlib.Path(folder, f"{name}.csv"), pathlib.Path(folder, f"{name}.svg")
    run(brick, "exec", *DAC8, "--record", record, "--record-of", columns, "-", input="\n".join(script) + "\n")
    run(brick, "plot", record, "-o", picture, *options)
    number = hashlib.sha256(record.read_bytes() + repr(options).encode()).hexdigest()
    return picture.read_text().replace("<svg", f"<!-- record {number} -->\n<svg", 1)


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
            text = draw(options.brick, name, folder)
            if not options.check:
                page.write_text(text)
            elif not page.exists() or number_of(page.read_text()) != number_of(text):
                stale.append(str(page.relative_to(ROOT)))
    if stale:
        sys.exit(f"draw_records: stale: {', '.join(stale)}; expected what tools/draw_records.py writes")


if __name__ == "__main__":
    main()
