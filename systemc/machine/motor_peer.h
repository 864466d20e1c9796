// What is wired to the motor side of the running controller: a motor with its encoder, a converter, a hand at the
// encoder. The machine tells it each change of the outputs it asked for, and calls step() when its time has come.
#pragma once

#include <array>
#include <cstdint>

#include "systemc/core/motor_digest.h"
#include "systemc/core/motor_pins.h"
#include "systemc/core/ticks.h"

namespace brick {

using MotorInputPins = std::array<MotorInputs, kMaxServoIcs>;  // index as in BoardInputs::fitted

class MotorPeer {
 public:
  virtual ~MotorPeer() = default;

  virtual std::uint32_t ics() const = 0;  // servo ICs whose outputs it wants to see, bit i; constant

  // It is attached, or the engine offers something else than before: `digest` in place of edges, or nullptr.
  // changed() with equal outputs follows.
  virtual void begin(MotorDigest* digest) { (void)digest; }

  // Those of their outputs whose changes it wants to be told; constant after begin().
  virtual MotorOutputs watched(unsigned ic) const {
    (void)ic;
    return kAllMotorOutputs;
  }

  // Outputs after whose change step() is called at once; constant after begin().
  virtual MotorOutputs stops(unsigned ic) const {
    (void)ic;
    return {};
  }

  // Input pins of a channel that it drives, bits as ChannelPin; constant. Nobody else should.
  virtual std::uint16_t drives(unsigned ic, unsigned channel) const {
    (void)ic, (void)channel;
    return 0;
  }

  // Absolute encoders (SSI): channels at which it has one, constant, bit n - 1 for channel n. Each edge of their clocks
  // is told, with step() after it; ssi_data() is asked after each step(), the edge now + 1 is the first to see it.
  virtual std::uint8_t ssi_channels() const { return 0; }
  virtual void ssi_clocked(Tick tick, std::uint8_t before, std::uint8_t after) {
    (void)tick, (void)before, (void)after;
  }
  virtual std::uint8_t ssi_data(Tick now) {
    (void)now;
    return 0xFF;
  }

  // Tick at which step() is to be called next, after now(); kNever: only after a stop.
  virtual Tick next_event() const = 0;

  // Each change of the outputs of its ICs, in order; first, when it is attached, the outputs as they stand, as `before`
  // and `after`, which are equal then and only then.
  virtual void changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) {
    (void)tick, (void)ic, (void)before, (void)after;
  }

  // The time is `now`. It may edit input pins, which the edge now + 1 is the first to see; true when it has.
  // next_event() is later than `now` afterwards.
  virtual bool step(Tick now, MotorInputPins& inputs) = 0;
};

}  // namespace brick
