// The Verilated choices_bench, one edge of clk_ref at a time. The Verilated header stays in the .cpp.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "systemc/servo_ic/channel_compare.h"

namespace brick {

class RtlChoices {
 public:
  struct Inputs {
    bool ce = true;
    // compare
    ChannelPosition position;
    bool fine = false, other = false;
    unsigned we = 0;
    std::uint32_t wdata = 0;
    // decode
    bool ready = true;
    unsigned mode = 0, abc = 0;
    bool pulse = false, pulse_down = false;
    // ADC
    bool sample = false, phase_fall = false, data = false;
    unsigned bit = 0;
  };
  struct Compare {
    bool equ;
    std::uint32_t a, b;
    bool operator==(const Compare& o) const { return equ == o.equ && a == o.a && b == o.b; }
  };
  struct Decode {
    bool count, down, error;  // down as 0 where nothing counts
    bool operator==(const Decode& o) const { return count == o.count && down == o.down && error == o.error; }
  };
  Inputs in;

  RtlChoices();
  ~RtlChoices();
  void edge();  // what decode() says of it was there before it

  // `value`: of the parameter, 0 or 1.
  Compare compare(unsigned value) const;
  Decode decode(unsigned value) const { return decode_[value]; }
  std::uint32_t adc(unsigned latency) const;  // 0, 4 or 6

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::array<Decode, 2> decode_{};
};

}  // namespace brick
