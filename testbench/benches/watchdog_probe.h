// Connects the watchdog scoreboard to a machine: SERVO and the trip at the board's pins, strobes at the end of bus
// cycles on Port A.
#pragma once

#include <algorithm>
#include <cstdlib>

#include "systemc/cpu/port_a.h"
#include "testbench/checkers/watchdog_scoreboard.h"
#include "testbench/host/host_link.h"

namespace brick {

class WatchdogProbe {
 public:
  WatchdogProbe(HostBus& bus, WatchdogScoreboard& scoreboard) : bus_(bus), scoreboard_(scoreboard) {
    BoardOutputs pins = select_pins(pin::kWdTripped);
    for (unsigned i = 0; i < kBoardOutputWords; ++i) pins.w[i] |= select_pins(pin::kServo).w[i];
    bus_.watch(pins, [this](Tick t, const BoardOutputs& before, const BoardOutputs& after) { edge(t, before, after); });
    bus_.machine().on_bus_cycle = [this](const PortACycle& c) {
      if (c.write && c.x && c.address == kStrobe) scoreboard_.strobe(fs_to_tick(c.strobe_low));
    };
  }
  ~WatchdogProbe() {
    bus_.watch({}, nullptr);
    bus_.machine().on_bus_cycle = nullptr;
  }
  WatchdogProbe(const WatchdogProbe&) = delete;
  WatchdogProbe& operator=(const WatchdogProbe&) = delete;

  // The background is starved from the first SERVO period of `period` ticks on; `counter` is what I40 stands for.
  void expect_starvation(Tick period, unsigned counter) {
    period_ = period;
    counter_ = counter;
  }
  Tick last_servo_edge() const { return last_edge_; }  // either level
  void reset() {
    scoreboard_.reset(bus_.now());
    last_fall_ = -1;
    period_ = 0;
  }

 private:
  static constexpr std::uint32_t kStrobe = 0x070011;

  void edge(Tick t, const BoardOutputs& before, const BoardOutputs& after) {
    if (before.get(pin::kServo) != after.get(pin::kServo)) last_edge_ = t;
    if (before.get(pin::kServo) != 0 && after.get(pin::kServo) == 0) {
      if (period_ != 0 && last_fall_ >= 0 && t - last_fall_ == period_) {
        scoreboard_.starved(last_fall_, period_, counter_);
        period_ = 0;
      }
      scoreboard_.servo_fell(t);
      last_fall_ = t;
    }
    if (before.get(pin::kWdTripped) == 0 && after.get(pin::kWdTripped) != 0) scoreboard_.trip(t);
  }

  HostBus& bus_;
  WatchdogScoreboard& scoreboard_;
  Tick period_ = 0, last_fall_ = -1, last_edge_ = -1;
  unsigned counter_ = 0;
};

// The servo period, as I7000 with dividers of one, that leaves the real-time task half of the CPU time it needs and the
// background none, from the task costs that a host reads in half CPU cycles (firmware:8.1). CPU clock I52=7.
// docs/watchdog.md, "Servo frequency too high".
struct WatchdogLoad {
  long servo = 0, real_time = 0;  // CPU cycles: phase and servo task, real-time task
  bool sensible() const { return servo > 100 && servo < 5000 && real_time > 100 && real_time < 5000; }
  unsigned starving_i7000(unsigned i8) const {
    const long period = (servo + real_time / (2 * (static_cast<long>(i8) + 1))) * 12 / 8;  // ticks
    return static_cast<unsigned>((period - 3) / 2);
  }
};

inline WatchdogLoad watchdog_load(HostLink& link) {
  const auto cycles = [&link](const char* word) {
    const Reply reply = link.command(word);
    return reply.lines.empty() ? 0 : 2 * std::strtol(reply.lines[0].c_str(), nullptr, 10);
  };
  WatchdogLoad load;
  for (int i = 0; i < 4; ++i) {  // the shortest: not a task that was interrupted, nor one that has more to do at times
    const long servo = cycles("RY$37") + cycles("RX$37"), real_time = cycles("RX$B");
    load.servo = i == 0 ? servo : std::min(load.servo, servo);
    load.real_time = i == 0 ? real_time : std::min(load.real_time, real_time);
  }
  return load;
}

}  // namespace brick
