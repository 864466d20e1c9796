"""`brick serve` for a test: started on a free port, ended with SIGTERM, and what it said checked."""
import contextlib
import os
import pathlib
import re
import resource
import signal
import socket
import struct
import subprocess
import sys

import command
from command import check

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "clients"))
import turbo_pmac

PATIENCE = 60  # seconds of wall time, on a loaded machine


class Served:
    def __init__(self, *options):
        self.process = subprocess.Popen([command.BRICK, "serve", "--listen", "127.0.0.1:0", *options], text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        line = self.process.stdout.readline()
        found = re.fullmatch(r"listening on 127\.0\.0\.1:(\d+), TCP and UDP\n", line)
        if not found:
            sys.exit(f"FAILED: {line!r} {self.process.stderr.read()}")
        self.port = int(found[1])

    def client(self):
        return turbo_pmac.TurboPmac("127.0.0.1", self.port, PATIENCE)

    def socket(self):
        return socket.create_connection(("127.0.0.1", self.port), PATIENCE)

    def processor_seconds(self):
        """Used so far: unlike the wall's, not stretched by what else the machine does."""
        status = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text(encoding="ascii")
        user, system = status.rpartition(")")[2].split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")

    def end(self, signal_number=signal.SIGTERM, status=0):
        """What it says on stderr, in 1.5 s of the processor."""
        def of_children():
            used = resource.getrusage(resource.RUSAGE_CHILDREN)
            return used.ru_utime + used.ru_stime
        others, until_then = of_children(), self.processor_seconds()
        self.process.send_signal(signal_number)
        said = self.process.communicate(timeout=PATIENCE)[1]
        check(self.process.returncode == status, f"exit {self.process.returncode}: {said}")
        used = of_children() - others - until_then
        check(used <= 1.5, f"the end takes {used:.1f} s of the processor")
        return said


def served(*options):
    return ended(Served(*options))


@contextlib.contextmanager
def ended(server):
    """The server, which ends with the block: as it should, or killed where the block fails."""
    try:
        yield server
        if server.process.poll() is None:
            server.end()
    finally:
        server.process.kill()
        server.process.wait()
        server.process.stdout.close()
        server.process.stderr.close()


def packet(request, data=b"", kind=0x40, value=0, index=0, length=None):
    return struct.pack(">BBHHH", kind, request, value, index, len(data) if length is None else length) + data


def exactly(sock, count):
    """So many bytes, in however many pieces."""
    text = b""
    while len(text) < count:
        more = sock.recv(count - len(text))
        if not more:
            break
        text += more
    return text


def refused(client, line):
    """The error that a line is refused with, "" when it is taken."""
    try:
        client.command(line)
    except turbo_pmac.TurboPmacError as error:
        return str(error)
    return ""
