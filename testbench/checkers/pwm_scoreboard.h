// The PWM rules (servo-ic:5.1/1, servo-ic:5.11/1 to servo-ic:5.11/5), for whole stretches of time: the triangle as a
// list of its turns, a phase's commands as a list of when they were written, and from both the switch pins as a list of
// changes. Nothing is stepped; every edge comes from where a straight line crosses the command.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

struct PwmTurn {
  Tick tick;
  std::int32_t count;
};

struct PwmChange {
  Tick tick;       // written
  unsigned limit;  // I7m00
};

// Turns from the bottom turn `bottom` on up to the first after `to`. A new limit counts from the next bottom turn on;
// the counter climbs from the old bottom to the new top.
std::vector<PwmTurn> pwm_turns(Tick bottom, unsigned limit, Tick to, const std::vector<PwmChange>& changes = {});

struct PwmCommand {
  Tick tick;  // written
  std::int32_t value;
};

// Pins of one phase from `tick` on: bit 0 upper switch, bit 1 lower one, 1 = on.
struct PwmLevel {
  Tick tick;
  unsigned pins;
};

struct PwmRule {
  Tick dead = 0;        // 16 I7m04
  bool greater = true;  // the switch is up while command > count; a negative control says >=
};

// The first command must be older than the first turn. Certain from dead ticks after that turn on.
std::vector<PwmLevel> pwm_switches(const std::vector<PwmTurn>& turns, const std::vector<PwmCommand>& commands,
                                   const PwmRule& rule);

// First difference within [from, to], or "".
std::string pwm_difference(const std::vector<PwmLevel>& seen, const std::vector<PwmLevel>& expected, Tick from,
                           Tick to);

// Ticks in [from, to) at which the pins show `pins`.
Tick pwm_time(const std::vector<PwmLevel>& levels, unsigned pins, Tick from, Tick to);

// On time of the comparison in each period, before the dead time: 2 command + 2 limit + 3, at least 0, at most the
// period.
Tick pwm_on_time(unsigned limit, std::int32_t command);

}  // namespace brick
