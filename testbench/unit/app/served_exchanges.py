"""Exchange files (exchange_file.py) through the Ethernet port. What differs from the host port is the protocol's: the
checksums of I4 are taken out, and ^X is a request of its own.
"""
import math

import exchange_file
from command import check

DIFFERS = {"I4=1": "<ACK>", "J+": "<ACK>", "^X": "@"}
SERVO_RATE = 2258.7  # Hz
BREQ = 0x02          # of the interrupt controller's signals, I/O byte 9


def shown(reply):
    return "".join(chr(byte) if 0x20 <= byte < 0x7F else f"<{byte:02X}>" for byte in reply)


def answer(client, line):
    """All that a line is answered, however many fetches it takes."""
    if line[0] == "^":
        code = ord(line[1]) & 0x1F
        if code == 0x18:
            return client.flush()
        check(client.request(0x40, 0xB6, value=code) == b"@", line)
        return None
    reply = client.request(0x40, 0xBF, data=line.encode("latin-1"))
    while reply[-1:] == b"\n":  # I3=1: data may follow
        more = client.get_buffer()
        if more == b"\0":
            break
        reply += more
    return reply


def breq(client):
    return client.request(0xC0, 0xBE, value=9)[0] & BREQ != 0


def memory_time(client):
    """Simulated seconds that a reading of 1400 bytes takes, by a counter that loses one each servo interrupt."""
    client.command("I5112=8388607")
    before = int(client.command("I5112"))
    for _ in range(50):
        client.read_memory(0, 1400)
    return (before - int(client.command("I5112"))) / SERVO_RATE / 50


def host(client, words, one_reading):
    if words[0] == "@wait":
        for _ in range(math.ceil(float(words[1].removesuffix("ms")) * 1e-3 / one_reading)):
            client.read_memory(0, 1400)
        return None
    check(words[:2] == ["@until", "host.breq=1"], words)
    for _ in range(10000):
        if breq(client):
            return None
    return check(False, "BREQ stays low")


def differences(client, name):
    """What does not fit, a string each; and how many answers were compared."""
    found, compared, one_reading = [], 0, memory_time(client)
    for number, sent, expected in exchange_file.read(name):
        if sent[0] == "@":
            host(client, sent.split(), one_reading)
            continue
        reply = answer(client, sent)
        if expected is None:
            continue
        wanted = DIFFERS.get(sent, expected)
        if reply is None:
            reply = client.get_buffer()
        compared += 1
        if not exchange_file.fits(shown(reply), wanted):
            found.append(f"{name}:{number}: `{sent}` answered {shown(reply)}, expected {wanted}")
    return found, compared
