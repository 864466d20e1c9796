// Every row of host-bus:2.2 with made-up cycles: it passes exactly at its limit and fails one femtosecond beyond, in
// each class of wait states, at slow and fast clocks, with and without /TA. The limits are written here once more, as
// the data sheet prints them.
#include <gmock/gmock.h>

#include "testbench/checkers/timing_port_a.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

using Rule = PortATiming::Rule;

constexpr unsigned kMultipliers[] = {1, 8, 10, 16, 31, 32};
constexpr unsigned kWaitStates[] = {1, 2, 3, 4, 7, 8, 15, 31};

// a TC + b, as the data sheet has it; TC = 1 / (9.8304 MHz x n). In favour of the part: down for a least, up for a
// most.
struct Formula {
  int quarters;
  double ns;
  bool most = false;
  TimeFs fs(unsigned n) const {
    // TC / 4 = 10^15 / (4 x 9830400 n) fs
    const __int128 product = static_cast<__int128>(quarters) * 1'000'000'000'000'000;
    const __int128 parts = static_cast<__int128>(4) * 9'830'400 * n;
    __int128 quotient = product / parts;
    if (product % parts != 0 && (product < 0) != most) quotient += most ? 1 : -1;
    return static_cast<TimeFs>(quotient) + static_cast<TimeFs>(ns * 10 + (ns < 0 ? -0.5 : 0.5)) * (kFsPerNs / 10);
  }
};

// The row for these wait states, `more` of them added by /TA; none where the data sheet has none.
std::optional<Formula> row(unsigned number, unsigned ws, unsigned more) {
  const int w = static_cast<int>(ws), all = static_cast<int>(ws + more), t = static_cast<int>(4 * more);
  const auto form = [&](int three, int seven, int above) { return ws <= 3 ? three : ws <= 7 ? seven : above; };
  const bool from_two = ws >= 2;
  switch (number) {
    case 100:
      return Formula{4 * (all + form(1, 2, 3)), -4};
    case 101:
      return Formula{ws == 1 ? 1 : form(3, 5, 5), -2};
    case 102:
      return Formula{t + (ws == 1 ? 6 : ws <= 3 ? 4 * w : 4 * w - 2), -4};
    case 103:
      return Formula{form(1, 5, 9), -2};
    case 104:
      return Formula{4 * all + 3, -5, true};
    case 105:
      return Formula{4 * all + 1, -5, true};
    case 106:
      return Formula{0, 0};
    case 107:
      return Formula{4 * all + 3, -4};
    case 108:
      return Formula{4 * all - 1, -3};
    case 109:
      return Formula{form(1, 5, 9), -2};
    case 110:
      if (from_two) return Formula{form(1, -1, -1), -3.7};
      break;
    case 111:
      if (from_two) return Formula{form(1, 5, 9), 0.2, true};
      break;
    case 112:
      if (from_two) return Formula{form(5, 9, 13), -4};
      break;
    case 113:
      if (from_two) return Formula{form(7, 7, 11), -4};
      break;
    case 114:
      if (from_two) return Formula{form(8, 10, 14), -4};
      break;
    case 115:
      return Formula{2, -2};
    case 116:
      return Formula{4 * all + 1, -4};
    case 117:
      if (from_two) return Formula{form(5, 5, 9), -2};
      break;
    case 118:
      return Formula{1, 2};
    case 119:
      return Formula{0, 0};
  }
  return std::nullopt;
}

// A cycle with all the time in the world, and nothing that moves. The data of a write come and go with the strobe.
PinCycle easy(bool write, unsigned n, unsigned ws, unsigned more, TimeFs start = 1'000'000 * kFsPerNs) {
  constexpr TimeFs kLong = 100'000 * kFsPerNs;
  PinCycle c;
  c.address = 0x078003;
  c.x = true;
  c.aa = 2;
  c.write = write;
  c.multiplier = n;
  c.wait_states = ws;
  c.stretched = c.asked = more;
  c.start = c.ta_moved = start;
  c.strobe_low = start + kLong;
  c.data_valid = start;
  c.strobe_high = start + 3 * kLong;
  c.end = c.data_held = c.ta_held = start + 4 * kLong;
  if (write) {
    const TimeFs quarter = 25'431'315 / n;
    c.data_on = c.data_valid = c.strobe_low + (ws <= 3 ? quarter : 0);
    c.end = c.ta_held = c.data_held = c.data_off = c.strobe_high + quarter * (ws <= 3 ? 1 : ws <= 7 ? 5 : 9);
  }
  return c;
}

