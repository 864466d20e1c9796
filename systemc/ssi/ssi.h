// Model of rtl/ssi/ssi.sv: serial encoder inputs of a Brick (eight channels) or a Geo PMAC (two). It wakes for the
// edges of the serial clocks and for nothing else: a net that moves while no channel waits for it costs nothing.
#pragma once

#include <array>
#include <cstdint>

#include <systemc>

#include "systemc/core/model_block.h"
#include "systemc/ssi/ssi_word.h"

namespace brick {

class Ssi final : public sc_core::sc_module, public ModelBlock {
 public:
  static constexpr unsigned kGroups = 2, kChannelsEach = 4, kChannels = kGroups * kChannelsEach;

  static constexpr unsigned kPage = 0x3F;  // registers are words of a page of 64 addresses

  explicit Ssi(const sc_core::sc_module_name& name) : sc_module(name) {}

  bool geo = false;                 // strap: which product
  bool phase = true, servo = true;  // nets
  std::uint8_t data = 0xFF;         // pins, bit n - 1 for channel n

  std::uint8_t clk() const { return clk_; }

  // Registers: words of the page of 64 addresses, as they stand. A write belongs to the edge that has been executed
  // last, a read that is taken to the one that is executed next.
  std::uint32_t read(bool x, unsigned address) const;
  void read_taken(bool x, unsigned address);
  void write(bool x, unsigned address, std::uint32_t value);

  Tick next_event() const override;
  void advance(Tick t) override;
  void reset(Tick t) override;

 private:
  enum class State { kIdle, kDelay, kLow, kHigh, kRest };
  struct Channel {
    std::uint32_t control = 0, shift = 0, position = 0, high = 0;
    std::uint8_t refused = 0;
    unsigned rises{};  // left
    bool active{}, first{}, odd{}, parity_error{};
    bool gray{};              // of a Geo PMAC that of the last mode that was on
    Tick shot_ends = kNever;  // edge that takes the enable bit away
  };
  struct Group {
    std::uint32_t word = 0;
    State state = State::kIdle;
    Tick begin{};           // of the frame
    std::int64_t cycles{};  // from there to the next change of state
    Tick next = kNever;     // when that is
    unsigned periods{};     // of the delay, left
    unsigned loads{};       // channels whose word is whole: the next edge loads them
    std::array<Channel, kChannelsEach> channel;
  };
  enum class Place { kControl, kPosition, kHigh, kRefused, kTiming, kNone };
  struct Where {
    Place place;
    unsigned channel;
  };

  Where where(bool x, unsigned address) const;
  ssi::Control control(const Channel& c) const { return {geo, c.control}; }
  ssi::Timing timing(const Group& g) const { return {geo, g.word}; }
  bool nets_moved() const { return phase != phase_ || servo != servo_; }
  bool triggered(const Group& g) const;  // by how the nets have moved
  void pass(Tick edges);                 // in which nothing but the synchronisers moves
  void end_shots(Tick t);
  void edge(Tick t, unsigned group);
  void enter(Group& g, State state, std::int64_t cycles);
  void start(Tick t, Group& g);
  void fall(unsigned group);
  void rise(unsigned group);
  void load(Group& g);

  std::array<Group, kGroups> group_;
  std::uint8_t clk_{}, data1_{}, data2_{};  // pins out; pins in, two stages
  bool phase_{}, servo_{};                  // as the last edge saw them
  Tick now_{};
};

}  // namespace brick
