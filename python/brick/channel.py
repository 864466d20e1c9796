"""JSON-RPC 2.0 on the socket of `brick control`, a line an object (docs/control.md)."""

from __future__ import annotations

import contextlib
import decimal
import json
import numbers
import operator
import select
import socket
import threading
import time
from collections.abc import Sequence
from typing import Any

from brick.errors import BrickError, CommandRefused, ControllerGone, NoAnswer, SimulatedTimeout, WallTimeout
from brick.process import Child
from brick.replay import outcome

PROTOCOL = "1.0"
START_LIMIT = 120.0  # seconds of the wall for the start of the controller, and what a call may take beyond its limit

_KINDS: dict[int, type[BrickError]] = {2: NoAnswer, 3: SimulatedTimeout, 4: WallTimeout, 5: ControllerGone}
_BAD_REQUEST = (-32700, -32600, -32601, -32602)  # whatever is wrong with it came with the arguments
_REFUSED = 1
_WALL_LIMIT = 4


def _plain(value: Any) -> Any:
    """Numbers of other libraries."""
    if hasattr(value, "__index__"):
        return operator.index(value)
    if isinstance(value, numbers.Real | decimal.Decimal):
        return float(value)
    raise TypeError(f"{value!r} is no text and no number")


def _read(line: bytes) -> dict[str, Any]:
    """An answer, of which is looked at what every one has."""
    try:
        answer: dict[str, Any] = json.loads(line)
        told = answer["error"] if "error" in answer else answer["result"]
        if "id" in answer and isinstance(told, dict) and ("error" not in answer or {"code", "message"} <= told.keys()):
            return answer
    except (ValueError, TypeError, KeyError, RecursionError):
        pass
    raise BrickError(f"the simulation answered {line[:80]!r}; expected an object of JSON-RPC 2.0")


