"""`brick control` as a program without the package meets it (docs/control.md): requests, mistakes, ends."""

import contextlib
import json
import os
import pathlib
import signal
import socket
import stat
import subprocess
import sys
import time

import pytest

BRICK = os.environ["BRICK"]
PATIENCE = 60  # seconds of the wall, on a loaded machine


class Client:
    """Lines to a controller without motors, over a socket pair."""

    def __init__(self, *options):
        self.socket, theirs = socket.socketpair()
        with theirs:
            self.process = subprocess.Popen([BRICK, "control", f"fd:{theirs.fileno()}", *options],
                                            pass_fds=[theirs.fileno()], stderr=subprocess.PIPE, text=True)
        self.socket.settimeout(PATIENCE)
        self.file = self.socket.makefile("rb")

    def send(self, line):
        self.socket.sendall(line if isinstance(line, bytes) else json.dumps(line).encode() + b"\n")

    def receive(self):
        return json.loads(self.file.readline())

    def call(self, method, **params):
        self.send({"jsonrpc": "2.0", "id": method, "method": method, "params": params})
        answer = self.receive()
        assert answer["id"] == method
        return answer

    def hang_up(self):
        self.file.close()
        self.socket.close()

    def end(self):
        said = self.process.communicate(timeout=PATIENCE)[1]
        return self.process.returncode, said


@contextlib.contextmanager
def control(*options):
    client = Client(*options)
    try:
        yield client
    finally:
        client.hang_up()
        client.process.kill()
        client.process.communicate()


@pytest.fixture(scope="module")
def shared():
    with control("--plant", "dac8") as client:
        yield client


def gone(pid):
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, 0)
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    return True


def wait_gone(pid):
    limit = time.monotonic() + PATIENCE
    while not gone(pid):
        assert time.monotonic() < limit, "it runs on"
        time.sleep(0.01)


def test_requests_are_answered_in_order_and_notifications_not(shared):
    shared.send(b'{"jsonrpc": "2.0", "method": "command", "params": {"line": "P7=8"}}\n'
                b'{"jsonrpc": "2.0", "id": 1, "method": "command", "params": {"line": "P7"}}\n'
                b'{"jsonrpc": "2.0", "id": "two", "method": "command", "params": {"line": "P9"}}\n')
    first, second = shared.receive(), shared.receive()
    assert (first["id"], first["result"]["lines"]) == (1, ["8"])
    assert (second["id"], second["result"]["lines"]) == ("two", ["0"])
    assert second["result"]["tick"] > first["result"]["tick"]


def test_time_passes_as_asked_and_stands_between_calls(shared):
    before = shared.call("run", ns=0)["result"]
    time.sleep(0.05)
    assert shared.call("run", ns=0)["result"]["tick"] == before["tick"]
    after = shared.call("run", ns=10_000_000)["result"]
    assert after["tick"] - before["tick"] == 1_179_648  # 10 ms of 117.9648 MHz
    assert 9_999_999 <= after["ns"] - before["ns"] <= 10_000_001


HOSTILE = [
    (b"\n", -32700), (b"null\n", -32600), (b"[]\n", -32600), (b'"a"\n', -32600), (b"\xff\xfe\n", -32700),
    (b'[{"jsonrpc": "2.0", "id": 1, "method": "run", "params": {"ns": 0}}]\n', -32600),
    (b'{"id": 1, "method": "run"}\n', -32600), (b'{"jsonrpc": "1.0", "id": 1, "method": "run"}\n', -32600),
    (b'{"jsonrpc": "2.0", "id": {}, "method": "run"}\n', -32600),
    (b'{"jsonrpc": "2.0", "id": 1, "method": ["run"]}\n', -32600),
    (b'{"jsonrpc": "2.0", "id": 1, "method": ""}\n', -32601),
    (b'{"jsonrpc": "2.0", "id": 1, "method": "end"}\n', -32601),
    (b'{"jsonrpc": "2.0", "id": 1, "method": "run", "params": [1]}\n', -32602),
    (b'{"jsonrpc": "2.0", "id": 1, "method": "run", "params": {"ns": 1e400}}\n', -32700),
    (b"x" * 3_000_000 + b"\n", -32600), (b"[" * 1_000_000 + b"\n", -32600),
    (b'{"jsonrpc": "2.0", "id": 1, "method": "run", "params": ' + b'{"a":' * 150_000 + b"1" + b"}" * 150_001 + b"\n",
     -32600),
]


