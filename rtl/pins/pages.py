"""What the documentation and rtl/board/board_sim.sv have of the pins: parts of hand-written files, between two marks,
and docs/pins.md."""
import re

from rows import COMPONENTS, camel

# The deliberate bug of board_sim is in what it shows of this pin.
SEEDED = {"servo": "servo | late"}


def replaced(text, begin, end, lines, path):
    """The text with the lines between two marks exchanged."""
    found = re.search(rf"({re.escape(begin)}\n).*?([ \t]*{re.escape(end)})", text, re.S)
    if not found:
        raise SystemExit(f"{path}: no part '{begin}' to '{end}'")
    return text[:found.end(1)] + "".join(f"{line}\n" for line in lines) + text[found.start(2):]


# board_sim ---------------------------------------------------------------------------------------------------------
def net(pin):
    return pin.rtl.removesuffix("_o")


def ports_of_board(board):
    """port -> (direction, bits) of board_top, as the rows say."""
    ports = {}
    for pin in board.pins:
        if pin.word is None:
            continue
        _, bits = ports.get(pin.rtl, (None, 0))
        ports[pin.rtl] = ("input" if pin.is_input else "output", max(bits, (pin.rtl_bit or 0) + pin.bits))
    return ports


def sim_nets(board):
    for port, (direction, bits) in ports_of_board(board).items():
        if direction == "output":
            yield f"  logic {f'[{bits - 1}:0]' if bits > 1 else '':<6} {port.removesuffix('_o')};"


def sim_ports(board):
    seen = set()
    for pin in board.pins:
        if pin.word is None or pin.group == "own" or pin.rtl in seen:
            continue
        seen.add(pin.rtl)
        value = pin.range(f"inputs_i[{pin.word}]") if pin.is_input else net(pin)
        yield f"    .{pin.rtl:<18} ({value}),"


def concatenation(pins, low, high):
    """Bits low to high of a word, gaps 0."""
    parts, at = [], low
    for pin in sorted(pins, key=lambda pin: pin.lsb):
        if pin.lsb > at:
            parts.append(f"{pin.lsb - at}'h0")
        value = net(pin) if pin.rtl_bit is None else f"{net(pin)}[{pin.rtl_bit}]"
        parts.append(SEEDED.get(pin.name, value))
        at = pin.lsb + pin.bits
    if at <= high:
        parts.append(f"{high + 1 - at}'h0")
    return "{" + ", ".join(reversed(parts)) + "}"


def folded(line):
    """A line of at most 120 characters and its continuations, broken behind a comma."""
    begin = " " * (line.index("{") + 1)
    while len(line) > 120:
        at = line.rindex(", ", 0, 120) + 1
        yield line[:at]
        line = begin + line[at + 1:]
    yield line


