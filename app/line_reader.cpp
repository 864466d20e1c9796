#include "app/line_reader.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "app/byte_text.h"
#include "app/time_text.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

bool in_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::string_view("_.$:@").find(c) != std::string::npos;
}

std::vector<std::string> cut(std::string_view text, char comment) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i + 1;
    if (text[i] == comment && comment != '\0') break;
    if (std::isspace(static_cast<unsigned char>(text[i])) != 0) {
      i = end;
      continue;
    }
    if (text[i] == '"') {
      end = text.find('"', end);
      if (end == std::string_view::npos)
        throw UsageError(
            fmt::format("{} is a text without its end; expected a closing \"", beginning_of(text.substr(i))));
      ++end;
    } else if (in_word(text[i])) {
      while (end < text.size() && in_word(text[end])) ++end;
    } else if (text.substr(i, 2) == "<<") {
      end = i + 2;
    }
    words.emplace_back(text.substr(i, end - i));
    i = end;
  }
  return words;
}

bool same(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::toupper(x) == std::toupper(y); });
}

// -1 where the word is no number.
std::int64_t value_of(std::string word) {
  word.erase(std::remove(word.begin(), word.end(), '_'), word.end());
  const std::size_t mark = word.rfind('$', 0) == 0 ? 1 : same(word.substr(0, 2), "0x") ? 2 : 0;
  const std::string digits = word.substr(mark);
  const bool good =
      !digits.empty() && digits.size() < 12 && std::all_of(digits.begin(), digits.end(), [&](unsigned char c) {
        return mark != 0 ? std::isxdigit(c) != 0 : std::isdigit(c) != 0;
      });
  return good ? std::stoll(digits, nullptr, mark != 0 ? 16 : 10) : -1;
}

bool is_unit(std::string_view word) { return word == "ns" || word == "us" || word == "ms" || word == "s"; }

}  // namespace

LineReader::LineReader(std::string_view text, char comment) : words_(cut(text, comment)) {}

void LineReader::fail(std::string_view expected) const { fail_since(next_, expected); }

void LineReader::fail_since(std::size_t begin, std::string_view expected) const {
  if (begin == words_.size()) throw UsageError(fmt::format("the line ends; expected {}", expected));
  std::string found;
  for (std::size_t i = begin; i <= next_ && i < words_.size(); ++i) found += words_[i];
  throw UsageError(fmt::format("{} is not known; expected {}", beginning_of(found), expected));
}

bool LineReader::take(std::string_view word) {
  if (at_end() || !same(peek(), word)) return false;
  ++next_;
  return true;
}

void LineReader::expect(std::string_view word) {
  if (!take(word)) fail(word);
}

void LineReader::end() {
  if (!at_end()) fail("nothing behind it");
}

std::string LineReader::word(std::string_view expected) {
  if (at_end()) fail(expected);
  return words_[next_++];
}

std::string LineReader::name(std::string_view expected) {
  if (at_end() || std::isalpha(static_cast<unsigned char>(words_[next_][0])) == 0) fail(expected);
  return words_[next_++];
}

std::string LineReader::quoted(std::string_view expected) {
  if (at_end() || words_[next_][0] != '"') fail(fmt::format("{} in quotation marks", expected));
  const std::string& text = words_[next_++];
  return text.substr(1, text.size() - 2);
}

std::int64_t LineReader::number(std::string_view expected) {
  const std::size_t begin = next_;
  const bool negative = take("-");
  const std::int64_t value = value_of(peek());
  if (value < 0) {
    next_ = begin;
    fail(expected);
  }
  ++next_;
  return negative ? -value : value;
}

std::int64_t LineReader::number(std::int64_t low, std::int64_t high, std::string_view expected) {
  const std::size_t begin = next_;
  const std::int64_t value = number(expected);
  if (value >= low && value <= high) return value;
  next_ = begin;
  fail(expected);
}

std::uint32_t LineReader::hex(std::uint32_t high, std::string_view expected) {
  const bool marked = peek().rfind('$', 0) == 0 || same(peek().substr(0, 2), "0x");
  const std::int64_t value = at_end() ? -1 : value_of(marked ? peek() : "$" + peek());
  if (value < 0 || value > high) fail(expected);
  ++next_;
  return static_cast<std::uint32_t>(value);
}

bool LineReader::time_follows() const {
  if (at_end() || std::isdigit(static_cast<unsigned char>(words_[next_][0])) == 0) return false;
  if (next_ + 1 < words_.size() && is_unit(words_[next_ + 1])) return true;
  const std::size_t unit = words_[next_].find_first_not_of("0123456789.");
  return unit != std::string::npos && is_unit(words_[next_].substr(unit));
}

TimeFs LineReader::time() {
  std::string text = word("a time with ns, us, ms or s, for example 10ms");
  if (is_unit(peek())) text += words_[next_++];
  return parse_time(text);
}

}  // namespace brick
