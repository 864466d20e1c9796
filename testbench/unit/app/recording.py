"""Recorded exchanges of the Ethernet port (testbench/clients/recordings), played again byte for byte."""
import pathlib
import re

from command import check
from served import exactly

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "clients" / "recordings"
TOKEN = re.compile(r'"([^"]*)"|([0-9A-F]{2})\*(\d+)|((?:[0-9A-F]{2})+)|\s+')
READY = bytes.fromhex("C0C2000000000002")


def bytes_of(text):
    found, at = b"", 0
    while at < len(text):
        token = TOKEN.match(text, at)
        check(token is not None, f"{text}: nothing known at {at}")
        quoted, repeated, times, plain = token.groups()
        if quoted is not None:
            found += quoted.encode("ascii")
        elif repeated:
            found += bytes.fromhex(repeated) * int(times)
        elif plain:
            found += bytes.fromhex(plain)
        at = token.end()
    return found


def play(sock, name):
    """The number of replies; READREADY is asked until it says what it said then, as clients do."""
    count, sent = 0, b""
    for number, line in enumerate((FOLDER / name).read_text(encoding="ascii").splitlines(), 1):
        if line[:2] == "> ":
            sent = bytes_of(line[2:])
            sock.sendall(sent)
        elif line[:2] == "< ":
            expected = bytes_of(line[2:])
            reply = exactly(sock, len(expected))
            while sent == READY and reply != expected:
                sock.sendall(sent)
                reply = exactly(sock, len(expected))
            check(reply == expected, f"{name}:{number}: {reply!r}, expected {expected!r}")
            count += 1
    return count
