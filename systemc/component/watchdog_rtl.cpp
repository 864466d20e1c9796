// The Verilated watchdog behind the pins of its component.
#include "Vwatchdog.h"
#include "Vwatchdog___024root.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/verilated_chip.h"
#include "systemc/component/watchdog_words.h"

namespace brick::component {
namespace {
using namespace watchdog_words;

struct Ports {
  static constexpr unsigned kOutputWords = 1;

  static void drive(Vwatchdog& v, const PinWords& in) {
    v.rst_ni = bit(in, 0, kRstN);
    v.servo_i = bit(in, 0, kServo);
    v.pwr_good_i = bit(in, 0, kPwrGood);
  }
  static void sample(const Vwatchdog& v, PinWords& out) {
    out[0] = std::uint32_t{v.trip_o} << kTrip | std::uint32_t{v.relay_o} << kRelay;
  }
  static void access(Vwatchdog& v, unsigned, bool on, const Face& face) { v.strobe_i = on && face.cycle.write; }
  static std::uint32_t read(const Vwatchdog&, unsigned, unsigned) { return 0; }
};

}  // namespace

std::unique_ptr<Chip> rtl_watchdog(std::uint64_t seed) {
  return std::make_unique<VerilatedChip<Vwatchdog, Ports>>(seed);
}

}  // namespace brick::component
