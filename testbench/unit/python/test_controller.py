"""brick.Controller (docs/python.md): what it does to the controller, and that it does it twice alike."""

import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time

import brick
import numpy
import pytest

PATIENCE = 60


@pytest.fixture(scope="module")
def moving():
    with brick.Controller(plant="dac8", setup="dac8") as controller:
        yield controller


def test_variables_are_items(moving):
    moving["P1"] = 12
    moving["q2"] = -0.125
    assert (moving["P1"], moving["Q2"]) == (12, -0.125)
    assert moving["I130"] == 112450 and moving["I102"] == 0x78002  # examples/setups/dac8.pmc
    for wrong in ("frob", "P1=3", "#1J+", "P1 P2"):
        with pytest.raises(ValueError, match="no variable"):
            moving[wrong]


@pytest.mark.parametrize(("i9", "shown"), [(0, "491522"), (1, "I102=491522"), (2, "$78002"), (3, "I102=$78002")])
def test_a_variable_is_a_number_in_each_form_of_i9(moving, i9, shown):
    moving["I9"] = i9
    try:
        assert moving.command("I102") == shown
        assert (moving["I102"], moving["i130"], moving["I9"]) == (0x78002, 112450, i9)
        moving["P1"], moving["M70"] = -0.5, 3
        assert (moving["P1"], moving["M70"]) == (-0.5, 3)
    finally:
        moving["I9"] = 2


def test_a_variable_keeps_its_digits(moving):
    sent = moving.calls
    for value, digits in ((1e-13, "0.0000000000001"), (0.1 + 0.2, "0.30000000000000004"), (True, "1"), (-3, "-3"),
                          (2.5e9, "2500000000"), (numpy.float64(-0.5), "-0.5"), (numpy.int32(7), "7")):
        moving["P3"] = value
        assert sent[-1][1]["line"] == f"P3={digits}"
    moving["P3"] = 1e-13
    moving.command("P4=P3*1000000*1000000*10")
    assert moving["P4"] == pytest.approx(1)
    for wrong in (float("nan"), float("inf"), -float("inf")):
        with pytest.raises(ValueError, match="expected a finite one"):
            moving["P3"] = wrong
    with pytest.raises(ValueError, match="JSON"):
        moving.set_load(1, float("nan"))


def test_an_error_is_an_exception_with_its_number(moving):
    with pytest.raises(brick.CommandRefused) as refused:
        moving.command("P1 frob")
    assert (refused.value.number, refused.value.line) == (3, "P1 frob")
    with pytest.raises(ValueError, match="no signal"):
        moving.signal("frob")


def test_a_jog_arrives_and_its_record_shows_it(moving):
    moving.command("#2J/")
    moving.run(ms=50)
    with moving.record("motor2.commanded motor2.velocity host.breq") as record:
        moving.command("#2J:2000")
        moving.wait_in_position(2)
    assert abs(moving.position(2) - 2000) < 10  # I228: in position within 10 counts
    assert record.names == ["time_ms", "motor2.commanded", "motor2.velocity", "host.breq"]
    assert record["motor2.commanded"][-1] == 2000
    table, frame = record.array(), record.frame()
    assert table.shape == (len(record), 4) and frame.shape == (len(record), 3)
    # I222: 32 counts/ms at most, I219: 1 count/ms^2, so 2000 counts need no more than sqrt(2000) of speed
    assert 30 < numpy.max(table[:, 2]) <= 32.1 and frame["motor2.velocity"].max() == table[:, 2].max()
    servo = numpy.diff(table[:, 0])
    assert numpy.allclose(servo, 1e3 / 2258.65, rtol=1e-3)  # default clocks


@pytest.fixture
def full(tmp_path):
    """A record that is opened and has no room."""
    (tmp_path / "full.csv").symlink_to("/dev/full")
    return str(tmp_path / "full.csv")


