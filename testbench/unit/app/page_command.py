"""The page of `brick serve --page`, spoken to by hand: what it shows is what the controller answers, it disturbs
nothing, and strangers do not get it.

usage: page_command.py BRICK CASE; each CASE is one test.
"""
import contextlib
import json
import pathlib
import random
import re
import signal
import struct
import tempfile
import time

import command
from command import check
from page_client import ServedPage, frame, head, status_of
from served import PATIENCE, Served, ended, packet

SPEC = command.REPOSITORY / "docs/datasheet/firmware.md"
SITE = command.REPOSITORY / "app" / "page" / "site"


def served_page(*options, **keywords):
    return ended(ServedPage(*options, **keywords))


def words(text, count):
    """The status words of an answer, six digits each."""
    check(len(text) == 6 * count, f"{text!r}: expected {count} words")
    return [int(text[6 * i:6 * i + 6], 16) for i in range(count)]


def page_moves():
    """A motor is seen to move: the page is fetched with its token, and the position goes where a line sends it. Also
    for an installed command (tools/packages.py)."""
    with served_page("--plant", "dac8", "--load", "dac8") as server, server.open() as page:
        status, body = server.get()
        check(status == 200 and "<title>brick</title>" in body, f"the page: {status}")
        page.command("#1J/")
        before = page.state()["motors"][0]["position"]
        check(abs(before) < 10, f"it stands at {before}")
        page.command("#1J:4000")
        page.state(lambda s: 100 < s["motors"][0]["position"] < 3900, "on its way")
        page.state(lambda s: abs(s["motors"][0]["position"] - 4000) < 10, "at its end")


