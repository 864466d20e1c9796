// A host with its hands on the motor side: plays levels on the input pins of all channels at once, and keeps a
// scoreboard for each of them (testbench/checkers/channel_scoreboard.h) that sees the same levels. What the channel
// benches share.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "systemc/machine/motor_peer.h"
#include "testbench/benches/servo_host.h"
#include "testbench/checkers/channel_scoreboard.h"

namespace brick {

struct PortACycle;

struct PinEvent {
  Tick tick;
  unsigned channel;
  std::uint16_t pins;
};

// A and B one step on: 00, 10, 11, 01 of {A, B} when A leads, else back.
constexpr std::uint16_t wheel_step(std::uint16_t pins, bool a_leads) {
  const bool equal = (pins >> kEncA & 1) == (pins >> kEncB & 1);
  return static_cast<std::uint16_t>(pins ^ (equal == a_leads ? 1u << kEncA : 1u << kEncB));
}

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

class ChannelHost : public ServoHost {
 public:
  explicit ChannelHost(BenchContext& bench);
  ~ChannelHost() override;

  ChannelScoreboard& board(unsigned channel) { return *boards_.at(channel); }
  PinPlayer& player() { return player_; }
  Tick period() const { return period_; }

  // Commands go with no pin moving.
  void assign(unsigned k, const std::vector<unsigned>& values);  // I7mnk of every channel; shorter lists leave the rest
  std::vector<long> read(unsigned number);  // the M-variables `number`, number + 100, ... of all channels

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

  // The background's last read of a word on Port A, and the tick of the last fall of SERVO that it shows.
  struct BusRead {
    Tick tick = -1;
    std::uint32_t data = 0;
    Tick servo = -1, end = -1;  // `end`: the sample was taken
  };
  BusRead last_read(unsigned channel, const regs::Register& word) const;

 private:
  void cycle(const PortACycle& c);
  void before_command() override { follow(); }
  void follow();  // scoreboards up to now

  PinPlayer player_;
  std::vector<std::unique_ptr<ChannelScoreboard>> boards_;
  std::vector<std::uint16_t> pins_;
  std::vector<Tick> servo_falls_;
  std::map<std::uint32_t, BusRead> reads_;  // key 2 * address + x
  Tick period_ = 12, played_ = 0;
};

}  // namespace brick
