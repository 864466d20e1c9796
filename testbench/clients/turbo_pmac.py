"""A host program's own class for the controller's Ethernet port, in the idiom of scripts and laboratory software: one
socket, one request, one reply; the header packed by hand, a command's length in its last byte.
"""
import argparse
import socket
import struct

ACK, BELL = b"\x06", b"\x07"
LONGEST = 1400


class TurboPmacError(Exception):
    """The controller refused a command: ERRnnn."""


class TurboPmac:
    DOWNLOAD, UPLOAD = 0x40, 0xC0
    SENDLINE, FLUSH, GETMEM, SETMEM, SENDCTRL = 0xB0, 0xB3, 0xB4, 0xB5, 0xB6
    GETRESPONSE, READREADY, CTRL_RESPONSE, GETBUFFER, WRITEBUFFER = 0xBF, 0xC2, 0xC4, 0xC5, 0xC6

    def __init__(self, host, port=1025, timeout=20.0):
        self.socket = socket.create_connection((host, port), timeout)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.identity = self.command("i6=1 i3=2 ver").strip()

    def close(self):
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def request(self, kind, code, value=0, index=0, data=b"", length=None):
        """One packet; the reply as one recv gives it."""
        size = len(data) if length is None else length
        self.socket.sendall(struct.pack(">BBHHH", kind, code, value, index, size) + data)
        return self.socket.recv(4096)

    def command(self, line):
        """The answer's text, data lines with CR between them; long ones in pieces of 1400 bytes."""
        data = line.encode("latin-1")
        reply = self.request(self.DOWNLOAD, self.GETRESPONSE, data=data)
        text = reply
        while len(reply) == LONGEST and reply[-1:] != ACK:
            reply = self.request(self.UPLOAD, self.GETBUFFER, length=2048)
            text += reply
        if BELL in text:
            raise TurboPmacError(text.partition(BELL)[2].decode("latin-1").strip())
        if text[-1:] != ACK:
            raise OSError(f"{line}: {text[-20:]!r} is not the end of an answer")
        return text[:-1].decode("latin-1")

    def values(self, line):
        return self.command(line).split("\r")[:-1]

    def flush(self, milliseconds=10):
        return self.request(self.DOWNLOAD, self.FLUSH, value=milliseconds)

    def control(self, character):
        """The answer to a control character such as "B"."""
        return self.request(self.UPLOAD, self.CTRL_RESPONSE, value=ord(character) & 0x1F).decode("latin-1")

    def send_line(self, line):
        return self.request(self.DOWNLOAD, self.SENDLINE, data=line.encode("latin-1"))

    def ready(self):
        return self.request(self.UPLOAD, self.READREADY, length=2)[0] != 0

    def get_buffer(self):
        return self.request(self.UPLOAD, self.GETBUFFER, length=LONGEST)

    def read_memory(self, offset, count):
        return self.request(self.UPLOAD, self.GETMEM, value=offset, length=count)

    def write_memory(self, offset, data):
        return self.request(self.DOWNLOAD, self.SETMEM, value=offset, data=data)

    def write_lines(self, lines):
        """Line number and error number of the first line that is refused, or None."""
        reply = self.request(self.DOWNLOAD, self.WRITEBUFFER, data="\0".join(lines).encode("latin-1"))
        number, error, refused = struct.unpack("<HBB", reply)
        return (number, error) if refused else None


def session(host, port):
    """What a first look at a controller is like."""
    with TurboPmac(host, port) as controller:
        for line in ("ver", "cid", "i20 i21 i22 i23", "#1?", "#1P", "P1=25 P2=50 P1..2"):
            print(f"{line:>18}  {controller.values(line)}")
        try:
            controller.command("frob")
        except TurboPmacError as error:
            print(f"{'frob':>18}  {error}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="A client's session with a controller that `brick serve` listens for.")
    parser.add_argument("place", nargs="?", default="127.0.0.1:1025", metavar="HOST:PORT", help="(%(default)s)")
    host, colon, port = parser.parse_args().place.rpartition(":")
    if not (colon and host and port.isdigit() and int(port) < 65536):
        parser.error(f"{host}{colon}{port}: is no place; expected HOST:PORT, for example 127.0.0.1:1025")
    session(host, int(port))
