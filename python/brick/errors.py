"""What may go wrong. Bad arguments are ValueError, as elsewhere in Python; all else is a BrickError."""


class BrickError(Exception):
    """Anything that the controller, its simulation or the way to it could not do."""


class CommandRefused(BrickError):
    """The controller answered a line with an error.

    number: of ERRnnn, 0 where I6 keeps it back. line: that was refused. lines: data that came before the error.
    """

    def __init__(self, message: str, number: int, line: str, lines: list[str]) -> None:
        super().__init__(message)
        self.number = number
        self.line = line
        self.lines = lines


class NoAnswer(BrickError):
    """The controller did not answer, or a line of a host script did not come true."""


class SimulatedTimeout(BrickError, TimeoutError):
    """Simulated time ran out before what was waited for."""


class WallTimeout(BrickError, TimeoutError):
    """The clock on the wall ran out: the call was cut off where it was."""


class MotorOff(BrickError):
    """A motor that was waited for has lost its amplifier enable: killed, tripped or never closed."""


class RulesBroken(BrickError):
    """At the end: a rule of the buses was broken, two sources drove the clocks, or the firmware raised an exception.

    failures: one line each.
    """

    def __init__(self, failures: list[str]) -> None:
        super().__init__("; ".join(failures))
        self.failures = failures


class ControllerGone(BrickError):
    """The simulation has ended: killed, failed, or never started. The message has what it said last."""
