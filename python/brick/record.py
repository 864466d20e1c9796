"""A record as it was written: a row each servo interrupt (docs/record.md)."""

from __future__ import annotations

import contextlib
import csv
import os
import pathlib
import shutil
import tempfile
from collections.abc import Callable
from types import TracebackType
from typing import Any

from brick.errors import BrickError


class Record:
    """`with c.record("motor1.*") as r:` records what happens inside; afterwards columns, numpy arrays or a frame.

    What the body raises comes out of the `with`; where the record has failed too, that is a note of it.
    """

    def __init__(self, call: Callable[..., Any], of: str, file: str | None) -> None:
        self._call = call
        self._of = of
        self._folder: str | None = None  # of this record alone, while it lasts
        self._file = file
        self.names: list[str] = []
        self.rows: list[list[float]] = []

    def __enter__(self) -> Record:
        if self._file is None:
            self._folder = tempfile.mkdtemp(prefix="brick-")
            self._maker = os.getpid()
        self.file = pathlib.Path(self._file or f"{self._folder}/record.csv")
        try:
            self._call("record.start", file=str(self.file), of=self._of)
        except (BrickError, ValueError):
            self._remove()
            raise
        except BaseException:  # of a signal handler: the record may have begun, and would be in the way of the next
            with contextlib.suppress(BrickError, ValueError):
                self._call("record.stop")
            self._remove()
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
            self._remove()

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
        if name not in self.names:
            raise KeyError(f"{name}: no such column; expected one of {', '.join(self.names)}")
        at = self.names.index(name)
        return [row[at] for row in self.rows]

    def __len__(self) -> int:
        return len(self.rows)

    def array(self) -> Any:
        """All rows as a numpy array of two dimensions. Needs numpy."""
        import numpy

        return numpy.array(self.rows, dtype=float).reshape(-1, len(self.names))

    def frame(self) -> Any:
        """A pandas frame with the time in ms as its index. Needs pandas."""
        import pandas  # type: ignore[import-untyped, unused-ignore]

        return pandas.DataFrame(self.rows, columns=self.names).set_index("time_ms")

    def _remove(self) -> None:
        if self._folder is not None and os.getpid() == self._maker:  # a fork's record is not its own
            shutil.rmtree(self._folder, ignore_errors=True)
