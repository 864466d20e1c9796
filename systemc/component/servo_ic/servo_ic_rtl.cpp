// The Verilated servo IC behind the pins of its component.
#include "Vservo_ic.h"
#include "Vservo_ic___024root.h"
#include "systemc/component/rtl_chips.h"
#include "systemc/component/servo_ic/servo_ic_words.h"
#include "systemc/component/verilated_chip.h"
#include "systemc/core/motor_pins.h"

namespace brick::component {
namespace {
using namespace servo_ic_words;

struct Ports : PortMap {
  static void drive(Vservo_ic& v, const PinWords& in) {
    PortMap::drive(v, in);
    QData pins = 0;
    unsigned adc_a = 0, adc_b = 0;
    for (unsigned n = 0; n < kChannels; ++n) {
      pins |= QData{in[n] & 0xFFF} << 12 * n;
      adc_a |= (in[n] >> kAdcA.lsb & 1) << n;
      adc_b |= (in[n] >> kAdcB.lsb & 1) << n;
    }
    v.pins_i = pins;
    v.trip_d_i = false;  // nobody knows of a pin before it moves
    v.adc_a_i = static_cast<CData>(adc_a);
    v.adc_b_i = static_cast<CData>(adc_b);
  }
  static void sample(const Vservo_ic& v, PinWords& out) {
    PortMap::sample(v, out);
    out[0] = static_cast<std::uint32_t>(v.motor_o);
    out[1] = static_cast<std::uint32_t>(v.motor_o >> 32);
  }
  static void access(Vservo_ic& v, unsigned, bool on, const Face& face) {
    const Cycle& c = face.cycle;
    v.sel_i = on;
    v.we_i = on && c.write;
    v.rd_i = on && !c.write;
    v.x_i = (c.address & 4) != 0;
    v.addr_i = static_cast<CData>(c.address / 8);
    v.wdata_i = c.value & 0xFFFFFF;
  }
  static std::uint32_t read(const Vservo_ic& v, unsigned, unsigned) { return v.rdata_o; }
};

}  // namespace

std::unique_ptr<Chip> rtl_servo_ic(std::uint64_t seed) {
  return std::make_unique<VerilatedChip<Vservo_ic, Ports>>(seed);
}

}  // namespace brick::component
