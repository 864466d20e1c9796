// SAVE and the start-up after it (docs/save.md): all that firmware:8.5 lists comes back; power that goes at any word
// leaves all of the old or all of the new data; damage is reported; content with a good CRC that no SAVE wrote harms
// nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "testbench/unit/covers.h"
#include "testbench/unit/firmware_platform/controller.h"
#include "testbench/unit/random_seed.h"

extern "C" {
#include "firmware/base/crc32.h"
#include "firmware/base/status.h"
#include "firmware/hal/hal.h"
#include "firmware/image/flash_store.h"
}

namespace brick {
namespace {

std::string text(const char* format, unsigned long a, unsigned long b = 0) {
  char line[80];
  std::snprintf(line, sizeof line, format, a, b);
  return line;
}

// What a user keeps in a controller: lines that set it, and questions with the answers they must then have.
struct Content {
  std::vector<std::string> lines;
  std::vector<std::pair<std::string, std::string>> answers;

  void set(const std::string& line) { lines.push_back(line); }
  void expect(const std::string& question, const std::string& answer) { answers.emplace_back(question, answer); }
};

Content random_content(unsigned seed, unsigned size) {
  std::mt19937 random(random_seed(seed));
  const auto below = [&](unsigned n) { return static_cast<unsigned>(random() % n); };
  Content content;
  content.expect("I3 I6", "2|1");
  for (unsigned i = 0; i < size; ++i) {
    const unsigned motor = 1 + below(32), cs = 1 + below(16);
    const std::string gain = std::to_string(1 + below(1000000));
    content.set(text("I%lu30=", motor) + gain);
    content.set(text("I%lu22=", motor) + gain + ".5");
    content.set("P" + std::to_string(1000 + i) + "=" + gain + ".25");
    content.expect("P" + std::to_string(1000 + i), gain + ".25");
    content.set(text("&%luQ%lu=-", cs, i) + gain);
    content.expect(text("&%luQ%lu", cs, i), "-" + gain);
    const std::string place = text("Y:$%lX,%lu,4", 0x10000 + below(0x700), below(20));
    content.set("M" + std::to_string(4000 + i) + "->" + place);
    content.expect("M" + std::to_string(4000 + i) + "->", place);
  }
  for (unsigned motor = 1; motor <= 32; motor += 1 + below(8)) {
    const unsigned cs = 1 + below(16);
    const std::string axis = std::to_string(2 + below(9999)) + "XYZ"[below(3)] + "+" + std::to_string(1 + below(99));
    content.set(text("&%lu#%lu->", cs, motor) + axis);
    content.expect(text("&%lu#%lu->", cs, motor), axis);
  }
  for (unsigned i = 0; i < size; ++i) {
    const std::string move = "X" + std::to_string(below(100000)) + "Y" + std::to_string(1 + below(1000));
    const std::string number = std::to_string(1 + i * 100 + below(100)), plc = std::to_string(i % 32);
    content.set("OPEN PROG " + number + " CLEAR " + move);
    content.set("CLOSE");
    content.expect("LIST PROG " + number, move + "|RET");
    const std::string formula = "P1=P" + std::to_string(below(8192)) + "*2";
    content.set("OPEN PLC " + plc + " CLEAR " + formula);
    content.set("CLOSE");
    if (i + 32 >= size) content.expect("LIST PLC " + plc, formula + "|RET");
  }
  const unsigned cs = 1 + below(16);
  content.set(text("&%luOPEN FORWARD CLEAR Q7=P%lu", cs, below(8192)));
  content.expect(text("&%luLIST FORWARD", cs), content.lines.back().substr(content.lines.back().find("Q7")) + "|RET");
  content.set("CLOSE");
  content.set(text("&%luOPEN INVERSE CLEAR P%lu=Q1", cs, below(8192)));
  content.expect(text("&%luLIST INVERSE", cs),
                 content.lines.back().substr(content.lines.back().find("CLEAR ") + 6) + "|RET");
  content.set("CLOSE");
  return content;
}

void enter(Controller& c, const Content& content) {
  for (const std::string& line : content.lines) EXPECT_EQ(c.line(line), "") << line;
}

// How many answers are not what they must be; the first of them.
unsigned wrong_answers(Controller& c, const Content& content, std::string* first = nullptr) {
  unsigned wrong = 0;
  for (const auto& [question, answer] : content.answers) {
    const std::string got = c.line(question);
    if (got == answer) continue;
    if (wrong++ == 0 && first != nullptr) *first = question + ": " + got + ", expected " + answer;
  }
  return wrong;
}

bool flash_error() { return (status_word() & STATUS_FLASH_ERROR) != 0; }

void restart(Controller& c) {
  c.restart();
  c.send("I6=1 I3=2\r");
}

// The words of the slot that counts.
struct Slot {
  std::uint32_t* words;
  std::uint32_t size;
};

Slot whole_slot() {
  std::uint32_t* words = fake_hal_flash();
  if (words[0] != FLASH_WHOLE) words += FLASH_SLOT_WORDS;
  EXPECT_EQ(words[0], FLASH_WHOLE);
  return {words, FLASH_WORD_DATA + words[FLASH_WORD_FIRST_WORDS] + words[FLASH_WORD_SECOND_WORDS]};
}

// Makes the checksums right again.
void seal(const Slot& slot) {
  std::uint32_t* w = slot.words;
  const std::uint32_t* data = w + FLASH_WORD_DATA;
  const std::uint32_t first = w[FLASH_WORD_FIRST_WORDS], second = w[FLASH_WORD_SECOND_WORDS];
  w[FLASH_WORD_SECOND_CRC] = ~crc32_words(CRC32_BEGIN, data + first, second);
  w[FLASH_WORD_FIRST_CRC] = ~crc32_words(crc32_words(CRC32_BEGIN, data, first), w + FLASH_WORD_SEQUENCE, 4);
}

// Without the timers, which run.
std::string variables(Controller& c) {
  return c.line("I0..999") + c.line("I5100..5110 I5113..5210 I5213..5299") + c.line("I7000..7199");
}

TEST(SavedContent, AllOfItComesBack) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Controller c;
    for (const unsigned size : {40u, 3u}) {  // the second time less than the first
      c.line("UNDEFINE ALL $$$***");
      c.line("I3=2 I6=1");
      const Content content = random_content(10 * seed + size, size);
      enter(c, content);
      std::string first;
      EXPECT_EQ(wrong_answers(c, content, &first), 0u) << "before SAVE: " << first;
      EXPECT_EQ(c.line("SAVE"), "");
      const std::string before = variables(c);
      c.line("$$$***");
      c.line("I3=2 I6=1");
      EXPECT_GE(wrong_answers(c, content), 5u) << "the answers mean something";
      restart(c);
      EXPECT_EQ(wrong_answers(c, content, &first), 0u) << first;
      EXPECT_EQ(variables(c), before);
      EXPECT_FALSE(flash_error());
    }
  }
}

