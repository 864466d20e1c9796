// A servo IC seen from its channels, Verilated or model: levels of all input pins in, output pins and the word at the
// present address out.
#pragma once

#include <algorithm>
#include <memory>

#include "systemc/servo_ic/servo_ic.h"
#include "testbench/unit/servo_ic/rtl_servo_ic.h"

namespace brick {

struct ChannelPins {
  std::uint32_t pwm = 0;     // per channel C bottom .. A top
  std::uint32_t others = 0;  // EQU, AENA, DAC B, DAC A, DIR, PULSE
  unsigned serial = 0;       // ADC strobe, ADC clock, DAC strobe, DAC clock
  bool phase = true, servo = true;
  ChannelPins() = default;
  // `motor`: the first two words of MotorOutputs
  ChannelPins(std::uint64_t motor, bool phase_level, bool servo_level)
      : pwm(motor & 0xFFFFFF),
        others(motor >> 24 & 0xFFFFFF),
        serial(motor >> 48 & 0xF),
        phase(phase_level),
        servo(servo_level) {}
  bool operator==(const ChannelPins& o) const {
    return pwm == o.pwm && others == o.others && serial == o.serial && phase == o.phase && servo == o.servo;
  }
};

inline ChannelPins channel_pins(const RtlServoIc& ic) { return {ic.motor(), ic.phase(), ic.servo()}; }
inline ChannelPins channel_pins(const ServoIc& ic) {
  const MotorOutputs o = ic.motor_outputs();
  return {o.w[0] | std::uint64_t{o.w[1]} << 32, ic.phase(), ic.servo()};
}

// All input pins of the model.
inline void set_inputs(ServoIc& ic, const ServoIcInputs& in) {
  MotorInputs motor;
  for (unsigned i = 0; i < kChannels; ++i) motor.pins[i] = static_cast<std::uint16_t>(in.pins[i]);
  motor.adc_a = static_cast<std::uint8_t>(in.adc_a);
  motor.adc_b = static_cast<std::uint8_t>(in.adc_b);
  ic.set_motor_inputs(motor);
  ic.set_trip(in.trip);
  ic.set_pins(in.phase, in.servo);
}

class ChannelsEngine {
 public:
  virtual ~ChannelsEngine() = default;
  virtual void run(const ServoIcInputs& in, Tick end) = 0;  // the edges up to `end`
  virtual std::uint32_t word(const ServoIcInputs& in) = 0;  // at the address
  virtual ChannelPins pins() const = 0;
};

class RtlChannelsEngine : public ChannelsEngine {
 public:
  void run(const ServoIcInputs& in, Tick end) override {
    rtl_.in = in;
    rtl_.settle();
    while (rtl_.now() < end) rtl_.tick();
  }
  std::uint32_t word(const ServoIcInputs& in) override {
    rtl_.in = in;
    return rtl_.rdata();
  }
  ChannelPins pins() const override { return channel_pins(rtl_); }

 private:
  RtlServoIc rtl_;
};

class ModelChannelsEngine : public ChannelsEngine {
 public:
  void run(const ServoIcInputs& in, Tick end) override {
    set_inputs(model_, in);
    if (!in.rst_n) {
      model_.reset(now_ = end);
      set_inputs(model_, in);
    }
    while (now_ < end) {
      const bool strobe = in.we || in.rd;
      now_ = strobe ? std::min(end, now_ + kTicksPerRef - now_ % kTicksPerRef) : end;
      model_.advance(now_);
      if (!strobe || now_ % kTicksPerRef != 0) continue;
      if (in.rd) model_.read_taken(in.x, in.addr);
      if (in.we) model_.write(in.x, in.addr, in.wdata);
    }
  }
  std::uint32_t word(const ServoIcInputs& in) override { return model_.read(in.x, in.addr); }
  ChannelPins pins() const override { return channel_pins(model_); }

 private:
  ServoIc model_{sc_core::sc_gen_unique_name("ic")};
  Tick now_ = 0;
};

inline std::unique_ptr<ChannelsEngine> make_channels_engine(bool rtl) {
  if (rtl) return std::make_unique<RtlChannelsEngine>();
  return std::make_unique<ModelChannelsEngine>();
}

}  // namespace brick
