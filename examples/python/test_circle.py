"""A motion program: a circle of two motors, judged by a record."""

import brick
import pytest

PROGRAM = """
&1 OPEN PROG 1 CLEAR
INC NORMAL K-1 TM 400 TA 50 TS 25
CIRCLE1 X0 Y0 I2 J0
CLOSE
"""


@pytest.mark.brick(plant="dac8", setup="dac8")
def test_circle_is_round(brick_controller: brick.Controller) -> None:
    c = brick_controller
    c["I5113"] = 10  # segments of 10 ms: circles need them
    c.script(PROGRAM)
    c.command("&1A")
    c.run(ms=50)
    with c.record("motor1.actual motor2.actual") as record:
        c.command("&1B1R")
        c.wait_in_position(1, 2)
    table = record.array()
    x, y = table[:, 1] / 1000, table[:, 2] / 1000  # units of the axes
    radius = ((x - 2) ** 2 + y**2) ** 0.5  # around X2 Y0, from X0 Y0
    assert radius.min() > 1.98 and radius.max() < 2.02
    assert x.max() > 3.9  # it went all the way round
