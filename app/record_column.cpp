#include "app/record_column.h"

#include <fnmatch.h>

#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "app/byte_text.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

constexpr std::uint32_t kMainMemory = 0xC0000000;  // docs/architecture.md, CPU memory map
constexpr std::uint32_t kMainWords = 0x40000;
constexpr unsigned kMotors = 32, kSystems = 16, kWordBits = 24;
constexpr unsigned kMotorWords = 0x80;  // firmware:1.10; offsets in them:
constexpr std::uint32_t kCommanded = 0x08, kPositionScale = 0x09, kActual = 0x0B, kOutput = 0x3F;
constexpr std::uint32_t kSystemWords = 0x2000, kSystemStride = 0x100, kRotary = 0x3E;  // firmware:1.10/9
constexpr const char* kMotorNumbers[] = {"commanded", "actual", "error", "velocity", "acceleration", "output"};
constexpr const char* kExpected =
    "a signal of docs/signals.md, motorN.commanded, actual, error, velocity, acceleration or output, csN.lines or "
    "words, feed:1/1000,2/1000, or a word of the main memory as X:$BF,8,16,S, D:$88 or L:$1000, with /divisor behind "
    "it";

std::uint32_t word(Machine& machine, bool x, std::uint32_t address) {
  const std::uint8_t* p = machine.cpu().memory(kMainMemory + 8 * address + (x ? 4 : 0), 4);
  return p == nullptr ? 0 : p[0] | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16;
}

double signed_of(std::uint64_t value, unsigned bits) {
  const auto number = static_cast<double>(value);
  return (value >> (bits - 1) & 1) != 0 ? number - std::ldexp(1.0, static_cast<int>(bits)) : number;
}

double double_word(Machine& machine, std::uint32_t address) {
  return signed_of(std::uint64_t{word(machine, true, address)} << kWordBits | word(machine, false, address),
                   2 * kWordBits);
}

// m / 2^35 x 2^(E - 2047), m of 36 bits in X and Y 23..12, E in Y 11..0 (firmware:1.2/5).
double float_word(Machine& machine, std::uint32_t address) {
  const std::uint32_t high = word(machine, true, address), low = word(machine, false, address);
  const double mantissa = signed_of(std::uint64_t{high} << 12 | low >> 12, 36);
  return std::ldexp(mantissa, static_cast<int>(low & 0xFFF) - 2047 - 35);
}

[[noreturn]] void refuse(const std::string& item, const std::string& what) {
  throw UsageError(fmt::format("--record-of {}: {}; expected {}", beginning_of(item), what, kExpected));
}

std::uint32_t number(const std::string& item, const std::string& text, std::uint32_t most) {
  const bool hex = !text.empty() && text[0] == '$';
  const std::string digits = text.substr(hex ? 1 : 0);
  if (digits.empty() || digits.size() > 8 ||
      digits.find_first_not_of(hex ? "0123456789ABCDEFabcdef" : "0123456789") != std::string::npos)
    refuse(item, fmt::format("`{}` is no number", text));
  const unsigned long value = std::stoul(digits, nullptr, hex ? 16 : 10);
  if (value > most) refuse(item, fmt::format("{} is above {}", text, most));
  return static_cast<std::uint32_t>(value);
}

std::vector<std::string> parts(const std::string& text, const std::string& divisors) {
  std::vector<std::string> list;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find_first_of(divisors, from), text.size());
    list.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  return list;
}

// What stands behind a slash, which is taken away with it; 1 without one.
double take_divisor(const std::string& item, std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return 1;
  double divisor = 0;
  std::size_t used = 0;
  const std::string digits = text.substr(slash + 1);
  try {
    divisor = std::stod(digits, &used);
  } catch (const std::exception&) {}
  if (used == 0 || used != digits.size() || !std::isfinite(divisor) || divisor == 0)
    refuse(item, fmt::format("`{}` is no divisor", digits));
  text.resize(slash);
  return divisor;
}

std::function<double()> definition(Machine& machine, const std::string& item, const std::string& text) {
  const char form = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  const auto fields = parts(text.substr(2), ",");
  const std::uint32_t address = number(item, fields[0], kMainWords - 1);
  if (form == 'D' || form == 'L') {
    if (fields.size() > 1) refuse(item, "D: and L: have an address alone");
    return [&machine, address, form] {
      return form == 'D' ? double_word(machine, address) : float_word(machine, address);
    };
  }
  if (fields.size() > 4) refuse(item, "too many fields");
  const std::uint32_t first = fields.size() > 1 ? number(item, fields[1], kWordBits - 1) : 0;
  const std::uint32_t width = fields.size() > 2   ? number(item, fields[2], kWordBits)
                              : fields.size() > 1 ? 1
                                                  : std::uint32_t{kWordBits};
  if (width == 0 || first + width > kWordBits) refuse(item, fmt::format("bits {} and {} on", first, width));
  const bool is_signed = fields.size() > 3 && (fields[3] == "S" || fields[3] == "s");
  if (fields.size() > 3 && !is_signed && fields[3] != "U" && fields[3] != "u")
    refuse(item, fmt::format("`{}` is neither S nor U", fields[3]));
  return [&machine, x = form == 'X', address, first, width, is_signed] {
    const std::uint32_t value = word(machine, x, address) >> first & ((1u << width) - 1);
    return is_signed ? signed_of(value, width) : value;
  };
}

std::string column_name(const std::string& item, std::size_t equals) {
  std::string name = item.substr(0, equals);
  if (name.empty() || name.find('"') != std::string::npos) refuse(item, "no name before `=`");
  return name;
}

