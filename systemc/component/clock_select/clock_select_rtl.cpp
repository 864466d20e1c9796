// The Verilated clock selection behind the pins of its component.
#include "Vclock_select.h"
#include "Vclock_select___024root.h"
#include "systemc/component/clock_select/clock_select_words.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/verilated_chip.h"

namespace brick::component {
namespace {
using namespace clock_select_words;

struct Ports : PortMap {
  static const std::vector<FaceClock>& faces() {
    static const std::vector<FaceClock> none;
    return none;
  }
  static void access(Vclock_select&, unsigned, bool, const Face&) {}
  static std::uint32_t read(const Vclock_select&, unsigned, unsigned) { return 0; }
};

}  // namespace

std::unique_ptr<Chip> rtl_clock_select(std::uint64_t seed) {
  return std::make_unique<VerilatedChip<Vclock_select, Ports>>(seed);
}

}  // namespace brick::component
