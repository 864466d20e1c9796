// Servo IC (DSPGATE1): four motor channels, PHASE and SERVO. docs/servo_ic.md, data sheet servo-ic.
#pragma once

#include <array>

#include <tlm_utils/simple_target_socket.h>

#include <brick/component.h>
#include <brick/pins/servo_ic.h>

namespace brick::component {

// The serial clocks and strobes are shared by the channels; bound they cost most (docs/components.md).
class ServoIc final : public Component, public ServoIcPins, public ServoIcSerialPins {
 public:
  ServoIc(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine = model_engine());

  // 32 words X and 32 Y of 24 bits, in the low bits of 4 bytes: X of offset n at 8 n + 4, Y at 8 n (servo-ic:2.1).
  tlm_utils::simple_target_socket_optional<ServoIc> registers;

  std::array<ServoIcChannel, 4> ch;  // ch[0] is channel 1

  static const std::vector<PinInfo>& pin_table();
};

}  // namespace brick::component