@pytest.mark.parametrize(("line", "code"), HOSTILE, ids=[line[:60].decode(errors="replace") for line, _ in HOSTILE])
def test_lines_that_are_no_request_get_an_error(shared, line, code):
    shared.send(line)
    error = shared.receive()["error"]
    assert error["code"] == code, error
    assert "expected" in error["message"] and len(error["message"]) < 500
    assert shared.call("command", line="P9")["result"]["lines"] == ["0"]


WRONG = [
    ("hello", {}), ("hello", {"protocol": "2.0"}), ("hello", {"protocol": 1}), ("command", {}),
    ("command", {"line": "P1\rP2"}), ("command", {"line": "P\u00e9"}), ("command", {"line": "a\0b"}),
    ("command", {"line": "1" * 1001}), ("command", {"line": ["P1"]}), ("command", {"line": "P1", "lines": 1}),
    ("run", {}), ("run", {"ns": -1}), ("run", {"ns": 0.5}), ("run", {"ns": 2**64}), ("run", {"ns": "1"}),
    ("run", {"ns": 0, "wall_s": -1}), ("run", {"ns": 0, "wall_s": "1"}), ("signal", {"name": "frob"}),
    ("signal", {"name": "\u001b[2J"}), ("until", {"name": "host.breq", "value": "7", "ns": 1}),
    ("until", {"name": "plant.axis1.position", "value": "1", "ns": 1}), ("input", {"name": "host.breq", "level": 1}),
    ("input", {"name": "host.mi1", "level": 2}), ("plant.trip", {"motor": 1, "cause": "rust"}),
    ("plant.trip", {"motor": 9, "cause": "i2t"}), ("plant.cut", {"motor": 1, "pins": ["enc_q"]}),
    ("plant.cut", {"motor": 1, "pins": "enc_a"}), ("plant.load", {"motor": 0, "torque": 1}),
    ("plant.load", {"motor": 1, "torque": 1e300}), ("wave.start", {"file": "/dev/null/no.vcd"}),
    ("wave.start", {"file": "wave.txt"}), ("wave.start", {"file": "w.vcd", "trace": "frob*"}),
    ("record.start", {"file": "/dev/null/no.csv"}), ("record.start", {"file": "r.csv", "of": "frob"}),
    ("script", {"text": "@frob"}), ("script", {"text": "@wait 1parsec"}),
    ("script", {"text": '#include "nowhere.pmc"'}),
]


@pytest.mark.parametrize(("method", "params"), WRONG, ids=[f"{m} {p}"[:60] for m, p in WRONG])
def test_wrong_parameters_get_an_error_and_change_nothing(shared, method, params):
    before = shared.call("run", ns=0)["result"]["tick"]
    error = shared.call(method, **params)["error"]
    assert error["code"] == -32602, error
    assert "expected" in error["message"] and "\x1b" not in error["message"]
    assert shared.call("run", ns=0)["result"]["tick"] == before


def test_a_refused_line_has_its_number(shared):
    error = shared.call("command", line="frob")["error"]
    assert (error["code"], error["data"]["number"], error["data"]["line"]) == (1, 3, "frob")


def test_the_echo_of_a_cleared_line_is_no_answer(shared):
    for line, lines in (("\x18", []), ("P1\x18P9", ["0"]), ("frob\x18", []), ("a\x18b\x18P9 P9", ["0", "0"])):
        assert shared.call("command", line=line)["result"]["lines"] == lines, line


def test_limits_of_simulated_and_of_wall_time(shared):
    begin = shared.call("run", ns=0)["result"]["tick"]
    error = shared.call("until", name="host.breq", value="1", ns=1_000_000)["error"]
    assert error["code"] == 3
    assert abs(error["data"]["tick"] - begin - 117_965) <= 16  # 1 ms
    shared.call("command", line="OPEN PLC1 CLEAR P1=P1+1 CLOSE")
    error = shared.call("run", ns=3_600_000_000_000, wall_s=0.1)["error"]
    assert error["code"] == 4
    assert shared.call("command", line="P9")["result"]["lines"] == ["0"]
    error = shared.call("command", line="P9", wall_s=0)  # too short for anything, or just long enough
    assert "result" in error or error["error"]["code"] == 4
    assert shared.call("command", line="P9")["result"]["lines"] == ["0"]


