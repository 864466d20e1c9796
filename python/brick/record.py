"""A record as it was written: a row each servo interrupt (docs/record.md)."""

from __future__ import annotations

import csv
import pathlib
import tempfile
from collections.abc import Callable
from types import TracebackType
from typing import Any


class Record:
    """`with c.record("motor1.*") as r:` records what happens inside; afterwards columns, numpy arrays or a frame."""

    def __init__(self, call: Callable[..., Any], of: str, file: str | None) -> None:
        self._call = call
        self._of = of
        self._folder = None if file is not None else tempfile.TemporaryDirectory()
        self.file = pathlib.Path(file or f"{self._folder.name if self._folder else ''}/record.csv")
        self.names: list[str] = []
        self.rows: list[list[float]] = []

    def __enter__(self) -> Record:
        try:
            self._call("record.start", file=str(self.file.absolute()), of=self._of)
        except BaseException:
            self._remove()
            raise
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        try:
            self._call("record.stop")
            with self.file.open(newline="", encoding="ascii") as file:
                rows = csv.reader(file)
                self.names = next(rows)
                self.rows = [[float(value) for value in row] for row in rows]
        finally:
            self._remove()

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
        if self._folder is not None:
            self._folder.cleanup()
