// The Verilated MACRO IC.
#pragma once

#include "testbench/unit/servo_ic/rtl_ic.h"

namespace brick {

struct MacroIcInputs {
  bool rst_n = true;
  bool gate = false;  // MACROGATE
  bool sel = false, x = false, we = false;
  unsigned addr = 0;
  std::uint32_t wdata = 0;
  bool phase = true, servo = true;
};

struct RtlMacroIc : RtlIc<MacroIcInputs> {
  RtlMacroIc();
};

}  // namespace brick
