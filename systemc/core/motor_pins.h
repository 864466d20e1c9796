// The motor side of a servo IC: the pins of its four channels, as every engine shows them. The packed words are the
// same in the Verilated RTL (rtl/board/board_sim.sv), the SystemC model and lock-step. As with the board's pins,
// outputs change only at a clock edge and inputs are sampled by the first clock edge after they were applied. A pin is
// a row of rtl/pins/servo_ic.pins. docs/servo_channel.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "rtl/pins/motor_pins.hpp"

namespace brick {

constexpr unsigned kMaxServoIcs = 18;  // that can be addressed: 0..9, then 2*..9*; index as in BoardInputs::fitted
constexpr unsigned kChannels = 4;      // of a servo IC

struct MotorInputs {
  std::array<std::uint16_t, kChannels> pins{kIdleChannelPins, kIdleChannelPins, kIdleChannelPins, kIdleChannelPins};
  std::uint8_t adc_a = 0;  // serial data into ADC A, bit n-1 = channel n
  std::uint8_t adc_b = 0;

  bool operator==(const MotorInputs& o) const { return pins == o.pins && adc_a == o.adc_a && adc_b == o.adc_b; }
  bool operator!=(const MotorInputs& o) const { return !(*this == o); }
};

// Output pins, packed. Word 0 changes on clk_pwm, word 1 on clk_ref and, by a serial clock of divider 0, on clk_pwm
// too; words 2..5 on clk_ref only. These are no pins: the counters of channels 1..4, shown so that a difference is
// found where it arises.
struct MotorOutputs {
  std::array<std::uint32_t, kMotorOutputWords> w{};

  // `channel` 0..3
  constexpr std::uint32_t get(const MotorField& f, unsigned channel) const {
    return w[word(f, channel)] >> lsb(f, channel) & mask(f);
  }
  constexpr void set(const MotorField& f, unsigned channel, std::uint32_t value) {
    std::uint32_t& word_of = w[word(f, channel)];
    word_of = (word_of & ~(mask(f) << lsb(f, channel))) | (value & mask(f)) << lsb(f, channel);
  }
  bool operator==(const MotorOutputs& o) const { return w == o.w; }
  bool operator!=(const MotorOutputs& o) const { return w != o.w; }
  MotorOutputs operator&(const MotorOutputs& o) const {
    MotorOutputs r;
    for (unsigned i = 0; i < kMotorOutputWords; ++i) r.w[i] = w[i] & o.w[i];
    return r;
  }
  MotorOutputs& operator|=(const MotorOutputs& o) {
    for (unsigned i = 0; i < kMotorOutputWords; ++i) w[i] |= o.w[i];
    return *this;
  }
  // True when any bit selected by `select` differs.
  bool differs(const MotorOutputs& o, const MotorOutputs& select) const {
    std::uint32_t d = 0;
    for (unsigned i = 0; i < kMotorOutputWords; ++i) d |= (w[i] ^ o.w[i]) & select.w[i];
    return d != 0;
  }

 private:
  static constexpr unsigned word(const MotorField& f, unsigned channel) {
    return f.stride == 0 && !f.shared ? f.word + channel : f.word;
  }
  static constexpr unsigned lsb(const MotorField& f, unsigned channel) { return f.lsb + f.stride * channel; }
  static constexpr std::uint32_t mask(const MotorField& f) { return (1u << f.width) - 1; }
};

constexpr MotorOutputs kAllMotorOutputs{{~0u, ~0u, ~0u, ~0u, ~0u, ~0u}};

// Scope of an IC in waveforms and scripts: servo_ic0 .. servo_ic9, and servo_ic2s .. servo_ic9s for 2* .. 9*.
inline std::string servo_ic_scope(unsigned ic) {
  return ic < 10 ? "servo_ic" + std::to_string(ic) : "servo_ic" + std::to_string(ic - 8) + "s";
}

}  // namespace brick
