// The Verilated MACRO IC behind the pins of its component.
#include "Vmacro_ic.h"
#include "Vmacro_ic___024root.h"
#include "systemc/component/macro_ic/macro_ic_words.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/verilated_chip.h"

namespace brick::component {
namespace {
using namespace macro_ic_words;

struct Ports : PortMap {
  static void access(Vmacro_ic& v, unsigned, bool on, const Face& face) {
    const Cycle& c = face.cycle;
    v.sel_i = on;
    v.we_i = on && c.write;
    v.x_i = (c.address & 4) != 0;
    v.addr_i = static_cast<CData>(c.address / 8 & 63);
    v.wdata_i = c.value & 0xFFFFFF;
  }
  static std::uint32_t read(const Vmacro_ic& v, unsigned, unsigned) { return v.rdata_o; }
};

}  // namespace

std::unique_ptr<Chip> rtl_macro_ic(std::uint64_t seed) {
  return std::make_unique<VerilatedChip<Vmacro_ic, Ports>>(seed);
}

}  // namespace brick::component