std::optional<RecordColumn> memory_column(Machine& machine, const std::string& item) {
  const std::size_t equals = item.find('=');
  std::string name = item, text = item;
  if (equals != std::string::npos) text = item.substr(equals + 1);
  if (text.size() < 3 || text[1] != ':' || std::string("XYDLxydl").find(text[0]) == std::string::npos) {
    if (equals != std::string::npos) refuse(item, "no word of the main memory behind `=`");
    return std::nullopt;
  }
  if (equals != std::string::npos) name = column_name(item, equals);
  const double divisor = take_divisor(item, text);
  return RecordColumn{
      name, [value = definition(machine, item, text), divisor](const RecordRow&) { return value() / divisor; }};
}

// The change of `value` a ms since the row before; 0 in the first.
std::function<double(const RecordRow&)> slope(std::function<double(const RecordRow&)> value) {
  struct Before {
    bool any = false;
    double ms = 0, value = 0;
  };
  return [value = std::move(value), before = std::make_shared<Before>()](const RecordRow& row) {
    const double now = value(row);
    const double change = before->any && row.ms > before->ms ? (now - before->value) / (row.ms - before->ms) : 0;
    *before = {true, row.ms, now};
    return change;
  };
}

std::function<double(const RecordRow&)> motor_number(Machine& machine, unsigned motor, const std::string& what) {
  const std::uint32_t base = kMotorWords * motor;
  const auto counts = [&machine, base](std::uint32_t at) {
    const std::uint32_t scale = word(machine, false, base + kPositionScale);  // Ixx08
    return double_word(machine, base + at) / (32.0 * (scale == 0 ? 1 : scale));
  };
  const auto commanded = [counts](const RecordRow&) { return counts(kCommanded); };
  if (what == "commanded") return commanded;
  if (what == "actual") return [counts](const RecordRow&) { return counts(kActual); };
  if (what == "error") return [counts](const RecordRow&) { return counts(kCommanded) - counts(kActual); };
  if (what == "velocity") return slope(commanded);
  if (what == "acceleration") return slope(slope(commanded));
  return [&machine, base](const RecordRow&) { return signed_of(word(machine, true, base + kOutput), kWordBits) / 256; };
}

// `feed:1/1000,2/500`, `name=feed:1`: the vector of these motors' velocities, each by counts a unit.
std::optional<RecordColumn> feed_column(Machine& machine, const std::string& item) {
  static const std::string kFeed = "feed:";
  const std::size_t equals = item.find('=');
  const std::string text = equals == std::string::npos ? item : item.substr(equals + 1);
  if (text.compare(0, kFeed.size(), kFeed) != 0) return std::nullopt;
  struct Part {
    std::function<double(const RecordRow&)> velocity;
    double divisor;
  };
  std::vector<Part> sum;
  for (std::string part : parts(text.substr(kFeed.size()), ",")) {
    const double divisor = take_divisor(item, part);
    const std::uint32_t motor = number(item, part, kMotors);
    if (motor == 0) refuse(item, "there is no motor 0");
    sum.push_back({motor_number(machine, motor, "velocity"), divisor});
  }
  return RecordColumn{equals == std::string::npos ? item : column_name(item, equals), [sum](const RecordRow& row) {
                        double square = 0;
                        for (const Part& part : sum) square += std::pow(part.velocity(row) / part.divisor, 2);
                        return std::sqrt(square);
                      }};
}

bool matches(const std::string& pattern, const std::string& name) {
  return fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

void add_named(Machine& machine, const std::string& item, std::vector<RecordColumn>& columns) {
  const std::size_t before = columns.size();
  for (unsigned motor = 1; motor <= kMotors; ++motor)
    for (const char* what : kMotorNumbers)
      if (const std::string name = fmt::format("motor{}.{}", motor, what); matches(item, name))
        columns.push_back({name, motor_number(machine, motor, what)});
  for (unsigned system = 1; system <= kSystems; ++system)
    for (const bool x : {true, false})
      if (const std::string name = fmt::format("cs{}.{}", system, x ? "lines" : "words"); matches(item, name))
        columns.push_back({name, [&machine, x, at = kSystemWords + kSystemStride * (system - 1) + kRotary](
                                     const RecordRow&) { return static_cast<double>(word(machine, x, at)); }});
  Signals& signals = machine.signals();
  for (Signals::Id id = 0; id < signals.size(); ++id) {
    const Signals::Info& info = signals.info(id);
    if (info.radix == Radix::kText || !matches(item, info.name)) continue;
    columns.push_back({info.name, [&signals, id, radix = info.radix, width = info.width](const RecordRow&) {
                         const std::uint64_t value = signals.value(id);
                         if (radix == Radix::kReal) return real_of(value);
                         return radix == Radix::kSigned ? signed_of(value, width) : static_cast<double>(value);
                       }});
  }
  if (columns.size() == before) refuse(item, "no such signal or number");
}

}  // namespace

std::vector<RecordColumn> record_columns(Machine& machine, const std::string& text) {
  std::vector<RecordColumn> columns;
  for (const std::string& item : parts(text, " ;")) {
    if (item.empty()) continue;
    if (auto feed = feed_column(machine, item))
      columns.push_back(std::move(*feed));
    else if (auto column = memory_column(machine, item))
      columns.push_back(std::move(*column));
    else
      add_named(machine, item, columns);
  }
  if (columns.empty()) refuse(text, "nothing");
  return columns;
}

}  // namespace brick
