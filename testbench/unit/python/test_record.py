"""brick.Record: what it holds, and that it ends (docs/python.md)."""

import os
import shutil
import signal

import brick
import numpy
import pytest
from support import Alarm


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


def test_a_record_says_what_it_has_not(moving):
    record = moving.record("host.breq")
    for use in (lambda: record["time_ms"], record.array, record.frame):
        with pytest.raises(brick.BrickError, match="no columns yet"):
            use()
    for wrong in (moving.record("frob"), moving.record(file="frob.txt"), moving.record(5)):
        with pytest.raises(ValueError, match="expected"), wrong:
            pass
    with record:
        pass
    assert record.array().shape == (0, 2) and len(record.frame()) == 0 and record["host.breq"] == []
    with pytest.raises(ValueError, match=r"no such column; expected one of time_ms, host.breq"):
        record["frob"]
    with pytest.raises(brick.BrickError, match="No such file"), record:
        shutil.rmtree(record.file.parent)


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
