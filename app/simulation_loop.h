// A simulation that works for other threads: they post what is to be done, it does it between two pieces of simulated
// time and sleeps when nothing is to be done and no time is due.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <vector>

#include "app/pacing.h"
#include "testbench/host/isa_host.h"

namespace brick {

class SimulationLoop {
 public:
  // `free`: time passes only while it is busy, and then as fast as it can; else as the clock on the wall says.
  SimulationLoop(IsaHost& bus, bool free) : bus_(bus), free_(free) {}

  // From any thread: `work` is done on the simulation's.
  void post(std::function<void()> work);

  // On the simulation's thread, until an exception ends it (SIGINT and SIGTERM come as one, app/simulation.h).
  // `busy`: somebody waits for something, so time may run ahead of the wall a little. `run_until`: lets time pass.
  // Told before each piece of time: how much of it passes for one of the wall's, at most 1; always 1 when `free`.
  std::function<void(double)> on_speed;

  // Between two pieces of time, often; it changes nothing of the simulation.
  std::function<void()> on_turn;

  [[noreturn]] void run(const std::function<bool()>& busy, const std::function<void(Tick)>& run_until);

 private:
  void work();
  void sleep_until(Pacing::Clock::time_point time);

  IsaHost& bus_;
  bool free_;
  std::mutex mutex_;
  std::condition_variable posted_;
  std::vector<std::function<void()>> work_;
};

}  // namespace brick
