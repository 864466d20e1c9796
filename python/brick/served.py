"""`brick serve` on a free port, for host software that speaks to a controller by TCP (docs/ethernet.md)."""

from __future__ import annotations

import re
import select
import subprocess
from collections.abc import Sequence
from types import TracebackType

from brick.arguments import run_options
from brick.channel import START_LIMIT
from brick.controller import RULES_BROKEN
from brick.errors import ControllerGone, WallTimeout
from brick.process import Child


class Served:
    """A controller behind 127.0.0.1:port. Simulated time passes while a client waits, and stands in between.

    Arguments as those of Controller. check: at the end, ControllerGone where a rule of the buses was broken too.
    """

    def __init__(self, board: str | None = None, plant: str | None = None, setup: str | None = None, *,
                 engine: str | None = None, seed: int | None = None, wave: str | None = None, realtime: bool = False,
                 check: bool = True, options: Sequence[str] = ()) -> None:
        chosen = run_options(options, board=board, plant=plant, load=setup, engine=engine, seed=seed, wave=wave)
        self._check = check
        self._closed = False
        pace = [] if realtime else ["--free"]
        self._child = Child(["serve", "--listen", "127.0.0.1:0", *pace, *chosen], stdout=subprocess.PIPE)
        try:
            self.port = self._listening()
        except BaseException:
            self._child.stop()
            self._child.close()
            raise

    def _listening(self) -> int:
        assert self._child.process.stdout is not None
        waiting = select.poll()  # select() knows no number above 1023
        waiting.register(self._child.process.stdout, select.POLLIN)
        if not waiting.poll(START_LIMIT * 1e3):
            raise WallTimeout("brick serve does not listen")
        found = re.match(rb"listening on 127\.0\.0\.1:(\d+)", self._child.process.stdout.readline())
        if not found:
            self._child.end()
            raise ControllerGone(self._child.said() or "brick serve has ended")
        return int(found[1])

    @property
    def pid(self) -> int:
        return self._child.process.pid

    def close(self) -> None:
        """Ends it; its waveform is whole then. Raises ControllerGone if it had failed."""
        if self._closed:
            return
        self._closed = True
        if not self._child.ours:
            self._child.close()
            return
        status = self._child.stop()
        said = self._child.close()
        if status != 0 and (self._check or status != RULES_BROKEN):
            raise ControllerGone(f"{said or 'brick serve has ended'} (exit status {status})")

    def __enter__(self) -> Served:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        try:
            self.close()
        except ControllerGone as failure:
            if error is None:
                raise
            error.add_note(f"brick serve: {failure}")
