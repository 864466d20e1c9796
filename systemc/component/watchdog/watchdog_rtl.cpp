// The Verilated watchdog behind the pins of its component.
#include "Vwatchdog.h"
#include "Vwatchdog___024root.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/verilated_chip.h"
#include "systemc/component/watchdog/watchdog_words.h"

namespace brick::component {
namespace {
using namespace watchdog_words;

struct Ports : PortMap {
  static void access(Vwatchdog& v, unsigned, bool on, const Face& face) { v.strobe_i = on && face.cycle.write; }
  static std::uint32_t read(const Vwatchdog&, unsigned, unsigned) { return 0; }
};

}  // namespace

std::unique_ptr<Chip> rtl_watchdog(std::uint64_t seed) {
  return std::make_unique<VerilatedChip<Vwatchdog, Ports>>(seed);
}

}  // namespace brick::component