std::vector<std::string> violated(const PortATiming& timing) {
  std::vector<std::string> ids;
  for (const TimingViolation& v : timing.ledger().violations()) ids.push_back(timing.ledger().rules()[v.rule].id);
  return ids;
}

// Makes a cycle whose row measures exactly `time`.
struct RowCase {
  unsigned number;
  bool write;
  std::function<void(PinCycle&, TimeFs time)> measure;
};
const std::vector<RowCase>& cases_of_one_cycle() {
  static const std::vector<RowCase> cases{{100, true, [](PinCycle& c, TimeFs t) { c.start = c.end - t; }},
                                          {101, true, [](PinCycle& c, TimeFs t) { c.strobe_low = c.start + t; }},
                                          {102, true, [](PinCycle& c, TimeFs t) { c.strobe_low = c.strobe_high - t; }},
                                          {103, true, [](PinCycle& c, TimeFs t) { c.end = c.strobe_high + t; }},
                                          {104, false, [](PinCycle& c, TimeFs t) { c.data_valid = c.start + t; }},
                                          {105, false, [](PinCycle& c, TimeFs t) { c.data_valid = c.strobe_low + t; }},
                                          {106, false, [](PinCycle& c, TimeFs t) { c.data_held = c.strobe_high + t; }},
                                          {107, true, [](PinCycle& c, TimeFs t) { c.start = c.strobe_high - t; }},
                                          {108, true, [](PinCycle& c, TimeFs t) { c.data_valid = c.strobe_high - t; }},
                                          {109, true, [](PinCycle& c, TimeFs t) { c.data_held = c.strobe_high + t; }},
                                          {110, true, [](PinCycle& c, TimeFs t) { c.data_on = c.strobe_low + t; }},
                                          {111, true, [](PinCycle& c, TimeFs t) { c.data_off = c.strobe_high + t; }},
                                          {115, false, [](PinCycle& c, TimeFs t) { c.strobe_low = c.start + t; }},
                                          {116, false, [](PinCycle& c, TimeFs t) { c.strobe_low = c.strobe_high - t; }},
                                          {117, false, [](PinCycle& c, TimeFs t) { c.end = c.strobe_high + t; }},
                                          {119, true, [](PinCycle& c, TimeFs t) { c.ta_held = c.strobe_high + t; }}};
  return cases;
}

template <class Judge>
void at_and_beyond_the_limit(unsigned number, Judge judge) {
  const std::string id = std::to_string(number);
  for (const unsigned n : kMultipliers) {
    for (const unsigned ws : kWaitStates) {
      for (const unsigned more : {0u, 3u}) {
        SCOPED_TRACE(::testing::Message() << "row " << number << ", I52 = " << n - 1 << ", " << ws << " + " << more);
        const auto formula = row(number, ws, more);
        if (!formula) {
          EXPECT_THAT(judge(n, ws, more, 0), ::testing::Not(::testing::Contains(id))) << "has no row";
          continue;
        }
        const TimeFs limit = formula->fs(n), beyond = formula->most ? 1 : -1;
        EXPECT_THAT(judge(n, ws, more, limit), ::testing::Not(::testing::Contains(id)));
        EXPECT_THAT(judge(n, ws, more, limit + beyond), ::testing::Contains(id));
      }
    }
  }
}

TEST(PortATiming, EachRowOfOneCyclePassesAtItsLimitAndFailsOneFemtosecondBeyond) {
  BRICK_COVERS("CARD-5");
  for (const RowCase& test : cases_of_one_cycle())
    at_and_beyond_the_limit(test.number, [&](unsigned n, unsigned ws, unsigned more, TimeFs time) {
      PortATiming timing;
      PinCycle c = easy(test.write, n, ws, more);
      test.measure(c, time);
      timing.cycle(c);
      return violated(timing);
    });
}

