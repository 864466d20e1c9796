"""`brick serve` from outside: what clients of the Ethernet port are answered.

usage: serve_acceptance.py BRICK CASE; each CASE is one test.
"""
import itertools
import json
import os
import pathlib
import pty
import re
import select
import signal
import socket
import struct
import subprocess
import sys
import tempfile

import command
import recording
import served_exchanges
import turbo_pmac
from command import brick, check
from served import PATIENCE, packet, refused, served


def serve_requests():
    """The requests that every client uses."""
    with served("--free") as server, server.client() as client:
        check(client.identity == "1.947", client.identity)
        check(client.request(0x40, 0xBF, data=b"ver") == b"1.947\r\x06", "GETRESPONSE")
        check(client.flush() == b"@", "FLUSH")
        check(not client.ready(), "nothing waits")
        check(client.send_line("cid") == b"@", "SENDLINE")
        while not client.ready():
            pass
        check(client.get_buffer() == b"603382\r\x06", "GETBUFFER")
        check(not client.ready(), "it has been fetched")


# covers: CARD-3
def serve_exchanges():
    """The golden exchanges and every command of firmware:11, as `brick exec` plays them."""
    for name, least in (("golden.txt", 100), ("commands.txt", 100)):
        with served("--free") as server, server.client() as client:
            found, compared = served_exchanges.differences(client, name)
            check(not found, "\n".join(found))
            check(compared >= least, f"{name}: {compared} compared, expected {least} or more")


def serve_recordings():
    """Recorded exchanges, byte for byte, on a port that has not been used before."""
    for name, least in (("manual.txt", 14), ("habits.txt", 20)):
        with served("--free") as server, server.socket() as sock:
            count = recording.play(sock, name)
            check(count >= least, f"{name}: {count} replies, expected {least} or more")


def gather(client):
    """The servo counter into the dual-ported RAM at each servo interrupt, read from there; then in user memory."""
    for line in ("I5000=2 I5001=$400000 I5050=1 I5051=0 I5049=1", "DEFINE GATHER 20", "GATHER"):
        check(client.command(line) == "", line)
    while client.values("???")[0][1] == "8":  # bit 19; with --free time passes only while somebody asks
        pass
    size, place = struct.unpack("<HH", client.read_memory(0x113C, 4))
    samples = struct.unpack("<20i", client.read_memory(0x1140, 80))
    check((size, place) == (20, 20), f"size {size}, pointer {place}")
    check(all(b == a + 1 for a, b in itertools.pairwise(samples)), f"{samples}")
    for line in ("DELETE GATHER I5000=0", "DEFINE GATHER 10", "GATHER"):
        check(client.command(line) == "", line)
    while client.values("???")[0][1] == "8":
        pass
    check(len(client.values("LIST GATHER")) == 10, "samples in user memory")
    check(client.command("ENDGATHER DELETE GATHER") == "", "DELETE GATHER")


