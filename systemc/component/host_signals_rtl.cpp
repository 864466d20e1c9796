// The Verilated host signals behind the pins of their component.
#include "Vhost_signals.h"
#include "Vhost_signals___024root.h"
#include "systemc/component/host_signals_words.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/verilated_chip.h"

namespace brick::component {
namespace {
using namespace host_signals_words;

struct Ports {
  static constexpr unsigned kOutputWords = 1;

  static void drive(Vhost_signals& v, const PinWords& in) { v.rst_ni = bit(in, 0, kRstN); }
  static void sample(const Vhost_signals& v, PinWords& out) {
    const std::uint32_t signals = v.ipos_o | v.breq_o << 1 | v.eror_o << 2 | v.f1er_o << 3;
    out[0] = signals << kSignals | std::uint32_t{v.ctrl_o} << kControl;
  }
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
