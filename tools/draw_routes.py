#!/usr/bin/env python3
"""How fast program lines reach a rotary buffer, as tables and a drawing: draw_routes.py [--write] [FOLDER].

Runs FOLDER/brick_routes (build/release/bin) and prints the tables of docs/routes.md. --write puts them into the page
and draws docs/images/routes.svg. The numbers are of simulated time: the same on every machine, for one firmware.
"""

import argparse
import json
import math
import pathlib
import re
import subprocess
import sys

from common import ROOT

PAGE, DRAWING = ROOT / "docs/routes.md", ROOT / "docs/images/routes.svg"
COLOURS = ["#555555", "#2b7bba", "#c0392b", "#e08e0b"]
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 720, 380, 70, 190, 46, 46
LEAST, MOST = 1e3, 2e5  # lines a second


def measure(folder):
    run = subprocess.run([folder / "brick_routes", folder / "turbo.elf"], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(f"draw_routes: {run.stderr.strip()}")
    return [json.loads(line) for line in run.stdout.splitlines() if line.startswith("{")]


def thousands(value):
    return f"{round(value, -2) if value >= 1000 else round(value):,.0f}"


def table(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
                     + ["| " + " | ".join(row) + " |" for row in rows])


def tables(rows):
    """By name, as the markers of the page have them."""
    speeds = [r for r in rows if "axes" in r]
    routes = list(dict.fromkeys(r["route"] for r in rows))
    axes = sorted({r["axes"] for r in speeds})

    def at(route, n):
        return next(r for r in speeds if r["route"] == route and r["axes"] == n)

    def lines(key, form):
        return table(["", *(f"{n} axis" if n == 1 else f"{n} axes" for n in axes)],
                     [[route, *(form(at(route, n)[key]) for n in axes)] for route in routes])

    def cycles(route, n):
        r = at(route, n)
        return f"{r['io_cycles'] + r['memory_cycles']:.0f} ({r['bus_us']:.0f} us)"

    reasons = [[route, *(cycles(route, n) for n in (1, 8)), *(thousands(at(route, n)["cpu_cycles"]) for n in (1, 8)),
                *(thousands(at(route, 1)[key]) for key in ("one_by_one", "lines_per_second"))] for route in routes]
    delays = [[r["route"], *(f"{r[key][which]:,.0f}" for key in ("breq", "breq_with_plcs")
                             for which in ("median", "most"))] for r in rows if "breq" in r]
    return {
        "speed": lines("lines_per_second", thousands),
        "reasons": table(["", "bus cycles, 1 axis", "8 axes", "CPU cycles, 1 axis", "8 axes",
                          "lines/s one by one", "as many as go"], reasons),
        "delays": table(["us", "median", "most", "with PLCs: median", "most"], delays)}


def text(x, y, words, **style):
    styles = " ".join(f'{k.replace("_", "-")}="{v}"' for k, v in style.items())
    return f'<text x="{x:.0f}" y="{y:.0f}" {styles}>{words}</text>'


def drawing(rows):
    speeds = [r for r in rows if "axes" in r]
    routes = list(dict.fromkeys(r["route"] for r in speeds))
    axes = sorted({r["axes"] for r in speeds})
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM

    def x(n):
        return LEFT + (right - LEFT) * (0.06 + 0.88 * math.log2(n) / math.log2(axes[-1]))

    def y(rate):
        return bottom - (bottom - TOP) * math.log(rate / LEAST) / math.log(MOST / LEAST)

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" '
             'font-size="12">', f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
             text(LEFT, 24, "Program lines into a rotary buffer, a second of simulated time", font_size=15)]
    for rate in (1e3, 2e3, 5e3, 1e4, 2e4, 5e4, 1e5, 2e5):
        parts += [f'<path d="M{LEFT} {y(rate):.1f}H{right}" stroke="#dddddd"/>',
                  text(LEFT - 8, y(rate) + 4, f"{rate:,.0f}", text_anchor="end")]
    for n in axes:
        parts.append(text(x(n), bottom + 18, f"{n} axis" if n == 1 else f"{n} axes", text_anchor="middle"))
    for route, colour in zip(routes, COLOURS, strict=True):
        points = [(x(r["axes"]), y(r["lines_per_second"])) for r in speeds if r["route"] == route]
        path = "L".join(f"{px:.1f} {py:.1f}" for px, py in points)
        parts.append(f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{px:.1f}" cy="{py:.1f}" r="4" fill="{colour}"/>' for px, py in points]
        parts.append(text(points[-1][0] + 12, points[-1][1] + 4, route, fill=colour))
    return "\n".join([*parts, "</svg>", ""])


def written(page, by_name):
    for name, words in by_name.items():
        page, count = re.subn(rf"(<!-- {name} -->\n).*?(\n<!-- end -->)", lambda m, w=words: m[1] + w + m[2], page,
                              flags=re.DOTALL)
        if count != 1:
            sys.exit(f"draw_routes: {count} places of `{name}` in {PAGE}; expected one")
    return page


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true")
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=ROOT / "build/release/bin")
    options = parser.parse_args()
    rows = measure(options.folder)
    by_name = tables(rows)
    print("\n\n".join(by_name.values()))
    if options.write:
        PAGE.write_text(written(PAGE.read_text(), by_name))
        DRAWING.write_text(drawing(rows))


if __name__ == "__main__":
    main()
