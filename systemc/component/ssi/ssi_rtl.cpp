// The Verilated serial encoder inputs behind the pins of their component.
#include "Vssi.h"
#include "Vssi___024root.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/ssi/ssi_words.h"
#include "systemc/component/verilated_chip.h"

namespace brick::component {
namespace {
using namespace ssi_words;

struct Ports : PortMap {
  static void access(Vssi& v, unsigned, bool on, const Face& face) {
    const Cycle& c = face.cycle;
    v.sel_i = on;
    v.we_i = on && c.write;
    v.rd_i = on && !c.write;
    v.x_i = (c.address & 4) != 0;
    v.addr_i = static_cast<CData>(c.address / 8 & 63);
    v.wdata_i = c.value & 0xFFFFFF;
  }
  static std::uint32_t read(const Vssi& v, unsigned, unsigned) { return v.rdata_o; }
  // Without the strobe, which holds the high part.
  static std::uint32_t peek(Vssi& v, unsigned, unsigned address) {
    v.sel_i = true;
    v.x_i = (address & 4) != 0;
    v.addr_i = static_cast<CData>(address / 8 & 63);
    v.eval();
    const std::uint32_t value = v.rdata_o;
    v.sel_i = false;
    v.eval();
    return value;
  }
};

}  // namespace

std::unique_ptr<Chip> rtl_ssi(std::uint64_t seed) { return std::make_unique<VerilatedChip<Vssi, Ports>>(seed); }

}  // namespace brick::component
