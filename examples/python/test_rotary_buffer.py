"""Lines sent ahead of the machine: BREQ falls when there are enough, and rises when more are wanted."""

import brick
import pytest

AHEAD = 10  # I17: so many lines are enough
ASK = 5  # I16: at so few more are wanted


@pytest.mark.brick(plant="dac8", setup="dac8")
def test_breq(brick_controller: brick.Controller) -> None:
    c = brick_controller
    c["I16"], c["I17"] = ASK, AHEAD
    c.command("&1 DEFINE ROT 1000 B0")  # B0: the coordinate system points to it
    c.command("&1 A")
    c.run(ms=50)
    c.command("OPEN ROT CLEAR")
    c.command("INC LINEAR TM20 TA10 TS0")
    sent = 0
    while sent < AHEAD + 2:
        c.command("X0.1")
        sent += 1
    assert c.signal("host.breq") == 0
    c.command("R")
    c.wait_signal("host.breq", 1, ms=500)
    assert int(c.command("PR")) <= ASK
    c.command("CLOSE")
    c.wait_in_position(1)
    assert abs(c.position(1) - sent * 100) < 10
