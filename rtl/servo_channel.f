// Channel of a servo IC: what servo_channel is made of, in compile order.
// Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit.
regs/brick_regs_pkg.sv
servo_ic/channel_input.sv
servo_ic/channel_index.sv
servo_ic/channel_decode.sv
servo_ic/channel_counter.sv
servo_ic/channel_subcount.sv
servo_ic/channel_capture.sv
servo_ic/channel_compare.sv
servo_ic/channel_triangle.sv
servo_ic/channel_pwm.sv
servo_ic/channel_pfm.sv
servo_ic/channel_dac.sv
servo_ic/channel_adc.sv
servo_ic/channel_regs.sv
servo_ic/servo_channel.sv