def page_shows():
    """Each number of the page is what the controller answers: `?`, `??`, `???`, P, %, PR, LIST PE, I-variables."""
    lines = ["OPEN PROG 5 CLEAR", "LINEAR ABS TA50 TS20 TM400", "X4 Y-2", "DWELL20000", "CLOSE", "#1J=300 #2J/"]
    with served_page("--free", "--plant", "dac8", "--load", "dac8") as server, server.client() as client:
        check(client.write_lines(lines) is None, "lines")
        client.write_lines(["#3K", "I16=3", "I17=7", "&2DEFINE ROTARY 200", "&2OPEN ROTARY"] +
                           [f"&2DWELL{n}" for n in range(1, 10)] + ["CLOSE"])
        client.values("&1A")
        while not int(client.values("&1??")[0], 16) >> 24 + 17 & 1:
            pass
        client.values("&1B5R")
        while not int(client.values("#1?")[0], 16) >> 24 + 15 & 1:  # dwells: nothing moves any more
            pass
        client.values("&1%50")  # it goes there at Isx94, to the whole number of I10's parts that is next to it
        part = 100 / float(client.values("I10")[0])
        while abs(float(client.values("&1%")[0]) - 50) > part:
            pass
        wanted = {motor: words(client.values(f"#{motor}?")[0], 2) for motor in range(1, 9)}
        systems = {cs: words(client.values(f"&{cs}??")[0], 3) for cs in (1, 2)}
        everything = words(client.values("???")[0], 2)
        places = {motor: [float(client.values(f"#{motor}{what}")[0]) for what in "PF"] for motor in (1, 2)}
        executing, line = client.values("&1PE")[0], client.values("LIST PE")[0]
        feed, lines_left = float(client.values("%")[0]), int(client.values("&2PR")[0])
        ring_line, sizes = client.values("LIST PC")[0], client.values("I16 I17 I19 I10 I52 I40")
        client.values("&1")
        page = server.open()
        about = page.receive()
        check(about["kind"] == "about" and about["board"] == "geobrick-lv-8" and not about["read_only"], str(about))
        page.send({"kind": "watch", "items": ["host.breq", "X:$0", "frob", "motor1.actual"]})
        state = page.state(lambda s: len(s["watch"]) == 4, "watch list")
        page.sock.close()
        motors = {m["number"]: m for m in state["motors"]}
        check(sorted(motors) == list(range(1, 9)), f"motors {sorted(motors)}")
        for motor, status in wanted.items():
            check(motors[motor]["status"] == status, f"#{motor}?: page {motors[motor]['status']}, controller {status}")
        for motor, (place, error) in places.items():
            shown = motors[motor]
            check(abs(shown["position"] - place) <= 2 and abs(shown["error"] - error) <= 2,
                  f"motor {motor}: {shown['position']} {shown['error']}, controller {place} {error}")
        shown = {s["number"]: s for s in state["systems"]}
        for cs, status in systems.items():
            check(shown[cs]["status"] == status, f"&{cs}??: page {shown[cs]['status']}, controller {status}")
        check(state["global"] == everything, f"???: {state['global']}, controller {everything}")
        check(shown[1]["line"]["at"] == executing, f"PE: {shown[1]['line']}, controller {executing}")
        check(line.endswith(":" + shown[1]["line"]["text"]), f"LIST PE: {shown[1]['line']}, controller {line}")
        check(abs(feed - 50) <= part and shown[1]["feed"] == round(feed, 4), f"%: {shown[1]}, controller {feed}")
        check(shown[2]["lines"] == lines_left == 9 and shown[2]["words"] + shown[2]["room"] in (199, 200),
              f"{shown[2]}, PR {lines_left}")
        check(ring_line.endswith(":" + shown[2]["line"]["text"]), f"LIST PC: {shown[2]['line']}, {ring_line}")
        request, clocks = state["request"], state["clocks"]
        check([str(n) for n in (request["i16"], request["i17"], clocks["i19"], clocks["i10"], clocks["i52"],
                                state["watchdog"]["reload"])] == sizes[:5] + [sizes[5] if sizes[5] != "0" else "4095"],
              f"{request} {clocks} {state['watchdog']}: {sizes}")
        # Coordinate system 1 has no rotary buffer: low (host-bus:5.7/1).
        check(request["selected"] == 1 and request["breq"] == state["watch"]["host.breq"] == 0, str(request))
        # The factory's clocks (firmware:1, host-bus): 9.03 and 2.26 kHz, CPU clock of I52.
        check(abs(clocks["phase_khz"] - 9.0346) < 0.01 and abs(clocks["servo_khz"] - 8388608 / 3713991) < 0.001,
              str(clocks))
        check(clocks["source"] == clocks["i19"] == 7007, str(clocks))
        check(abs(clocks["cpu_mhz"] - 117.9648 * (clocks["i52"] + 1) / 12) < 0.01, str(clocks))
        tasks = state["tasks"]
        check(0 < tasks["phase"]["load"] < tasks["servo"]["load"] < 1 and 0 < tasks["asleep"] < 1, str(tasks))
        check(0 < state["watchdog"]["lowest"] <= state["watchdog"]["count"] <= 4095, str(state["watchdog"]))
        check("no such signal" in state["watch"]["frob"], state["watch"]["frob"])
        check(0 < state["cost"]["page"] < state["cost"]["all"], str(state["cost"]))
        check(abs(state["watch"]["motor1.actual"] - motors[1]["position"]) <= 2, str(state["watch"]))


