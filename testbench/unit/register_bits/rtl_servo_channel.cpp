#include "testbench/unit/register_bits/rtl_servo_channel.h"

#include "Vservo_channel.h"
#include "Vservo_channel___024root.h"
#include "testbench/unit/rtl/verilated_shell.h"

namespace brick {
namespace {

void drive(Vservo_channel& v, const ServoChannelInputs& in) {
  v.x_i = in.x;
  v.addr_i = in.addr & 7;
  v.sel_i = v.sclk_ce_i = v.pfm_ce_i = true;
  v.we_i = in.we;
  v.wdata_i = in.wdata & 0xFFFFFF;
  v.read_capture_i = in.read_capture;
  v.phase_fall_i = v.servo_fall_i = in.latch;
  v.pins_i = in.pins & 0xFFF;
  // What comes from the rest of the IC, and the pins of the ADCs, rests.
  v.trip_i = v.trip_d_i = v.turn_i = v.dac_load_i = v.dac_shift_i = v.adc_sample_i = v.adc_a_i = v.adc_b_i = false;
  v.count1_i = v.down1_i = v.still1_i = v.fine1_i = false;
  v.cnt_i = v.counter1_i = 0;
  v.deadtime_i = v.adc_bit_i = 0;
  v.fraction1_i = 0;
}
std::uint32_t sample(const Vservo_channel& v) { return v.rdata_o; }

}  // namespace

RtlServoChannel::RtlServoChannel() : RtlBlock(verilated_shell(drive, sample)) {}

void RtlServoChannel::step(std::int64_t periods) {
  while (periods-- > 0) ref_edge();
}

void RtlServoChannel::step_with(bool ServoChannelInputs::*strobe) {
  in.*strobe = true;
  step();
  in.*strobe = false;
}

void RtlServoChannel::write(bool x, unsigned offset, std::uint32_t word) {
  in.x = x;
  in.addr = offset;
  in.wdata = word;
  step_with(&ServoChannelInputs::we);
}

std::uint32_t RtlServoChannel::read(bool x, unsigned offset) {
  in.x = x;
  in.addr = offset;
  settle();
  return outputs();
}

}  // namespace brick
