// The scoreboards of PWM, PFM, serial DACs and ADCs against numbers of the data sheet and pins made by hand.
#include <gtest/gtest.h>

#include "testbench/checkers/pfm_scoreboard.h"
#include "testbench/checkers/pwm_scoreboard.h"
#include "testbench/checkers/serial_scoreboard.h"

namespace brick {
namespace {

TEST(PwmScoreboard, OnTimesAreThoseOfTheDataSheet) {  // servo-ic:14/2
  struct Row {
    int command;
    Tick high;
  };
  constexpr Tick kPeriod = 26114;
  const auto turns = pwm_turns(0, 6527, 5 * kPeriod);
  for (const Row row : {Row{0, 13057}, Row{100, 13257}, Row{-100, 12857}, Row{6528, 26113}, Row{6529, 26114},
                        Row{-6529, 0}, Row{-32768, 0}}) {
    const auto levels = pwm_switches(turns, {{-1, row.command}}, {});
    EXPECT_EQ(pwm_time(levels, 1, kPeriod, 2 * kPeriod), row.high) << row.command;
    EXPECT_EQ(pwm_time(levels, 2, kPeriod, 2 * kPeriod), kPeriod - row.high) << row.command;
    EXPECT_EQ(pwm_on_time(6527, row.command), row.high);
  }
}

TEST(PwmScoreboard, PulseNoLongerThanTheDeadTimeIsSwallowed) {
  constexpr Tick kPeriod = 4 * 100 + 6;
  const auto turns = pwm_turns(0, 100, 5 * kPeriod);
  const auto upper = [&](int command) {
    return pwm_time(pwm_switches(turns, {{-1, command}}, {16}), 1, kPeriod, 2 * kPeriod);
  };
  EXPECT_EQ(upper(-94), 0);  // 15 ticks
  EXPECT_EQ(upper(-93), 1);  // 17 ticks
  EXPECT_EQ(pwm_time(pwm_switches(turns, {{-1, -94}}, {16}), 2, kPeriod, 2 * kPeriod), kPeriod - 15 - 16);
}

TEST(PwmScoreboard, NewLimitCountsFromTheNextBottomTurn) {
  const auto turns = pwm_turns(0, 100, 2000, {{50, 200}});
  ASSERT_GE(turns.size(), 5u);
  EXPECT_EQ(turns[1].tick, 203);
  EXPECT_EQ(turns[2].tick, 406);  // the old one to its end
  EXPECT_EQ(turns[3].tick, 406 + 102 + 201);
  EXPECT_EQ(turns[3].count, 201);
  EXPECT_EQ(turns[4].tick, turns[3].tick + 403);
}

TEST(PwmScoreboard, CommandCountsFromTheNextTurn) {
  const auto levels = pwm_switches(pwm_turns(0, 100, 1000), {{-1, 0}, {110, -200}}, {});
  // Up to count 0 at tick 102 the upper switch is on; command 0 would put it on again at 203 + 102.
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_EQ(levels[1].tick, 102);
  EXPECT_EQ(levels[1].pins, 2u);
}

TEST(PwmScoreboard, OneTickIsADifference) {
  const auto expected = pwm_switches(pwm_turns(0, 100, 1000), {{-1, 0}}, {16});
  EXPECT_EQ(pwm_difference(expected, expected, 16, 900), "");
  for (std::size_t i = 1; i < expected.size() && expected[i].tick <= 899; ++i) {
    auto seen = expected;
    ++seen[i].tick;
    EXPECT_NE(pwm_difference(seen, expected, 16, 900), "") << i;
    seen.erase(seen.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(pwm_difference(seen, expected, 16, 900), "") << i;
  }
  std::vector<PwmLevel> seen{{0, 3}};
  EXPECT_EQ(pwm_difference(seen, {{0, 2}}, 5, 900), "tick 5: both on, expected lower on") << "from the beginning";
}

// servo-ic:14/6: $010000 is a pulse every 256 PFM_CLK, 15 wide.
std::vector<PfmLevel> pulses(Tick first, Tick clock, unsigned width, int count, Tick period) {
  std::vector<PfmLevel> levels{{0, 0}};
  for (int i = 0; i < count; ++i) {
    levels.push_back({first + i * period * clock, 1});
    levels.push_back({first + (i * period + width) * clock, 0});
  }
  return levels;
}

TEST(PfmScoreboard, PulseEach256Clocks) {
  const auto seen = pulses(256 * 12, 12, 15, 10, 256);  // first edge that adds: tick 12
  const PfmRule rule{12, 15};
  const std::vector<PfmCommand> commands{{0, 65'536}, {2560 * 12 + 3, 0}};
  PfmScoreboard board;
  EXPECT_EQ(board.judge(rule, commands, seen, 256 * 12, 40'000), "");
  EXPECT_EQ(board.pulses().up, 10);
  EXPECT_EQ(board.pulses().down, 0);
  EXPECT_FALSE(board.pulses().overlap);
  for (std::size_t i = 1; i < seen.size(); ++i) {
    auto wrong = seen;
    wrong[i].tick += 12;
    EXPECT_NE(PfmScoreboard{}.judge(rule, commands, wrong, 256 * 12, 40'000), "") << i;
    wrong = seen;
    wrong[i].pins ^= 2;
    EXPECT_NE(PfmScoreboard{}.judge(rule, commands, wrong, 256 * 12, 40'000), "") << i;
  }
  auto wrong = seen;
  wrong.pop_back();
  EXPECT_NE(PfmScoreboard{}.judge(rule, commands, wrong, 256 * 12, 40'000).find("no change, expected pulse 0"),
            std::string::npos);
  wrong = seen;
  wrong.push_back({39'000, 1});
  EXPECT_NE(PfmScoreboard{}.judge(rule, commands, wrong, 256 * 12, 40'000).find("at tick 39000, expected no change"),
            std::string::npos);
}

TEST(PfmScoreboard, NoMoreThanAQuarterOfTheClock) {
  const auto seen = pulses(4 * 12, 12, 1, 10, 4);
  const std::vector<PfmCommand> commands{{0, 8'388'607}, {40 * 12 + 3, 0}};
  EXPECT_EQ(PfmScoreboard{}.judge({12, 0}, commands, seen, 48, 2'000), "");
  EXPECT_NE(PfmScoreboard{}.judge({12, 0, 1 << 23}, commands, seen, 48, 2'000), "");
}

TEST(SerialScoreboard, WordsAndLines) {
  EXPECT_EQ(dac_stream(0xA5C37F, false), 0xA5C340u);
  EXPECT_EQ(dac_stream(0xA5C37F, true), 0x5A3C80u);
  EXPECT_EQ(adc_word(0x5C3A96), 0xC3A940u);
  EXPECT_EQ(dac_strobe_bits(0x7FFFC0), 18u);
  EXPECT_EQ(dac_strobe_bits(0x7FFF00), 16u);
  for (const std::uint32_t other : {0xFFFFC0u, 0x7FFFC1u, 0x3FFFC0u, 0u}) EXPECT_EQ(dac_strobe_bits(other), 0u);
}

// 24 bits of `strobe` and of `data` on line 0 from tick `start` on.
std::vector<SerialLevel> stream(Tick start, Tick bit, std::uint32_t strobe, std::uint32_t data) {
  std::vector<SerialLevel> levels{{0, false, false, 0}};
  for (int i = 23; i >= 0; --i, start += bit) {
    levels.push_back({start, false, (strobe >> i & 1) != 0, data >> i & 1});
    levels.push_back({start + bit / 2, true, (strobe >> i & 1) != 0, data >> i & 1});
  }
  levels.push_back({start, false, (strobe & 1) != 0, 0});
  return levels;
}

TEST(SerialScoreboard, FindsTheWordAndWhatTheStrobeLatches) {
  const auto levels = stream(112, 24, 0x7FFFC0, 0xA5C340);
  const SerialRecord record = serial_streams(levels, {100, 5000}, 24, 1);
  EXPECT_EQ(record.error, "");
  ASSERT_EQ(record.streams.size(), 1u);
  EXPECT_EQ(record.streams[0].strobe, 0x7FFFC0u);
  EXPECT_EQ(record.streams[0].data[0], 0xA5C340u);
  EXPECT_EQ(record.streams[0].received[0], 0xA5C340u >> 6);
  EXPECT_EQ(record.streams[0].strobe_high, 17 * 24);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    auto wrong = levels;
    wrong.erase(wrong.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NE(serial_streams(wrong, {100, 5000}, 24, 1).error, "") << i;
  }
  EXPECT_NE(serial_streams(levels, {100, 5000}, 12, 1).error, "");
  EXPECT_NE(serial_streams(levels, {20, 5000}, 24, 1).error, "") << "too late";
  auto more = levels;
  more.push_back({2000, false, true, 0});
  EXPECT_NE(serial_streams(more, {100, 5000}, 24, 1).error, "") << "strobe moves afterwards";
}

}  // namespace
}  // namespace brick
