// The loop of tools/rtl_speed.py: the Verilated board with two servo ICs, its clocks running, and nobody else.
//   rtl_speed quiet|busy TICKS [second-eval]
// busy: eight encoders turn (a count each 240 ticks), PWM on all outputs, PFM on two, hardware 1/T on two channels.
// second-eval: clocks are lowered by an evaluation of their own, not by writing what Verilator remembers of them.
// Prints ticks a second, and a checksum over all pins, which tells whether two trees do the same.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "Vboard_s2.h"
#include "Vboard_s2___024root.h"
#include "verilated.h"

namespace {

VerilatedContext context;
Vboard_s2 top{&context, ""};
std::uint64_t now = 0, sum = 0;
bool busy = false, second_eval = false;

void turn_encoders() {
  static const unsigned kAb[] = {0, 1, 3, 2};
  for (unsigned ic = 0; ic < 2; ++ic) {
    std::uint64_t pins = 0;
    for (unsigned n = 0; n < 4; ++n)
      pins |= static_cast<std::uint64_t>(0xF80 | kAb[(now / 60 + 4 * ic + n) & 3]) << 12 * n;
    top.motor_i[ic] = pins;
  }
}

void tick() {
  ++now;
  if (busy && now % 60 == 0) turn_encoders();
  top.clk_pwm_i = 1;
  top.clk_ref_i = now % 3 == 0;
  top.eval();
  top.clk_pwm_i = top.clk_ref_i = 0;
  if (second_eval)
    top.eval();
  else
    top.rootp->__Vtrigrprev__TOP__clk_pwm_i = top.rootp->__Vtrigrprev__TOP__clk_ref_i = 0;
  sum = (sum * 31 + top.pins_o[0]) ^ (top.motor_o[0] * 7 + top.motor_o[1]);
}

void ticks(std::uint64_t n) {
  while (n-- > 0) tick();
}

void write(std::uint32_t address, bool x, std::uint32_t value) {
  top.pa_addr_i = address & 0x7FFFF;
  top.pa_x_i = x;
  top.pa_aa_i = 2;
  top.pa_wdata_i = value;
  top.pa_wr_ni = 0;
  ticks(20);
  top.pa_wr_ni = 1;
  ticks(10);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  busy = std::strcmp(argv[1], "busy") == 0;
  second_eval = argc > 3;
  top.rst_ni = 1;
  top.fitted_i = 3;
  top.pa_rd_ni = top.pa_wr_ni = top.isa_ior_ni = top.isa_iow_ni = top.isa_memr_ni = top.isa_memw_ni = 1;
  top.isa_sbhe_ni = top.ext_phase_i = top.ext_servo_i = 1;
  top.eval();
  top.rst_ni = 0;
  ticks(30);
  top.rst_ni = 1;
  write(0x78004, true, 0x3008D2);  // servo IC 0 drives PHASE and SERVO
  for (std::uint32_t channel = 0; busy && channel < 8; ++channel) {
    const std::uint32_t at = 0x78000 + (channel / 4) * 0x100 + 8 * (channel % 4), n = channel % 4;
    write(at + 5, true, 7u | (n == 0 ? 1u << 18 : 0) | (n == 1 ? 1u << 23 : 0));
    for (std::uint32_t output = 2; output < 5; ++output) write(at + output, false, 0x100000 * output);
  }
  const std::uint64_t n = std::strtoull(argv[2], nullptr, 0);
  const auto begin = std::chrono::steady_clock::now();
  ticks(n);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::printf("%.0f %016llx\n", static_cast<double>(n) / seconds, static_cast<unsigned long long>(sum));
  top.final();
}