def test_a_record_that_failed_is_not_in_the_way_of_the_next(moving, full):
    with pytest.raises(ValueError, match="cannot be written"), moving.record(file=full):
        moving.run(ms=1)
    with moving.record("host.breq") as record:
        moving.run(ms=1)
    assert len(record) in (2, 3)  # 2258.65 servo interrupts a second


def test_a_record_that_was_cut_off_as_it_began_is_not_in_the_way_of_the_next(alarm):
    with brick.Controller(check=False) as c:
        def ring(number, frame):
            os.kill(c.pid, signal.SIGCONT)
            raise Alarm

        signal.signal(signal.SIGALRM, ring)
        os.kill(c.pid, signal.SIGSTOP)
        alarm(0.05)
        with pytest.raises(Alarm), c.record("host.breq"):
            pass
        with c.record("host.breq"):
            c.run(ms=1)


def test_what_the_body_of_a_record_raises_comes_out(moving, full):
    with pytest.raises(KeyError, match="mine") as raised, moving.record(file=full):
        moving.run(ms=1)
        raise KeyError("mine")
    assert any("cannot be written" in note for note in raised.value.__notes__)
    with pytest.raises(KeyError, match="mine") as raised, brick.Controller() as c, c.record():
        os.kill(c.pid, signal.SIGKILL)
        raise KeyError("mine")
    assert any("exit status -9" in note for note in raised.value.__notes__)


def test_faults_of_the_plant_reach_the_motor(moving):
    moving.command("#3J+")
    moving.run(ms=50)
    moving.open_limit(3, "+")
    moving.run(ms=100)
    assert moving.status(3).on_limit and moving.status(3).at_rest
    moving.open_limit(3, "+", False)
    moving.command("#3J-")
    moving.run(ms=50)
    assert not moving.status(3).on_limit
    moving.trip_amplifier(3, "over-temperature")
    moving.run(ms=20)
    assert moving.status(3).amplifier_fault and not moving.status(3).enabled
    with pytest.raises(brick.MotorOff):
        moving.wait_in_position(3)
    moving.command("#4J+")
    moving.run(ms=100)
    moving.lose_encoder(4)
    moving.run(ms=200)
    assert moving.status(4).following_error and not moving.status(4).enabled
    moving.lose_encoder(4, [])


def test_a_pin_of_the_plant_is_held_and_given_back(moving):
    assert moving.signal("servo_ic0.ch1.fault") == 0
    moving.set_pin("servo_ic0.ch1.fault", 1)
    moving.run(us=1)
    assert moving.signal("servo_ic0.ch1.fault") == 1
    moving.set_pin("servo_ic0.ch1.fault", None)
    moving.run(us=1)
    assert moving.signal("servo_ic0.ch1.fault") == 0


def test_waits_have_a_simulated_and_a_wall_limit(moving):
    moving["P1"] = 12
    begin = moving.time_ns
    with pytest.raises(brick.SimulatedTimeout):
        moving.wait_signal("host.breq", 1, ms=3)
    assert abs(moving.time_ns - begin - 3_000_000) < 200
    with pytest.raises(brick.WallTimeout):
        moving.run(s=3600, wall_limit=0.2)
    assert moving["P1"] == 12  # it goes on
    moving.command("#5J/")
    moving.run(ms=50)
    moving.command("#5J+")
    with pytest.raises(brick.SimulatedTimeout):
        moving.wait_in_position(5, ms=30)
    moving.command("#5K")


def test_a_wait_for_motors_looks_at_all_of_them_and_has_one_limit_of_the_wall(moving):
    moving.command("#6J/")
    moving.command("#6J+")
    moving.run(ms=50)
    begin = time.monotonic()
    with pytest.raises(brick.MotorOff, match="motor 7"):
        moving.wait_in_position(6, 7, ms=100_000, wall_limit=PATIENCE)
    with pytest.raises(brick.WallTimeout):
        moving.wait_in_position(6, ms=1e6, wall_limit=0.3)
    assert time.monotonic() - begin < PATIENCE
    moving.command("#6K")


