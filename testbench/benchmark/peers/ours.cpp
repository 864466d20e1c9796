// The servo IC by our two engines, and the Verilated one in the loop of Verilator's examples:
// brick_peers model|rtl|bare WRITES STEPS FLIP
#include <Vservo_ic.h>
#include <Vservo_ic___024root.h>

#include <algorithm>
#include <cstring>

#include "systemc/core/ticks.h"
#include "systemc/cosim/verilated_module.h"
#include "systemc/servo_ic/servo_ic.h"
#include "testbench/benchmark/peers/peer.h"

namespace brick {
namespace {

// The SystemC model: it wakes where something happens.
class Model {
 public:
  Model() { ic_.reset(0); }
  void run_until(Tick end) {
    while (now_ < end) {
      now_ = std::min(end, std::max(now_ + 1, ic_.next_event()));
      ic_.advance(now_);
    }
  }
  void write(unsigned address, std::uint32_t value) {
    run_until(now_ + 1);
    ic_.write((address & 4) != 0, address / 8, value);
  }
  void set_pins(std::uint64_t pins) {
    for (unsigned n = 0; n < kChannels; ++n) ic_.set_channel_pins(n, pins >> 12 * n & 0xFFF);
  }
  void select(unsigned address) { address_ = address; }
  std::uint32_t word() const { return ic_.read((address_ & 4) != 0, address_ / 8); }
  std::uint64_t motor() const {
    const MotorOutputs out = ic_.motor_outputs();
    return out.w[0] | std::uint64_t{out.w[1]} << 32;
  }

 private:
  ServoIc ic_{"model"};
  unsigned address_ = 0;
  Tick now_ = 0;
};

class Verilated {
 public:
  explicit Verilated(bool bare) : bare_(bare) {
    top_->phase_i = top_->servo_i = true;
    top_.pulse_reset();
  }
  void run_until(Tick end) {
    while (now_ < end) tick();
  }
  void write(unsigned address, std::uint32_t value) {
    select(address);
    top_->we_i = true;
    top_->wdata_i = value;
    tick();
    top_->we_i = false;
  }
  void set_pins(std::uint64_t pins) { top_->pins_i = pins; }
  void select(unsigned address) {
    top_->sel_i = true;
    top_->x_i = (address & 4) != 0;
    top_->addr_i = static_cast<CData>(address / 8);
  }
  std::uint32_t word() const { return top_->rdata_o; }
  std::uint64_t motor() const { return top_->motor_o; }

 private:
  void tick() {
    const bool ref = ++now_ % kTicksPerRef == 0;
    if (!bare_) return top_.edge(true, ref);
    top_->clk_pwm_i = true;
    top_->clk_ref_i = ref;
    top_->eval();
    top_->clk_pwm_i = top_->clk_ref_i = false;
    top_->eval();
  }

  VerilatedModule<Vservo_ic> top_{0};
  const bool bare_;
  Tick now_ = 0;
};

}  // namespace
}  // namespace brick

int sc_main(int argc, char** argv) {
  const char* which = argc > 1 ? argv[1] : "";
  if (std::strcmp(which, "model") == 0) {
    brick::Model dut;
    return brick::peer::play(dut, argc - 1, argv + 1);
  }
  if (std::strcmp(which, "rtl") != 0 && std::strcmp(which, "bare") != 0) return 2;
  brick::Verilated dut(std::strcmp(which, "bare") == 0);
  return brick::peer::play(dut, argc - 1, argv + 1);
}
