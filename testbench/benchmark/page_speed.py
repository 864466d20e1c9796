"""What a browser with the page costs `brick serve`, and how old is what it shows, median of five. Not a test.

Eight axes move, following the wall; three socket clients poll them ten times a second and a fourth takes nothing of
the 90 KB that it has asked for. The share of the processor time is what the page says itself. A state's age is that of
its servo counter, X:$0, which a client asks for too.

usage: page_speed.py BRICK
"""
import bisect
import itertools
import pathlib
import re
import socket
import statistics
import subprocess
import sys
import threading
import time

TESTBENCH = pathlib.Path(__file__).resolve().parents[1]
sys.path += [str(TESTBENCH / "clients"), str(TESTBENCH / "unit/app")]
import turbo_pmac  # noqa: E402
from browser import Browser  # noqa: E402
from rows import row  # noqa: E402

ROUNDS, SECONDS, POLL_SECONDS = 5, 5, 0.1
AGE, SHARE = 0.5, 0.05  # seconds; of the processor time of the simulator
AXES = "".join(f"#{motor}?PVF" for motor in range(1, 9))
UNREAD, MEMORY = 64, b"\xc0\xb4\0\0\0\0\x05\x78"  # answers of 1400 bytes
SEE = """
window.states = [];
socket.addEventListener("message", event => {
  const state = JSON.parse(event.data), wall = performance.timeOrigin + performance.now();
  if (state.kind === "state" && state.watch["X:$0"] !== undefined)
    states.push({wall: wall / 1000, ms: state.ms, count: state.watch["X:$0"], cost: state.cost});
});
at("item").value = "X:$0";
at("add").requestSubmit();
"""


class Polls(threading.Thread):
    """A client that polls the axes; `seen`: times of the wall, and what the servo counter stood at."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.client, self.seen, self.ends = turbo_pmac.TurboPmac("127.0.0.1", port), [], False

    def run(self):
        while not self.ends:
            asked = time.time()
            self.seen.append((asked, int(self.client.command("RX$0 " + AXES).split()[0])))
            time.sleep(max(0, asked + POLL_SECONDS - time.time()))

    def age(self, wall, count):
        """At a time of the wall, of a count."""
        i = min(max(bisect.bisect(self.seen, count, key=lambda one: one[1]), 1), len(self.seen) - 1)
        (before, first), (after, last) = self.seen[i - 1:i + 1]
        return wall - before - (count - first) * (after - before) / (last - first)


def stalled(port):
    """A client that has asked, and takes no answer."""
    sock = socket.socket()
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    sock.connect(("127.0.0.1", port))
    sock.sendall(UNREAD * MEMORY)
    return sock


def measured(browser, address, polls):
    """Age of the oldest state when the next one came, share, states a second, simulated seconds a second."""
    browser.show(address)
    while browser.value("latest === null"):
        time.sleep(0.05)
    browser.value(SEE)
    time.sleep(SECONDS)
    states = browser.value("states")
    browser.show("about:blank")
    time.sleep(2 * POLL_SECONDS)
    first, last = states[0], states[-1]
    page, everything = (last["cost"][whose] - first["cost"][whose] for whose in ("page", "all"))
    wall = last["wall"] - first["wall"]
    ages = [polls.age(after["wall"], one["count"]) for one, after in itertools.pairwise(states)]
    return (max(ages), page / everything, (len(states) - 1) / wall, (last["ms"] - first["ms"]) / 1e3 / wall,
            page / (len(states) - 1))


def main():
    with subprocess.Popen([sys.argv[1], "serve", "--listen", "127.0.0.1:0", "--page", "127.0.0.1:0", "--plant", "dac8",
                           "--load", "dac8"], text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        try:
            port = int(re.search(r":(\d+),", process.stdout.readline())[1])
            address = process.stdout.readline().split()[-1]
            polls = [Polls(port) for _ in range(3)]
            for line in ("#{}J/", "#{}J+"):
                polls[0].client.command("".join(line.format(motor) for motor in range(1, 9)))
            with stalled(port), Browser() as browser:
                for one in polls:
                    one.start()
                time.sleep(5)
                rounds = [measured(browser, address, polls[0]) for _ in range(ROUNDS)]
                for one in polls:
                    one.ends = True
                    one.join()
        finally:
            process.terminate()
    age, share, rate, speed, state = (statistics.median(column) for column in zip(*rounds, strict=True))
    row("page, eight moving axes, five clients: age of its data", f"{age:.2f} s", f"<= {AGE} s", age <= AGE)
    row("  of the simulator's processor time", f"{100 * share:.1f} %", f"<= {100 * SHARE:.0f} %", share <= SHARE)
    row("  states a second", f"{rate:.1f}")
    row("  a state", f"{1e3 * state:.2f} ms")
    row("  simulated time of wall time", f"{speed:.2f}")


main()
