"""C++ of the pins: structures, packed words and drive tables of board and motor side (.hpp), of the components their
members (public headers), pin tables, and places in the packed words with the ports of the Verilated module."""
from rows import CHANNELS, camel, fail

ON = "// clang-format off"


def type_of(pin):
    return "bool" if pin.width == 1 else next(f"std::uint{n}_t" for n in (8, 16, 32) if pin.width <= n)


def literal(pin):
    if pin.width == 1:
        return "true" if pin.idle else "false"
    return f"0x{pin.idle:X}" if pin.idle > 9 else str(pin.idle)


def plain(text):
    return text.replace("`", "")


def cited(pin):
    return plain(pin.sentence) if f"({pin.rule}" in pin.sentence else f"{plain(pin.sentence)} ({pin.rule})"


def text_of(text):
    escaped = plain(text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


# Board and motor side ----------------------------------------------------------------------------------------------
def group_struct(group, pins):
    yield f"struct {group} {{"
    for pin in pins:
        yield f"  {type_of(pin)} {pin.name} = {literal(pin)};  // {cited(pin)}"
    zeros = ", ".join("false" if pin.width == 1 else "0" for pin in pins)
    same = " && ".join(f"{pin.name} == o.{pin.name}" for pin in pins)
    yield ""
    if all(kind == "strap" for pin in pins for kind, _ in pin.sampled):
        yield f"  static constexpr {group} none() {{ return {{{zeros}}}; }}  // as a reset leaves what takes them over"
    yield from (f"  bool operator==(const {group}& o) const {{",
                f"    if constexpr (std::has_unique_object_representations_v<{group}>)",
                "      return std::memcmp(this, &o, sizeof o) == 0;  // no byte between them",
                "    else", f"      return {same};", "  }",
                f"  bool operator!=(const {group}& o) const {{ return !(*this == o); }}", "};", "")


def input_groups(board):
    return [group for group in board.groups() if group not in ("own", "board", "inner")]


def write_board_pins(board, notice):
    yield from (f"// {notice}",
                "// Inputs of the board in groups by who drives them, places of its outputs in their packed words.", ON,
                "#pragma once", "", "#include <array>", "#include <cstdint>", "#include <cstring>",
                "#include <string_view>", "#include <type_traits>", "", "namespace brick {", "")
    for group in input_groups(board):
        yield from group_struct(group, board.of(group))
    yield from ("// One field of the packed output words. `name` is the trace and script name (docs/signals.md), scope",
                "// `brick` left out.", "struct PinField {", "  std::string_view name;", "  unsigned word;",
                "  unsigned lsb;", "  unsigned width;", "  bool hex;", "};", "",
                f"constexpr unsigned kBoardOutputWords = {board.words(False)};", "", "namespace pin {")
    for pin in board.outputs():
        hexed = "true" if pin.hex else "false"
        yield (f'constexpr PinField {pin.constant}{{"{pin.signal}", {pin.word}, {pin.lsb}, {pin.width}, {hexed}}};'
               f"  // {plain(pin.sentence)}")
    yield "inline constexpr std::array kAll{"
    yield from listed(pin.constant for pin in board.outputs())
    yield from ("};", "}  // namespace pin", "", "}  // namespace brick", "")


def listed(names, indent="    "):
    """Names between commas, as many a line as fit."""
    line = indent
    for name in names:
        if len(line) + len(name) > 116:
            yield line.rstrip()
            line = indent
        line += name + ", "
    yield line.rstrip().rstrip(",")


def write_board_inputs(board, notice):
    words = 1 + max(pin.word for pin in board.inputs() if pin.word is not None and pin.group != "own")
    yield from (f"// {notice}", "// Where the packed input words of a Verilated board have what, and the named signals",
                "// of inputs.", ON, "#pragma once", "",
                "#include <tuple>", "", '#include "rtl/pins/board_pins.hpp"', "", "namespace brick {", "",
                "template <class Group, class Value>", "struct InputField {", "  std::string_view name;",
                "  Value Group::*pin;", "  unsigned word, lsb, width;", "};", "template <class Group, class Value>",
                "InputField(std::string_view, Value Group::*, unsigned, unsigned, unsigned) -> "
                "InputField<Group, Value>;", "", f"constexpr unsigned kBoardInputWords = {words};", "",
                "// All of one port; what has a port of its own is apart.", "inline constexpr std::tuple kInputFields{")
    packed = [pin for pin in board.inputs() if pin.group != "own" and pin.word is not None]
    for pin in packed:
        end = "" if pin is packed[-1] else ","
        yield (f'    InputField{{"{pin.name}", &{pin.group}::{pin.name}, {pin.word}, {pin.lsb}, {pin.width}}}{end}')
    yield from ("};", "", "// A signal that shows an input as it is driven.", "template <class Group, class Value>",
                "struct InputSignal {", "  std::string_view name;", "  Value Group::*pin;", "  unsigned width;",
                "  bool hex;", "};", "template <class Group, class Value>",
                "InputSignal(std::string_view, Value Group::*, unsigned, bool) -> InputSignal<Group, Value>;", "",
                "inline constexpr std::tuple kInputSignals{")
    shown = [pin for pin in board.inputs() if pin.signal]
    for pin in shown:
        end = "" if pin is shown[-1] else ","
        yield (f'    InputSignal{{"{pin.signal}", &{pin.group}::{pin.name}, {pin.width}, '
               f'{"true" if pin.hex else "false"}}}{end}')
    yield from ("};", "", "}  // namespace brick", "")


def write_board_ports(board, notice):
    """For a Verilated module with the board's ports themselves."""
    ports = [pin for pin in board.pins if pin.word is not None]
    yield from (f"// {notice}", "// The ports of a Verilated board_chip, or another module with those of board_top.",
                ON, "#pragma once", "", "#include <cstdint>", "", "namespace brick {", "", "// `in`: BoardInputs.",
                "template <class Chip, class Inputs>", "void drive_ports(Chip& chip, const Inputs& in) {")
    for pin in ports:
        if pin.is_input:
            yield f"  chip.{pin.rtl} = in.{pin.name};"
    yield from ("}", "", "// `out`: BoardOutputs.", "template <class Chip, class Outputs>",
                "void read_ports(const Chip& chip, Outputs& out) {")
    for word in range(board.words(False)):
        parts = []
        for pin in ports:
            if not pin.is_input and pin.word == word:
                value = f"std::uint32_t{{chip.{pin.rtl}}}"
                if pin.rtl_bit is not None:
                    value = f"({value} >> {pin.rtl_bit} & 1u)"
                parts.append(value if pin.lsb == 0 else f"{value} << {pin.lsb}")
        yield f"  out.w[{word}] = {(' |' + chr(10) + ' ' * 13).join(parts)};"
    yield from ("}", "", "}  // namespace brick", "")


def write_motor_pins(servo, notice):
    channel = servo.of("channel")
    flags = [pin for pin in channel if pin.is_input and not pin.name.startswith("adc_")]
    adc = {pin.name: pin.motor[0] for pin in channel if pin.is_input and pin not in flags}
    if any(pin.motor != (flags[0].motor[0] + pin.lsb, flags[0].motor[1]) for pin in flags):
        fail(servo.path.name, "a channel's pins stand in motor_i otherwise than in its word; expected them alike")
    idle = " | ".join(f"1u << {pin.constant}" for pin in reversed(flags) if pin.idle)
    outputs = [pin for pin in servo.pins if not pin.is_input and pin.group in ("channel", "serial", "count")]
    words = 1 + max(pin.word + (CHANNELS - 1) * pin.word_step for pin in outputs)
    yield from (f"// {notice}", "// The pins of a servo IC's channels: bits of the inputs, places of the outputs.", ON,
                "#pragma once", "", "#include <array>", "#include <cstdint>", "#include <string_view>", "",
                "namespace brick {", "", "// Input pins of a channel, bits as in status word bits 23..12.",
                "enum ChannelPin : unsigned {")
    for pin in flags:
        yield f"  {pin.constant} = {pin.lsb},  // {cited(pin)}"
    yield from (f"  kChannelPins = {len(flags)}", "};",
                "constexpr std::array<std::string_view, kChannelPins> kChannelPinNames{")
    yield from listed(f'"{pin.name}"' for pin in flags)
    yield from ("};", "// Nothing connected: these are pulled up, the others show 0 (servo-ic:5.15/6).",
                "constexpr std::uint16_t kIdleChannelPins =", f"    {idle};",
                "// motor_i of the RTL: channel n has its pins from kMotorPinsLsb + n * kMotorPinsStep on, ADCs at",
                "// kMotorAdcALsb + n, kMotorAdcBLsb + n.",
                f"constexpr unsigned kMotorPinsLsb = {flags[0].motor[0]}, kMotorPinsStep = {flags[0].motor[1]};",
                f"constexpr unsigned kMotorAdcALsb = {adc['adc_a']}, kMotorAdcBLsb = {adc['adc_b']};", "",
                f"constexpr unsigned kMotorOutputWords = {words};", "",
                "// A field that every channel has: channel n (0..3) has it at lsb + n * stride, or in word + n when",
                "// the stride is 0.", "struct MotorField {",
                '  std::string_view name;  // of the signal, after "servo_icI.chN."',
                "  unsigned word, lsb, width, stride;",
                "  bool shared = false;  // one pin of the IC, shown under each of its channels", "};", "",
                "namespace motor_pin {")
    for pin in outputs:
        shared = ", true" if pin.group == "serial" else ""
        yield (f'constexpr MotorField {pin.constant}{{"{pin.name}", {pin.word}, {pin.lsb}, {pin.width}, '
               f"{pin.lsb_step}{shared}}};  // {cited(pin)}")
    yield "inline constexpr std::array kAll{"
    yield from listed(pin.constant for pin in outputs)
    yield from ("};", "}  // namespace motor_pin", "", "}  // namespace brick", "")


# Components --------------------------------------------------------------------------------------------------------
def member(pin):
    kind = "In" if pin.is_input else "Out"
    pins = f"{kind}<>" if pin.width == 1 else f"{kind}<{pin.width}>"
    return f"std::array<{pins}, {pin.count}>" if pin.count > 1 else pins


def remark(pin):
    idle = f"; idle {'1' if pin.width == 1 else f'${pin.idle:X}'}" if pin.idle else ""
    return f"{cited(pin).replace('{n}', 'n')}{idle}"


def ports_struct(name, pins, channel=False):
    made = 'Component& ic, unsigned number, const std::string& prefix = ""' if channel else (
        "Component& owner, const std::string& prefix")
    yield from (f"struct {name} {{", f"  {name}({made});")
    for pin in pins:
        yield f"  {member(pin)} {pin.port};  // {remark(pin)}"
    yield from ("};", "")


def structs_of(table):
    """(name, pins, whether it is one of a channel) of the structures with ports that a component is made of."""
    whole = camel(table.name)
    if table.name == "servo_ic":
        return [(f"{whole}Channel", table.of("channel"), True), (f"{whole}SerialPins", table.of("serial"), False),
                (f"{whole}Pins", table.of("ic"), False)]
    return [(f"{whole}Pins", [pin for pin in table.pins if pin.is_port and pin.word is not None], False)]


def write_ports(table, notice):
    yield from (f"// {notice}", f"// Pins of the component {camel(table.name)}, which has them as members.", ON,
                "#pragma once", "", "#include <array>", "#include <string>", "", "#include <brick/pins.h>", "",
                "namespace brick::component {", "")
    for struct in structs_of(table):
        yield from ports_struct(*struct)
    yield from ("}  // namespace brick::component", "")


def constructor(name, pins, channel):
    if channel:
        yield f"{name}::{name}(Component& ic, unsigned number, const std::string& prefix)"
        owner, prefix = "ic", 'prefix + "ch" + std::to_string(number) + "_'
    else:
        yield f"{name}::{name}(Component& owner, const std::string& prefix)"
        owner, prefix = "owner", 'prefix + "'
    for place, pin in enumerate(pins):
        name_of = f'{prefix}{pin.port}"'
        value = f"{pin.port}({owner}, {name_of})"
        if pin.count > 1:
            value = f"{pin.port}(pin_array<{member(pin).split('<', 1)[1].rsplit(',', 1)[0]}, {pin.count}>({owner}, " \
                    f"{name_of}))"
        yield f"    {':' if place == 0 else ' '} {value}{' {}' if pin is pins[-1] else ','}"


DIRECTIONS = {"in": "PinDirection::kIn", "out": "PinDirection::kOut", "inner": "PinDirection::kInner"}


def info_rows(pins):
    for pin in pins:
        direction = DIRECTIONS[pin.direction if pin.is_port else "inner"]
        name = pin.port if pin.is_port else pin.signal or pin.name
        for n in range(pin.count):
            number = str(n) if pin.count > 1 else ""
            yield (f'      {{"{name}{number}", {direction}, {pin.word}, {pin.lsb + n}, {pin.width}, '
                   f'{pin.idle:#x}, "{pin.rule}", {text_of(pin.sentence.replace("{n}", str(n)))}}},')


def write_table(table, notice):
    """Pin table and constructors of the ports."""
    whole = camel(table.name)
    header = f"#include <brick/{table.name}.h>"
    yield from (f"// {notice}", f"// The pin table of the component {whole} and its ports.", ON, header, "")
    if table.name in ("servo_ic", "board"):
        yield from (f'#include "systemc/component/{table.name}/{table.name}_pins.h"', "")
    yield from ("namespace brick::component {", "")
    if table.name == "servo_ic":
        yield from motor_rows(table)
        yield f"const std::vector<PinInfo>& {table.name}_rows() {{"
        yield "  static const std::vector<PinInfo> table{"
        yield from info_rows(table.of("ic"))
    elif table.name == "board":
        yield "const std::vector<PinInfo>& board_rows() {"
        yield "  static const std::vector<PinInfo> table{"
        yield from info_rows([pin for pin in table.pins if pin.word is not None])
    else:
        yield f"const std::vector<PinInfo>& {whole}::pin_table() {{"
        yield "  static const std::vector<PinInfo> table{"
        yield from info_rows(table.pins)
    yield from ("  };", "  return table;", "}", "")
    for name, pins, channel in structs_of(table):
        yield from (*constructor(name, pins, channel), "")
    yield from ("}  // namespace brick::component", "")


def motor_rows(table):
    for group in ("serial", "channel"):
        yield f"const std::vector<MotorRow>& {group}_rows() {{"
        yield "  static const std::vector<MotorRow> rows{"
        for pin in table.of(group):
            yield (f'      {{{{"{pin.name}", {DIRECTIONS[pin.direction]}, {pin.word}, {pin.lsb}, {pin.width}, '
                   f'{pin.idle:#x}, "{pin.rule}", {text_of(pin.sentence)}}}, {pin.word_step}, {pin.lsb_step}}},')
        yield from ("  };", "  return rows;", "}", "")


def write_words(table, notice):
    """Places in the packed words, and what the ports of the Verilated module are called."""
    space = f"{table.name}_words"
    own = table.of("ic") if table.name == "servo_ic" else table.pins
    yield from (f"// {notice}", f"// Where the packed words of the component {camel(table.name)} have its pins, and to",
                "// which ports of the Verilated module they go.", ON, "#pragma once", "",
                '#include "systemc/component/chip.h"', "", f"namespace brick::component::{space} {{", "")
    for pin in table.pins:
        if pin.group in ("count", "serial") or (pin.group == "channel" and not pin.name.startswith("adc_")):
            continue  # core/motor_pins.h has these
        note = "  // of a channel's word" if pin.group == "channel" else ""
        yield f"constexpr PinPlace {pin.constant}{{{pin.word}, {pin.lsb}, {pin.bits}}};{note}"
    yield from (f"constexpr unsigned kInputWords = {table.words(True)}, kOutputWords = {output_words(own)};", "",
                "struct PortMap {", f"  static constexpr unsigned kOutputWords = {space}::kOutputWords;",
                "  template <class V>", "  static void drive(V& v, const PinWords& in) {")
    for pin in own:
        if pin.is_input:
            yield f"    {pin.constant}.drive(v.{pin.rtl}, in);"
    yield from ("  }", "  template <class V>", "  static void sample(const V& v, PinWords& out) {")
    outputs = [pin for pin in own if not pin.is_input]
    for word in sorted({pin.word for pin in outputs}):
        parts = [f"{pin.constant}.at({sampled_value(pin)})" for pin in outputs if pin.word == word]
        yield f"    out[{word}] = {' | '.join(parts)};"
    yield from ("  }", "};", "", f"}}  // namespace brick::component::{space}", "")


def output_words(pins):
    return 1 + max(pin.word for pin in pins if not pin.is_input)


def sampled_value(pin):
    value = f"v.{pin.rtl}"
    if pin.rtl_bit is not None:
        value = f"{value} >> {pin.rtl_bit}"
    return f"{value} | (v.{pin.drives}_o ^ 1u)" if pin.drives else value