def serve_python_client():
    """A script's work: all variables read out, programs written and read back, jogs, SAVE, reset, a new connection."""
    lines = ["OPEN PROG 5 CLEAR", "RPD X10Y20", "DWELL 20", "CLOSE", "OPEN PLC 3 CLEAR", "P7=P7+1", "CLOSE"]
    with tempfile.TemporaryDirectory() as folder, served("--free", "--flash", f"{folder}/flash.bin") as server:
        with server.client() as client:
            for name, count in (("I", 8192), ("P", 8192), ("Q", 8192), ("M", 8192)):
                check(len(client.values(f"{name}0..{count - 1}")) == count, name)
            check(len(client.values("M0..8191->")) == 8192, "definitions")
            check(client.write_lines(lines) is None, "download")
            check(client.values("LIST PROG5") == ["RPD X10Y20", "DWE20", "RET"], "upload of a program")
            check(client.values("LIST PLC3") == ["P7=P7+1", "RET"], "upload of a PLC")
            check(client.write_lines(["P1=1", "P2=", "P3=3"]) == (2, 3), "the line that is refused")
            # No amplifier is connected, and the fault input reads 0 here.
            for jog in ("I124=$800001", "#1J+", "#1J-", "#1J=100", "#1J^5", "#1J/", "#1K"):
                check(client.command(jog) == "", jog)
            check(client.values("#1?") == ["850000000000"], "the motor stands")
            for jog in ("#2J+", "#2HM"):
                check(refused(client, jog) == "ERR013", f"{jog}: motor 2 is not activated")
            check(client.control("B").split()[0] == "850000000000", "^B")
            gather(client)
            check(client.command("I16=7 P100=2.5") == "" and client.command("SAVE") == "", "SAVE")
            check(client.command("I16=9 I3") == "2\r", "I16")
            check(client.request(0x40, 0xBF, data=b"$$$") in (b"\x06", b"\n"), "$$$ has an answer")
        with server.client() as client:
            check(client.values("I16 P100") == ["7", "2.5"], "what was SAVEd, on a new connection")
            check(client.values("LIST PROG5") == ["RPD X10Y20", "DWE20", "RET"], "and the program")


def serve_c_driver():
    """The driver in C: polls and long answers at once."""
    driver = pathlib.Path(command.BRICK).with_name("poll_driver")
    with served() as server:
        r = subprocess.run([driver, str(server.port), "20", "UUU", "P0..2000", "I0..9", "ver", "P1=1"], text=True,
                           capture_output=True, timeout=PATIENCE, check=False)
    check(r.returncode == 0, r.stderr)
    poll = "850000000000|0|0|0|" + "050000000000|0|0|0|" * 7
    said = r.stdout.splitlines()
    check(said.count(poll) == 20, f"{said.count(poll)} polls")
    answers = [line for line in said if line != poll]
    check(answers == ["!ERR003|", "0|" * 2001, "0|0|1|2|0|0|1|0|2|2|", "1.947|", ""], str(answers)[:500])


def serve_datagrams():
    """The same packets by UDP: one datagram, one reply."""
    with served("--free") as server, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        sock.settimeout(PATIENCE)
        sock.connect(("127.0.0.1", server.port))

        def ask(text):
            sock.send(text)
            return sock.recv(4096)
        check(ask(packet(0xBF, b"i6=1 i3=2 ver")) == b"1.947\r\x06", "ver")
        check(ask(packet(0xB5, b"abcd", value=0x1200)) == b"@", "SETMEM")
        check(ask(packet(0xB4, kind=0xC0, value=0x1200, length=4)) == b"abcd", "GETMEM")
        check(ask(packet(0xB0, b"cid")) == b"@" and ask(packet(0xC5, kind=0xC0)) == b"603382\r\x06", "the same client")
        for bad in (b"", b"x", packet(0xBF, b"ver")[:9], packet(0xD0), packet(0xBF, b"ver", length=1493)):
            sock.send(bad)  # lost
        check(ask(packet(0xBF, b"i16")) == b"5\r\x06", "after what is lost")


def serve_mailbox():
    """Lines through the dual-ported RAM, as a client does that knows only memory (host-bus:6)."""
    with served("--free") as server, server.client() as client:
        client.command("I58=1")

        def ask(line):
            client.write_memory(0x0EA0, line + b"\0")
            client.request(0xC0, 0xBA, value=0x0E9C, index=1, data=b"\1\0\0\0")
            lines = []
            for _ in range(20000):
                control, length = struct.unpack("<HH", client.read_memory(0x0F40, 4))
                if control == 0:
                    continue
                if control & 0x8000:
                    lines.append(f"ERR{control & 0xFFF:03X}")
                elif length > 1:
                    lines.append(client.read_memory(0x0F44, length - 1).rstrip(b"\0").decode("ascii"))
                client.write_memory(0x0F40, b"\0\0")
                if control != 0x0D:
                    return lines
            return lines + ["no end"]
        for line, expected in ((b"VER", ["1.947"]), (b"I16..17", ["5", "10"]), (b"UUU", ["ERR003"])):
            said = ask(line)
            check(said == expected, f"{line}: {said}, expected {expected}")
        check(client.values("ver") == ["1.947"], "and by lines as before")


