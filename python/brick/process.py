"""The brick command as a child that ends with whoever started it."""

from __future__ import annotations

import contextlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from typing import IO

from brick.errors import BrickError, ControllerGone

_PATIENCE = 10  # seconds of the wall for an end
_HERE = pathlib.Path(__file__).resolve().parent


def executable() -> str:
    """The command: $BRICK, else the one of this package, of the tree this stands in, or on the path."""
    if named := os.environ.get("BRICK"):
        return os.path.abspath(named) if os.sep in named else named  # the command may start in another folder
    for file in (_HERE / "_installed/bin/brick", _HERE.parents[1] / "build/release/bin/brick"):
        if file.is_file():
            return str(file)
    if found := shutil.which("brick"):
        return os.path.abspath(found)
    raise ControllerGone("no command brick; expected it on the path, or its place in $BRICK")


def main() -> None:
    """The command `brick` of the wheel."""
    program = executable()
    os.execv(program, [program, *sys.argv[1:]])


def folder_now() -> str | None:
    """In which the caller stands; None: one that is no more."""
    try:
        return os.getcwd()
    except OSError:
        return None


def place(file: str | os.PathLike[str]) -> str:
    """The name in full, from the folder in which the caller stands now: the command stands where it was started."""
    name = os.fspath(file) if isinstance(file, (str, os.PathLike)) else None
    if not isinstance(name, str) or "\0" in name:
        raise ValueError(f"{file!r} is no name of a file; expected a text or a path")
    if not os.path.isabs(name) and folder_now() is None:
        raise BrickError(f"{name}: the folder in which this process stands has gone; expected a name from /")
    return str(pathlib.Path(name).absolute())


@contextlib.contextmanager
def scratch() -> Iterator[str]:
    """A folder for as long. In a fork it stays, as it is not the fork's."""
    try:
        folder = tempfile.mkdtemp(prefix="brick-")
    except OSError as error:
        raise BrickError(f"{error}; expected room for a folder in {tempfile.gettempdir()}") from None
    maker = os.getpid()
    try:
        yield folder
    finally:
        if os.getpid() == maker:
            shutil.rmtree(folder, ignore_errors=True)


class Child:
    """A running command; what it says on stderr is kept for the message of an error. folder: in which it runs."""

    def __init__(self, arguments: Sequence[str], pass_fds: Sequence[int] = (), stdout: int = subprocess.DEVNULL,
                 folder: str | None = None) -> None:
        self._last = ""  # what it had said by close()
        self._starter = os.getpid()
        # The process is to end with this one, however this one ends, and not by a Ctrl-C that this one survives.
        command = [executable(), *arguments, "--end-with", str(self._starter)]
        if any("\0" in word for word in command):
            raise ValueError(f"{command[1:]}: a NUL in them; expected arguments of a command line")
        try:
            self._said: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115  until close()
            self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=stdout, stderr=self._said,
                                            pass_fds=pass_fds, process_group=0, cwd=folder)
        except OSError as error:
            raise ControllerGone(f"{command[0]}: cannot be started: {error}; expected the command brick, whose place "
                                 "$BRICK may name") from None

    @property
    def ours(self) -> bool:
        """False in a fork of the process that has started it: there it is neither heard, ended nor waited for."""
        return os.getpid() == self._starter

    def need_ours(self, what: str) -> None:
        if not self.ours:
            raise BrickError(f"{what}: process {os.getpid()} is a fork of {self._starter}, which has the controller; "
                             "expected the call there, or a controller of its own")

    def said(self) -> str:
        if self._said.closed or not self.ours:
            return self._last
        self._said.seek(0)
        return self._said.read().decode(errors="replace").strip()

    def end(self, patience: float = _PATIENCE) -> int:
        """Waits for an end that is under way, ends it where there is none."""
        self.need_ours("end")
        try:
            status = self.process.wait(patience)
        except subprocess.TimeoutExpired:
            self.process.kill()
            status = self.process.wait()
        return status

    def stop(self) -> int:
        self.need_ours("stop")
        self.process.terminate()
        return self.end()

    def close(self) -> str:
        """What it said last. Of the files a fork closes its own copies alone."""
        self._last = self.said()
        self._said.close()
        if self.process.stdout is not None:
            self.process.stdout.close()
        return self._last
