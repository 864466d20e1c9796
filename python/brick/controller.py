"""A controller, its motors and its clock in a program's hand."""

from __future__ import annotations

import os
import pathlib
import time
from collections.abc import Sequence
from types import TracebackType
from typing import Any

from brick.arguments import digits, nanoseconds, run_options, seconds, texts, variable
from brick.arguments import motor as need_motor
from brick.channel import Channel
from brick.errors import BrickError, ControllerGone, MotorOff, NoAnswer, RulesBroken, SimulatedTimeout, WallTimeout
from brick.process import folder_now, place, scratch
from brick.record import Record
from brick.replay import options_again, play, values

WALL_LIMIT = 60.0  # seconds of the wall that a call may take, unless told otherwise
_SEEN_BY = 20  # ms: what a command begins shows in the status by then (motion:6.6/1)
_STATUS_EVERY = 1  # ms
_ENCODER = ("enc_a", "enc_b", "enc_c")
_LIMITS = {"+": "plim", "-": "mlim"}
RULES_BROKEN = 1  # exit status, of other failures too
_FIVE_VOLTS = "watchdog.pwr_good"
_CHANNELS = 4  # of a servo IC


class Status:
    """The two status words of a motor (firmware:5.2, firmware:5.3)."""

    def __init__(self, word1: int, word2: int) -> None:
        self.word1 = word1
        self.word2 = word2

    @property
    def enabled(self) -> bool:
        return bool(self.word1 >> 19 & 1)

    @property
    def closed(self) -> bool:
        """The loop is closed: enabled, and not open."""
        return self.enabled and not self.word1 >> 18 & 1

    @property
    def at_rest(self) -> bool:
        """Loop closed, desired velocity 0."""
        return bool(self.word1 >> 13 & 1)

    @property
    def in_position(self) -> bool:
        return bool(self.word2 & 1)

    @property
    def on_limit(self) -> bool:
        """In a limit, or stopped by one."""
        return bool(self.word1 >> 21 & 3 or self.word2 >> 11 & 1)

    @property
    def following_error(self) -> bool:
        """Tripped by the following error."""
        return bool(self.word2 >> 2 & 1)

    @property
    def amplifier_fault(self) -> bool:
        """Tripped by a fault input or by overload."""
        return bool(self.word2 >> 3 & 1)

    @property
    def home_complete(self) -> bool:
        return bool(self.word2 >> 10 & 1)

    def __repr__(self) -> str:
        return f"Status({self.word1:06X} {self.word2:06X})"


