"""`brick serve` and clients that mean no good, or do no good: the others are served, memory stays where it is.

usage: serve_hostile.py BRICK CASE [--seconds N] [--hours N] [--slow-clocks]; each CASE is one test.
"""
import concurrent.futures
import contextlib
import os
import pathlib
import random
import socket
import sys
import time

import command
import misbehaving
from command import check
from served import exactly, packet, refused, served

VERSION = b"1.947\r\x06"


@contextlib.contextmanager
def measured(*options):
    """A server whose memory is judged. The address sanitizer does not keep what is freed then, up to 256 MB of it."""
    before = os.environ.get("ASAN_OPTIONS", "")
    os.environ["ASAN_OPTIONS"] = before + ":quarantine_size_mb=0:thread_local_quarantine_size_kb=0"
    with served(*options) as server:
        os.environ["ASAN_OPTIONS"] = before
        yield server


def memory(server):
    """KiB that the process has in use."""
    status = pathlib.Path(f"/proc/{server.process.pid}/status").read_text(encoding="ascii")
    return int(status.partition("VmRSS:")[2].split()[0])


def check_growth(server, before, most):
    """The sanitizer's allocator takes 64 KiB at a time for each size of blocks; what is lost, it tells at the end."""
    sanitized = "libasan" in pathlib.Path(f"/proc/{server.process.pid}/maps").read_text(encoding="utf-8")
    grown, most = memory(server) - before, most + (1024 if sanitized else 0)
    check(grown <= most, f"{grown} KiB more, expected {most:.0f} or less")
    return grown


def ask_version(sock):
    sock.sendall(packet(0xBF, b"ver"))
    return exactly(sock, len(VERSION))


def serve_hostile():
    """Each misdeed many times, while a client of good manners is answered in between."""
    chance = random.Random(1)
    def play(server, times):
        with server.client() as good:
            for misdeed in misbehaving.MISDEEDS:
                for _ in range(times):
                    misdeed(server.port, chance)
                    check(good.values("ver") == ["1.947"], misdeed.__name__)
    with served("--free") as server:
        play(server, 3)
    with measured("--free") as server:
        play(server, 3)  # what is taken once
        before = memory(server)
        play(server, 20)
        check_growth(server, before, 1024)


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
    with measured("--free") as server, contextlib.ExitStack() as stack:
        server.client().close()  # which sets I3
        crowd = [stack.enter_context(server.socket()) for _ in range(64)]
        for sock in crowd:
            check(ask_version(sock) == VERSION, "one of 64")
        before = memory(server)
        for attempt in range(1000):
            with server.socket() as sock, contextlib.suppress(ConnectionError):
                check(sock.recv(1) == b"", f"attempt {attempt} is refused")
        check_growth(server, before, 1024)
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


def poll(server, enough, lost):
    """Eight axes, ten times a second; how many times."""
    count = 0
    with server.client() as client:
        names = "".join(f"#{motor}PVF" for motor in range(1, 9))
        while not enough():
            if client.values(names) != ["0"] * 24:
                lost.append(names)
            count += 1
            time.sleep(0.1)
    return count


def serve_soak():
    """Two clients poll, a third misbehaves: nothing is lost, memory does not grow. An hour: --seconds 3600."""
    seconds = float(sys.argv[4]) if sys.argv[3:4] == ["--seconds"] else 20
    with measured() as server:
        end = time.monotonic() + seconds
        lost = []

        def enough(pause=0.0):
            time.sleep(pause)
            return time.monotonic() >= end
        with concurrent.futures.ThreadPoolExecutor(3) as pool:
            polls = [pool.submit(poll, server, enough, lost) for _ in range(2)]
            misdeeds = pool.submit(misbehaving.misbehave, server.port, 1, lambda: enough(0.3))
            time.sleep(min(10, seconds / 3))  # until each misdeed has been done
            before = memory(server)
            counts = [done.result() for done in polls]  # raises what has ended one of them
            misdone = misdeeds.result()
        grown = check_growth(server, before, min(1024, 256 + seconds / 5))
        print(f"{seconds:.0f} s: {sum(counts)} polls, {len(lost)} lost, {grown} KiB more")
        # Ten a second where nothing holds them up; one, because the machine may be busy.
        check(min(counts) >= seconds, f"polls of each client: {counts}, expected {seconds:.0f} or more")
        check(not lost, f"{len(lost)} answers are not what they should be")
        check(misdone != 0, "the third client did nothing")


