// Serial ADCs at a servo IC: eight of them (A and B of four channels) on one clock and one strobe. The rising edge of
// the strobe starts a conversion; after a header of four bits 18 bits follow, first the highest. A bit stands on the
// line from the falling edge of the clock on, and the IC takes it at the rising edge (servo-ic:5.14). The strobe
// carries a command word (servo-ic:11.1) meanwhile.
#pragma once

#include <array>
#include <cstdint>

#include "systemc/core/motor_digest.h"
#include "systemc/core/motor_pins.h"
#include "systemc/core/ticks.h"

namespace brick::plant {

class AdcPeer {
 public:
  static constexpr unsigned kStreamBits = kSerialBits, kValueBits = 18;

  explicit AdcPeer(unsigned header = 4) : header_(header) {}

  struct Event {
    bool start = false;    // a conversion has begun: set the words of all inputs now
    bool command = false;  // command() is a new one
  };
  Event changed(Tick tick, const MotorOutputs& before, const MotorOutputs& after) {
    const bool clk = after.get(motor_pin::kAdcClk, 0) != 0, strobe = after.get(motor_pin::kAdcStrobe, 0) != 0;
    const bool clk_before = before.get(motor_pin::kAdcClk, 0) != 0,
               strobe_before = before.get(motor_pin::kAdcStrobe, 0) != 0;
    Event event;
    if (clk && !clk_before && bit_ < kStreamBits) shift_ = shift_ << 1 | static_cast<std::uint32_t>(strobe);
    if (!clk && clk_before && bit_ < kStreamBits && ++bit_ == kStreamBits) {
      command_ = shift_ & 0xFFFFFF;
      event.command = true;
    }
    // The command word makes the strobe rise within a stream, too. A stream that was broken off (reset) is over when
    // the clock has stood for longer than its longest period.
    const bool over = bit_ >= kStreamBits || tick - clk_edge_ > kLongestPeriod;
    if (strobe && !strobe_before && over) {
      bit_ = 0;
      shift_ = 0;
      clk_edge_ = tick;
      event.start = true;
    }
    if (clk != clk_before) clk_edge_ = tick;
    return event;
  }

  // What it must see: the strobe alone where the engine says what it carries (started()).
  static MotorOutputs watched(bool digest) {
    MotorOutputs watched;
    watched.set(motor_pin::kAdcStrobe, 0, 1);
    if (!digest) watched.set(motor_pin::kAdcClk, 0, 1);
    return watched;
  }
  static bool starts(const MotorOutputs& before, const MotorOutputs& after) {
    return before.get(motor_pin::kAdcStrobe, 0) == 0 && after.get(motor_pin::kAdcStrobe, 0) != 0;
  }
  // The strobe has risen in this stream: whether a conversion has begun. A command that it carries is a new one at
  // command_end(); a strobe word that begins with 0 carries none.
  bool started(const MotorDigest::AdcStream& stream) {
    if (stream.clocks - started_ < kStreamBits) return false;
    started_ = stream.clocks;
    if (stream.first) {
      next_command_ = stream.strobe;
      command_end_ = stream.end;
    }
    return true;
  }
  Tick command_end() const { return command_end_; }  // kNever: none is under way
  void take_command() {
    command_ = next_command_;
    command_end_ = kNever;
  }
  ConverterWords words() const {  // as send_adc() wants them
    ConverterWords words;
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = word_[i] << (kStreamBits - kValueBits - header_);
    return words;
  }

  // `channel` 0..3; ADC B when `b`; 18 bits.
  void set_word(unsigned channel, bool b, std::uint32_t word) { word_.at(b ? kChannels + channel : channel) = word; }

  // Data line of each channel, bit n.
  unsigned lines(bool b) const {
    unsigned lines = 0;
    const unsigned number = bit_ - header_;  // wraps to a large number within the header
    if (number < kValueBits)
      for (unsigned n = 0; n < kChannels; ++n)
        lines |= (word_[b ? kChannels + n : n] >> (kValueBits - 1 - number) & 1) << n;
    return lines;
  }
  std::uint32_t command() const { return command_; }

 private:
  static constexpr Tick kLongestPeriod = kTicksPerRef << 7;

  unsigned header_;
  unsigned bit_ = kStreamBits;  // on the lines now
  std::uint32_t shift_ = 0, command_ = 0;
  Tick clk_edge_ = -kNever;
  std::int64_t started_ = -std::int64_t{kStreamBits};  // falling clocks at the start of the last conversion
  std::uint32_t next_command_ = 0;
  Tick command_end_ = kNever;
  ConverterWords word_{};
};

}  // namespace brick::plant
