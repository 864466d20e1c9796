#!/usr/bin/env python3
"""Draws the timing figures of the documentation from testbench/vectors/NAME.vec into docs/images/vectors/.

  draw_vectors.py [--program build/release/bin/brick_vectors]
               runs each vector that has a [wave] on the model, writes NAME.json (WaveDrom source) and NAME.svg
  --check      every NAME.json has the NAME.svg that was drawn from it, and every vector with a [wave] has both; whether
               the .json is what the vector says is shown by the tests vectors.figure_NAME
  --check-svg  draws each NAME.json anew and compares
  Drawing needs the Python package wavedrom (`./dev setup` puts it into build/venv). Without it, or with another version
  than that which drew, --check-svg ends with exit status 77.
"""

import argparse
import hashlib
import importlib.metadata
import pathlib
import re
import subprocess
import sys

from common import ROOT, finish, skip

try:
    import wavedrom
except ImportError:
    wavedrom = None

WHITE = '<rect width="100%" height="100%" fill="white" />'


def version():
    return importlib.metadata.version("wavedrom")


def origin(source):
    """The first line of a drawing: what it was drawn from, and by which version."""
    return re.compile(rf"<!-- drawn from sha256 {hashlib.sha256(source.encode()).hexdigest()} by wavedrom (\S+) -->\n")


def draw(source):
    """The SVG of a WaveDrom source, on white, so that it can be read on a dark page."""
    svg = wavedrom.render(source).tostring()
    svg = re.sub(r"(<svg\b[^>]*>)", r"\1" + WHITE, svg, count=1)
    return f"<!-- drawn from sha256 {hashlib.sha256(source.encode()).hexdigest()} by wavedrom {version()} -->\n{svg}\n"


def drawn_vectors(root):
    return [path for path in sorted((root / "testbench/vectors").glob("*.vec"))
            if re.search(r"^\[wave\]", path.read_text(), re.M)]


def write(root, program):
    if wavedrom is None:
        skip("the Python package wavedrom is not installed (./dev setup puts it into build/venv)")
    if not program.exists():
        sys.exit(f"draw_vectors.py: {program} does not exist; build the target brick_vectors or name it: --program")
    folder = root / "docs/images/vectors"
    folder.mkdir(parents=True, exist_ok=True)
    for vector in drawn_vectors(root):
        done = subprocess.run([program, "--draw", vector], cwd=root, stdout=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            sys.exit(done.returncode)
        (folder / f"{vector.stem}.json").write_text(done.stdout)
        (folder / f"{vector.stem}.svg").write_text(draw(done.stdout))
        print(f"docs/images/vectors/{vector.stem}.svg")


def problems_in(root):
    folder = root / "docs/images/vectors"
    wanted = {vector.stem for vector in drawn_vectors(root)}
    for name in sorted(wanted | {path.stem for path in folder.glob("*")}):
        source, drawing = folder / f"{name}.json", folder / f"{name}.svg"
        missing = [path for path in (source, drawing) if not path.exists()]
        if name not in wanted:
            yield f"{folder.relative_to(root)}/{name}.*: no vector with a [wave] has this name"
        elif missing:
            yield f"{missing[0].relative_to(root)}: missing, run tools/draw_vectors.py"
        elif not origin(source.read_text()).match(drawing.read_text()):
            yield f"{drawing.relative_to(root)}: drawn from another {name}.json, run tools/draw_vectors.py"


def stale_drawings(root):
    if wavedrom is None:
        skip("the Python package wavedrom is not installed (./dev setup puts it into build/venv)")
    for drawing in sorted((root / "docs/images/vectors").glob("*.svg")):
        source = drawing.with_suffix(".json").read_text()
        by = origin(source).match(drawing.read_text())
        if by and by[1] != version():
            skip(f"drawn by wavedrom {by[1]}, here is {version()}")
        if draw(source) != drawing.read_text():
            yield f"{drawing.relative_to(root)}: stale, run tools/draw_vectors.py"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--check-svg", action="store_true")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/brick_vectors")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    options = parser.parse_args()
    root = options.root.resolve()
    if options.check:
        finish("figures of the vectors", [*problems_in(root)])
    elif options.check_svg:
        finish("drawings of the vectors", [*stale_drawings(root)])
    else:
        write(root, options.program.resolve())


if __name__ == "__main__":
    main()
