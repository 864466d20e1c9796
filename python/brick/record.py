"""A record as it was written: a row each servo interrupt (docs/record.md)."""

from __future__ import annotations

import contextlib
import csv
import pathlib
from collections.abc import Callable
from types import TracebackType
from typing import Any

from brick.errors import BrickError
from brick.process import scratch


class Record:
    """`with c.record("motor1.*") as r:` records what happens inside; afterwards columns, numpy arrays or a frame.

    What the body raises comes out of the `with`; where the record has failed too, that is a note of it.
    """

    def __init__(self, call: Callable[..., Any], of: str, file: str | None) -> None:
        self._call = call
        self._of = of
        self._folder = contextlib.ExitStack()  # of this record alone, while it lasts
        self._file = file
        self.names: list[str] = []
        self.rows: list[list[float]] = []

    def __enter__(self) -> Record:
        folder = self._folder.enter_context(scratch()) if self._file is None else ""
        self.file = pathlib.Path(self._file or f"{folder}/record.csv")
        try:
            self._call("record.start", file=str(self.file), of=self._of)
        except (BrickError, ValueError):
            self._folder.close()
            raise
        except BaseException:  # of a signal handler: the record may have begun, and would be in the way of the next
            with contextlib.suppress(BrickError, ValueError):
                self._call("record.stop")
            self._folder.close()
            raise
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        try:
            self._call("record.stop")
            self._read()
        except (BrickError, ValueError) as failure:
            if error is None:
                raise
            error.add_note(f"record: {failure}")
        finally:
            self._folder.close()

    def _read(self) -> None:
        try:
            with self.file.open(newline="", encoding="ascii") as file:
                rows = csv.reader(file)
                self.names = next(rows, [])
                self.rows = [[float(value) for value in row] for row in rows]
        except (OSError, ValueError, csv.Error) as error:
            raise BrickError(f"record {self.file}: {error}; expected what the controller has written") from None

    def __getitem__(self, name: str) -> list[float]:
        """A column, by its name; `time_ms` is the first."""
        self._need_end()
        if name not in self.names:
            raise ValueError(f"{name!r}: no such column; expected one of {', '.join(self.names)}")
        at = self.names.index(name)
        return [row[at] for row in self.rows]

    def _need_end(self) -> None:
        if not self.names:
            raise BrickError("the record has no columns yet; expected the end of its with")

    def __len__(self) -> int:
        return len(self.rows)

    def array(self) -> Any:
        """All rows as a numpy array of two dimensions. Needs numpy."""
        self._need_end()
        import numpy

        return numpy.array(self.rows, dtype=float).reshape(-1, len(self.names))

    def frame(self) -> Any:
        """A pandas frame with the time in ms as its index. Needs pandas."""
        self._need_end()
        import pandas  # type: ignore[import-untyped, unused-ignore]

        return pandas.DataFrame(self.rows, columns=self.names).set_index("time_ms")