class Alarm(Exception):
    pass


@pytest.fixture
def alarm():
    def ring(number, frame):
        raise Alarm

    before = signal.signal(signal.SIGALRM, ring)
    yield lambda seconds: signal.setitimer(signal.ITIMER_REAL, seconds)
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


def test_an_exception_in_a_call_leaves_no_old_answer(moving, alarm):
    for n in range(5):
        moving["P1"] = n
        alarm(0.05)
        with pytest.raises(Alarm):
            moving.run(s=3600, wall_limit=0.2)
        assert moving["P1"] == n and moving.call("signal", name="host.breq")["name"] == "host.breq"


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


def test_a_text_that_came_with_a_refused_line_is_kept(moving):
    moving.script('OPEN PLC 3 CLEAR\nSEND"a text"\nDISABLE PLC 3\nCLOSE\nI5=2\nENABLE PLC 3\n')
    moving.run(ms=20)
    with pytest.raises(brick.CommandRefused):
        moving.command("frob")
    assert moving.texts() == ["a text"]


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


def test_a_request_that_was_sent_in_part_ends_the_channel(alarm):
    with brick.Controller(check=False) as c:
        os.kill(c.pid, signal.SIGSTOP)
        alarm(0.2)
        with pytest.raises(Alarm):
            c.script("; comment\n" * 90_000)
        os.kill(c.pid, signal.SIGCONT)
        with pytest.raises(brick.ControllerGone, match="transfer"):
            c.command("P1")


def test_nothing_is_asked_of_a_closed_controller():
    c = brick.Controller()
    c.close()
    c.close()
    with pytest.raises(brick.ControllerGone, match="closed"):
        c.command("P1")


def test_an_end_that_failed_is_an_error():
    c = brick.Controller(check=False)
    os.kill(c.pid, signal.SIGKILL)
    with pytest.raises(brick.ControllerGone, match="exit status -9"):
        c.close()
    c = brick.Controller()
    # It shall end by the signal and not by the end of the socket that close() makes behind this.
    c.failures = lambda: os.kill(c.pid, signal.SIGTERM) or time.sleep(1) or []
    with pytest.raises(brick.ControllerGone, match="SIGTERM"):
        c.close()


def test_ctrl_c_of_the_script_leaves_the_controller():
    text = ("import brick, os, time\nwith brick.Controller() as c:\n"
            "    try:\n        print(os.getpid(), flush=True)\n        time.sleep(60)\n"
            "    except KeyboardInterrupt:\n        time.sleep(0.3)\n        c['P1'] = 4\n        print(c['P1'])\n")
    script = subprocess.Popen([sys.executable, "-c", text], text=True, stdout=subprocess.PIPE, start_new_session=True)
    group = int(script.stdout.readline())
    os.killpg(group, signal.SIGINT)  # as a terminal does
    assert script.communicate(timeout=PATIENCE)[0] == "4\n" and script.returncode == 0


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


def test_a_port_of_a_controller_with_broken_rules_may_end_without_an_error(tmp_path, monkeypatch):
    fake = tmp_path / "brick"
    fake.write_text("#!/bin/sh\ntrap 'exit 1' TERM\necho listening on 127.0.0.1:9\nwhile :; do sleep 0.01; done\n")
    fake.chmod(0o755)
    monkeypatch.setenv("BRICK", str(fake))
    with brick.Served(check=False) as served:
        assert served.port == 9
    with pytest.raises(brick.ControllerGone, match="exit status 1"), brick.Served():
        pass


def test_a_port_may_be_closed_twice_and_leaves_what_the_body_raises():
    with pytest.raises(KeyError, match="mine") as raised, brick.Served() as served:
        os.kill(served.pid, signal.SIGKILL)
        gone(served.pid)
        raise KeyError("mine")
    assert any("exit status -9" in note for note in raised.value.__notes__)
    served.close()


