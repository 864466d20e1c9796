// A host that listens on the motor side: every change of the output pins of two servo ICs, every edge of PHASE and
// every write of the CPU to their words, each with its tick. What the benches of the outputs share.
#pragma once

#include <vector>

#include "systemc/machine/motor_peer.h"
#include "testbench/benches/servo_host.h"

namespace brick {

struct PortACycle;

class OutputHost : public ServoHost, public MotorPeer {
 public:
  struct Change {
    Tick tick;
    MotorOutputs pins;
  };
  struct Access {
    Tick tick;  // write: the word has the value from here on; read: data as they stood after this edge
    bool write, x;
    std::uint32_t address, data;
  };
  struct Edge {
    Tick tick;
    bool high;
  };

  explicit OutputHost(BenchContext& bench);
  ~OutputHost() override;

  std::uint32_t ics() const override;
  Tick next_event() const override { return kNever; }
  void changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) override;
  bool step(Tick, MotorInputPins&) override { return false; }

  MotorOutputs pins(unsigned place) { return bench().machine.motor_outputs(ic(place)); }

  // The record; forget() leaves the pins as they stand as the only entry.
  void forget();
  const std::vector<Change>& changes(unsigned place) const { return changes_.at(place); }
  const std::vector<Edge>& phase() const { return phase_; }
  const std::vector<Access>& accesses() const { return accesses_; }
  // Last write to a word that is recorded, -1 if none.
  Tick written(unsigned channel, const regs::Register& word) const;

 private:
  void cycle(const PortACycle& c);

  std::vector<std::vector<Change>> changes_;
  std::vector<Edge> phase_;
  std::vector<Access> accesses_;
};

}  // namespace brick
