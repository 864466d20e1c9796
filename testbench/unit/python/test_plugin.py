"""The pytest plugin (docs/python.md), with tests of its own in a pytest of their own."""

import hashlib
import os
import re
import subprocess
import sys

import pytest

TESTS = """
import pathlib, socket, struct
import pytest

@pytest.mark.brick(plant="dac8", setup="dac8")
@pytest.mark.parametrize("sign", ["+", "*"])
def test_that_fails(brick_controller, sign):
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
