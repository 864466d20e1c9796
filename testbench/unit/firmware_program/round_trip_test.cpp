// Random programs of every kind are entered, listed, cleared, entered from their listing and listed again: the words
// and the text must be the same. And lines that are no programs at all: nothing stops, and no word outside its buffer
// changes. BRICK_ROUND_TRIPS: programs of each kind.
#include <cstdlib>
#include <map>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_program/program_generator.h"
#include "testbench/unit/random_seed.h"

namespace {

using platform::host;
using platform::host_lines;

struct Kind {
  const char* text;
  fixed_kind kind;
  std::uint32_t number, where;
};
constexpr Kind kKinds[] = {{"PROG 7", FIXED_PROG, 7, WHERE_PROG},
                           {"PLC 31", FIXED_PLC, 31, WHERE_PLC},
                           {"FORWARD", FIXED_FORWARD, 0, WHERE_KINEMATIC},
                           {"INVERSE", FIXED_INVERSE, 0, WHERE_KINEMATIC}};

unsigned programs_of_each_kind() {
  const char* text = std::getenv("BRICK_ROUND_TRIPS");
  return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : 150;
}

// Without a RETURN at its end: CLOSE appends one unless the lines, or a listing, end with one.
std::vector<word48_t> words_of(const Kind& kind) {
  std::vector<word48_t> words;
  const fixed_program* program = fixed_program_find(kind.kind, kind.number);
  for (std::uint32_t i = 0; program != nullptr && i < program->words; ++i)
    words.push_back(fixed_program_word(program, i));
  const instruction last = words.empty() ? instruction{} : word_decode(words.back());
  if (last.operation == OP_STATEMENT && last.number == KEY_RETURN) words.pop_back();
  return words;
}

class RoundTrip : public FirmwareTest {
 protected:
  static void enter(const Kind& kind, const std::vector<std::string>& lines) {
    ASSERT_EQ(host(std::string("OPEN ") + kind.text + " CLEAR"), "");
    for (const std::string& line : lines) {
      ASSERT_LE(line.size(), 255u);
      ASSERT_EQ(host(line), "") << line;
    }
    ASSERT_EQ(host("CLOSE"), "");
  }
  static std::vector<std::string> list(const Kind& kind) { return host_lines(std::string("LIST ") + kind.text); }
  // As clients do it: 80 words at a time, from the last offset on.
  static std::vector<std::string> list_in_parts(const Kind& kind) {
    std::map<unsigned, std::string> lines;
    for (unsigned start = 0;;) {
      const auto part = host_lines(std::string("LIST ") + kind.text + "," + std::to_string(start) + ",80");
      if (part.empty() || part[0].substr(0, 3) == "ERR") break;
      std::size_t characters = 0;
      for (const std::string& line : part) {
        const std::size_t colon = line.find(':');
        lines[static_cast<unsigned>(std::stoul(line.substr(0, colon)))] = line.substr(colon + 1);
        characters += line.size() + 1;
      }
      EXPECT_LE(characters, 1400u);
      const unsigned last = lines.rbegin()->first;
      start = last > start ? last : last + 1;
    }
    std::vector<std::string> text;
    for (const auto& line : lines) text.push_back(line.second);
    return text;
  }
};

TEST_F(RoundTrip, AListingIsDownloadedToTheSameWords) {
  BRICK_COVERS("I9-1 I9-3");
  std::set<std::string> produced;
  unsigned lines = 0;
  for (const Kind& kind : kKinds)
    for (unsigned seed = 0; seed < programs_of_each_kind(); ++seed) {
      SCOPED_TRACE(std::string(kind.text) + " seed " + std::to_string(seed));
      ProgramGenerator generator(brick::random_seed(seed), kind.where);
      const std::vector<std::string> program = generator.program(12);
      ASSERT_EQ(host("I9=" + std::to_string(seed % 4)), "");
      ASSERT_NO_FATAL_FAILURE(enter(kind, program));
      const std::vector<word48_t> words = words_of(kind);
      const std::vector<std::string> listed = list(kind);
      ASSERT_GE(words.size(), program.size());
      EXPECT_EQ(list_in_parts(kind), listed);
      ASSERT_NO_FATAL_FAILURE(enter(kind, listed));
      ASSERT_EQ(words_of(kind), words);
      ASSERT_EQ(list(kind), listed);
      lines += static_cast<unsigned>(program.size());
      for (const std::string& name : generator.produced()) produced.insert(name);
    }
  EXPECT_GE(lines, 4 * 12 * programs_of_each_kind());
  for (std::uint32_t i = 0; i < statement_row_count; ++i)
    EXPECT_EQ(produced.count(statement_rows[i].name), 1u) << statement_rows[i].name << " was never produced";
}

// A rotary buffer takes lines whatever their listing, so it tells what that is. A fixed program takes those whose short
// form has 255 characters at most, and what it lists goes back in both forms.
TEST_F(RoundTrip, LongLinesGoBackOrAreRefused) {
  BRICK_COVERS("I9-1");
  const Kind& kind = kKinds[0];
  ProgramGenerator generator(brick::random_seed(5), WHERE_ROTARY);
  unsigned in_full = 0, in_brief = 0, refused = 0;
  ASSERT_EQ(host("DEF ROT 1000"), "");
  for (unsigned i = 0; i < 4 * programs_of_each_kind(); ++i) {
    const std::string line = generator.long_line();
    ASSERT_EQ(host("OPEN ROT CLEAR"), "");
    ASSERT_EQ(host(line), "") << line;
    ASSERT_EQ(host("CLOSE I9=0"), "");
    const std::string brief = host("LIST ROT"), full = host("I9=1 LIST ROT");
    EXPECT_LE(brief.size(), line.size() + 2 * rotary_buffers[0].used) << line;
    ASSERT_EQ(host("OPEN PROG 7 CLEAR"), "");
    const bool fits = brief.size() <= 255;
    ASSERT_EQ(host(line), fits ? "" : "ERR003") << line;
    ASSERT_EQ(host("CLOSE"), "");
    if (!fits) {
      ++refused;
      continue;
    }
    const std::vector<word48_t> words = words_of(kind);
    for (const char* i9 : {"I9=0", "I9=1"}) {
      ASSERT_EQ(host(i9), "");
      const std::vector<std::string> listed = list(kind);
      ASSERT_EQ(listed.front(), i9[3] == '1' ? full : brief);
      ASSERT_LE(listed.size(), 2u);
      ASSERT_NO_FATAL_FAILURE(enter(kind, listed));
      ASSERT_EQ(words_of(kind), words) << listed[0];
    }
    ++(full == brief ? in_brief : in_full);
  }
  EXPECT_GT(in_full, programs_of_each_kind() / 4);
  EXPECT_GT(in_brief, programs_of_each_kind() / 4);
  EXPECT_GT(refused, 10u);
}

// The comparison itself: one word of a program is another, and the listing is no longer downloaded to the words it had.
TEST_F(RoundTrip, AnotherWordIsNoticed) {
  const Kind& kind = kKinds[0];
  ASSERT_NO_FATAL_FAILURE(enter(kind, {"X1 Y2", "P1=$A+1"}));
  const std::vector<word48_t> words = words_of(kind);
  for (std::uint32_t i = 0; i < words.size(); ++i) {
    ASSERT_NO_FATAL_FAILURE(enter(kind, {"X1 Y2", "P1=$A+1"}));
    const instruction in = word_decode(words[i]);
    user_memory_write(i, words[i] ^ (in.operation == OP_APPLY || in.operation == OP_ASSIGN_POP ? 1 : 1 << 20));
    const std::vector<std::string> listed = list(kind);
    ASSERT_NO_FATAL_FAILURE(enter(kind, listed));
    EXPECT_NE(words_of(kind), words) << "word " << i;
  }
}

// Nine tenths of a line from the grammar, the rest anything that can be typed.
std::string spoil(std::string line, std::mt19937& random) {
  static const std::string characters = " ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789()+-*/%&|^=!<>~,.:;#$@?\"'_[]{}";
  for (unsigned i = 0, count = 1 + random() % 3; i < count && !line.empty(); ++i) {
    const std::size_t at = random() % line.size();
    switch (random() % 4) {
      case 0:
        line.erase(at, 1 + random() % 3);
        break;
      case 1:
        line.insert(at, line.substr(random() % line.size(), random() % 10));
        break;
      default:
        line[at] = characters[random() % characters.size()];
        break;
    }
  }
  return line.substr(0, 255);
}

bool is_word_of_reset_or_memory(const std::string& line) {  // they change what the test looks at, or wait
  for (const char* text : {"$", "W", "SAVE", "DEF", "DEL", "OPEN", "CL"})
    if (line.find(text) != std::string::npos) return true;
  return false;
}

// Lines that are no programs are commands: they change what replies look like (ranges such as I0..9=1), and start
// programs, behind which OPEN is ERR001.
void undo_commands() {
  for (const char* command : {"CLOSE", "I3=1", "I4=0", "I68=15"}) (void)host(command);
  for (int cs = 16; cs >= 1; --cs) ASSERT_EQ(host("&" + std::to_string(cs) + "A"), "");
}

TEST_F(RoundTrip, HostileLinesStayInTheirBuffer) {
  unsigned stored = 0, refused = 0;
  std::mt19937 random(brick::random_seed(7));
  ASSERT_EQ(host("OPEN PROG 1 X1 Y2 CLOSE"), "");
  for (const Kind& kind : kKinds) {
    ProgramGenerator generator(brick::random_seed(99), kind.where);
    ASSERT_EQ(host(std::string("OPEN ") + kind.text), "");
    for (unsigned i = 0; i < 20 * programs_of_each_kind(); ++i) {
      const std::string line = spoil(generator.statement(), random);
      if (is_word_of_reset_or_memory(line)) continue;
      const std::string reply = host(line);
      ++(reply.substr(0, 3) == "ERR" ? refused : stored);
    }
    ASSERT_NO_FATAL_FAILURE(undo_commands());
    const std::vector<word48_t> words = words_of(kind);
    const std::vector<std::string> listed = list(kind);
    ASSERT_EQ(host(std::string("OPEN ") + kind.text + " CLEAR"), "");
    for (const std::string& line : listed) {
      EXPECT_LE(line.size(), 255u) << line;
      (void)host(line);
    }
    ASSERT_NO_FATAL_FAILURE(undo_commands());
    EXPECT_EQ(list(kind), listed) << kind.text;
    EXPECT_EQ(words_of(kind), words) << kind.text << ": what was taken is listed so that it is taken again";
  }
  EXPECT_GE(stored, programs_of_each_kind());
  EXPECT_GE(refused, programs_of_each_kind());
  EXPECT_EQ(host("LIST PROG 1"), "X1Y2|RET");
}

// What a host writes over a program with WX and WY is listed as something, and nothing else happens.
TEST_F(RoundTrip, DamagedWordsAreListed) {
  std::mt19937_64 random(brick::random_seed(3));
  ASSERT_EQ(host("OPEN PLC 1 CLEAR"), "");
  for (int i = 0; i < 50; ++i) ASSERT_EQ(host("P1=1 IF(P1=$10) CMD\"ABCDEFG\" ENDIF"), "");
  ASSERT_EQ(host("CLOSE"), "");
  const std::uint32_t words = fixed_program_find(FIXED_PLC, 1)->words;
  for (unsigned round = 0; round < programs_of_each_kind(); ++round) {
    for (std::uint32_t i = 0; i < words; ++i) {
      word48_t word = random() & WORD48_MASK;
      if (random() % 3 != 0) word = (word & ~(WORD48_MASK << 43)) | (14ull << 43);            // operators
      if (random() % 2 != 0) word &= ~(0x3FFull << 30) & ~WORD_START_OF_LINE & ~0xFFFF00ull;  // small numbers
      user_memory_write(i, word);
    }
    ASSERT_FALSE(list(kKinds[1]).size() > 1 && host("LIST PLC 1").empty());
    ASSERT_EQ(host("OPEN PLC 1"), "");
    (void)host("CLOSE");
  }
}

}  // namespace
