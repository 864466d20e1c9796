// The plant at the model of a servo IC. Default dividers (SCLK and PFM_CLK 12 ticks, DAC_CLK 24, ADC_CLK 48) and a
// phase period of 2 x 1500 + 3 ticks.
#pragma once

#include "systemc/servo_ic/servo_ic.h"
#include "testbench/unit/plant/plant_rig.h"

namespace brick::plant {

class IcRig : public PlantRig {
 public:
  static constexpr unsigned kMaxCount = 1500;
  static constexpr Tick kPhase = 2 * kMaxCount + 3;

  explicit IcRig(MotorPeer& peer) : PlantRig(peer) {
    ic_.reset(0);
    write(true, 0x1C, kMaxCount << 8);  // no dead time, PFM pulses of one PFM_CLK
    write(true, 0x04, 0x0008D2);
    run(2 * 13057);  // the new maximum count is taken at a turnaround
  }

  // Executed by the next edge of clk_ref.
  void write(bool x, unsigned offset, std::uint32_t value) {
    run(kTicksPerRef - 1 - now_ % kTicksPerRef);
    strobe_ = [=] { ic_.write(x, offset, value); };
    tick();
  }
  std::uint32_t read(bool x, unsigned offset) const { return ic_.read(x, offset); }
  // Signed counter of channel 0..3, as the last falling edge of PHASE latched it.
  int counter(unsigned channel) const { return static_cast<int>(read(true, 8 * channel + 1) << 8) >> 8; }
  bool status(unsigned channel, unsigned bit) const { return (read(true, 8 * channel) >> bit & 1) != 0; }
  const MotorOutputs& outputs() const { return outputs_; }

 private:
  void edge() override {
    ic_.set_motor_inputs(inputs[0]);
    ic_.advance(now_);
    if (strobe_) strobe_();
    strobe_ = nullptr;
    const MotorOutputs before = outputs_;
    outputs_ = ic_.motor_outputs();
    if (outputs_ == before) return;
    peer_.changed(now_, 0, before, outputs_);
    stopped_ = stopped_ || before.differs(outputs_, peer_.stops(0));
  }

  ServoIc ic_{sc_core::sc_gen_unique_name("ic")};
  MotorOutputs outputs_;
  std::function<void()> strobe_;
};

}  // namespace brick::plant
