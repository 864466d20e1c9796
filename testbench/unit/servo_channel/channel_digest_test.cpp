// What the model of the channels tells of serial streams as words (systemc/core/motor_digest.h) is what its pins show
// edge by edge, at every tick and with all that may come in the middle of a stream.
#include <random>

#include "testbench/unit/random_seed.h"
#include "testbench/unit/servo_channel/channel_fixture.h"

namespace brick {
namespace {

class ChannelDigest : public ::testing::Test {
 protected:
  static constexpr unsigned kSlowest = 5, kLongCount = 700;
  static constexpr Tick kLongPhase = 2 * kLongCount + 3;  // the slowest stream is longer: it is cut
  static_assert(kLongPhase < Tick{kSerialBits} * (kTicksPerRef << kSlowest));

  void SetUp() override {
    for (ServoIc* ic : {&ic_, &by_pins_}) ic->reset(0);
    write(ic_words::kPwmControl, pwm_control(kLongCount, 1));
    divide(2, 2);
    run(2 * 13057);
  }
  std::uint32_t pick(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }
  void divide(unsigned dac, unsigned adc) {
    using namespace ic_words::clock_control;
    write(ic_words::kClockControl, kAdcDivider.set(kDacDivider.set(kOwnClocks, dac), adc));
  }
  // At the next edge of clk_ref.
  void write(const regs::Register& word, std::uint32_t value, unsigned channel = 1) {
    run(kTicksPerRef - 1 - now_ % kTicksPerRef);
    advance();
    for (ServoIc* ic : {&ic_, &by_pins_}) ic->write(word.space == 'X', base(channel) + word.address, value);
    look();
  }
  void run(Tick ticks) {
    for (; ticks > 0; --ticks) {
      advance();
      look();
    }
  }
  ChannelPins pins() const { return channel_pins(ic_); }
  virtual void look() = 0;

  // A word that is sent has its first bit in the present bit of the stream.
  void send(const ConverterWords& words) {
    ic_.send_adc(words);
    sent_ = words;
    sent_at_ = falls_;
  }
  unsigned level(unsigned line) const {
    const std::int64_t bit = falls_ - sent_at_;
    return bit < kSerialBits ? sent_[line] >> (23 - bit) & 1 : 0;
  }
  unsigned levels(bool b) const {
    unsigned all = 0;
    for (unsigned i = 0; i < kChannels; ++i) all |= level((b ? kChannels : 0) + i) << i;
    return all;
  }

  ServoIc ic_{sc_core::sc_gen_unique_name("ic")}, by_pins_{sc_core::sc_gen_unique_name("by_pins")};
  Tick now_ = 0;
  std::mt19937 random_{random_seed(1)};
  ConverterWords sent_{};
  std::int64_t sent_at_ = 0, falls_ = 0;  // of the ADCs' clock

