// Model of rtl/servo_ic/channel_dac.sv and channel_adc.sv: serial data of one DAC, one ADC.
#pragma once

#include <algorithm>
#include <cstdint>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

class ChannelDac {
 public:
  void load(std::uint32_t command) { word_ = command >> 6 & 0x3FFFF; }
  std::uint32_t stream() const { return word_ << 6; }  // all 24 bits
  // `left`: bits of the 24 to go, the present one included; six 0s follow the command.
  bool data(unsigned left) const { return left >= 7 && (word_ >> (left - 7) & 1) != 0; }

 private:
  std::uint32_t word_ = 0;
};

constexpr unsigned kAdcLatency = 4;  // bits before the value: 0..6

template <unsigned Latency>
class BasicChannelAdc {
 public:
  // `count` bits of one level, the first of them number `bit` of the stream.
  void sample(unsigned bit, unsigned count, bool data) {
    const unsigned first = std::max(bit, Latency), end = std::min(bit + count, Latency + 18);
    if (first >= end) return;
    const unsigned n = end - first;
    word_ = (word_ << n | (data ? (1u << n) - 1 : 0)) & 0x3FFFF;
  }
  // The same where each bit has its level: that of number 0 is bit 23 of `stream`.
  void sample_stream(unsigned bit, unsigned count, std::uint32_t stream) {
    for (unsigned i = bit; i < bit + count; ++i) sample(i, 1, (stream << i & 0x800000) != 0);
  }
  void transfer() { value_ = word_; }
  std::uint32_t value() const { return kValue.at(value_); }  // the word; those of ADC A and ADC B are alike

 private:
  static constexpr regs::Field kValue = regs::servo_channel::adc_a::kValue;
  static_assert(kValue.mask() == regs::servo_channel::adc_b::kValue.mask());

  std::uint32_t word_ = 0, value_ = 0;
};
using ChannelAdc = BasicChannelAdc<kAdcLatency>;

}  // namespace brick
