"""The page of `brick serve --page` for a test: HTTP and a websocket (RFC 6455) by hand, so that it can misbehave."""
import base64
import json
import os
import re
import socket
import struct
import time

from command import check
from served import PATIENCE, Served, exactly


class ServedPage(Served):
    """`brick serve` with a page: where, and with which token."""

    def __init__(self, *options, page="127.0.0.1:0"):
        super().__init__("--page", page, *options)
        line = self.process.stdout.readline()
        found = re.fullmatch(r"page at (http://([^/]+):(\d+)/\?token=([0-9a-f]{32}))\n", line)
        check(found, f"{line!r}: expected the address of the page with a token of 128 bits")
        self.address, self.host, self.token = found[1], f"{found[2]}:{found[3]}", found[4]
        self.page_port = int(found[3])

    def connect(self):
        return socket.create_connection(("127.0.0.1", self.page_port), PATIENCE)

    def raw(self, text):
        """What the page answers to these bytes, to the end."""
        with self.connect() as sock:
            sock.sendall(text)
            answer = b""
            while more := sock.recv(65536):
                answer += more
        return answer

    def get(self, path=None, method="GET", **fields):
        """Status and body."""
        answer = self.raw(head(path or f"/?token={self.token}", method, {"Host": self.host, **fields}))
        return status_of(answer), answer.partition(b"\r\n\r\n")[2].decode()

    def open(self, **fields):
        return WebSocket(self, **fields)


def head(path, method, fields):
    lines = [f"{method} {path} HTTP/1.1"]
    for name, value in fields.items():
        lines += [f"{name}: {one}" for one in (value if isinstance(value, list) else [value]) if one is not None]
    return ("\r\n".join(lines) + "\r\n\r\n").encode("latin-1")


def status_of(answer):
    return int(answer.split(b" ", 2)[1]) if answer.startswith(b"HTTP/1.1 ") else None


def frame(data, opcode=1, final=True):
    mask, size = os.urandom(4), len(data)
    length = bytes([0x80 | size]) if size < 126 else struct.pack(">BH", 0xFE, size) if size < 65536 else \
        struct.pack(">BQ", 0xFF, size)
    masked = bytes(b ^ mask[i % 4] for i, b in enumerate(data))
    return bytes([(0x80 if final else 0) | opcode]) + length + mask + masked


class WebSocket:
    """`refused`: the status of HTTP that it was not opened with, or None."""

    def __init__(self, server, path=None, **fields):
        self.sock = server.connect()
        key = base64.b64encode(os.urandom(16)).decode()
        self.sock.sendall(head(path or f"/socket?token={server.token}", "GET", {
            "Host": server.host, "Origin": f"http://{server.host}", "Upgrade": "websocket", "Connection": "Upgrade",
            "Sec-WebSocket-Key": key, "Sec-WebSocket-Version": "13", **fields}))
        answer = b""
        while b"\r\n\r\n" not in answer and (more := self.sock.recv(1)):
            answer += more
        self.refused = None if status_of(answer) == 101 else status_of(answer)
        self.last_id = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.sock.close()

    def frame(self, data, opcode=1, final=True):
        self.sock.sendall(frame(data, opcode, final))

    def send(self, message):
        self.frame(json.dumps(message).encode())

    def receive(self):
        """The next message as JSON; None when it is closed."""
        text = b""
        while True:
            first = exactly(self.sock, 2)
            if len(first) < 2 or first[0] & 0xF == 8:
                return None
            size = first[1] & 0x7F
            if size == 126:
                size = struct.unpack(">H", exactly(self.sock, 2))[0]
            elif size == 127:
                size = struct.unpack(">Q", exactly(self.sock, 8))[0]
            data = exactly(self.sock, size)
            if first[0] & 0xF == 9:
                self.frame(data, 10)
            elif first[0] & 0xF < 2:  # a text, or more of it
                text += data
                if first[0] & 0x80:
                    return json.loads(text)

    def until(self, wanted, what):
        """The first message for which that holds."""
        last = time.monotonic() + PATIENCE
        while time.monotonic() < last:
            message = self.receive()
            check(message is not None, f"closed while waiting for {what}")
            if wanted(message):
                return message
        return check(False, f"no {what}")

    def state(self, wanted=lambda _: True, what="state"):
        return self.until(lambda m: m["kind"] == "state" and wanted(m), what)

    def command(self, line):
        self.last_id += 1
        self.send({"kind": "command", "id": self.last_id, "line": line})
        return self.until(lambda m: m["kind"] in ("answer", "mistake"), f"answer to {line}")