TEST(PortATiming, RowsBetweenCyclesPassAtTheirLimitAndFailOneFemtosecondBeyond) {
  BRICK_COVERS("CARD-5");
  struct Case {
    unsigned number;
    bool first_writes, second_writes;
  };
  for (const Case& test : {Case{112, false, true}, Case{113, false, false}, Case{114, true, true}})
    at_and_beyond_the_limit(test.number, [&](unsigned n, unsigned ws, unsigned, TimeFs time) {
      PortATiming timing;
      const PinCycle first = easy(test.first_writes, n, ws, 0);
      timing.cycle(first);
      PinCycle second = easy(test.second_writes, n, ws, 0, first.end);
      (test.number == 112 ? second.data_on : second.strobe_low) = first.strobe_high + time;
      timing.cycle(second);
      return violated(timing);
    });
}

// Set-up of /TA counts only where wrong data come of it: the word was not there yet.
TEST(PortATiming, TaSetUpPassesAtItsLimitAndFailsOneFemtosecondBeyondWithWrongData) {
  BRICK_COVERS("CARD-5");
  for (const bool corrupted : {true, false})
    for (const unsigned n : kMultipliers)
      for (const unsigned ws : kWaitStates)
        for (const TimeFs less : {0, 1}) {
          if (n >= 16 && ws == 1) continue;  // rule f
          PortATiming timing;
          PinCycle c = easy(false, n, ws, 2);
          c.ta_moved = c.strobe_high - row(118, ws, 2)->fs(n) + less;
          c.corrupted = corrupted;
          timing.cycle(c);
          EXPECT_EQ(violated(timing),
                    less == 1 && corrupted ? std::vector<std::string>{"118"} : std::vector<std::string>{});
        }
}

// The device took its answer back before the strobe rose: no hold.
TEST(PortATiming, TaThatRisesBeforeTheStrobeDoesIsAHoldViolation) {
  PortATiming timing;
  PinCycle c = easy(true, 8, 3, 0);
  c.ta_moved = c.strobe_high - 1;
  c.ta_high = true;
  timing.cycle(c);
  EXPECT_THAT(violated(timing), ::testing::ElementsAre("119"));
}

TEST(PortATiming, TaMovesAreCountedAndNoViolationByThemselves) {
  PortATiming timing;
  PinCycle c;
  for (unsigned i = 0; i < 2; ++i) {
    c = easy(true, 8, 3, 1, c.end + 1000 * kFsPerNs);
    c.ta_moved = c.strobe_high - 1;
    c.ta_seen = 1;
    c.ta_missed = 2;
    timing.cycle(c);
  }
  EXPECT_THAT(violated(timing), ::testing::IsEmpty());
  EXPECT_EQ(timing.ta_moves().seen, 2u);
  EXPECT_EQ(timing.ta_moves().missed, 4u);
}

// host-bus:2.2: with different wait states the fewer count; with one wait state rows 112 to 114 do not exist.
TEST(PortATiming, BetweenCyclesOfTwoRegionsTheFewerWaitStatesCount) {
  for (const auto& [first_ws, second_ws, needs_ws] : {std::array{15u, 3u, 3u}, {3u, 15u, 3u}, {7u, 31u, 7u}}) {
    for (const TimeFs less : {0, 1}) {
      PortATiming timing;
      const PinCycle first = easy(true, 16, first_ws, 0);
      timing.cycle(first);
      PinCycle second = easy(true, 16, second_ws, 0, first.end);
      second.strobe_low = first.strobe_high + row(114, needs_ws, 0)->fs(16) - less;
      timing.cycle(second);
      EXPECT_EQ(::testing::Matches(::testing::Contains("114"))(violated(timing)), less == 1);
    }
  }
}

constexpr TimeFs kPad = 8'477'105;  // one of 117.9648 MHz, in femtoseconds