def page_tasks():
    """Loads as the controller defines them: a duration less the tasks that interrupted it (firmware:8.1)."""
    with served_page("--free", "--plant", "servo8", "--load", "servo8") as server, server.client() as client:
        # A phase period of two thirds, in which the servo task does not end.
        client.write_lines(["I7000=4351 I7002=5", *(f"#{motor}J/" for motor in range(1, 9))])
        t, n, i8 = (int(client.values(what)[0]) for what in ("RX$FFFF8C", "I7002", "I8"))
        with server.open() as page:
            page.send({"kind": "watch", "items": ["X:$37", "Y:$37", "X:$B", "Y:$B", "Y:$25", "X:$25"]})
            page.state(lambda s: len(s["watch"]) == 6, "watch list")
            interrupted = 0
            for _ in range(10):
                client.values("P1..40")
                state = page.state()
                p, s, r, longest = (int(state["watch"][word]) for word in ("X:$37", "Y:$37", "X:$B", "Y:$B"))
                own = s - s // t * p
                rest = r - r // t * p - r // ((n + 1) * t) * own
                loads = p / t, own / ((n + 1) * t), rest / ((n + 1) * t * (i8 + 1))
                for task, load in zip(("phase", "servo", "real_time"), loads, strict=True):
                    shown = state["tasks"][task]["load"]
                    check(abs(shown - load) <= 1e-4, f"{task}: {shown}, expected {load}: {state['watch']}, T {t}")
                halves = state["clocks"]["cpu_mhz"] / 2  # in a microsecond
                tasks = state["tasks"]
                for shown, half in ((tasks["servo"]["us"], s), (tasks["real_time_longest_us"], longest)):
                    check(abs(shown - half / halves) < 0.01, f"{shown} us, {half} halves of a cycle")
                interrupted += s > t
            check(interrupted > 0, "a servo task that is interrupted")


def page_full():
    """The four views of a rotary buffer that fills: ??, PR, BREQ, IR1 of the interrupt controller."""
    with served_page("--free") as server, server.client() as client, server.open() as page:
        client.write_lines(["I16=3", "I17=5", "&1DEFINE ROTARY 200", "OPEN ROTARY"])
        for count in range(1, 8):
            client.command(f"DWELL{count}")
            state = page.state(lambda s, n=count: s["systems"][0]["lines"] == n, f"PR {count}")
            full = state["systems"][0]["status"][1] >> 16 & 1
            check(full == (count >= 5), f"{count} lines: Full {full}, I17 is 5")
            levels = state["request"]["sig"] >> 1 & 1
            check(state["request"]["breq"] == levels == 1 - full, f"{count} lines: {state['request']}")


def status_names():
    """Each bit of the data sheet's tables of status words has its name on the page, and no other has one."""
    text = SPEC.read_text()
    site = (SITE / "status.js").read_text()
    tables = re.split(r"\n    (?=\[)", site)[1:]
    check(len(tables) == 7, f"{len(tables)} tables")
    # What the name says, or part of it: by hand, from firmware:5.2 to firmware:5.8. Fields by highest and lowest bit;
    # the rows of axes in firmware:5.4 are made by a function.
    wanted = [
        {23: "activated", 22: "negative limit", 21: "positive limit", 20: "extended", 19: "amplifier enabled",
         18: "open loop", 17: "known length", 16: "at rest", 15: "dwell", 14: "late", 13: "velocity zero", 12: "abort",
         10: "trigger", 9: "user phase", 8: "user servo", 7: "alternate source", 6: "phased", 5: "offset mode",
         4: "following", 3: "error trigger", 2: "software capture", 1: "integrator", 0: "alternate output"},
        {(23, 20): "coordinate system", (19, 16): "axis", 15: "assigned", 14: "amplifier enabled", 13: "servo task",
         12: "desired position limit", 11: "stopped on a limit", 10: "home complete", 9: "searched", 8: "missing",
         7: "trigger", 6: "integrated", 5: "overload", 4: "backlash", 3: "amplifier fault", 2: "fatal", 1: "warning",
         0: "in position"},
        {5: "vector", 4: "continuous", 3: "time", 2: "blended", 1: "single step", 0: "runs"},
        {23: "lookahead", 22: "run-time error", 20: "amplifier fault", 19: "fatal", 18: "warning", 17: "in position",
         16: "Rotary Buffer Full", 14: "end of the block", 12: "dwell", 7: "segments", (4, 0): "mode"},
        {23: "written over", 22: "backwards", 21: "oldest", 20: "wait", 19: "lost", (11, 8): "Isx21",
         6: "sharp corner", 5: "pause", 3: "radius", 2: "refused", 1: "limit", 0: "matching"},
        {22: "real-time", 20: "servo task", 19: "gathered", 14: "compensation", 10: "damaged", 9: "late", 7: "ICs",
         3: "no phase clock"},
        {23: "Ultralite", 20: "binary rotary", 19: "motion buffer", 18: "rotary buffers open", 17: "PLC buffer",
         16: "UMAC", 15: "forward", 14: "inverse", 11: "Fixed Buffer Full"}]
    for section, table, names in zip(range(2, 9), tables, wanted, strict=True):
        found = {int(high) if high == low else (int(high), int(low)): name
                 for high, low, name in re.findall(r"\[(\d+), (\d+), \"([^\"]*)\"", table)}
        check(found.keys() == names.keys(), f"firmware:5.{section}: bits {found.keys() ^ names.keys()}")
        for number, name in names.items():
            check(name in found[number], f"firmware:5.{section}/{number}: {found[number]!r}, expected {name!r}")
        rows = text.partition(f"\n### 5.{section} ")[2].partition("\n#")[0]
        listed = {int(number) for number in re.findall(r"^\| (\d+)", rows, re.M)}
        highest = {bit if isinstance(bit, int) else bit[0] for bit in names} | ({23} if section == 4 else set())
        check(listed <= highest, f"firmware:5.{section}: the data sheet has {listed - highest} too")
        check(section != 8 or listed >= {17, 18, 19, 20}, "firmware:5.8: buffers that are open")


