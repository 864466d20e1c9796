"""A home search ends at the edge of a flag, and the position is counted from there."""

import brick
import pytest


@pytest.mark.brick(plant="dac8", setup="dac8")
def test_home_search(brick_controller: brick.Controller) -> None:
    c = brick_controller
    c["I7012"], c["I7013"] = 2, 0  # capture by the rise of the flag, which is HMFL
    c.command("#1J/")
    c.run(ms=50)
    c.command("#1HM")  # I123: 10 counts/ms upwards
    c.run(ms=80)
    assert not c.status(1).home_complete
    c.set_pin("servo_ic0.ch1.hmfl", 1)
    c.wait_in_position(1)
    assert c.status(1).home_complete
    assert abs(c.position(1)) < 10  # it goes back to where the flag rose
