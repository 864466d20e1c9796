#include "testbench/unit/vectors/statement.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace brick {

unsigned Statement::signal() {
  const auto found =
      std::find_if(vector_.signals.begin(), vector_.signals.end(), [&](const auto& s) { return s.name == peek(); });
  if (found == vector_.signals.end())
    fail(fmt::format("a signal of the device '{}', as {}", vector_.device, vector_.signals.front().name));
  word("");
  return static_cast<unsigned>(found - vector_.signals.begin());
}

unsigned Statement::input() {
  const std::size_t begin = place();
  const unsigned found = signal();
  if (vector_.signals[found].input) return found;
  back_to(begin);
  fail("an input pin");
}

std::optional<Edge> Statement::edge() {
  if (take("rises")) return Edge::kRises;
  if (take("falls")) return Edge::kFalls;
  if (take("changes")) return Edge::kChanges;
  return std::nullopt;
}

SignalEdge Statement::signal_edge() {
  const unsigned found = signal();
  const auto of = edge();
  if (!of) fail("rises, falls or changes");
  return {found, *of};
}

Word Statement::register_word() {
  const unsigned words = vector_.kind().words;
  const std::string text = peek();
  const std::string space = text.substr(0, 3), digits = text.size() > 3 ? text.substr(3) : "";
  const bool good = (space == "X:$" || space == "Y:$") && !digits.empty() && digits.size() <= 2 &&
                    std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
  const unsigned long addr = good ? std::stoul(digits, nullptr, 16) : words;
  if (addr >= words) fail(fmt::format("a word, X:$00 to X:${0:02X} or Y:$00 to Y:${0:02X}", words - 1));
  word("");
  return {space[0] == 'X', static_cast<unsigned>(addr)};
}

std::int64_t Statement::term() {
  constexpr std::int64_t kLargest = std::int64_t{1} << 48;
  const std::size_t begin = place();
  std::int64_t value = number("a number, decimal or $hex");
  while (take("<<")) {
    const std::int64_t shift = number(0, 31, "a number of places, 0 to 31");
    if (std::abs(value) > kLargest >> shift) {
      back_to(begin);
      fail("a value of at most 48 bits");
    }
    value *= std::int64_t{1} << shift;
  }
  return value;
}

std::int64_t Statement::expression() {
  std::int64_t value = term();
  while (true) {
    if (take("|")) {
      value |= term();
    } else if (take("+")) {
      value += term();
    } else if (take("-")) {
      value -= term();
    } else {
      return value;
    }
  }
}

std::uint32_t Statement::bits24() {
  const std::size_t begin = place();
  const std::int64_t value = expression();
  if (value >= -0x800000 && value <= 0xFFFFFF) return static_cast<std::uint32_t>(value) & 0xFFFFFF;
  back_to(begin);
  fail("a value of 24 bits");
}

Tick Statement::duration() {
  if (time_follows()) return fs_to_tick(time());
  const bool unit_alone = vector_.units.count(peek()) != 0;
  const std::int64_t value = unit_alone ? 1 : term();
  if (take("ticks")) return value;
  const auto unit = vector_.units.find(peek());
  if (unit == vector_.units.end()) return value;
  word("");
  return value * unit->second;
}

TimePoint Statement::time_point() {
  if (std::find(marks_.begin(), marks_.end(), peek()) == marks_.end()) fail("a mark that was set before");
  TimePoint t{word(""), 0};
  while (true) {
    if (take("+")) {
      t.offset += duration();
    } else if (take("-")) {
      t.offset -= duration();
    } else {
      return t;
    }
  }
}

Window Statement::window() {
  Window w;
  expect("from");
  w.from = time_point();
  expect("to");
  w.to = time_point();
  return w;
}

std::string Statement::bits() {
  std::string text = peek();
  text.erase(std::remove(text.begin(), text.end(), '_'), text.end());
  if (text.empty() || text.find_first_not_of("01") != std::string::npos) fail("bits, as 0111_1110");
  word("");
  return text;
}

}  // namespace brick
