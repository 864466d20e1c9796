#!/usr/bin/env python3
"""Lints the Python of the tree with ruff, by the rules of pyproject.toml: lint_python.py [--root FOLDER].

Exit status 0 clean, 1 problems, 77 ruff is not installed where this interpreter looks.
"""

import argparse
import importlib.util
import pathlib
import subprocess
import sys

from common import ROOT, finish, skip


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    root = parser.parse_args().root
    if importlib.util.find_spec("ruff") is None:
        skip("ruff is not installed (./dev setup puts it into build/venv)")
    command = [sys.executable, "-m", "ruff", "check", "--no-cache", "--output-format", "concise", "--quiet",
               "--config", ROOT / "pyproject.toml", root]
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    problems = done.stdout.splitlines() or [f"ruff ended with exit status {done.returncode} and said nothing"]
    finish("ruff", problems if done.returncode else [])


if __name__ == "__main__":
    main()
