// The Verilated servo IC.
#pragma once

#include <array>

#include "testbench/unit/servo_ic/rtl_ic.h"

namespace brick {

struct ServoIcInputs {
  bool rst_n = true, trip = false, trip_d = false;
  bool sel = true, x = false, we = false, rd = false;
  unsigned addr = 0;
  std::uint32_t wdata = 0;
  bool phase = true, servo = true;
  std::array<unsigned, 4> pins{};  // of a channel, bits as status bits 23..12
  unsigned adc_a = 0, adc_b = 0;   // bit n-1: channel n
};

struct RtlServoIc : RtlIc<ServoIcInputs> {
  RtlServoIc();
};

}  // namespace brick
