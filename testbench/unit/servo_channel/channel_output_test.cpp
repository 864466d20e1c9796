// Output side of a channel: PWM, PFM, serial DAC and ADC with their strobes, amplifier enable, registers.
#include <algorithm>
#include <array>
#include <map>

#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

TEST_F(ChannelTest, PwmOnTimeFollowsTheCommand) {
  rig_.write(ic_words::kPwmControl, pwm_control(6527, 0));  // no dead time: TOP is the raw comparison
  const std::map<int, Tick> expected{{0, 13057},    {100, 13257}, {-100, 12857}, {6528, 26113},
                                     {6529, 26114}, {-6529, 0},   {-6528, 1}};
  std::vector<int> commands;
  for (const auto& [command, high] : expected) commands.push_back(command);
  for (unsigned i = 0; i < commands.size(); ++i)
    rig_.write(false, base(i / 3 + 1) + 2 + i % 3, static_cast<std::uint32_t>(commands[i]) << 8 & 0xFFFFFF);
  rig_.ticks(2 * 26114);
  std::vector<Tick> high(commands.size()), low(commands.size());
  for (Tick t = 0; t < 26114; ++t) {
    rig_.tick();
    for (unsigned i = 0; i < commands.size(); ++i) {
      high[i] += rig_.pwm(i / 3 + 1, 2 * (i % 3));
      low[i] += rig_.pwm(i / 3 + 1, 2 * (i % 3) + 1);
    }
  }
  for (unsigned i = 0; i < commands.size(); ++i) {
    EXPECT_EQ(high[i], expected.at(commands[i])) << "command " << commands[i];
    EXPECT_EQ(low[i], 26114 - high[i]) << "command " << commands[i];
  }
}

TEST_F(ChannelTest, DeadTimeHoldsBothSwitchesOff) {
  rig_.write(ic_words::kPwmControl, pwm_control(6527, 15));
  rig_.ticks(3 * 26114);
  int gaps = 0;
  Tick off = 0;
  for (Tick t = 0; t < 2 * 26114; ++t) {
    rig_.tick();
    EXPECT_FALSE(rig_.pwm(1, kTopA) && rig_.pwm(1, kBottomA));
    if (!rig_.pwm(1, kTopA) && !rig_.pwm(1, kBottomA)) {
      ++off;
    } else if (off != 0) {
      if (gaps > 0 || off >= 240) { EXPECT_EQ(off, 240); }
      ++gaps;
      off = 0;
    }
  }
  EXPECT_EQ(gaps, 4) << "two a period";
}

TEST_F(ChannelTest, PulseShorterThanTheDeadTimeIsSwallowed) {
  rig_.write(ic_words::kPwmControl, pwm_control(6527, 15));
  rig_.write(1, words::kOutA,
             static_cast<std::uint32_t>(6527 - 100) << 8);  // low for 26114 - (2 * 6427 + 13057) = 203 < 240
  rig_.ticks(3 * 26114);
  for (Tick t = 0; t < 26114; ++t) {
    rig_.tick();
    ASSERT_FALSE(rig_.pwm(1, kBottomA));
  }
}

// The top switch of A, the bottom one of B and the top one of C are on, those beside them off.
TEST_F(ChannelTest, InversionTurnsBothSwitchesRound) {
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 0));
  rig_.write(1, words::kOutA, 0x7FFF00);
  rig_.write(1, words::kOutB, 0x800000);
  rig_.write(1, words::kOutC, 0x7FFF00);
  rig_.ticks(4 * kPhase);
  constexpr unsigned kOn = 1u << kTopA | 1u << kBottomB | 1u << kTopC;
  for (const auto& [word, inverted] :
       {std::pair{0u, 0u}, {kInvertAb, 0x0Fu}, {kInvertC, 0x30u}, {kInvertAb | kInvertC, 0x3Fu}}) {
    control(1, word);
    EXPECT_EQ(rig_.pins().pwm & 0x3F, kOn ^ inverted) << std::hex << word;
  }
}

