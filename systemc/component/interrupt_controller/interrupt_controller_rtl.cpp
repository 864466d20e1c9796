// The Verilated interrupt controller behind the pins of its component.
#include "Vinterrupt_pins.h"
#include "Vinterrupt_pins___024root.h"
#include "systemc/component/interrupt_controller/interrupt_controller_words.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/verilated_chip.h"

namespace brick::component {
namespace {
using namespace interrupt_controller_words;
using Module = Vinterrupt_pins;

struct Ports : PortMap {
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
