#include "app/script.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "app/byte_text.h"
#include "app/command_file.h"
#include "app/line_reader.h"

namespace brick {

namespace {

using Kind = ScriptLine::Kind;
constexpr std::uint32_t kDpramBytes = 0x10000;
constexpr std::int64_t kHandRate = 10'000,
                       kHighestRate = 9'830'400,  // @encoder, counts per second: one count per SCLK at most
    kLongestTurn = 9000;                          // seconds, as of any time
constexpr std::int64_t kHighestByte = 0xFF, kHighestWord = 0xFFFF;

void read_pic(ScriptLine& line, LineReader& in) {
  const char* form = "@pic, @pic clear, or @pic MSK=xx ELR=xx in hex";
  line.kind = in.at_end() ? Kind::kPicRead : in.take("clear") ? Kind::kPicClear : Kind::kPicWrite;
  if (line.kind != Kind::kPicWrite) return;
  while (!in.at_end()) {
    int* value = in.take("MSK") ? &line.mask : in.take("ELR") ? &line.edge_level : nullptr;
    if (value == nullptr || !in.take("=")) in.fail(form);
    *value = static_cast<int>(in.hex(kHighestByte, form));
  }
}

void read_dpram(ScriptLine& line, LineReader& in) {
  const char* form = "@dpram OFFSET COUNT or @dpram OFFSET = WORD... (words in hex)";
  if (in.at_end()) in.fail(form);
  const std::string text = in.peek();
  const std::int64_t offset =
      in.number(0, kDpramBytes - 1, "an even number of bytes below 65536 (decimal, or hex with 0x)");
  if (offset % 2 != 0)
    throw UsageError(fmt::format("{} is no offset; expected an even number of bytes", beginning_of(text)));
  line.offset = static_cast<std::uint32_t>(offset);
  if (in.take("=")) {
    line.kind = Kind::kDpramWrite;
    do line.words.push_back(static_cast<std::uint16_t>(in.hex(kHighestWord, "words, 0 to FFFF in hex")));
    while (!in.at_end());
    line.count = static_cast<std::uint32_t>(line.words.size());
  } else {
    line.kind = Kind::kDpramRead;
    line.count = static_cast<std::uint32_t>(in.number(1, UINT32_MAX, form));
    in.end();
  }
  if (line.count > (kDpramBytes - line.offset) / 2)
    throw UsageError(fmt::format("{} words from offset {} go beyond the window; expected at most {}", line.count,
                                 line.offset, (kDpramBytes - line.offset) / 2));
}

void read_until(ScriptLine& line, LineReader& in) {
  const char* form = "@until NAME=VALUE LIMIT, for example @until host.breq=1 50ms";
  line.kind = Kind::kUntil;
  line.name = in.name(form);
  if (!in.take("=")) in.fail(form);
  line.value = in.take("-") ? "-" : "";  // signed signals
  line.value += in.word(form);
  if (in.at_end()) in.fail(form);
  line.time = in.time();
}

void read_input(ScriptLine& line, LineReader& in) {
  const char* form = "@input NAME=0 or @input NAME=1, for example @input servo_ic0.ch1.hmfl=1";
  line.kind = Kind::kInput;
  line.name = in.name(form);
  if (!in.take("=")) in.fail(form);
  line.on = in.number(0, 1, "the level 0 or 1") == 1;
}

void read_encoder(ScriptLine& line, LineReader& in) {
  const char* form = "@encoder MOTOR COUNTS or @encoder MOTOR COUNTS RATE (counts per second)";
  if (in.at_end()) in.fail(form);
  line.kind = Kind::kEncoder;
  line.motor = static_cast<unsigned>(in.number(1, UINT32_MAX, "a motor, 1, 2, ..."));
  if (in.at_end()) in.fail(form);
  const char* counts = "a number of counts other than 0, for example -2000";
  line.counts = in.number(-std::int64_t{UINT32_MAX}, UINT32_MAX, counts);
  if (line.counts == 0) throw UsageError(fmt::format("`0` is not known; expected {}", counts));
  line.rate = in.at_end() ? kHandRate
                          : in.number(1, kHighestRate, fmt::format("a rate, 1 to {} counts per second", kHighestRate));
  if (std::abs(line.counts) / line.rate > kLongestTurn)
    throw UsageError(fmt::format("{} counts, {} a second, take too long; expected at most {} s", line.counts, line.rate,
                                 kLongestTurn));
}

// FPD=n sets the four inputs FPDn/ to the number n: low means 1. The others are levels of one pin.
void read_jpan(ScriptLine& line, LineReader& in) {
  constexpr std::array<std::string_view, 12> kInputs{"JOG-", "JOG+", "PREJOG", "START", "STEP", "STOP",
                                                     "HOME", "HOLD", "FPD0",   "FPD1",  "FPD2", "FPD3"};
  constexpr unsigned kFpd = 8;
  constexpr std::uint32_t kNumbers = 0xF;
  const char* form =
      "@jpan NAME=0 or NAME=1 (JOG-, JOG+, PREJOG, START, STEP, STOP, HOME, HOLD, FPD0 to FPD3, INIT; 0 is active), "
      "or FPD=0 to 15";
  if (in.at_end()) in.fail(form);
  line.kind = Kind::kJpan;
  const auto set = [&](std::uint32_t inputs, std::uint32_t levels) {
    line.inputs = static_cast<std::uint16_t>(line.inputs | inputs);
    line.levels = static_cast<std::uint16_t>((line.levels & ~inputs) | levels);
  };
  const auto bit_of_next = [&] {  // of kInputs; a name with its sign is two words
    std::string name = in.word(form);
    if (in.take("-")) name += '-';
    if (in.take("+")) name += '+';
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const auto* input = std::find(kInputs.begin(), kInputs.end(), name);
    if (input == kInputs.end()) in.fail(form);
    return static_cast<unsigned>(input - kInputs.begin());
  };
  const auto read_one = [&] {
    if (in.take("INIT")) {
      in.expect("=");
      line.init = in.number(0, 1, form) == 1;
      return;
    }
    const bool fpd = in.take("FPD");
    const unsigned bit = fpd ? kFpd : bit_of_next();
    in.expect("=");
    const auto value = static_cast<std::uint32_t>(in.number(0, fpd ? kNumbers : 1, form));
    if (fpd) {
      set(kNumbers << kFpd, (~value & kNumbers) << kFpd);
    } else {
      set(1u << bit, value << bit);
    }
  };
  while (!in.at_end()) {
    const std::size_t begin = in.place();
    try {
      read_one();
    } catch (const UsageError&) { in.fail_since(begin, form); }
  }
}

void read_at_line(ScriptLine& line) {
  if (line.text.rfind("@expect", 0) == 0 &&
      (line.text.size() == 7 || std::isspace(static_cast<unsigned char>(line.text[7])) != 0)) {
    line.kind = Kind::kExpect;  // the rest as it stands
    line.value = line.text.size() > 8 ? line.text.substr(8) : "";
    return;
  }
  LineReader in(line.text);
  if (in.take("@wait")) {
    line.kind = Kind::kWait;
    line.time = in.time();
  } else if (in.take("@until")) {
    read_until(line, in);
  } else if (in.take("@signal")) {
    line.kind = Kind::kSignal;
    line.name = in.name("@signal NAME");
  } else if (in.take("@pic")) {
    read_pic(line, in);
  } else if (in.take("@dpram")) {
    read_dpram(line, in);
  } else if (in.take("@jumper")) {
    const char* form = "@jumper E3 on or @jumper E3 off";
    line.kind = Kind::kJumper;
    if (!in.take("E3")) in.fail(form);
    line.on = in.take("on");
    if (!line.on && !in.take("off")) in.fail(form);
  } else if (in.take("@input")) {
    read_input(line, in);
  } else if (in.take("@encoder")) {
    read_encoder(line, in);
  } else if (in.take("@jpan")) {
    read_jpan(line, in);
  } else if (in.take("@reset")) {
    line.kind = Kind::kReset;
  } else if (in.take("@power")) {
    line.kind = Kind::kPower;
  } else if (in.take("@time")) {
    line.kind = Kind::kTime;
  } else {
    in.fail("one of @wait @until @signal @pic @dpram @jumper @input @encoder @jpan @reset @power @expect @time");
  }
  in.end();
}

// A line of nothing but ^A, ^X, ...: those control characters, without CR.
bool is_control(const std::string& text) {
  if (text.empty() || text.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < text.size(); i += 2)
    if (text[i] != '^' || !std::isalpha(static_cast<unsigned char>(text[i + 1]))) return false;
  return true;
}

}  // namespace

UsageError ScriptLine::wrong(const std::string& what) const {
  constexpr std::size_t kLongestWord = 20;
  return UsageError(
      fmt::format("{}: {}: {}{}", place, cut_text(text.substr(0, text.find(' ')), kLongestWord), what, included));
}

std::vector<ScriptLine> read_script(std::istream& in, const std::string& file) {
  std::vector<ScriptLine> script;
  for (SourceLine& source : read_command_file(in, file)) {
    ScriptLine line;
    line.place = std::move(source.place);
    line.included = std::move(source.included);
    line.text = std::move(source.text);
    if (line.text[0] == '@') {
      try {
        read_at_line(line);
      } catch (const UsageError& e) { throw line.wrong(e.what()); }
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