TEST_F(ChannelTest, PwmCommandIsUsedFromTheTurnaroundOn) {
  rig_.write(ic_words::kPwmControl, pwm_control(6527, 0));
  rig_.ticks(3 * 13057);
  wait_until([&] { return !rig_.pins().phase; });
  wait_until([&] { return rig_.pins().phase; });  // a turnaround; command 0's level changes half way to the next
  const Tick turn = rig_.now();
  const bool level = rig_.pwm(1, kTopA);
  rig_.ticks(2000);
  rig_.write(1, words::kOutA, level ? 0x800000 : 0x7FFF00);  // used at once, it would turn the level round
  while (rig_.now() < turn + 6500) {
    rig_.tick();
    ASSERT_EQ(rig_.pwm(1, kTopA), level);
  }
  while (rig_.now() < turn + 13057) rig_.tick();
  for (Tick t = 0; t < 26114; ++t) {
    rig_.tick();
    ASSERT_EQ(rig_.pwm(1, kTopA), !level) << "from the turnaround on";
  }
}

TEST_F(ChannelTest, PfmRateAndWidth) {
  control(2, kPfm);
  rig_.write(2, words::kOutC, 0x010000);
  auto rise = [&] {
    wait_until([&] { return !rig_.other(kPulse, 2); });
    wait_until([&] { return rig_.other(kPulse, 2); });
    return rig_.now();
  };
  const Tick first = rise();
  wait_until([&] { return !rig_.other(kPulse, 2); });
  EXPECT_EQ(rig_.now() - first, 15 * 12) << "I7m04 PFM_CLK wide";
  EXPECT_EQ(rise() - first, 256 * 12) << "38.4 kHz";
  EXPECT_FALSE(rig_.other(kDir, 2));
  rig_.write(2, words::kOutC, 0xFE0000);
  rise();
  const Tick down = rise();
  EXPECT_TRUE(rig_.other(kDir, 2));
  EXPECT_EQ(rise() - down, 128 * 12);
  control(2, kPfm | kInvertC);
  EXPECT_TRUE(rig_.other(kDir, 2)) << "that bit is PULSE's";
  control(2, kPfm | kInvertDir | kInvertC);
  EXPECT_FALSE(rig_.other(kDir, 2)) << "direction inverted";
  EXPECT_FALSE(rig_.other(kPulse, 2)) << "pulse inverted";
}

TEST_F(ChannelTest, PfmRateIsLimitedToAQuarterOfItsClock) {
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 1));
  control(1, kPfm);
  rig_.write(1, words::kOutC, 0x7FFFFF);
  rig_.ticks(100);
  int pulses = 0;
  bool last = rig_.other(kPulse, 1);
  for (Tick t = 0; t < 100 * 4 * 12; ++t) {
    rig_.tick();
    pulses += rig_.other(kPulse, 1) && !last;
    last = rig_.other(kPulse, 1);
  }
  EXPECT_EQ(pulses, 100);
}

class ChannelSerialTest : public ChannelTest {
 protected:
  static constexpr unsigned kDacClk = 1, kDacStrobe = 2, kAdcClk = 4, kAdcStrobe = 8;
  static constexpr Tick kPeriod = 13'057;  // of PHASE
  void SetUp() override {
    ChannelTest::SetUp();
    rig_.write(ic_words::kPwmControl, pwm_control(6527, 15));
    rig_.ticks(2 * 13057);
  }
  void wait_for_phase(bool level) {
    wait_until([&] { return rig_.pins().phase != level; });
    wait_until([&] { return rig_.pins().phase == level; });
  }
  // Levels of a pin at the 24 rising edges of a serial clock after PHASE rises.
  template <class Level>
  std::uint32_t receive(unsigned clock, Level level) {
    wait_for_phase(true);
    std::uint32_t word = 0;
    edges_ = 0;
    period_ = 0;
    high_ = 0;
    Tick last_edge = 0;
    bool last = false;
    for (Tick t = 0; t < 24 * (3 << 7) + 400; ++t) {
      rig_.tick();
      const bool now = (rig_.pins().serial & clock) != 0;
      high_ += now;
      if (now && !last) {
        if (edges_ > 0) period_ = rig_.now() - last_edge;
        last_edge = rig_.now();
        word = word << 1 | (level() ? 1u : 0u);
        ++edges_;
      }
      last = now;
    }
    return word;
  }
  // What the eight DACs have latched after `ticks`: how many words, how many of the last are not zero, when it came and
  // when the first came of which all were.
  struct Latched {
    unsigned words = 0, wrong = 8;
    Tick at = kNever, first_zero = kNever;
  };
  Latched latch_dacs(Tick ticks) {
    Latched dacs;
    std::array<std::uint32_t, 8> shift{};
    ChannelPins last = rig_.pins();
    for (Tick t = 0; t < ticks; ++t) {
      rig_.tick();
      const ChannelPins now = rig_.pins();
      if ((now.serial & ~last.serial & kDacClk) != 0)
        for (unsigned i = 0; i < 8; ++i)
          shift[i] = shift[i] << 1 | (rig_.other(i < 4 ? kDacA : kDacB, i % 4 + 1) ? 1 : 0);
      if ((last.serial & ~now.serial & kDacStrobe) != 0) {
        ++dacs.words;
        dacs.at = rig_.now();
        dacs.wrong = 0;
        for (const std::uint32_t word : shift) dacs.wrong += (word & 0x3FFFF) != 0;
        if (dacs.wrong == 0) dacs.first_zero = std::min(dacs.first_zero, dacs.at);
      }
      last = now;
    }
    return dacs;
  }
  int edges_ = 0;
  Tick period_ = 0, high_ = 0;  // ticks between two rises, and high in all
};

