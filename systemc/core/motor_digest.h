// What an engine tells of the motor side without showing each edge, which would cost it an event: the serial streams of
// the converters as words, the on-times of the PWM switches as sums. Both say what the pins show; an engine of pins
// alone (the RTL, and lock-step with it) has no digest.
#pragma once

#include <array>
#include <cstdint>

#include "systemc/core/motor_pins.h"
#include "systemc/core/ticks.h"

namespace brick {

constexpr unsigned kSerialBits = 24;                              // of a stream
using ConverterWords = std::array<std::uint32_t, 2 * kChannels>;  // A of the four channels, then B; the first bit is 23

struct PwmTimes {
  static constexpr unsigned kPhases = 3;
  std::array<Tick, kPhases> balance{};  // how long the upper switch has been on, less how long the lower one has
  std::uint64_t shorts = 0;             // how often both of a phase came to be on
};

class MotorDigest {
 public:
  virtual ~MotorDigest() = default;

  // The last 24 bits that the DAC lines of an IC had at rising edges of their clock.
  virtual ConverterWords dac_lines(unsigned ic) = 0;

  struct AdcStream {
    std::int64_t clocks = 0;   // falling edges of the ADC clock so far
    std::uint32_t strobe = 0;  // the word on the strobe
    bool first = false;        // the present bit is the first of it
    Tick end = 0;              // edge at which the last one ends, with the clock as it is
  };
  virtual AdcStream adc_stream(unsigned ic) = 0;
  // From the present bit on the ADC lines carry these words, then 0; in place of the pins (MotorInputs::adc_a, adc_b).
  virtual void send_adc(unsigned ic, const ConverterWords& words) = 0;
  virtual unsigned adc_lines(unsigned ic, bool b) = 0;  // as they stand, bit n-1 for channel n

  virtual PwmTimes pwm_times(unsigned ic, unsigned channel) = 0;  // up to now
};

}  // namespace brick
