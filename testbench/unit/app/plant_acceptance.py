"""Motors at the pins of the built command: --plant, --load, the plant's signals (docs/plant.md).

usage: plant_acceptance.py BRICK CASE; each CASE is one test.
"""

import math
import pathlib
import re
import tempfile

import command
from command import brick, check, play

# Motor 1 by hand: the amplifier is enabled and its DAC written, whatever the firmware thinks of motors.
BY_HAND = ["I100=0", "M102->Y:$078002,8,16,S", "M114->X:$078005,14"]
ONE_MOTOR = """
[[axis]]
axes = 1
drive = "torque"
motor = { inertia = 1e-5, viscous = 1e-4, coulomb = 5e-4, torque_constant = 0.1 }
amplifier = { full_scale_amps = 10 }
"""


def values(text, name):
    return [float(v) for v in re.findall(rf"^{re.escape(name)}=(\S+)$", text, re.M)]


def plant_torque():
    """A constant torque turns the motor as the formula says, the counter follows, lock-step agrees at each line."""
    script = [*BY_HAND, "I200=0 M202->Y:$07800A,8,16,S M214->X:$07800D,14", "M214=1 M202=-656", "M114=1", "M102=328",
              "@time", "@wait 20ms", "@time", "@signal plant.axis1.position", "@signal plant.axis1.velocity",
              *(f"@signal plant.axis{n}.{what}" for n in (1, 2) for what in ("torque", "current_a", "command")),
              "@signal servo_ic0.ch1.count", "M102=0 M114=0 M202=0 M214=0", "@wait 3ms",
              "@signal plant.axis1.position", "@signal servo_ic0.ch1.count"]
    outputs = []
    for engine in ("systemc", "lockstep"):
        r = play(script, "--plant", "dac8", "--load", "dac8", "--engine", engine)
        check(r.returncode == 0, f"{engine}: exit {r.returncode}: {r.stderr}")
        outputs.append(r.stdout)
    check(len(set(outputs)) == 1, "the engines differ:\n" + "\n".join(outputs))
    begin, end = (int(t) * 1e-9 for t in re.findall(r"^time=(\d+) ns$", outputs[0], re.M))
    # J w' = T - Tc - B w: 328/32768 of 10 V are 0.01001 N m
    drive, friction, viscous, inertia = 328 / 32768, 5e-4, 1e-4, 1e-5
    tau, final, t = inertia / viscous, (drive - friction) / viscous, end - begin
    speed = final * (1 - math.exp(-t / tau))  # rad/s
    counts = 4000 / (2 * math.pi)

    def angle(t):
        return final * (t - tau * (1 - math.exp(-t / tau)))

    position, later = values(outputs[0], "plant.axis1.position")
    velocity, = values(outputs[0], "plant.axis1.velocity")
    for axis, bits in ((1, 328), (2, -656)):  # of 32768: 10 V, 10 A, 1 N m; 18 bits are latched
        for what, whole in (("command", 10), ("current_a", 10), ("torque", 1)):
            shown, = values(outputs[0], f"plant.axis{axis}.{what}")
            check(abs(shown - bits / 32768 * whole) < 1e-4 * whole, f"{what} of axis {axis} is {shown}")
    early = 1 / 9034.6  # the command is taken by the next phase clock, and its answer may be quicker than that,
    late = 0.25e-3      # or take its time
    check(angle(t - early) * counts - 1 < position < (angle(t) + speed * late) * counts + 1,
          f"{position} counts, expected {angle(t) * counts} less {early} s or {late} s more")
    check(abs(velocity * 1000 / counts / speed - 1) < 0.05, f"{velocity} counts/ms, expected {speed * counts / 1000}")
    for count, place in zip(values(outputs[0], "servo_ic0.ch1.count"), (position, later), strict=True):
        check(abs(count - math.floor(place)) <= 1, f"counter {count} at position {place}")
    check(later > position + 10, "it stops at once")


def plant_steps():
    """Each pulse is a step of the motor and, with the encoder read back, a count."""
    r = play(["I100=0 I7010=3 I7016=3", "M104->Y:$078004,8,16,S", "M114->X:$078005,14", "M114=1 M104=-200", "@wait 5ms",
              "M104=0", "@wait 1ms", "@signal plant.axis1.position", "@signal servo_ic0.ch1.count", "M104=200",
              "@wait 20ms", "M104=0", "@wait 1ms", "@signal plant.axis1.position", "@signal servo_ic0.ch1.count"],
             "--plant", "stepper8")
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    first, second = values(r.stdout, "plant.axis1.position")
    check(-190 < first < -140, f"{first} steps, expected 5 ms of 30 a ms and what the command takes")
    check(second - first > 590, f"{second - first} steps, expected 20 ms of 30 a ms or more")
    check(values(r.stdout, "servo_ic0.ch1.count") == [first, second], r.stdout)


