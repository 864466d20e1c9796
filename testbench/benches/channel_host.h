// A host with its hands on the motor side: plays levels on the input pins of all channels at once, and keeps a scoreboard for each of
// them (testbench/checkers/channel_scoreboard.h) that sees the same levels. What the channel benches share.
#pragma once

#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "systemc/machine/motor_peer.h"
#include "testbench/benches/bench.h"
#include "testbench/checkers/channel_scoreboard.h"

namespace brick {

struct PortACycle;

// Channels are numbered 0, 1, ... over the fitted servo ICs in rising order.
struct PinEvent {
  Tick tick;
  unsigned channel;
  std::uint16_t pins;
};

// Plays a list of levels and records what the output pins show.
class PinPlayer : public MotorPeer {
 public:
  struct Seen {
    std::vector<ChannelScoreboard::Change> counts, equs, pulses;  // a pulse's value is 1 or -1, by the direction pin
    void clear() {
      counts.clear();
      equs.clear();
      pulses.clear();
    }
  };

  explicit PinPlayer(std::vector<unsigned> ics) : ics_(std::move(ics)), seen(ics_.size() * kChannels) {}
  std::uint32_t ics() const override;
  MotorOutputs stops(unsigned ic) const override;
  Tick next_event() const override { return events_.empty() ? kNever : events_.begin()->first; }
  void changed(Tick tick, unsigned ic, const MotorOutputs& before, const MotorOutputs& after) override;
  bool step(Tick now, MotorInputPins& inputs) override;
  void add(const PinEvent& e) { events_.insert({e.tick, e}); }

 private:
  std::vector<unsigned> ics_;
  std::multimap<Tick, PinEvent> events_;

 public:
  std::vector<Seen> seen;
  std::function<void(Tick, unsigned channel)> on_pulse;  // the rise of a PFM pulse; may add() later events
};

class ChannelHost {
 public:
  explicit ChannelHost(BenchContext& bench);
  ~ChannelHost();
  ChannelHost(const ChannelHost&) = delete;
  ChannelHost& operator=(const ChannelHost&) = delete;

  unsigned channels() const { return static_cast<unsigned>(boards_.size()); }
  ChannelScoreboard& board(unsigned channel) { return *boards_.at(channel); }
  PinPlayer& player() { return player_; }
  unsigned pick(unsigned count) { return static_cast<unsigned>(random_() % count); }
  std::mt19937_64& random() { return random_; }
  BenchContext& bench() { return bench_; }
  Tick now() const { return bench_.bus.now(); }
  Tick period() const { return period_; }

  // Names: servo-ic.md 1.2, 1.4, 2.1.
  unsigned ic(unsigned channel) const { return ics_.at(channel / kChannels); }
  unsigned i_variable(unsigned channel, unsigned k) const;         // I7mnk
  std::uint32_t address(unsigned channel, unsigned offset) const;  // of a word of the channel
  std::string name(unsigned channel) const;                        // servo_ic0.ch1

  // Commands, with no pin moving. ------------------------------------------------------------------------------------------
  std::string ask(const std::string& line);  // data lines joined by '|'
  void expect(const std::string& line, const std::string& answer);
  std::vector<long> numbers(const std::string& line);            // data lines as numbers
  void assign(unsigned k, const std::vector<unsigned>& values);  // I7mnk of every channel; shorter lists leave the rest
  void define(unsigned number, char space, unsigned offset, const std::string& part);  // M(number + 100 n) of channel n = 0, 1, ...
  std::vector<long> read(unsigned number);                                             // these M-variables of all channels

  // SCLK divider 2^n of all ICs; finds where its edges are with one edge of A of each IC's first channel and back.
  void sclk(unsigned n);

  // Levels of one channel from tick `start` on: each call of `next` gives the pins and the ticks that they stay.
  struct Hold {
    std::uint16_t pins;
    Tick ticks;
  };
  void drive(unsigned channel, Tick start, const std::vector<Hold>& holds);
  void play();  // runs until all levels are played and everything is quiet again; scoreboards follow
  std::uint16_t pins(unsigned channel) const { return pins_.at(channel); }

  // What the pins did since the last verdict against the scoreboards. The detail says how much there was.
  struct Difference {
    std::string text;  // empty: none
    std::size_t events;
  };
  Difference counts(unsigned channel);
  Difference equs(unsigned channel);

  // Tick of the last fall of SERVO before the last read of a word on Port A, and what was read.
  struct BusRead {
    Tick tick = -1;
    std::uint32_t data = 0;
    Tick servo = -1, end = -1;  // `end`: the data was taken
  };
  BusRead last_read(bool x, std::uint32_t address) const;

 private:
  void cycle(const PortACycle& c);
  void follow();  // scoreboards up to now

  BenchContext& bench_;
  std::mt19937_64 random_;
  std::vector<unsigned> ics_;
  PinPlayer player_;
  std::vector<std::unique_ptr<ChannelScoreboard>> boards_;
  std::vector<std::uint16_t> pins_;
  std::vector<Tick> servo_falls_;
  std::map<std::uint32_t, BusRead> reads_;  // key 2 * address + x
  Tick period_ = 12, played_ = 0;
};

}  // namespace brick