class Channel:
    """The command and the socket to it; one call at a time, those of other threads wait for their turn."""

    def __init__(self, options: Sequence[str], folder: str | None = None) -> None:
        self.tick = 0
        self.ns = 0
        self.calls: list[tuple[str, dict[str, Any]]] = []
        self.exact: int | None = None  # calls before the first that was cut off; None: there was none
        self.errors: dict[int, str] = {}  # of calls, by their place among them, that ended with one
        self._texts: list[str] = []  # that have come beside answers
        self._turn = threading.RLock()  # a call of its holder's signal handler shall be told, not wait for ever
        self._busy = False
        self._sound = True  # nothing was cut off in the middle of a transfer
        self._closed = False
        self._count = 0
        self._waiting = b""
        try:
            self._socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        except OSError as error:
            raise ControllerGone(f"cannot be started: {error}; expected room for two sockets") from None
        try:
            self.child = Child(["control", f"fd:{theirs.fileno()}", *options], pass_fds=[theirs.fileno()],
                               folder=folder)
        except BaseException:
            self._socket.close()
            raise
        finally:
            theirs.close()

    def hello(self) -> dict[str, Any]:
        """The first call, which is answered when the controller has started: what it is."""
        try:
            return self.call("hello", START_LIMIT, protocol=PROTOCOL)
        except ValueError as error:  # of no argument of the caller's
            raise ControllerGone(f"{error}: the command is of another version; see brick --version") from None

    def call(self, method: str, wall_limit: float, **params: Any) -> dict[str, Any]:
        """The result; a wall_limit of seconds, the wait for other threads' calls too, stands beside the parameters."""
        self.child.need_ours(method)  # its lock may be another thread's, which a fork has not
        begin = time.monotonic()
        if not self._turn.acquire(timeout=wall_limit):
            raise WallTimeout(f"{method}: a call of another thread is under way; expected its end in {wall_limit} s")
        try:
            if self._busy:
                raise BrickError(f"{method}: a call within a call, as of a signal handler; expected it behind that")
            try:
                self._busy = True
                return self._exchange(method, max(0.0, wall_limit - (time.monotonic() - begin)), params)
            finally:
                self._busy = False
        finally:
            self._turn.release()

    def take_texts(self) -> list[str]:
        """What programs have sent beside answers since this was asked last."""
        with self._turn:
            texts, self._texts = self._texts, []
        return texts

    def _exchange(self, method: str, wall_limit: float, params: dict[str, Any]) -> dict[str, Any]:
        if self._closed or not self._sound:
            raise ControllerGone("the way to the controller is closed: by close(), or an exception in a transfer")
        request = {"jsonrpc": "2.0", "id": self._count + 1, "method": method,
                   "params": {**params, "wall_s": wall_limit}}
        try:
            line = json.dumps(request, allow_nan=False, ensure_ascii=False, default=_plain).encode() + b"\n"
        except (TypeError, ValueError, RecursionError) as error:  # UnicodeEncodeError too
            raise ValueError(f"{method}: {error}; expected texts in Unicode and finite numbers") from None
        self._count += 1
        self.calls.append((method, params))
        cut_off = True
        try:
            self._socket.settimeout(wall_limit + START_LIMIT)
            self._send(line)
            answer = self._answer(time.monotonic() + wall_limit + START_LIMIT)
            cut_off = "error" in answer and answer["error"]["code"] == _WALL_LIMIT
        except TimeoutError:
            self.child.process.kill()
            raise WallTimeout(f"{method}: no answer of the simulation") from None
        except OSError as error:
            raise self._gone(str(error)) from None
        finally:
            if cut_off and self.exact is None:
                self.exact = len(self.calls) - 1
        if "error" in answer:
            told = self._error(answer["error"])
            self.errors[len(self.calls) - 1] = outcome(told)
            raise told
        result: dict[str, Any] = answer["result"]
        self._take(result)
        return result

    def close(self) -> tuple[int, str]:
        """The end of the controller: its exit status, and what it said last. A call of another thread ends by it.

        It needs no end of the socket's copies, which forks of this process may have. In one nothing ends.
        """
        self._closed = True
        if not self.child.ours:
            self._socket.close()
            return 0, self.child.close()
        with contextlib.suppress(OSError):  # the other end has gone already
            self._socket.shutdown(socket.SHUT_RDWR)
        with self._turn:
            if not self._busy:  # else this is a signal handler's, and the call below it still looks at the socket
                self._socket.close()
            status = self.child.end()
            return status, self.child.close()

    def _send(self, line: bytes) -> None:
        self._sound = False
        self._socket.sendall(line)
        self._sound = True

    def _answer(self, limit: float) -> dict[str, Any]:
        """That of the last call; those of calls that an exception has cut off come before it and are dropped."""
        while True:
            answer = _read(self._line(limit))
            if answer["id"] in (self._count, None):  # None: the line was no request
                return answer

    def _line(self, limit: float) -> bytes:
        waiting = select.poll()
        waiting.register(self._socket, select.POLLIN)
        while b"\n" not in self._waiting:
            if not waiting.poll(max(0.0, limit - time.monotonic()) * 1e3):  # the place where an exception does no harm
                raise TimeoutError
            self._sound = False
            piece = self._socket.recv(1 << 16)
            self._waiting += piece
            self._sound = True
            if not piece:
                raise self._gone("the simulation has ended")
        line, _, self._waiting = self._waiting.partition(b"\n")
        return line

    def _gone(self, what: str) -> ControllerGone:
        status = self.child.end()
        said = self.child.said()
        return ControllerGone(f"{said or what} (exit status {status})")

    def _take(self, data: dict[str, Any]) -> None:
        """What comes beside each answer, an error too."""
        self._texts += data.get("texts", [])
        self.tick = data.get("tick", self.tick)
        self.ns = data.get("ns", self.ns)

    def _error(self, error: dict[str, Any]) -> Exception:
        code, message, data = error["code"], error["message"], error.get("data", {})
        self._take(data)
        if code == _REFUSED:
            return CommandRefused(message, data["number"], data["line"], data["lines"][:-1])
        if code in _BAD_REQUEST:
            return ValueError(message)
        return _KINDS.get(code, BrickError)(message)
