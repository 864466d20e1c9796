#include "testbench/host/framing_probe.h"

#include <algorithm>
#include <cctype>

namespace brick {

namespace {

constexpr std::size_t kDigits = 12;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

// In capitals, without spaces, texts in quotation marks, the comment at the end, and the password, which takes all that
// follows in the line (firmware:5.10/8).
std::string commands_of(std::string_view line) {
  std::string text;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (quoted || c == '"' || c == ' ' || c == '\t') continue;
    if (c == ';') break;
    text.push_back(static_cast<char>(std::toupper(static_cast<unsigned char>(c))));
    if (ends_with(text, "PASSWORD=")) break;
  }
  return text;
}

// The digits of `text` from `at` on are 3 or 4, or the first of several variables among which these are.
bool reaches_3_or_4(const std::string& text, std::size_t at) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789", at), text.size());
  const std::size_t first = std::min(text.find_first_not_of('0', at), end);
  if (end - first > 1) return false;
  const int number = first == end ? 0 : text[first] - '0';
  const bool several = text.compare(end, 2, "..") == 0 || text.compare(end, 1, ",") == 0;
  const bool assigns = text.find('=', end) != std::string::npos;
  return assigns && (several ? number <= 4 : (number == 3 || number == 4) && text.compare(end, 1, "=") == 0);
}

bool is_status(std::string_view text, const Framing& framing) {
  std::string form = (framing.i3 & 1) != 0 ? "\n" : "";
  const std::size_t digits = form.size();
  if (text.size() < digits + kDigits + 1) return false;
  for (std::size_t i = digits; i < digits + kDigits; ++i) {
    const char c = text[i];
    if (!is_digit(c) && (c < 'A' || c > 'F')) return false;
    form.push_back(c);
  }
  form.push_back('\r');
  const auto sum = [](std::string_view bytes) {
    unsigned total = 0;
    for (const unsigned char c : bytes) total += c;
    return static_cast<char>(total);
  };
  if (framing.checksums()) form.push_back(sum(form));
  if (framing.i3 != 0) form.push_back(framing.i3 == 1 ? '\n' : '\x06');
  if (framing.i3 != 0 && framing.checksums()) {  // of a control character: any byte
    if (text.size() != form.size() + 1) return false;
    form.push_back(text.back());
  }
  return text == form;
}

}  // namespace

bool may_change_framing(std::string_view line) {
  const std::string text = commands_of(line);
  for (std::size_t at = text.find('I'); at != std::string::npos; at = text.find('I', at + 1)) {
    if (at + 1 == text.size()) continue;  // the letter before may be the end of another command: CLOSE I4=1
    if (text[at + 1] == '(' && text.find('=', at) != std::string::npos) return true;
    if (is_digit(text[at + 1]) && reaches_3_or_4(text, at + 1)) return true;
  }
  return false;
}

bool has_control_characters(std::string_view line) {
  return std::any_of(line.begin(), line.end(), [](unsigned char c) { return c < ' '; });
}

bool may_restart(std::string_view line) { return commands_of(line).find("$$$") != std::string::npos; }

bool may_take_long(std::string_view line) { return commands_of(line).find("SAVE") != std::string::npos; }

std::optional<FramingAnswer> framing_answer(std::string_view text, std::size_t from) {
  constexpr std::size_t kLongestForm = kDigits + 5;  // LF, CR, ACK, two checksums
  if (text.size() > kLongestForm) from = std::max(from, text.size() - kLongestForm);
  for (std::size_t begin = from; begin + kDigits < text.size(); ++begin)
    for (const unsigned i3 : {2u, 1u, 3u, 0u})
      for (const unsigned i4 : {0u, 1u})
        if (is_status(text.substr(begin), {i3, i4})) return FramingAnswer{begin, {i3, i4}};
  return std::nullopt;
}

std::string without_answers(std::string text, std::size_t from, const Framing& framing, unsigned most) {
  const std::size_t length = kDigits + 1 + (framing.i3 & 1) + (framing.checksums() ? 1 : 0) +
                             (framing.i3 == 0       ? 0
                              : framing.checksums() ? 2
                                                    : 1);
  for (std::size_t at = from; most > 0 && at + length <= text.size();) {
    if (!is_status(std::string_view(text).substr(at, length), framing)) {
      ++at;
      continue;
    }
    text.erase(at, length);
    --most;
  }
  return text;
}

}  // namespace brick
