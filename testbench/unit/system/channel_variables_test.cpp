// I-variables with hardware behind them: each of the channel and IC variables writes its own field of its own word and
// nothing else, takes its range modulo, and is what the data sheet says after a re-initialisation (servo-ic:1.4,
// servo-ic:2.5, servo-ic:2.6, servo-ic:3, servo-ic:4). Words are read back over the bus with RHX, so firmware's shadows
// cannot hide a wrong write.
#include <array>
#include <sstream>

#include "systemc/cpu/port_a.h"
#include "systemc/machine/board_file.h"
#include "testbench/unit/system/controller.h"

namespace brick {
namespace {

struct Field {
  unsigned lsb, width;
};
using Fields = std::array<Field, 10>;

// I7mn0..I7mn9 in X:+5. A supplementary channel of a MACRO IC has no de-multiplexing, output modes and hardware 1/T.
constexpr Fields kServoFields{{{0, 4}, {13, 1}, {4, 4}, {8, 2}, {15, 1}, {16, 2}, {22, 2}, {20, 2}, {19, 1}, {18, 1}}};
constexpr Fields kSupplementaryFields{
    {{0, 4}, {13, 1}, {4, 4}, {8, 2}, {15, 1}, {16, 1}, {22, 0}, {20, 2}, {19, 1}, {18, 0}}};
constexpr std::uint32_t kLive =
    1 << 10 | 1 << 12 | 1 << 14;  // counter reset, EQU state, amplifier enable; bit 11 falls back

constexpr std::uint32_t mask(Field f) { return ((1u << f.width) - 1) << f.lsb; }
std::uint32_t with(std::uint32_t word, Field f, std::uint32_t value) {
  return (word & ~mask(f)) | (value << f.lsb & mask(f));
}

std::string hex(std::uint32_t value) {
  std::ostringstream text;
  text << '$' << std::hex << std::uppercase << value;
  return text.str();
}

// A channel: number of its first variable, address of its control word. `first`: channel 1 of its IC, which has no
// other counter to compare with.
struct ChannelPlace {
  unsigned variable, address;
  bool first;
  const Fields& fields;
};

// Servo IC m, or m*, channel n = 1..4 (servo-ic:1.2, servo-ic:1.4).
ChannelPlace servo_channel(unsigned m, bool star, unsigned n) {
  constexpr unsigned kBases[10] = {0x78000, 0x78100, 0x78200, 0x78300, 0x79200,
                                   0x79300, 0x7A200, 0x7A300, 0x7B200, 0x7B300};
  return {7000 + 100 * m + (star ? 50 : 0) + 10 * n, kBases[m] + (star ? 0x20 : 0) + 8 * (n - 1) + 5, n == 1,
          kServoFields};
}
// Supplementary channel 1*, 2* of MACRO IC m.
ChannelPlace supplementary_channel(unsigned m, unsigned n) {
  constexpr unsigned kBases[4] = {0x78400, 0x79400, 0x7A400, 0x7B400};
  return {6800 + 50 * m + 10 * n, kBases[m] + 0x0D + 8 * n, n == 1, kSupplementaryFields};
}

class ChannelVariables : public Controller {
 protected:
  void start_board(const std::string& name) {
    MachineConfig config;
    config.board = read_board_file("boards/" + name + ".toml");
    start(config);
  }
  void reinitialize() {
    link().command("$$$***");
    ASSERT_TRUE(link().connect(machine().now() + ms_to_ticks(200))) << "no reply after $$$***";
  }
  // Replies to a line of several commands, one line each.
  std::vector<std::string> ask_all(const std::string& line) {
    const Reply reply = link().command(line);
    EXPECT_TRUE(reply.complete) << "no complete reply to " << line;
    EXPECT_FALSE(reply.error) << line << ": " << reply.raw;
    return reply.lines;
  }
  std::uint32_t word(unsigned address) {
    return static_cast<std::uint32_t>(std::stoul(ask("RHX" + hex(address)), nullptr, 16));
  }

  // Writes the variable, reads it and the word. Returns false after reporting a difference.
  bool expect(unsigned variable, std::uint32_t value, std::uint32_t reads, unsigned address, std::uint32_t word) {
    const std::string name = "I" + std::to_string(variable);
    const auto lines = ask_all(name + "=" + std::to_string(value) + " " + name + " RHX" + hex(address));
    if (lines.size() != 2) {
      ADD_FAILURE() << name << ": " << lines.size() << " lines";
      return false;
    }
    const std::string& shown = lines[0];
    const auto read = std::stoul(shown[0] == '$' ? shown.substr(1) : shown, nullptr, shown[0] == '$' ? 16 : 10);
    EXPECT_EQ(read, reads) << name << "=" << value;
    const auto found = std::stoul(lines[1], nullptr, 16);
    EXPECT_EQ(found, word) << name << "=" << value << ": " << hex(address) << " is "
                           << hex(static_cast<std::uint32_t>(found)) << ", expected " << hex(word);
    return read == reads && found == word;
  }