 private:
  void advance() {
    MotorInputs in;
    in.adc_a = static_cast<std::uint8_t>(levels(false));
    in.adc_b = static_cast<std::uint8_t>(levels(true));
    by_pins_.set_motor_inputs(in);
    ++now_;
    for (ServoIc* ic : {&ic_, &by_pins_}) ic->advance(now_);
  }
};

class ChannelDacDigest : public ChannelDigest {
 protected:
  // A bit has been clocked from the tick behind the rise on.
  void look() override {
    const ChannelPins now = pins();
    for (unsigned i = 0; i < lines_.size(); ++i) {
      if (rose_) lines_[i] = (lines_[i] << 1 | level_[i]) & 0xFFFFFF;
      level_[i] = now.others >> (4 * (i < kChannels ? kDacA : kDacB) + i % kChannels) & 1;
    }
    const bool clock = (now.serial & 1) != 0;
    rose_ = clock && !clock_;
    clock_ = clock;
    if (ic_.channels().dac_lines() != lines_ && wrong_ == 0) wrong_ = now_;
    ones_ |= lines_[0];
  }
  ConverterWords lines_{}, level_{};
  bool rose_ = false, clock_ = false;
  Tick wrong_ = 0;
  std::uint32_t ones_ = 0;
};

// Words, modes, levels and the clock's number change at any tick of a bit; a trip sends zeros.
TEST_F(ChannelDacDigest, LinesAreTheLast24BitsAtRisesOfTheClock) {
  bool trip = false;
  for (unsigned channel = 1; channel <= kChannels; ++channel) write(words::kControl, kDac, channel);
  for (int round = 0; round < 250 && wrong_ == 0; ++round) {
    const unsigned channel = 1 + pick(kChannels);
    switch (pick(6)) {
      case 0:
        write(words::kControl, (pick(4) != 0 ? kDac : 0) | (pick(2) != 0 ? kInvertAb : 0), channel);
        break;
      case 1:
        divide(pick(kSlowest + 1), 2);
        break;
      case 2:
        if (pick(4) == 0) ic_.set_trip(trip = !trip);
        break;
      default:
        write(pick(2) != 0 ? words::kOutA : words::kOutB, pick(1u << 24), channel);
        break;
    }
    run(pick(2) != 0 ? pick(100) : pick(1500));
  }
  EXPECT_EQ(wrong_, 0) << "the first tick at which they are others";
  EXPECT_EQ(ones_, 0xFFFFFFu);
}

class ChannelAdcDigest : public ChannelDigest {
 protected:
  void look() override {
    const unsigned serial = pins().serial;
    const bool clock = (serial & 4) != 0, strobe = (serial & 8) != 0;
    const MotorDigest::AdcStream stream = ic_.channels().adc_stream();
    if (clock_ && !clock) ++falls_;
    if (stream.first) begin_ = falls_;
    const bool ends = clock_ && !clock && falls_ == begin_ + kSerialBits;
    if (ends) { EXPECT_EQ(now_, end_) << "of a stream"; }
    clock_ = clock;
    if (wrong_ == 0 && stream.clocks != falls_) wrong_ = now_;
    if (stream.first) { EXPECT_EQ((stream.strobe & 0x800000) != 0, strobe) << "tick " << now_; }
    if (falls_ >= begin_ + kSerialBits) return;  // no stream is under way
    end_ = stream.end;
    for (const bool b : {false, true})
      if (wrong_ == 0 && falls_ > 0 && ic_.channels().adc_lines(b) != levels(b)) wrong_ = now_;
  }
  bool clock_ = false;
  std::int64_t begin_ = -kSerialBits;
  Tick wrong_ = 0, end_ = 0;
};

// A word that is sent stands on the lines from the present bit on, its bit 23 first, then zeros: in the words of the
// ADCs, and on the lines, as if the pins had these levels. Streams are counted and end as they say.
TEST_F(ChannelAdcDigest, WordsAreLevelsOfTheLinesBitByBit) {
  unsigned others = 0;
  for (unsigned n = 0; n <= kSlowest; ++n) {
    divide(2, n);
    write(ic_words::kAdcStrobe, n % 2 != 0 ? 0xFFFFFE : 0x7FFFFE);
    run(2 * kLongPhase);
    for (int round = 0; round < 40; ++round) {
      ConverterWords sent;
      for (std::uint32_t& word : sent) word = pick(1u << 24);
      send(sent);
      run(pick(2) != 0 ? pick(30 * (kTicksPerRef << n)) : pick(2 * kLongPhase));
      for (unsigned channel = 1; channel <= kChannels; ++channel)
        for (const unsigned word : {regs::servo_channel::kAdcA.address, regs::servo_channel::kAdcB.address}) {
          ASSERT_EQ(ic_.read(false, base(channel) + word), by_pins_.read(false, base(channel) + word))
              << "n " << n << ", channel " << channel << ", tick " << now_;
          others += ic_.read(false, base(channel) + word) != 0;
        }
    }
  }
  EXPECT_EQ(wrong_, 0) << "the first tick at which it counts others, or the lines are";
  EXPECT_GT(others, 300u);
}

}  // namespace
}  // namespace brick
