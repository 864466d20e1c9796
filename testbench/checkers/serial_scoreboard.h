// The serial rules (servo-ic:5.13/1 to servo-ic:5.13/6, servo-ic:5.14/1 to servo-ic:5.14/3): 24 bits from each rise of
// PHASE on, first the highest, one a clock, changed with the falling edge and taken with the rising one; then the clock
// stops and the strobe keeps its last bit. Finds the streams in what the pins did, and says what the words on both ends
// must be.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "systemc/core/ticks.h"

namespace brick {

struct SerialLevel {
  Tick tick;
  bool clock, strobe;
  unsigned data;  // one bit a line
};

struct SerialStream {
  Tick phase = 0;            // the rise of PHASE before it
  Tick first = 0, last = 0;  // rise of the clock for bits 23 and 0
  std::uint32_t strobe = 0;
  std::vector<std::uint32_t> data{};      // of each line
  std::vector<std::uint32_t> received{};  // what a converter has in its shift register as the strobe falls
  Tick strobe_high = 0;                   // ticks from the first rise of the strobe to its next fall
};

struct SerialRecord {
  std::vector<SerialStream> streams{};
  std::string error{};  // first break of the rules, or ""
};

// Streams of all PHASE periods that lie wholly between the first and the last tick of `phase_rises`. `bit`: ticks of a
// clock period.
SerialRecord serial_streams(const std::vector<SerialLevel>& levels, const std::vector<Tick>& phase_rises, Tick bit,
                            unsigned lines);

// What a DAC line carries for a command: 18 bits in 23..6. The inversion (I7mn7 bit 0) turns those 18.
std::uint32_t dac_stream(std::uint32_t command, bool invert);
constexpr std::uint32_t kDacBits = 0xFFFFC0;

// What Y:+5 or Y:+6 reads after an ADC has sent these 24 bits: four are dropped, 18 are the value.
std::uint32_t adc_word(std::uint32_t sent);

// Bits between the leading edge of a DAC strobe word and its latch edge, 0 if it is no such word: 0, ones, zeros.
unsigned dac_strobe_bits(std::uint32_t strobe);

}  // namespace brick
