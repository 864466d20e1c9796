// How a Verilated board takes its inputs: packed words, laid out as the ports of rtl/board/board_sim.sv unpack them.
// The one place in C++ that knows this layout; `InputLayout.*` (testbench/unit/cosim) holds it to the RTL's, field by
// field. Free of Verilator, so whoever verilates board_sim drives it by this.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "systemc/core/board_pins.h"
#include "systemc/core/motor_pins.h"

namespace brick {

template <class Group, class Value>
struct InputField {
  std::string_view name;
  Value Group::*pin;
  unsigned word, lsb, width;
};
template <class Group, class Value>
InputField(std::string_view, Value Group::*, unsigned, unsigned, unsigned) -> InputField<Group, Value>;

constexpr unsigned kBoardInputWords = 8;
using BoardInputWords = std::array<std::uint32_t, kBoardInputWords>;

// rst_n is apart: it is asynchronous, a port of its own.
inline constexpr std::tuple kInputFields{InputField{"pa_addr", &BoardInputs::pa_addr, 0, 0, 19},
                                         InputField{"pa_aa", &BoardInputs::pa_aa, 0, 19, 4},
                                         InputField{"pa_x", &BoardInputs::pa_x, 0, 23, 1},
                                         InputField{"pa_int", &BoardInputs::pa_int, 0, 24, 1},
                                         InputField{"pa_rd_n", &BoardInputs::pa_rd_n, 0, 25, 1},
                                         InputField{"pa_wr_n", &BoardInputs::pa_wr_n, 0, 26, 1},
                                         InputField{"pa_wdata", &BoardInputs::pa_wdata, 1, 0, 24},
                                         InputField{"isa_sa", &BoardInputs::isa_sa, 2, 0, 20},
                                         InputField{"isa_ior_n", &BoardInputs::isa_ior_n, 2, 20, 1},
                                         InputField{"isa_iow_n", &BoardInputs::isa_iow_n, 2, 21, 1},
                                         InputField{"isa_memr_n", &BoardInputs::isa_memr_n, 2, 22, 1},
                                         InputField{"isa_memw_n", &BoardInputs::isa_memw_n, 2, 23, 1},
                                         InputField{"isa_aen", &BoardInputs::isa_aen, 2, 24, 1},
                                         InputField{"isa_sbhe_n", &BoardInputs::isa_sbhe_n, 2, 25, 1},
                                         InputField{"isa_sd", &BoardInputs::isa_sd, 3, 0, 16},
                                         InputField{"jpan", &BoardInputs::jpan, 3, 16, 16},
                                         InputField{"fitted", &BoardInputs::fitted, 4, 0, 22},
                                         InputField{"macro_gate", &BoardInputs::macro_gate, 4, 22, 4},
                                         InputField{"dpram_small", &BoardInputs::dpram_small, 4, 26, 1},
                                         InputField{"jpan_fitted", &BoardInputs::jpan_fitted, 4, 27, 1},
                                         InputField{"ext_clock", &BoardInputs::ext_clock, 4, 28, 1},
                                         InputField{"ext_phase", &BoardInputs::ext_phase, 4, 29, 1},
                                         InputField{"ext_servo", &BoardInputs::ext_servo, 4, 30, 1},
                                         InputField{"line_select", &BoardInputs::line_select, 5, 0, 12},
                                         InputField{"isa_la", &BoardInputs::isa_la, 6, 0, 7},
                                         InputField{"isa_resetdrv", &BoardInputs::isa_resetdrv, 6, 7, 1},
                                         InputField{"io_base", &BoardInputs::io_base, 6, 8, 8},
                                         InputField{"window", &BoardInputs::window, 6, 16, 10},
                                         InputField{"io_decode16", &BoardInputs::io_decode16, 6, 26, 1},
                                         InputField{"window_flat", &BoardInputs::window_flat, 6, 27, 1},
                                         InputField{"slot8", &BoardInputs::slot8, 6, 28, 1},
                                         InputField{"mi1", &BoardInputs::mi1, 5, 12, 1},
                                         InputField{"mi2", &BoardInputs::mi2, 5, 13, 1},
                                         InputField{"axexp0", &BoardInputs::axexp0, 5, 14, 1},
                                         InputField{"axexp1", &BoardInputs::axexp1, 5, 15, 1},
                                         InputField{"pic_8259", &BoardInputs::pic_8259, 5, 16, 1},
                                         InputField{"pwr_good", &BoardInputs::pwr_good, 7, 0, 1}};

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

// Pins of channel n from bit 12 n up, ADC A from 48, ADC B from 52.
constexpr std::uint64_t pack(const MotorInputs& in) {
  std::uint64_t word = std::uint64_t{in.adc_a & 0xFu} << 48 | std::uint64_t{in.adc_b & 0xFu} << 52;
  for (unsigned n = 0; n < kChannels; ++n) word |= std::uint64_t{in.pins[n] & 0xFFFu} << 12 * n;
  return word;
}

template <class Ports>
void drive_motor(Ports& ports, unsigned ic, const MotorInputs& in) {
  ports.motor_i[ic] = pack(in);
}

}  // namespace brick