TEST_F(ChannelSerialTest, StrobeWordsAppearBitByBitAndKeepTheLast) {
  rig_.write(ic_words::kAdcStrobe, 0xF84DFE);
  EXPECT_EQ(receive(kAdcClk, [&] { return (rig_.pins().serial & kAdcStrobe) != 0; }), 0xF84DFEu);
  EXPECT_EQ(edges_, 24);
  EXPECT_EQ(period_, 48);
  EXPECT_EQ(rig_.pins().serial & kAdcStrobe, 0u);
  EXPECT_EQ(receive(kDacClk, [&] { return (rig_.pins().serial & kDacStrobe) != 0; }), 0x7FFFC0u);
  EXPECT_EQ(edges_, 24);
  EXPECT_EQ(period_, 24);
  rig_.write(ic_words::kDacStrobe, 0x000001);
  receive(kDacClk, [] { return false; });
  EXPECT_NE(rig_.pins().serial & kDacStrobe, 0u) << "the last bit is held";
}

// Strobe and data change when the clock falls, or with the first bit, and stand when it rises; a new rise of PHASE
// starts over, here before the word is out.
TEST_F(ChannelSerialTest, BitsChangeAsTheClockFallsAndPhaseStartsOver) {
  control(1, kDac);
  rig_.write(1, words::kOutA, 0xAAAA80);
  rig_.write(ic_words::kDacStrobe, 0x555555);
  wait_for_phase(true);
  wait_for_phase(true);
  ChannelPins last = rig_.pins();
  for (Tick t = 0; t < 24 * 24; ++t) {
    rig_.tick();
    const ChannelPins now = rig_.pins();
    const bool rises = (now.serial & ~last.serial & kDacClk) != 0;
    EXPECT_FALSE(rises && (((now.serial ^ last.serial) & kDacStrobe) != 0 || now.others != last.others)) << t;
    last = now;
  }
  rig_.write(ic_words::kDacStrobe, 0x800000);  // the first bit alone
  rig_.write(ic_words::kPwmControl, pwm_control(kMaxCount, 15));
  rig_.ticks(3 * 13057);
  int starts = 0;
  bool high = true;
  for (Tick t = 0; t < 20 * kPhase; ++t) {
    rig_.tick();
    const bool now = (rig_.pins().serial & kDacStrobe) != 0;
    starts += now && !high;
    high = now;
  }
  EXPECT_EQ(starts, 20) << "a stream of 576 ticks each 203";
}

// 24 bits at n = 7 take 9216 of the 13057 ticks between two rises of PHASE. The clock is high for the second half of a
// bit, of one of three ticks for two (servo-ic:5.13/7).
TEST_F(ChannelSerialTest, DividersGiveEveryBitRate) {
  const auto high = [](unsigned n) { return n == 0 ? Tick{2} : (kTicksPerRef << n) / 2; };
  for (unsigned n = 0; n < 8; ++n) {
    rig_.write(ic_words::kClockControl, ic_words::clock_control::kAdcDivider.set(
                                            ic_words::clock_control::kDacDivider.set(kOwnClocks, n), 7 - n));
    wait_for_phase(true);
    wait_for_phase(true);
    EXPECT_EQ(receive(kDacClk, [&] { return (rig_.pins().serial & kDacStrobe) != 0; }), 0x7FFFC0u) << "n " << n;
    EXPECT_EQ(period_, 3 << n);
    EXPECT_EQ(edges_, 24) << "n " << n;
    EXPECT_EQ(high_, 24 * high(n)) << "n " << n;
    EXPECT_EQ(receive(kAdcClk, [&] { return (rig_.pins().serial & kAdcStrobe) != 0; }), 0xFFFFFEu) << "n " << n;
    EXPECT_EQ(period_, 3 << (7 - n));
    EXPECT_EQ(high_, 24 * high(7 - n)) << "n " << n;
    EXPECT_EQ(edges_, 24) << "n " << n;
  }
}

