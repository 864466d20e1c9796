// The words and fields of a channel under short names, for tests: all from the generated map. Constants are bits of the
// control word, at their place.
#pragma once

#include <cstdint>

#include "rtl/regs/brick_regs.hpp"

namespace brick {

namespace words = regs::servo_channel;  // words::kStatus ...
namespace ic_words = regs::servo_ic;    // ic_words::kPwmControl ...
namespace status_bit = words::status;   // status_bit::kCaptured ...
namespace field = words::control;       // field::kDecode ...
namespace fine1 = regs::servo_channel_fine::timer1;
namespace fine2 = regs::servo_channel_fine::timer2;

constexpr std::uint32_t decode_mode(regs::decode::Code code) { return field::kDecode.at(code); }
constexpr std::uint32_t kX4 = decode_mode(regs::decode::kX4Cw);
constexpr std::uint32_t kIndex = field::kCaptureSource.at(regs::capture_source::kIndex),
                        kFlag = field::kCaptureSource.at(regs::capture_source::kFlag),
                        kIndexInvert = field::kIndexInvert.mask();
constexpr std::uint32_t kCounterReset = field::kCounterReset.mask(), kEquWrite = field::kEquWrite.mask(),
                        kEquState = field::kEquState.mask(), kFromChannel1 = field::kCompareChannel.mask(),
                        kEnable = field::kAena.mask();
constexpr std::uint32_t kGated = field::kGatedIndex.mask(), kGateLow = field::kGateState.mask(),
                        kDemux = field::kIndexDemux.mask(), kFine = field::kHardware1t.mask();
constexpr std::uint32_t kInvertDir = field::kPfmDirInvert.mask(), kInvertAb = field::kAbInvert.mask(),
                        kInvertC = field::kCInvert.mask(), kDac = field::kAbDac.mask(), kPfm = field::kCPfm.mask();

// The PWM control word.
constexpr std::uint32_t pwm_control(std::uint32_t max_count, std::uint32_t deadtime) {
  return ic_words::pwm_control::kMaxCount.at(max_count) | ic_words::pwm_control::kDeadtime.at(deadtime);
}

}  // namespace brick
