"""A wire of the encoder breaks while the motor runs: the following error switches it off before it runs away."""

import brick
import pytest


@pytest.mark.brick(plant="dac8", setup="dac8")
def test_motor_does_not_run_away(brick_controller: brick.Controller) -> None:
    c = brick_controller
    c.command("#1J+")
    c.run(ms=100)
    c.lose_encoder(1)
    c.wait_signal("servo_ic0.ch1.aena", 0, ms=200)
    assert c.status(1).following_error
