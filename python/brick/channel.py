"""JSON-RPC 2.0 on the socket of `brick control`, a line an object (docs/control.md)."""

from __future__ import annotations

import json
import socket
from collections.abc import Sequence
from typing import Any

from brick.errors import BrickError, CommandRefused, ControllerGone, NoAnswer, SimulatedTimeout, WallTimeout
from brick.process import Child

PROTOCOL = "1.0"
START_LIMIT = 120.0  # seconds of the wall for the start of the controller, and what a call may take beyond its limit

_KINDS: dict[int, type[BrickError]] = {2: NoAnswer, 3: SimulatedTimeout, 4: WallTimeout, 5: ControllerGone}
_BAD_PARAMETERS = -32602
_REFUSED = 1


class Channel:
    """The command and the socket to it; one call at a time."""

    def __init__(self, options: Sequence[str]) -> None:
        self.tick = 0
        self.ns = 0
        self.calls: list[tuple[str, dict[str, Any]]] = []
        self._count = 0
        self._waiting = b""
        self._socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            self.child = Child(["control", f"fd:{theirs.fileno()}", *options], pass_fds=[theirs.fileno()])
        except BaseException:
            self._socket.close()
            raise
        finally:
            theirs.close()

    def call(self, method: str, wall_limit: float, **params: Any) -> dict[str, Any]:
        """The result; a wall_limit of seconds stands beside the parameters."""
        self._count += 1
        self.calls.append((method, params))
        request = {"jsonrpc": "2.0", "id": self._count, "method": method, "params": {**params, "wall_s": wall_limit}}
        try:
            self._socket.settimeout(wall_limit + START_LIMIT)
            self._socket.sendall(json.dumps(request).encode() + b"\n")
            answer = json.loads(self._line())
        except TimeoutError:
            self.child.process.kill()
            raise WallTimeout(f"{method}: no answer of the simulation") from None
        except OSError as error:
            raise self._gone(str(error)) from None
        if "error" in answer:
            self._raise(answer["error"])
        result: dict[str, Any] = answer["result"]
        self._take_time(result)
        return result

    def close(self) -> int:
        """The end of the controller, and its exit status."""
        self._socket.close()
        status = self.child.end()
        self.child.close()
        return status

    def _line(self) -> bytes:
        while b"\n" not in self._waiting:
            piece = self._socket.recv(1 << 16)
            if not piece:
                raise self._gone("the simulation has ended")
            self._waiting += piece
        line, _, self._waiting = self._waiting.partition(b"\n")
        return line

    def _gone(self, what: str) -> ControllerGone:
        status = self.child.end()
        said = self.child.said()
        return ControllerGone(f"{said or what} (exit status {status})")

    def _take_time(self, data: dict[str, Any]) -> None:
        self.tick = data.get("tick", self.tick)
        self.ns = data.get("ns", self.ns)

    def _raise(self, error: dict[str, Any]) -> None:
        code, message, data = error["code"], error["message"], error.get("data", {})
        self._take_time(data)
        if code == _REFUSED:
            raise CommandRefused(message, data["number"], data["line"], data["lines"][:-1])
        if code == _BAD_PARAMETERS:
            raise ValueError(message)
        raise _KINDS.get(code, BrickError)(message)