def page_disturbs_nothing():
    """With --free and one scripted client replies and waveform are the same with the page open and without, byte for
    byte, whatever the page shows and watches."""
    script = ["#1J/", "#1J+", *(f"#1PVF#2P#{n % 8 + 1}?" for n in range(40)), "#1J/", "&1??", "???",
              *("#1?" for _ in range(20)), "frob", "I100..110"]
    def play(folder, with_page):
        wave = pathlib.Path(folder) / f"{with_page}.vcd"
        options = ("--free", "--plant", "dac8", "--load", "dac8", "--wave", str(wave), "--trace",
                   "host.*,servo_ic0.ch1.*")
        server = ServedPage(*options) if with_page else Served(*options)
        answers = []
        with contextlib.ExitStack() as stack:
            if with_page:
                page = stack.enter_context(server.open())
                page.send({"kind": "watch", "items": ["X:$0", "host.breq", "D:$88", "plant.axis1.position"]})
            with server.socket() as sock:
                for line in script:
                    sock.sendall(packet(0xBF, line.encode()))
                    answers.append(sock.recv(4000))
                    if with_page:
                        check(page.state()["motors"], "motors")
        server.end()
        return answers, wave.read_bytes()
    with tempfile.TemporaryDirectory() as folder:
        alone, watched = play(folder, False), play(folder, True)
        for line, one, other in zip(script, alone[0], watched[0], strict=True):
            check(one == other, f"{line}: {one!r} without, {other!r} with the page")
        check(len(alone[1]) > 10000, "a waveform with something in it")
        # How far the controller goes on behind the last answer is when the signal comes that ends it.
        end = min(len(alone[1]), len(watched[1]))
        end = max(wave[1][:end].rindex(b"\n#") for wave in (alone, watched) if len(wave[1]) == end)
        check(alone[1][:end] == watched[1][:end], "the waveforms differ")


