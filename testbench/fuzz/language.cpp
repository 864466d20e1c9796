// Compiler and lister. First byte: kind of program, form of the listing, text or words. Text: what a line is compiled
// to is listed as text that is compiled to the same words. Words: whatever they are, they are listed, and nothing is
// written beside the listing.
#include <array>
#include <cctype>
#include <cstring>
#include <string>
#include <vector>

#include "testbench/fuzz/target.h"

#define error_t firmware_error_t  // the C library has a type of this name
extern "C" {
#include "firmware/language/lister.h"
#include "firmware/language/statement.h"
}

namespace {

constexpr std::size_t kLineLimit = 255, kLineWords = 300;
constexpr std::size_t kLongestListing = 64 * kLineWords;  // a word is a wide number and an operator at most
constexpr std::uint8_t kWords = 0x80, kLong = 0x40;

using Words = std::vector<word48_t>;

std::string listing;
void put(char c) { listing += c; }

std::string list(const Words& words, bool long_form) {
  listing.clear();
  lister_line(words.data(), static_cast<std::uint32_t>(words.size()), long_form, put);
  require(listing.size() <= kLongestListing, "a listing without an end");
  for (const char c : listing) require(c >= ' ', "a control character in a listing");
  return listing;
}

// As firmware/command/program_line.c makes a line: several statements in motion programs, one elsewhere. Empty:
// refused.
Words compile(const std::string& text, std::uint32_t kind) {
  std::array<word48_t, kLineWords> words{};
  word_list all = {words.data(), 0, kLineWords};
  lexer lx = {text.c_str()};
  bool called = false;
  while (lexer_peek(&lx) != '\0') {
    const bool begun = all.count != 0;
    if (begun && (kind & WHERE_MOVES) == 0) return {};
    std::uint32_t where = kind;
    if (begun) where |= WHERE_BEGUN;
    if (called) where |= WHERE_CALLED;
    const statement head = statement_find(&lx, where);
    if (head.kind == STATEMENT_NONE || statement_compile(&lx, head, where, &all) != ERR_NONE) return {};
    if (head.kind == STATEMENT_ROW && (statement_rows[head.index].where & CALLS) != 0) called = true;
  }
  require(all.count <= kLineWords, "more words than there is room for");
  Words line(words.begin(), words.begin() + all.count);
  if (!line.empty()) line.front() |= WORD_START_OF_LINE;
  return line;
}

void round_trip(std::string text, std::uint32_t kind, bool long_form) {
  bool quoted = false;
  for (char& c : text) {  // as firmware/host/line_input.c
    if (c == '"') quoted = !quoted;
    if (!quoted) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  const Words words = compile(text, kind);
  if (words.empty()) return;
  const std::string listed = list(words, long_form);
  const std::size_t brief = long_form ? list(words, false).size() : listed.size();
  require(brief <= text.size() + 2 * words.size(), "a word is listed with more than two characters more");
  if (brief > kLineLimit) return;  // no fixed program takes it (firmware/buffers/fixed_entry.c)
  require(listed.size() <= kLineLimit, "the long form is too long");
  if (compile(listed, kind) == words) return;
  std::fprintf(stderr, "%s\n%s\n", text.c_str(), listed.c_str());
  require(false, "the listing is compiled to other words");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array<std::uint32_t, 4> kinds = {WHERE_PROG, WHERE_ROTARY, WHERE_PLC, WHERE_KINEMATIC};
  if (size == 0) return 0;
  const std::uint8_t choice = *data++;
  --size;
  const bool long_form = (choice & kLong) != 0;
  if ((choice & kWords) == 0) {
    std::string line;
    for (std::size_t i = 0; i <= size; ++i) {
      if (i < size && data[i] != '\n') {
        if (data[i] >= ' ' && data[i] < 0x80 && line.size() < kLineLimit) line += static_cast<char>(data[i]);
        continue;
      }
      round_trip(line, kinds[choice % kinds.size()], long_form);
      line.clear();
    }
    return 0;
  }
  Words words;
  for (; size >= 6 && words.size() < kLineWords; data += 6, size -= 6) {
    word48_t word = 0;
    std::memcpy(&word, data, 6);
    words.push_back(word & WORD48_MASK);
  }
  if (!words.empty()) (void)list(words, long_form);
  return 0;
}
