"""Clients as they should not be, against the Ethernet port. Each function is one misdeed: it leaves when it is done."""
import contextlib
import random
import select
import socket

from served import packet

PACKETS = (packet(0xBF, b"ver"), packet(0xB0, b"P1=1"), packet(0xB3), packet(0xB4, kind=0xC0, length=100),
           packet(0xB5, b"abcd", value=0x1200), packet(0xC2, kind=0xC0, length=2), packet(0xC4, kind=0xC0, value=2),
           packet(0xC6, b"P2=1\0P3=1"), packet(0xE0, kind=0xC0, length=4))


@contextlib.contextmanager
def connected(port):
    """A socket; that it is cut off is no error."""
    with contextlib.suppress(ConnectionError, TimeoutError), socket.create_connection(("127.0.0.1", port), 60) as sock:
        yield sock


def lies(port, chance):
    """Headers whose length is not that of what follows."""
    with connected(port) as sock:
        code = chance.choice((0xB0, 0xB5, 0xBA, 0xBB, 0xBF, 0xC6, 0xCB, 0xE0))
        sock.sendall(packet(code, b"P1=1", length=chance.choice((0, 1, 3, 5, 1492, 1493, 32768, 65535))))
        sock.sendall(bytes(chance.randrange(256) for _ in range(chance.randrange(3000))))


def noise(port, chance):
    with connected(port) as sock:
        sock.sendall(bytes(chance.choice((0x40, 0xC0, chance.randrange(256))) for _ in range(chance.randrange(4000))))


def lines(port, chance):
    """Requests in order, but lines of any bytes, control characters among them."""
    with connected(port) as sock:
        text = bytes(chance.randrange(256) for _ in range(chance.choice((2, 30, 255, 256, 1400))))
        sock.sendall(packet(chance.choice((0xB0, 0xBF, 0xC6)), text))


def half(port, chance):
    """Gone at any byte of a packet."""
    with connected(port) as sock:
        text = chance.choice(PACKETS)
        sock.sendall(text[:chance.randrange(len(text) + 1)])


def slow(port, chance):
    """A byte at a time."""
    with connected(port) as sock:
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for byte in chance.choice(PACKETS):
            sock.sendall(bytes([byte]))
        sock.recv(2000)


def flood(port, chance, most=1 << 20):
    """Requests without an end, and no reply is read."""
    with connected(port) as sock:
        sock.setblocking(False)
        text = chance.choice((packet(0xB4, kind=0xC0, length=1400), packet(0xC2, kind=0xC0, length=2))) * 500
        sent = 0
        while sent < most and select.select([], [sock], [], 0.2)[1]:
            sent += sock.send(text)


def reset(port, chance):
    """Gone with a reset, while a reply is under way."""
    with connected(port) as sock:
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
        sock.sendall(chance.choice(PACKETS) * 3)


def datagrams(port, chance):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        for _ in range(50):
            text = chance.choice(PACKETS)
            text = text[:chance.randrange(len(text) + 1)] if chance.random() < 0.5 else text + b"x" * 1400
            sock.sendto(text, ("127.0.0.1", port))


MISDEEDS = (lies, noise, lines, half, slow, flood, reset, datagrams)


def misbehave(port, seed, enough):
    """Until `enough()`; the number of misdeeds."""
    chance = random.Random(seed)
    count = 0
    while not enough():
        chance.choice(MISDEEDS)(port, chance)
        count += 1
    return count
