// Serial DACs at a servo IC: eight of them (A and B of four channels) on one clock and one strobe. Data is taken with
// the rising edge of the clock; the falling edge of the strobe latches the last 16 or 18 bits (servo-ic:5.13). Full
// scale is 10 V.
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>

#include "systemc/core/motor_digest.h"
#include "systemc/core/motor_pins.h"

namespace brick::plant {

class DacPeer {
 public:
  explicit DacPeer(unsigned bits = 18) : bits_(bits) {
    if (bits != 16 && bits != 18) throw std::invalid_argument("DAC: 16 or 18 bits");
  }

  // What it must see: the strobe alone where the engine says what was on the lines (latch()).
  static MotorOutputs watched(bool digest) {
    MotorOutputs watched;
    watched.set(motor_pin::kDacStrobe, 0, 1);
    if (digest) return watched;
    watched.set(motor_pin::kDacClk, 0, 1);
    for (unsigned n = 0; n < kChannels; ++n) {
      watched.set(motor_pin::kDac, n, 1);
      watched.set(motor_pin::kDacB, n, 1);
    }
    return watched;
  }
  static bool latches(const MotorOutputs& before, const MotorOutputs& after) {
    return rises(motor_pin::kDacStrobe, after, before);
  }
  void latch(const ConverterWords& lines) {
    shift_ = lines;
    latch();
  }

  void changed(const MotorOutputs& before, const MotorOutputs& after) {
    if (before.w[1] == after.w[1]) return;
    if (rises(motor_pin::kDacClk, before, after)) {
      for (unsigned n = 0; n < kChannels; ++n) {
        shift_[n] = shift_[n] << 1 | after.get(motor_pin::kDac, n);
        shift_[kChannels + n] = shift_[kChannels + n] << 1 | after.get(motor_pin::kDacB, n);
      }
    }
    if (latches(before, after)) latch();
  }

  // `channel` 0..3; DAC B when `b`.
  std::int32_t value(unsigned channel, bool b = false) const { return value_.at(b ? kChannels + channel : channel); }
  double volts(unsigned channel, bool b = false) const { return 10.0 * value(channel, b) / (1 << (bits_ - 1)); }
  std::uint64_t updates() const { return updates_; }

 private:
  void latch() {
    for (std::size_t i = 0; i < shift_.size(); ++i) value_[i] = sign_extended(shift_[i]);
    ++updates_;
  }
  static bool rises(const MotorField& f, const MotorOutputs& before, const MotorOutputs& after) {
    return before.get(f, 0) == 0 && after.get(f, 0) != 0;
  }
  std::int32_t sign_extended(std::uint32_t word) const {
    const std::uint32_t sign = 1u << (bits_ - 1);
    return static_cast<std::int32_t>(word & (sign - 1)) - static_cast<std::int32_t>(word & sign);
  }

  unsigned bits_;
  ConverterWords shift_{};
  std::array<std::int32_t, 2 * kChannels> value_{};
  std::uint64_t updates_ = 0;
};

}  // namespace brick::plant
