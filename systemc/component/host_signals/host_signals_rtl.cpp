// The Verilated host signals behind the pins of their component.
#include "Vhost_signals.h"
#include "Vhost_signals___024root.h"
#include "systemc/component/host_signals/host_signals_registers.h"
#include "systemc/component/host_signals/host_signals_words.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/verilated_chip.h"

namespace brick::component {
namespace {
using namespace host_signals_words;

struct Ports : PortMap {
  static void access(Vhost_signals& v, unsigned, bool on, const Face& face) {
    const Cycle& c = face.cycle;
    v.wr_i = on && c.write && c.address == kSignalsByte;
    v.ctrl_wr_i = on && c.write && c.address == kControlByte;
    v.wdata_i = c.value & 0xF;
  }
  static std::uint32_t read(const Vhost_signals& v, unsigned, unsigned address) {
    return address == kSignalsByte ? v.rdata_o : v.ctrl_o;
  }
};

}  // namespace

std::unique_ptr<Chip> rtl_host_signals(std::uint64_t seed) {
  return std::make_unique<VerilatedChip<Vhost_signals, Ports>>(seed);
}

}  // namespace brick::component
