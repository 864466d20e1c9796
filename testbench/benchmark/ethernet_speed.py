"""Speed of `brick serve` as a client sees it: round trips of short commands, and what polling costs. Not a test.

usage: ethernet_speed.py BRICK
"""
import pathlib
import re
import statistics
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "clients"))
import turbo_pmac
from rows import row

AXES = "".join(f"#{motor}?PVF" for motor in range(1, 9))
ROUNDS, SECONDS = 2000, 10


def processor_time(process):
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100


def round_trips(client, line):
    times = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        client.command(line)
        times.append(time.perf_counter() - begin)
    times.sort()
    return statistics.median(times) * 1e3, times[ROUNDS * 99 // 100] * 1e3


def polls(process, client):
    """Processor seconds a second while eight axes are polled ten times a second, or nothing is asked."""
    begin, used = time.monotonic(), processor_time(process)
    for number in range(SECONDS * 10 if client else 1):
        if client:
            client.command(AXES)
        time.sleep(max(0, begin + ((number + 1) * 0.1 if client else SECONDS) - time.monotonic()))
    return (processor_time(process) - used) / (time.monotonic() - begin)


def main():
    with subprocess.Popen([sys.argv[1], "serve", "--listen", "127.0.0.1:0"], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE) as process:
        port = int(re.search(r":(\d+),", process.stdout.readline())[1])
        begin = time.monotonic()
        with turbo_pmac.TurboPmac("127.0.0.1", port) as client:
            for what, line, goal in (("a short command, #1P", "#1P", 2), ("eight axes in one line", AXES, None)):
                middle, late = round_trips(client, line)
                row(f"serve, round trip of {what}", f"{middle:.2f} ms", f"<= {goal} ms" if goal else "",
                    goal is None or middle <= goal)
                row("  99 of 100", f"{late:.2f} ms")
            load = polls(process, client)
            row("serve, eight axes ten times a second, of one processor", f"{100 * load:.1f} %", "<= 100 %", load <= 1)
        row("  nobody connected", f"{100 * polls(process, None):.1f} %")
        wall = time.monotonic() - begin
        process.terminate()
        simulated = float(re.search(r"after (\S+) ms", process.communicate()[1])[1]) / 1e3
        row("  simulated time of wall time", f"{simulated / wall:.3f}", ">= 1.000", simulated >= wall - 0.03)


main()
