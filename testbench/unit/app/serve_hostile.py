"""`brick serve` and clients that mean no good, or do no good: the others are served, memory stays where it is.

usage: serve_hostile.py BRICK CASE [--seconds N]; each CASE is one test.
"""
import contextlib
import pathlib
import random
import socket
import sys
import threading
import time

import command
import misbehaving
from command import check
from served import exactly, packet, served

VERSION = b"1.947\r\x06"


def memory(server):
    """KiB that the process has in use."""
    status = pathlib.Path(f"/proc/{server.process.pid}/status").read_text(encoding="ascii")
    return int(status.partition("VmRSS:")[2].split()[0])


def ask_version(sock):
    sock.sendall(packet(0xBF, b"ver"))
    return exactly(sock, len(VERSION))


def serve_hostile():
    """Each misdeed many times, while a client of good manners is answered in between."""
    chance = random.Random(1)
    with served("--free") as server, server.client() as good:
        def play(times):
            for misdeed in misbehaving.MISDEEDS:
                for _ in range(times):
                    misdeed(server.port, chance)
                    check(good.values("ver") == ["1.947"], misdeed.__name__)
        play(3)  # what is taken once
        before = memory(server)
        play(20)
        grown = memory(server) - before
        check(grown <= 1024, f"{grown} KiB more")


def serve_every_byte():
    """Split and ended at every byte of every packet: all are answered alike, and nobody else is."""
    with served("--free") as server, server.client() as good:
        for text in misbehaving.PACKETS:
            with server.socket() as sock:
                sock.sendall(text)
                whole = sock.recv(2000)
            for at in range(1, len(text)):
                with server.socket() as sock, server.socket() as gone:
                    sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                    gone.sendall(text[:at])
                    gone.close()
                    sock.sendall(text[:at])
                    check(good.ready() is False, "a request of another in between")
                    sock.sendall(text[at:])
                    check(exactly(sock, len(whole)) == whole, f"{text!r} split at {at}")
        check(good.values("ver") == ["1.947"], "the other client")


def serve_crowd():
    """64 clients stay connected, the 65th is told that there is no room, and so are a thousand more."""
    with served("--free") as server, contextlib.ExitStack() as stack:
        server.client().close()  # which sets I3
        crowd = [stack.enter_context(server.socket()) for _ in range(64)]
        for sock in crowd:
            check(ask_version(sock) == VERSION, "one of 64")
        before = memory(server)
        for attempt in range(1000):
            with server.socket() as sock, contextlib.suppress(ConnectionError):
                check(sock.recv(1) == b"", f"attempt {attempt} is refused")
        grown = memory(server) - before
        check(grown <= 1024, f"{grown} KiB more")
        for sock in crowd:
            check(ask_version(sock) == VERSION, "one of 64 after that")
        crowd[0].close()
        with contextlib.suppress(ConnectionError):
            for _ in range(1000):  # until the server has seen it go
                with server.socket() as sock:
                    reply = ask_version(sock)
                if reply:
                    break
        check(reply == VERSION, "the place is free again")
        said = server.end()
        check("a client is refused: 64 are connected" in said and said.count("\n") < 10, said)


def poll(server, enough, lost, counts):
    """Eight axes, ten times a second."""
    with server.client() as client:
        names = "".join(f"#{motor}PVF" for motor in range(1, 9))
        while not enough():
            if client.values(names) != ["0"] * 24:
                lost.append(names)
            counts.append(1)
            time.sleep(0.1)


def serve_soak():
    """Two clients poll, a third misbehaves: nothing is lost, memory does not grow. An hour: --seconds 3600."""
    seconds = float(sys.argv[4]) if sys.argv[3:4] == ["--seconds"] else 60
    with served() as server:
        end = time.monotonic() + seconds
        lost, counts = [], []

        def enough(pause=0.0):
            time.sleep(pause)
            return time.monotonic() >= end
        threads = [threading.Thread(target=poll, args=(server, enough, lost, counts)) for _ in range(2)]
        threads.append(threading.Thread(target=misbehaving.misbehave, args=(server.port, 1, lambda: enough(0.3))))
        for thread in threads:
            thread.start()
        time.sleep(min(10, seconds / 3))  # until each misdeed has been done
        before = memory(server)
        for thread in threads:
            thread.join()
        grown = memory(server) - before
        print(f"{seconds:.0f} s: {len(counts)} polls, {len(lost)} lost, {grown} KiB more")
        check(counts and not lost, f"{len(lost)} answers are not what they should be")
        check(grown <= 1024, f"{grown} KiB more")


globals()[command.CASE]()