def test_loss_of_five_volts_trips_and_shows():
    with brick.Controller(check=False) as c:
        c.lose_five_volts()
        c.run(ms=5)
        assert c.signal("host.wdo") == 1
        with pytest.raises(brick.NoAnswer, match="watchdog"):
            c.command("P1")


def session(wave):
    """Everything that is answered, and when."""
    with brick.Controller(plant="dac8", setup="dac8", seed=4711) as c:
        told = [c.tick]
        c.start_wave(str(wave))
        c.command("#1J/")
        c.run(ms=20)
        for line in ("#1J:500", "P1=1.5", "P1", "#1P", "frob", "I7000..7003"):
            try:
                told.append(c.command(line))
            except brick.CommandRefused as error:
                told.append(str(error))
            told.append(c.tick)
        c.wait_in_position(1)
        c.stop_wave()
        return [*told, c.tick, c.position(1)]


def test_the_same_script_and_seed_give_the_same_bytes_at_the_same_instants(tmp_path):
    first, second = tmp_path / "1.vcd", tmp_path / "2.vcd"
    answers = session(first)
    time.sleep(0.1)
    assert session(second) == answers
    assert first.read_bytes() == second.read_bytes() and first.stat().st_size > 10_000


def test_time_follows_the_wall_when_asked_to():
    with brick.Controller(realtime=True) as c:
        begin, wall = c.time, time.monotonic()
        time.sleep(0.2)
        c.run()
        waited = time.monotonic() - wall
        assert 0 < c.time - begin < waited + 0.5  # a loaded machine may be behind, never ahead by more than its lead


def test_a_start_that_fails_says_why():
    with pytest.raises(brick.ControllerGone, match="no such board"):
        brick.Controller(board="frob")
    with pytest.raises(brick.ControllerGone, match="no such plant"):
        brick.Controller(plant="frob")


def gone(pid):
    limit = time.monotonic() + PATIENCE
    while time.monotonic() < limit:
        try:
            if pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z":
                return True
        except FileNotFoundError:
            return True
        time.sleep(0.01)
    return False


def test_a_killed_controller_is_an_error_and_no_orphan():
    with pytest.raises(brick.ControllerGone), brick.Controller(check=False) as c:
        os.kill(c.pid, signal.SIGKILL)
        c.run(ms=1)
    assert gone(c.pid)


@pytest.mark.parametrize("work", ["time.sleep(600)", "c.run(s=3600, wall_limit=600)"])
def test_a_killed_script_leaves_no_orphan(work):
    text = ("import brick, os, time\nc = brick.Controller()\n"
            "if os.fork() == 0: os.close(1); os.read(0, 1); os._exit(0)\n"
            f"print(c.pid, flush=True)\n{work}\n")
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    script = subprocess.Popen([sys.executable, "-c", text], text=True, **pipes)
    pid = int(script.stdout.readline())
    script.kill()
    assert gone(pid)  # although a fork of the script still has the socket
    script.communicate()


def test_a_replay_does_the_same_with_a_waveform(tmp_path):
    with brick.Controller(plant="dac8", setup="dac8", seed=5) as c:
        c.command("#1J:100")
        with pytest.raises(brick.CommandRefused):
            c.command("frob")
        c.run(ms=5)
        c.replay(str(tmp_path / "replay.vcd"))
    assert (tmp_path / "replay.vcd").stat().st_size > 10_000


