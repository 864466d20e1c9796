// The lines of the serial streams at every tick: with which edge of the clock a bit changes, and what a reset leaves of
// a stream, what a new divider does to a bit (servo-ic:5/2, servo-ic:5.13/1, servo-ic:5.13/2, servo-ic:5.13/8).
#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

class ChannelSerialLineTest : public ChannelTest {
 protected:
  static constexpr unsigned kDacClk = 1, kDacStrobe = 2, kAdcClk = 4, kAdcStrobe = 8;
  // PHASE comes from the pin.
  void SetUp() override {
    ChannelTest::SetUp();
    divide(0);
    rig_.ticks(6 * kPhase);
  }
  void divide(unsigned n) {  // both serial clocks, by 2^n
    using namespace ic_words::clock_control;
    rig_.write(ic_words::kClockControl, kAdcDivider.set(kDacDivider.set(ic_words::kClockControl.reset, n), n));
  }
  void phase_rises() {
    rig_.in.phase = false;
    rig_.ticks(20);
    rig_.in.phase = true;
    rig_.ticks(2 * kTicksPerRef);  // behind the edge of clk_ref that sees it
  }
  unsigned serial() { return rig_.pins().serial; }
};

// Words of alternating bits: from the second bit on each begins with a fall of its clock, and with nothing else.
TEST_F(ChannelSerialLineTest, EachBitBeginsWithAFallOfItsClock) {
  constexpr std::uint32_t kWord = 0xAAAAAA;
  control(1, kDac);
  rig_.write(1, words::kOutA, kWord);
  rig_.write(1, words::kOutB, ~kWord & 0xFFFFFF);
  rig_.write(ic_words::kDacStrobe, ~kWord & 0xFFFFFF);
  rig_.write(ic_words::kAdcStrobe, kWord);
  for (unsigned n = 0; n < 8; ++n) {
    divide(n);
    rig_.ticks(kTicksPerRef << 7);
    phase_rises();
    rig_.ticks(2 * (kTicksPerRef << n));  // into the first bit, or the second
    std::array<int, 4> begun{};           // DAC strobe, DAC A, DAC B, ADC strobe
    ChannelPins last = rig_.pins();
    const auto lines = [](const ChannelPins& pins) {
      return std::array<bool, 4>{(pins.serial & kDacStrobe) != 0, (pins.others >> (4 * kDacA) & 1) != 0,
                                 (pins.others >> (4 * kDacB) & 1) != 0, (pins.serial & kAdcStrobe) != 0};
    };
    for (Tick t = 0; t < 25 * (kTicksPerRef << n); ++t) {
      rig_.tick();
      const ChannelPins now = rig_.pins();
      const unsigned falls = last.serial & ~now.serial;
      for (unsigned line = 0; line < 4; ++line) {
        if (lines(now)[line] == lines(last)[line]) continue;
        ++begun[line];
        EXPECT_NE(falls & (line == 3 ? kAdcClk : kDacClk), 0u) << "n " << n << ", line " << line << ", tick " << t;
      }
      last = now;
    }
    // 24 bits change 23 times, 18 of a DAC 17 times; one change or two have gone before.
    EXPECT_GE(begun[0], 21) << "n " << n;
    EXPECT_GE(begun[1], 15) << "n " << n;
    EXPECT_GE(begun[2], 15) << "n " << n;
    EXPECT_GE(begun[3], 21) << "n " << n;
  }
}

// Written just behind the fall that begins a bit: the rise in its middle and the fall at its end come as before, the
// next bit has the new length (servo-ic:5/2).
TEST_F(ChannelSerialLineTest, ANewNumberMovesNoEdgeOfTheBitUnderWay) {
  for (const unsigned clock : {kDacClk, kAdcClk})
    for (const unsigned before : {3u, 4u, 5u})
      for (const unsigned after : {1u, 2u, 6u, 7u}) {
        SCOPED_TRACE(::testing::Message() << "clock " << clock << ", " << before << " to " << after);
        const auto high = [&] { return (serial() & clock) != 0; };
        divide(before);
        rig_.ticks(kTicksPerRef << 7);
        phase_rises();
        wait_until(high);
        wait_until([&] { return !high(); });
        const Tick fall = rig_.now(), old = kTicksPerRef << before, fresh = kTicksPerRef << after;
        divide(after);
        wait_until(high);
        EXPECT_EQ(rig_.now() - fall, old / 2);
        wait_until([&] { return !high(); });
        EXPECT_EQ(rig_.now() - fall, old);
        wait_until(high);
        EXPECT_EQ(rig_.now() - fall, old + fresh / 2);
        wait_until([&] { return !high(); });
        EXPECT_EQ(rig_.now() - fall, old + fresh);
        rig_.ticks(25 * (kTicksPerRef << 7));  // to the end of the stream
      }
}

