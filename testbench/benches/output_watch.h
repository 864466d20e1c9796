// Collects which output pins of the servo ICs were high in a stretch of time, and what the DACs at them hold, for
// benches that expect outputs to be alive or dead.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "systemc/machine/machine.h"
#include "testbench/plant/dac_peer.h"

namespace brick {

class OutputWatch : public MotorPeer {
 public:
  OutputWatch(Machine& machine, std::uint32_t fitted) : machine_(machine), ics_(fitted & ((1u << kMaxServoIcs) - 1)) {
    machine.attach(*this);
  }
  ~OutputWatch() override { machine_.detach(*this); }
  OutputWatch(const OutputWatch&) = delete;
  OutputWatch& operator=(const OutputWatch&) = delete;

  std::uint32_t ics() const override { return ics_; }
  Tick next_event() const override { return kNever; }
  bool step(Tick, MotorInputPins&) override { return false; }
  void changed(Tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) override {
    add(ic, after);
    dac_[ic].changed(before, after);
  }

  void begin() {
    for (unsigned ic = 0; ic < kMaxServoIcs; ++ic) {
      high_[ic] = {};
      if ((ics_ >> ic & 1) != 0) add(ic, machine_.motor_outputs(ic));
    }
  }
  bool was_high(unsigned ic, const MotorField& pin, unsigned channel) const { return high_[ic].get(pin, channel) != 0; }

  const plant::DacPeer& dac(unsigned ic) const { return dac_.at(ic); }

  // Names of the pins that an amplifier obeys and that were high since begin(): "servo_ic0.ch1.aena ...".
  std::string alive() const {
    using namespace motor_pin;
    std::string text;
    for (unsigned ic = 0; ic < kMaxServoIcs; ++ic)
      for (unsigned n = 0; n < kChannels && (ics_ >> ic & 1) != 0; ++n)
        for (const MotorField* pin : {&kAena, &kPwmATop, &kPwmABot, &kPwmBTop, &kPwmBBot, &kPwmCTop, &kPwmCBot,
                                      &kPfmPulse, &kDac, &kDacB, &kEqu})
          if (was_high(ic, *pin, n))
            text += fmt::format("{}{}.ch{}.{}", text.empty() ? "" : " ", servo_ic_scope(ic), n + 1, pin->name);
    return text;
  }

 private:
  void add(unsigned ic, const MotorOutputs& pins) {
    for (unsigned i = 0; i < kMotorOutputWords; ++i) high_[ic].w[i] |= pins.w[i];
  }

  Machine& machine_;
  std::uint32_t ics_;
  std::array<MotorOutputs, kMaxServoIcs> high_{};
  std::vector<plant::DacPeer> dac_ = std::vector<plant::DacPeer>(kMaxServoIcs, plant::DacPeer());
};

}  // namespace brick