TEST_F(ChannelSerialTest, DacSendsEighteenBitsOfTheCommand) {
  control(3, kDac);
  rig_.write(3, words::kOutA, 0xA5C37F);
  rig_.write(3, words::kOutB, 0x5A3CBF);
  EXPECT_EQ(receive(kDacClk, [&] { return rig_.other(kDacA, 3); }), 0xA5C37Fu & 0xFFFFC0);
  EXPECT_EQ(receive(kDacClk, [&] { return rig_.other(kDacB, 3); }), 0x5A3CBFu & 0xFFFFC0);
  control(3, kDac | kInvertAb);
  EXPECT_EQ(receive(kDacClk, [&] { return rig_.other(kDacA, 3); }), ~(0xA5C37Fu & 0xFFFFC0) & 0xFFFFFF) << "inverted";
  EXPECT_EQ(receive(kDacClk, [&] { return rig_.other(kDacB, 3); }), ~(0x5A3CBFu & 0xFFFFC0) & 0xFFFFFF) << "inverted";
  EXPECT_EQ(rig_.pins().pwm >> 12 & 0xF, 0u) << "no PWM on a DAC channel";
  control(3, kDac);
  rig_.in.trip = true;
  EXPECT_EQ(receive(kDacClk, [&] { return rig_.other(kDacA, 3); }), 0u) << "0 after a watchdog trip";
}

// PHASE has stopped; the trip comes while a word is under way, or long after it, at several bit clocks. The word ends,
// then each DAC gets 18 zeros, at the latest 2 x 24 bits and what it takes to see the trip later, and nothing follows.
TEST_F(ChannelSerialTest, TripSendsAZeroWordWithoutPhase) {
  const std::uint32_t stopped = ic_words::kClockControl.reset;  // both clocks from outside
  for (const unsigned n : {0u, 1u, 3u, 7u})
    for (const bool idle : {false, true}) {
      rig_.in.trip = false;
      const auto dividers = [n](std::uint32_t w) { return ic_words::clock_control::kDacDivider.set(w, n); };
      rig_.write(ic_words::kClockControl, dividers(kOwnClocks));
      for (unsigned ch = 1; ch <= 4; ++ch) {
        control(ch, kDac);
        rig_.write(ch, words::kOutA, 0x555540 + (ch << 8));
        rig_.write(ch, words::kOutB, 0xAAAA80);
      }
      wait_for_phase(true);
      wait_for_phase(true);
      rig_.write(ic_words::kClockControl, dividers(stopped));
      const Tick bit = 3 << n;
      rig_.ticks(idle ? 30 * bit : 9 * bit);

      const Tick trip = rig_.now();
      rig_.in.trip = true;
      const Latched dacs = latch_dacs(80 * bit + 40);
      EXPECT_EQ(dacs.words, idle ? 1u : 2u) << "n " << n;
      EXPECT_EQ(dacs.wrong, 0u) << "DACs that are not zero, n " << n;
      EXPECT_LE(dacs.at - trip, 2 * 24 * bit + 6 * kTicksPerRef) << "n " << n;
      if (!idle) { EXPECT_GE(dacs.at - trip, (24 - 12 + 18) * bit) << "the rest of the word under way comes first"; }
    }
}

