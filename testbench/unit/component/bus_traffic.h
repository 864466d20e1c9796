// Random but repeatable traffic for the sockets of a board's component, and what it must lead to: the same board, with
// the same bus masters, driven edge by edge through its C++ face. Each bus has a program of accesses, each some time
// after the end of the one before; pins change at times of their own.
#pragma once

#include <cstdint>
#include <vector>

#include "systemc/core/board.h"
#include "testbench/unit/component/traffic.h"

namespace brick::component {

struct BusAccess {
  enum Socket { kPortA, kIo, kMemory };
  Picoseconds idle = 0;
  Socket socket = kPortA;
  bool write = false;
  std::uint32_t address = 0;  // byte
  unsigned length = 4;
  std::uint32_t value = 0;
  unsigned enables = 0xF;  // bytes
};

struct BusTraffic {
  std::vector<BusAccess> port_a, isa;
  std::vector<PinChange> pins;
  Picoseconds end = 0;
};
BusTraffic bus_traffic(unsigned seed, Tick ticks);

// Answers of an access that failed.
constexpr std::uint32_t kNotMapped = 0xBAD00001, kNotMade = 0xBAD00002;

struct BusSeen {
  std::vector<Change> changes;  // outputs of the board, under their ports' names
  std::vector<Answer> port_a, isa;
  unsigned reads = 0, writes = 0;
};
enum class BusFault { kNone, kLateStrobe, kLateAddress };
BusSeen run(brick::Board& board, std::uint32_t fitted, const BusTraffic& traffic, BusFault fault = BusFault::kNone);

}  // namespace brick::component
