// A host that listens on the motor side: every change of the output pins of two servo ICs, every edge of PHASE and every write of the
// CPU to their words, each with its tick. What the benches of the outputs share.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "systemc/machine/motor_peer.h"
#include "testbench/benches/bench.h"

namespace brick {

struct PortACycle;

// Channels are numbered 0, 1, ... over the first two fitted servo ICs; `place` is 0 or 1.
class OutputHost : public MotorPeer {
 public:
  struct Change {
    Tick tick;
    MotorOutputs pins;
  };
  struct Access {
    Tick tick;  // write: the word has the value from here on; read: data sampled
    bool write, x;
    std::uint32_t address, data;
  };
  struct Edge {
    Tick tick;
    bool high;
  };

  explicit OutputHost(BenchContext& bench);
  ~OutputHost() override;
  OutputHost(const OutputHost&) = delete;
  OutputHost& operator=(const OutputHost&) = delete;

  std::uint32_t ics() const override;
  Tick next_event() const override { return kNever; }
  void changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) override;
  bool step(Tick, MotorInputPins&) override { return false; }

  unsigned places() const { return static_cast<unsigned>(ics_.size()); }
  unsigned channels() const { return places() * kChannels; }
  unsigned ic(unsigned place) const { return ics_.at(place); }
  unsigned i_global(unsigned place, unsigned k) const;             // I7m0k
  unsigned i_channel(unsigned channel, unsigned k) const;          // I7mnk
  std::uint32_t base(unsigned place) const;                        // address of the IC
  std::uint32_t address(unsigned channel, unsigned offset) const;  // of a word of the channel
  std::string name(unsigned channel) const;                        // servo_ic0.ch1
  MotorOutputs pins(unsigned place) const { return bench_.machine.motor_outputs(ic(place)); }

  std::string ask(const std::string& line);  // data lines joined by '|'
  void expect(const std::string& line, const std::string& answer);
  void say(const std::vector<std::string>& words);     // several to a line; no answer expected
  std::vector<long> numbers(const std::string& line);  // data lines as numbers
  // M(100 n + number) of channel n = 1, 2, ... -> a part of its word.
  void define(unsigned number, char space, unsigned offset, const std::string& part);

  unsigned pick(unsigned count) { return static_cast<unsigned>(random_() % count); }
  Tick now() const { return bench_.bus.now(); }
  void wait(Tick ticks) { bench_.bus.wait(ticks); }
  BenchReport& report() { return bench_.report; }
  BenchContext& bench() { return bench_; }

  // The record; forget() leaves the pins as they stand as the only entry.
  void forget();
  const std::vector<Change>& changes(unsigned place) const { return changes_.at(place); }
  const std::vector<Edge>& phase() const { return phase_; }
  const std::vector<Access>& accesses() const { return accesses_; }
  // Last write to a word that is recorded, -1 if none.
  Tick written(bool x, std::uint32_t address) const;

 private:
  void cycle(const PortACycle& c);

  BenchContext& bench_;
  std::mt19937_64 random_;
  std::vector<unsigned> ics_;
  std::vector<std::vector<Change>> changes_;
  std::vector<Edge> phase_;
  std::vector<Access> accesses_;
};

}  // namespace brick
