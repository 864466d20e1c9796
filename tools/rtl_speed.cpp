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
#include "systemc/cosim/drive.h"
#include "verilated.h"

namespace {

VerilatedContext context;
Vboard_s2 top{&context, ""};
brick::BoardInputs in;
std::uint64_t now = 0, sum = 0;
bool busy = false, second_eval = false;

void turn_encoders() {
  static const unsigned kAb[] = {0, 1, 3, 2};
  for (unsigned ic = 0; ic < 2; ++ic) {
    brick::MotorInputs motor;
    for (unsigned n = 0; n < 4; ++n)
      motor.pins[n] = static_cast<std::uint16_t>(0xF80 | kAb[(now / 60 + 4 * ic + n) & 3]);
    brick::drive_motor(top, ic, motor);
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
  for (const std::uint32_t word : top.pins_o) sum = sum * 31 + word;
  for (unsigned ic = 0; ic < 2; ++ic) sum = sum * 31 + top.motor_o[ic];
}

void ticks(std::uint64_t n) {
  while (n-- > 0) tick();
}

void write(std::uint32_t address, bool x, std::uint32_t value) {
  in.pa_addr = address;
  in.pa_x = x;
  in.pa_aa = 2;
  in.pa_wdata = value;
  in.pa_wr_n = false;
  brick::drive(top, in);
  ticks(20);
  in.pa_wr_n = true;
  brick::drive(top, in);
  ticks(10);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  busy = std::strcmp(argv[1], "busy") == 0;
  second_eval = argc > 3;
  in.rst_n = true;
  in.fitted = 3;
  brick::drive(top, in);
  top.eval();
  in.rst_n = false;
  brick::drive(top, in);
  ticks(30);
  in.rst_n = true;
  brick::drive(top, in);
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
