"""Eight three-phase motors at PWM amplifiers, currents read through the ADCs (--plant servo8), on the SystemC engine:
phase references, closed loops, cycles of the phase task. docs/commutation.md

usage: commutation_acceptance.py BRICK CASE; each CASE is one test.
"""

import pathlib
import tempfile

import command
from command import check, play

MOTORS = range(1, 9)
WORD_1_BITS = 23, 18, 16, 6  # activated, open loop, integration mode, commutated; firmware:5.2
CLOSED_BITS = 23, 19, 16, 13, 6  # activated, amplifier enabled, integration mode, desired velocity zero, commutated
ASSIGNED_BITS = 15,
AXIS = {motor: 7 if motor <= 3 else motor - 3 if motor <= 6 else 4 for motor in MOTORS}  # X Y Z A B C U V


def word(bits):
    return sum(1 << bit for bit in bits)


def status(motor, bits_1, bits_2):
    return f"{word(bits_1):06X}{word(bits_2) | AXIS[motor] << 16:06X}"


def in_position(motor):
    return status(motor, CLOSED_BITS, (15, 14, 0))


def controller(lines):
    r = play(lines, "--plant", "servo8", "--load", "servo8")
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    return r.stdout.split()


def forget(motors):
    """Lines with which motors lose the reference that the set-up has given them."""
    return [f"#{m}K I{m}01=0 I{m}01=1" for m in motors]


def wrong_by(position, counts):
    """Degrees of an electrical cycle; 4 of them in 4000 counts, all motors stand at the angle 0 at first."""
    return ((position - 4 * counts) * 360 / 4000 + 180) % 360 - 180


def commutation_guesses():
    """$$ finds all eight; then each jogs a revolution and is where it shall be."""
    lines = forget(MOTORS) + ["M60->X:$37,0,24"] + [f"M{m}->X:${0x80 * m + 0x34:X},0,24,S" for m in MOTORS]
    lines += [f"#{m}?" for m in MOTORS] + ["&1$$", "@wait 60ms"] + [f"#{m}?" for m in MOTORS]
    lines += [f"#{m}PM{m}" for m in MOTORS] + [f"#{m}J=4000" for m in MOTORS] + ["@wait 40ms", "M60", "@wait 260ms"]
    lines += [f"#{m}?#{m}P" for m in MOTORS]
    found = controller(lines)
    before, after, at, rest = found[:8], found[8:16], found[16:32], found[32:]
    for m in MOTORS:
        check(before[m - 1] == status(m, WORD_1_BITS, (15, 8)), f"motor {m} at the start: {before[m - 1]}")
        check(after[m - 1] == in_position(m), f"motor {m} with its reference: {after[m - 1]}")
        counts, position = float(at[2 * m - 2]), int(at[2 * m - 1])
        check(abs(wrong_by(position, counts)) < 15, f"motor {m} at {counts}: phase position {position}")
        check(rest[2 * m - 1] == in_position(m), f"motor {m} after its jog: {rest[2 * m - 1]}")
        check(abs(float(rest[2 * m]) - 4000) <= 1, f"motor {m} is at {rest[2 * m]}, expected 4000")
    cycles = 2 * int(rest[0])
    check(2000 < cycles <= 4400, f"{cycles} cycles of the phase task")


def commutation_stepper():
    """The other search, and halls; a motor that has a good reference goes where it shall."""
    found = controller([*forget((1, 2)), "I180=2 I174=2 I173=4000", "I281=$78008 I291=$BB0000", "#2$", "#2?", "RX$134",
                        "#1$", "@wait 500ms", "#1?", "#1J:1000", "#2J=1000", "#1?", "@wait 200ms", "#1?", "#2?", "#2P"])
    check(found[0] == in_position(2)[:-1] + "0" or found[0] == in_position(2), f"halls: {found[0]}")
    # 011 is the sector around 0 degrees of this plant: -30 degrees are 58.7/64 of a cycle.
    check(abs(wrong_by(int(found[1]), 0)) <= 30 + 360 / 64, f"halls: {found[1]}")
    check(found[2] == in_position(1), f"stepper: {found[2]}")
    check(found[4] == in_position(1), f"after its jog: {found[4]}")
    check(found[5] == in_position(2), f"after its jog: {found[5]}")
    check(abs(float(found[6]) - 1000) <= 1, f"at {found[6]}, expected 1000")