def serve_ends():
    """SIGINT and SIGTERM end it with status 0 and the address kept beside the flash file; SAVE has written that, so
    that SIGKILL takes nothing away."""
    with tempfile.TemporaryDirectory() as folder:
        file = f"{folder}/flash.bin"
        for number, end in enumerate((signal.SIGINT, signal.SIGTERM), 20):
            with served("--flash", file) as server, server.client() as client:
                client.command(f"I16={number}")
                client.command("SAVE")
                address = struct.pack("4B", 10, 1, 2, number)
                check(client.request(0x40, 0xE0, data=address) == address, "IPADDRESS")
                said = server.end(end)
                check(re.search(rf"stopped by {end.name} after \d+\.\d+ ms", said), said)
                check(client.socket.recv(1) == b"", "the connection is closed")
            with served("--free", "--flash", file) as server, server.client() as client:
                check(client.values("I16") == [str(number)], f"{end.name}: SAVEd")
                check(client.request(0xC0, 0xE0) == address, f"{end.name}: address")
        with served("--flash", file) as server, server.client() as client:
            check(client.command("I16=30") == "" and client.command("SAVE") == "", "SAVE")
            server.process.kill()
            server.process.wait()
        with served("--free", "--flash", file) as server, server.client() as client:
            check(client.values("I16") == ["30"], "SIGKILL: SAVEd")
        check(sorted(os.listdir(folder)) == ["flash.bin", "flash.bin.address"], os.listdir(folder))
        results = pathlib.Path(folder, "results.json")
        with served("--free", "--flash", file, "--json", str(results)) as server, server.client() as client:
            (pathlib.Path(folder) / "flash.bin.address.new").mkdir()  # where it would be written
            client.request(0x40, 0xE0, data=struct.pack("4B", 10, 1, 2, 99))
            for number in range(999):  # nobody reads what it says meanwhile
                address = struct.pack(">I", number)
                check(client.request(0x40, 0xE0, data=address) == address, f"IPADDRESS {number}")
            said = re.findall(r"flash\.bin\.address: cannot be written, the address is lost.*", server.end())
            check(len(said) == 4 and said[3].endswith("(1000 times so far)"), f"a lost address: {said}")
        made = json.loads(results.read_text())
        for option, name in (("--wave", "w.vcd"), ("--record", "r.csv")):
            full = pathlib.Path(folder, name)
            full.symlink_to("/dev/full")
            with served("--free", option, str(full)) as server, server.client() as client:
                said = ""
                while "the run goes on" not in said:
                    check(client.get_buffer() == b"\0", "half a second of simulated time")
                    if select.select([server.process.stderr], [], [], 0)[0]:
                        said += server.process.stderr.readline()
                check("No space left on device" in said and name in said, said)
                check(client.values("I16") == ["5"], f"{option}: it answers")
                said = server.end(status=1)
                check(said.count("No space left on device") == 1 and "stopped by SIGTERM" in said, said)
            full.unlink()
        check(made["passed"] and all(key in made for key in ("build", "image", "command")), str(made.keys()))
        for bad in ("somewhere\n", "", "999.1.2.3\n", "1,2,3,4\n", "-1.2.3.4\n", "1.2.3.4.5\n", "1.2.3.256\n"):
            (pathlib.Path(folder) / "flash.bin.address").write_text(bad, encoding="ascii")
            r = brick("serve", "--listen", "127.0.0.1:0", "--flash", file)
            check(r.returncode == 2 and "flash.bin.address: is no address; expected" in r.stderr, f"{bad}: {r.stderr}")


