#include "app/script.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "app/time_text.h"
#include "app/usage_error.h"

namespace brick {

namespace {

using Kind = ScriptLine::Kind;
constexpr std::uint32_t kDpramBytes = 0x10000;
constexpr std::int64_t kHandRate = 10'000,
                       kHighestRate = 9'830'400;  // @encoder, counts per second: one count per SCLK at most
constexpr const char* kKnown =
    "@wait @until @signal @pic @dpram @jumper @input @encoder @jpan @reset @power @expect @time";

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::optional<std::uint32_t> number(const std::string& text, int base) {
  if (text.empty() || !std::isalnum(static_cast<unsigned char>(text[0]))) return std::nullopt;
  std::size_t used = 0;
  try {
    const unsigned long value = std::stoul(text, &used, base);
    if (used != text.size() || value > UINT32_MAX) return std::nullopt;
    return static_cast<std::uint32_t>(value);
  } catch (const std::exception&) { return std::nullopt; }
}

// Decimal, or hexadecimal with 0x or $.
std::optional<std::uint32_t> place(const std::string& text) {
  if (text.size() > 1 && text[0] == '$') return number(text.substr(1), 16);
  if (text.size() > 2 && upper(text.substr(0, 2)) == "0X") return number(text.substr(2), 16);
  return number(text, 10);
}

void read_pic(ScriptLine& line, const std::vector<std::string>& words) {
  if (words.size() == 1) {
    line.kind = Kind::kPicRead;
    return;
  }
  if (words.size() == 2 && upper(words[1]) == "CLEAR") {
    line.kind = Kind::kPicClear;
    return;
  }
  line.kind = Kind::kPicWrite;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string name = upper(words[i].substr(0, 4));
    const auto value = words[i].size() > 4 ? number(words[i].substr(4), 16) : std::nullopt;
    if (!value || *value > 0xFF || (name != "MSK=" && name != "ELR="))
      throw UsageError(
          fmt::format("`{}` is not known; expected @pic, @pic clear, or @pic MSK=xx ELR=xx in hex", words[i]));
    (name == "MSK=" ? line.mask : line.edge_level) = static_cast<int>(*value);
  }
}

void read_dpram(ScriptLine& line, const std::vector<std::string>& words) {
  const char* form = "expected @dpram OFFSET COUNT or @dpram OFFSET = WORD... (words in hex)";
  if (words.size() < 3) throw UsageError(form);
  const auto offset = place(words[1]);
  if (!offset || *offset % 2 != 0 || *offset >= kDpramBytes)
    throw UsageError(
        fmt::format("`{}` is no offset; expected an even number of bytes below {} (decimal, or hex with 0x)", words[1],
                    kDpramBytes));
  line.offset = *offset;
  if (words[2] == "=") {
    line.kind = Kind::kDpramWrite;
    for (std::size_t i = 3; i < words.size(); ++i) {
      const auto word = number(words[i], 16);
      if (!word || *word > 0xFFFF)
        throw UsageError(fmt::format("`{}` is no word; expected 0 to FFFF in hex", words[i]));
      line.words.push_back(static_cast<std::uint16_t>(*word));
    }
    if (line.words.empty()) throw UsageError(form);
    line.count = static_cast<std::uint32_t>(line.words.size());
  } else {
    line.kind = Kind::kDpramRead;
    const auto count = place(words[2]);
    if (words.size() != 3 || !count || *count == 0) throw UsageError(form);
    line.count = *count;
  }
  if (line.count > (kDpramBytes - line.offset) / 2)
    throw UsageError(fmt::format("{} words from offset {} go beyond the window; expected at most {}", line.count,
                                 line.offset, (kDpramBytes - line.offset) / 2));
}

void read_until(ScriptLine& line, const std::vector<std::string>& words) {
  const std::size_t equals = words.size() > 1 ? words[1].find('=') : std::string::npos;
  if (words.size() != 3 || equals == std::string::npos || equals == 0 || equals + 1 == words[1].size())
    throw UsageError("expected @until NAME=VALUE LIMIT, for example @until host.breq=1 50ms");
  line.kind = Kind::kUntil;
  line.name = words[1].substr(0, equals);
  line.value = words[1].substr(equals + 1);
  line.time = parse_time(words[2]);
}

void read_input(ScriptLine& line, const std::vector<std::string>& words) {
  const std::size_t equals = words.size() == 2 ? words[1].find('=') : std::string::npos;
  if (equals == std::string::npos || equals == 0)
    throw UsageError("expected @input NAME=0 or @input NAME=1, for example @input servo_ic0.ch1.hmfl=1");
  line.kind = Kind::kInput;
  line.name = words[1].substr(0, equals);
  const std::string level = words[1].substr(equals + 1);
  if (level != "0" && level != "1") throw UsageError(fmt::format("`{}` is no level; expected 0 or 1", level));
  line.on = level == "1";
}

void read_encoder(ScriptLine& line, const std::vector<std::string>& words) {
  if (words.size() < 3 || words.size() > 4)
    throw UsageError("expected @encoder MOTOR COUNTS or @encoder MOTOR COUNTS RATE (counts per second)");
  line.kind = Kind::kEncoder;
  const auto motor = number(words[1], 10);
  if (!motor || *motor == 0) throw UsageError(fmt::format("`{}` is no motor; expected 1, 2, ...", words[1]));
  line.motor = *motor;
  const bool down = words[2].size() > 1 && words[2][0] == '-';
  const auto counts = number(words[2].substr(down ? 1 : 0), 10);
  if (!counts || *counts == 0)
    throw UsageError(
        fmt::format("`{}` is no number of counts; expected one other than 0, for example -2000", words[2]));
  line.counts = down ? -static_cast<std::int64_t>(*counts) : static_cast<std::int64_t>(*counts);
  line.rate = kHandRate;
  if (words.size() == 3) return;
  const auto rate = number(words[3], 10);
  if (!rate || *rate == 0 || *rate > kHighestRate)
    throw UsageError(fmt::format("`{}` is no rate; expected 1 to {} counts per second", words[3], kHighestRate));
  line.rate = *rate;
}

// FPD=n sets the four inputs FPDn/ to the number n: low means 1. The others are levels of one pin.
void read_jpan(ScriptLine& line, const std::vector<std::string>& words) {
  constexpr std::array<std::string_view, 12> kInputs{"JOG-", "JOG+", "PREJOG", "START", "STEP", "STOP",
                                                     "HOME", "HOLD", "FPD0",   "FPD1",  "FPD2", "FPD3"};
  constexpr unsigned kFpd = 8;
  constexpr std::uint32_t kNumbers = 0xF;
  const char* form =
      "expected @jpan NAME=0 or NAME=1 (JOG-, JOG+, PREJOG, START, STEP, STOP, HOME, HOLD, FPD0 to FPD3; 0 is active), "
      "or FPD=0 to 15";
  if (words.size() < 2) throw UsageError(form);
  line.kind = Kind::kJpan;
  const auto set = [&](std::uint32_t inputs, std::uint32_t levels) {
    line.inputs = static_cast<std::uint16_t>(line.inputs | inputs);
    line.levels = static_cast<std::uint16_t>((line.levels & ~inputs) | levels);
  };
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::size_t equals = words[i].find('=');
    const std::string name = upper(words[i].substr(0, equals));
    const auto input = std::find(kInputs.begin(), kInputs.end(), name);
    const bool fpd = name == "FPD";
    const std::uint32_t most = fpd ? kNumbers : 1;
    const std::uint32_t value =
        equals == std::string::npos ? most + 1 : number(words[i].substr(equals + 1), 10).value_or(most + 1);
    if (value > most || (!fpd && input == kInputs.end()))
      throw UsageError(fmt::format("`{}` is not known; {}", words[i], form));
    if (fpd) {
      set(kNumbers << kFpd, (~value & kNumbers) << kFpd);
    } else {
      const auto bit = static_cast<unsigned>(input - kInputs.begin());
      set(1u << bit, value << bit);
    }
  }
}

