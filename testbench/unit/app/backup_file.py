"""A backup of a controller, made by the data sheet: what a program that reads a real one out writes into its files.

Variables of every group with values of their ranges (firmware:2, firmware:3), P, Q, M definitions of every form
(firmware:1.8), axis definitions (firmware:7.4) and PLC programs of every statement that they may hold (firmware:7.2).
Everything in it a real controller takes. usage: backup_file.py FOLDER; FOLDER/backup.pmc includes the other files.
With `each` every third variable or PLC is in it, or so: every form of them still.
"""
import itertools
import pathlib
import random
import sys

GLOBALS = {2: 1, 3: 2, 6: 1, 8: 2, 9: 2, 10: 3713991, 16: 5, 17: 10, 18: 10, 19: 7007, 37: "$0", 52: 7, 53: 12, 54: 12,
           60: 15, 61: 8, 63: 1, 67: "$0", 68: 15, 78: 32, 79: 32, 80: 32, 81: 32, 82: 32, 83: 15, 84: 3, 85: 32,
           **dict.fromkeys((*range(20, 25), *range(69, 78)), "$0"),
           **dict(enumerate(("$39", "$4", "$FF", "$7F", "$A0", "$7", "$A1", "$0", "$60", "$30"), start=90))}
MOTOR = {2: "$78002", 3: "$3501", 4: "$3501", 5: "$35C0", 7: 96, 8: 96, 9: 96, 10: "$0", 11: 32000, 12: 16000,
         13: 1250.5, 14: -1250.5, 15: 0.25, 16: 32, 17: 0.015625, 19: 0.015625, 21: 50, 22: 32, 23: 32, 24: "$1",
         25: "$78000", 26: -16, 27: 4000.25, 28: 160, 29: -3, 30: 2000, 31: 1280, 32: 1280, 34: 1, 36: 0.5, 39: -0.5,
         42: "$0", 43: "$0", 55: "$0", 63: 4194304, 65: 16, 66: 6527, 67: 4194304, 69: 20480, 70: 1, 71: 1000, 72: 1365,
         **dict.fromkeys((81, 82, 84, 91, 95), "$0"), 83: "$78001", 87: 64, 92: 10}
COORDINATE_SYSTEM = {88: 50, 89: 1000, 90: 1000, 93: "$2000", 94: 1644, 95: 1644, 99: 0.9998474121}
SERVO_IC = {0: 6527, 2: 3, 3: 2258, 4: 15, 5: "$7FFFC0", 6: "$FFFFFE"}
CHANNEL = {0: 7, 2: 1}
PLCS, PLC_LINES = 31, 110


def i_variables():
    for n in range(8192):
        if 4900 <= n <= 4999:
            continue  # read-only, in no backup
        if n < 100:
            value = GLOBALS.get(n, 0)
        elif n < 3300:
            value = n // 100 if n % 100 == 0 and n == 100 else MOTOR.get(n % 100, 0)
        elif 5100 <= n < 6700:
            value = COORDINATE_SYSTEM.get(n % 100, 0)
        elif 7000 <= n < 7200 and n % 100 < 50:
            value = 3 if n == 7107 else SERVO_IC.get(n % 100, 0) if n % 100 < 10 else CHANNEL.get(n % 10, 0)
        else:
            value = f"$78{(n - 8000) % 8 * 8:03X}" if n >= 8000 else 0
        yield f"I{n}={value}"


def numbers(seed):
    """Values as a controller reports them: integers, fractions of up to ten digits, both signs."""
    chosen = random.Random(seed)
    while True:
        yield chosen.choice([0, chosen.randint(-10**6, 10**6), chosen.randint(-10**9, 10**9) / 2**10,
                             chosen.randint(1, 999) / 1000])


def text_of(value):
    return f"{value:.10f}".rstrip("0").rstrip(".") if isinstance(value, float) else str(value)


def p_values(each):
    return dict(itertools.islice(zip(range(8192), numbers(1), strict=False), 0, None, each))


def pq_variables(each):
    for n, value in p_values(each).items():
        yield f"P{n}={text_of(value)}"
    for cs in range(1, 17):
        values = numbers(1 + cs)
        yield f"&{cs}"
        for n in range(0, 200, each):
            yield f"Q{n}={text_of(next(values))}"


