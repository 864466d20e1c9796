"""The built command with a debugger attached. usage: attached.py BRICK CASE; status 77: not possible here."""
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "app"))
import faulty_image

BRICK, CASE = sys.argv[1], sys.argv[2]
FIRMWARE = pathlib.Path(BRICK).parent / "turbo.elf"
LINES = ["VERSION", "I16", "P1=3", "P1", "&2DEFINE ROTARY 50", "@wait 2ms", "UUU", "@pic"]
SCRIPT = "".join(f"{line}\n@time\n" for line in LINES)


def check(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


class Run:
    """`brick exec --gdb 0` that waits for its debugger."""

    def __init__(self, *options, script=SCRIPT):
        self.process = subprocess.Popen([BRICK, "exec", "--gdb", "0", *options, "-"], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.process.stdin.write(script)
        self.process.stdin.close()
        self.process.stdin = None
        line = self.process.stderr.readline()
        found = re.fullmatch(r"gdb: waiting on 127\.0\.0\.1:(\d+)\n", line)
        check(found, f"first line {line!r}")
        self.port = int(found.group(1))

    def end(self):
        out, err = self.process.communicate(timeout=60)
        return self.process.returncode, out, err


class Debugger:
    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=60)
        self.stream = self.socket.makefile("rb")

    def send(self, data):
        self.socket.sendall(f"${data}#{sum(data.encode()) & 255:02x}".encode())

    def reply(self):
        data, c = b"", self.stream.read(1)
        while c not in (b"$", b""):
            c = self.stream.read(1)
        while (c := self.stream.read(1)) not in (b"#", b""):
            data += c
        self.stream.read(2)
        return data.decode()

    def ask(self, data):
        self.send(data)
        return self.reply()


def symbol(name):
    names = subprocess.run(["riscv64-unknown-elf-nm", FIRMWARE], capture_output=True, text=True, check=True).stdout
    return next(int(line.split()[0], 16) for line in names.splitlines() if line.split()[-1] == name)


def same_results():
    """Every reply and its time: without a debugger, continued only, stopped at each line, stepped, on two engines."""
    plain = subprocess.run([BRICK, "exec", "-"], input=SCRIPT, capture_output=True, text=True, timeout=60)
    check(plain.returncode == 0 and plain.stdout.count("time=") == 8, plain.stdout + plain.stderr)
    stop_at = f"Z0,{symbol('acknowledge'):x},2"
    for engine in ("systemc", "rtl"):
        for way in ("continue", "breakpoint", "steps", "never reached"):
            run = Run("--engine", engine)
            debugger = Debugger(run.port)
            stops = 0
            if way == "steps":
                for _ in range(200):
                    check(debugger.ask("s").startswith("T05"), "step")
            if way == "breakpoint":
                check(debugger.ask(stop_at) == "OK", "breakpoint")
            if way == "never reached":
                for packet in ("Z2,20000000,1", "Z0,0,2", "z2,20000000,1"):
                    check(debugger.ask(packet) == "OK", f"{way}: {packet}")
            while (stop := debugger.ask("c")).startswith("T05"):
                stops += 1
            check(stop == "W00", f"{engine}, {way}: ended with {stop!r}")
            check((stops >= 6) == (way == "breakpoint"), f"{engine}, {way}: {stops} stops")
            status, out, err = run.end()
            check(status == 0, f"{engine}, {way}: status {status}: {err}")
            check(out == plain.stdout, f"{engine}, {way}:\n{out}\nexpected:\n{plain.stdout}")


def bad_port():
    taken = socket.socket()
    taken.bind(("127.0.0.1", 0))
    taken.listen()
    for port in (str(taken.getsockname()[1]), "70000", "-1", "x", ""):
        for command in (["exec", "-"], ["run", "smoke"]):
            r = subprocess.run([BRICK, *command, f"--gdb={port}"], input="I16\n", capture_output=True, text=True,
                               timeout=60)
            check(r.returncode == 2, f"{command} {port}: status {r.returncode}: {r.stderr}")
            check(r.stderr.count("\n") == 1 and "--gdb" in r.stderr, f"{command} {port}: {r.stderr!r}")


def kill():
    run = Run()
    Debugger(run.port).send("k")
    status, out, err = run.end()
    check(status == 1 and "killed by the debugger" in err and out == "", f"{status} {out!r} {err!r}")


def break_byte():
    """Breaks in while the whole controller runs, mostly asleep; time stands until it goes on."""
    run = Run(script="@wait 1000s\n")
    debugger = Debugger(run.port)
    for _ in range(3):
        debugger.send("c")
        time.sleep(0.2)
        debugger.socket.sendall(b"\x03")
        check(debugger.reply() == "T02thread:1;", "stop by the break byte")
        first = debugger.ask("qRcmd,74696d65")
        time.sleep(0.1)
        check(debugger.ask("qRcmd,74696d65") == first, "time goes on while stopped")
        check(re.fullmatch(r"\d+ ns\n", bytes.fromhex(first).decode()), first)
    debugger.send("k")
    check(run.end()[0] == 1, "kill")


def gdb_session():
    gdb = shutil.which("gdb-multiarch")
    if gdb is None:
        print("gdb-multiarch is not installed: no session with it")
        sys.exit(77)
    run = Run()
    commands = [f"target remote 127.0.0.1:{run.port}", "print/x $pc", "break acknowledge", "continue", "bt",
                "info locals", "print style_before", "stepi", "next", "monitor time", "print *(int*)0xC03C0000",
                "delete", "watch current", "continue", "delete", "detach"]
    session = subprocess.run([gdb, "-nx", "-batch", *[x for c in commands for x in ("-ex", c)], str(FIRMWARE)],
                             capture_output=True, text=True, timeout=60)
    text = session.stdout + session.stderr
    for expected in (r"\$1 = 0x10000000\n", r"\nBreakpoint 1, acknowledge \(",
                     r"\n#0 +acknowledge \(.*\n#1 .*\n(.*\n)*#\d .*image_main", r"\$2 = \d",
                     r"\n\d+ ns\n", r"Cannot access memory at address 0xc03c0000",
                     r"Hardware watchpoint 2: current\n\nOld value = \d+\nNew value = \d+\n", r"detached"):
        check(re.search(expected, text), f"no {expected!r} in:\n{text}")
    status, out, err = run.end()
    check(status == 0 and out.startswith("1.947\n"), f"after the session: status {status}: {out} {err}")


def exception():
    """The firmware raises one: the debugger sees which, and where; the run goes on and fails."""
    with tempfile.TemporaryDirectory() as folder:
        pc = symbol("card")
        image = faulty_image.with_words(folder, "card", faulty_image.ILLEGAL)
        run = Run("--firmware", image, script="CID\n@wait 50ms\n")
        debugger = Debugger(run.port)
        said = bytes.fromhex(debugger.ask("c")[1:]).decode()
        expected = rf"exception of the CPU: illegal instruction 0xffffffff, pc {pc:#010x} \(card\), at \d+\.\d+ ms\n"
        check(re.fullmatch(expected, said), f"console: {said!r}")
        check(debugger.reply() == "T04thread:1;", "SIGILL")
        check(int.from_bytes(bytes.fromhex(debugger.ask("p20")), "little") == symbol("trap_vector"), "pc")
        check(int.from_bytes(bytes.fromhex(debugger.ask("p382")), "little") == pc, "mepc")
        check(debugger.ask("c") == "W00", "the firmware restarts")
        status, _, err = run.end()
        check(status == 1 and re.search("^brick exec: " + expected[:-2], err, re.M), f"{status} {err!r}")


CASES = (same_results, bad_port, kill, break_byte, gdb_session, exception)
{case.__name__: case for case in CASES}[CASE]()
