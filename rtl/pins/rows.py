"""Reads the tables of pins, *.pins beside this file: plain text, a row a pin, columns as their first row names them.

Lines that begin with # are comments. `KEY [NAME]: TEXT` before the columns is a setting of the file (a reason why a pin
may be sampled, a line of its drawing). A file that says nothing sensible ends the program with file, line and what was
expected.
"""
import dataclasses
import re
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
COLUMNS = ("name", "direction", "width", "group", "place", "motor", "idle", "sampled", "rtl", "port", "signal",
           "drives", "rule", "sentence", "valid")
COMPONENTS = ("servo_ic", "macro_ic", "clock_select", "interrupt_controller", "host_port", "dpram", "host_signals",
              "ssi", "watchdog")  # with those of the board all that there are
CHANNELS = 4


def camel(name):
    return "".join(part[:1].upper() + part[1:] for part in name.split("_"))


def fail(where, text):
    sys.exit(f"{where}: {text}")


@dataclasses.dataclass(frozen=True)
class Pin:
    name: str
    direction: str
    width: int
    count: int  # of pins that the row stands for: NAME[COUNT]
    group: str
    word: int | None  # None: has no place
    word_step: int    # a channel
    lsb: int
    lsb_step: int
    motor: tuple | None  # (bit, step a channel) in motor_i of the RTL
    idle: int
    sampled: tuple    # of (way, patterns of registers)
    rtl: str          # port, without the bit
    rtl_bit: int | None
    port: str         # of the component
    signal: str
    hex: bool
    drives: str
    rule: str
    sentence: str
    valid: str

    @property
    def is_input(self):
        return self.direction == "in"

    @property
    def is_port(self):
        """A component has a port of it."""
        return self.direction != "inner" and self.group != "inner"

    @property
    def constant(self):
        return "k" + camel(self.name)

    @property
    def bits(self):
        return self.width * self.count

    def motor_bits(self):
        """Its bits in motor_i or motor_o of the RTL, of all channels that have one of their own."""
        bit, step = self.motor if self.is_input else (32 * self.word + self.lsb, self.lsb_step)
        return [bit + n * step for n in range(CHANNELS if step else 1)]

    def range(self, word):
        """Its bits of a packed vector, as SystemVerilog writes them."""
        return f"{word}[{self.lsb}]" if self.bits == 1 else f"{word}[{self.lsb + self.bits - 1}:{self.lsb}]"


def rtl_port(name, direction):
    if direction == "in":
        return name if name.endswith("_i") else f"{name}i" if name.endswith("_n") else f"{name}_i"
    return name if name.endswith("_o") else f"{name}_o"


def number(where, column, text, largest):
    try:
        value = int(text, 0)
    except ValueError:
        value = -1
    if not 0 <= value <= largest:
        fail(where, f"{column} is '{text}'; expected 0 to {largest:#x}")
    return value


def sampled_ways(text):
    for way in filter(None, (way.strip() for way in text.split(";"))):
        kind, *registers = way.split()
        yield kind, tuple(registers)


def motor_place(where, cells):
    place = re.fullmatch(r"(?:(\d+)(?:\+(\d+))?)?", cells.get("motor", ""))
    if not place:
        fail(where, f"motor is '{cells['motor']}'; expected BIT or BIT+STEP")
    return (int(place[1]), int(place[2] or 0)) if place[1] else None


def make_pin(where, cells):
    name = re.fullmatch(r"([a-z][a-z0-9_]*)(?:\[(\d+)\])?", cells["name"])
    if not name:
        fail(where, f"'{cells['name']}' is no name of a pin; expected small letters, digits and _, then [COUNT] or not")
    if cells["direction"] not in ("in", "out", "inner"):
        fail(where, f"direction is '{cells['direction']}'; expected in, out or inner")
    width = number(where, "width", cells["width"], 32)
    place = re.fullmatch(r"(?:(\d)(\+?)\.(\d+)(?:\+(\d+))?)?", cells.get("place", ""))
    if not place:
        fail(where, f"place is '{cells['place']}'; expected WORD.BIT, WORD+.BIT or WORD.BIT+STEP")
    word, step, lsb, lsb_step = place.groups()
    count = int(name[2] or 1)
    if width == 0 or int(lsb or 0) + width * count > 32:
        fail(where, f"{width * count} bits from bit {lsb or 0} on; expected 1 to 32 bits of one word")
    if not cells["rule"] or not cells["sentence"]:
        fail(where, "expected a rule of the data sheet and a sentence")
    rtl = re.fullmatch(r"(\w*)(?:\[(\d+)\])?", cells.get("rtl", ""))
    signal, *radix = cells.get("signal", "").split() or [""]
    return Pin(
        name=name[1], direction=cells["direction"], width=width, count=count, group=cells.get("group", ""),
        word=None if word is None else int(word), word_step=1 if step else 0, lsb=int(lsb or 0),
        lsb_step=int(lsb_step or 0), motor=motor_place(where, cells),
        idle=number(where, "idle", cells.get("idle") or "0", 2 ** width - 1),
        sampled=tuple(sampled_ways(cells.get("sampled", ""))), rtl=rtl[1] or rtl_port(name[1], cells["direction"]),
        rtl_bit=None if rtl[2] is None else int(rtl[2]), port=cells.get("port") or name[1], signal=signal,
        hex=radix == ["hex"] if radix else width > 1, drives=cells.get("drives", ""), rule=cells["rule"],
        sentence=cells["sentence"], valid=cells.get("valid", ""))


