// Servo IC (DSPGATE1): four motor channels, PHASE and SERVO. docs/servo_ic.md, data sheet servo-ic.
#pragma once

#include <array>

#include <tlm_utils/simple_target_socket.h>

#include <brick/component.h>

namespace brick::component {

struct ServoIcChannel {
  ServoIcChannel(Component& ic, unsigned number, const std::string& prefix = "");

  // Encoder with index, fault of the amplifier, home flag, end switches, user flag, hall sensors (servo-ic:5.15).
  // enc_b and user to t are pulled up: idle 1.
  In<> enc_a, enc_b, enc_c, fault, hmfl, plim, mlim, user, w, v, u, t;
  In<> adc_a, adc_b;  // serial data of the converters (servo-ic:5.14)
  // PWM of three phases, top and bottom switch (servo-ic:5.11).
  Out<> pwm_a_top, pwm_a_bot, pwm_b_top, pwm_b_bot, pwm_c_top, pwm_c_bot;
  Out<> pfm_pulse, pfm_dir;  // pulse and direction (servo-ic:5.12)
  Out<> dac, dac_b;          // serial data of OUT A and OUT B (servo-ic:5.13)
  Out<> aena, equ;           // amplifier enable; position compare (servo-ic:5.10)
};

class ServoIc final : public Component {
 public:
  ServoIc(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine = model_engine());

  // 32 words X and 32 Y of 24 bits, in the low bits of 4 bytes: X of offset n at 8 n + 4, Y at 8 n (servo-ic:2.1).
  tlm_utils::simple_target_socket_optional<ServoIc> registers;

  In<> rst_n;                                      // reset, asynchronous, idle 1; outputs follow with the next edge
  In<> trip;                                       // of the watchdog: all outputs of all channels go off (servo-ic:10)
  In<> phase_i, servo_i;                           // clock net, idle 1 (servo-ic:5.1)
  Out<> phase_o, phase_oe, servo_o, servo_oe;      // what it drives onto them, high while it does not; that it does
  Out<> dac_clk, dac_strobe, adc_clk, adc_strobe;  // shared by the channels; bound they cost most (docs/components.md)
  std::array<ServoIcChannel, 4> ch;                // ch[0] is channel 1

  static const std::vector<PinInfo>& pin_table();
};

}  // namespace brick::component
