// A block behind the pins of a component, in one engine. It knows no kernel time: who owns it says up to which edge it
// runs and sets its inputs in between. Pins are packed words, laid out as the component's pin table says. Outputs are
// what stands after an edge; what a reset or another level changes without one is seen after the next.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick::component {

using PinWords = std::vector<std::uint32_t>;

// Where the words have a pin, or a row of pins.
struct PinPlace {
  unsigned word, lsb, width;
  constexpr std::uint32_t mask() const { return width >= 32 ? ~0u : (1u << width) - 1; }
  std::uint32_t of(const PinWords& words) const { return words[word] >> lsb & mask(); }
  bool is_set(const PinWords& words) const { return of(words) != 0; }
  constexpr std::uint32_t at(std::uint32_t value) const { return (value & mask()) << lsb; }  // alone, at its place
  template <class Port>
  void drive(Port& port, const PinWords& words) const {
    port = static_cast<Port>(of(words));
  }
};

// An access to a register face, as an initiator asks for it.
struct Cycle {
  bool write = false;
  unsigned address = 0;
  std::uint32_t value = 0;
  unsigned lanes = ~0u;  // bytes used
  TimeFs asked = 0;      // true time of the call, for a bus with clocks of its own
};

class Chip {
 public:
  virtual ~Chip() = default;

  virtual Tick now() const = 0;  // edges executed
  virtual const PinWords& outputs() const = 0;
  virtual void watch(const PinWords& outputs) = 0;      // the bits that the calls below speak of
  virtual void set_inputs(const PinWords& inputs) = 0;  // edge now() + 1 is the first to see them
  // Executes edges up to `limit` or to the first that changes a watched output or ends a cycle: true then.
  virtual bool run_until(Tick limit) = 0;

  // Whether quiet_until() looks ahead: a tick up to which run_until() would not stop, the inputs staying as they are.
  virtual bool foresees() const { return false; }
  virtual Tick quiet_until() const { return now(); }

  // Register faces, in the order of the component's sockets. Edge now() + 1 is the first to see the cycle; the face has
  // none under way.
  virtual void begin(unsigned face, const Cycle& cycle) = 0;
  virtual void abandon(unsigned face) = 0;               // what has not been made of its cycle is not made
  virtual bool busy(unsigned face) const = 0;            // its cycle has not ended with edge now()
  virtual std::uint32_t value(unsigned face) const = 0;  // what the last read took
  // Of a face that is a bus, whose cycles end between two edges: when the last one did, and whether it was made.
  struct BusEnd {
    TimeFs time;
    bool made;
  };
  virtual std::optional<BusEnd> bus_end(unsigned face) const {
    (void)face;
    return {};
  }
  virtual Tick no_end_until() const = 0;  // a tick up to which no cycle ends; kNever: none is under way
  virtual std::uint32_t peek(unsigned face, unsigned address) = 0;  // what a read would take now
  virtual bool peeks(unsigned face, unsigned address) const {       // whether it can say
    (void)face, (void)address;
    return true;
  }
};

class ChipFactory {
 public:
  virtual ~ChipFactory() = default;
  virtual std::unique_ptr<Chip> servo_ic() const = 0;
  virtual std::unique_ptr<Chip> interrupt_controller() const = 0;
  virtual std::unique_ptr<Chip> host_signals() const = 0;
  virtual std::unique_ptr<Chip> watchdog() const = 0;
  virtual std::unique_ptr<Chip> ssi() const = 0;
  virtual std::unique_ptr<Chip> macro_ic() const = 0;
  virtual std::unique_ptr<Chip> clock_select() const = 0;
  virtual std::unique_ptr<Chip> host_port() const = 0;
  virtual std::unique_ptr<Chip> dpram(std::uint64_t ram_seed) const = 0;  // of what it holds at power-on
  virtual std::unique_ptr<Chip> board(std::uint32_t fitted, std::uint64_t seed) const = 0;
};

inline bool differ(const PinWords& a, const PinWords& b, const PinWords& select) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (((a[i] ^ b[i]) & select[i]) != 0) return true;
  return false;
}

}  // namespace brick::component