class Controller:
    """A started controller. Use it with `with`: its process ends there, and with this process in any case.

    board, plant, setup, engine, seed: as --board, --plant, --load, --engine and --seed of the command.
    wave: a waveform from the start. realtime: between calls simulated time follows the clock on the wall; else it
    stands, and the same calls with the same seed give the same answers at the same instants. wall_limit: seconds of the
    wall that a call may take. check: at the end, RulesBroken where a rule of the buses was broken.
    """

    def __init__(self, board: str | None = None, plant: str | None = None, setup: str | None = None, *,
                 engine: str | None = None, seed: int | None = None, wave: str | None = None,
                 realtime: bool = False, wall_limit: float = WALL_LIMIT, check: bool = True,
                 options: Sequence[str] = ()) -> None:
        self.wall_limit = seconds("wall_limit", wall_limit)
        self.options = run_options(options, board=board, plant=plant, load=setup, engine=engine, seed=seed, wave=wave)
        self.options += ["--realtime"] if realtime else []
        self._check = check
        self._closed = False
        # As it is now, for a replay: at the end it holds what was saved.
        self._flash = next((_bytes(file) for file in values(self.options, "--flash")), None)
        self._folder = folder_now()  # from which names of files in the options count, in a replay too
        self._channel = Channel(self.options)
        try:
            self.about = self._channel.hello()
        except BaseException:
            self._channel.close()
            raise

    def __enter__(self) -> Controller:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        if kind is None:
            self.close()
        else:
            self.abandon()

    def close(self) -> None:
        """Ends the controller; waveform, record and flash file are whole then. ControllerGone where they are not.

        In a fork of the process that has started it, nothing: that one has it.
        """
        if self._closed:
            return
        failures: list[str] = []
        try:
            if self._check and self._channel.child.ours:
                failures = self.failures()
        finally:
            status, said = self._end()
        if failures:
            raise RulesBroken(failures)
        if status != 0 and (self._check or status != RULES_BROKEN):
            raise ControllerGone(f"{said or 'the simulation has ended'} (exit status {status})")

    def abandon(self) -> None:
        """Ends the controller without a look at what it did."""
        if not self._closed:
            self._end()

    def _end(self) -> tuple[int, str]:
        self._closed = True
        return self._channel.close()

    @property
    def pid(self) -> int:
        return self._channel.child.process.pid

    @property
    def calls(self) -> list[tuple[str, dict[str, Any]]]:
        """What has been asked of the controller, to play it again (`replay`)."""
        return self._channel.calls

    def call(self, method: str, wall_limit: float | None = None, **params: Any) -> dict[str, Any]:
        """A method of docs/control.md as it stands there."""
        return self._channel.call(method, self._limit(wall_limit), **params)

    def _limit(self, wall_limit: float | None) -> float:
        return seconds("wall_limit", self.wall_limit if wall_limit is None else wall_limit)

    # ---- Time: it passes in these and in commands

    @property
    def time(self) -> float:
        """Simulated time in seconds since power-on."""
        return self._channel.ns * 1e-9

    @property
    def time_ns(self) -> int:
        return self._channel.ns

    @property
    def tick(self) -> int:
        """Simulated time in ticks of the 117.9648 MHz clock, exact."""
        return self._channel.tick

    def run(self, *, s: float = 0, ms: float = 0, us: float = 0, wall_limit: float | None = None) -> None:
        """Lets so much simulated time pass."""
        self.call("run", wall_limit, ns=nanoseconds(s=s, ms=ms, us=us))

    # ---- The controller's language

    def command(self, line: str, wall_limit: float | None = None) -> str:
        """Sends a line; its answer, lines with LF between, at the instant at which it ends.

        CommandRefused has the controller's number, NoAnswer says that there was none. A control character alone is sent
        as it is: command("\\x01") is ^A.
        """
        return "\n".join(self.call("command", wall_limit, line=line)["lines"])

    def script(self, text: str, wall_limit: float | None = None) -> list[str]:
        """Plays lines of a host script (docs/scripts.md): @dpram, @jumper, @reset, @power, ...; what it prints."""
        folder = folder_now()
        here = {} if folder == self._folder else {"folder": folder}
        lines: list[str] = self.call("script", wall_limit, text=text, **here)["lines"]
        return lines

    def load(self, file: str | os.PathLike[str], wall_limit: float | None = None) -> None:
        """Sends a command file. BrickError where a line of it is refused."""
        name = place(file)
        if any(character in name for character in '"\r\n'):
            raise ValueError(f"{name!r}: expected a name without quotation marks and line ends")
        refused = self.call("script", wall_limit, text=f'#include "{name}"\n')
        if refused["refused"]:
            raise BrickError(f"{file}: {refused['refused']} lines refused: {' '.join(refused['lines'])}")

    def texts(self) -> list[str]:
        """Lines that programs have sent since the last call (SEND, CMD)."""
        self.call("texts")
        return self._channel.take_texts()

    def __getitem__(self, name: str) -> int | float:
        """A variable: c["P1"], c["I130"], as a number in whatever form I9 has it shown."""
        return self._asked(variable(name))

    def __setitem__(self, name: str, value: float) -> None:
        self.command(f"{variable(name)}={digits(value)}")

    def _asked(self, line: str) -> int | float:
        text = self.command(line)
        value = _number(text.removeprefix(f"{line}="))  # a statement where I9 is odd (firmware:1.6)
        if isinstance(value, str):
            raise NoAnswer(f"{line}: {text!r}; expected a number")
        return value

    # ---- Motors

    def position(self, motor: int) -> float:
        """Actual position in counts."""
        return float(self._asked(f"#{need_motor(motor)}P"))

    def status(self, motor: int, wall_limit: float | None = None) -> Status:
        """Leaves the addressed motor as it is."""
        word = 0x80 * need_motor(motor)
        lines = self.command(f"RHX${word + 0x30:X} RHY${word + 0x40:X}", wall_limit).split()
        try:
            word1, word2 = (int(line, 16) for line in lines)
        except ValueError:
            raise NoAnswer(f"status of motor {motor}: {lines}; expected two words") from None
        return Status(word1, word2)

    def wait_in_position(self, *motors: int, ms: float = 10_000, wall_limit: float | None = None) -> None:
        """Until all of them are at rest and in position at once, asked once a simulated millisecond.

        What a command begins shows in the status within 20 ms, which are waited first. MotorOff where one is not
        enabled, SimulatedTimeout after `ms`, WallTimeout where the wait as a whole takes longer than the wall_limit.
        """
        limit = self._channel.ns + nanoseconds(ms=ms)
        wall = time.monotonic() + self._limit(wall_limit)
        self.run(ms=min(_SEEN_BY, ms), wall_limit=_left(wall))
        while True:
            status = {motor: self.status(motor, _left(wall)) for motor in motors}
            for motor, one in status.items():
                if not one.enabled:
                    raise MotorOff(f"motor {motor} is off: {one}")
            late = [motor for motor, one in status.items() if not (one.in_position and one.at_rest)]
            if not late:
                return
            if self._channel.ns >= limit:
                raise SimulatedTimeout(f"motor {late[0]} is not in position after {ms} ms: {status[late[0]]}")
            self.run(ms=_STATUS_EVERY, wall_limit=_left(wall))

    # ---- Signals and pins (docs/signals.md)

    def signal(self, name: str) -> int | float | str:
        """What a signal shows."""
        return _number(self.call("signal", name=name)["value"])

    def signals(self, pattern: str = "all") -> list[str]:
        """Names of signals, by name or glob."""
        names: list[str] = self.call("signals", pattern=pattern)["names"]
        return names

    def wait_signal(self, name: str, value: int | str, *, ms: float, wall_limit: float | None = None) -> None:
        """Until the signal shows the value. SimulatedTimeout after `ms`."""
        self.call("until", wall_limit, name=name, value=str(value), ns=nanoseconds(ms=ms))

    def set_pin(self, name: str, level: int | None) -> None:
        """Drives an input pin, against the plant if that drives it; None gives it back."""
        self.call("input", name=name, level=level)

    def channel(self, motor: int) -> str:
        """Scope of the signals of a motor's channel, on boards whose ICs are fitted in order: servo_ic0.ch1."""
        motor = need_motor(motor)
        return f"servo_ic{(motor - 1) // _CHANNELS}.ch{(motor - 1) % _CHANNELS + 1}"

    # ---- What can go wrong at the plant (docs/plant.md)

    def open_limit(self, motor: int, side: str, active: bool = True) -> None:
        """Opens the end switch "+" or "-" of a motor, as a cut wire does, or closes it."""
        if side not in list(_LIMITS):  # it may have no hash
            raise ValueError(f"{side!r} is no side; expected + or -")
        self.set_pin(f"{self.channel(motor)}.{_LIMITS[side]}", 1 if active else None)

    def trip_amplifier(self, motor: int, cause: str = "over-current") -> None:
        """Trips the amplifier: over-current, shorted-bus, under-voltage, over-voltage, over-temperature, i2t."""
        self.call("plant.trip", motor=motor, cause=cause)

    def lose_encoder(self, motor: int, pins: Sequence[str] = _ENCODER) -> None:
        """Cuts wires of the encoder; no pins: all are whole again."""
        self.call("plant.cut", motor=motor, pins=texts("pins", pins))

    def set_load(self, motor: int, torque: float) -> None:
        """Torque on the shaft, N m."""
        self.call("plant.load", motor=motor, torque=torque)

    def lose_five_volts(self, lost: bool = True) -> None:
        """The supervisor of the 5 V supply says that it has failed, or that it is there."""
        self.set_pin(_FIVE_VOLTS, 0 if lost else 1)

    # ---- Files

    def start_wave(self, file: str | os.PathLike[str], trace: str | None = None) -> None:
        """A waveform from now on, FILE.vcd or FILE.fst; trace: names or globs with commas between."""
        self.call("wave.start", file=place(file), trace=trace)

    def stop_wave(self) -> None:
        self.call("wave.stop")

    def record(self, of: str = "", file: str | os.PathLike[str] | None = None) -> Record:
        """Records what happens inside a `with`, see Record. of: columns of docs/record.md."""
        return Record(self.call, of, None if file is None else place(file))

    def failures(self) -> list[str]:
        """Broken rules of the buses, clocks with two sources, exceptions of the CPU, so far: one line each."""
        failures: list[str] = self.call("check")["failures"]
        return failures

    def replay(self, wave: str | os.PathLike[str]) -> None:
        """The calls so far once more, in a new controller with a waveform from its start, which is always made.

        BrickError where a call does not end as it did, with its result or its error. WallTimeout where one was cut off,
        then or now: nobody knows where it stood, and the waveform ends before it. Files of the first run stay as they
        are; the flash file is that of its start.
        """
        wave = place(wave)
        calls, errors, whole = list(self.calls), dict(self._channel.errors), self._channel.exact
        with scratch() as folder:
            options = [*options_again(self.options), *self._flash_options(folder), f"--wave={wave}"]
            again = Channel(options, self._folder)
            try:
                again.hello()
                play(lambda method, **params: again.call(method, self.wall_limit, **params), calls, errors, whole, wave)
            finally:
                status, said = again.close()
        if status not in (0, RULES_BROKEN):
            raise ControllerGone(f"{said or 'the simulation has ended'} (exit status {status})")

    def _flash_options(self, folder: str) -> list[str]:
        if self._flash is None:
            return []
        copy = pathlib.Path(folder) / "flash"
        try:
            copy.write_bytes(self._flash)
        except OSError as error:
            raise BrickError(f"replay: {error}; expected room for a flash file") from None
        return [f"--flash={copy}"]


def _bytes(file: str) -> bytes | None:
    """None where there are none: the command says what is wrong with the file."""
    try:
        return pathlib.Path(file).read_bytes() if pathlib.Path(file).is_file() else None
    except (OSError, ValueError):
        return None


def _left(wall: float) -> float:
    left = wall - time.monotonic()
    if left <= 0:
        raise WallTimeout("the limit of wall time of the wait has passed")
    return left


def _number(text: str) -> int | float | str:
    try:
        return int(text[1:], 16) if text.startswith("$") else int(text)
    except ValueError:
        pass
    try:
        return float(text)
    except ValueError:
        return text
