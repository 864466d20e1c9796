// How a Verilated board takes its inputs: packed words, laid out by the rows of rtl/pins as rtl/board/board_sim.sv
// unpacks them; `InputLayout.*` (testbench/unit/cosim) holds this to the RTL, field by field. Free of Verilator, so
// whoever verilates board_sim drives it by this.
#pragma once

#include <array>
#include <cstdint>

#include "rtl/pins/board_inputs.hpp"
#include "systemc/core/board_pins.h"
#include "systemc/core/motor_pins.h"

namespace brick {

using BoardInputWords = std::array<std::uint32_t, kBoardInputWords>;

constexpr BoardInputWords pack(const BoardInputs& in) {
  BoardInputWords words{};
  std::apply(
      [&](const auto&... f) {
        ((words[f.word] |= (static_cast<std::uint32_t>(in.*f.pin) & pin_mask(f.width)) << f.lsb), ...);
      },
      kInputFields);
  return words;
}

// `ports`: a Verilated board_sim.
template <class Ports>
void drive(Ports& ports, const BoardInputs& in) {
  const BoardInputWords words = pack(in);
  ports.rst_ni = in.rst_n;
  for (unsigned i = 0; i < kBoardInputWords; ++i) ports.inputs_i[i] = words[i];
}

constexpr std::uint64_t pack(const MotorInputs& in) {
  std::uint64_t word = std::uint64_t{in.adc_a & 0xFu} << kMotorAdcALsb | std::uint64_t{in.adc_b & 0xFu}
                                                                             << kMotorAdcBLsb;
  for (unsigned n = 0; n < kChannels; ++n)
    word |= std::uint64_t{in.pins[n] & 0xFFFu} << (kMotorPinsLsb + kMotorPinsStep * n);
  return word;
}

template <class Ports>
void drive_motor(Ports& ports, unsigned ic, const MotorInputs& in) {
  ports.motor_i[ic] = pack(in);
}

}  // namespace brick