  // All fields at 0 and at their limit, the live bits at 0 and 1: each variable changes its own field only. A value
  // beyond the range is taken modulo, without an error.
  void check_channel(const ChannelPlace& c) {
    SCOPED_TRACE("I" + std::to_string(c.variable) + ".., " + hex(c.address));
    for (const bool ones : {false, true}) {
      for (const std::uint32_t live : {0u, kLive}) {
        const std::uint32_t before = prepare(c, ones, live);
        for (unsigned k = 0; k < c.fields.size(); ++k)
          if (!check_field(c, k, before, ones)) return;
      }
    }
  }
  // The short form: each variable once from 0 to its limit.
  void check_channel_once(const ChannelPlace& c) {
    SCOPED_TRACE("I" + std::to_string(c.variable) + ".., " + hex(c.address));
    std::uint32_t word = prepare(c, false, kLive);
    for (unsigned k = 0; k < c.fields.size(); ++k) {
      const Field f = c.fields[k];
      if (f.width == 0) continue;
      const std::uint32_t limit = (1u << f.width) - 1;
      word = with(word, f, limit);
      if (!expect(c.variable + k, limit, limit, c.address, word)) return;
    }
  }
  std::uint32_t prepare(const ChannelPlace& c, bool ones, std::uint32_t live) {
    std::string set;
    std::uint32_t word = live | (c.first ? 1u << 13 : 0);
    for (unsigned k = 0; k < c.fields.size(); ++k) {
      if (ones) word |= mask(c.fields[k]);
      if (c.fields[k].width != 0) set += "I" + std::to_string(c.variable + k) + (ones ? "=15 " : "=0 ");
    }
    ask_all(set + "WX" + hex(c.address) + "," + hex(word));
    return word;
  }
  bool check_field(const ChannelPlace& c, unsigned k, std::uint32_t before, bool ones) {
    const Field f = c.fields[k];
    const unsigned variable = c.variable + k;
    const std::uint32_t limit = (1u << f.width) - 1;
    if (c.first && k == 1)
      return expect(variable, 0, 1, c.address, before) && expect(variable, 1, 1, c.address, before);
    std::vector<std::uint32_t> values{ones ? 0 : limit};
    for (std::uint32_t bit = 1; bit <= limit; bit *= 2) values.push_back(ones ? limit & ~bit : bit);
    values.push_back(ones ? limit : 0);
    for (const std::uint32_t value : values)
      if (!expect(variable, value, value, c.address, with(before, f, value))) return false;
    const std::uint32_t beyond = 2 * limit + 2 + (ones ? limit : 0);  // the range is limit + 1
    return expect(variable, beyond, ones ? limit : 0, c.address, before);
  }
};

class ChannelVariablesOnEachEngine : public ChannelVariables {};

TEST_P(ChannelVariables, EachWritesItsOwnFieldAndLeavesTheLiveBitsAlone) {
  BRICK_COVERS("CLK-6 CARD-3");
  start_board("geobrick-lv-8");
  for (unsigned m = 0; m < 2; ++m)
    for (unsigned n = 1; n <= 4; ++n) check_channel(servo_channel(m, false, n));
}

TEST_P(ChannelVariablesOnEachEngine, EachWritesItsOwnField) {
  start_board("geobrick-lv-8");
  check_channel_once(servo_channel(0, false, 1));
  check_channel_once(servo_channel(1, false, 3));
}

TEST_P(ChannelVariablesOnEachEngine, DefaultsAfterAReinitialisationAreInTheControlWords) {
  start_board("geobrick-lv-8");
  for (unsigned m = 0; m < 2; ++m) {
    for (unsigned n = 1; n <= 4; ++n) {
      const ChannelPlace c = servo_channel(m, false, n);
      std::string set;
      for (unsigned k = 0; k < 10; ++k) set += "I" + std::to_string(c.variable + k) + "=2 ";
      ask_all(set + "WX" + hex(c.address) + "," + hex(kLive | 2));
    }
  }
  EXPECT_EQ(word(0x7811D), kLive | 2);
  reinitialize();
  for (unsigned m = 0; m < 2; ++m) {
    for (unsigned n = 1; n <= 4; ++n) {
      const ChannelPlace c = servo_channel(m, false, n);
      const std::string first = std::to_string(c.variable), last = std::to_string(c.variable + 9);
      EXPECT_EQ(ask("I" + first + ".." + last), n == 1 ? "7|1|1|0|0|0|0|0|0|0" : "7|0|1|0|0|0|0|0|0|0") << "I" << first;
      // x4, capture on the index; amplifiers off
      EXPECT_EQ(word(c.address), 7u | 1u << 4 | (n == 1 ? 1u << 13 : 0)) << hex(c.address);
    }
  }
}

// Servo IC 1 does not drive the clocks, so its words can take any value.
TEST_P(ChannelVariables, IcVariablesWriteTheirOwnFields) {
  BRICK_COVERS("CLK-6");
  start_board("geobrick-lv-8");
  constexpr unsigned kClock = 0x78104, kPwm = 0x7811C;
  struct Variable {
    unsigned number, address;
    Field field;
  };
  const Variable variables[] = {{7100, kPwm, {8, 15}},   {7101, kClock, {16, 4}}, {7102, kClock, {20, 4}},
                                {7103, kClock, {0, 12}}, {7104, kPwm, {0, 8}},    {7105, 0x7810C, {0, 24}},
                                {7106, 0x78114, {0, 24}}};
  for (const bool ones : {false, true}) {
    for (const Variable& v : variables)
      ask_all("I" + std::to_string(v.number) + "=" + (ones ? std::to_string((1u << v.field.width) - 1) : "0"));
    for (const Variable& v : variables) {
      const std::uint32_t before = word(v.address), limit = (1u << v.field.width) - 1;
      std::uint32_t background = 0;
      for (const Variable& other : variables)
        if (ones && other.address == v.address) background |= mask(other.field);
      ASSERT_EQ(before, background | (v.address == kClock ? 3u << 12 : 0)) << "directions 3 are inputs";
      for (std::uint32_t bit = 1; bit <= limit; bit *= 2) {
        const std::uint32_t value = ones ? limit & ~bit : bit;
        if (!expect(v.number, value, value, v.address, with(before, v.field, value))) return;
      }
      ASSERT_TRUE(expect(v.number, limit + 1, 0, v.address, with(before, v.field, 0))) << "modulo";
      ask_all("I" + std::to_string(v.number) + "=" + std::to_string(ones ? limit : 0));
    }
  }
  EXPECT_EQ(ask("I7108=5 I7109=5 I7108 I7109"), "0|0") << "no function";
  EXPECT_EQ(ask("I7107=0 I7007=3 I7007 I7107"), "3|0");  // one line: the source moves
  EXPECT_EQ(word(0x78004) >> 12 & 3, 3u);
  EXPECT_EQ(word(kClock) >> 12 & 3, 0u);
}

TEST_P(ChannelVariables, VariablesOfAbsentIcsRead0AndIgnoreWrites) {
  start_board("geobrick-lv-4");
  unsigned writes = 0;
  machine().on_bus_cycle = [&](const PortACycle& c) {
    if (c.write && c.x && c.address >= 0x78100 && c.address < 0x7C000) ++writes;
  };
  for (const unsigned number :
       {7100u, 7103u, 7105u, 7110u, 7116u, 7143u, 7250u, 7260u, 7999u, 6800u, 6807u, 6810u, 6823u, 6990u})
    EXPECT_EQ(ask("I" + std::to_string(number) + "=1 I" + std::to_string(number)).find_first_not_of("$0"),
              std::string::npos)
        << number;
  EXPECT_EQ(writes, 0u);
  machine().on_bus_cycle = nullptr;
}

BRICK_ON_ENGINES(ChannelVariables, Engine::kSystemC);
BRICK_ON_ENGINES(ChannelVariablesOnEachEngine, Engine::kRtl, Engine::kSystemC);

// Every IC that can be fitted: IC 2*..9* and the supplementary channels among them.
class AllIcVariables : public ChannelVariables {};

TEST_P(AllIcVariables, EachWritesItsOwnField) {
  start_board("all-ics");
  for (unsigned m = 0; m < 10; ++m)
    for (unsigned n = 1; n <= 4; ++n) check_channel_once(servo_channel(m, false, n));
  for (unsigned m = 2; m < 10; ++m)
    for (unsigned n = 1; n <= 4; ++n) check_channel_once(servo_channel(m, true, n));
  for (unsigned m = 0; m < 4; ++m)
    for (unsigned n = 1; n <= 2; ++n) check_channel_once(supplementary_channel(m, n));
}
TEST_P(AllIcVariables, DefaultsOfStarredAndMacroIcs) {
  start_board("all-ics");
  reinitialize();
  EXPECT_EQ(ask("I7250..7259"), "6527|0|3|2258|15|$7FFFC0|$FFFFFE|3|0|0");
  EXPECT_EQ(ask("I7260..7269"), "7|1|1|0|0|0|0|0|0|0");
  EXPECT_EQ(ask("I6820..6829"), "7|0|1|0|0|0|0|0|0|0");
  EXPECT_EQ(word(0x78225), 0x2017u);
  EXPECT_EQ(word(0x7841D), 0x17u);
}
BRICK_ON_ENGINES(AllIcVariables, Engine::kSystemC);

}  // namespace
}  // namespace brick
