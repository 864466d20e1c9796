// The Verilated choices_bench, one edge of clk_ref at a time.
#pragma once

#include <array>
#include <cstdint>

#include "systemc/servo_ic/channel_compare.h"
#include "testbench/unit/rtl/rtl_block.h"

namespace brick {

struct ChoicesInputs {
  bool ce = true;
  // compare
  ChannelPosition position;
  bool fine = false, other = false;
  unsigned we = 0;
  std::uint32_t wdata = 0;
  // decode
  bool ready = true, hold = false;
  unsigned mode = 0, abc = 0;
  bool pulse = false, pulse_down = false;
  // ADC
  bool sample = false, phase_fall = false, data = false;
  unsigned bit = 0;
};

// Of each value of a parameter.
struct ChoicesOutputs {
  struct Compare {
    bool equ;
    std::uint32_t a, b;
    bool operator==(const Compare& o) const { return equ == o.equ && a == o.a && b == o.b; }
  };
  struct Decode {
    bool count, down, error;  // down as 0 where nothing counts
    bool operator==(const Decode& o) const { return count == o.count && down == o.down && error == o.error; }
  };
  std::array<Compare, 2> compare;
  std::array<Decode, 2> decode;
  std::array<std::uint32_t, 3> adc;
};

class RtlChoices : public RtlBlock<ChoicesInputs, ChoicesOutputs> {
 public:
  using Inputs = ChoicesInputs;
  using Compare = ChoicesOutputs::Compare;
  using Decode = ChoicesOutputs::Decode;

  RtlChoices();
  void edge();  // what decode() says of it was there before it

  // `value`: of the parameter, 0 or 1.
  Compare compare(unsigned value) const { return outputs().compare[value]; }
  Decode decode(unsigned value) const { return decode_[value]; }
  std::uint32_t adc(unsigned latency) const { return outputs().adc[latency == 0 ? 0 : latency == 4 ? 1 : 2]; }

 private:
  std::array<Decode, 2> decode_{};
};

}  // namespace brick
