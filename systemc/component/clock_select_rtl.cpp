// The Verilated clock selection behind the pins of its component.
#include "Vclock_select.h"
#include "Vclock_select___024root.h"
#include "systemc/component/clock_select_words.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/verilated_chip.h"

namespace brick::component {
namespace {
using namespace clock_select_words;

struct Ports {
  static constexpr unsigned kOutputWords = 1;

  static const std::vector<FaceClock>& faces() {
    static const std::vector<FaceClock> none;
    return none;
  }
  static void drive(Vclock_select& v, const PinWords& in) {
    v.rst_ni = bit(in, kControl, kRstN);
    v.fitted_i = in[kFitted];
    v.phase_i = in[kPhaseIn];
    v.servo_i = in[kServoIn];
    v.phase_oe_i = in[kPhaseOe];
    v.servo_oe_i = in[kServoOe];
    v.ext_clock_i = bit(in, kControl, kExtClock);
    v.ext_phase_i = bit(in, kControl, kExtPhase);
    v.ext_servo_i = bit(in, kControl, kExtServo);
  }
  static void sample(const Vclock_select& v, PinWords& out) {
    out[0] = std::uint32_t{v.phase_o} << kPhase | std::uint32_t{v.servo_o} << kServo |
             std::uint32_t{v.conflict_o} << kConflict | std::uint32_t{v.phase_source_o} << kSource;
  }
  static void access(Vclock_select&, unsigned, bool, const Face&) {}
  static std::uint32_t read(const Vclock_select&, unsigned, unsigned) { return 0; }
};

}  // namespace

std::unique_ptr<Chip> rtl_clock_select(std::uint64_t seed) {
  return std::make_unique<VerilatedChip<Vclock_select, Ports>>(seed);
}

}  // namespace brick::component