def m_definitions():
    """(kind, line), the forms in turn; none points to a register that somebody assigns."""
    words = [(f"{space}:$", f",{offset},{width}{sign}") for space in "XY" for width in (4, 8, 12, 16, 20)
             for offset in range(0, 25 - width, 4) for sign in ("", ",S", ",U")]
    words += [(f"{space}:$", f",{bit}{one}") for space in "XY" for bit in range(24) for one in ("", ",1")]
    words += [(f"{space}:$", form) for space in "XY" for form in (",24", ",0,24", ",0,24,U", ",0,24,S")]
    words += [("D:$", ""), ("L:$", ""), ("DP:$60", "")]
    forms = [("M definition", word) for word in words for _ in range(6)] + [("M definition", None)] * 20
    forms += [("M of signed words", (f"{space}:$", ",24,S")) for space in "XY"] * 6
    forms += [("M of DPRAM floats", ("F:$60", ""))] * 8
    forms += [("M of BCD", ("Y:$", f",{offset},4,{code}")) for offset in (0, 4) for code in "DC"]
    forms += [("M of accessories", (name, "")) for name in ("TWD:4,0,8.3,U", "TWB:0,5,8,S", "TWR:0,0", "TWS:1")]
    turn = itertools.cycle(forms)
    for n in range(8192):
        kind, form = next(turn)
        if form is None:
            target = "*"
        elif form[0].startswith("TW"):
            target = form[0]
        else:
            address = f"{0x200 + n % 0xC00:X}" if form[0].endswith("60") else f"{0x10000 + n:X}"
            target = form[0] + (address if form[0].endswith("60") else "0" + address) + form[1]
        yield kind, f"M{n}->{target}"


def axis_definitions():
    yield "UNDEFINE ALL"
    forms = ("1000X", "-1000Y", "2000Z-666.667", "100A+500", "0.5B", "360C", "1000U", "1000.25V+3", "100W")
    for cs in range(1, 4):
        yield f"&{cs}"
        for axis, form in enumerate(forms):
            yield f"#{(cs - 1) * len(forms) + axis + 1}->{form}"
    yield "&4"
    yield from ("#28->8660X-5000Y", "#29->5000X+8660Y+100", "#30->I", "#31->I", "#32->0")


def plc(number):
    """Of every statement that a PLC may hold, then of assignments."""
    yield f"OPEN PLC {number} CLEAR"
    body = [f"ADDRESS#{number % 32 + 1}&{number % 4 + 1}", "IF(M4900=0)", "AND(P1>3 OR P2!<-4)", "M4900=1", "ELSE",
            f"I5111={number}*8388608/I10", "WHILE(I5111>0 AND M1=0)", "ENDWHILE", "ENDIF", "IF(P3~5)", "OR(Q1!=7)",
            "P4=SIN(P5)*2", f"P{number + 100}=P{number + 100}%16|$F0", "ENDI", "WHILE(P6<0)", "P6=P6+1", "ENDW",
            "CMD\"&1B10R\"", "COMMAND\"#1J/\"", "CMD^A", "SENDP\"done; // not a comment\"", "SEND\"ready\"",
            f"DISABLE PLC {number}", "ENABLE PLC 0..3", "DIS PLC4,5", "PAUSE PLC6", "RESUME PLC6", "M100=M101^$3",
            "I124=I124|$20000", "P(P1+10)=Q(10)", "RETURN"]
    yield from body
    for n in range(PLC_LINES - len(body)):
        yield f"P{1000 + n}=(P{1001 + n}*I{number}08-{n}.5)/Q{n % 50}"
    yield "CLOSE"


def lines(each):
    """(file, kind, line) of the backup, in the order in which they are sent."""
    yield "backup.pmc", "buffers", "CLOSE"
    yield "backup.pmc", "buffers", "DELETE GATHER"
    for line in itertools.islice(i_variables(), 0, None, each):
        yield "variables.pmc", "I variable", line
    for line in pq_variables(each):
        yield "variables.pmc", "P or Q variable", line
    for kind, line in itertools.islice(m_definitions(), 0, None, each):
        yield "variables.pmc", kind, line
    for line in axis_definitions():
        yield "axes.pmc", "axis definition", line
    for number in range(1, PLCS + 1, each):
        for line in plc(number):
            yield "plcs.pmc", "PLC", line


def write(folder, each=1):
    """Writes the files; returns `file:line` -> (kind, line)."""
    files = {name: [f"; {name}, made by the data sheet", "/* what is read out of a controller",
                    "   has comments like these */"]
             for name in ("backup.pmc", "variables.pmc", "axes.pmc", "plcs.pmc")}
    places = {}
    for file, kind, line in lines(each):
        if file != "backup.pmc":
            include = f'#include "{file}" ; in its turn'
            if include not in files["backup.pmc"]:
                files["backup.pmc"].append(include)
        files[file].append(line)
        places[f"{pathlib.Path(folder) / file}:{len(files[file])}"] = (kind, line)
    for name, text in files.items():
        (pathlib.Path(folder) / name).write_text("\n".join(text) + "\n")
    return places


if __name__ == "__main__":
    print(len(write(sys.argv[1])), "lines")
