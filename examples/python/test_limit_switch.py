"""An end switch opens while the motor runs: it stops within its deceleration, and moves away again."""

import brick
import pytest


@pytest.mark.brick(plant="dac8", setup="dac8")
def test_motor_stops_at_a_limit(brick_controller: brick.Controller) -> None:
    c = brick_controller
    c.command("#1J+")
    c.run(ms=100)  # 32 counts/ms by now
    there = c.position(1)
    c.open_limit(1, "+")
    c.run(ms=100)
    status = c.status(1)
    assert status.on_limit and status.closed and status.at_rest
    # I115 = 1 count/ms^2: 32^2/2 counts, and 20 ms until it is seen at most
    assert 0 < c.position(1) - there < 32 * 32 / 2 + 20 * 32
    c.command("#1J-")
    c.run(ms=100)
    assert c.position(1) < there
