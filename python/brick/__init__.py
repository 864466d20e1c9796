"""A virtual Turbo PMAC2 / Geo Brick LV in a program's hand: simulated time stands between calls (docs/python.md).

    with brick.Controller(plant="dac8", setup="dac8") as c:
        c.command("#1J:4000")
        c.wait_in_position(1)
        print(c.command("#1P"), c["I130"], c.time)
"""

from brick.controller import Controller, Status
from brick.errors import (
    BrickError,
    CommandRefused,
    ControllerGone,
    MotorOff,
    NoAnswer,
    RulesBroken,
    SimulatedTimeout,
    WallTimeout,
)
from brick.process import executable
from brick.record import Record
from brick.served import Served

__all__ = [
    "BrickError",
    "CommandRefused",
    "Controller",
    "ControllerGone",
    "MotorOff",
    "NoAnswer",
    "Record",
    "RulesBroken",
    "Served",
    "SimulatedTimeout",
    "Status",
    "WallTimeout",
    "executable",
]
