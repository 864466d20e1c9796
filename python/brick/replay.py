"""What a replay takes over from the run before: its options, and how each of its calls ended (Controller.replay)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from brick.errors import BrickError, ControllerGone, WallTimeout

_WRITTEN = ("--wave", "--record", "--record-of", "--profile", "--flash")  # files of the run before, which stay
_UNHEARD = ("wave.", "record.")  # calls that pass no time


def values(options: Sequence[str], name: str) -> Iterator[str]:
    """Those of an option of the command line, NAME=VALUE or NAME VALUE."""
    for at, option in enumerate(options):
        if option == name:
            yield from options[at + 1:at + 2]
        elif option.startswith(name + "="):
            yield option[len(name) + 1:]


def options_again(options: Sequence[str]) -> list[str]:
    """Those of a run that writes none of the files of the run before, and does not wait for the wall."""
    left: list[str] = []
    rest = iter(options)
    for option in rest:
        if option in _WRITTEN:
            next(rest, None)
        elif option != "--realtime" and not option.startswith(tuple(name + "=" for name in _WRITTEN)):
            left.append(option)
    return left


def outcome(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"


def play(call: Callable[..., Any], calls: Sequence[tuple[str, dict[str, Any]]], errors: dict[int, str],
         whole: int | None, wave: str) -> None:
    """Makes the calls again, the first `whole` of them. BrickError at the end where one ended otherwise than before."""
    other = ""
    for n, (method, params) in enumerate(calls[:whole]):
        if method == "hello" or method.startswith(_UNHEARD):
            continue
        now = None
        try:
            call(method, **params)
        except WallTimeout:
            raise WallTimeout(f"call {n} ({method}) was cut off: {wave} ends within it") from None
        except ControllerGone:
            raise
        except (BrickError, ValueError) as error:
            now = outcome(error)
        if not other and now != errors.get(n):
            other = (f"call {n} ({method}) ended with {now or 'a result'}; expected {errors.get(n, 'a result')}, as "
                     f"the first time: {wave} shows another run from there on")
    if other:
        raise BrickError(other)
    if whole is not None:
        raise WallTimeout(f"call {whole} ({calls[whole][0]}) was cut off: {wave} ends before it")