def test_a_replay_that_goes_another_way_says_so(tmp_path):
    wave, included = tmp_path / "replay.vcd", tmp_path / "included.pmc"
    with brick.Controller() as c:
        included.write_text("P1=3\n")
        c.load(str(included))
        with pytest.raises(ValueError, match="no signal"):
            c.signal("frob")
        c.replay(str(wave))
        included.unlink()
        c.run(ms=1)
        with pytest.raises(brick.BrickError, match=r"call 1 \(script\) ended with ValueError: .*; expected a result"):
            c.replay(str(wave))
        with pytest.raises(ValueError, match="cannot be read"):
            c.load(str(included))
        included.write_text("P1=3\n")
        with pytest.raises(brick.BrickError, match=r"call 4 \(script\) ended with a result; expected ValueError: "):
            c.replay(str(wave))
    assert wave.stat().st_size > 1000


@pytest.mark.parametrize(("options", "file"), [(["--profile", "profile"], "profile"),
                                               (["--record=r.csv", "--record-of=host.breq"], "r.csv")])
def test_a_replay_leaves_the_files_of_the_first_run(tmp_path, monkeypatch, options, file):
    monkeypatch.chdir(tmp_path)
    with brick.Controller(options=options) as c:
        c.run(ms=1)
    pathlib.Path(file).write_text("mine")
    c.replay("replay.vcd")
    assert pathlib.Path(file).read_text() == "mine" and pathlib.Path("replay.vcd").stat().st_size > 1000


def test_names_of_files_count_from_where_the_caller_stands(tmp_path, monkeypatch):
    first, then = tmp_path / "first", tmp_path / "then"
    for folder in (first, then):
        folder.mkdir()
        (folder / "line.pmc").write_text(f"P1={len(folder.name)}\n")
    shutil.copy(pathlib.Path(__file__).resolve().parents[3] / "boards/geobrick-lv-4.toml", first / "board.toml")
    monkeypatch.chdir(first)
    with brick.Controller(board="board.toml", options=["--load=line.pmc", "--profile=profile"]) as c:
        assert c["P1"] == len("first")
        with c.record("host.breq", file="record.csv") as record:
            monkeypatch.chdir(then)
            c.run(ms=1)
        assert len(record) in (2, 3) and (first / "record.csv").exists()
        c.start_wave(pathlib.Path("wave.vcd"))
        c.stop_wave()
        for again in (lambda: c.load("line.pmc"), lambda: c.script('#include "line.pmc"\n')):
            c["P1"] = 0
            again()
            assert c["P1"] == len("then")
        c.replay("replay.vcd")
        monkeypatch.chdir(first)
        c.script('#include "line.pmc"\n')
        assert c["P1"] == len("first")
    assert {file.name for file in then.iterdir()} == {"line.pmc", "wave.vcd", "replay.vcd"}
    assert {file.name for file in first.iterdir()} == {"line.pmc", "board.toml", "record.csv", "profile"}


def test_a_replay_ends_where_a_call_was_cut_off(tmp_path):
    with brick.Controller(realtime=True, options=["--wave", str(tmp_path / "own.vcd")]) as c:
        c["P1"] = 3
        with pytest.raises(brick.WallTimeout):
            c.run(s=3600, wall_limit=0.2)
        c["P1"] = 4
        own = (tmp_path / "own.vcd").stat().st_ino
        with pytest.raises(brick.WallTimeout, match=r"call 2 \(run\) was cut off: .*replay.vcd ends before"):
            c.replay(str(tmp_path / "replay.vcd"))
        assert (tmp_path / "own.vcd").stat().st_ino == own
    assert (tmp_path / "replay.vcd").stat().st_size > 1000


def test_a_replay_has_the_flash_of_the_start_and_leaves_the_file(tmp_path):
    flash, wave = tmp_path / "flash", tmp_path / "wave.vcd"
    for option in (["--flash", str(flash)], [f"--flash={flash}"]):
        c = brick.Controller(options=option)
        c.command(f"I5={len(option)}")
        c.command("SAVE")
        c.close()
        saved = flash.read_bytes()
        flash.write_bytes(b"")  # a replay that reads or writes this one shows
        c.replay(str(wave))
        assert flash.read_bytes() == b"" and wave.stat().st_size > 1000
        flash.write_bytes(saved)
