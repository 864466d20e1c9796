// The servo IC as Verilator makes it with --sc: clocks are sc_clocks, pins are signals.
#include <systemc>

#include "Vservo_ic.h"
#include "testbench/benchmark/peers/peer.h"

namespace {

using sc_core::sc_signal;
using sc_core::sc_time;

// A tick is 2 ns; the clocks rise together, tick 1 at 3 ns.
struct Bench : sc_core::sc_module {
  SC_HAS_PROCESS(Bench);
  Bench(const sc_core::sc_module_name& name, int argc, char** argv) : sc_module(name), argc_(argc), argv_(argv) {
    dut.clk_pwm_i(clk_pwm), dut.clk_ref_i(clk_ref), dut.rst_ni(rst_n);
    dut.sel_i(sel), dut.x_i(x), dut.addr_i(addr), dut.we_i(we), dut.wdata_i(wdata), dut.rd_i(rd), dut.rdata_o(rdata);
    dut.phase_i(phase_in), dut.servo_i(servo_in), dut.phase_o(phase), dut.servo_o(servo);
    dut.phase_oe_o(phase_oe), dut.servo_oe_o(servo_oe);
    dut.trip_i(trip), dut.trip_d_i(trip_d), dut.pins_i(pins), dut.adc_a_i(adc_a), dut.adc_b_i(adc_b);
    dut.equ_o(equ), dut.motor_o(motor_out);
    SC_THREAD(run);
  }

  void run_until(std::uint64_t tick) {
    const sc_time end(2.0 * static_cast<double>(tick) + 2.0, sc_core::SC_NS);  // between two edges
    if (end > sc_core::sc_time_stamp()) wait(end - sc_core::sc_time_stamp());
    now = tick;
  }
  void write(unsigned address, std::uint32_t value) {
    select(address);
    we = true;
    wdata = value;
    run_until(now + 1);
    we = false;
  }
  void set_pins(std::uint64_t value) { pins = value; }
  void select(unsigned address) {
    sel = true;
    x = (address & 4) != 0;
    addr = address / 8;
  }
  std::uint32_t word() { return static_cast<std::uint32_t>(rdata.read()); }
  std::uint64_t motor() { return static_cast<std::uint64_t>(motor_out.read()); }

  int status = 2;

 private:
  void run() {
    phase_in = true;
    servo_in = true;
    rst_n = true;
    wait(0.2, sc_core::SC_NS);
    rst_n = false;
    wait(0.2, sc_core::SC_NS);
    rst_n = true;
    run_until(0);
    status = brick::peer::play(*this, argc_, argv_);
    sc_core::sc_stop();
  }

  const int argc_;
  char** const argv_;
  std::uint64_t now = 0;
  sc_core::sc_clock clk_pwm{"clk_pwm", sc_time(2, sc_core::SC_NS), 0.5, sc_time(3, sc_core::SC_NS), true};
  sc_core::sc_clock clk_ref{"clk_ref", sc_time(6, sc_core::SC_NS), 0.5, sc_time(7, sc_core::SC_NS), true};
  sc_signal<bool> rst_n, sel, x, we, rd, phase_in, servo_in, phase, servo, phase_oe, servo_oe, trip, trip_d;
  sc_signal<std::uint32_t> addr, wdata, rdata, adc_a, adc_b, equ;
  sc_signal<std::uint64_t> pins, motor_out;
  Vservo_ic dut{"dut"};
};

}  // namespace

int sc_main(int argc, char** argv) {
  Bench bench("bench", argc, argv);
  sc_core::sc_start();
  return bench.status;
}
