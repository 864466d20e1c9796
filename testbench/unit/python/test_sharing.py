"""One controller between threads, signal handlers and forks (docs/python.md)."""

import os
import signal
import socket
import subprocess
import sys
import threading
import time

import brick
import pytest
from support import PATIENCE, Alarm, gone


def test_an_exception_in_a_call_leaves_no_old_answer(moving, alarm):
    for n in range(5):
        moving["P1"] = n
        alarm(0.05)
        with pytest.raises(Alarm):
            moving.run(s=3600, wall_limit=0.2)
        assert moving["P1"] == n and moving.call("signal", name="host.breq")["name"] == "host.breq"


def test_a_request_that_was_sent_in_part_ends_the_channel(alarm):
    with brick.Controller(check=False) as c:
        os.kill(c.pid, signal.SIGSTOP)
        alarm(0.2)
        with pytest.raises(Alarm):
            c.script("; comment\n" * 90_000)
        os.kill(c.pid, signal.SIGCONT)
        with pytest.raises(brick.ControllerGone, match="transfer"):
            c.command("P1")


def test_a_call_within_a_call_is_an_error(moving, monkeypatch):
    told = []

    def ring(number, frame):
        try:
            moving.command("P1")
        except brick.BrickError as error:
            told.append(str(error))

    before = signal.signal(signal.SIGALRM, ring)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        with pytest.raises(brick.WallTimeout):
            moving.run(s=3600, wall_limit=0.2)
    finally:
        signal.signal(signal.SIGALRM, before)
    assert told == ["command: a call within a call, as of a signal handler; expected it behind that"]
    assert moving.command("P1") == moving.command("P1")


def together(*works):
    """What each of them gave, or raised, in threads of their own."""
    results = [None] * len(works)

    def work(n):
        try:
            results[n] = works[n]()
        except Exception as error:
            results[n] = error

    threads = [threading.Thread(target=work, args=[n], daemon=True) for n in range(len(works))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE)
    return results


def test_each_thread_has_its_own_answers(moving, monkeypatch):
    monkeypatch.setattr("brick.channel.START_LIMIT", 1)  # an answer that another thread has taken does not come
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    try:
        moving["P11"], moving["P12"], moving["P13"] = 11, 12, 13
        asked = [lambda n=n: [moving.command(f"P{n}", wall_limit=PATIENCE) for _ in range(200)] for n in (11, 12, 13)]
        assert together(*asked) == [["11"] * 200, ["12"] * 200, ["13"] * 200]
    finally:
        sys.setswitchinterval(before)


def test_a_call_waits_for_that_of_another_thread_up_to_its_limit():
    with brick.Controller(check=False) as c:
        os.kill(c.pid, signal.SIGSTOP)
        first = threading.Thread(target=lambda: c.command("P1"))
        first.start()
        while len(c.calls) < 2:  # hello, P1
            time.sleep(0)
        with pytest.raises(brick.WallTimeout, match="another thread"):
            c.command("P2", wall_limit=0.01)
        os.kill(c.pid, signal.SIGCONT)
        first.join(PATIENCE)
        assert [params["line"] for method, params in c.calls if method == "command"] == ["P1"]


def test_close_ends_the_call_of_another_thread():
    c = brick.Controller(check=False)

    def end():
        while len(c.calls) < 2:
            time.sleep(0)
        c.abandon()

    called, _ = together(lambda: c.run(s=3600), end)
    assert isinstance(called, brick.ControllerGone)
    assert gone(c.pid)


def in_a_fork(work):
    """The texts that work() gives, in a fork that ends without a look behind."""
    mine, its = os.pipe()
    if (pid := os.fork()) == 0:
        try:
            os.write(its, "\n".join(work()).encode())
        finally:
            os._exit(0)
    os.close(its)
    with open(mine) as said:
        text = said.read()
    os.waitpid(pid, 0)
    return text.split("\n")


def test_a_fork_is_told_that_the_controller_is_not_its_own():
    with brick.Controller() as c, brick.Served() as served, c.record("host.breq") as record:
        c["P1"] = 5

        def work():
            for use in (lambda: c.command("P1"), c.texts, lambda: record.__exit__(None, None, None)):
                try:
                    use()
                    yield "no error"
                except brick.BrickError as error:
                    yield str(error).partition(": ")[2]
            for end in (served.close, c.abandon, c.close):
                yield str(end())

        *uses, served_end, abandoned, closed = in_a_fork(work)
        assert all(f"is a fork of {os.getpid()}, which has the controller" in use for use in uses) and len(uses) == 3
        assert [served_end, abandoned, closed] == ["None"] * 3
        with socket.create_connection(("127.0.0.1", served.port), PATIENCE):
            pass
        c.run(ms=1)
        assert c["P1"] == 5
    assert len(record) in (2, 3)


def test_a_fork_that_leaves_the_block_ends_nothing_and_an_end_waits_for_no_fork():
    text = ("import brick, os, sys\nread, write = os.pipe()\n"
            "with brick.Controller() as c, brick.Served() as s:\n"
            "    for status in ('sys.exit(3)', '0'):\n"
            "        if (pid := os.fork()) == 0:\n            exec(status)\n            break\n"
            "        print(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), flush=True)\n"
            "        c['P1'] = 4\n"
            "    else:\n"
            "        if (pid := os.fork()) == 0: os.close(write); os.read(read, 1); os._exit(0)\n"
            "        c.close(); print(c.pid == s.pid, flush=True)\n")
    done = subprocess.run([sys.executable, "-c", text], text=True, capture_output=True, timeout=PATIENCE)
    assert (done.stdout, done.returncode) == ("3\n0\nFalse\n", 0), done.stderr
    assert "Error" not in done.stderr
