#include "testbench/benchmark/bare_servo_ic.h"

#include <Vservo_ic.h>
#include <Vservo_ic___024root.h>

#include "systemc/core/model_block.h"
#include "systemc/core/motor_pins.h"
#include "systemc/cosim/verilated_module.h"

namespace brick {

struct BareServoIc::Model {
  explicit Model(bool two) : twice(two) {}
  VerilatedModule<Vservo_ic> top{0};
  const bool twice;
  Tick now = 0;

  void tick() {
    ++now;
    const bool ref = now % kTicksPerRef == 0;
    if (!twice) return top.edge(true, ref);
    top->clk_pwm_i = 1;
    top->clk_ref_i = ref;
    top->eval();
    top->clk_pwm_i = 0;
    top->clk_ref_i = 0;
    top->eval();
  }
};

BareServoIc::BareServoIc(bool twice) : model_(std::make_unique<Model>(twice)) {
  Vservo_ic& v = *model_->top;
  for (unsigned n = 0; n < kChannels; ++n) v.pins_i |= QData{kIdleChannelPins} << 12 * n;
  v.phase_i = v.servo_i = true;
  model_->top.pulse_reset();
}
BareServoIc::~BareServoIc() = default;

void BareServoIc::write(unsigned address, std::uint32_t value) {
  Vservo_ic& v = *model_->top;
  v.sel_i = v.we_i = true;
  v.x_i = (address & 4) != 0;
  v.addr_i = static_cast<CData>(address / 8);
  v.wdata_i = value;
  run_until(next_ref_edge(model_->now));
  v.sel_i = v.we_i = false;
}

void BareServoIc::turn() { model_->top->pins_i ^= 1u << kEncA; }

void BareServoIc::run_until(Tick end) {
  while (model_->now < end) model_->tick();
}

}  // namespace brick
