"""How long the Python package keeps whoever tests with it waiting, of the wall, median of five. Not a test.

usage: python_speed.py BRICK
"""
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from rows import row

PACKAGE = pathlib.Path(__file__).resolve().parents[2] / "python"
CLIENTS = pathlib.Path(__file__).resolve().parents[1] / "clients"
sys.path.insert(0, str(PACKAGE))
os.environ["BRICK"] = str(pathlib.Path(sys.argv[1]).resolve())
import brick  # noqa: E402

ROUNDS, ANSWER, TESTS = 5, 1, 10  # seconds until the first answer, and of ten tests
HOST_TESTS = """
import pytest
from turbo_pmac import TurboPmac


@pytest.mark.parametrize("number", range(10))
def test_host(brick_port, number):
    with TurboPmac("127.0.0.1", brick_port) as client:
        assert client.command(f"P1={number} P1").strip() == str(number)
"""


def first_answer():
    with brick.Controller(plant="dac8", setup="dac8") as controller:
        controller.command("#1P")


def ten_tests(folder):
    (folder / "test_host.py").write_text(HOST_TESTS)
    paths = f"{PACKAGE}:{CLIENTS}"
    done = subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "brick.pytest_plugin", "-p", "no:cacheprovider",
                           "test_host.py"], cwd=folder, env={**os.environ, "PYTHONPATH": paths}, capture_output=True,
                          text=True, check=False)
    if "10 passed" not in done.stdout:
        sys.exit(f"python_speed: ten tests: {done.stdout}{done.stderr}")


def seconds(what, *arguments):
    times = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        what(*arguments)
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def main():
    measured = seconds(first_answer)
    row("Python, from Controller() to the first answer, with motors", f"{measured:.2f} s", f"<= {ANSWER} s",
        measured <= ANSWER)
    with tempfile.TemporaryDirectory() as folder:
        measured = seconds(ten_tests, pathlib.Path(folder))
    row("pytest, ten tests of a host program, brick_port", f"{measured:.2f} s", f"<= {TESTS} s", measured <= TESTS)


main()