def test_a_limit_of_wall_time_leaves_no_bus_cycle_half_done():
    reads = "@dpram 0 8\n@dpram 0=1234\n" * 4000
    with control() as client:
        cut = [client.call("script", text=reads, wall_s=0.006 + n * 1e-4).get("error", {}).get("code")
               for n in range(50)]
        assert cut.count(4) > 40, cut
        assert client.call("check")["result"]["failures"] == []


@pytest.mark.parametrize("opened", ["OPEN PROG 7 CLEAR", "OPEN PLC 3 CLEAR"])
def test_a_line_that_was_cut_off_is_dropped_and_nothing_is_typed(opened):
    with control() as client:
        client.call("command", line=opened)
        line = "P1=" + "+".join(["1"] * 120)
        client.call("command", line=line)  # else there may be no program: a busy machine cuts all of the others
        cut = []
        while cut.count(4) < 3 and len(cut) < 1000:  # the wall is looked at now and then, and a line may end before
            limit = len(cut) % 20 * 1e-4
            cut.append(client.call("command", line=line, wall_s=limit).get("error", {}).get("code"))
        assert cut.count(4) == 3, cut
        client.call("command", line="CLOSE")
        name = opened.replace("OPEN", "LIST").replace(" CLEAR", "")
        listed = client.call("command", line=name)["result"]["lines"]
        whole = [one for one in listed if one.strip() not in ("RET", "RETURN", "")]
        assert set(whole) == {line}, listed
        assert client.call("texts")["result"]["texts"] == []
        assert client.call("command", line="I3 I4 I6")["result"]["lines"] == ["2", "0", "1"]


def test_a_script_prints_what_brick_exec_prints(shared):
    result = shared.call("script", text="P1=5\nP1\n@signal host.breq\n@dpram 0 1\nfrob\n")["result"]
    assert result["lines"][:2] == ["5", "host.breq=0"] and result["lines"][3].startswith("ERR003")
    assert result["refused"] == 1
    error = shared.call("script", text="P1\n@expect 6\n")["error"]
    assert error["code"] == 2 and error["data"]["lines"] == ["5"]


def test_a_waveform_without_room_is_an_error_of_its_own_and_the_machine_goes_on(tmp_path):
    for ending, start in (("vcd", "wave"), ("csv", "record")):
        file = tmp_path / f"f.{ending}"
        file.symlink_to("/dev/full")
        for stopped in (True, False):
            with control() as client:
                assert "result" in client.call(f"{start}.start", file=str(file))
                assert "result" in client.call("run", ns=100_000_000)
                if stopped:
                    error = client.call(f"{start}.stop")["error"]
                    assert error["code"] == -32602 and "No space left on device; expected" in error["message"], error
                    assert "result" in client.call(f"{start}.start", file=str(tmp_path / f"g.{ending}"))
                assert client.call("command", line="P9")["result"]["lines"] == ["0"]
                client.hang_up()
                status, said = client.end()
            assert status == (0 if stopped else 1) and said.count("the run goes on") == 1, said
            assert said.count("No space left on device") == (1 if stopped else 2), said


def test_the_end_of_the_client_ends_it_in_the_middle_of_a_call():
    with control() as client:
        client.call("hello", protocol="1.0")
        client.send({"jsonrpc": "2.0", "id": 1, "method": "run", "params": {"ns": 3_600_000_000_000}})
        client.hang_up()
        assert client.end() == (0, "")


def test_a_signal_ends_it_and_says_so():
    with control() as client:
        client.call("hello", protocol="1.0")
        client.process.send_signal(signal.SIGTERM)
        status, said = client.end()
        assert status == 1 and "stopped by SIGTERM" in said