// What is written after the trip neither cuts that word nor takes away the edge that latches it: here PHASE would come
// every three ticks, and the strobe word be 0. The DACs' clock is the slowest: a word takes 9216 of the 10003 ticks
// between two rises of PHASE. 5001 ticks after the next of them, where that is at the bottom, PHASE is that fast: in
// the middle of the zeros.
TEST_F(ChannelSerialTest, NoWriteCutsTheZeroWordOfATrip) {
  const Tick bit = 3 << 7;
  for (const bool top : {false, true}) {
    rig_.in.trip = false;
    rig_.reset();
    rig_.write(ic_words::kClockControl, ic_words::clock_control::kDacDivider.set(kServoEachPhase, 7));
    rig_.write(ic_words::kPwmControl, pwm_control(5000, 15));
    for (unsigned ch = 1; ch <= 4; ++ch) {
      control(ch, kDac);
      rig_.write(ch, words::kOutA, 0x555540 + (ch << 8));
      rig_.write(ch, words::kOutB, 0xAAAA80);
    }
    for (int i = 0; i < (top ? 5 : 6); ++i) wait_for_phase(true);
    rig_.ticks(9 * bit);
    const Tick trip = rig_.now();
    rig_.in.trip = true;
    rig_.ref(2);
    rig_.write(ic_words::kPwmControl, pwm_control(0, 15));
    rig_.write(ic_words::kDacStrobe, 0);
    EXPECT_EQ(rig_.peek(true, ic_words::kDacStrobe.address), ic_words::kDacStrobe.reset);
    const Latched dacs = latch_dacs(80 * bit);
    EXPECT_GE(dacs.words, 2u);
    EXPECT_EQ(dacs.wrong, 0u) << "DACs that are not zero";
    EXPECT_LE(dacs.first_zero - trip, 2 * 24 * bit + 6 * kTicksPerRef);
    EXPECT_GE(dacs.first_zero - trip, (24 - 10 + 18) * bit) << "the rest of the word under way, 18 bits of the zeros";
  }
}

TEST_F(ChannelSerialTest, AdcKeepsEighteenBitsAfterTheHeader) {
  const std::uint32_t a = 0x2B5D3, b = 0x1A2C6;  // 18 bits each
  for (unsigned ch = 1; ch <= 4; ++ch) {
    wait_for_phase(true);
    unsigned bit = 0;
    bool last = false;
    const std::uint32_t before = rig_.peek(ch, words::kAdcA);
    // The converter shifts on the falling edge, so the next bit stands ready when the clock rises.
    for (const Tick end = rig_.now() + kPeriod; rig_.pins().phase && rig_.now() < end;) {
      const auto level = [&](std::uint32_t word) { return bit < 4 || bit > 21 ? bit % 2 : word >> (21 - bit) & 1; };
      rig_.in.adc_a = level(a) << (ch - 1);
      rig_.in.adc_b = level(b) << (ch - 1);
      rig_.tick();
      const bool now = (rig_.pins().serial & kAdcClk) != 0;
      if (last && !now) {
        ++bit;
        EXPECT_EQ(rig_.peek(ch, words::kAdcA), before) << "until PHASE falls, bit " << bit;
      }
      last = now;
    }
    EXPECT_EQ(bit, 24u);
    EXPECT_NE(before, a << 6);
    rig_.ref(2);
    EXPECT_EQ(rig_.peek(ch, words::kAdcA), a << 6) << "channel " << ch;
    EXPECT_EQ(rig_.peek(ch, words::kAdcB), b << 6) << "channel " << ch;
  }
}

// servo-ic:5.14/2: a line that shows each bit for one tick alone, and its inverse else. The edge that finds the bit is
// the rise of ADC_CLK; at n = 0, where that comes a tick after the fall, it is the next fall, the end of the bit.
TEST_F(ChannelSerialTest, AdcTakesItsLineAtOneEdgeOfEachBit) {
  const std::uint32_t a = 0x2B5D3, b = 0x1A2C6;  // 18 bits each
  for (const unsigned n : {0u, 1u, 2u, 5u}) {
    rig_.write(ic_words::kClockControl, ic_words::clock_control::kAdcDivider.set(kOwnClocks, n));
    wait_for_phase(true);
    wait_for_phase(true);
    const Tick bit = 3 << n;
    Tick first = kNever;  // edge that takes the first bit, which is dropped
    bool last = false;
    for (const Tick end = rig_.now() + kPeriod; rig_.pins().phase && rig_.now() < end;) {
      const Tick behind = first == kNever ? 1 : rig_.now() + 1 - first, place = behind / bit;
      const auto level = [&](std::uint32_t word) {
        const std::uint32_t right = place < 4 || place > 21 ? 0 : word >> (21 - place) & 1;
        return behind % bit == 0 ? right : right ^ 1;
      };
      rig_.in.adc_a = level(a);
      rig_.in.adc_b = level(b);
      rig_.tick();
      const bool now = (rig_.pins().serial & kAdcClk) != 0;
      if (first == kNever && (n == 0 ? last && !now : now && !last)) first = rig_.now();
      last = now;
    }
    rig_.ref(2);
    EXPECT_EQ(rig_.peek(1, words::kAdcA), a << 6) << "n " << n;
    EXPECT_EQ(rig_.peek(1, words::kAdcB), b << 6) << "n " << n;
  }
}

