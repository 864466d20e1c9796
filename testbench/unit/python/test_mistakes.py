"""What is wrong with a call, and what has gone, is said in an exception of docs/python.md."""

import os
import resource
import signal
import sys

import brick
import numpy
import pytest
from support import PATIENCE, Alarm, gone

BAD = {  # arguments that a call cannot take, and what its message says of them
    "command": [((5,), "expected a text"), ((b"P1",), "no text"), (("P1\nP2",), "one line"), (("P1\rP2",), "one line"),
                (("P1\0",), "without NUL"), (("\ud800",), "surrogates"), (("P1 \u00e9",), "ASCII"),
                (("P" * 1001,), "up to 1000 characters")],
    "script": [((None,), "expected a text"), ((";" * (1 << 20),), "more than 1048576 bytes")],
    "load": [(("frob.pmc",), "cannot be read"), (('a"b',), "quotation marks"), (("a\nb",), "line ends"),
             ((5,), "name of a file"), (("a\0",), "name of a file"), ((b"a",), "name of a file")],
    "call": [(("frob",), "no method")],
    "run": [({"ms": float("inf")}, "ms=inf: expected a finite"),
            ({"us": float("nan")}, "finite"), ({"s": "1"}, "finite"),
            ({"ms": -1}, "integer, 0 to"), ({"s": 3601}, "integer, 0 to")],
    "__getitem__": [((5,), "no variable"), (("P\uff11",), "no variable")],
    "__setitem__": [(("P1", "3"), "no number"), (("P1", None), "no number"), (("P1", 1j), "no number"),
                    (("P1", [1]), "no number")],
    "position": [((0,), "expected 1 to 32"), ((33,), "1 to 32"), (("1",), "1 to 32"), ((1.5,), "1 to 32")],
    "status": [((0,), "expected 1 to 32"), ((33,), "1 to 32"), ((None,), "1 to 32")],
    "channel": [((0,), "expected 1 to 32")],
    "wait_in_position": [((0,), "expected 1 to 32"), (({1},), "1 to 32")],
    "wait_signal": [(({"name": "host.breq", "value": 1, "ms": float("nan")}), "finite"),
                    (({"name": "host.breq", "value": None, "ms": 1}), "no value of host.breq")],
    "signal": [(("frob",), "no signal"), ((5,), "expected a text")],
    "signals": [((5,), "expected a text")],
    "set_pin": [(("frob", 1), "no signal"), (("servo_ic0.ch1.fault", 2), "0 to 1"), ((["x"], 1), "expected a text")],
    "open_limit": [((1, "x"), "expected [+] or -"), ((1, []), "expected [+] or -"), ((0, "+"), "1 to 32")],
    "trip_amplifier": [((1, "frob"), "no cause"), ((99, "i2t"), "1 to 80")],
    "lose_encoder": [((1, ["x"]), "no input pin"), ((1, 5), "list of texts"), ((1, "enc_a"), "list of texts"),
                     ((1, [b"enc_a"]), "list of texts")],
    "set_load": [((1, "x"), "expected a number"), ((1, object()), "no number"), ((1, float("nan")), "JSON")],
    "start_wave": [(("frob.txt",), "FILE.vcd"), (({},), "name of a file")],
    "replay": [((5,), "name of a file")],
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_argument_is_a_value_error_that_says_what_was_expected(moving, name):
    for given, message in BAD[name]:
        keywords = given if isinstance(given, dict) else {}
        with pytest.raises(ValueError, match=message):
            getattr(moving, name)(*(() if keywords else given), **keywords)


@pytest.mark.parametrize("limit", [-1, float("nan"), float("inf"), 1e7, "1", [1]])
def test_a_limit_of_the_wall_is_a_number_of_seconds(moving, limit):
    for use in (lambda: moving.run(wall_limit=limit), lambda: moving.wait_in_position(wall_limit=limit),
                lambda: brick.Controller(wall_limit=limit)):
        with pytest.raises(ValueError, match=r"wall_limit=.*: expected seconds, 0 to 1000000"):
            use()


def test_numbers_of_other_libraries_are_numbers(moving):
    moving.run(ms=numpy.int64(1))
    moving.set_pin("servo_ic0.ch1.fault", numpy.int32(0))
    moving.set_pin("servo_ic0.ch1.fault", None)
    moving.set_load(numpy.int64(1), numpy.float32(0))


@pytest.mark.parametrize("end", ["closed", "killed"])
def test_each_call_of_a_controller_that_has_gone_says_so(end):
    c = brick.Controller()
    c.close() if end == "closed" else os.kill(c.pid, signal.SIGKILL)
    assert gone(c.pid)
    uses = (lambda: c.command("P1"), lambda: c["P1"], lambda: c.__setitem__("P1", 1), lambda: c.script(""), c.texts,
            lambda: c.run(ms=1), lambda: c.position(1), lambda: c.status(1), lambda: c.wait_in_position(1),
            lambda: c.signal("host.breq"), c.signals, lambda: c.wait_signal("host.breq", 1, ms=1),
            lambda: c.set_pin("host.breq", 1), lambda: c.trip_amplifier(1), lambda: c.lose_encoder(1),
            lambda: c.set_load(1, 0), c.lose_five_volts, lambda: c.start_wave("x.vcd"), c.stop_wave, c.failures,
            lambda: c.record().__enter__(), lambda: c.call("hello", protocol="1.0"))
    for use in uses:
        with pytest.raises(brick.ControllerGone, match=r"closed|exit status -9"):
            use()


def test_a_command_that_cannot_be_started_is_an_error(tmp_path, monkeypatch):
    (tmp_path / "brick").write_text("no program")
    for place in (tmp_path / "none", tmp_path / "brick", tmp_path):
        monkeypatch.setenv("BRICK", str(place))
        for start in (brick.Controller, brick.Served):
            with pytest.raises(brick.ControllerGone, match=r"cannot be started: .*; expected the command brick"):
                start()
    for start in (brick.Controller, brick.Served):
        for wrong in (["a\0"], "--realtime", [5], 5):
            with pytest.raises(ValueError, match="expected"):
                start(options=wrong)


@pytest.mark.parametrize("answer", [b"frob", b"[]", b"{}", b'{"id": 1}', b'{"id": 1, "result": 5}', b"\xff",
                                    b'{"id": 1, "error": {}}'])
def test_an_answer_that_is_none_is_an_error(tmp_path, monkeypatch, answer):
    fake = tmp_path / "brick"
    line = answer + b"\n"
    fake.write_text(f"#!{sys.executable} -SE\nimport os, sys\nos.write(int(sys.argv[2][3:]), {line!r})\n")
    fake.chmod(0o755)
    monkeypatch.setenv("BRICK", str(fake))
    with pytest.raises(brick.BrickError, match=r"expected an object of JSON-RPC 2.0"):
        brick.Controller()


def test_a_command_of_another_version_is_an_error(tmp_path, monkeypatch):
    fake = tmp_path / "brick"
    line = b'{"id": 1, "error": {"code": -32602, "message": "protocol 1.0 is not spoken here"}}\n'
    fake.write_text(f"#!{sys.executable} -SE\nimport os, sys\nos.write(int(sys.argv[2][3:]), {line!r})\n")
    fake.chmod(0o755)
    monkeypatch.setenv("BRICK", str(fake))
    with pytest.raises(brick.ControllerGone, match="not spoken here: the command is of another version"):
        brick.Controller()


@pytest.mark.parametrize("answer", ["frob", "", "1 2 3", "$x y"])
def test_an_answer_that_is_no_number_is_an_error(moving, monkeypatch, answer):
    monkeypatch.setattr(moving, "command", lambda *_: answer)
    for use in (lambda: moving["P1"], lambda: moving.position(1), lambda: moving.status(1)):
        with pytest.raises(brick.NoAnswer, match="expected"):
            use()


def test_no_room_for_files_is_an_error(moving, monkeypatch, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "none"))
    for start in (brick.Controller, brick.Served):
        with pytest.raises(brick.ControllerGone, match="cannot be started"):
            start()
    with pytest.raises(brick.BrickError, match="expected room"):
        moving.replay("replay.vcd")
    with pytest.raises(brick.BrickError, match="expected room"), moving.record():
        pass


def test_a_port_of_a_process_with_many_open_files():
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (2048, hard))
    files = [os.dup(0) for _ in range(1100)]
    try:
        with brick.Served() as served:
            assert served.port > 0
    finally:
        for file in files:
            os.close(file)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def test_a_command_that_does_not_listen_is_ended(tmp_path, monkeypatch, alarm):
    fake = tmp_path / "brick"
    fake.write_text(f"#!/bin/sh\necho $$ > {tmp_path}/pid\nexec sleep 60\n")
    fake.chmod(0o755)
    monkeypatch.setenv("BRICK", str(fake))
    monkeypatch.setattr("brick.served.START_LIMIT", 0.3)
    with pytest.raises(brick.WallTimeout):
        brick.Served()
    assert gone(int((tmp_path / "pid").read_text()))
    monkeypatch.setattr("brick.served.START_LIMIT", PATIENCE)
    alarm(0.3)
    with pytest.raises(Alarm):
        brick.Served()
    assert gone(int((tmp_path / "pid").read_text()))


def test_a_start_that_fails_says_why():
    with pytest.raises(brick.ControllerGone, match="no such board"):
        brick.Controller(board="frob")
    with pytest.raises(brick.ControllerGone, match="no such plant"):
        brick.Controller(plant="frob")
