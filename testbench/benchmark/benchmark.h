// The measured loops, one function each: they return how much was done; the caller takes the time.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "systemc/core/board.h"
#include "systemc/machine/machine.h"

namespace brick {

// The Verilated board of the RTL engine without anything of ours around it: two evaluations a tick, pins not looked at.
// The clocks run from servo IC 0 as in the engine that it is compared with.
class BareLoop {
 public:
  BareLoop();
  ~BareLoop();
  void run(Tick ticks);

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

// Instructions retired by a loop of integer arithmetic, loads, stores and branches on the CPU model alone.
std::uint64_t run_cpu_alone(std::uint64_t instructions);

// Lets servo IC 0 drive PHASE and SERVO at their reset values: reset, then one write to X:$078004.
void start_clocks(Board& board, std::uint32_t fitted = 0x3);

// The whole controller with its firmware: idle (waits for the host), busy (the host asks without a pause), and both
// with a waveform at `wave`.
void measure_machine(Engine engine, const std::string& name, const std::string& firmware, double simulated,
                     const std::string& wave);

// The SystemC engine where every tick counts: host and CPU use their buses without a pause.
void measure_bus(const std::string& firmware, double simulated);

// The SystemC engine with the plant and set-up examples/.../NAME, eight motors jogging; `goal` in simulated seconds a
// second and as a part of the idle speed.
void measure_moving(const std::string& name, const std::string& what, const std::string& firmware, double simulated,
                    double goal, double goal_ratio);

}  // namespace brick