def page_commands():
    """Buttons and terminal are a client: what is asked is answered, refused, long, and in order, however I3 is."""
    with served_page("--free") as server, server.open() as page:  # the factory's I3, and no other client
        check(page.command("ver")["lines"] == ["1.947"], "ver of a new controller")
    with served_page("--free", "--plant", "dac8", "--load", "dac8") as server, server.open() as page:
        check(page.command("ver")["lines"] == ["1.947"], "ver")
        answer = page.command("frob")
        check(answer["refused"] and answer["lines"] == ["ERR003"], str(answer))
        check(page.command("P1..300=7")["lines"] == [] and page.command("P1..300")["lines"] == ["7"] * 300, "300 lines")
        for framing in (0, 1, 3, 2):  # firmware:6.2
            page.command(f"I3={framing}")
            answers = [page.command(line)["lines"] for line in ("ver", "P1=5", "P1 P2", "frob")]
            check(answers == [["1.947"], [], ["5", "7"], ["ERR003"]], f"I3={framing}: {answers}")
        for number in range(16):
            page.send({"kind": "command", "id": 100 + number, "line": f"P({number}*2)={number} P{number * 2}"})
        for number in range(16):
            answer = page.until(lambda m: m["kind"] == "answer", "answer")
            check((answer["id"], answer["lines"]) == (100 + number, [str(number)]), str(answer))
        # What is watched sends nothing: the motor that all clients address stays.
        page.command("#2")
        page.send({"kind": "watch", "items": ["#1P", "&3PR", "P1"]})
        state = page.state(lambda s: len(s["watch"]) == 3, "watch list")
        check(all(isinstance(value, str) for value in state["watch"].values()), str(state["watch"]))
        check([page.command(line)["lines"] for line in ("#", "&")] == [["2"], ["1"]], "what is addressed")
        check(page.command("#1J/")["lines"] == [], "J/")
        page.command("#1J+")
        before = page.state()["motors"][0]["position"]
        last = time.monotonic() + PATIENCE
        while float(page.command("#1P")["lines"][0]) < 100:
            check(time.monotonic() < last, "J+ does not move it")
        page.state(lambda s: s["motors"][0]["position"] > before + 50, "motion")
        with server.open() as other, server.client() as client:
            other.command("P9=81")
            check(client.values("P9") == ["81"] and page.command("P9")["lines"] == ["81"], "clients see each other")


def page_engines():
    """The page of the RTL and of lock-step: what it reads by the back door is what the controller answers."""
    for engine in ("rtl", "lockstep"):
        options = ("--free", "--board", "geobrick-lv-4", "--engine", engine)
        with served_page(*options) as server, server.client() as client, server.open() as page:
            about = page.receive()
            check(about["engine"] == engine, str(about))
            page.send({"kind": "watch", "items": ["X:$0", "host.breq"]})
            check(page.command("P1=5 P1")["lines"] == ["5"], engine)
            motor, everything = words(client.values("#1?")[0], 2), words(client.values("???")[0], 2)
            i17 = int(client.values("I17")[0])
            state = page.state(lambda s: s["watch"].get("X:$0", 0) > 0, "the servo counter")
            check(state["motors"][0]["status"] == motor and state["global"] == everything, f"{engine}: {state}")
            check(state["request"]["i17"] == i17 and state["watch"]["host.breq"] == state["request"]["breq"], engine)


def page_read_only():
    """--page-read-only: no command goes through, whatever is sent; all is shown."""
    with served_page("--free", "--page-read-only") as server, server.client() as client, server.open() as page:
        check(page.receive()["read_only"] is True, "it says so")
        answer = page.command("P5=55")
        check(answer["kind"] == "mistake" and "read only" in answer["text"], str(answer))
        check(client.values("P5") == ["0"], "the controller has got it")
        page.send({"kind": "watch", "items": ["X:$0"]})
        check(page.state(lambda s: "X:$0" in s["watch"], "watch list")["motors"], "motors")
        check('data-mode="read-only"' in server.get()[1], "the page")