def sim_packing(board):
    for word in range(board.words(False)):
        pins = [pin for pin in board.outputs() if pin.word == word]
        full = sum(pin.bits for pin in pins) == 32
        if full or any(pin.lsb // 8 != (pin.lsb + pin.bits - 1) // 8 for pin in pins):
            yield from folded(f"  assign pins_o[{word}] = {concatenation(pins, 0, 31)};")
            continue
        for low in range(0, 32, 8):  # a byte moves without the others
            some = [pin for pin in pins if low <= pin.lsb < low + 8]
            yield f"  assign pins_o[{word}][{low + 7}:{low}] = {concatenation(some, low, low + 7)};"


def write_motor_package(servo, notice):
    """Where board_top and its users find the pins of a servo IC: vectors of all four channels."""
    yield from (f"// {notice}",
                "// The motor side of a servo IC: where motor_i and motor_o have its pins, vectors of all channels,",
                "// the first one lowest.",
                "`default_nettype none", "", "package motor_pins_pkg;", "",
                "  localparam int Stride = 64;  // bits of motor_i and of motor_o for each servo IC that is built")
    for inputs, word in ((True, "In"), (False, "Out")):
        fields = servo.motor_fields(inputs)
        yield from ("", f"  localparam int {word}Bits = {sum(map(len, fields.values()))};  // of these in use")
        for name, bits in fields.items():
            yield f"  localparam int {camel(name) + 'Lsb':<14} = {bits[0]};"
            yield f"  localparam int {camel(name) + 'Width':<14} = {len(bits)};"
    yield from ("", "endpackage : motor_pins_pkg", "", "`default_nettype wire", "")


def board_sim(board, text, path):
    end = "// end of rows"
    for mark, lines in (("nets", sim_nets), ("ports", sim_ports), ("words", sim_packing)):
        text = replaced(text, f"// rows of rtl/pins/board.pins: {mark}", end, lines(board), path)
    return text


# docs/components.md ------------------------------------------------------------------------------------------------
def shown(table):
    """(name, pin) of a component's rows: one channel and one IC stand for all."""
    order = {"ic": 0, "serial": 1, "channel": 2}
    pins = sorted(table.pins, key=lambda pin: order.get(pin.group, 0)) if table.name == "servo_ic" else table.pins
    for pin in pins:
        if not pin.is_port or pin.group == "count" or pin.word is None:
            continue
        if pin.count > 1 and "{n}" in pin.sentence:
            yield from ((f"{pin.port}{n}", pin, pin.sentence.replace("{n}", str(n))) for n in range(pin.count))
        else:
            before, after = ("chN_" if pin.group == "channel" else ""), ("N" if pin.count > 1 else "")
            yield f"{before}{pin.port}{after}", pin, pin.sentence


def idle_of(pin):
    if pin.idle == 0:
        return ""
    return f", idle ${pin.idle:X}" if pin.width > 1 else ", idle 1"


def drawing(table):
    """Inputs on the left, outputs on the right, the socket on top; then the table."""
    inside, margin, title = 26, 24, camel(table.name)
    sides = {True: [], False: []}
    for name, pin, _ in shown(table):
        sides[pin.is_input].append(f"{name}[{pin.width}]" if pin.width > 1 else name)
    before = (inside - len(title)) // 2
    yield "```"
    if "socket" in table.settings:
        yield " " * (margin + 5 + inside // 2) + "║ " + table.settings["socket"]
    yield " " * (margin + 4) + "┌" + "─" * (before - 1) + f" {title} " + "─" * (inside - before - len(title) - 1) + "┐"
    for i in range(max(map(len, sides.values()))):
        left = f"{sides[True][i]:>{margin}} ──►" if i < len(sides[True]) else " " * (margin + 4)
        right = f"──► {sides[False][i]}" if i < len(sides[False]) else ""
        yield f"{left}│{' ' * inside}│{right}"
    yield from (" " * (margin + 4) + "└" + "─" * inside + "┘", "```", "", "| pin | | what | data sheet |",
                "|---|---|---|---|")
    for name, pin, sentence in shown(table):
        bits = f", {pin.width} bits" if pin.width > 1 else ""
        yield f"| `{name}` | {pin.direction}{bits}{idle_of(pin)} | {sentence} | {pin.rule} |"


def components_page(tables, text, path):
    for name in (*COMPONENTS, "board"):
        text = replaced(text, f"<!-- pins of {name} -->", "<!-- end -->", drawing(tables[name]), path)
    return text


# docs/signals.md ---------------------------------------------------------------------------------------------------
def signal_row(name, pin):
    radix = "signed" if pin.group == "count" else "hex" if pin.hex else "bin"
    return f"| `{name}` | {pin.width} {radix} | {pin.sentence} | {pin.valid} |"


HEADER = ("| name | width, radix | what | valid |", "|---|---|---|---|")


def signals_page(tables, text, path):
    shown_pins = [pin for pin in tables["board"].pins if pin.signal]
    for scope in ("clock", "host", "dpram", "ssi", "watchdog"):
        rows = [signal_row(pin.signal, pin) for pin in shown_pins if pin.signal.split(".")[0] == scope]
        text = replaced(text, f"<!-- signals of {scope} -->", "<!-- end -->", [*HEADER, *rows], path)
    rows = [signal_row(pin.signal, pin) for pin in shown_pins if pin.signal.split(".")[0] in ("bus", "cpu")]
    text = replaced(text, "<!-- signals of bus -->", "<!-- end -->", [*HEADER, *rows], path)
    rows = [signal_row(pin.name, pin) for pin in tables["servo_ic"].pins if pin.group in ("channel", "serial", "count")]
    return replaced(text, "<!-- signals of motors -->", "<!-- end -->", [*HEADER, *rows], path)


# docs/chips.md -----------------------------------------------------------------------------------------------------
PORT = re.compile(r"^\s*(input|output|inout)\s+(?:wire\s+)?(?:logic\s*)?(?:\[([^\]]*):0\])?\s*(\w+)\s*,?\s*(?://.*)?$",
                  re.M)
BOTH_WAYS = {"pa_data": "D23..D0", "isa_sd": "SD15..SD0"}  # of which the rows tell one way each


def pad_rows(top, chip, tables, text, path):
    """(pad, bits, direction, sentence, rule) of each port of a top of fpga/, its rows those of the chip, else the
    board's."""
    rows = {}
    for pin in (*tables["board"].pins, *chip.pins):
        rows[pin.name] = rows[re.sub(r"_[io]$", "", pin.rtl)] = pin
    servo = tables["servo_ic"]
    header = re.search(rf"module {top} \((.*?)\);", text, re.S)[1]
    for direction, high, name in PORT.findall(header):
        base = re.sub(r"_n[io]$", "_n", re.sub(r"_(io|i|o)$", "", name))
        way = {"input": "in", "output": "out", "inout": "both"}[direction]
        if base == "clk":
            yield name, 1, way, "oscillator of 39.3216 MHz, the same for all chips", "servo-ic:3.3"
        elif base == "motor":
            pins = [pin for pin in servo.pins if pin.is_input == (way == "in") and pin.group in ("channel", "serial")]
            shared = [f"`{pin.name}`" for pin in pins if pin.group == "serial"]
            of_channel = ", ".join(f"`{pin.name}`" for pin in pins if pin.group == "channel")
            yield (name, sum(map(len, servo.motor_fields(way == "in").values())), way, f"of each channel {of_channel}" +
                   (f"; {', '.join(shared)}" if shared else ""), "servo-ic:5")
        elif base not in rows:
            raise SystemExit(f"{path}: port {name} has no row in rtl/pins")
        else:
            bits = int(high or 0) + 1 if not high or high.isdigit() else 0
            if not 0 < bits <= rows[base].bits:
                raise SystemExit(f"{path}: port {name} has {bits} bits; expected at most {rows[base].bits}, of its row")
            yield name, bits, way, BOTH_WAYS.get(base, rows[base].sentence), rows[base].rule


def chips_page(tables, chips, root, text, path):
    for name, chip in chips.items():
        top = f"fpga/{name}_ecp5.sv"
        rows = list(pad_rows(f"{name}_ecp5", chip, tables, (root / top).read_text(), top))
        lines = ["| pad | pads | | what | data sheet |", "|---|---|---|---|---|",
                 *(f"| `{pad}` | {bits} | {way} | {sentence} | {rule} |" for pad, bits, way, sentence, rule in rows),
                 f"| all | {sum(row[1] for row in rows)} | | | |"]
        text = replaced(text, f"<!-- pads of {name} -->", "<!-- end -->", lines, path)
    return text


# docs/pins.md ------------------------------------------------------------------------------------------------------
def way(board, pin, kind, registers):
    if f"reason {kind}" in board.settings:
        return f"{'by' if pin.is_input else 'made of'} {', '.join(f'`{name}`' for name in registers)} ({kind})"
    return {"synchroniser": "synchroniser", "selected": "synchroniser behind a jumper's multiplexer",
            "clocks": f"clocks {', '.join(f'`{name}`' for name in registers)}",
            "resets": "acts without a clock",
            "through": f"follows {', '.join(f'`{name}`' for name in registers)} without a clock"}[kind]


def link(page, place=""):
    return f"[{page}]({page}.md{place})"


def write_pins_page(tables, notice):
    board = tables["board"]
    yield from (f"<!-- {notice} -->", "# Board pins", "",
                "The pins of the controller board, as every engine shows them: what drives them, where the packed",
                "words have them, and how the RTL may look at them, which `lint.cdc` holds. An output",
                "is one flip-flop, or has what else it is made of, which `lint.outputs` holds. A row here is a row of",
                "`rtl/pins/board.pins`; what is made of it, and what a new one takes, is in "
                f"{link('architecture', '#board-pins')}.", f"Signals of waveforms and scripts: {link('signals')}. "
                f"Pins of single blocks: {link('components')}; pads of a board of several chips: {link('chips')}.", "")
    for key, text in board.settings.items():
        if key.startswith("reason "):
            yield f"- *{key.removeprefix('reason ')}*: {text}"
    for title, inputs in (("Inputs", True), ("Outputs", False)):
        yield from ("", f"## {title}", "", "| pin | bits | port of `board_top` | place | " +
                    ("idle | driven by | sampled | " if inputs else "signal | gates | ") + "what | data sheet |",
                    "|---|---|---|---|---|---|" + ("---|---|---|" if inputs else "---|---|"))
        for pin in board.pins:
            if pin.is_input != inputs:
                continue
            bit = "" if pin.rtl_bit is None else f"[{pin.rtl_bit}]"
            port = "" if pin.word is None else f"`{pin.rtl}{bit}`"
            place = "" if pin.word is None or pin.group == "own" else f"{pin.word}.{pin.lsb}"
            ways = "; ".join(way(board, pin, *one) for one in pin.sampled)
            middle = f"${pin.idle:X} | `{pin.group}` | {ways}" if inputs else f"`{pin.signal}` | {ways}"
            yield f"| `{pin.name}` | {pin.width} | {port} | {place} | {middle} | {pin.sentence} | {pin.rule} |"
    yield ""