def check_places(path, pins):
    """Each bit of a word is one pin's, each name one row's."""
    taken, names = {}, set()
    for pin in pins:
        if (pin.is_input, pin.name) in names:
            fail(path, f"{pin.name} has two rows of one direction")
        names.add((pin.is_input, pin.name))
        if pin.word is None:
            continue
        for n in range(CHANNELS if pin.word_step or pin.lsb_step else 1):
            for bit in range(pin.bits):
                place = (pin.is_input, pin.group == "count", pin.word + n * pin.word_step,
                         pin.lsb + n * pin.lsb_step + bit)
                if place in taken:
                    fail(path, f"{pin.name} and {taken[place]} have bit {place[3]} of word {place[2]} both")
                taken[place] = pin.name


class Table:
    """A file of rows: its pins in their order, its settings."""

    def __init__(self, name, folder=FOLDER):
        self.name, self.path = name, folder / f"{name}.pins"
        self.settings, self.pins, columns = {}, [], None
        for count, line in enumerate(self.path.read_text().splitlines(), 1):
            where, text = f"{self.path.name}:{count}", line.strip()
            if not text or text.startswith("#"):
                continue
            if columns is None and "|" not in text:
                key, _, value = text.partition(":")
                self.settings[key] = value.strip()
                continue
            cells = [cell.strip() for cell in line.split("|")]
            if columns is None:
                columns = cells
                for column in set(columns) - set(COLUMNS):
                    fail(where, f"column '{column}'; expected some of {', '.join(COLUMNS)}")
            elif len(cells) != len(columns):
                fail(where, f"{len(cells)} cells; expected {len(columns)}: {' | '.join(columns)}")
            else:
                self.pins.append(make_pin(where, dict(zip(columns, cells, strict=True))))
        check_places(self.path.name, self.pins)
        for pin in self.pins:
            for kind, _ in pin.sampled:
                if kind not in ("synchroniser", "selected", "clocks", "resets", "through") and \
                        f"reason {kind}" not in self.settings:
                    fail(self.path.name, f"{pin.name} is sampled '{kind}'; expected a way of the header or a reason")

    def inputs(self):
        return [pin for pin in self.pins if pin.is_input]

    def outputs(self):
        return [pin for pin in self.pins if not pin.is_input]

    def groups(self):
        """Names of the groups, in the order of their first rows."""
        return list(dict.fromkeys(pin.group for pin in self.pins))

    def of(self, group):
        return [pin for pin in self.pins if pin.group == group]

    def motor_fields(self, inputs):
        """{vector of the RTL: its bits of motor_i or motor_o}, each without a gap, lowest first."""
        fields = {}
        for pin in self.pins:
            if pin.group in ("channel", "serial") and pin.is_input == inputs:
                fields.setdefault(pin.rtl, []).extend(pin.motor_bits())
        taken = sorted(bit for bits in fields.values() for bit in bits)
        if taken != list(range(len(taken))):
            fail(self.path.name, f"motor_{'i' if inputs else 'o'} has bits {taken}; expected each from 0 on once")
        for name, bits in fields.items():
            if max(bits) - min(bits) >= len(bits):
                fail(self.path.name, f"{name} has bits {sorted(bits)}; expected one range")
        return {name: sorted(bits) for name, bits in fields.items()}

    def words(self, inputs):
        return 1 + max(pin.word for pin in self.pins if pin.is_input == inputs and pin.word is not None)