// firmware:8.5/2: a timer that was saved would begin at the start, where nobody has set it.
TEST(SavedContent, TimersAreNotKept) {
  Controller c;
  c.line("I5111=8000000 I5213=77 SAVE");
  restart(c);
  EXPECT_LE(std::stol(c.line("I5111")), 0) << "it runs on, downwards";
  EXPECT_EQ(c.line("I5213"), "77");
}

TEST(SavedContent, FloatsAreKeptToTheLastBit) {
  Controller c;
  c.line("I122=1/3 I123=-12345678.875 P7=1/3 Q9=-1/7 I8000=$FFFFFF");
  const std::string before = c.line("I122 I123 P7 Q9 I8000");
  c.line("SAVE");
  restart(c);
  EXPECT_EQ(c.line("I122 I123 P7 Q9 I8000"), before);
  EXPECT_EQ(c.line("I122=I122-1/3 I122"), "0") << "no digit of it is lost";
}

// A checksum that is right says nothing of who wrote the words.
TEST(SavedContent, ARealThatIsNoNumberIsPassedOver) {
  Controller c;
  for (const std::uint32_t high : {0x7FF80000u, 0x7FF00000u, 0xFFF00000u}) {  // no number, infinite, minus infinite
    c.line("I123=-12345678.875 SAVE");
    const double saved = -12345678.875;
    std::uint32_t words[2];
    std::memcpy(words, &saved, sizeof words);
    const Slot slot = whole_slot();
    std::uint32_t* const at = std::search(slot.words, slot.words + slot.size, words, words + 2);
    ASSERT_NE(at, slot.words + slot.size);
    at[0] = 0;
    at[1] = high;
    seal(slot);
    restart(c);
    EXPECT_FALSE(flash_error());
    EXPECT_EQ(c.line("I123"), "0") << "as one that SAVE has not kept, " << std::hex << high;
  }
}

