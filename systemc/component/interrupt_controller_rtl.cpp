// The Verilated interrupt controller behind the pins of its component.
#include "Vinterrupt_pins.h"
#include "Vinterrupt_pins___024root.h"
#include "systemc/component/interrupt_controller_words.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/verilated_chip.h"

namespace brick::component {
namespace {
using namespace interrupt_controller_words;
using Module = Vinterrupt_pins;

struct Ports {
  static constexpr unsigned kOutputWords = 2;

  static void drive(Module& v, const PinWords& in) {
    v.line_i = static_cast<CData>(in[0] >> kLine & 0xFF);
    v.reset_i = bit(in, 0, kResetDrv);
    v.rst_ni = bit(in, 0, kRstN);
  }
  static void sample(const Module& v, PinWords& out) {
    out[0] = v.ist_o | std::uint32_t{v.sig_o} << 8 | std::uint32_t{v.msk_o} << 16 | std::uint32_t{v.elr_o} << 24;
    out[1] = std::uint32_t{v.irq_o} << kIrq;
  }
  static void access(Module& v, unsigned, bool on, const Face& face) {
    v.wr_i = on && face.cycle.write;
    v.addr_i = static_cast<CData>(face.cycle.address & 3);
    v.wdata_i = static_cast<CData>(face.cycle.value);
  }
  static std::uint32_t read(const Module& v, unsigned, unsigned) { return v.rdata_o; }
};

}  // namespace

std::unique_ptr<Chip> rtl_interrupt_controller(std::uint64_t seed) {
  return std::make_unique<VerilatedChip<Module, Ports>>(seed);
}

}  // namespace brick::component
