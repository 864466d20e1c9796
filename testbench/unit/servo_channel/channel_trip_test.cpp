// After a trip of the watchdog: every output of every channel is off at the level that was off before, and stays so
// whatever is written (servo-ic:10/10). The DACs' word of zeros is in channel_output_test.cpp.
#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

class ChannelTripTest : public ChannelTest {
 protected:
  static constexpr std::uint32_t kOutputBits = kInvertAb | kInvertC | kDac | kPfm;
  static constexpr unsigned kPwmPins = 0x3F;

  void trip() {
    rig_.in.trip = true;
    rig_.ref(2);
  }
  unsigned switches(unsigned channel) { return rig_.pins().pwm >> 6 * (channel - 1) & kPwmPins; }
  // servo-ic:5.11/5, servo-ic:5.11/8, servo-ic:5.11/9: off is low, inverted high; what is no PWM output is low.
  static unsigned switches_off(std::uint32_t word) {
    const unsigned ab = (word & kDac) == 0 && (word & kInvertAb) != 0 ? 0x0F : 0;
    return ab | ((word & kPfm) == 0 && (word & kInvertC) != 0 ? 0x30 : 0);
  }
  // servo-ic:5.12/6, servo-ic:5.12/8
  static bool pulse_off(std::uint32_t word) { return (word & kPfm) != 0 && (word & kInvertC) != 0; }
  // All pins that must rest, for so long that the slowest of them would move.
  void expect_off(unsigned channel, std::uint32_t word, const std::string& when) {
    for (Tick t = 0; t < 3 * kPhase; ++t) {
      rig_.tick();
      ASSERT_EQ(switches(channel), switches_off(word)) << when << ", control " << std::hex << word;
      ASSERT_EQ(rig_.other(kPulse, channel), pulse_off(word)) << when << ", control " << std::hex << word;
      ASSERT_FALSE(rig_.other(kAena, channel)) << when;
      ASSERT_FALSE(rig_.other(kEqu, channel)) << when;
    }
  }
};

TEST_F(ChannelTripTest, TurnsEverythingOffAndOutputsIgnoreWrites) {
  control(1, kEnable | kEquState | kEquWrite);
  control(2, kPfm);
  rig_.write(2, words::kOutC, 0x400000);
  rig_.write(1, words::kOutA, 0x7FFF00);
  rig_.ticks(1000);
  EXPECT_TRUE(rig_.other(kAena, 1));
  EXPECT_TRUE(equ(1));
  EXPECT_TRUE(rig_.pwm(1, kTopA));
  EXPECT_TRUE(rig_.other(kPulse, 2)) << "pulses wider than their distance";
  trip();
  EXPECT_EQ(rig_.pins().pwm, 0u);
  EXPECT_EQ(rig_.pins().others & ~0xF0u, 0u) << "all but DIR, which rests";
  EXPECT_FALSE(status(1, status_bit::kEqu));
  for (const regs::Register& word : {words::kOutA, words::kOutB, words::kOutC}) {
    const std::uint32_t held = rig_.peek(1, word);
    rig_.write(1, word, 0x123456);
    EXPECT_EQ(rig_.peek(1, word), held) << word.name;
  }
  rig_.ticks(500);
  EXPECT_EQ(rig_.pins().pwm, 0u);
}

// Each of the 16 values at the trip, then each of the 16 written, in all four channels: neither a pin nor the word
// moves. The other bits of the word are still written; AENA and EQU stay off all the same.
TEST_F(ChannelTripTest, NoWriteTurnsOverWhatOffIs) {
  for (std::uint32_t kept = 0; kept < 16; ++kept) {
    rig_.in.trip = false;
    for (unsigned ch = 1; ch <= 4; ++ch) {
      control(ch, ((kept + ch) << 20 & kOutputBits) | kEnable | kX4);
      for (const regs::Register& word : {words::kOutA, words::kOutB, words::kOutC}) rig_.write(ch, word, 0x3FFF00);
    }
    rig_.ticks(2 * kPhase);
    trip();
    for (std::uint32_t written = 0; written < 16; ++written)
      for (unsigned ch = 1; ch <= 4; ++ch) {
        const std::uint32_t word = ((kept + ch) << 20 & kOutputBits),
                            others = kEnable | kEquState | (written % 2 ? kX4 : 0);
        control(ch, written << 20 | others | kEquWrite);
        rig_.ref();
        ASSERT_EQ(rig_.peek(ch, words::kControl), word | others) << "channel " << ch << ", written " << written;
        ASSERT_EQ(switches(ch), switches_off(word)) << "channel " << ch << ", kept " << kept << ", written " << written;
        ASSERT_EQ(rig_.other(kPulse, ch), pulse_off(word)) << "channel " << ch << ", written " << written;
      }
    for (unsigned ch = 1; ch <= 4; ++ch)
      expect_off(ch, (kept + ch) << 20 & kOutputBits, "channel " + std::to_string(ch));
  }
  rig_.in.trip = false;
  rig_.reset();
  control(1, kInvertAb);
  EXPECT_EQ(rig_.peek(1, words::kControl), kInvertAb) << "until a reset";
}