// Each word of the small images that a controller with little in it makes; a start-up after each 13th, and after each
// of the first and the last.
TEST(SavedContent, PowerCutAtAnyWordLeavesAllOfTheOldOrAllOfTheNew) {
  Controller c;
  c.line("I17=1 P1=1 M1->X:$10001,0,4");
  c.line("&1#1->1X OPEN PROG 1 CLEAR X1 CLOSE SAVE");
  fake_hal_power_goes(FAKE_POWER_STAYS, 0);
  const auto make = [&](unsigned long n) {
    c.line(text("I17=%lu P1=%lu", n, n) + text(" M1->X:$1%04lX,0,4", n));
    c.line(text("&1#1->%luX OPEN PROG 1 CLEAR X%lu CLOSE SAVE", n, n));
  };
  const auto expected = [](unsigned long n) {
    const std::string number = std::to_string(n), scale = n == 1 ? "" : number;
    return number + "|" + number + "|" + text("X:$1%04lX,0,4", n) + "|" + scale + "X|X" + number + "|RET";
  };
  make(1);
  restart(c);  // as before each of those that follow
  fake_hal_power_goes(FAKE_POWER_STAYS, 0);
  make(1);
  const std::uint32_t writes = fake_hal_flash_writes();
  ASSERT_GT(writes, 500u);
  unsigned long stored = 1;
  unsigned old_ones = 0, new_ones = 0;
  for (std::uint32_t n = 0; n <= writes; n += n < 12 || n + 24 > writes ? 1 : 13) {
    fake_hal_power_goes(n, n % 2 == 0 ? 0x00FFFF00u : 0);
    make(stored + 1);
    fake_hal_power_goes(FAKE_POWER_STAYS, 0);
    restart(c);
    EXPECT_FALSE(flash_error()) << n;
    const std::string got = c.line("I17 P1 M1->") + "|" + c.line("&1#1->") + "|" + c.line("LIST PROG 1");
    if (got == expected(stored + 1)) {
      ++stored;
      ++new_ones;
    } else {
      ASSERT_EQ(got, expected(stored)) << "word " << n << " of " << writes;
      ++old_ones;
    }
  }
  EXPECT_GE(old_ones, 24u);
  EXPECT_GE(new_ones, 2u);
}

TEST(SavedContent, PowerCutInASaveOfFullMemoryLeavesOldOrNew) {
  std::mt19937 random(random_seed(3));
  Controller c;
  std::string line;
  for (int i = 0; i < 64; ++i) line += "X" + std::to_string(i);
  c.line("OPEN PROG 1");
  for (unsigned i = 0; i < 26624 / 64; ++i) ASSERT_EQ(c.line(line), "");
  c.line("CLOSE");
  for (const char* each : {"P0..8191=1.5", "M0..8191->X:$10000,0,24", "I100..3299=1"}) EXPECT_EQ(c.line(each), "");
  for (unsigned cs = 1; cs <= 16; ++cs) EXPECT_EQ(c.line(text("&%luQ0..511=2.5", cs)), "");
  c.line("P0=1 SAVE");
  fake_hal_power_goes(FAKE_POWER_STAYS, 0);
  c.line("SAVE");
  const std::uint32_t writes = fake_hal_flash_writes();
  EXPECT_GT(writes, 100000u);
  int stored = 1;
  for (int i = 0; i < 12; ++i) {
    const std::uint32_t n =
        i < 4 ? writes - static_cast<std::uint32_t>(i) : static_cast<std::uint32_t>(random()) % writes;
    fake_hal_power_goes(n, 0);
    c.line("P0=" + std::to_string(stored + 1) + " SAVE");
    fake_hal_power_goes(FAKE_POWER_STAYS, 0);
    restart(c);
    EXPECT_FALSE(flash_error());
    const std::string got = c.line("P0");
    if (n + 1 >= writes) ++stored;
    EXPECT_EQ(got, std::to_string(stored)) << n << " of " << writes;
    EXPECT_EQ(c.line("SIZE"), "0");
    EXPECT_EQ(c.line("P8191 Q511 I3200"), "1.5|2.5|1");
  }
}