// From the end of a read to the moment at which the next cycle drives D or lets it be driven, by its wait states:
// host-bus:2.2/2. Mixed forms leave what the rows of the two cycles make together.
struct Gap {
  TimeFs write, read;
};
Gap gap(unsigned n, unsigned first, unsigned next) {
  const auto sum = [n](std::initializer_list<std::pair<unsigned, unsigned>> rows) {
    TimeFs all = 0;
    for (const auto& [number, ws] : rows) all += row(number, ws, 0)->fs(n);
    return all;
  };
  // Row 110 has no form for one wait state: as for two.
  const unsigned fewer = std::min(first, next), drives = std::max(2u, next);
  Gap gap{sum({{117, first}, {101, next}, {110, drives}}), sum({{117, first}, {115, next}})};
  if (fewer > 1) {
    gap.write = std::max(gap.write, row(112, fewer, 0)->fs(n));
    gap.read = std::max(gap.read, row(113, fewer, 0)->fs(n));
  }
  return gap;
}

// host-bus:2.5: behind a read of the board its end of D, a pad late, comes before whoever drives next, at the wait
// states of host-bus:2.5 up to I52 = 15. Short are the two clocks of the table there, behind the dual-ported RAM, by no
// more than it says.
TEST(PortATiming, DIsOffBeforeWhoeverDrivesNext) {
  struct Areas {
    unsigned to, main, gate, ram, latch;
  };
  constexpr Areas kAreas[] = {{4, 1, 8, 4, 15}, {7, 1, 8, 3, 15}, {9, 1, 10, 4, 15}, {15, 2, 16, 7, 31}};
  for (unsigned i52 = 0; i52 <= 15; ++i52) {
    const Areas* a = kAreas;
    while (a->to < i52) ++a;
    for (const unsigned first : {a->gate, a->ram, a->latch})
      for (const unsigned next : {a->main, a->gate, a->ram, a->latch, 7u}) {
        const auto [write, read] = gap(i52 + 1, first, next);
        const bool is_short = i52 >= 14 && first == a->ram;
        const TimeFs by_read = !is_short ? 0 : (i52 == 14 ? 610 : 1360) * (kFsPerNs / 1000);
        const TimeFs by_write = !is_short || next > 2 ? 0 : (i52 == 14 ? 920 : 1880) * (kFsPerNs / 1000);
        EXPECT_GE(read, kPad - by_read) << "I52 = " << i52 << ", " << first << " and " << next << " wait states";
        EXPECT_GE(write, kPad - by_write) << "I52 = " << i52 << ", " << first << " and " << next << " wait states";
      }
  }
}

// host-bus:2.5: the clock up to which rows 112 and 113 leave a pad, and that the eighth wait state which the field of
// the RAM does not have would mend it at 14 and 15.
TEST(PortATiming, TheClocksUpToWhichDIsOffInTime) {
  constexpr unsigned kOneMore = 8;
  constexpr TimeFs kWord = 95'800'000;  // host-bus:2.6/4
  for (unsigned i52 = 0; i52 < 32; ++i52) {
    SCOPED_TRACE(::testing::Message() << "I52 = " << i52);
    const unsigned n = i52 + 1, main = i52 <= 9 ? 1 : i52 <= 15 ? 2 : i52 <= 23 ? 4 : 5;
    const unsigned gate = std::clamp(n, 8u, 31u), ram = i52 <= 4 ? 4 : i52 <= 7 ? 3 : i52 <= 9 ? 4 : 7;
    EXPECT_EQ(row(105, gate, 0)->fs(n) >= kWord, i52 <= 30);
    EXPECT_EQ(gap(n, gate, main).write >= kPad, i52 <= 19);
    EXPECT_EQ(gap(n, gate, ram).write >= kPad, i52 <= 19);
    EXPECT_EQ(gap(n, gate, gate).write >= kPad, i52 <= 25);
    const bool four = i52 == 16 || i52 == 17;  // the first of main memory's four
    EXPECT_EQ(gap(n, ram, main).write >= kPad, i52 <= 13 || four);
    for (const unsigned next : {main, ram, gate}) {
      EXPECT_EQ(gap(n, gate, next).read >= kPad, i52 <= 21);
      EXPECT_EQ(gap(n, ram, next).read >= kPad, i52 <= 13);
    }
    EXPECT_EQ(gap(n, kOneMore, main).read >= kPad, i52 <= 21);
  }
}

