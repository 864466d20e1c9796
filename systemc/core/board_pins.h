// The pins of the controller board, as every engine shows them: the Verilated RTL (rtl/board/board_sim.sv packs the
// same words), the SystemC model, and lock-step, which compares the packed words tick by tick. A pin is a row of
// rtl/pins/board.pins. All outputs are
// registered: they change only at a clock edge, or without one when a strobe ends. All inputs are sampled by the first
// clock edge after they were applied. Active-low pins end in _n.
#pragma once

#include <array>
#include <cstdint>

#include "rtl/pins/board_pins.hpp"

namespace brick {

// Inputs, in groups by who drives them. Whoever drives or samples a group takes it as a whole.

struct IsaPins : IsaLines {                  // ISA / PC104 host bus (host-bus:3.4)
  void set_address(std::uint32_t address) {  // of 24 bits; I/O has 16
    isa_la = static_cast<std::uint8_t>(address >> 17 & 0x7F);
    isa_sa = address & 0xFFFFF;
  }
};

struct HostInputs : IsaPins, IsaStraps, Straps, ConnectorPins, PanelReset {};  // all but what the CPU drives

struct BoardInputs : PortAPins, HostInputs {
  bool rst_n = false;
};

constexpr std::uint32_t pin_mask(unsigned width) { return width >= 32 ? ~0u : (1u << width) - 1; }

struct BoardOutputs {
  std::array<std::uint32_t, kBoardOutputWords> w{};

  constexpr std::uint32_t get(const PinField& f) const { return (w[f.word] >> f.lsb) & pin_mask(f.width); }
  constexpr void set(const PinField& f, std::uint32_t value) {
    w[f.word] = (w[f.word] & ~(pin_mask(f.width) << f.lsb)) | ((value & pin_mask(f.width)) << f.lsb);
  }
  bool operator==(const BoardOutputs& o) const { return w == o.w; }
  bool operator!=(const BoardOutputs& o) const { return w != o.w; }
  // True when any bit selected by `select` differs.
  bool differs(const BoardOutputs& o, const BoardOutputs& select) const {
    std::uint32_t bits = 0;  // without branches
    for (unsigned i = 0; i < kBoardOutputWords; ++i) bits |= (w[i] ^ o.w[i]) & select.w[i];
    return bits != 0;
  }
};

// A selection of output pins, to stop a run at their next change.
template <class... Fields>
constexpr BoardOutputs select_pins(const Fields&... fields) {
  BoardOutputs s;
  (s.set(fields, ~0u), ...);
  return s;
}

}  // namespace brick