def page_strangers():
    """Host, Origin and token of every request; nothing of the page is given away, and nothing is done."""
    with served_page("--free") as server, server.client() as client:
        here, port = server.host, server.page_port
        status, body = server.get()
        check(status == 200 and "<title>brick</title>" in body, f"{status}")
        check(server.get(Origin=f"http://{here}")[0] == 200, "our own origin")
        check(server.get(Host=f"localhost:{port}")[0] == 200, "localhost")
        wrong = "0" * 32
        for what, path, fields in (
                ("no token", "/", {}), ("a wrong token", f"/?token={wrong}", {}),
                ("half a token", f"/?token={server.token[:16]}", {}),
                ("a token and more", f"/?token={server.token}0", {}), ("another field", f"/?t={server.token}", {}),
                ("another host", None, {"Host": f"evil.example:{port}"}),
                ("another port", None, {"Host": "127.0.0.1:1"}),
                ("no host", None, {"Host": None}), ("two hosts", None, {"Host": [here, here]}),
                ("an address that is not ours", None, {"Host": f"10.0.0.1:{port}"}),
                ("another origin", None, {"Origin": "http://evil.example"}),
                ("an origin of another port", None, {"Origin": "http://127.0.0.1:1"}),
                ("no origin at all", None, {"Origin": "null"}), ("https", None, {"Origin": f"https://{here}"}),
                ("two origins", None, {"Origin": [f"http://{here}", f"http://{here}"]})):
            status, body = server.get(path, **fields)
            check(status in (400, 403), f"{what}: {status}")
            check("<script" not in body and server.token not in body, f"{what}: {body}")
            target = path and path.replace("/?", "/socket?").replace("/", "/socket", path == "/")
            with server.open(path=target, **fields) as page:
                check(page.refused in (400, 403), f"websocket, {what}: {page.refused}")
        with server.open(Origin=None) as page:
            check(page.refused == 403, f"websocket without an origin: {page.refused}")
        for path, method, wanted in ((f"/other?token={server.token}", "GET", 404),
                                     (f"/socket?token={server.token}", "GET", 404),
                                     (None, "POST", 405), (None, "DELETE", 405)):
            check(server.get(path, method)[0] == wanted, f"{method} {path}")
        check(client.values("ver") == ["1.947"], "the controller")
    with served_page("--free") as one, served_page("--free") as other:
        check(one.token != other.token, "the same token twice")
        nonces = [re.search(r'<script nonce="([0-9a-f]{32})">', server.get()[1]) for server in (one, other)]
        check(all(nonces) and nonces[0][1] != nonces[1][1], "the same nonce twice")


def page_header():
    """The page loads nothing from anywhere, is kept by nobody, and stands in no frame."""
    with served_page("--free") as server:
        answer = server.raw(head(f"/?token={server.token}", "GET", {"Host": server.host})).decode()
        for line in ("Cache-Control: no-store", "Referrer-Policy: no-referrer", "X-Content-Type-Options: nosniff",
                     "default-src 'none'", "frame-ancestors 'none'"):
            check(line in answer, line)
        body = answer.partition("\r\n\r\n")[2]
        check(not re.search(r"(?:src|href)=\"(?!data:)", body) and "@" not in re.sub(r"@media", "", body),
              "it asks for more than itself")


def page_beyond_loopback():
    """A page that others reach says what that means; its own machine is named in the printed address."""
    with served_page("--free", page="0.0.0.0:0") as server:
        check(server.get()[0] == 200 and server.get(Host=f"10.1.2.3:{server.page_port}")[0] == 200, "by address")
        check(server.get(Host=f"evil.example:{server.page_port}")[0] == 403, "by a stranger's name")
        said = server.end()
        check("encrypted" in said and "no password" in said, said)
    with served_page("--free", page="0") as server:
        check(server.host.startswith("127.0.0.1:"), server.host)
        said = server.end()
        check("encrypted" not in said, said)


def page_bad_input():
    for options, wanted in ((("--page", "frob"), "HOST:PORT"), (("--page", "127.0.0.1:99999"), "HOST:PORT"),
                            (("--page", "192.0.2.1:0"), "free port"), (("--page-read-only",), "--page")):
        r = command.brick("serve", "--listen", "127.0.0.1:0", *options)
        check(r.returncode == 2 and wanted in r.stderr and r.stderr.count("\n") == 1, f"{options}: {r.stderr}")


