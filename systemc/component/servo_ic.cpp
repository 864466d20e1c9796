// Pins of the servo IC's component. Inputs: word n - 1 has those of channel n, word 4 those of the whole IC; outputs:
// words 0 and 1 as core/motor_pins.h has them, word 2 PHASE and SERVO.
#include <brick/servo_ic.h>

#include <utility>

#include "systemc/component/chip.h"
#include "systemc/component/servo_ic_pins.h"
#include "systemc/component/servo_ic_words.h"
#include "systemc/core/motor_pins.h"

namespace brick::component {
namespace {

struct ChannelInput {
  const char* meaning;
  const char* section;
};
constexpr std::array<ChannelInput, kChannelPins> kChannelInputs{{{"encoder A, or pulse and direction", "servo-ic:5.4"},
                                                                 {"encoder B; pulled up", "servo-ic:5.4"},
                                                                 {"encoder index", "servo-ic:5.8"},
                                                                 {"fault of the amplifier", "servo-ic:5.15"},
                                                                 {"home flag", "servo-ic:5.15"},
                                                                 {"positive end switch", "servo-ic:5.15"},
                                                                 {"negative end switch", "servo-ic:5.15"},
                                                                 {"user flag; pulled up", "servo-ic:5.15"},
                                                                 {"hall sensor W; pulled up", "servo-ic:5.15"},
                                                                 {"hall sensor V; pulled up", "servo-ic:5.15"},
                                                                 {"hall sensor U; pulled up", "servo-ic:5.15"},
                                                                 {"flag T; pulled up", "servo-ic:5.15"}}};

struct Output {
  const MotorField& field;
  const char* meaning;
  const char* section;
};
constexpr Output kChannelOutputs[] = {{motor_pin::kPwmATop, "PWM phase A, top switch", "servo-ic:5.11"},
                                      {motor_pin::kPwmABot, "PWM phase A, bottom switch", "servo-ic:5.11"},
                                      {motor_pin::kPwmBTop, "PWM phase B, top switch", "servo-ic:5.11"},
                                      {motor_pin::kPwmBBot, "PWM phase B, bottom switch", "servo-ic:5.11"},
                                      {motor_pin::kPwmCTop, "PWM phase C, top switch", "servo-ic:5.11"},
                                      {motor_pin::kPwmCBot, "PWM phase C, bottom switch", "servo-ic:5.11"},
                                      {motor_pin::kPfmPulse, "pulse", "servo-ic:5.12"},
                                      {motor_pin::kPfmDir, "direction of the pulses", "servo-ic:5.12"},
                                      {motor_pin::kDac, "serial data of OUT A", "servo-ic:5.13"},
                                      {motor_pin::kDacB, "serial data of OUT B", "servo-ic:5.13"},
                                      {motor_pin::kAena, "amplifier enable", "servo-ic:5.15"},
                                      {motor_pin::kEqu, "position compare", "servo-ic:5.10"}};
constexpr Output kSharedOutputs[] = {{motor_pin::kDacClk, "serial clock of the DACs", "servo-ic:5.13"},
                                     {motor_pin::kDacStrobe, "frame of the DACs", "servo-ic:5.13"},
                                     {motor_pin::kAdcClk, "serial clock of the ADCs", "servo-ic:5.14"},
                                     {motor_pin::kAdcStrobe, "frame of the ADCs", "servo-ic:5.14"}};

std::string channel_pin(unsigned number, std::string_view name) {
  return "ch" + std::to_string(number) + "_" + std::string(name);
}

std::vector<PinInfo> make_table() {
  using namespace servo_ic_words;
  constexpr PinDirection kIn = PinDirection::kIn, kOut = PinDirection::kOut;
  std::vector<PinInfo> table{
      {"rst_n", kIn, kControl, kRstN, 1, 1, "servo-ic:2.6", "reset, asynchronous, active low"},
      {"trip", kIn, kControl, kTrip, 1, 0, "servo-ic:10", "of the watchdog: the outputs of all channels go off"},
      {"phase_i", kIn, kControl, kPhaseIn, 1, 1, "servo-ic:5.1", "PHASE net"},
      {"servo_i", kIn, kControl, kServoIn, 1, 1, "servo-ic:5.1", "SERVO net"},
      {"phase_o", kOut, kClocks, kPhase, 1, 0, "servo-ic:5.1", "PHASE as the IC drives it, high while it does not"},
      {"phase_oe", kOut, kClocks, kPhaseOe, 1, 0, "servo-ic:5.1", "the IC drives PHASE"},
      {"servo_o", kOut, kClocks, kServo, 1, 0, "servo-ic:5.1", "SERVO as the IC drives it, high while it does not"},
      {"servo_oe", kOut, kClocks, kServoOe, 1, 0, "servo-ic:5.1", "the IC drives SERVO"}};
  add_motor_pins(table, "", 0, 0);
  return table;
}

}  // namespace

void add_motor_pins(std::vector<PinInfo>& table, const std::string& prefix, unsigned input_word, unsigned output_word) {
  using namespace servo_ic_words;
  constexpr PinDirection kIn = PinDirection::kIn, kOut = PinDirection::kOut;
  for (const Output& o : kSharedOutputs)
    table.push_back({prefix + std::string(o.field.name), kOut, output_word + o.field.word, o.field.lsb, 1, 0, o.section,
                     o.meaning});
  for (unsigned n = 1; n <= kChannels; ++n) {
    for (unsigned pin = 0; pin < kChannelPins; ++pin)
      table.push_back({prefix + channel_pin(n, kChannelPinNames[pin]), kIn, input_word + n - 1, pin, 1,
                       kIdleChannelPins >> pin & 1u, kChannelInputs[pin].section, kChannelInputs[pin].meaning});
    table.push_back({prefix + channel_pin(n, "adc_a"), kIn, input_word + n - 1, kAdcA, 1, 0, "servo-ic:5.14",
                     "serial data of ADC A"});
    table.push_back({prefix + channel_pin(n, "adc_b"), kIn, input_word + n - 1, kAdcB, 1, 0, "servo-ic:5.14",
                     "serial data of ADC B"});
    for (const Output& o : kChannelOutputs)
      table.push_back({prefix + channel_pin(n, o.field.name), kOut, output_word + o.field.word,
                       o.field.lsb + (n - 1) * o.field.stride, 1, 0, o.section, o.meaning});
  }
}

const std::vector<PinInfo>& ServoIc::pin_table() {
  static const std::vector<PinInfo> table = make_table();
  return table;
}

ServoIcChannel::ServoIcChannel(Component& ic, unsigned n, const std::string& prefix)
    : enc_a(ic, prefix + channel_pin(n, "enc_a")),
      enc_b(ic, prefix + channel_pin(n, "enc_b")),
      enc_c(ic, prefix + channel_pin(n, "enc_c")),
      fault(ic, prefix + channel_pin(n, "fault")),
      hmfl(ic, prefix + channel_pin(n, "hmfl")),
      plim(ic, prefix + channel_pin(n, "plim")),
      mlim(ic, prefix + channel_pin(n, "mlim")),
      user(ic, prefix + channel_pin(n, "user")),
      w(ic, prefix + channel_pin(n, "w")),
      v(ic, prefix + channel_pin(n, "v")),
      u(ic, prefix + channel_pin(n, "u")),
      t(ic, prefix + channel_pin(n, "t")),
      adc_a(ic, prefix + channel_pin(n, "adc_a")),
      adc_b(ic, prefix + channel_pin(n, "adc_b")),
      pwm_a_top(ic, prefix + channel_pin(n, "pwm_a_top")),
      pwm_a_bot(ic, prefix + channel_pin(n, "pwm_a_bot")),
      pwm_b_top(ic, prefix + channel_pin(n, "pwm_b_top")),
      pwm_b_bot(ic, prefix + channel_pin(n, "pwm_b_bot")),
      pwm_c_top(ic, prefix + channel_pin(n, "pwm_c_top")),
      pwm_c_bot(ic, prefix + channel_pin(n, "pwm_c_bot")),
      pfm_pulse(ic, prefix + channel_pin(n, "pfm_pulse")),
      pfm_dir(ic, prefix + channel_pin(n, "pfm_dir")),
      dac(ic, prefix + channel_pin(n, "dac")),
      dac_b(ic, prefix + channel_pin(n, "dac_b")),
      aena(ic, prefix + channel_pin(n, "aena")),
      equ(ic, prefix + channel_pin(n, "equ")) {}

ServoIc::ServoIc(const sc_core::sc_module_name& name, TimeBase& time, const Engine& engine)
    : Component(name, time, pin_table(), {{4, 32 * 8}}),
      registers("registers"),
      rst_n(*this, "rst_n"),
      trip(*this, "trip"),
      phase_i(*this, "phase_i"),
      servo_i(*this, "servo_i"),
      phase_o(*this, "phase_o"),
      phase_oe(*this, "phase_oe"),
      servo_o(*this, "servo_o"),
      servo_oe(*this, "servo_oe"),
      dac_clk(*this, "dac_clk"),
      dac_strobe(*this, "dac_strobe"),
      adc_clk(*this, "adc_clk"),
      adc_strobe(*this, "adc_strobe"),
      ch{ServoIcChannel{*this, 1}, ServoIcChannel{*this, 2}, ServoIcChannel{*this, 3}, ServoIcChannel{*this, 4}} {
  registers.register_b_transport(this, &ServoIc::transport);
  registers.register_transport_dbg(this, &ServoIc::debug);
  set_chip(engine.factory().servo_ic());
}

}  // namespace brick::component
