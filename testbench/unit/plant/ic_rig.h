// The plant at the model of a servo IC. Default dividers (SCLK and PFM_CLK 12 ticks, DAC_CLK 24, ADC_CLK 48) and a
// phase period of 2 x 1500 + 3 ticks.
#pragma once

#include "rtl/regs/brick_regs.hpp"
#include "systemc/servo_ic/servo_ic.h"
#include "testbench/unit/plant/plant_rig.h"

namespace brick::plant {

namespace servo_channel = regs::servo_channel;
namespace servo_ic = regs::servo_ic;

class IcRig : public PlantRig, private MotorDigest {
 public:
  static constexpr unsigned kMaxCount = 1500;
  static constexpr Tick kPhase = 2 * kMaxCount + 3;

  // `digest`: the peer has one, else it sees every edge.
  explicit IcRig(MotorPeer& peer, bool digest = false) : PlantRig(peer) {
    peer.begin(digest ? this : nullptr);
    peer.changed(0, 0, {}, {});
    ic_.reset(0);
    using namespace servo_ic;
    write(0, kPwmControl, pwm_control::kMaxCount.set(0, kMaxCount));  // no dead time, PFM pulses of one PFM_CLK
    write(0, kClockControl, 0x0008D2);
    run(2 * 13057);  // the new maximum count is taken at a turnaround
  }

  // Words of channel 0..3, or with channel 0 of the whole IC. A write is executed by the next edge of clk_ref.
  void write(unsigned channel, const regs::Register& word, std::uint32_t value) {
    run(kTicksPerRef - 1 - now_ % kTicksPerRef);
    const unsigned offset = kChannelWords * channel + word.address;
    strobe_ = [=, x = word.space == 'X'] { ic_.write(x, offset, value); };
    tick();
  }
  std::uint32_t read(unsigned channel, const regs::Register& word) const {
    return ic_.read(word.space == 'X', kChannelWords * channel + word.address);
  }
  // Signed counter of a channel, as the last falling edge of PHASE latched it.
  int counter(unsigned channel) const {
    return static_cast<int>(read(channel, servo_channel::kPhasePosition) << 8) >> 8;
  }
  bool status(unsigned channel, const regs::Field& bit) const {
    return bit.get(read(channel, servo_channel::kStatus)) != 0;
  }
  const MotorOutputs& outputs() const { return outputs_; }

 private:
  static constexpr unsigned kChannelWords = 8;

  void edge() override {
    ic_.set_motor_inputs(inputs[0]);
    ic_.advance(now_);
    if (strobe_) strobe_();
    strobe_ = nullptr;
    outputs_ = ic_.motor_outputs();
    const MotorOutputs before = seen_;
    seen_ = outputs_ & peer_.watched(0);
    if (seen_ == before) return;
    peer_.changed(now_, 0, before, seen_);
    stopped_ = stopped_ || before.differs(seen_, peer_.stops(0));
  }

  ConverterWords dac_lines(unsigned) override { return ic_.channels().dac_lines(); }
  AdcStream adc_stream(unsigned) override { return ic_.channels().adc_stream(); }
  void send_adc(unsigned, const ConverterWords& words) override { ic_.send_adc(words); }
  unsigned adc_lines(unsigned, bool b) override { return ic_.channels().adc_lines(b); }
  PwmTimes pwm_times(unsigned, unsigned channel) override { return ic_.channels().pwm_times(channel); }

  ServoIc ic_{sc_core::sc_gen_unique_name("ic")};
  MotorOutputs outputs_, seen_;
  std::function<void()> strobe_;
};

}  // namespace brick::plant