// host-bus:2.2/2: the shorter time is asked for, whichever of the two cycles had the faster clock.
TEST(PortATiming, BetweenCyclesOfTwoClocksTheFasterCounts) {
  for (const auto& [first_n, second_n] : {std::array{8u, 16u}, {16u, 8u}}) {
    for (const TimeFs less : {0, 1}) {
      PortATiming timing;
      const PinCycle first = easy(true, first_n, 15, 0);
      timing.cycle(first);
      PinCycle second = easy(true, second_n, 15, 0, first.end);
      second.strobe_low = first.strobe_high + row(114, 15, 0)->fs(16) - less;
      timing.cycle(second);
      EXPECT_EQ(::testing::Matches(::testing::Contains("114"))(violated(timing)), less == 1);
    }
  }
}

TEST(PortATiming, ConditionsOfTheStrobes) {
  for (const bool write : {true, false}) {
    PortATiming timing;
    PinCycle c = easy(write, 8, 7, 0);
    timing.cycle(c);
    EXPECT_THAT(violated(timing), ::testing::IsEmpty());
    c = easy(write, 8, 7, 0, c.end + 1000 * kFsPerNs);
    c.both_strobes = true;
    timing.cycle(c);
    EXPECT_THAT(violated(timing), ::testing::ElementsAre("a")) << write;
    c = easy(write, 8, 7, 0, c.end + 1000 * kFsPerNs);
    c.address_moved = true;
    timing.cycle(c);
    EXPECT_THAT(violated(timing), ::testing::ElementsAre("a", "b")) << write;
  }
}

