"""The pytest plugin (docs/python.md), with tests of its own in a pytest of their own."""

import hashlib
import os
import re
import subprocess
import sys

import pytest

TESTS = """
import os, pathlib, socket, struct
import pytest

@pytest.mark.brick(plant="dac8", setup="dac8")
@pytest.mark.parametrize("sign", ["+", "*"])
def test_that_fails(brick_controller, sign, tmp_path):
    os.chdir(tmp_path)
    brick_controller.command("#1J:200")
    brick_controller.run(ms=3)
    assert brick_controller["P1"] == 5

@pytest.mark.parametrize("n", [1, 2])
def test_that_passes(brick_controller, n):
    brick_controller["P1"] = n
    assert brick_controller["P1"] == n

def test_of_a_host_program(brick_port):
    with socket.create_connection(("127.0.0.1", brick_port), 60) as host:
        for line, answer in ((b"I3=2", b""), (b"P1", b"0\\r\\x06")):
            host.sendall(struct.pack(">BBHHH", 0x40, 0xBF, 0, 0, len(line)) + line)  # GETRESPONSE
            assert host.recv(100).endswith(answer)
"""


FAILING = ["test_that_fails[+]", "test_that_fails[*]"]  # alike in a file's name


def wave_of(test):
    name = re.sub(r"[^\w.-]+", "-", test).strip("-")
    return f"waves/{name}-{hashlib.sha256(test.encode()).hexdigest()[:8]}.fst"


@pytest.fixture(scope="module", params=[[], ["-n", "2"]], ids=["alone", "xdist"])
def run(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("tests")
    (folder / "test_them.py").write_text(TESTS)
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-p", "brick.pytest_plugin", "--brick-wave",
               "waves", *request.param, "test_them.py"]
    return folder, subprocess.run(command, cwd=folder, capture_output=True, text=True, env=os.environ)


def test_tests_pass_and_fail_as_they_should(run):
    _, done = run
    assert "2 failed, 3 passed" in done.stdout, done.stdout + done.stderr


def test_a_failed_test_is_played_once_more_with_a_waveform(run):
    folder, done = run
    for test in FAILING:
        wave = folder / wave_of(f"test_them.py::{test}")
        assert f"waveform {wave}" in done.stdout
        assert wave.stat().st_size > 1000


def test_a_port_has_its_waveform_from_the_start_and_no_other_test_has_one(run):
    folder, _ = run
    assert (folder / wave_of("test_them.py::test_of_a_host_program")).stat().st_size > 1000
    assert len(list((folder / "waves").iterdir())) == 3


MARKED = """
import os, pathlib, socket
import pytest

pytestmark = pytest.mark.brick(seed=5, options=["--realtime"])

@pytest.mark.brick("turbo-pmac2-pc", "dac8", seed=7, wall_limit=11)
class TestOfAClass:
    @pytest.mark.brick(setup="dac8", seed=8, options=[])
    def test_adds_up(self, brick_controller):
        about = brick_controller.about
        assert (about["board"], about["plant"], about["seed"]) == ("turbo-pmac2-pc", "dac8", 8)
        assert brick_controller["I130"] == 112450 and brick_controller.wall_limit == 11
        assert "--realtime" not in brick_controller.options

    @pytest.mark.brick(check=False, wave="own.vcd", options=[])
    def test_of_a_port(self, brick_port):
        socket.create_connection(("127.0.0.1", brick_port), 60).close()
        assert pathlib.Path("own.vcd").exists() and not list(pathlib.Path("waves").glob("*port*"))

@pytest.mark.brick("geobrick-lv-8", "dac8", "dac8", "systemc")
def test_with_one_too_many(brick_controller):
    pass

@pytest.mark.brick(frob=1)
def test_with_one_unknown(brick_port):
    pass
"""


def test_markers_add_up_and_wrong_ones_are_errors(tmp_path):
    (tmp_path / "test_marked.py").write_text(MARKED)
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-p", "brick.pytest_plugin", "--brick-wave",
               "waves", "test_marked.py"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, env=os.environ)
    assert "2 passed, 2 errors" in done.stdout, done.stdout + done.stderr
    for what in ("too many positional arguments", "got an unexpected keyword argument 'frob'"):
        assert f"marker brick: {what}; expected arguments of brick.Controller: board, plant, setup" in done.stdout