def page_hostile():
    """Huge headers, noise, half requests, frames too long, broken JSON, clients that stall: others are served."""
    chance = random.Random(1)
    with served_page("--free") as server, server.client() as client, server.open() as good:
        def still_good():
            check(client.values("ver") == ["1.947"] and good.command("P7")["lines"] == ["0"], "a good client")
        request = head(f"/?token={server.token}", "GET", {"Host": server.host})
        check(status_of(server.raw(request[:-2] + b"X: " + b"a" * 20000 + b"\r\n\r\n")) in (431, None), "a huge header")
        check(status_of(server.raw(b"\x00\x01frob\r\n\r\n")) == 400, "noise")
        still_good()
        for _ in range(20):
            with contextlib.suppress(ConnectionError):
                server.raw(bytes(chance.randrange(256) for _ in range(3000)) + b"\r\n\r\n")
        still_good()
        halves = [server.connect() for _ in range(100)]  # more than there is room for
        for at, half in enumerate(halves):
            with contextlib.suppress(ConnectionError):
                half.sendall(request[:at % (len(request) - 1)])
        still_good()
        check(server.get()[0] == 200, "the page while half requests wait")
        for half in halves:
            half.close()
        for data, opcode in ((b"x" * 5000, 1), (b"x" * 100000, 1), (b"\xff\xfe", 1)):
            with server.open() as page, contextlib.suppress(ConnectionError):
                page.frame(data, opcode)
                while page.receive() is not None:
                    pass
            still_good()
        with server.open() as page:
            page.sock.sendall(b"\x81\x05hello")  # not masked
            with contextlib.suppress(ConnectionError):
                while page.receive() is not None:
                    pass
        with server.open() as page:
            page.sock.sendall(bytes([0x81, 0xFF]) + struct.pack(">Q", 1 << 62) + b"mask")  # of a size that is none
            with contextlib.suppress(ConnectionError):
                while page.receive() is not None:
                    pass
        still_good()
        for text in ("", "{", "[]", "null", "7", "[" * 4000, '{"kind":7}', '{"kind":"frob"}', '{"kind":"command"}',
                     '{"kind":"command","id":-1,"line":"P7=9"}', '{"kind":"command","id":1,"line":"P7=9\\rP7=9"}',
                     '{"kind":"command","id":1,"line":7}', '{"kind":"command","id":1,"line":""}',
                     '{"kind":"command","id":1e30,"line":"P7=9"}', '{"kind":"watch"}', '{"kind":"watch","items":[7]}',
                     '{"kind":"watch","items":["a b"]}', '{"kind":"watch","items":{}}', '{"kind":"command","id":1,'
                     f'"line":"{"P" * 256}"' + "}"):
            good.frame(text.encode())
            mistake = good.until(lambda m: m["kind"] != "state" and m["kind"] != "about", f"answer to {text[:40]}")
            check(mistake["kind"] == "mistake", f"{text[:40]}: {mistake}")
            check(mistake.get("id") == (1 if '"id":1,' in text else None), f"{text[:40]}: {mistake}")
        still_good()
        crowd = [server.open() for _ in range(20)]
        refused = [one.refused for one in crowd]
        check(refused.count(503) == 5, f"{refused}: expected 16 with the good one")
        for one in crowd:
            one.sock.close()
        still_good()


def page_makes_room():
    """Strangers press a connection out while its upgrade is read: it is closed, and the others are served."""
    with served_page("--free") as server, server.client() as client:
        check(client.values("ver") == ["1.947"], "the controller")
        for size in range(300, 2000, 100):  # bytes of the request: one or more are read of it when it goes
            request = head(f"/socket?token={server.token}", "GET", {
                "Host": server.host, "Origin": f"http://{server.host}", "Upgrade": "websocket",
                "Connection": "Upgrade", "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
                "Sec-WebSocket-Version": "13", "X": ""})
            request = request[:-4] + b"a" * max(0, size - len(request)) + b"\r\n\r\n"
            with contextlib.ExitStack() as stack:
                idle = [stack.enter_context(server.connect()) for _ in range(31)]
                good = stack.enter_context(server.open())  # the last that there is room for: all are in
                server.process.send_signal(signal.SIGSTOP)
                idle[0].sendall(request)
                stack.enter_context(server.connect())
                server.process.send_signal(signal.SIGCONT)
                answer = good.command("ver")
                check(answer.get("lines") == ["1.947"], f"{size} bytes: {answer}")
        check("page:" not in server.end(), "the server complains")


