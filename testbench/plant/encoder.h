// An incremental encoder with index and hall tracks: its pins as a function of the position. What is wrong with the
// disc or with the wires (phase error, dark lines, A and B together, cut wires) belongs to the position too; noise
// comes from line_noise.h. Going up, A leads B: {A,B} = 00 10 11 01, which counts up with I7mn0 = 3 (x4 CW) and down
// with the default of 7. docs/plant.md
#pragma once

#include <cstdint>
#include <vector>

#include "systemc/core/motor_pins.h"
#include "testbench/plant/position_grid.h"

namespace brick::plant {

struct EncoderParameters {
  unsigned lines = 1000;     // per revolution (index to index), 4 counts each
  unsigned index_at = 2;     // count at which the index begins; A and B are both high at counts 2 mod 4
  unsigned index_width = 1;  // 1..4 counts: a quarter to a whole cycle
  std::int64_t b_late = 0;   // phase error of B, a_long: A's pulse too long; units, less than a count either way
  std::int64_t a_long = 0;
  std::vector<unsigned> dark_lines;   // lines (0 .. lines-1) whose pulse of A is missing
  std::vector<unsigned> joint_lines;  // lines at which A and B rise together: an illegal transition
  unsigned pole_pairs = 0;            // hall periods per revolution
  std::int64_t hall_offset = 0;       // units
  // What U, V, W, T carry: nothing (pulled up); halls on U, V, W; the complements of A and B as the encoder-loss
  // circuit wants them (U = A, T = /A, V = B, W = /B). kHallsOnAbc: no quadrature, the halls are on A, B, C (I7mn0 =
  // 11).
  enum class Wiring { kNone, kHalls, kComplements, kHallsOnAbc } wiring = Wiring::kNone;
};

class Encoder {
 public:
  static constexpr std::uint16_t kPins =
      1u << kEncA | 1u << kEncB | 1u << kEncC | 1u << kU | 1u << kV | 1u << kW | 1u << kT;

  explicit Encoder(const EncoderParameters& parameters);

  // Levels at kPins, bits as ChannelPin; the others are 0.
  std::uint16_t pins(std::int64_t position) const;
  const std::vector<PositionGrid>& grids() const { return grids_; }
  std::int64_t units_per_revolution() const { return revolution_; }

  // Wires that are cut, bits as ChannelPin: the input shows what nothing connected shows.
  void cut(std::uint16_t wires) { cut_ = wires & kPins; }

 private:
  bool inside(std::int64_t position, std::int64_t from, std::int64_t width, std::int64_t period) const;
  unsigned halls(std::int64_t position) const;  // {U, V, W}

  EncoderParameters par_;
  std::int64_t revolution_;
  std::vector<bool> dark_, joint_;
  std::vector<PositionGrid> grids_;
  bool whole_counts_ = false;  // no edge is off its count
  std::uint16_t cut_ = 0;
};

}  // namespace brick::plant
