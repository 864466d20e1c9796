// The encoder bench: its host, what all its parts use, and the parts. How the lines A, B, C are counted is in
// encoder.cpp; what takes time, in encoder_timers.cpp.
#pragma once

#include "testbench/benches/channel_host.h"
#include "testbench/benches/encoder_moves.h"

namespace brick {

class EncoderBench {
 public:
  explicit EncoderBench(BenchContext& b);
  void run();

 private:
  static constexpr unsigned kA = EncoderMoves::kA, kB = EncoderMoves::kB, kC = EncoderMoves::kC;
  static constexpr Tick kServo = 4 * (2 * 6527 + 3);  // factory setting
  // M-variables, + 100 for each further channel.
  static constexpr unsigned kStatus = 100, kPhase = 101, kServoWord = 102, kT1 = 103, kT2 = 104, kError = 105,
                            kReset = 106, kLoss = 107, kOutC = 108;

  void define();
  void all(unsigned number, long value);  // one M-variable of all channels
  void set_modes(const std::vector<unsigned>& modes);
  void clear_errors();
  void words(const std::string& name, unsigned channels);  // what is read while nothing moves
  void judge_counts(const std::string& name, unsigned least);

  void cover_ways(unsigned mode, const std::vector<ChannelScoreboard::Change>& counts);
  void random_movement(const std::vector<unsigned>& modes);
  void illegal_moves();
  void counter_reset();
  void encoder_loss();

  void timers();
  void own_pulses();
  void mldt();
  void fraction();
  void rest(const char* name, long even_channels, long odd_channels);
  Tick latched(unsigned i, Tick fall) const;  // when the timers are latched, after SERVO has fallen at `fall`
  long since_count(unsigned i, Tick tick);

  BenchContext& b_;
  ChannelHost host_;
  EncoderMoves moves_{host_};
  unsigned errors_ = 0;  // channels with a count error when words() looked
};

}  // namespace brick
