// Debugger on the modelled CPU: a GDB remote serial protocol server (docs/debugging.md). The machine asks it to run the
// CPU in the CPU's place; it stops between two instructions, and while it serves the debugger nothing else goes on, so
// simulated time stands still. It patches no code and adds no cycles: a program that is only continued runs as without
// it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "systemc/cpu/cpu.h"

namespace brick {

// The debugger ended the run (packet k).
class GdbKilled : public std::runtime_error {
 public:
  GdbKilled() : std::runtime_error("killed by the debugger") {}
};

class GdbServer {
 public:
  // Listens at once; std::runtime_error when the port cannot be had. Port 0 takes a free one.
  GdbServer(Cpu& cpu, std::uint16_t port);
  ~GdbServer();  // tells a debugger that waits for the program that it has ended
  std::uint16_t port() const;

  // Cpu::run with stops for the debugger. The first call waits for a debugger to connect.
  Cpu::Stop run(Cycle limit);

  // To be called now and then. Without a debugger it looks for a new one; with one, for a break. `idle`: the CPU sleeps
  // or is held, so there is no next instruction to stop before, and the debugger is served here.
  void poll(bool idle);

  // The device access of the instruction that just runs broke a rule of the bus: `text` goes to the debugger's console,
  // and the program stops behind the instruction as if a bus error had been signalled.
  void bus_error(const std::string& text);

  // The program has raised an exception (mcause): the same with the signal that stands for it, before the handler's
  // first instruction.
  void exception(std::uint32_t cause, const std::string& text);

  std::function<std::string()> on_time;  // answer to `monitor time`

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace brick
