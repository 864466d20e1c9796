"""brick.Controller (docs/python.md): what it does to the controller, and that it does it twice alike."""

import contextlib
import os
import pathlib
import signal
import subprocess
import sys
import time

import brick
import numpy
import pytest
from support import PATIENCE, gone

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "app"))
import faulty_image


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


def test_a_text_that_came_with_a_refused_line_is_kept(moving):
    moving.script('OPEN PLC 3 CLEAR\nSEND"a text"\nDISABLE PLC 3\nCLOSE\nI5=2\nENABLE PLC 3\n')
    moving.run(ms=20)
    with pytest.raises(brick.CommandRefused):
        moving.command("frob")
    assert moving.texts() == ["a text"]


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


def test_an_exception_of_the_cpu_breaks_a_rule(tmp_path):
    image = faulty_image.with_words(tmp_path, "card", faulty_image.STORE)
    c = brick.Controller(options=["--firmware", image])
    assert c.failures() == []
    with contextlib.suppress(brick.NoAnswer):
        c.command("CID")
    c.run(ms=20)
    with pytest.raises(brick.RulesBroken, match=r"^exception of the CPU: store access fault at 0x0+, pc .* \(card\)"):
        c.close()


def test_ctrl_c_of_the_script_leaves_the_controller():
    text = ("import brick, os, time\nwith brick.Controller() as c:\n"
            "    try:\n        print(os.getpid(), flush=True)\n        time.sleep(60)\n"
            "    except KeyboardInterrupt:\n        time.sleep(0.3)\n        c['P1'] = 4\n        print(c['P1'])\n")
    script = subprocess.Popen([sys.executable, "-c", text], text=True, stdout=subprocess.PIPE, start_new_session=True)
    group = int(script.stdout.readline())
    os.killpg(group, signal.SIGINT)  # as a terminal does
    assert script.communicate(timeout=PATIENCE)[0] == "4\n" and script.returncode == 0


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
