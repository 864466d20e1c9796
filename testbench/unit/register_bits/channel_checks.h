// What the checks of a channel's words share: a control word with its settling, the status bits, the position, a
// capture.
#pragma once

#include "testbench/unit/register_bits/bits_rig.h"

namespace brick {

using Check = std::function<bool(BitsRig&, unsigned)>;

constexpr std::uint32_t kFar = 0x400000;  // a compare that is never reached

inline void control(BitsRig& rig, unsigned ch, std::uint32_t word) {
  rig.write(ch, words::kControl, word);
  rig.run(BitsRig::kHold);
}
inline bool status(BitsRig& rig, unsigned ch, const regs::Field& bit) {
  return bit.is_set(rig.peek(ch, words::kStatus));
}
inline std::uint32_t counter(BitsRig& rig, unsigned ch) {
  rig.latch();
  return rig.peek(ch, words::kPhasePosition);
}
inline bool equ(BitsRig& rig, unsigned ch) { return rig.other(kEqu, ch); }

// Arms the trigger, raises a pin and says whether that captured.
inline bool captures(BitsRig& rig, unsigned ch, std::uint32_t word, unsigned pin) {
  control(rig, ch, word);
  rig.read(ch, words::kFlagPosition);
  rig.run(BitsRig::kHold);
  rig.pin(ch, pin, true);
  return status(rig, ch, status_bit::kCaptured);
}

// Three counts with hardware 1/T, and the time to see that they were the last.
inline void creep(BitsRig& rig, unsigned ch, bool up) {
  rig.steps(ch, 3, up, 30);
  rig.run(300);  // more than the 10 SCLK periods between two counts and the 26 clk_ref of the division
}

}  // namespace brick
