// Random but repeatable traffic for a component, and what it must lead to. Pins change at kernel times of their own,
// accesses come one after another, each some time after the end of the one before. The same lists drive the component,
// through signals and a socket, and the block inside, edge by edge through its C++ face; times are computed here, by
// the rule in brick/time_base.h, with 128-bit arithmetic.
#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick::component {

using Picoseconds = std::uint64_t;  // units of the kernel

// Instant in which edge t acts: the first unit after t x 78125000/9216 ps.
inline Picoseconds edge_time(Tick t) {
  return static_cast<Picoseconds>(static_cast<unsigned __int128>(t) * 78'125'000 / 9216) + 1;
}
// First edge that acts after `time`.
inline Tick edge_after(Picoseconds time) {
  Tick t = static_cast<Tick>(static_cast<unsigned __int128>(time) * 9216 / 78'125'000);
  while (edge_time(t) <= time) ++t;
  return t;
}

struct PinChange {
  Picoseconds time;
  std::string pin;
  std::uint32_t value;
};
struct Access {
  Picoseconds idle;  // after the end of the one before
  bool write;
  unsigned address;
  std::uint32_t value;
  unsigned length = 0;      // bytes, 4 at most; 0: the width of the socket
  unsigned enables = 0xFF;  // bytes that are enabled, bit 0 the first; all of them: no byte enables
};
struct Traffic {
  std::vector<PinChange> pins;  // by time
  std::vector<Access> accesses;
  std::vector<Access> others;  // at a second socket
  Picoseconds end = 0;
};

// What can be seen outside.
using Change = std::tuple<Picoseconds, std::string, std::uint32_t>;  // of an output; sorted within an instant
using Answer = std::pair<Picoseconds, std::uint32_t>;                // end of an access, what it read
struct Seen {
  std::vector<Change> changes;
  std::vector<Answer> answers, others;
  std::size_t annotated = 0;  // accesses that began ahead of the kernel's time
};

// The block inside, through its C++ face.
class Block {
 public:
  virtual ~Block() = default;
  virtual void set(const std::string& pin, std::uint32_t value) = 0;
  virtual void edge(Tick t) = 0;
  virtual bool moved() = 0;                          // some output may have changed since the last call
  virtual std::uint32_t read(unsigned address) = 0;  // before the edge that takes the sample
  virtual void before(const Access&) {}              // it goes to the next edge
  virtual void accessed(const Access& access) = 0;   // after it
  virtual std::map<std::string, std::uint32_t> outputs() const = 0;
};

Seen run(Block& block, const Traffic& traffic);

}  // namespace brick::component
