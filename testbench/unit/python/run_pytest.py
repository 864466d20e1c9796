"""Runs tests with the package of this tree and a built command: run_pytest.py BRICK FILE|FOLDER [OPTIONS]."""
import importlib.util
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
SKIPPED = 77
if missing := [name for name in ("pytest", "xdist", "numpy", "pandas") if importlib.util.find_spec(name) is None]:
    print(f"skipped: {', '.join(missing)} not installed (./dev setup puts them into build/venv)")
    sys.exit(SKIPPED)
brick, *tests = sys.argv[1:]
path = os.pathsep.join([str(ROOT / "python"), os.environ.get("PYTHONPATH", "")]).rstrip(os.pathsep)
environment = {**os.environ, "BRICK": brick, "PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": "1"}
command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "brick.pytest_plugin", *tests]
sys.exit(subprocess.run(command, env=environment).returncode)
