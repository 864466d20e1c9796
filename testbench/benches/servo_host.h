// A host that commands the channels of servo ICs: their numbers, addresses and variables, and lines sent to all of
// them. What the benches of inputs (channel_host.h) and of outputs (output_host.h) share.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "app/bench.h"
#include "rtl/regs/brick_regs.hpp"

namespace brick {

namespace word = regs::servo_channel;  // words of a channel and their bits

// Bits that are no field of their own, and those from the lowest of one field to the highest of another: some
// I-variables cover several.
constexpr regs::Field bits(unsigned lsb, unsigned width) {
  regs::Field field{};
  field.lsb = lsb;
  field.width = width;
  return field;
}
constexpr regs::Field span(regs::Field low, regs::Field high) { return bits(low.lsb, high.lsb + high.width - low.lsb); }

// The edge at which a write takes place and a read takes its sample: the third of clk_ref after the strobe falls
// (host-bus:2.6) at the board, which with --skew is later than at the CPU.
inline Tick bus_edge(const PortACycle& c, const Machine& machine) {
  const Tick low = fs_to_tick(c.strobe_low + machine.skew().of_strobe(c.write));
  return (low + kTicksPerRef - 1) / kTicksPerRef * kTicksPerRef + 2 * kTicksPerRef;
}

// Channels are numbered 0, 1, ... over the first two fitted servo ICs in rising order; `place` is 0 or 1. Names:
// servo-ic:1.2, servo-ic:1.4, servo-ic:2.1.
class ServoHost {
 public:
  ServoHost(BenchContext& bench, std::uint64_t seed);
  virtual ~ServoHost() = default;
  ServoHost(const ServoHost&) = delete;
  ServoHost& operator=(const ServoHost&) = delete;

  const std::vector<unsigned>& fitted() const { return ics_; }
  unsigned places() const { return static_cast<unsigned>(ics_.size()); }
  unsigned channels() const { return places() * kChannels; }
  unsigned ic(unsigned place) const { return ics_.at(place); }
  unsigned i_global(unsigned place, unsigned k) const;     // I7m0k
  unsigned i_channel(unsigned channel, unsigned k) const;  // I7mnk
  std::uint32_t base(unsigned place) const;                // address of the IC
  std::uint32_t address(unsigned channel, const regs::Register& word) const;
  std::string name(unsigned channel) const;  // servo_ic0.ch1
  // Ticks by which an IC is behind the nets PHASE and SERVO: two flip-flops (servo-ic:5.1/6), but the one that drives
  // them is ahead (servo-ic:5.1/11).
  Tick behind(unsigned place) const;
  std::uint32_t pin(const MotorField& pin, unsigned channel) const {
    return bench_.machine.motor_outputs(ic(channel / kChannels)).get(pin, channel % kChannels);
  }

  std::string ask(const std::string& line);  // data lines joined by '|'
  void expect(const std::string& line, const std::string& answer);
  void say(const std::vector<std::string>& words);     // several to a line; no answer expected
  std::vector<long> numbers(const std::string& line);  // data lines as numbers
  // M(number + 100 n) of channel n = 0, 1, ... -> a word, or a field of it.
  static constexpr regs::Field kWord = bits(0, 24), kCommand = bits(8, 16);  // of OUT A, B, C: servo-ic:5.11
  void define(unsigned number, const regs::Register& word, bool is_signed = false, regs::Field part = kWord);

  unsigned pick(unsigned count) { return static_cast<unsigned>(random_() % count); }
  std::mt19937_64& random() { return random_; }
  Tick now() const { return bench_.bus.now(); }
  void wait(Tick ticks) { bench_.bus.wait(ticks); }
  BenchReport& report() { return bench_.report; }
  BenchContext& bench() { return bench_; }

 private:
  virtual void before_command() {}

  BenchContext& bench_;
  std::mt19937_64 random_;
  std::vector<unsigned> ics_;
};

}  // namespace brick