def serve_without_acknowledge():
    """With I3=0 nothing says that a line has been read, and still nobody waits for half a second."""
    with served("--free") as server, server.client() as client, server.client() as other:
        def ask(line, who=client):
            return who.request(0x40, 0xBF, data=line)

        def servo_cycles():
            return int(ask(b"M1").strip(b"\r\x06"))
        check(ask(b"M1->X:$0,0,24 P1=5") == b"\x06", "I3=2")
        check(ask(b"I3=0") in (b"\0", b"\x06"), "I3=0")
        begin = servo_cycles()
        for number in range(20):
            check(ask(b"P1=%d" % number) == b"\0", "nothing is answered")
            check(ask(b"P1", other) == b"%d\r" % number, "a value")
        check(ask(b"frob") == b"\x07ERR003\r", "an error")
        check(client.request(0x40, 0xC6, data=b"P1=7\0P2=8") == bytes(4), "two lines are taken")
        check(ask(b"P1..2", other) == b"7\r8\r", "both")
        took = (servo_cycles() - begin) % (1 << 24) / 2258.5
        check(took < 0.2, f"45 lines take {took:.3f} s, one 0.5 s when it is waited for")
        check(ask(b"I3=2") in (b"\0", b"\x06") and ask(b"P1") == b"7\r\x06", "and as before")
        check(not client.ready() and not other.ready(), "nothing is left over")


def serve_terminal():
    """On a terminal a line shows time and clients; results and waveform are written at the end."""
    with tempfile.TemporaryDirectory() as folder:
        results, wave = pathlib.Path(folder) / "results.json", pathlib.Path(folder) / "wave.vcd"
        screen, errors = pty.openpty()
        server = subprocess.Popen([command.BRICK, "serve", "--listen", "127.0.0.1:0", "--json", str(results), "--wave",
                                   str(wave), "--wave-to", "1ms"], stdout=subprocess.PIPE, stderr=errors, text=True)
        os.close(errors)
        port = int(re.search(r":(\d+),", server.stdout.readline())[1])
        shown = ""
        with turbo_pmac.TurboPmac("127.0.0.1", port) as client:
            check(client.values("I16") == ["5"], "an answer")
            while "1 of 64 clients" not in shown:
                shown += os.read(screen, 4096).decode()
        check(re.search(r"serve: \d+\.\d ms simulated, \d+\.\d M ticks/s, 1 of 64 clients", shown), shown)
        server.send_signal(signal.SIGTERM)
        check(server.wait(PATIENCE) == 0, "exit status")
        report = json.loads(results.read_text(encoding="utf-8"))
        check(report["passed"] and report["seed"] == 1 and report["simulated_ns"] > 0, str(report))
        check("$var" in wave.read_text(encoding="utf-8"), "waveform")


def serve_contention():
    """Two ICs drive the clocks, an event at each tick: what is asked is answered as soon as else, who fetches nothing
    waits for half a second of the wall, which is little of the simulation, and the end comes at once."""
    said = []
    for options in (["--free"], []):
        with served(*options) as server:
            with server.client() as client:
                for line in ("M1->X:$0,0,24", "I7100=0", "I7107=0"):  # M1 counts servo interrupts, 443 us
                    check(client.command(line) == "", line)
                if options:  # time passes only while a client waits
                    begin = int(client.values("M1")[0])
                    for _ in range(20):
                        check(client.values("P1") == ["0"], "the controller answers")
                    passed = (int(client.values("M1")[0]) - begin) * 0.443
                    # Half a millisecond until it is taken up, as much for the answer, 0.2 ms for the characters.
                    check(0 < passed <= 21 * 1.2, f"21 answers take {passed:.1f} ms of simulated time")
                else:
                    check(client.get_buffer() == b"\0", "nothing waits; from now on it is known how slow it is")
                    used = server.processor_seconds()
                    check(client.get_buffer() == b"\0", "nothing waits")
                    used = server.processor_seconds() - used
                    check(used < 1.5, f"a fetch of nothing takes {used:.1f} s of the processor")
                    used = server.processor_seconds()
                    check(client.values("P1") == ["0"], "and the controller answers")
                    used = server.processor_seconds() - used
                    check(used < 1.5, f"P1 takes {used:.1f} s of the processor")
            said.append(server.end(status=1))
    check(all("clock contention" in text for text in said), str(said))


