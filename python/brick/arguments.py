"""Arguments as the command takes them. What it cannot take is a ValueError that says what was expected."""

from __future__ import annotations

import decimal
import math
import operator
import os
import re
from collections.abc import Iterable, Sequence

_LONGEST_WAIT = 1e6  # seconds of the wall
_MOTORS = 32
_VARIABLE = re.compile(r"[IPQM]\d{1,4}", re.IGNORECASE | re.ASCII)


def texts(name: str, values: Iterable[str | os.PathLike[str]]) -> list[str]:
    """A list of them; one alone is none."""
    try:
        if not isinstance(values, (str, bytes)):
            return [os.fspath(value) + "" for value in values]  # no bytes
    except TypeError:
        pass
    raise ValueError(f"{name}={values!r}: expected a list of texts")


def run_options(options: Sequence[str], **values: object) -> list[str]:
    """Those of the command line: of values that are none of None, then the options themselves."""
    return [*(f"--{name}={value}" for name, value in values.items() if value is not None), *texts("options", options)]


def seconds(name: str, value: float) -> float:
    """A limit of the wall."""
    try:
        if 0 <= value <= _LONGEST_WAIT:  # False for no number
            return float(value)
    except (TypeError, ValueError):
        pass
    raise ValueError(f"{name}={value!r}: expected seconds, 0 to {_LONGEST_WAIT:.0f}")


def nanoseconds(**values: float) -> int:
    """Simulated time, the sum of s, ms and us."""
    scale = {"s": 1e9, "ms": 1e6, "us": 1e3}
    try:
        return round(sum(value * scale[name] for name, value in values.items()))
    except (TypeError, ValueError, OverflowError):
        given = ", ".join(f"{name}={value!r}" for name, value in values.items() if value != 0)
        raise ValueError(f"{given}: expected a finite number") from None


def motor(value: int) -> int:
    try:
        number = operator.index(value)
    except TypeError:
        number = 0
    if not 1 <= number <= _MOTORS:
        raise ValueError(f"motor {value!r}: expected 1 to {_MOTORS}")
    return number


def variable(name: str) -> str:
    if not isinstance(name, str) or not _VARIABLE.fullmatch(name):
        raise ValueError(f"{name!r} is no variable; expected one like P1, Q20, M102 or I130")
    return name.upper()


def digits(value: float) -> str:
    """As the controller takes numbers: all digits that tell this float from others, without an exponent."""
    try:
        return str(operator.index(value))  # type: ignore[arg-type]
    except TypeError:
        pass
    try:
        number = math.nan if isinstance(value, (str, bytes)) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"{value!r} is no number for a variable; expected a finite one")
    return f"{decimal.Decimal(repr(number)):f}".removesuffix(".0")
