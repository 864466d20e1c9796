// Sizes of samples and what is in them (firmware/buffers/gather.h), over all short mixtures of sources of 24 and of 48
// bits, in user memory and in the dual-ported RAM (firmware:4.3, host-bus:6.8).
#include "testbench/unit/firmware_program/dpram_host.h"

namespace {

using platform::host;
using platform::host_lines;
using Lines = std::vector<std::string>;

class GatherSizes : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(host("I3=2 I6=1 I9=0 I5049=1"), "");
    for (unsigned i = 0; i < 6; ++i)
      ASSERT_EQ(
          host("WX$" + hex(0x10F0 + i, 1) + ",$" + hex(x(i), 6) + " WY$" + hex(0x10F0 + i, 1) + ",$" + hex(y(i), 6)),
          "");
  }
  static std::string hex(unsigned long word, int digits) {
    char text[16];
    std::snprintf(text, sizeof text, "%0*lX", digits, word);
    return text;
  }
  static unsigned x(unsigned i) { return 0x810000 + 0x111 * i; }
  static unsigned y(unsigned i) { return 0x2A0000 + 0x111 * i; }

  // `mixture`: a letter a source, X or Y of 24 bits, L or F of 48 (fixed or floating point).
  static void choose(const std::string& mixture) {
    for (unsigned i = 0; i < mixture.size(); ++i) {
      const std::size_t kind = std::string("YXLF").find(mixture[i]);
      ASSERT_EQ(host("I" + std::to_string(5001 + i) + "=$" + hex(kind << 22 | (0x10F0 + i), 6)), "");
    }
    ASSERT_EQ(host("I5050=" + std::to_string((1 << mixture.size()) - 1) + " I5051=0"), "");
  }
  static bool is_long(char kind) { return kind == 'L' || kind == 'F'; }
  // The long words of a sample: words of 24 bits fill X and Y in turn, those of 48 a whole one.
  static Lines sample(const std::string& mixture) {
    Lines lines;
    bool half = false;
    for (unsigned i = 0; i < mixture.size(); ++i) {
      const std::string word = hex(mixture[i] == 'Y' ? y(i) : x(i), 6);
      if (is_long(mixture[i])) {
        lines.push_back(hex(x(i), 6) + hex(y(i), 6));
      } else if (half) {
        lines.back().replace(6, 6, word);
      } else {
        lines.push_back(word + "000000");
      }
      half = !is_long(mixture[i]) && !half;
    }
    return lines;
  }
  static Lines mixtures() {
    Lines all, last = {""};
    for (int length = 1; length <= 4; ++length) {
      Lines next;
      for (const std::string& begun : last)
        for (const char* kind : {"X", "L"}) next.push_back(begun + kind);
      all.insert(all.end(), next.begin(), next.end());
      last = next;
    }
    all.insert(all.end(), {"XYXYX", "YLYLY", "FXF", "YYF", "FYYYL", "XFLYYX"});
    return all;
  }
  platform::NativeDpram ram;
};

// As many whole samples as there is room for.
TEST_F(GatherSizes, SamplesFillUserMemory) {
  for (const std::string& mixture : mixtures()) {
    ASSERT_NO_FATAL_FAILURE(choose(mixture));
    const Lines one = sample(mixture);
    for (std::size_t size = 1; size <= 3 * one.size(); ++size) {
      SCOPED_TRACE(mixture + " in " + std::to_string(size));
      ASSERT_EQ(host("DEL GAT DEF GAT " + std::to_string(size)), "");
      const std::size_t samples = size / one.size();
      ASSERT_EQ(host("GATHER"), samples == 0 ? "ERR003" : "");
      if (samples == 0) continue;
      platform::servo_ticks(5);
      Lines expected;
      for (std::size_t i = 0; i < samples; ++i) expected.insert(expected.end(), one.begin(), one.end());
      EXPECT_EQ(host_lines("LIST GATHER"), expected);
      EXPECT_EQ(host("GATHER"), "ERR003") << "full";
    }
  }
}

