// Simulated time that goes with the wall's where the engine is fast enough, in steps so short that a key or a packet is
// not kept waiting.
#pragma once

#include <chrono>

#include "testbench/host/isa_host.h"

namespace brick {

class Pace {
 public:
  static constexpr std::chrono::milliseconds kStep{10};      // of an engine that keeps up, and the longest of any
  static constexpr std::chrono::milliseconds kMostLag{100};  // what is behind by more is not caught up

  explicit Pace(IsaHost& host) : host_(host) { start(); }

  void start();                        // from now on, whatever went by before
  std::chrono::milliseconds follow();  // returns how long there is nothing to do

 private:
  using Clock = std::chrono::steady_clock;

  IsaHost& host_;
  Clock::time_point origin_;
  Tick from_ = 0;  // tick at `origin_`
  Tick slice_ = ns_to_ticks(100'000);
};

}  // namespace brick