def look_around(server, period):
    """What a client finds that connects anew: the same, however long the controller has been running."""
    with server.client() as client, server.socket() as other:
        found = [client.values(line) for line in ("ver", "#1?PVF", "??", "I0..99", "P1..3", "M1->X:$0,0,24 I3")]
        found.append(client.command("P1=P1+1 P1=P1-1"))
        found.append(client.write_memory(0x1200, b"hello") + client.read_memory(0x1200, 8))
        found += [client.control("B"), refused(client, "frob"), client.flush(), ask_version(other)]
        clock = ServoClock(client, period)
        client.get_buffer()  # half a second
        check(0.5 <= clock.seconds() < 0.6, f"half a second is {clock.seconds()} s of servo interrupts")
    return found


class ServoClock:
    """Simulated time by the controller's own count of servo interrupts, X:$0: 24 bits, so it is to be asked more often
    than every two hours."""
    def __init__(self, client, period):
        self.client, self.period = client, period
        self.last, self.count = self.read(client), 0

    @staticmethod
    def read(client):
        client.command("M1->X:$0,0,24")
        return int(client.values("M1")[0])

    def seconds(self):
        """Since the beginning."""
        now = self.read(self.client)
        self.count, self.last = self.count + (now - self.last) % (1 << 24), now
        return self.count * self.period

    def hours(self):
        return self.seconds() / 3600


def serve_days():
    """A client at 0, 2.6, 24 and 48 hours of simulated time, as fast as the engine goes: --hours 48. The conversion
    table is empty, because its reads of encoders in each servo interrupt make an idle machine five times as slow.
    --slow-clocks: with the slowest phase clock, five times as fast once more."""
    hours = float(sys.argv[4]) if sys.argv[3:4] == ["--hours"] else 0.01
    max_phase = 32767 if sys.argv[-1] == "--slow-clocks" else 6527
    period = 4 * (2 * max_phase + 3) / 117_964_800  # I7001 = 0, I7002 = 3
    begin = time.monotonic()
    with served("--free") as server, server.client() as client:
        client.command(f"I8000=0 I7000={max_phase}")
        clock, fetches, seen, told = ServoClock(client, period), 0, [], 0
        for stop in [at for at in (0, 2.6, 24, 48) if at < hours] + [hours]:
            passed = clock.hours()
            while passed < stop:
                for _ in range(10):  # half a second is what a fetch waits for when there is nothing
                    check(client.get_buffer() == b"\0", "nothing waits")
                    fetches += 1
                passed = clock.hours()
                # A minute more: what look_around does.
                check(fetches / 7200 <= passed < 2 * fetches / 7200 + 1 / 60, f"{fetches} fetches took {passed} h")
                if passed >= told + 1:
                    told = int(passed)
                    wall = time.monotonic() - begin
                    print(f"{told} h after {wall:.0f} s, {memory(server)} KiB", flush=True)
            seen.append(look_around(server, period))
            print(f"a client at {passed:.3f} h of servo interrupts: "
                  f"{'as before' if seen[-1] == seen[0] else seen[-1]}", flush=True)
            check(seen[-1] == seen[0], f"at {stop} h: {seen[-1]}, before {seen[0]}")
        check(clock.hours() >= hours, f"{clock.hours()} h, expected {hours}")


globals()[command.CASE]()