def serve_clients_help():
    """The clients say how they are used, and what is wrong with a place."""
    clients = pathlib.Path(turbo_pmac.__file__).parent
    python = [sys.executable, str(clients / "turbo_pmac.py")]
    driver = [str(pathlib.Path(command.BRICK).with_name("poll_driver"))]
    for program, word in ((python, "HOST:PORT"), (driver, "PORT POLLS LINE")):
        for option in ("--help", "-h"):
            r = subprocess.run([*program, option], text=True, capture_output=True, timeout=PATIENCE, check=False)
            check(r.returncode == 0 and r.stderr == "" and word in r.stdout, f"{program} {option}: {r}")
    for arguments in (["1025"], ["127.0.0.1:"], ["127.0.0.1:66000"], [":1025"], ["127.0.0.1:x"]):
        r = subprocess.run([*python, *arguments], text=True, capture_output=True, timeout=PATIENCE, check=False)
        check(r.returncode == 2 and "expected HOST:PORT" in r.stderr, f"{arguments}: {r}")
    r = subprocess.run(driver, text=True, capture_output=True, timeout=PATIENCE, check=False)
    check(r.returncode == 1 and "expected PORT POLLS LINE" in r.stderr, str(r))


def serve_bad_input():
    """One line that says what was expected, exit status 2; 1 where the controller does not start."""
    with served("--free") as server:
        for arguments, what in (
                (["--listen", "1025"], "--listen 1025: is no place"),
                (["--listen", "127.0.0.1:65536"], "is no place"),
                (["--listen", "127.0.0.1:"], "is no place"),
                (["--listen", ":1025"], "is no place"),
                (["--listen", "192.0.2.1:0"], "--listen 192.0.2.1:0: "),
                (["--listen", f"127.0.0.1:{server.port}"], "Address already in use"),
                (["--free", "--realtime"], "--realtime"),
                (["--engine", "verilog"], "verilog"),
                (["--board", "nothing"], "nothing"),
                (["--flash", "/none/flash.bin"], "/none"),
        ):
            r = brick("serve", *arguments)
            check(r.returncode == 2 and r.stdout == "", f"{arguments}: exit {r.returncode}: {r.stdout}{r.stderr}")
            check(r.stderr.count("\n") == 1 and what in r.stderr and "expected" in r.stderr, f"{arguments}: {r.stderr}")
    with tempfile.TemporaryDirectory() as folder:
        file = f"{folder}/flash.bin"
        check(command.play(["I17=33 I8=0 I7100=20 I7101=0 I7102=0 I19=7107", "SAVE"], "--flash", file).returncode == 0,
              "settings that stop the controller")
        r = brick("serve", "--listen", "127.0.0.1:0", "--flash", file)
        check(r.returncode == 1 and "does not answer after power-on: nothing in " in r.stderr, r.stderr)


def serve_engines():
    """The same bytes from each engine and from boards whose host is at the end of another bus."""
    for options in (["--engine", "rtl"], ["--engine", "lockstep"], ["--board", "turbo-pmac2-pci-lite"],
                    ["--board", "pmac-pc"]):
        with served("--free", *options) as server, server.client() as client:
            check(client.identity == "1.947", f"{options}: {client.identity}")
            check(client.write_memory(0x1201, b"hello") == b"@", options)
            check(client.read_memory(0x1200, 8) == b"\0hello\0\0", options)
            check(client.values("P1=5 P1 P2") == ["5", "0"], options)


globals()[command.CASE]()