// A converter whose bits begin with the falls of the clock gives 18 bits behind four, whatever the clock's number is
// from one bit to the next (servo-ic:5/2, servo-ic:5.14/2).
TEST_F(ChannelSerialLineTest, AConversionGoesOnThroughANewNumber) {
  constexpr std::uint32_t kWord = 0x2B5D3, kStream = 0xA00000 | kWord << 2 | 1;
  for (const unsigned before : {3u, 4u, 5u})
    for (const unsigned after : {2u, 6u})
      for (const unsigned at : {2u, 7u, 8u, 19u}) {
        divide(before);
        rig_.in.phase = false;
        rig_.ticks(25 * (kTicksPerRef << 6));
        rig_.in.phase = true;
        bool last = false;
        for (unsigned bit = 0; bit < kSerialBits;) {
          rig_.in.adc_a = kStream >> (23 - bit) & 1;
          rig_.tick();
          const bool now = (serial() & kAdcClk) != 0;
          if (last && !now && ++bit == at) divide(after);
          last = now;
        }
        rig_.in.phase = false;
        rig_.ticks(20);
        EXPECT_EQ(rig_.peek(1, words::kAdcA), kWord << 6) << before << " to " << after << " in bit " << at;
      }
}

// A reset before the first bit of a stream, in the middle of one, or between a trip and its zeros: all four lines are
// low at once, and nothing moves until PHASE rises. One rise of PHASE more or less is nothing to that, nor a reset that
// is over before the next edge of clk_ref.
TEST_F(ChannelSerialLineTest, AResetEndsTheStreamsUntilPhaseRises) {
  struct Row {
    Tick ticks;  // behind a rise of PHASE
    bool trip;
  };
  constexpr Tick kBit = kTicksPerRef << 5;
  for (const Row& row : {Row{0, false}, Row{6 * kBit - 30, false}, Row{27 * kBit, true}})
    for (const Tick length : {1, 2, 4, 5}) {
      const bool more = length % 4 == 1;
      SCOPED_TRACE(::testing::Message() << row.ticks << " ticks, " << length);
      divide(5);
      control(1, kDac);
      rig_.write(1, words::kOutA, 0x7FFFC0);
      rig_.write(1, words::kOutB, 0xFFFFC0);
      rig_.write(ic_words::kDacStrobe, 0xFFFFFF);
      rig_.write(ic_words::kAdcStrobe, 0xFFFFFF);
      phase_rises();
      rig_.ticks(27 * kBit);
      if (more) phase_rises();
      phase_rises();
      rig_.ticks(row.ticks);
      rig_.in.trip = row.trip;
      if (row.trip) rig_.ref(2);
      EXPECT_NE(serial(), 0u) << "a strobe stands high";
      while (rig_.now() % kTicksPerRef != 0) rig_.tick();
      rig_.in.trip = false;
      rig_.in.rst_n = false;
      for (Tick t = 0; t < length; ++t) {
        rig_.tick();
        ASSERT_EQ(serial(), 0u) << "in the reset, tick " << t;
      }
      rig_.in.rst_n = true;
      control(1, kDac);
      for (Tick t = 0; t < 1500; ++t) {
        rig_.tick();
        ASSERT_EQ(serial(), 0u) << "tick " << t;
        ASSERT_FALSE(rig_.other(kDacA, 1)) << "tick " << t;
        ASSERT_FALSE(rig_.other(kDacB, 1)) << "tick " << t;
      }
      phase_rises();
      rig_.ticks(2 * 48 + 20);  // the reset value of ADC_CLK has 48 ticks a bit
      EXPECT_EQ(serial() & kAdcStrobe, kAdcStrobe) << "$FFFFFE";
      EXPECT_EQ(serial() & kDacStrobe, kDacStrobe) << "$7FFFC0, its second bit and those behind it";
    }
}

// A trip that the first edge behind a reset sees is one, though there was another before it: the DACs get their word
// (servo-ic:5.13/8, servo-ic:10/11).
TEST_F(ChannelSerialLineTest, ATripThatStandsBehindAResetSendsItsZeros) {
  for (const bool before : {false, true}) {
    rig_.in.trip = before;
    rig_.ref(2);
    rig_.in.trip = true;
    rig_.reset();
    int rises = 0, strobes = 0;
    unsigned last = 0;
    for (Tick t = 0; t < 30 * 24; ++t) {  // the reset value of DAC_CLK has 24 ticks a bit
      rig_.tick();
      rises += (serial() & ~last & kDacClk) != 0;
      strobes += (last & ~serial() & kDacStrobe) != 0;
      last = serial();
    }
    EXPECT_EQ(rises, 24) << before;
    EXPECT_EQ(strobes, 1) << before;
  }
}

}  // namespace
}  // namespace brick
