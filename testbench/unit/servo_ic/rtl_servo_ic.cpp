#include "testbench/unit/servo_ic/rtl_servo_ic.h"

#include "Vservo_ic.h"
#include "Vservo_ic___024root.h"
#include "testbench/unit/rtl/verilated_shell.h"

namespace brick {
namespace {

void drive(Vservo_ic& v, const ServoIcInputs& in) {
  v.rst_ni = in.rst_n;
  v.trip_i = in.trip;
  v.trip_d_i = in.trip_d;
  v.sel_i = in.sel;
  v.x_i = in.x;
  v.addr_i = in.addr & 31;
  v.we_i = in.we;
  v.wdata_i = in.wdata & 0xFFFFFF;
  v.rd_i = in.rd;
  v.phase_i = in.phase;
  v.servo_i = in.servo;
  v.pins_i = in.pins[0] | QData{in.pins[1]} << 12 | QData{in.pins[2]} << 24 | QData{in.pins[3]} << 36;
  v.adc_a_i = static_cast<CData>(in.adc_a);
  v.adc_b_i = static_cast<CData>(in.adc_b);
}
IcOutputs sample(const Vservo_ic& v) {
  return {v.phase_o != 0, v.servo_o != 0, v.phase_oe_o != 0, v.servo_oe_o != 0, v.rdata_o, v.motor_o};
}

}  // namespace

RtlServoIc::RtlServoIc() : RtlIc(verilated_shell(drive, sample)) {}

}  // namespace brick
