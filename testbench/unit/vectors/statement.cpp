#include "testbench/unit/vectors/statement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace brick {
namespace {

bool in_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '$' || c == ':';
}

std::vector<std::string> cut(std::string_view text, const std::string& where) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    std::size_t end = i + 1;
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      i = end;
      continue;
    }
    if (c == '#') break;
    if (c == '"') {
      end = text.find('"', end);
      if (end == std::string_view::npos) throw VectorError(where + ": found a text without its closing \"");
      ++end;
    } else if (in_word(c)) {
      while (end < text.size() && in_word(text[end])) ++end;
    } else if (text.substr(i, 2) == "<<") {
      end = i + 2;
    }
    words.emplace_back(text.substr(i, end - i));
    i = end;
  }
  return words;
}

}  // namespace

Statement::Statement(std::string where, std::string_view text, const Vector& vector,
                     const std::vector<std::string>& marks)
    : where_(std::move(where)), vector_(vector), marks_(marks), words_(cut(text, where_)) {}

void Statement::fail(const std::string& expected) const {
  const std::string found = at_end() ? "the end of the line" : "'" + peek() + "'";
  throw VectorError(fmt::format("{}: found {}, expected {}", where_, found, expected));
}
bool Statement::take(std::string_view word) {
  if (peek() != word) return false;
  ++next_;
  return true;
}
void Statement::expect(std::string_view word) {
  if (!take(word)) fail(fmt::format("'{}'", word));
}
void Statement::end() {
  if (!at_end()) fail("the end of the line");
}
std::string Statement::name(const char* what) {
  const std::string word = peek();
  if (word.empty() || std::isalpha(static_cast<unsigned char>(word[0])) == 0) fail(what);
  ++next_;
  return word;
}
std::string Statement::quoted(const char* what) {
  const std::string word = peek();
  if (word.empty() || word[0] != '"') fail(std::string(what) + " in quotation marks");
  ++next_;
  return word.substr(1, word.size() - 2);
}

unsigned Statement::signal() {
  const auto found =
      std::find_if(vector_.signals.begin(), vector_.signals.end(), [&](const auto& s) { return s.name == peek(); });
  if (found == vector_.signals.end())
    fail(fmt::format("a signal of the device '{}', as {}", vector_.device, vector_.signals.front().name));
  ++next_;
  return static_cast<unsigned>(found - vector_.signals.begin());
}
unsigned Statement::input() {
  const unsigned found = signal();
  if (vector_.signals[found].input) return found;
  --next_;
  fail("an input pin");
}
Edge Statement::edge() {
  if (take("rises")) return Edge::kRises;
  if (take("falls")) return Edge::kFalls;
  if (take("changes")) return Edge::kChanges;
  fail("rises, falls or changes");
}
SignalEdge Statement::signal_edge() {
  const unsigned found = signal();
  return {found, edge()};
}

Word Statement::word() {
  const std::string text = peek();
  constexpr unsigned kWords = 32;
  if (text.size() > 3 && (text[0] == 'X' || text[0] == 'Y') && text[1] == ':' && text[2] == '$') {
    std::size_t used = 0;
    const unsigned long addr =
        std::isxdigit(static_cast<unsigned char>(text[3])) != 0 ? std::stoul(text.substr(3), &used, 16) : kWords;
    if (used + 3 == text.size() && addr < kWords) {
      ++next_;
      return {text[0] == 'X', static_cast<unsigned>(addr)};
    }
  }
  fail("a word of the IC, X:$00 to X:$1F or Y:$00 to Y:$1F");
}

std::int64_t Statement::term() {
  if (take("-")) return -term();
  std::string text = peek();
  text.erase(std::remove(text.begin(), text.end(), '_'), text.end());
  const bool hex = !text.empty() && text[0] == '$';
  const std::string digits = hex ? text.substr(1) : text;
  const bool good = !digits.empty() && digits.size() < 12 &&
                    std::all_of(digits.begin(), digits.end(),
                                [hex](unsigned char c) { return hex ? std::isxdigit(c) != 0 : std::isdigit(c) != 0; });
  if (!good) fail("a number, decimal or $hex");
  ++next_;
  std::int64_t value = std::stoll(digits, nullptr, hex ? 16 : 10);
  while (take("<<")) value *= std::int64_t{1} << (term() & 31);
  return value;
}
std::int64_t Statement::number() {
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
  const std::size_t at = next_;
  const std::int64_t value = number();
  if (value >= -0x800000 && value <= 0xFFFFFF) return static_cast<std::uint32_t>(value) & 0xFFFFFF;
  next_ = at;
  fail("a value of 24 bits");
}
Tick Statement::duration() {
  const bool one = vector_.units.count(peek()) != 0;  // a unit alone
  const std::int64_t value = one ? 1 : term();
  if (take("ticks")) return value;
  if (take("ms")) return ns_to_ticks(value * 1'000'000);
  const auto unit = vector_.units.find(peek());
  if (unit == vector_.units.end()) return value;
  ++next_;
  return value * unit->second;
}
TimePoint Statement::time() {
  TimePoint t{peek(), 0};
  if (std::find(marks_.begin(), marks_.end(), t.mark) == marks_.end()) fail("a mark that was set before");
  ++next_;
  while (!at_end()) {
    if (take("+")) {
      t.offset += duration();
    } else if (take("-")) {
      t.offset -= duration();
    } else {
      break;
    }
  }
  return t;
}
Window Statement::window() {
  Window w;
  expect("from");
  w.from = time();
  expect("to");
  w.to = time();
  return w;
}
std::string Statement::bits() {
  std::string text = peek();
  text.erase(std::remove(text.begin(), text.end(), '_'), text.end());
  if (text.empty() || text.find_first_not_of("01") != std::string::npos) fail("bits, as 0111_1110");
  ++next_;
  return text;
}

}  // namespace brick
