#include "testbench/host/framing_probe.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string>

namespace brick {

namespace {

constexpr std::size_t kWords = 8, kDigits = 12, kAnswer = kWords * (kDigits + 1) - 1;
constexpr char kStx = 0x02, kAck = 0x06, kLf = 0x0A, kCr = 0x0D;

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

bool is_hex_digit(char c) { return is_digit(c) || (c >= 'A' && c <= 'F'); }

// The answer that begins at `begin` and whose CR is at `cr`, if it has that form.
std::optional<FramingAnswer> answer_of_form(std::string_view text, std::size_t begin, std::size_t cr,
                                            const Framing& framing) {
  std::string form(text.substr(begin, cr + 1 - begin));
  if (framing.checksums()) form.push_back(sum_of(form));
  if (framing.i3 != 0) form.push_back(framing.i3 == 1 ? kLf : kAck);
  const bool command_sum = framing.i3 != 0 && framing.checksums();  // of a control character: any byte
  const std::size_t end = begin + form.size() + (command_sum ? 1 : 0);
  if (end > text.size() || text.substr(begin, form.size()) != form) return std::nullopt;
  return FramingAnswer{begin, end, framing};
}

// The line that `text` begins with has a checksum; nothing where it has no end.
std::optional<bool> has_checksum(std::string_view text) {
  const std::size_t cr = text.find(kCr);
  if (cr == std::string_view::npos || cr + 1 == text.size()) return std::nullopt;
  if (text[cr + 1] == sum_of(text.substr(0, cr + 1))) return true;
  if (may_be_error(text.substr(0, cr + 1))) return has_checksum(text.substr(cr + 1));
  return false;
}

// An acknowledge is none of a text. What looks like a checksum may be the beginning of the next line, and like an
// acknowledge a checksum: then that line shows which it is.
std::optional<FramingAnswer> answer_at(std::string_view text, std::size_t begin, std::size_t cr) {
  const unsigned acknowledged = text[begin] == kLf ? 3 : 2, other = acknowledged - 2;
  std::array<std::optional<FramingAnswer>, 2> found;
  for (const unsigned i4 : {0u, 1u}) {
    found[i4] = answer_of_form(text, begin, cr, {acknowledged, i4});
    if (!found[i4]) found[i4] = answer_of_form(text, begin, cr, {other, i4});
  }
  const auto& [plain, summed] = found;
  if (!plain || !summed) return plain ? plain : summed;
  if (plain->framing.i3 == 0 && summed->framing.i3 == 2) return summed;
  if (const auto next = has_checksum(text.substr(summed->end))) return *next ? summed : plain;
  return summed->end == text.size() && plain->end != text.size() ? summed : plain;
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

bool may_be_error(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of("\x02\x07\n"), line.size()));
  return line.substr(0, 3) == "ERR" || line.substr(0, 1) == "\r";
}

char sum_of(std::string_view bytes) {
  unsigned total = 0;
  for (const unsigned char c : bytes) total += c;
  return static_cast<char>(total);
}

bool may_end_answer(std::string_view text) {
  if (text.size() <= kAnswer || text.back() != kCr) return false;
  const std::string_view words = text.substr(text.size() - kAnswer - 1, kAnswer);
  for (std::size_t i = 0; i < kAnswer; ++i)
    if (i % (kDigits + 1) == kDigits ? words[i] != ' ' : !is_hex_digit(words[i])) return false;
  return true;
}

std::vector<FramingAnswer> framing_answers(std::string_view text, std::size_t from) {
  std::vector<FramingAnswer> answers;
  for (std::size_t cr = text.find(kCr, from); cr != std::string_view::npos; cr = text.find(kCr, cr + 1)) {
    if (!may_end_answer(text.substr(from, cr + 1 - from))) continue;
    const std::size_t begin = cr - kAnswer;
    const char before = begin > from ? text[begin - 1] : kCr;
    const bool behind_acknowledge = begin > from + 1 && text[begin - 2] == kAck;
    auto answer = before == kLf ? answer_at(text, begin - 1, cr) : std::nullopt;
    if (!answer) answer = answer_at(text, begin, cr);
    if (!answer) continue;
    const bool is_checksum = behind_acknowledge && answer->framing == Framing{2, 1};
    if (before != kStx || is_checksum) answers.push_back(*answer);  // else it is a tag
  }
  return answers;
}

}  // namespace brick
