// The bus masters behind the sockets of a board's component: Port A of a DSP563xx and ISA, both with the edges that
// they have in a machine. They drive the pins of a board; whoever runs it takes it to next() and lets them step().
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "systemc/component/chip.h"
#include "systemc/core/board.h"
#include "systemc/cpu/port_a_master.h"
#include "systemc/host/isa_master.h"

namespace brick::component {

// Register faces of the board, in the order of its constructor.
constexpr unsigned kPortAFace = 0;
constexpr unsigned kIsaFace = 1;
constexpr unsigned kIsaMemory = 1u << 24;  // in the address of a cycle: memory, not I/O
constexpr unsigned kIsaNarrow = 1u << 16;  // in what it reads: memory of eight bits

class BoardBuses {
 public:
  explicit BoardBuses(brick::Board& board);

  // As the user drives them; a bus that has had a cycle here is driven from here alone.
  void set_inputs(const BoardInputs& inputs);
  const BoardInputs& inputs() const { return pins_; }

  void begin(unsigned face, const Cycle& cycle);
  void abandon(unsigned face);  // nobody waits any more: a cycle that has begun goes on to its end
  bool busy(unsigned face) const { return buses_[face].busy; }
  std::uint32_t value(unsigned face) const { return buses_[face].value; }
  Chip::BusEnd end(unsigned face) const { return buses_[face].end; }

  static bool is_control(unsigned address) { return address == kBcr || address == kPctl; }  // byte on Port A
  std::uint32_t control(unsigned address) const { return port_a_.control(address == kBcr); }

  Tick next() const;           // kNever: no cycle is under way
  BoardOutputs stops() const;  // the board goes no further than their next change
  bool step();                 // true: a cycle has ended

 private:
  static constexpr unsigned kBcr = 8 * 0xFFFFFBu + 4, kPctl = 8 * 0xFFFFFDu + 4;
  struct Bus {
    bool used = false;             // has driven its pins
    bool busy = false;             // somebody waits
    std::optional<Cycle> waiting;  // for the end of an abandoned one
    std::uint32_t value = 0;
    Chip::BusEnd end{0, true};
  };
  void reset_port_a();
  void start(unsigned face);
  void start_port_a(const Cycle& cycle);
  void start_isa(const Cycle& cycle);
  void step_port_a();
  void step_isa();
  void finish(unsigned face, std::uint32_t value, Chip::BusEnd end);
  Tick isa_stand() const;

  brick::Board& board_;
  BoardInputs pins_;  // as the board has them
  PortAMaster port_a_;
  IsaMaster isa_;
  TimeFs isa_free_ = 0;
  std::array<Bus, 2> buses_;
  bool ended_ = false;  // since the last step
};

}  // namespace brick::component