// Every word of a real image at the level of the store, every 97th with a start-up.
TEST(SavedContent, AFlippedWordIsReportedAndDefaultsAreTaken) {
  std::mt19937 random(random_seed(4));
  Controller c;
  c.line("&1#1->3X I17=21 P1=5");
  c.line("OPEN PROG 1 X1 Y2 CLOSE PASSWORD=pass");
  c.line("SAVE");
  const Slot slot = whole_slot();
  ASSERT_GT(slot.size, 500u);
  unsigned starts = 0;
  for (std::uint32_t word = 0; word < slot.size; ++word) {
    const std::uint32_t bit = 1u << random() % 32;
    slot.words[word] ^= bit;
    flash_image image{};
    const flash_store_t found = flash_store_find(&image);
    EXPECT_TRUE(found == FLASH_STORE_DAMAGED || !flash_store_second_is_whole(&image)) << "word " << word;
    if (word % 97 == 0 || word < FLASH_WORD_DATA || word + 1 == slot.size) {
      restart(c);
      EXPECT_TRUE(flash_error()) << "word " << word;
      EXPECT_EQ(c.line("I17 P1"), "10|0") << "word " << word;
      EXPECT_EQ(c.line("&1#1->"), "0");
      EXPECT_EQ(c.line("LIST PROG 1"), "ERR003");
      ++starts;
    }
    slot.words[word] ^= bit;
  }
  EXPECT_GE(starts, 12u);
  restart(c);
  EXPECT_FALSE(flash_error());
  EXPECT_EQ(c.line("I17 P1"), "21|5");
}

TEST(SavedContent, DamageOfTheSecondPartGivesTheDefaultClocksToo) {
  Controller c;
  c.line("I7000=3000 I7002=1 SAVE");
  const Slot slot = whole_slot();
  restart(c);
  EXPECT_EQ(*hal_x(0x07801C) & 0xFFFF00u, 3000u << 8);
  slot.words[slot.size - 1] ^= 0x100;
  restart(c);
  EXPECT_TRUE(flash_error());
  EXPECT_EQ(*hal_x(0x07801C) & 0xFFFF00u, 6527u << 8) << "servo-ic:3";
  EXPECT_EQ(*hal_x(0x078004), 0x3008D2u) << "servo-ic:3";
  EXPECT_EQ(c.line("I7000 I7002 I17"), "6527|3|10");
  EXPECT_EQ(c.line("SAVE"), "");
  restart(c);
  EXPECT_FALSE(flash_error()) << "a new SAVE repairs it";
}