// The streams begin with a rise of PHASE: a fall that comes before the first one, behind a reset in the middle of a
// stream of ones, finds no bit of any.
TEST_F(ChannelSerialTest, AdcWordsAreEmptyUntilAStreamHasCome) {
  rig_.in.adc_a = rig_.in.adc_b = 0xF;
  wait_for_phase(false);
  wait_for_phase(true);
  rig_.ticks(12 * 48);  // ADC_CLK has 48 ticks
  rig_.reset();
  rig_.ticks(1000);
  rig_.in.phase = false;
  rig_.ticks(kHold);
  for (unsigned ch = 1; ch <= 4; ++ch) {
    EXPECT_EQ(rig_.peek(ch, words::kAdcA), 0u) << "channel " << ch;
    EXPECT_EQ(rig_.peek(ch, words::kAdcB), 0u) << "channel " << ch;
  }
}

// What the written words hold, bit by bit, is in unit_register_bits. Here every other word is made to hold something,
// the clocks are taken away so that it stays, and nothing that is written to it or beside it may show.
TEST_F(ChannelTest, WritesOfReadOnlyWordsChangeNothing) {
  const regs::Register read_only[] = {words::kPhasePosition, words::kServoPosition, words::kFlagPosition,
                                      words::kTimer1,        words::kTimer2,        words::kAdcA,
                                      words::kAdcB};
  rig_.in.adc_a = rig_.in.adc_b = 0xF;
  rig_.write(ic_words::kPwmControl, pwm_control(1000, 15));  // time for 24 bits in a half of PHASE
  for (unsigned ch = 1; ch <= 4; ++ch) {
    control(ch, kX4 | kFlag);
    steps(ch, 5, true);
    pin(ch, kHmfl, true);
    step(ch, false);
  }
  rig_.ticks(4 * 2003);
  rig_.write(ic_words::kClockControl, ic_words::kClockControl.reset);  // both clocks are inputs
  rig_.ticks(3 * 2003);
  for (unsigned ch = 1; ch <= 4; ++ch) {
    for (const regs::Register& word : read_only) {
      const std::uint32_t held = rig_.peek(ch, word);
      EXPECT_NE(held, 0u) << word.name;
      for (unsigned bit = 0; bit < 24; ++bit) {
        rig_.write(ch, word, 1u << bit);
        rig_.ref();
        EXPECT_EQ(rig_.peek(ch, word), held) << word.name << ", bit " << bit << " written";
      }
      rig_.write(ch, word, ~held & 0xFFFFFF);
      EXPECT_EQ(rig_.peek(ch, word), held) << word.name;
    }
    EXPECT_TRUE(status(ch, status_bit::kCaptured)) << "writing is not reading";
  }
}

// T, U, V, W (bits 23 to 20), USER (19) and B (13) are pulled up.
TEST(ChannelReset, OpenInputsReadAsTheirPullUps) {
  ChannelsRig rig;
  rig.reset();
  rig.in.pins.fill(kIdleChannelPins);
  rig.ticks(200);
  EXPECT_EQ(rig.peek(1, words::kStatus) & 0xFFF000, 0xF8A000u);
  EXPECT_EQ(rig.difference, "");
}

TEST(ChannelReset, WordsHaveTheValuesOfTheMap) {
  ChannelsRig rig;
  rig.reset();
  for (unsigned ch = 1; ch <= 4; ++ch) {
    for (unsigned offset = 0; offset < 8; ++offset) {
      EXPECT_EQ(rig.peek(false, base(ch) + offset), 0u) << "Y" << offset;
      if (offset == 4) continue;
      EXPECT_EQ(rig.peek(true, base(ch) + offset), offset == 0 ? 8u : 0u) << "X" << offset;
    }
  }
  EXPECT_EQ(rig.pins().pwm, 0u) << "all switches off";
  EXPECT_EQ(rig.difference, "");
}

}  // namespace
}  // namespace brick