def test_a_path_is_for_this_user_alone_and_for_the_first_who_speaks(tmp_path):
    place = tmp_path / "control"
    left_over = socket.socket(socket.AF_UNIX)
    left_over.bind(str(place))
    left_over.close()  # nobody listens there
    process = subprocess.Popen([BRICK, "control", place], stderr=subprocess.PIPE, text=True)
    limit = time.monotonic() + PATIENCE
    silent = socket.socket(socket.AF_UNIX)
    while silent.connect_ex(str(place)) != 0:
        assert time.monotonic() < limit
        time.sleep(0.01)
    assert stat.S_IMODE(place.stat().st_mode) == 0o600
    silent.close()
    other = subprocess.run([BRICK, "control", place], capture_output=True, text=True, timeout=PATIENCE)
    assert other.returncode == 2 and "expected a place for a new socket" in other.stderr
    with socket.socket(socket.AF_UNIX) as client, socket.socket(socket.AF_UNIX) as second:
        client.connect(str(place))
        client.settimeout(PATIENCE)
        client.sendall(b'{"jsonrpc": "2.0", "id": 1, "method": "hello", "params": {"protocol": "1.0"}}\n')
        client.shutdown(socket.SHUT_WR)  # requests that are there are answered
        assert json.loads(client.makefile().readline())["result"]["protocol"] == "1.0"
        assert not place.exists() and second.connect_ex(str(place)) != 0
    assert process.communicate(timeout=PATIENCE) == (None, "") and process.returncode == 0


def connected(place, limit):
    client = socket.socket(socket.AF_UNIX)
    client.settimeout(PATIENCE)
    while client.connect_ex(str(place)) != 0:
        assert time.monotonic() < limit
        time.sleep(0.01)
    return client


def test_who_says_nothing_keeps_nobody_out(tmp_path):
    place = tmp_path / "control"
    process = subprocess.Popen([BRICK, "control", place], stderr=subprocess.PIPE, text=True)
    limit = time.monotonic() + PATIENCE
    with contextlib.ExitStack() as stack:
        silent = [stack.enter_context(connected(place, limit)) for _ in range(17)]
        first = json.loads(silent.pop(0).makefile().readline())
        assert "too many clients that say nothing; expected a request" in first["error"]["message"]
        client = stack.enter_context(connected(place, limit))
        client.sendall(b'{"jsonrpc": "2.0", "id": 1, "method": "hello", "params": {"protocol": "1.0"}}\n')
        assert json.loads(client.makefile().readline())["result"]["protocol"] == "1.0"
        said = [one.makefile().read() for one in silent]  # to its end
        assert all(text.count("\n") == 1 for text in said), said
        errors = [json.loads(text) for text in said]
        assert all(one["id"] is None and one["error"]["code"] == -32600 for one in errors), errors
        assert sum("another client has the controller; expected" in one["error"]["message"] for one in errors) >= 15
    assert process.communicate(timeout=PATIENCE) == (None, "") and process.returncode == 0


@pytest.mark.parametrize("option", ["--gdb=0", "--json=results.json"])
def test_options_that_mean_nothing_here_are_refused(tmp_path, option):
    done = subprocess.run([BRICK, "control", "socket", option], cwd=tmp_path, capture_output=True, text=True,
                          timeout=PATIENCE)
    assert done.returncode == 2 and "not with brick control" in done.stderr and done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("place", ["fd:0", "fd:", "fd:99", "fd:x", "", "/dev/null/no", "x" * 200])
def test_a_bad_place_is_one_line(place):
    done = subprocess.run([BRICK, "control", place], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=PATIENCE)
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "expected" in done.stderr


@pytest.mark.parametrize("command", [["control", "{place}"], ["serve", "--listen", "127.0.0.1:0"]])
def test_it_ends_with_the_process_that_it_shall_end_with(tmp_path, command):
    child = [word.format(place=tmp_path / "s") for word in command]
    start = ("import os, subprocess, sys, time\n"
             f"p = subprocess.Popen([{BRICK!r}, *{child!r}, '--end-with', str(os.getpid())])\n"
             "print(p.pid, flush=True)\ntime.sleep(600)\n")
    parent = subprocess.Popen([sys.executable, "-c", start], stdout=subprocess.PIPE, text=True,
                              stderr=subprocess.DEVNULL)
    pid = int(parent.stdout.readline())
    assert not gone(pid)
    parent.kill()
    parent.communicate()
    wait_gone(pid)