// A coordinate system, a motor, a number that there is not: the run begins at `head` and has `words`.
TEST(SavedContent, NumbersThatThereAreNotAreLeftOut) {
  Controller c;
  c.line("&16#32->7X+3");
  c.line("SAVE");
  const Slot slot = whole_slot();
  const std::uint32_t head = 31u << 16 | 21;  // motor 32 and the 21 words of its definition
  std::uint32_t* axis = slot.words;
  while (axis < slot.words + slot.size && (axis[0] != head || axis[1] != 15)) ++axis;
  ASSERT_LT(axis, slot.words + slot.size);
  restart(c);
  EXPECT_EQ(c.line("&16#32->"), "7X+3");
  const auto left_out = [&](std::uint32_t* word, std::uint32_t value) {
    const std::uint32_t was = *word;
    *word = value;
    seal(slot);
    restart(c);
    EXPECT_FALSE(flash_error());
    EXPECT_EQ(c.line("&16#32->"), "0") << value;
    EXPECT_EQ(c.line("&2#32->5X"), "") << "it is nobody's";
    *word = was;
  };
  left_out(axis + 1, 16);
  left_out(axis + 1, 0xFFFFFFFF);
  left_out(axis, 32u << 16 | 21);
  left_out(axis, 31u << 16 | 20);
  left_out(axis, 31u << 16 | 22);
  left_out(axis, 31u << 16 | 0x8000 | 21);
  left_out(axis, 31u << 16 | 0x7FFF);
  left_out(axis + 3, 0x7FF00000);   // infinite
  left_out(axis + 21, 0xFFF80000);  // no number
  seal(slot);
  restart(c);
  EXPECT_EQ(c.line("&16#32->"), "7X+3");
}

TEST(SavedContent, WordsBehindTheVariablesAreLeftOut) {
  Controller c;
  c.line("P1=1.5 SAVE");
  const Slot slot = whole_slot();
  std::uint32_t* run = slot.words;  // of $6001, the word of P1, counted from M0's at $4000
  while (run < slot.words + slot.size && *run != (0x2001u << 16 | 0x8000 | 1)) ++run;
  ASSERT_LT(run, slot.words + slot.size);
  for (const std::uint32_t first : {0x6000u, 0x5FFFu, 0xFFFFu}) {
    *run = first << 16 | 0x8000 | 1;
    seal(slot);
    restart(c);
    EXPECT_FALSE(flash_error());
    const std::uint32_t address = 0x4000 + first;
    EXPECT_EQ(c.line(text("RHX$%lX", address)) == "0", first != 0x5FFF) << first;
  }
}

// Whatever stands behind a good checksum: the start-up ends, and the controller answers.
TEST(SavedContent, AnythingBehindAGoodChecksumHarmsNothing) {
  std::mt19937 random(random_seed(5));
  Controller c;
  for (unsigned i = 0; i < 40; ++i) {
    c.line("UNDEFINE ALL $$$***");
    c.line("I3=2 I6=1 PASSWORD=");
    enter(c, random_content(i, 2));
    c.line("PASSWORD=something");
    c.line("SAVE");
    const Slot slot = whole_slot();
    for (unsigned change = 0; change < 30; ++change) {
      // The second part is the one with the places; of the first only the last channels' variables are changed.
      const std::uint32_t first = FLASH_WORD_DATA + slot.words[FLASH_WORD_FIRST_WORDS];
      std::uint32_t word = first + static_cast<std::uint32_t>(random()) % (slot.size - first);
      if (random() % 4 == 0) word = first - 1 - static_cast<std::uint32_t>(random()) % 40;
      slot.words[word] =
          random() % 2 == 0 ? static_cast<std::uint32_t>(random()) : slot.words[word] ^ 1u << random() % 32;
    }
    seal(slot);
    restart(c);
    EXPECT_FALSE(flash_error());
    EXPECT_EQ(c.line("VER"), "1.947");
    for (const char* line :
         {"SIZE", "&1#1->", "#32->", "M0..99->", "P0..99", "Q0..99", "LIST PROG 1", "PASSWORD=x", "SAVE", "CLOSE"})
      EXPECT_NE(c.line(line), "no answer");
    EXPECT_EQ(c.line("VER"), "1.947");
  }
}

TEST(SavedContent, NothingOfATemporaryBufferIsKept) {
  Controller c;
  c.line("&1DEF ROT 100 I14=1 B0");
  c.line("OPEN ROT X1 CLOSE SAVE");
  restart(c);
  EXPECT_EQ(c.line("SIZE"), "26624");
  EXPECT_EQ(c.line("I14"), "1");
}

}  // namespace
}  // namespace brick