// A write at the very edge of the trip is the last that counts: the edge sees the trip one later.
TEST_F(ChannelTripTest, WriteAtTheEdgeOfTheTripIsTheLast) {
  control(1, 0);
  rig_.write(1, words::kControl, kInvertC);
  trip();
  EXPECT_EQ(switches(1), switches_off(kInvertC));
  control(1, kInvertAb);
  EXPECT_EQ(switches(1), switches_off(kInvertC));
}

// The data lines of a channel with DACs rest as the last bit of zeros leaves them: low, inverted high.
TEST_F(ChannelTripTest, DacLinesKeepTheirSense) {
  for (const std::uint32_t word : {kDac, kDac | kInvertAb}) {
    rig_.in.trip = false;
    rig_.reset();
    rig_.write(ic_words::kClockControl, kServoEachPhase);
    control(2, word);
    rig_.write(2, words::kOutA, 0x7FFFC0);
    rig_.write(2, words::kOutB, 0x555540);
    rig_.ticks(13057);
    trip();
    rig_.ticks(3 * 24 * 24);
    control(2, word ^ kInvertAb);
    for (Tick t = 0; t < 2 * 13057; ++t) {
      rig_.tick();
      ASSERT_EQ(rig_.other(kDacA, 2), (word & kInvertAb) != 0);
      ASSERT_EQ(rig_.other(kDacB, 2), (word & kInvertAb) != 0);
    }
    control(2, 0);
    rig_.ref();
    EXPECT_EQ(rig_.other(kDacA, 2), (word & kInvertAb) != 0) << "nor does it become a PWM channel";
    EXPECT_EQ(switches(2) & 0xFu, 0u);
  }
}

// DIR stands, whatever is written into bit 19, and at the level that it had at the trip.
TEST_F(ChannelTripTest, DirectionStands) {
  for (const std::uint32_t word : {kPfm, kPfm | kInvertDir}) {
    rig_.in.trip = false;
    rig_.reset();
    control(4, word);
    rig_.write(4, words::kOutC, 0xC00000);
    rig_.ticks(1000);
    const bool level = rig_.other(kDir, 4);
    EXPECT_EQ(level, (word & kInvertDir) == 0) << "downwards";
    trip();
    control(4, word ^ kInvertDir);
    EXPECT_EQ(rig_.peek(4, words::kControl), word);
    rig_.write(4, words::kOutC, 0x400000);
    rig_.ticks(1000);
    EXPECT_EQ(rig_.other(kDir, 4), level);
  }
}

// The ADC strobe commands amplifiers, the DAC strobe latches what DACs get: the words and what goes out stay.
TEST_F(ChannelTripTest, StrobesKeepTheirWords) {
  constexpr std::uint32_t kWord = 0xF84DFE;
  rig_.write(ic_words::kAdcStrobe, kWord);
  trip();
  rig_.write(ic_words::kAdcStrobe, 0xFC0DFE);
  rig_.write(ic_words::kDacStrobe, 0x7FFF00);
  EXPECT_EQ(rig_.peek(true, ic_words::kAdcStrobe.address), kWord);
  EXPECT_EQ(rig_.peek(true, ic_words::kDacStrobe.address), ic_words::kDacStrobe.reset);
  rig_.write(ic_words::kPwmControl, pwm_control(6527, 15));
  rig_.ticks(2 * 13057);
  wait_until([&] { return !rig_.pins().phase; });
  wait_until([&] { return rig_.pins().phase; });
  std::uint32_t sent = 0;
  int bits = 0;
  bool last = false;
  for (const Tick end = rig_.now() + 13'057; rig_.pins().phase && rig_.now() < end;) {  // a period of PHASE
    rig_.tick();
    const bool clock = (rig_.pins().serial & 4) != 0;
    if (clock && !last) {
      sent = sent << 1 | ((rig_.pins().serial & 8) != 0 ? 1u : 0u);
      ++bits;
    }
    last = clock;
  }
  EXPECT_EQ(bits, 24);
  EXPECT_EQ(sent, kWord);
  rig_.in.trip = false;
  rig_.reset();
  EXPECT_EQ(rig_.peek(true, ic_words::kAdcStrobe.address), ic_words::kAdcStrobe.reset);
  rig_.write(ic_words::kAdcStrobe, kWord);
  EXPECT_EQ(rig_.peek(true, ic_words::kAdcStrobe.address), kWord);
}

}  // namespace
}  // namespace brick
