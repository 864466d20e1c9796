// Model of rtl/servo_ic/servo_ic.sv: servo IC (DSPGATE1) with its register face and its clock pins, in ticks. Ports, a
// TLM-2.0 socket and SystemC's time are in front of it in systemc/component.
#pragma once

#include <algorithm>
#include <cstdint>

#include <systemc>

#include "systemc/core/model_block.h"
#include "systemc/servo_ic/clock_follower.h"
#include "systemc/servo_ic/clock_gen.h"
#include "systemc/servo_ic/servo_channels.h"
#include "systemc/servo_ic/servo_ic_regs.h"

namespace brick {

class ServoIc : public sc_core::sc_module, public ClockFollower {
 public:
  explicit ServoIc(const sc_core::sc_module_name& name);

  // Registers as they stand after the last executed edge; a write is executed by that edge, so call advance() first.
  std::uint32_t read(bool x, unsigned offset) const { return regs_.read(x, offset) | channels_.read(x, offset); }
  void write(bool x, unsigned offset, std::uint32_t value);
  // The last executed edge took the word, as it stood before, as the sample of a read.
  void read_taken(bool x, unsigned offset) { channels_.read_taken(x, offset); }

  // Motor side: pins of a channel (0..3) as status bits 23..12 show them, and whether the watchdog has tripped.
  void set_channel_pins(unsigned channel, unsigned pins) { channels_.set_pins(channel, pins); }
  void set_motor_inputs(const MotorInputs& inputs) {
    for (unsigned i = 0; i < kChannels; ++i) channels_.set_pins(i, inputs.pins[i]);
    channels_.set_adc(inputs.adc_a, inputs.adc_b);
  }
  MotorOutputs motor_outputs(const MotorOutputs& select = kAllMotorOutputs) const {
    return channels_.motor_outputs(select);
  }
  unsigned equ() const { return channels_.equ(); }  // bit n-1 for channel n
  void set_trip(bool trip) { channels_.set_trip(trip); }
  const ServoChannels& channels() const { return channels_; }
  void send_adc(const ConverterWords& words) { channels_.send_adc(words); }  // in place of the pins

  // Clock pins; the inputs are seen by the edges to come.
  void set_pins(bool phase, bool servo) override {
    clock_gen_.in.phase = phase;
    clock_gen_.in.servo = servo;
  }
  bool phase() const { return clock_gen_.phase(); }
  bool servo() const { return clock_gen_.servo(); }
  const ClockGen& clock_gen() const override { return clock_gen_; }

  // Clock pins only; motor outputs and EQU can change from the others on.
  Tick next_event() const override { return clock_gen_.next_event(); }
  Tick next_motor_event(const MotorOutputs& select = kAllMotorOutputs) const;  // of the outputs selected
  Tick next_equ_event(unsigned channels) const { return channels_.next_equ_event(channels); }
  void advance(Tick t) override;
  void reset(Tick t) override;

 private:
  void mark() override;
  bool repeats() const override;
  void jump(Tick by) override;
  void apply_registers();

  ServoIcRegs regs_;
  void follow_clock();

  ClockGen clock_gen_;
  ServoChannels channels_;
  Tick now_{}, chain_edge_{};  // the last edge of PHASE or SERVO inside
};

}  // namespace brick
