// A MACRO IC on one engine or on both: the rigs of the servo IC (same faces), and the kind as one more input.
#pragma once

#include "systemc/macro_ic/macro_ic.h"
#include "testbench/unit/macro_ic/rtl_macro_ic.h"
#include "testbench/unit/servo_ic/servo_ic_rig.h"

namespace brick {

// Offsets of the words that are built (servo-ic:6.2).
namespace macro {
constexpr unsigned kClock = 0x0C, kPwm = 0x0D, kAdcStrobe = 0x0E, kRing = 0x0F, kNodes = 0x0F, kJio = 0x00,
                   kMultiplexer = 0x02;
constexpr unsigned kSupplementary[] = {0x15, 0x1D};
}  // namespace macro

class RtlMacroRig : public RtlRigOf<RtlMacroIc> {
 public:
  void set_gate(bool gate) {
    ic().in.gate = gate;
    ic().settle();
  }
};

class ModelMacroRig : public ModelRigOf<MacroIc> {
 public:
  void set_gate(bool gate) {
    change([gate](MacroIc& ic) { ic.set_gate(gate); });
  }
};

class LockstepMacroRig : public LockstepRigOf<RtlMacroIc, MacroIc> {
 public:
  void set_gate(bool gate) {
    rtl().ic().in.gate = gate;
    rtl().ic().settle();
    model().change([gate](MacroIc& ic) { ic.set_gate(gate); });
  }
};

}  // namespace brick