// Items of 32 bits, of 48 bits two, the low one first; a sample that begins in the buffer is whole.
TEST_F(GatherSizes, SamplesFillTheRam) {
  ASSERT_EQ(host("I5000=2"), "");
  for (const std::string& mixture : mixtures()) {
    ASSERT_NO_FATAL_FAILURE(choose(mixture));
    std::vector<std::uint32_t> items;
    const auto add = [&items](std::uint32_t word) { items.push_back(word | (word & 0x800000 ? 0xFF000000 : 0)); };
    for (unsigned i = 0; i < mixture.size(); ++i) {
      if (mixture[i] != 'X') add(y(i));
      if (mixture[i] != 'Y') add(x(i));
    }
    for (std::size_t size = 1; size <= 2 * items.size(); ++size) {
      SCOPED_TRACE(mixture + " in " + std::to_string(size));
      ASSERT_EQ(host("DEL GAT DEF GAT " + std::to_string(size) + " GATHER"), "");
      platform::servo_ticks(4);
      const std::size_t samples = (size + items.size() - 1) / items.size();
      EXPECT_EQ(ram.read(DPRAM_GATHER_POINTER), samples * items.size());
      for (std::size_t i = 0; i < samples * items.size(); ++i)
        EXPECT_EQ(dpram_read_item(static_cast<std::uint32_t>(DPRAM_OPEN + 4 * i)), items[i % items.size()]) << i;
    }
  }
}

// Words that are made when they are read, of 48 bits too: scales of an axis definition, a timer.
TEST_F(GatherSizes, LongWordsThatAreMade) {
  ASSERT_EQ(host("&1#2->100X+7 I5111=-5 I5112=1234567"), "");
  for (const char* address : {"14F", "152"}) {
    const std::string both = hex(std::stoul(host(std::string("RHX$") + address), nullptr, 16), 6) +
                             hex(std::stoul(host(std::string("RHY$") + address), nullptr, 16), 6);
    ASSERT_NE(both.find_first_not_of('0'), std::string::npos);
    ASSERT_EQ(host(std::string("DEL GAT I5000=0 I5001=$C00") + address + " I5050=1 DEF GAT 10 GATHER"), "");
    platform::servo_ticks(1);
    ASSERT_EQ(host("ENDG"), "");
    EXPECT_EQ(host_lines("LIST GATHER"), Lines{both}) << address;
    host_port_character(0x05);
    platform::background(1);
    std::string sent;
    for (const char c : platform::sent()) sent += hex(static_cast<std::uint8_t>(c), 2);
    EXPECT_EQ(sent, both + "06") << address << ", ^E";
  }
  ASSERT_EQ(host("DEL GAT I5000=2 I5001=$802015 DEF GAT 10 GATHER"), "");
  platform::servo_ticks(1);
  const auto item = [](unsigned n) { return static_cast<std::int32_t>(dpram_read_item(DPRAM_OPEN + 4 * n)); };
  EXPECT_NEAR(item(0), 1234567, 10) << "Isx12, which runs down";
  EXPECT_NEAR(item(1), -5, 10);
  EXPECT_LE(item(1), -5);
}

// Each of the 48 has its bit of I5050 or I5051.
TEST_F(GatherSizes, EachSourceHasItsBit) {
  for (unsigned i = 0; i < 48; ++i) {
    const unsigned word = i % 6;
    ASSERT_EQ(host("I5001..5048=$400000 I" + std::to_string(5001 + i) + "=$" + hex(0x10F0 + word, 6)), "");
    ASSERT_EQ(
        host("I5050=" + std::to_string(i < 24 ? 1 << i : 0) + " I5051=" + std::to_string(i < 24 ? 0 : 1 << (i - 24))),
        "");
    ASSERT_EQ(host("DEL GAT DEF GAT 10 GATHER"), "");
    platform::servo_ticks(1);
    ASSERT_EQ(host("ENDG"), "");
    EXPECT_EQ(host_lines("LIST GATHER"), Lines{hex(y(word), 6) + "000000"}) << i;
  }
}

// A start forgets the buffer, whatever has been saved of its sources; nothing is gathered.
TEST_F(GatherSizes, AStartForgetsTheBuffer) {
  for (const char* mode : {"0", "2"}) {
    ASSERT_EQ(host(std::string("I5000=") + mode + " I5001=$10F0 I5050=1 I5051=0 SAVE"), "");
    ASSERT_EQ(host("DEF GAT 50 GATHER"), "");
    platform::reset();
    ASSERT_EQ(host("I5050"), "1");
    EXPECT_EQ(host("GATHER"), "ERR003") << mode;
    EXPECT_EQ(host("SIZE"), "26624");
    EXPECT_EQ(host("DEF GAT 50 GATHER"), "") << mode;
    ASSERT_EQ(host("ENDG DEL GAT"), "");
  }
}

}  // namespace
