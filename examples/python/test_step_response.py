"""A step of 100 counts: the loop of the set-up rises within 20 ms and overshoots by less than 30 %."""

import brick
import pytest


@pytest.mark.brick(plant="dac8", setup="dac8")
def test_step(brick_controller: brick.Controller) -> None:
    c = brick_controller
    c.command("#1J/")
    c.run(ms=50)
    c["I119"], c["I120"], c["I121"], c["I122"] = 1000, 0, 0, 1000  # as steep as a profile can be
    with c.record("motor1.actual") as record:
        c.command("#1J:100")
        c.run(ms=100)
    table = record.array()
    time, position = table[:, 0] - table[0, 0], table[:, 1]
    assert position[-1] == pytest.approx(100, abs=5)
    assert time[(position > 90).argmax()] - time[(position > 10).argmax()] < 20
    assert position.max() < 130
