// The statements that steps are made of.
#include <fmt/format.h>

#include "testbench/unit/vectors/statement.h"

namespace brick {
namespace {

using Action = decltype(Step::action);

constexpr const char* kStatements = "reset, write, read, pin, wait, until, mark, turn, send, command or expect";
constexpr const char* kExpectations = "is, high, rises, falls, changes, period, pulses, stays or reads";

Action expectation(Statement& s) {
  const unsigned signal = s.signal();
  if (s.take("is")) return step::Level{signal, static_cast<std::uint32_t>(s.expression())};
  if (s.take("stays")) {
    const auto value = static_cast<std::uint32_t>(s.expression());
    return step::Stays{signal, value, s.window()};
  }
  if (s.take("high")) {
    const Tick ticks = s.duration();
    return step::High{signal, ticks, s.window()};
  }
  if (s.take("period")) {
    const Tick ticks = s.duration();
    return step::Period{signal, ticks, s.window()};
  }
  if (s.take("pulses")) {
    const Tick ticks = s.duration();
    return step::Pulses{signal, ticks, s.window()};
  }
  if (s.take("reads")) {
    const std::string bits = s.bits();
    s.expect("on");
    const unsigned clock = s.signal();
    return step::Bits{signal, clock, bits, s.window()};
  }
  if (const auto edge = s.edge()) {
    if (s.take("at")) return step::At{{signal, *edge}, s.time_point()};
    if (s.take("then")) {
      const SignalEdge second = s.signal_edge();
      s.expect("after");
      const Tick ticks = s.duration();
      return step::Gap{{signal, *edge}, second, ticks, s.window()};
    }
    const std::int64_t times = s.expression();
    s.expect("times");
    return step::Count{{signal, *edge}, times, s.window()};
  }
  s.fail(kExpectations);
}

Action action(Statement& s, const Vector& vector, std::vector<std::string>& marks) {
  const DeviceKind& kind = vector.kind();
  const auto only = [&](bool has, const char* what) {
    if (!has) s.fail(fmt::format("another statement: the device '{}' has no {}", vector.device, what));
  };
  if (s.take("reset")) return step::Reset{};
  if (s.take("wait")) return step::Wait{s.duration()};
  if (s.take("expect")) return expectation(s);
  if (s.take("write")) {
    only(kind.words > 0, "registers");
    const Word word = s.register_word();
    s.expect("=");
    return step::Write{word, s.bits24()};
  }
  if (s.take("read")) {
    only(kind.words > 0, "registers");
    step::Read read{s.register_word(), 0xFFFFFF, 0};
    if (s.at_end()) {
      read.mask = 0;
      return read;
    }
    if (s.take("&")) read.mask = s.bits24();
    s.expect("=");
    read.value = s.bits24();
    return read;
  }
  if (s.take("pin")) {
    const unsigned signal = s.input();
    s.expect("=");
    return step::Drive{signal, static_cast<std::uint32_t>(s.expression())};
  }
  if (s.take("until")) {
    constexpr Tick kLimit = 1'000'000;
    step::Until until{s.signal_edge(), kLimit};
    if (s.take("within")) until.limit = s.duration();
    return until;
  }
  if (s.take("mark")) {
    marks.push_back(s.name("the name of a mark"));
    return step::Mark{marks.back()};
  }
  if (s.take("turn")) {
    only(kind.encoders, "encoders");
    unsigned channel = 0;
    while (channel < 4 && !s.take(fmt::format("ch{}", channel + 1))) ++channel;
    if (channel == 4) s.fail("ch1 to ch4");
    s.take("+");
    const std::int64_t counts = s.expression();
    s.expect("every");
    return step::Turn{channel, counts, s.duration()};
  }
  if (s.take("send")) {
    const std::uint32_t word = s.bits24();
    s.expect("to");
    const unsigned signal = s.input();
    s.expect("on");
    const unsigned clock = s.signal();
    return step::Send{word, signal, clock, s.take("rises")};
  }
  if (s.take("command")) {
    only(kind.commands, "command lines");
    step::Command command{s.quoted("a command line"), std::nullopt};
    if (s.take("=")) command.reply = s.quoted("the reply");
    return command;
  }
  s.fail(kStatements);
}

}  // namespace

std::optional<Step> parse_step(int line, std::string_view text, const Vector& vector, std::vector<std::string>& marks) {
  Statement s(text, vector, marks);
  if (s.at_end()) return std::nullopt;
  const auto first = text.find_first_not_of(' ');
  std::string shown(text.substr(first, text.find('#') - first));
  shown.erase(shown.find_last_not_of(' ') + 1);
  Step result{line, shown, action(s, vector, marks)};
  s.end();
  return result;
}

}  // namespace brick
