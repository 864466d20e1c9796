"""An amplifier trips: its motor is off, and with the set-up's Ixx24 all other motors too."""

import brick
import pytest


@pytest.mark.brick(plant="dac8", setup="dac8")
def test_all_motors_are_off(brick_controller: brick.Controller) -> None:
    c = brick_controller
    for motor in (1, 2):
        c.command(f"#{motor}J/")
    c.run(ms=30)
    assert c.status(1).enabled and c.status(2).enabled
    c.trip_amplifier(1, "over-current")
    c.wait_signal("servo_ic0.ch1.aena", 0, ms=20)
    c.wait_signal("servo_ic0.ch2.aena", 0, ms=20)
    assert c.status(1).amplifier_fault and not c.status(2).amplifier_fault