def commutation_serial():
    """A motor whose phase is read from an SSI encoder of 12 bits and commutated by it; four cycles are 4096 of it."""
    plant = (command.EXAMPLES / "plants" / "servo8.toml").read_text() + "\n[axis.absolute]\nbits = 12\n"
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "serial.toml"
        file.write_text(plant)
        # 2 MHz, from the fall of PHASE, SSI; trigger and driver enable, 12 bits (servo-ic:11.3)
        lines = ["M50->X:$78B2F,0,24 M51->X:$78B20,0,24 M50=$310102 M51=$140C", "#1J=137", "@wait 120ms",
                 "#1K I101=0", "I171=4096 I183=$78B20 I101=3 I181=$78B20 I191=$0C0000", "#1?", "#1$",
                 "RX$B4", "RY$78B20", "@wait 2ms", "#1?", "#1J=1137", "@wait 150ms", "#1?", "#1P",
                 "#1K I110=$78B20 I195=$0C0000", "#1$*", "#1P", "RY$78B20"]
        r = play(lines, "--plant", str(file), "--load", "servo8")
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    before, phase, sensor, after, rest, at, absolute, read = r.stdout.split()
    check(before == status(1, (*WORD_1_BITS, 7), (15, 8)), f"no reference: {before}")
    check(abs(int(sensor) - 137 * 4096 / 4000) <= 2, f"137 of 4000 counts are {sensor} of 4096")
    off = (int(phase) - 4 * int(sensor) + 2048) % 4096 - 2048
    check(abs(off) <= 8, f"phase position {phase} at {sensor}")
    check(after == status(1, (*CLOSED_BITS, 7), (15, 14, 0)), f"with its reference: {after}")
    check(rest == after, f"behind its jog: {rest}")
    check(abs(float(at) - 1137) <= 1, f"at {at}, expected 1137")
    check(absolute == read, f"its position is {absolute}, the sensor says {read}")


def commutation_serial_at_power_on():
    """A Geo PMAC's SSI input at a servo clock of 1.8 ms: a start waits for its first word, a counter does not count."""
    plant = """
[[axis]]
axes = 1
drive = "hand"
absolute = { bits = 12 }
[[incident]]
at = "1ms"
axes = 1
turn = 1000
within = "1ms"
"""
    clocks = "I7002=15 I10=14855964"
    with tempfile.TemporaryDirectory() as folder:
        file, flash = pathlib.Path(folder) / "serial.toml", pathlib.Path(folder) / "flash"
        file.write_text(plant)
        options = "--board", "geo-pmac", "--plant", str(file), "--flash", str(flash)
        first = play(["I1016=2 I1017=0 I100=1 I110=$FF54 I195=$180000", clocks, "SAVE"], *options)
        check(first.returncode == 0, f"exit {first.returncode}: {first.stderr}")
        r = play(["#1P", "#1?", "RX$78001", "$$$", "@wait 40ms", "#1P"], *options)
    check(r.returncode == 0, f"exit {r.returncode}: {r.stderr}")
    position, word_1_and_2, counted, again = r.stdout.split()
    check(int(counted) != 0, "the encoder has not turned before")
    check(position == again == str(1000 * 4096 // 4000), f"at {position} and {again}, 1000 of 4000 counts are 1024")
    check(int(word_1_and_2[6:], 16) & 1 << 10, f"home is not complete: {word_1_and_2}")


def commutation_cycles():
    """The phase task with all loops at full voltage and the third harmonic, at both clocks."""
    drive = [f"#{m}O2" for m in MOTORS] + ["@wait 2ms"] + ["RX$37", "@wait 1ms"] * 10
    worst = [f"I{m}24=$900001 I{m}84=0 I{m}61=1 I{m}62=2 I{m}76=2" for m in MOTORS]
    clocks = [f"I{ic}00=1473 I{ic}01=3 I{ic}02=1 I{ic}03=1746" for ic in (70, 71)]
    fast = ["I52=24", "I10=1677653", *clocks, "SAVE", "$$$", "@wait 30ms"]
    for change, most in (([], 4400), (fast, 6000)):
        cycles = [2 * int(value) for value in controller(worst + change + drive)]
        check(len(cycles) == 10 and min(cycles) > 2000 and max(cycles) <= most, f"{cycles}, at most {most}")


def commutation_negative():
    """Negative control: with the other value of Ixx72 the current loop runs away, the amplifier trips."""
    found = controller(["I172=683", "#1$", "@wait 60ms", "#1?"])
    check(found[0] == status(1, WORD_1_BITS, (15, 8, 3)), f"{found[0]}: expected an amplifier fault and no reference")


globals()[command.CASE]()
