// A hand at a motor's encoder (`@encoder`): A and B step by step at an even rate. A positive count turns the way that
// counts up with the factory default I7mn0 = 7, x4 CCW: B leads A. docs/command.md.
#pragma once

#include <cstdint>
#include <optional>

#include "systemc/machine/machine.h"

namespace brick {

class HandEncoder : public MotorPeer {
 public:
  // Turns channel `channel` (0..3) of servo IC `ic` by `counts` edges, `rate` edges a second (1 or more), from tick
  // `now` on.
  HandEncoder(unsigned ic, unsigned channel, std::int64_t counts, std::int64_t rate, Tick now);

  std::uint32_t ics() const override { return 0; }
  Tick next_event() const override;
  bool step(Tick now, MotorInputPins& inputs) override;

  Tick end() const;  // of the last edge

 private:
  Tick time_of(std::int64_t edge) const;  // edge 1 is the first

  unsigned ic_, channel_;
  std::int64_t left_, total_, rate_;
  bool up_;
  Tick start_;
};

// Motor n (1, 2, ...) has channel n of the fitted servo ICs in rising order; nullopt when there are not so many.
struct MotorPlace {
  unsigned ic, channel;
};
std::optional<MotorPlace> motor_place(std::uint32_t fitted, unsigned motor);
unsigned motor_number(std::uint32_t fitted, unsigned ic, unsigned channel);  // of a channel that is fitted

}  // namespace brick