def page_commands_wait():
    """While 16 commands wait the page is read: the 17th is a mistake at once, and all others are answered."""
    with served_page() as server, server.client() as client, server.open() as page:
        check(client.values("ver") == ["1.947"], "the controller")
        server.process.send_signal(signal.SIGSTOP)  # so that all of them are there at once
        for number in range(40):
            page.send({"kind": "command", "id": number, "line": "P1..200"})
        server.process.send_signal(signal.SIGCONT)
        told = [page.until(lambda m: m["kind"] in ("answer", "mistake"), "an answer to each") for _ in range(40)]
        mistakes = [m["id"] for m in told if m["kind"] == "mistake"]
        check(all("16 commands wait" in m["text"] for m in told if m["kind"] == "mistake"), str(told))
        check(mistakes and mistakes[0] >= 16 and sorted(m["id"] for m in told) == list(range(40)), f"{mistakes}")
        check(told[-1]["kind"] == "answer", "mistakes do not wait for answers")
        check(page.command("ver")["lines"] == ["1.947"], "answers")


def page_watch_flood():
    """Watch lists one after the other, each item a walk over all signals: the newest counts, those between cost next to
    nothing; time goes on, others have their values, SIGTERM ends it."""
    lists = [["?" * n + end for n in range(31)] + ["*"] for end in ("*", "*?")]
    flood = 1500 * b"".join(frame(json.dumps({"kind": "watch", "items": items}).encode()) for items in lists)
    with served_page() as server, server.open() as page, server.open() as good:
        good.send({"kind": "watch", "items": ["host.breq"]})
        good.state(lambda s: "host.breq" in s["watch"], "the other's value")
        begin = server.processor_seconds()
        for number in range(10):
            page.send({"kind": "watch", "items": lists[number % 2]})
            page.state(lambda s, items=lists[number % 2]: set(items) < s["watch"].keys(), "each list")
        alone = (server.processor_seconds() - begin) / 10
        begin = server.processor_seconds()
        page.sock.sendall(flood)
        page.send({"kind": "watch", "items": ["Y:$25"]})
        state = good.state(lambda s: "Y:$25" in s["watch"], "the newest list")
        took = server.processor_seconds() - begin
        check(took < 3000 * alone / 20, f"{took:.2f} processor seconds, {alone:.4f} a list that is taken alone")
        check(sorted(state["watch"]) == ["Y:$25", "host.breq"], str(state["watch"]))
        good.state(lambda s: s["ms"] > state["ms"], "time that passes")
        page.sock.sendall(flood)
        server.end()


def page_stalled():
    """Clients that take nothing: the others have fresh states, and the memory of the process stays where it is."""
    def memory(server):
        status = pathlib.Path(f"/proc/{server.process.pid}/status").read_text(encoding="ascii")
        return int(status.partition("VmRSS:")[2].split()[0])
    with served_page("--plant", "dac8", "--load", "dac8") as server, server.open() as good:
        good.send({"kind": "watch", "items": [f"{n:x>100}" for n in range(32)]})  # states of more than 10 KB
        size = len(json.dumps(good.state(lambda s: len(s["watch"]) == 32, "watch list")))
        stalled = [server.open() for _ in range(12)]
        for one in stalled[:4]:
            for number in range(40):  # more than are taken from one client at a time
                one.send({"kind": "command", "id": number, "line": "P1..200"})
        good.state()
        def see(count):
            first = last = good.state()["ms"]
            for _ in range(count):
                now = good.state()["ms"]
                check(now > last, "an old state")
                last = now
            return last - first
        see(20)
        before = memory(server)
        see(150)
        check(150 * len(stalled) * size > 4 * 4096 * 1024, f"{size} bytes a state: nothing would be seen")
        grown = memory(server) - before
        check(grown < 4096, f"{grown} KiB more for clients that take nothing")
        check(good.command("ver")["lines"] == ["1.947"], "answers")
        for one in stalled:
            one.sock.close()


if __name__ == "__main__":
    globals()[command.CASE]()