// host-bus:2.6/6 to host-bus:2.6/8 and host-bus:6.9/8; periods of 39.3216 MHz and 117.9648 MHz, 1 ns for the flip-flop.
TEST(PortATiming, WhatTheBoardNeedsOfAWrite) {
  const auto periods = [](std::int64_t count, std::int64_t hz) { return count * 1'000'000'000'000'000 / hz; };
  struct Case {
    unsigned aa;
    TimeFs w1, w2;
  };
  const TimeFs pins = periods(1, 117'964'800);  // one may come so much later than another
  for (const Case& test : {Case{2, periods(1, 39'321'600) - kFsPerNs - pins, periods(2, 39'321'600) + kFsPerNs + pins},
                           {0, periods(1, 39'321'600) - kFsPerNs - pins, periods(2, 39'321'600) + kFsPerNs + pins},
                           {4, periods(2, 117'964'800) - kFsPerNs - pins, 0}}) {
    for (const TimeFs beyond : {0, 1}) {
      PortATiming timing;
      PinCycle c = easy(true, 32, 1, 0);
      c.aa = static_cast<std::uint8_t>(test.aa);
      if (test.w2 > 0) {  // the data may go before the address does
        PinCycle early = c;
        early.end = early.strobe_low + 2 * test.w2;
        early.data_held = early.strobe_low + test.w2 - beyond;
        PortATiming of_data;
        of_data.cycle(early);
        EXPECT_EQ(::testing::Matches(::testing::Contains("w2"))(violated(of_data)), beyond == 1) << "AA " << test.aa;
      }
      c.data_valid = c.strobe_low + test.w1 + beyond;
      c.end = c.strobe_low + (test.w2 > 0 ? test.w2 - beyond : 40 * kFsPerNs);  // of the RAM nothing is asked
      c.strobe_high = c.end - 10 * kFsPerNs;
      timing.cycle(c);
      const auto told = violated(timing);
      EXPECT_EQ(::testing::Matches(::testing::Contains("w1"))(told), beyond == 1) << "AA " << test.aa;
      EXPECT_EQ(::testing::Matches(::testing::Contains("w2"))(told), beyond == 1 && test.w2 > 0) << "AA " << test.aa;
    }
  }
}

TEST(PortATiming, AStrobeIsLowForTwoPeriodsOfTheReferenceClock) {
  const TimeFs least = 2 * 1'000'000'000'000'000 / 39'321'600 + kFsPerNs;
  for (const bool write : {true, false})
    for (const unsigned aa : {0u, 2u, 4u})
      for (const TimeFs less : {0, 1}) {
        PortATiming timing;
        PinCycle c = easy(write, 32, 1, 0);
        c.aa = static_cast<std::uint8_t>(aa);
        c.strobe_high = c.strobe_low + least - less;
        timing.cycle(c);
        EXPECT_EQ(::testing::Matches(::testing::Contains("s1"))(violated(timing)), less == 1 && aa != 4) << "AA " << aa;
      }
}

// host-bus:2.2: without a wait state rows 104 to 108, 115 and 116 have a form; 118 and 119 are of /TA, which is not
// looked at then (host-bus:2.1/3).
TEST(PortATiming, WithoutWaitStatesSevenRowsHaveAForm) {
  for (const bool write : {true, false}) {
    PortATiming timing;
    const PinCycle first = easy(write, 8, 0, 0);
    timing.cycle(first);
    timing.cycle(easy(write, 8, 0, 0, first.end));
    std::vector<std::string> rows;
    for (unsigned rule = PortATiming::k100; rule <= PortATiming::k119; ++rule)
      if (timing.ledger().row(rule, PortATiming::kGateIcs).evaluations > 0)
        rows.push_back(timing.ledger().rules()[rule].id);
    EXPECT_EQ(rows, write ? (std::vector<std::string>{"107", "108"})
                          : (std::vector<std::string>{"104", "105", "106", "115", "116"}));
  }
}

// host-bus:2.2/1, host-bus:2.2/4: a clock for which /TA may have been seen or not. The CPU need not add it; where it
// has, the data have it too.
TEST(PortATiming, AClockThatTaDidNotSurelyAskForIsThatOfTheDataAlone) {
  for (const unsigned number : {104u, 105u, 116u})
    for (const TimeFs beyond : {0, 1}) {
      PortATiming timing;
      PinCycle c = easy(false, 8, 3, 2);
      c.asked = 1;
      if (number == 116)
        c.strobe_low = c.strobe_high - row(116, 3, 1)->fs(8) + beyond;
      else
        c.data_valid = (number == 104 ? c.start : c.strobe_low) + row(number, 3, 2)->fs(8) + beyond;
      timing.cycle(c);
      EXPECT_EQ(::testing::Matches(::testing::Contains(std::to_string(number)))(violated(timing)), beyond == 1)
          << number;
    }
}

// Both drive D, by a femtosecond: the one that came later is told.
TEST(PortATiming, OneSideLetsGoBeforeTheOtherDrives) {
  for (const bool cpu_followed : {true, false})
    for (const TimeFs both : {0, 1}) {
      PortATiming timing;
      PinCycle c = easy(cpu_followed, 8, 7, 0);
      c.turnaround = -both;
      c.cpu_followed = cpu_followed;
      timing.cycle(c);
      EXPECT_EQ(violated(timing),
                both == 0 ? std::vector<std::string>{} : std::vector<std::string>{cpu_followed ? "c" : "d"});
    }
}

TEST(PortATiming, OneWaitStateIsLegalBelow150MHzOnly) {
  for (const unsigned n : {15u, 16u})  // 147.5, 157.3 MHz
    for (const unsigned ws : {1u, 2u}) {
      PortATiming timing;
      timing.cycle(easy(true, n, ws, 0));
      EXPECT_EQ(::testing::Matches(::testing::Contains("f"))(violated(timing)), n == 16 && ws == 1) << n << ", " << ws;
    }
}

TEST(TimingLedger, OneViolationForEachRuleAndAddressWithItsCount) {
  PortATiming timing;
  std::vector<std::uint32_t> told;
  timing.ledger().on_violation = [&](const TimingViolation& v) { told.push_back(v.where.address); };
  PinCycle c;
  for (const std::uint32_t address : {0x078000u, 0x078001u, 0x078000u}) {
    c = easy(false, 8, 7, 0, c.end + 1000 * kFsPerNs);
    c.address = address;
    c.data_lost = true;
    c.data_held = c.strobe_high - 5;
    timing.cycle(c);
  }
  EXPECT_THAT(told, ::testing::ElementsAre(0x078000u, 0x078001u));
  ASSERT_EQ(timing.ledger().violations().size(), 2u);
  EXPECT_EQ(timing.ledger().violations()[0].count, 2u);
  const TimingRow& row = timing.ledger().row(PortATiming::k106, PortATiming::kGateIcs);
  EXPECT_EQ(row.violations, 3u);
  EXPECT_EQ(row.margin, -5);
}

}  // namespace
}  // namespace brick
