"""mypy --strict over the Python package and its examples, for Python 3.11."""
import importlib.util
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
SKIPPED = 77
if importlib.util.find_spec("mypy") is None:
    print("skipped: mypy is not installed (./dev setup puts it into build/venv)")
    sys.exit(SKIPPED)
command = [sys.executable, "-m", "mypy", "--strict", "--python-version", "3.11", "--cache-dir", os.devnull,
           "python/brick", "examples/python"]
sys.exit(subprocess.run(command, cwd=ROOT, env={**os.environ, "MYPYPATH": "python"}).returncode)