def plant_set_ups():
    """Each ready set-up is taken whole by the controller, with its plant."""
    for name in ("dac8", "servo8", "stepper8"):
        r = play(["I800 &1#8->", "@wait 5ms", "@signal plant.axis8.position"], "--plant", name, "--load", name)
        check(r.returncode == 0 and r.stdout.startswith("1\n1000V\n"), f"{name}: {r.returncode} {r.stdout} {r.stderr}")


def plant_load():
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "up.pmc")
        file.write_text("P1=5 ; one\nP2=P1+1\n")
        r = play(["P2"], "--load", str(file))
        check(r.returncode == 0 and r.stdout == "6\n", f"{r.returncode} {r.stdout} {r.stderr}")
        file.write_text("P1=5\nNONSENSE\nP1=7\n")
        r = play(["P1"], "--load", str(file))
        check(r.returncode == 1 and r.stdout == "" and f"{file}:2: `NONSENSE`: ERR003" in r.stderr,
              f"{r.returncode} {r.stdout} {r.stderr}")
        r = brick("run", "smoke", "--engine", "systemc", "--load", str(file))
        check(r.returncode == 1 and "FAIL" in r.stdout and f"{file}:2: `NONSENSE`" in r.stdout, r.stdout)
        r = play(["P1"], "--load", f"{folder}/none.pmc")
        check(r.returncode == 2 and r.stderr == f"brick exec: --load {folder}/none.pmc: cannot be read; expected a "
              "command file\n", r.stderr)
        file.write_text("@signal nowhere\n")
        r = play(["P1"], "--load", str(file))
        check(r.returncode == 2 and f"{file}:1:" in r.stderr, r.stderr)
    r = play(["P1"], "--load", "dac9")
    check(r.returncode == 2 and "--load dac9: no such set-up; expected dac8, servo8, stepper8 or a file" in r.stderr,
          r.stderr)


def plant_none():
    """Without a plant, and with the plant `none`, nothing is different: replies, their times, signals."""
    lines = ["VERSION", "@time", "M102->Y:$078002,8,16,S M114->X:$078005,14", "M114=1 M102=9999", "@wait 5ms", "@time",
             "@signal servo_ic0.ch1.count", "@signal servo_ic0.ch1.fault", "@encoder 1 5", "@time",
             "@signal servo_ic0.ch1.count"]
    first, second = play(lines), play(lines, "--plant", "none")
    check(first.returncode == 0 and "ch1.count=5" in first.stdout, first.stdout + first.stderr)
    check(first.stdout == second.stdout, second.stdout + second.stderr)
    r = play(["@signal plant.axis1.position"])
    check(r.returncode == 2 and "no signal `plant.axis1.position`" in r.stderr, r.stderr)


def plant_mistakes():
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "p.toml")
        file.write_text(ONE_MOTOR)
        for line, message in (("@encoder 1 5", "the plant turns the encoder of motor 1"),
                              ("@input servo_ic0.ch1.enc_b=1", "enc_b is driven by the plant"),
                              ("@until plant.axis1.position=3 1ms", "is never exactly a number")):
            r = play([line], "--plant", str(file))
            check(r.returncode == 2 and message in r.stderr, f"{line}: {r.stderr}")
        r = play(["@encoder 2 5", "@input servo_ic0.ch1.plim=1", "@signal servo_ic0.ch2.count"], "--plant", str(file))
        check(r.returncode == 0 and r.stdout.endswith("count=5\n"), r.stdout + r.stderr)
        file.write_text(ONE_MOTOR.replace("inertia = 1e-5", "inertia = 0"))
        for arguments in (("exec", "-"), ("console",), ("serve", "--listen", "127.0.0.1:0"), ("run", "smoke")):
            r = brick(*arguments, "--plant", str(file), script="")
            check(r.returncode == 2 and r.stderr ==
                  f"brick {arguments[0]}: {file}:5: inertia: found 0; expected kg m2, 1e-9 or more\n", r.stderr)
    r = play(["VERSION"], "--plant", "dac9")
    check(r.returncode == 2 and "--plant dac9: no such plant; expected none, dac8, servo8, stepper8 or FILE.toml" in
          r.stderr, r.stderr)
    r = play(["VERSION"], "--plant", "dac8", "--board", "geobrick-lv-4")
    check(r.returncode == 2 and "expected motors 1 to 4: the board has no more" in r.stderr, r.stderr)


