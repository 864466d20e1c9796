// The words that firmware writes to serial encoder inputs, as hardware takes them: servo-ic:11.3 (Brick), servo-ic:11.4
// (Geo PMAC). Models rtl/ssi/ssi_channel_regs.sv and the first lines of rtl/ssi/ssi_group.sv.
#pragma once

#include <algorithm>
#include <cstdint>

#include "rtl/regs/brick_regs.hpp"

namespace brick::ssi {

// Control word of a channel.
struct Control {
  bool geo;
  std::uint32_t word;

  bool enable() const { return geo ? (mode() & 2) != 0 : regs::ssi_brick::control::kTrigger.is_set(word); }
  bool single() const { return !geo && regs::ssi_brick::control::kOneShot.is_set(word); }
  bool driver() const { return geo || regs::ssi_brick::control::kDriver.is_set(word); }
  bool gray() const { return geo ? (mode() & 1) != 0 : regs::ssi_brick::control::kGray.is_set(word); }
  bool odd() const { return parity_code() == 1; }
  bool even() const { return parity_code() == 2; }
  bool parity() const { return odd() || even(); }
  unsigned bits() const {
    if (geo) return 12 + 4 * regs::ssi_geo::control::kLength.get(word);
    return std::clamp(regs::ssi_brick::control::kBits.get(word), 12u, 32u);
  }

 private:
  unsigned mode() const { return regs::ssi_geo::control::kMode.get(word); }
  unsigned parity_code() const { return geo ? 0 : regs::ssi_brick::control::kParity.get(word); }
};

// Word of a group.
struct Timing {
  bool geo;
  std::uint32_t word;

  bool on_servo() const { return geo || regs::ssi_brick::timing::kOnServo.is_set(word); }
  bool falling() const { return geo || regs::ssi_brick::timing::kFalling.is_set(word); }
  bool triggers() const { return geo || regs::ssi_brick::timing::kProtocol.get(word) == 2; }
  unsigned delay() const { return geo ? 0 : regs::ssi_brick::timing::kDelay.get(word); }
  // In ticks, on a Brick in cycles of 100 MHz.
  std::int64_t period() const {
    if (geo) return 768 >> regs::ssi_geo::timing::kRate.get(word);
    const std::int64_t divisor = regs::ssi_brick::timing::kDivisor.get(word);
    return std::max<std::int64_t>(25, (divisor + 1) << regs::ssi_brick::timing::kPower.get(word));
  }
  std::int64_t low_time() const { return period() / 2; }
  std::int64_t high_time() const { return period() - low_time(); }
  // Ticks in which so many have passed.
  std::int64_t ticks(std::int64_t cycles) const { return geo ? cycles : (cycles * 18432 + 15624) / 15625; }
};

}  // namespace brick::ssi