void read_at_line(ScriptLine& line) {
  const std::vector<std::string> words = words_of(line.text);
  const std::string& what = words[0];
  const auto need = [&](std::size_t count, const char* form) {
    if (words.size() != count) throw UsageError(fmt::format("expected {}", form));
  };
  if (what == "@wait") {
    need(2, "@wait TIME, for example @wait 10ms");
    line.kind = Kind::kWait;
    line.time = parse_time(words[1]);
  } else if (what == "@until") {
    read_until(line, words);
  } else if (what == "@signal") {
    need(2, "@signal NAME");
    line.kind = Kind::kSignal;
    line.name = words[1];
  } else if (what == "@pic") {
    read_pic(line, words);
  } else if (what == "@dpram") {
    read_dpram(line, words);
  } else if (what == "@jumper") {
    need(3, "@jumper E3 on or @jumper E3 off");
    line.kind = Kind::kJumper;
    if (upper(words[1]) != "E3" || (words[2] != "on" && words[2] != "off"))
      throw UsageError(fmt::format("`{} {}` is not known; expected E3 on or E3 off", words[1], words[2]));
    line.on = words[2] == "on";
  } else if (what == "@input") {
    read_input(line, words);
  } else if (what == "@encoder") {
    read_encoder(line, words);
  } else if (what == "@reset" || what == "@power" || what == "@time") {
    need(1, "nothing behind it");
    line.kind = what == "@reset" ? Kind::kReset : what == "@power" ? Kind::kPower : Kind::kTime;
  } else if (what == "@expect") {
    line.kind = Kind::kExpect;
    line.value = line.text.size() > 8 ? line.text.substr(8) : "";
  } else if (what == "@jpan") {
    read_jpan(line, words);
  } else {
    throw UsageError(fmt::format("is not known; expected one of {}", kKnown));
  }
}

// A line of nothing but ^A, ^X, ...: those control characters, without CR.
bool is_control(const std::string& text) {
  if (text.empty() || text.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < text.size(); i += 2)
    if (text[i] != '^' || !std::isalpha(static_cast<unsigned char>(text[i + 1]))) return false;
  return true;
}

}  // namespace

std::vector<ScriptLine> read_script(std::istream& in, const std::string& file) {
  std::vector<ScriptLine> script;
  unsigned number_of_line = 0;
  for (std::string text; std::getline(in, text);) {
    ++number_of_line;
    const std::size_t end = text.find_last_not_of(" \t\r");
    text.erase(end == std::string::npos ? 0 : end + 1);
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string::npos) continue;
    ScriptLine line;
    line.number = number_of_line;
    line.text = text.substr(begin);
    if (line.text[0] == '@') {
      try {
        read_at_line(line);
      } catch (const UsageError& e) {
        const std::string what = line.text.substr(0, line.text.find_first_of(" \t"));
        throw UsageError(fmt::format("{}:{}: {}: {}", file, number_of_line, what, e.what()));
      }
    } else if (is_control(line.text)) {
      line.kind = Kind::kControl;
      for (std::size_t i = 1; i < line.text.size(); i += 2)
        line.value.push_back(static_cast<char>(line.text[i] & 0x1F));
    }
    script.push_back(std::move(line));
  }
  return script;
}

}  // namespace brick
