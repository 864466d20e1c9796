// Random but sound cycles of a host on the ISA pins, at any phase to the femtosecond, at usual times, slowly and at the
// limits of host-bus:3.4: I/O and memory of its board and of nobody, in bytes and words. Between its cycles it pulls
// RESETDRV, moves AEN and the lines of the connectors, lets the 5 V fail, and resets the board.
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "testbench/host/host_bus.h"
#include "testbench/unit/accesses/access_cpu.h"

namespace brick {

class AccessHost {
 public:
  enum Kind { kIoRead, kIoWrite, kMemoryRead, kMemoryWrite, kKinds };
  static constexpr std::array<const char*, kKinds> kNames{"I/O read", "I/O write", "memory read", "memory write"};

  AccessHost(Machine& machine, AccessCpu& cpu, std::uint64_t seed, bool memory);

  void step();
  std::uint64_t made(Kind kind) const { return made_[kind]; }
  std::uint64_t made() const { return made_[kIoRead] + made_[kIoWrite] + made_[kMemoryRead] + made_[kMemoryWrite]; }

 private:
  std::uint32_t pick(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }
  TimeFs soon() { return bus_.machine().now_fs() + isa::ns(1000) + pick(static_cast<std::uint32_t>(isa::ns(20))); }
  void times();
  void io();
  void memory_word();
  void another_clock();
  void connectors();
  void reset_drive();
  void reset();

  HostBus bus_;
  AccessCpu& cpu_;
  bool memory_;
  std::mt19937_64 random_;
  std::array<std::uint64_t, kKinds> made_{};
};

}  // namespace brick