def plant_incidents():
    """What the file says happens, happens then: a fault, a cut wire, a hand."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "p.toml")
        file.write_text(ONE_MOTOR + """
[[axis]]
axes = 2
drive = "hand"
encoder = { wiring = "complements" }
[[incident]]
at = "60ms"
axes = 1
trip = "over-temperature"
[[incident]]
at = "60ms"
axes = 2
turn = 1000
within = "10ms"
[[incident]]
at = "80ms"
axes = 2
cut = ["enc_a", "u"]
""")
        names = ["servo_ic0.ch1.fault", "plant.axis2.position", "servo_ic0.ch2.u"]
        script = ["@until servo_ic0.ch1.fault=1 70ms", "@time", *(f"@signal {n}" for n in names), "@wait 15ms",
                  *(f"@signal {n}" for n in names), "@wait 20ms", *(f"@signal {n}" for n in names)]
        r = play(script, "--plant", str(file))
        check(r.returncode == 0, r.stdout + r.stderr)
        at = int(re.search(r"time=(\d+)", r.stdout)[1])
        check(60_000_000 <= at < 60_001_000, f"FAULT rose at {at} ns, expected 60 ms")
        check(values(r.stdout, names[0]) == [1, 1, 1], r.stdout)
        check(values(r.stdout, names[1])[1:] == [1000, 1000], r.stdout)
        check(values(r.stdout, names[2])[1:] == [0, 1], r.stdout)  # count 1000: A is low; cut: pulled up


def plant_wave():
    """Positions and speeds are real variables of the waveform, the same in both formats and as @signal says."""
    script = [*BY_HAND, "M114=1 M102=3280", "@wait 20ms", "@signal plant.axis1.position", "@time"]
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "x.vcd")
        r = play(script, "--plant", "dac8", "--load", "dac8", "--wave", str(file), "--trace", "plant.*")
        check(r.returncode == 0, r.stderr)
        text = file.read_text()
        code = re.search(r"\$var real 64 (\S+) position \$end", text.split("axis1")[1])[1]
        curve = [float(v) for v in re.findall(rf"^r(\S+) {re.escape(code)}$", text, re.M)]
        check(len(curve) > 150, f"{len(curve)} samples, expected 12.8 a ms of motion")
        check(curve == sorted(curve), "the position goes back")
        end, = values(r.stdout, "plant.axis1.position")
        check(0 <= end - curve[-1] < 30, f"the curve ends at {curve[-1]}, @signal says {end}")
        plain = play(script, "--plant", "dac8", "--load", "dac8")
        check(plain.stdout == r.stdout, "a waveform changes the run")


PLACES = [1000 * motor if motor < 5 else -1000 * (motor - 4) for motor in range(1, 9)]


def moves(name, index):
    """Each motor of a ready plant jogs to a place of its own, and home: to the index where count `index` of a
    revolution is 0 from then on (docs/plant.md)."""
    def of_all(text):
        return "".join(f"#{motor}{text}" for motor in range(1, 9))
    jogs = "".join(f"#{motor}J={place}" for motor, place in enumerate(PLACES, 1))
    names = [f"plant.axis{motor}.position" for motor in range(1, 9)]
    # Jogs at 32 counts/ms; home at 10 counts/ms, from place n x 1000 up to the next index.
    r = play([of_all("J/"), "@wait 50ms", jogs, "@wait 400ms", of_all("?PF"), *(f"@signal {n}" for n in names),
              of_all("HM"), "@wait 800ms", of_all("?PF"), *(f"@signal {n}" for n in names)],
             "--plant", name, "--load", name)
    check(r.returncode == 0, f"{r.stdout}{r.stderr}")
    answers = [line for line in r.stdout.splitlines() if "=" not in line]
    stood = [float(line.partition("=")[2]) for line in r.stdout.splitlines() if "=" in line]
    check(len(answers) == 48 and len(stood) == 16, r.stdout)
    for part, places, at in ((0, PLACES, PLACES), (24, [0] * 8, [math.ceil(p / 4000) * 4000 + index for p in PLACES])):
        for motor in range(8):
            status, place, error = answers[part + 3 * motor:part + 3 * motor + 3]
            bits = int(status, 16)
            what = f"{name}, motor {motor + 1}: {status} {place} {error}, plant {stood[(part and 8) + motor]}"
            check(bits & 1 and bits >> 43 & 1 and not bits >> 42 & 1, f"closed and in position: {what}")
            check(bits >> 10 & 1 == (part != 0), f"home complete: {what}")
            check(abs(float(place) - places[motor]) <= 2 and abs(float(error)) <= 2, what)
            check(abs(stood[(part and 8) + motor] - at[motor]) <= 3, f"expected at {at[motor]}: {what}")


def plant_moves_dac8():
    moves("dac8", 2)


def plant_moves_servo8():
    moves("servo8", 2)


def plant_moves_stepper8():
    moves("stepper8", 2)


def plant_moves_none():
    """Nothing is connected: a motor that is sent away stays, and trips by its following error, 2000 counts."""
    r = play(["#1J/", "@wait 50ms", "#1J:1500", "@wait 200ms", "#1?PF", "#1J:1500", "@wait 200ms", "#1?P", "#1HM",
              "@wait 400ms", "#1?"], "--plant", "none", "--load", "dac8")
    check(r.returncode == 0, f"{r.stdout}{r.stderr}")
    said = r.stdout.splitlines()
    check(said[1:3] == ["0", "1500"] and int(said[0], 16) & 6 == 2, f"warned, on, not in position: {said}")
    check(int(said[3], 16) >> 42 & 1 and int(said[3], 16) & 4 and said[4] == "0", f"tripped: {said}")
    check(int(said[5], 16) & 0x404 == 4, f"no home, tripped again: {said}")


def plant_overload():
    """More than the CPU can do (docs/watchdog.md): the watchdog takes the motors off and says so; a reset ends it."""
    script = ["#1J/", "@wait 5ms", "@signal servo_ic0.ch1.aena", "I7000=1473", "@until watchdog.tripped=1 60ms",
              "@signal host.wdo", "@signal servo_ic0.ch1.aena", "@reset", "???", "#1?", "I7000"]
    r = play(script, "--plant", "servo8", "--load", "servo8")
    check(r.returncode == 0, r.stderr)
    said = r.stdout.split()
    check(said[:3] == ["servo_ic0.ch1.aena=1", "host.wdo=1", "servo_ic0.ch1.aena=0"], str(said))
    check(said[3:] == ["000000000800", "850000000000", "6527"], f"as at power-on: {said}")
    r = play([*script[:5], "???"], "--plant", "servo8", "--load", "servo8")
    check(r.returncode != 0 and "the watchdog has tripped" in r.stderr, r.stderr)


def plant_first_minute():
    """The README's first minute, as printed: two commands, and a motor has moved, to be seen in the waveform's view."""
    tree = command.BOARDS.parent
    text = (tree / "README.md").read_text(encoding="utf-8")
    lines = re.search(r"first minute.*?```sh\n(.*?)```", text, re.S)[1].splitlines()
    first, second = (line.split("#")[0].split() for line in lines)
    check(first[:3] == ["./dev", "brick", "exec"] and second[0] == "gtkwave", str(lines))
    wave, view = first[first.index("--wave") + 1], second[second.index("-a") + 1]
    check(second[-1] == wave, f"{wave} is written, {second[-1]} shown")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, pathlib.Path(wave).name)
        arguments = [str(file) if a == wave else str(tree / a) if "/" in a else a for a in first[2:]]
        r = brick(*arguments)
        check(r.returncode == 0, r.stderr)
        shown = re.search(r"`(\d+)` after `#1J:4000`,\s+`(\d+)` after `#1J:-2000`", text)
        said = r.stdout.split()
        check((said[0], said[-1]) == shown.groups() and abs(float(said[1])) <= 1, f"{said}, README: {shown[0]}")
        names, scopes = set(), []
        for scope, name in re.findall(r"^\$(?:scope \w+ (\S+)|upscope|var \S+ \d+ \S+ (\S+)).*\$end$", file.read_text(),
                                      re.M):
            if scope:
                scopes.append(scope)
            elif name:
                names.add(".".join([*scopes, name]))
            else:
                scopes.pop()
        wanted = [line for line in (tree / view).read_text(encoding="ascii").splitlines() if line.startswith("brick.")]
        missing = [name for name in wanted if name.split("[")[0] not in names]
        check(len(wanted) >= 4 and not missing, f"{view}: {missing} not in the waveform")


globals()[command.CASE]()
