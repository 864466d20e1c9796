// The plant at a servo IC: the model of its channels, clock chain and registers, with pins as the board shows them. Default dividers
// (SCLK and PFM_CLK 12 ticks, DAC_CLK 24, ADC_CLK 48) and a phase period of 2 x 1500 + 3 ticks.
#pragma once

#include <algorithm>

#include "systemc/servo_ic/clock_gen.h"
#include "systemc/servo_ic/servo_channels.h"
#include "systemc/servo_ic/servo_ic_regs.h"
#include "testbench/unit/plant/plant_rig.h"

namespace brick::plant {

class IcRig : public PlantRig {
 public:
  static constexpr unsigned kMaxCount = 1500;
  static constexpr Tick kPhase = 2 * kMaxCount + 3;

  explicit IcRig(MotorPeer& peer) : PlantRig(peer) {
    regs_.reset();
    clock_gen_.reset(0);
    channels_.reset(0);
    apply_registers();
    write(true, 0x1C, kMaxCount << 8);  // no dead time, PFM pulses of one PFM_CLK
    write(true, 0x04, 0x0008D2);
    run(2 * 13057);  // the new maximum count is taken at a turnaround
  }

  // Executed by the next edge of clk_ref.
  void write(bool x, unsigned offset, std::uint32_t value) {
    run(kTicksPerRef - 1 - now_ % kTicksPerRef);
    strobe_ = [=] {
      regs_.write(x, offset, value);
      channels_.write(x, offset, value);
      apply_registers();
    };
    tick();
  }
  std::uint32_t read(bool x, unsigned offset) const { return regs_.read(x, offset) | channels_.read(x, offset); }
  // Signed counter of channel 0..3, as the last falling edge of PHASE latched it.
  int counter(unsigned channel) const { return static_cast<int>(read(true, 8 * channel + 1) << 8) >> 8; }
  bool status(unsigned channel, unsigned bit) const { return (read(true, 8 * channel) >> bit & 1) != 0; }
  const MotorOutputs& outputs() const { return outputs_; }

 private:
  void edge() override {
    for (unsigned n = 0; n < kChannels; ++n) channels_.set_pins(n, inputs[0].pins[n]);
    channels_.in.adc_a = inputs[0].adc_a;
    channels_.in.adc_b = inputs[0].adc_b;
    channels_.advance(now_);
    const bool up = clock_gen_.up(), phase = clock_gen_.phase_clock();
    clock_gen_.advance(now_);
    if (clock_gen_.up() != up) channels_.turn();
    if (clock_gen_.phase_clock() != phase) {
      bool& edges = phase ? channels_.in.phase_falls : channels_.in.phase_rises;
      edges = !edges;
    }
    follow_clock();
    if (strobe_) strobe_();
    strobe_ = nullptr;
    show();
  }
  void show() {
    const MotorOutputs before = outputs_;
    const ServoChannels& c = channels_;
    outputs_.w[0] = c.pwm() | c.pulse() << 24 | c.dir() << 28;
    outputs_.w[1] = c.dac_a() | c.dac_b() << 4 | c.aena() << 8 | c.equ() << 12;
    outputs_.set(motor_pin::kDacClk, 0, c.dac_clk());
    outputs_.set(motor_pin::kDacStrobe, 0, c.dac_strobe());
    outputs_.set(motor_pin::kAdcClk, 0, c.adc_clk());
    outputs_.set(motor_pin::kAdcStrobe, 0, c.adc_strobe());
    if (outputs_ == before) return;
    peer_.changed(now_, 0, before, outputs_);
    stopped_ = stopped_ || before.differs(outputs_, peer_.stops(0));
  }
  void apply_registers() {
    clock_gen_.in.max_count = regs_.max_count();
    clock_gen_.in.phase_div = regs_.phase_div();
    clock_gen_.in.servo_div = regs_.servo_div();
    clock_gen_.in.phase_ext = regs_.phase_ext();
    clock_gen_.in.servo_ext = regs_.servo_ext();
    channels_.in.dividers = regs_.clock_dividers();
    channels_.in.dac_strobe = regs_.dac_strobe();
    channels_.in.adc_strobe = regs_.adc_strobe();
    channels_.in.deadtime = regs_.deadtime();
    follow_clock();
  }
  void follow_clock() { channels_.in.line = {clock_gen_.cnt(), clock_gen_.up() ? 1 : -1}; }

  ServoIcRegs regs_{sc_core::sc_gen_unique_name("regs")};
  ClockGen clock_gen_{sc_core::sc_gen_unique_name("clock_gen")};
  ServoChannels channels_{sc_core::sc_gen_unique_name("channels")};
  MotorOutputs outputs_;
  std::function<void()> strobe_;
};

}  // namespace brick::plant
