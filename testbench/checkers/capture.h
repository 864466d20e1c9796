// Index conditioning and position capture as rules (servo-ic:5.8/1, servo-ic:5.8/3, servo-ic:5.9/1 to servo-ic:5.9/7),
// one call an SCLK period with the filtered levels.
#pragma once

#include <cstdint>

#include "systemc/core/motor_pins.h"

namespace brick {

class Capture {
 public:
  unsigned code = 1;        // I7mn2
  unsigned flag = 0;        // I7mn3: HMFL, PLIM, MLIM, USER
  bool gated = false;       // I7mn4
  unsigned gate = 0;        // I7mn5: bit 0 A and B low, bit 1 de-multiplex
  bool level_rule = false;  // deliberately wrong rule: a condition that is true when the trigger is armed captures

  explicit Capture(std::uint16_t level) : last_(level) {}

  // `position` is the counter after a count in this period. True when it is captured.
  bool step(std::uint16_t level, std::uint32_t position);
  std::uint32_t read() {  // of X:+3
    armed_ = true;
    captured_ = gated_index_ = false;
    return position_;
  }

  bool captured() const { return captured_; }
  bool gated_index() const { return gated_index_; }
  std::uint32_t position() const { return position_; }
  unsigned hall() const { return hall_; }  // bit 0 W, 1 V, 2 U
  bool incomplete() const { return seen_ != 0xF; }
  // Status bits 23..12: C, U, V, W come from the index line while it is de-multiplexed.
  std::uint16_t shown(std::uint16_t level) const;

 private:
  static constexpr unsigned bit(unsigned level, unsigned pin) { return level >> pin & 1; }
  static constexpr unsigned state(unsigned level) { return bit(level, kEncA) << 1 | bit(level, kEncB); }
  constexpr unsigned parts(unsigned level) const {
    return (part_ & ~(1u << state(level))) | bit(level, kEncC) << state(level);
  }
  bool condition(std::uint16_t level) const;

  std::uint16_t last_;  // as shown
  unsigned seen_ = 0;   // AB states since reset, bit 2A + B
  unsigned part_ = 0;   // C line in each of them, at the last SCLK edge
  bool term_ = false, armed_ = true, captured_ = false, gated_index_ = false;
  std::uint32_t position_ = 0;
  unsigned hall_ = 0;
};

}  // namespace brick
