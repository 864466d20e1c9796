// The motor side of a servo IC: the pins of its four channels, as every engine shows them. The packed words are the
// same in the Verilated RTL (rtl/board/board_sim.sv), the SystemC model and lock-step. As with the board's pins,
// outputs change only at a clock edge and inputs are sampled by the first clock edge after they were applied.
// docs/servo_channel.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace brick {

constexpr unsigned kMaxServoIcs = 18;  // that can be addressed: 0..9, then 2*..9*; index as in BoardInputs::fitted
constexpr unsigned kChannels = 4;      // of a servo IC

// Input pins of a channel, bits as in status word bits 23..12.
enum ChannelPin : unsigned { kEncA, kEncB, kEncC, kFault, kHmfl, kPlim, kMlim, kUser, kW, kV, kU, kT, kChannelPins };
constexpr std::array<std::string_view, kChannelPins> kChannelPinNames{
    "enc_a", "enc_b", "enc_c", "fault", "hmfl", "plim", "mlim", "user", "w", "v", "u", "t"};
// Nothing connected: T, U, V, W, USER and B are pulled up, the others show 0 (servo-ic:5.15/6).
constexpr std::uint16_t kIdleChannelPins = 1u << kT | 1u << kU | 1u << kV | 1u << kW | 1u << kUser | 1u << kEncB;

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
constexpr unsigned kMotorOutputWords = 6;

// A field that every channel has: channel n (0..3) has it at lsb + n * stride, or in word + n when the stride is 0.
struct MotorField {
  std::string_view name;  // of the signal, after "servo_icI.chN."
  unsigned word, lsb, width, stride;
  bool shared = false;  // one pin of the IC, shown under each of its channels
};

namespace motor_pin {
constexpr MotorField kPwmATop{"pwm_a_top", 0, 0, 1, 6}, kPwmABot{"pwm_a_bot", 0, 1, 1, 6},
    kPwmBTop{"pwm_b_top", 0, 2, 1, 6}, kPwmBBot{"pwm_b_bot", 0, 3, 1, 6}, kPwmCTop{"pwm_c_top", 0, 4, 1, 6},
    kPwmCBot{"pwm_c_bot", 0, 5, 1, 6}, kPfmPulse{"pfm_pulse", 0, 24, 1, 1}, kPfmDir{"pfm_dir", 0, 28, 1, 1},
    kDac{"dac", 1, 0, 1, 1},  // serial data of OUT A
    kDacB{"dac_b", 1, 4, 1, 1}, kAena{"aena", 1, 8, 1, 1}, kEqu{"equ", 1, 12, 1, 1},
    kDacClk{"dac_clk", 1, 16, 1, 0, true}, kDacStrobe{"dac_strobe", 1, 17, 1, 0, true},
    kAdcClk{"adc_clk", 1, 18, 1, 0, true}, kAdcStrobe{"adc_strobe", 1, 19, 1, 0, true}, kCount{"count", 2, 0, 24, 0};
inline constexpr std::array kAll{kPwmATop,  kPwmABot,   kPwmBTop, kPwmBBot,   kPwmCTop, kPwmCBot,
                                 kPfmPulse, kPfmDir,    kDac,     kDacB,      kAena,    kEqu,
                                 kDacClk,   kDacStrobe, kAdcClk,  kAdcStrobe, kCount};
}  // namespace motor_pin

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
